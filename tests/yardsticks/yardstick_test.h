// Frames of half-spaces and numbers that follow from them, for the methods that are compared with.
#pragma once

#include "layered/solids.h"

namespace obscura::test {

class YardstickTest : public MethodTest {
protected:
    using MethodTest::MethodTest;
    using Kind = Solid::Kind;

    static Room roomOf(const std::vector<Solid>& solids) {
        Room room = frameOf(solids, 200, 120, 20);
        room.thickness.clear();
        room.second.clear();
        return room;
    }
    static Solid floor() { return {Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}; }
    static Solid wall() { return {Kind::plane, {0, 0, -5}, {0, 0, 1}}; }
    static std::vector<std::vector<Solid>> convex() {
        return {{floor()}, {{Kind::plane, {0, -1.5f, 0}, {0.5f, 1, 0.05f}}}, {{Kind::plane, {0, 0, -6}, {0.5f, 0.3f, 1}}}};
    }

    // Rows of the floor before the wall: how far from it, and the mean obscurance of the middle of the picture there.
    struct Row { double away, obscurance; };
    static std::vector<Row> rowsBeforeWall(const Room& room, const Picture& picture) {
        std::vector<Row> rows;
        for (uint32_t y = room.guard; y < room.height - room.guard; ++y) {
            Row row{0, 0};
            for (uint32_t x = 60; x < 140; ++x) row.obscurance += picture[size_t(y - room.guard) * room.visibleWidth() + x - room.guard] / 80.0;
            const glm::vec3 p = pointAt(room, 100, y);
            row.away = p.z + 5.0;
            if (p.y < -1.49f && row.away > 0.1 && row.away < 1.2) rows.push_back(row);
        }
        return rows;
    }
    // Mean over directions above a floor, cosine-weighted or even, of a weight of the distance to a wall `away`.
    template <class Weight> static double beforeWall(double away, bool cosine, Weight weight) {
        constexpr int kParts = 200;
        double sum = 0.0, total = 0.0;
        for (int i = 0; i < kParts; ++i)
            for (int j = 0; j < kParts; ++j) {
                const double z = (i + 0.5) / kParts, towards = std::sqrt(1.0 - z * z) * std::cos((j + 0.5) / kParts * 6.283185307);
                const double share = cosine ? z : 1.0;
                total += share;
                if (towards > 0.0) sum += share * weight(away / towards);
            }
        return sum / total;
    }
};

}  // namespace obscura::test
