// A floor and a tall box on it, seen from 1.6 m above the floor. When the camera yaws by away(), the box is just outside the guard band (by
// 0.1 m at the default position), while its obscurance falls inside the image. Depth, normals and voxel bits are analytic for any yaw;
// the exact obscurance is ray-traced.
#pragma once

#include "ao/room.h"

namespace obscura::test {

struct TallBox : Room {
    static constexpr double kPi = 3.14159265358979;
    static constexpr float kCell = 0.08f, kFloor = -1.6f;
    // World: the camera at the origin, y up; yaw 0 looks down -z, positive yaw turns left.
    using Point = std::array<double, 3>;
    Point low{0.1, kFloor, -6.0}, high{1.3, 1.4, -3.0};
    // Half of the horizontal field of view, guard band included, radians.
    double away() const { return std::atan(std::tan(kPi / 6) * double(width) / visibleTall()); }
    uint32_t visibleWide() const { return width - 2 * guards.width; }
    uint32_t visibleTall() const { return height - 2 * guards.height; }

    double yaw = 0.0;
    VkExtent2D guards{19, 11};

    explicit TallBox(uint32_t wide = 192) { build(wide); }
    TallBox(const Point& lowest, const Point& highest) : low(lowest), high(highest) { build(192); }
    void build(uint32_t wide) {
        guards = {wide / 10, wide / 17};
        width = wide + 2 * guards.width;
        height = wide * 9 / 16 + 2 * guards.height;
        fill();
        turnTo(away());
    }

    // Turns the camera; the voxel bits stay.
    void turnTo(double turned) {
        yaw = turned;
        const double fy = 1.0 / std::tan(kPi / 6) * visibleTall() / height, fx = fy * height / width;
        const float p[16] = {float(fx), 0, 0, 0, 0, float(-fy), 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
        std::memcpy(projection, p, sizeof(p));
        const float scale = 1.0f / kCell, half = 0.5f * float(volume.cells), c = float(std::cos(yaw)) * scale,
                    s = float(std::sin(yaw)) * scale;
        const float columns[16] = {c, 0, -s, 0, 0, scale, 0, 0, s, 0, c, 0, half, half, half, 1};
        std::copy(std::begin(columns), std::end(columns), volume.cellFromEye);
        depth.assign(size_t(width) * height, 1e4f);
        normals.assign(size_t(width) * height * 4, 0.0f);
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const Point d = direction(x + 0.5, y + 0.5);
                const size_t i = size_t(y) * width + x;
                double t = d[1] < 0.0 ? kFloor / d[1] : 1e9;
                Point n{0, 1, 0};
                int axis = 0;
                const double box = hit({0, 0, 0}, d, axis);
                if (box < t) {
                    t = box;
                    n = {0, 0, 0};
                    n[size_t(axis)] = d[size_t(axis)] > 0.0 ? -1.0 : 1.0;
                }
                if (t > 60.0) continue;
                depth[i] = float(t);
                normals[i * 4] = float(n[0] * std::cos(yaw) - n[2] * std::sin(yaw));
                normals[i * 4 + 1] = float(n[1]);
                normals[i * 4 + 2] = float(n[0] * std::sin(yaw) + n[2] * std::cos(yaw));
            }
    }
    ao::Frame seen() const {
        ao::Frame result = frame();
        result.guard = guards;
        return result;
    }

    // World direction through a position of the image, px; 1 m of linear depth long.
    Point direction(double x, double y) const {
        const double ex = (x / width * 2.0 - 1.0) / double(projection[0]), ey = (y / height * 2.0 - 1.0) / double(projection[5]);
        return {ex * std::cos(yaw) - std::sin(yaw), ey, -ex * std::sin(yaw) - std::cos(yaw)};
    }
    // Position of a world point in the visible part, px.
    std::array<double, 2> pixelOf(const Point& p) const {
        const double right = p[0] * std::cos(yaw) - p[2] * std::sin(yaw), ahead = -p[0] * std::sin(yaw) - p[2] * std::cos(yaw);
        return {(right / ahead * double(projection[0]) + 1.0) * 0.5 * width - guards.width,
            (p[1] / ahead * double(projection[5]) + 1.0) * 0.5 * height - guards.height};
    }

    // Distance along d to the box in lengths of d, and the axis of the face; 1e9: none.
    double hit(const Point& o, const Point& d, int& axis) const {
        double from = 0.0, to = 1e9;
        for (int k = 0; k < 3; ++k) {
            const size_t i = size_t(k);
            double a = (low[i] - o[i]) / d[i], b = (high[i] - o[i]) / d[i];
            if (a > b) std::swap(a, b);
            if (a > from) from = a, axis = k;
            to = std::min(to, b);
        }
        return from < to ? from : 1e9;
    }
    // Obscurance of a floor point.
    double truth(const Point& p, const ao::Falloff& rho) const {
        constexpr int kSide = 48;
        double sum = 0.0;
        for (int i = 0; i < kSide; ++i)
            for (int k = 0; k < kSide; ++k) {
                const double square = (i + 0.5) / kSide, azimuth = 2.0 * kPi * (k + 0.5) / kSide,
                             across = std::sqrt(square);  // cosine-weighted
                int axis = 0;
                const double t = hit(p, {across * std::cos(azimuth), std::sqrt(1.0 - square), across * std::sin(azimuth)}, axis);
                if (t < 1e8) sum += double(ao::evaluate(rho, float(t)));
            }
        return sum / (kSide * kSide);
    }

private:
    // Every cell that the floor or the box's surface touches.
    void fill() {
        const uint32_t cells = 256;
        volume = {};
        volume.cells = cells;
        bits.assign(size_t(cells) * cells * cells / 32, 0);
        const auto cell = [&](double metres) { return uint32_t(int(std::floor(metres / double(kCell))) + int(cells) / 2); };
        const uint32_t floor = cell(kFloor);
        for (uint32_t x = 0; x < cells; ++x)
            for (uint32_t z = 0; z < cells; ++z) set(x, floor, z);
        uint32_t a[3], b[3];
        for (size_t i = 0; i < 3; ++i) a[i] = cell(low[i]), b[i] = cell(high[i]);
        for (uint32_t x = a[0]; x <= b[0]; ++x)
            for (uint32_t y = a[1]; y <= b[1]; ++y)
                for (uint32_t z = a[2]; z <= b[2]; ++z)
                    if (x == a[0] || x == b[0] || y == a[1] || y == b[1] || z == a[2] || z == b[2]) set(x, y, z);
    }
};

}  // namespace obscura::test
