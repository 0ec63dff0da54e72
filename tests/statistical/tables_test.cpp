// Tables against sequential sums, bit by bit; windows against exact integrals; the function psi.
#include <random>

#include "statistical/fixture.h"

namespace obscura::test {
namespace {

// Random depths, a near stripe, some sky: cases that could overflow a sum or empty a layer.
Room rubble(uint32_t width, uint32_t height, float furthest) {
    Room room;
    room.width = width;
    room.height = height;
    room.guard = 3;
    room.build();
    std::mt19937 random(5);
    std::uniform_real_distribution<float> depths(1.0f, furthest);
    for (size_t i = 0; i < room.depth.size(); ++i) {
        const uint32_t x = uint32_t(i) % width;
        room.depth[i] = x / 8 % 5 == 0 ? 0.5f + 0.01f * float(x % 8) : random() % 16 == 0 ? 1e4f : depths(random);
    }
    return room;
}

// Summed-area table of the texels for which `counts` holds, in 64 bits.
template <class Counts>
std::vector<std::array<int64_t, 4>> tableOf(const std::vector<Texel>& texels, shared::uvec2 size, Counts counts) {
    std::vector<std::array<int64_t, 4>> table(size_t(size.x + 1) * (size.y + 1));
    for (uint32_t y = 0; y < size.y; ++y)
        for (uint32_t x = 0; x < size.x; ++x)
            for (int c = 0; c < 4; ++c) {
                const size_t i = size_t(y) * size.x + x, at = size_t(y + 1) * (size.x + 1) + x + 1, above = at - size.x - 1;
                table[at][c] = table[at - 1][c] + table[above][c] - table[above - 1][c] + (counts(i) ? int32_t(texels[i][c]) : 0);
            }
    return table;
}

TEST_F(TablesTest, everyLayerIsTheExactSumOfItsTexels) {
    for (const uint32_t side : {1u, 2u, 4u}) {
        const Room room = rubble(131, 77, 40.0f);
        const Tables t = tables(room, {0.6f, 1.2f, 20.0f, side}, 3);
        ASSERT_EQ(t.size.x, (131 + side - 1) / side);
        // Built layers, and layers that follow as differences: code, mask, table minus tables.
        struct Sum {
            const std::vector<Texel>* table;
            uint32_t layers, layer;
        };
        const Sum s0{&t.root, 1, 0}, s10{&t.levels[0], 1, 0}, s20{&t.levels[1], 2, 0}, s22{&t.levels[1], 2, 1};
        const Sum s30{&t.levels[2], 4, 0}, s32{&t.levels[2], 4, 1}, s34{&t.levels[2], 4, 2}, s36{&t.levels[2], 4, 3};
        const struct {
            uint32_t mask, code;
            std::vector<Sum> plus, minus;
        } layers[] = {{0, 0, {s0}, {}}, {1, 1, {s10}, {}}, {1, 0, {s0}, {s10}}, {3, 3, {s20}, {}}, {3, 1, {s10}, {s20}}, {3, 2, {s22}, {}},
            {3, 0, {s0}, {s10, s22}}, {7, 7, {s30}, {}}, {7, 3, {s20}, {s30}}, {7, 5, {s32}, {}}, {7, 1, {s10}, {s20, s32}},
            {7, 6, {s34}, {}}, {7, 2, {s22}, {s34}}, {7, 4, {s36}, {}}, {7, 0, {s0}, {s10, s22, s36}}};
        for (const auto& layer : layers) {
            size_t members = 0;
            const auto exact = tableOf(t.texels, t.size, [&](size_t i) { return (t.codes[i] & layer.mask) == layer.code; });
            for (const uint32_t code : t.codes) members += (code & layer.mask) == layer.code;
            if (side == 1) {
                EXPECT_GT(members, 0u) << "layer " << layer.code << " of mask " << layer.mask << " is empty";
            }
            for (size_t i = 0; i < exact.size(); ++i)
                for (int c = 0; c < 4; ++c) {
                    uint32_t sum = 0;
                    for (const Sum& s : layer.plus) sum += (*s.table)[i * s.layers + s.layer][c];
                    for (const Sum& s : layer.minus) sum -= (*s.table)[i * s.layers + s.layer][c];
                    ASSERT_EQ(sum, uint32_t(exact[i][c]))
                        << "layer " << layer.code << " of mask " << layer.mask << ", entry " << i << ", channel " << c;
                }
        }
    }
}

TEST_F(TablesTest, noWindowOverflows) {
    // Large windows over far coordinates: entries of the table wrap around, differences over a window must not.
    for (const uint32_t side : {1u, 2u}) {
        const Room room = rubble(400, 300, 900.0f);
        const shared::Box box{2.0f, 4.0f, 60.0f, side};
        const Tables t = tables(room, box, 0);
        EXPECT_EQ(t.nearest, 0.5f);
        const double reach = (60.0 + side) * 2.0, most = reach * reach * (double(t.coordinate) * t.units + 1.0);
        EXPECT_LT(most, 2147483648.0);
        EXPECT_GT(most, 2147483648.0 / 4.0) << "the range of 32 bits is not used";
        const auto exact = tableOf(t.texels, t.size, [](size_t) { return true; });
        const uint32_t w = t.size.x + 1, window = uint32_t(reach) / side;
        int64_t largest = 0, whole = 0;
        for (uint32_t y = 0; y + window <= t.size.y; ++y)
            for (uint32_t x = 0; x + window <= t.size.x; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](const auto& table, uint32_t px, uint32_t py) { return table[size_t(py) * w + px][c]; };
                    const int64_t sum =
                        at(exact, x + window, y + window) - at(exact, x, y + window) - at(exact, x + window, y) + at(exact, x, y);
                    const uint32_t modular =
                        at(t.root, x + window, y + window) - at(t.root, x, y + window) - at(t.root, x + window, y) + at(t.root, x, y);
                    ASSERT_EQ(sum, int32_t(modular));
                    largest = std::max(largest, std::abs(sum));
                }
        for (int c = 0; c < 3; ++c) whole = std::max(whole, std::abs(exact.back()[c]));
        EXPECT_GT(whole, int64_t(1) << 31) << "no entry wrapped around";
        EXPECT_GT(largest, int64_t(1) << 28);
    }
}

TEST_F(TablesTest, countsExcludeSky) {
    for (const uint32_t side : {1u, 2u, 4u}) {
        const Room room = rubble(75, 50, 20.0f);
        const Tables t = tables(room, {0.5f, 1.0f, 20.0f, side}, 0);
        for (uint32_t y = 0; y < t.size.y; ++y)
            for (uint32_t x = 0; x < t.size.x; ++x) {
                uint32_t count = 0;
                double z = 0.0;
                for (uint32_t v = y * side; v < std::min(y * side + side, room.height); ++v)
                    for (uint32_t u = x * side; u < std::min(x * side + side, room.width); ++u) {
                        const float depth = room.depth[size_t(v) * room.width + u];
                        if (depth >= 9000.0f) continue;
                        ++count;
                        z -= depth;
                    }
                const Texel& texel = t.texels[size_t(y) * t.size.x + x];
                ASSERT_EQ(texel[3], count);
                ASSERT_NEAR(int32_t(texel[2]) / t.units, z, (0.5 * count + 1.0) / t.units + 1e-5);
            }
    }
}

TEST_F(TablesTest, windowsOfAConstantDepthAreExact) {
    // A wall facing the camera: z is constant, window sizes are fractional.
    Room room;
    room.build();
    std::fill(room.depth.begin(), room.depth.end(), 4.0f);
    for (const float half : {0.103f, 0.251f, 0.577f}) {
        const Tables t = tables(room, {half, 1.0f, 40.0f, 1}, 0);
        const float pixels = half * 0.5f * float(room.visibleHeight()) / std::tan(0.5236f) / 4.0f;
        for (size_t i = 0; i < t.windows.size(); ++i) {
            const uint32_t x = uint32_t(i) % room.visibleWidth() + room.guard, y = uint32_t(i) / room.visibleWidth() + room.guard;
            const auto side = [&](uint32_t centre, uint32_t size) {
                return std::min(float(centre) + 0.5f + pixels, float(size)) - std::max(float(centre) + 0.5f - pixels, 0.0f);
            };
            const float area = side(x, room.width) * side(y, room.height);
            ASSERT_NEAR(t.windows[i][3], area, 1e-3f * area) << x << "," << y;
            ASSERT_NEAR(t.windows[i][2], 0.0f, 2e-5f) << x << "," << y;
        }
    }
}

class Tilted : public TablesTest, public testing::WithParamInterface<std::array<float, 3>> {};
INSTANTIATE_TEST_SUITE_P(Tables, Tilted,
    testing::Values(
        std::array{0.0f, 1.0f, 0.0f}, std::array{0.0f, 0.0f, 1.0f}, std::array{0.5f, 1.0f, 0.05f}, std::array{-0.7f, 0.1f, 0.7f}));

TEST_P(Tilted, meanHeightOverAPlaneIsZero) {
    const Room room = plane(GetParam(), 20.0f);
    for (const uint32_t side : {1u, 2u, 4u}) {
        const Tables t = tables(room, {0.75f, 1.5f, 20.0f, side}, 0);
        for (size_t i = 0; i < t.windows.size(); ++i) {
            const size_t at = (i / room.visibleWidth() + room.guard) * room.width + i % room.visibleWidth() + room.guard;
            if (room.depth[at] > 20.0f) continue;
            const auto& w = t.windows[i];
            const float height = w[0] * room.normals[4 * at] + w[1] * room.normals[4 * at + 1] + w[2] * room.normals[4 * at + 2];
            ASSERT_LT(std::abs(height), 1e-4f * 1.5f / 1.4f) << "pixel " << i;
        }
    }
}

TEST_F(TablesTest, psiRisesToOneAndFallsFourTimesAsFast) {
    gpu::Program psi;
    program("psi.comp",
        "#include \"ao/statistical/window.glsl\"\nlayout(local_size_x = 12) in;\n"
        "layout(binding = 0, std430) writeonly buffer Out { float to[]; };\n"
        "const float kHeights[12] = float[](-0.1, 0.0, 0.5, 1.0, 1.125, 1.25, 2.0, 0.25, 1.5, 2.0, 2.5, -9.0);\n"
        "void main() { uint i = gl_LocalInvocationID.x; to[i] = psi(kHeights[i], i < 8u ? 4.0 : 1.0); }\n",
        {}, psi);
    const gpu::Buffer to = back(48);
    m_device.nextFrame();
    m_graph.begin();
    m_graph.pass("psi", psi).write(m_graph.import("to", to, graph::Graph::Shared::written)).dispatch(1);
    ASSERT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(m_executor.execute(m_graph, cmd), gpu::Status::ok); }), gpu::Status::ok);
    const float expected[] = {0, 0, 0.5f, 1, 0.5f, 0, 0, 0.25f, 0.5f, 0, 0, 0};
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(reinterpret_cast<const float*>(to.mapped())[i], expected[i], 1e-6f) << i;
}

}  // namespace
}  // namespace obscura::test
