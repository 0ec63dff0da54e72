// A floor and a tall box that stands on it, along the plane in which the picture's guard band ends when the camera looks away by
// kAway: seen from 1.6 m above the floor, the box is outside of the buffer by a hand's breadth, its obscurance within the picture.
// Depth, normals and bits are cast analytically for any yaw of the camera; the truth by rays.
#pragma once

#include "ao/room.h"

namespace obscura::test {

struct TallBox : Room {
    static constexpr double kPi = 3.14159265358979;
    static constexpr float kCell = 0.08f, kFloor = -1.6f;
    // World: the camera at the origin, y up; yaw 0 looks down -z, more turns left.
    static constexpr double kLow[3] = {0.1, kFloor, -6.0}, kHigh[3] = {1.3, 1.4, -3.0};
    static constexpr uint32_t kGuardX = 19, kGuardY = 11, kWide = 192, kHigh_ = 108;
    static double away() { return std::atan(std::tan(kPi / 6) * double(kWide) / kHigh_ * (kWide + 2.0 * kGuardX) / kWide); }  // half of the field of view

    double yaw = 0.0;
    VkExtent2D guards{kGuardX, kGuardY};

    TallBox() {
        width = kWide + 2 * kGuardX;
        height = kHigh_ + 2 * kGuardY;
        fill();
        look(away());
    }

    // The bits rest; the camera turns.
    void look(double turned) {
        yaw = turned;
        const double fy = 1.0 / std::tan(kPi / 6) * kHigh_ / height, fx = fy * height / width;
        const float p[16] = {float(fx), 0, 0, 0, 0, float(-fy), 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
        std::memcpy(projection, p, sizeof(p));
        const float scale = 1.0f / kCell, half = 0.5f * float(volume.cells), c = float(std::cos(yaw)) * scale, s = float(std::sin(yaw)) * scale;
        const float columns[16] = {c, 0, -s, 0, 0, scale, 0, 0, s, 0, c, 0, half, half, half, 1};
        std::copy(std::begin(columns), std::end(columns), volume.cellFromEye);
        depth.assign(size_t(width) * height, 1e4f);
        normals.assign(size_t(width) * height * 4, 0.0f);
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const std::array<double, 3> d = direction(x + 0.5, y + 0.5);
                const size_t i = size_t(y) * width + x;
                double t = d[1] < 0.0 ? kFloor / d[1] : 1e9;
                std::array<double, 3> n{0, 1, 0};
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

    // World direction through a place of the buffer, px; one metre of linear depth long.
    std::array<double, 3> direction(double x, double y) const {
        const double ex = (x / width * 2.0 - 1.0) / double(projection[0]), ey = (y / height * 2.0 - 1.0) / double(projection[5]);
        return {ex * std::cos(yaw) - std::sin(yaw), ey, -ex * std::sin(yaw) - std::cos(yaw)};
    }
    // Where the visible part shows a point of the world, px.
    std::array<double, 2> pixelOf(const std::array<double, 3>& p) const {
        const double right = p[0] * std::cos(yaw) - p[2] * std::sin(yaw), ahead = -p[0] * std::sin(yaw) - p[2] * std::cos(yaw);
        return {(right / ahead * double(projection[0]) + 1.0) * 0.5 * width - kGuardX, (p[1] / ahead * double(projection[5]) + 1.0) * 0.5 * height - kGuardY};
    }

    // Distance along d to the box in lengths of d, and the axis of the face; 1e9: none.
    static double hit(const std::array<double, 3>& o, const std::array<double, 3>& d, int& axis) {
        double from = 0.0, to = 1e9;
        for (int k = 0; k < 3; ++k) {
            const size_t i = size_t(k);
            double a = (kLow[k] - o[i]) / d[i], b = (kHigh[k] - o[i]) / d[i];
            if (a > b) std::swap(a, b);
            if (a > from) from = a, axis = k;
            to = std::min(to, b);
        }
        return from < to ? from : 1e9;
    }
    // Obscurance of a point of the floor.
    static double truth(const std::array<double, 3>& p, const ao::Falloff& rho) {
        constexpr int kSide = 48;
        double sum = 0.0;
        for (int i = 0; i < kSide; ++i)
            for (int k = 0; k < kSide; ++k) {
                const double square = (i + 0.5) / kSide, azimuth = 2.0 * kPi * (k + 0.5) / kSide, across = std::sqrt(square);  // cosine-weighted
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
        uint32_t low[3], high[3];
        for (int i = 0; i < 3; ++i) low[i] = cell(kLow[i]), high[i] = cell(kHigh[i]);
        for (uint32_t x = low[0]; x <= high[0]; ++x)
            for (uint32_t y = low[1]; y <= high[1]; ++y)
                for (uint32_t z = low[2]; z <= high[2]; ++z)
                    if (x == low[0] || x == high[0] || y == low[1] || y == high[1] || z == low[2] || z == high[2]) set(x, y, z);
    }
};

}  // namespace obscura::test
