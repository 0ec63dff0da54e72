// Fixture of the baseline methods: the exact values beside a wall.
#pragma once

#include "ao/solids.h"

namespace obscura::test {

class BaselineTest : public MethodTest {
protected:
    using MethodTest::MethodTest;
    using Kind = Solid::Kind;

    // Rows of the floor in front of the wall: distance to it, metres, and mean obscurance of the middle of the row.
    struct Row {
        double away, obscurance;
    };
    static std::vector<Row> rowsBeforeWall(const Room& room, const Picture& picture) {
        std::vector<Row> rows;
        for (uint32_t y = room.guard; y < room.height - room.guard; ++y) {
            Row row{0, 0};
            for (uint32_t x = 60; x < 140; ++x)
                row.obscurance += picture[size_t(y - room.guard) * room.visibleWidth() + x - room.guard] / 80.0;
            const glm::vec3 p = pointAt(room, 100, y);
            row.away = p.z + 5.0;
            if (p.y < -1.49f && row.away > 0.1 && row.away < 1.2) rows.push_back(row);
        }
        return rows;
    }
    // Mean over the hemisphere above a floor, cosine-weighted or uniform, of weight(distance along the direction to a wall at `away` m).
    template <class Weight> static double beforeWall(double away, bool cosine, Weight weight) {
        constexpr int kSteps = 200;
        double sum = 0.0, total = 0.0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                const double z = (i + 0.5) / kSteps, towards = std::sqrt(1.0 - z * z) * std::cos((j + 0.5) / kSteps * 6.283185307);
                const double solidAngle = cosine ? z : 1.0;
                total += solidAngle;
                if (towards > 0.0) sum += solidAngle * weight(away / towards);
            }
        return sum / total;
    }
};

}  // namespace obscura::test
