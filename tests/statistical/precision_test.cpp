// The windowed height in fixed point against double precision, on a captured frame: Sponza of the stored references, or the
// frame named by OBSCURA_FRAME.
#include <cstdlib>

#include "ao/oracle.h"
#include "statistical/fixture.h"

namespace obscura::test {
namespace {

namespace fs = std::filesystem;

truth::CapturedFrame frameOfRecord() {
    if (const char* named = std::getenv("OBSCURA_FRAME"); named && *named) return truth::readCapture(named);
    const fs::path stem = oracleFolder() / "sponza_a";
    if (!fs::exists(stem.string() + ".json"))
        skip("no " + stem.string() + ".json; set OBSCURA_ORACLE to the stored references or OBSCURA_FRAME to a captured frame");
    return truth::readCapture(stem);
}

TEST_F(TablesTest, windowedHeightsAreExactToHalfAMillimetre) {
    const truth::CapturedFrame captured = frameOfRecord();
    ao::Frame frame;
    const Room room = roomOf(captured, frame);
    const shared::View view = captured.view();
    const uint32_t w = room.width + 1;
    const auto position = [&](uint32_t x, uint32_t y) {
        const double z = room.depth[size_t(y) * room.width + x];
        return glm::dvec3((x + 0.5) * view.unproject.x + view.unproject.z, (y + 0.5) * view.unproject.y + view.unproject.w, -1.0) *
               glm::dvec3(z, z, z);
    };
    std::vector<glm::dvec4> table(size_t(w) * (room.height + 1), glm::dvec4(0.0));
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) {
            const size_t at = size_t(y + 1) * w + x + 1;
            const glm::dvec4 here = captured.isSky(captured.index(x, y)) ? glm::dvec4(0.0) : glm::dvec4(position(x, y), 1.0);
            table[at] = here + table[at - 1] + table[at - w] - table[at - w - 1];
        }
    for (const float half : {0.05f, 0.25f, 1.0f}) {
        const float largest = 0.25f * float(captured.visible().y);
        const Tables t = tables(room, frame, {half, 1.5f, largest, 1}, 0);
        double most = 0.0, sum = 0.0;
        size_t count = 0;
        for (uint32_t y = 0; y < captured.visible().y; ++y)
            for (uint32_t x = 0; x < captured.visible().x; ++x) {
                const uint32_t px = x + captured.guard.x, py = y + captured.guard.y;
                if (captured.isSky(captured.index(px, py))) continue;
                // The window in single precision, as in the shader, so that its edges agree.
                const float reach = std::clamp(half * view.pixelsPerMetre / room.depth[size_t(py) * room.width + px], 1.0f, largest);
                const auto sample = [&](float u, float v) {
                    u = std::clamp(u, 0.0f, float(room.width));
                    v = std::clamp(v, 0.0f, float(room.height));
                    const uint32_t i = std::min(uint32_t(u), room.width - 1), j = std::min(uint32_t(v), room.height - 1);
                    const double a = double(u) - i, b = double(v) - j;
                    const size_t at = size_t(j) * w + i;
                    return (table[at] * (1.0 - a) + table[at + 1] * a) * (1.0 - b) +
                           (table[at + w] * (1.0 - a) + table[at + w + 1] * a) * b;
                };
                const float u = float(px) + 0.5f, v = float(py) + 0.5f;
                const glm::dvec4 window = sample(u + reach, v + reach) - sample(u - reach, v + reach) - sample(u + reach, v - reach) +
                                          sample(u - reach, v - reach);
                const glm::dvec3 exact = glm::dvec3(window) / window.w - position(px, py), n = captured.normals[captured.index(px, py)];
                const auto& got = t.windows[size_t(y) * captured.visible().x + x];
                const double error = std::abs(glm::dot(glm::dvec3(got[0], got[1], got[2]) - exact, n));
                most = std::max(most, error);
                sum += error;
                ++count;
            }
        printf("%ux%u, r %.2f m: height error %.3f mm mean, %.3f mm maximum; 1/%g m, depths %.2f to %.2f m\n", captured.visible().x,
            captured.visible().y, double(half), 1e3 * sum / double(count), 1e3 * most, double(t.units), double(t.nearest),
            double(t.furthest));
        EXPECT_LE(most, 0.5e-3) << half;
    }
}

}  // namespace
}  // namespace obscura::test
