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

// Compares sums over windows with exact ones. Returns the largest, and the largest entry of the whole table.
std::pair<int64_t, int64_t> largestSums(
    const std::vector<Texel>& root, const std::vector<Texel>& texels, shared::uvec2 size, uint32_t window) {
    const auto exact = tableOf(texels, size, [](size_t) { return true; });
    const uint32_t w = size.x + 1;
    int64_t largest = 0, whole = 0;
    for (uint32_t y = 0; y + window <= size.y; ++y)
        for (uint32_t x = 0; x + window <= size.x; ++x)
            for (int c = 0; c < 3; ++c) {
                const auto at = [&](const auto& table, uint32_t px, uint32_t py) { return table[size_t(py) * w + px][c]; };
                const int64_t sum =
                    at(exact, x + window, y + window) - at(exact, x, y + window) - at(exact, x + window, y) + at(exact, x, y);
                const uint32_t modular =
                    at(root, x + window, y + window) - at(root, x, y + window) - at(root, x + window, y) + at(root, x, y);
                EXPECT_EQ(sum, int32_t(modular)) << x << ", " << y;
                largest = std::max(largest, std::abs(sum));
            }
    for (int c = 0; c < 3; ++c) whole = std::max(whole, std::abs(exact.back()[c]));
    return {largest, whole};
}

TEST_F(TablesTest, noWindowOverflows) {
    // Large windows over far coordinates: entries of the table wrap around, differences over a window must not.
    for (const uint32_t side : {1u, 2u}) {
        const Room room = rubble(400, 300, 900.0f);
        const shared::Box box{2.0f, 4.0f, 60.0f, side};
        const Tables t = tables(room, box, 0);
        EXPECT_EQ(t.nearest, 0.5f);
        const double reach = (60.0 + side) * 2.0, most = reach * reach * (double(std::max(t.coordinate, t.furthest)) * t.units + 1.0);
        EXPECT_LT(most, 2147483648.0);
        EXPECT_GT(most, 2147483648.0 / 4.0) << "the range of 32 bits is not used";
        const auto [largest, whole] = largestSums(t.root, t.texels, t.size, uint32_t(reach) / side);
        EXPECT_GT(whole, int64_t(1) << 31) << "no entry wrapped around";
        EXPECT_GT(largest, int64_t(1) << 28);
    }
}

// Few far pixels, together in one corner: what all coordinates add up to bounds the sums.
TEST_F(TablesTest, fewFarPixelsKeepTheUnitsSmall) {
    Room near = rubble(400, 300, 20.0f), room = near;
    for (uint32_t y = 0; y < 10; ++y)
        for (uint32_t x = 0; x < 10; ++x) room.depth[y * room.width + x] = 9000.0f - float(x + y);
    ao::Frame frame = room.frame();
    frame.skyDepth = 9500.0f;
    for (const uint32_t side : {1u, 2u}) {
        const shared::Box box{2.0f, 4.0f, 60.0f, side};
        const Tables t = tables(room, frame, box, 0);
        EXPECT_EQ(t.furthest, 9000.0f);
        EXPECT_GE(t.units, tables(near, frame, box, 0).units / 8.0f) << "9000 m by the largest window alone: / 512";
        const auto [largest, whole] = largestSums(t.root, t.texels, t.size, 122 / side);
        EXPECT_GT(largest, int64_t(1) << 27);
        EXPECT_LT(whole, int64_t(1) << 31);
    }
}

// Beyond the limit surfaces are as sky: in the tables, and as receivers.
TEST_F(TablesTest, surfacesBeyondTheLimitAreNotCounted) {
    Room room;
    room.build();
    std::fill(room.depth.begin(), room.depth.end(), 4.0f);
    const shared::Box box{0.5f, 1.0f, 20.0f, 1};
    const float limit = 2147483000.0f / (42.0f * 42.0f) * box.height / 4.0f;
    ao::Frame frame = room.frame();
    frame.skyDepth = 1e8f;
    for (const float beyond : {0.9f, 1.1f}) {
        room.depth[room.width * 40 + 50] = beyond * limit;
        const Tables t = tables(room, frame, box, 0);
        EXPECT_EQ(t.texels[room.width * 40 + 50][3], beyond < 1.0f ? 1u : 0u);
        EXPECT_EQ(t.furthest, beyond < 1.0f ? 0.9f * limit : 4.0f);
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
                for (uint32_t v = y * side; v < y * side + side; ++v)
                    for (uint32_t u = x * side; u < x * side + side; ++u) {  // edge pixels are repeated
                        const float depth = room.depth[size_t(std::min(v, room.height - 1)) * room.width + std::min(u, room.width - 1)];
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

TEST_F(StatisticalTest, tablesThatShrinkAreLogged) {
    Room room;
    room.width = 1936;
    room.height = 1100;
    room.guard = 0;
    room.build();
    const gpu::Image depth = room.image(m_device, false), normals = room.image(m_device, true);
    const auto says = [&](Layering layering) {  // declares a frame
        const auto import = [&](const gpu::Image& image) {
            graph::External external{image.handle(), image.view(), image.desc()};
            external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            return m_graph->import("room", external);
        };
        logged().clear();
        m_graph->begin();
        ao::Frame frame = room.frame();
        frame.volume = {};
        ao::Sources sources;
        sources.depth = import(depth);
        sources.normals = import(normals);
        EXPECT_TRUE(bool(m_library->add(*m_graph, frame, sources, {}, values({{"layers", float(layering)}}, "quality")).visibility));
        return loggedContains("statistical: tables of full size do not fit this device's storage buffers");
    };
    EXPECT_FALSE(says(kFour));
    const bool tooLarge = ao::SummedArea::bytes({room.width, room.height}, 4) > m_device.caps().maxStorageRange;
    EXPECT_EQ(says(kEight), tooLarge);
    EXPECT_FALSE(says(kEight)) << "once is enough";
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
