// `layered` against exact obscurance: beside an infinite wall, behind a pillar, behind a board that hides another.
#include "layered/fixture.h"

namespace obscura::test {
namespace {

using Kind = Solid::Kind;
constexpr const char* kRamp = "ramp:0.385:1";

// Obscurance of a floor point `a` metres from an infinite wall: the cosine-weighted mean of rho(a / d_x).
double exactAtWall(double a) {
    ao::Falloff rho;
    ao::parseFalloff(kRamp, rho);
    const int n = 1000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double across = std::cos((i + 0.5) / n * 3.14159265358979 - 1.570796326794897) * std::sqrt((j + 0.5) / n);
            sum += ao::evaluate(rho, float(a / across));
        }
    return sum / (2.0 * n * n);
}

TEST_F(LayeredTest, infiniteWallMatchesTheExactValueAtEveryDistance) {
    // Check of the integral against independently computed values.
    for (const auto& [a, exact] : {std::pair{0.10, 0.4017}, {0.25, 0.2610}, {0.50, 0.0845}, {0.75, 0.0133}})
        EXPECT_NEAR(exactAtWall(a), exact, 5e-4);
    const Room room = frameOf(floorAndWall(), 384, 216, 32);
    for (const auto& [changes, preset, tolerance] :
        {std::tuple{Changes{{"steps", 4}, {"slices", 16}, {"interleave", 3}, {"map", 1}}, "default", 0.012},
            {Changes{{"steps", 9}, {"slices", 16}, {"interleave", 3}, {"map", 1}}, "default", 0.011}, {Changes{}, "reference", 0.004}}) {
        const Picture picture = run(room, values(changes, preset), kRamp);
        // Row by row. Samples interleaved over 4x4 pixels are compared with the exact mean over the gathered rows.
        std::vector<double> found, exact, distance;
        for (uint32_t y = 0; y < room.visibleHeight(); ++y) {
            const size_t i = size_t(y + room.guard) * room.width + room.width / 2;
            const double a = 5.0 - room.depth[i];
            if (room.normals[4 * i + 1] < 0.5f || a > 1.5) continue;
            double sum = 0.0;
            for (uint32_t x = room.visibleWidth() / 4; x < 3 * room.visibleWidth() / 4; ++x)
                sum += picture[size_t(y) * room.visibleWidth() + x];
            found.push_back(sum / (room.visibleWidth() / 2));
            exact.push_back(exactAtWall(a));
            distance.push_back(a);
        }
        const int reach = std::string(preset) == "reference" ? 0 : 2;
        int compared = 0;
        for (int row = reach; row + reach < int(found.size()); ++row) {
            double sum = 0.0, weights = 0.0;
            for (int k = -reach; k <= reach; ++k) {
                const double w = std::abs(k) == 2 ? 0.5 : 1.0;
                sum += w * exact[size_t(row + k)];
                weights += w;
            }
            if (distance[size_t(row)] < 0.08 || distance[size_t(row)] > 1.1) continue;
            EXPECT_NEAR(found[size_t(row)], sum / weights, tolerance) << distance[size_t(row)] << " m from the wall, " << preset;
            ++compared;
        }
        EXPECT_GT(compared, 8);
    }
}

// Error and bias on surfaces with a normal along `axis`, at every third pixel on both axes where `judged` holds.
struct Errors {
    double eA = 0.0, bias = 0.0, reference = 0.0;
};
Errors facing(int axis, bool (*judged)(const glm::vec3&), const Room& room, const Picture& picture, const std::vector<Solid>& world) {
    glm::vec3 n(0);
    n[axis] = 1.0f;
    ao::Falloff rho;
    ao::parseFalloff(kRamp, rho);
    Errors result;
    int count = 0;
    for (uint32_t y = 0; y < room.visibleHeight(); y += 3)
        for (uint32_t x = 0; x < room.visibleWidth(); x += 3) {
            const glm::vec3 p = pointAt(room, x + room.guard, y + room.guard);
            const size_t i = size_t(y + room.guard) * room.width + x + room.guard;
            if (room.normals[4 * i + size_t(axis)] < 0.9f || !judged(p)) continue;
            const double exact = worldObscurance(world, p, n, rho, 2000),
                         off = double(picture[size_t(y) * room.visibleWidth() + x]) - exact;
            result.eA += std::abs(off);
            result.bias += off;
            result.reference += exact;
            ++count;
        }
    EXPECT_GT(count, 60);
    result.eA /= count;
    result.bias /= count;
    result.reference /= count;
    return result;
}
Errors onWall(const Room& room, const Picture& picture, const std::vector<Solid>& world) {
    return facing(2, [](const glm::vec3& p) { return p.z < -7.99f && std::abs(p.x) < 0.8f && std::abs(p.y) < 0.8f; }, room, picture, world);
}

TEST_F(LayeredTest, pillarMatchesTheReferenceOnTheWallBehind) {
    const std::vector<Solid> world = {{Kind::plane, {0, 0, -8}, {0, 0, 1}}, {Kind::cylinder, {0, 0, -7.4f}, {0.1f, 0, 0}}};
    const Room room = frameOf(world, 512, 296, 32);
    const Errors layered = onWall(room, run(room, values({}, "ultra"), kRamp), world);
    const Errors endless = onWall(room, run(room, values({{"depth_layers", 0}, {"thickness", 1000}}, "ultra"), kRamp), world);
    EXPECT_NEAR(layered.reference, 0.0412, 0.006);
    EXPECT_LT(layered.eA, 0.010);
    EXPECT_LT(std::abs(layered.bias), 0.010);
    EXPECT_GT(endless.bias, 0.03);
    const Room half = frameOf(world, 512, 296, 32, true);
    EXPECT_LT(onWall(half, run(half, values({}, "ultra"), kRamp), world).eA, 0.010);
}

TEST_F(LayeredTest, floorBetweenThinPostsHasLittleBias) {
    // Posts are a few px wide and strata dozens of px: a sample that hits a post represents most of those that miss it.
    std::vector<Solid> world = {{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}};
    for (int i = 0; i < 63; ++i)
        world.push_back({Kind::box, {-1.6f + 0.4f * float(i % 9) + 0.13f * float(i / 9 % 3), -1.2f, -2.8f - 0.4f * float(i / 9)},
            {0.015f, 0.3f, 0.015f}});
    const Room room = frameOf(world, 512, 296, 32);
    const auto between = [](const glm::vec3& p) { return p.y < -1.49f && std::abs(p.x) < 1.2f && p.z < -3.0f && p.z > -4.8f; };
    const Errors few = facing(1, between, room, run(room, values({}), kRamp), world),
                 many = facing(1, between, room, run(room, values({}, "reference"), kRamp), world);
    EXPECT_GT(few.reference, 0.09);
    printf("posts: reference %.4f, bias %+.4f, %+.4f\n", few.reference, few.bias, many.bias);
    EXPECT_LT(std::abs(few.bias), 0.025);
    EXPECT_LT(std::abs(many.bias), 0.01);
}

TEST_F(LayeredTest, moreSamplesReduceTheError) {
    const std::vector<Solid> world = {{Kind::plane, {0, 0, -8}, {0, 0, 1}}, {Kind::cylinder, {-0.4f, 0, -7.4f}, {0.1f, 0, 0}},
        {Kind::box, {0.5f, -0.3f, -7.8f}, {0.2f, 0.3f, 0.2f}}};
    const Room room = frameOf(world, 512, 296, 32);
    double before = 1.0;
    for (const auto& [slices, steps, side] : {std::tuple{1.0f, 2.0f, 3.0f}, {1.0f, 4.0f, 3.0f}, {1.0f, 9.0f, 3.0f}, {12.0f, 9.0f, 1.0f},
             {16.0f, 16.0f, 1.0f}, {16.0f, 32.0f, 0.0f}}) {
        const double error =
            onWall(room, run(room, values({{"slices", slices}, {"steps", steps}, {"interleave", side}, {"map", 1}}, "ultra"), kRamp), world)
                .eA;
        EXPECT_LT(error, before) << slices << " x " << steps;
        before = error;
    }
}

TEST_F(LayeredTest, depthLayersReduceTheErrorOfOtherMethods) {
    const std::vector<Solid> world = {{Kind::plane, {0, 0, -8}, {0, 0, 1}}, {Kind::cylinder, {0, 0, -7.4f}, {0.1f, 0, 0}}};
    const Room room = frameOf(world, 512, 296, 32);
    for (const auto& [method, preset] :
        {std::pair{"hbao", "default"}, {"horizon_split", "default"}, {"gtao", "default"}, {"gtao", "tuned"}}) {
        m_method = method;
        const Errors bare = onWall(room, run(room, values({}, preset), kRamp), world),
                     ended = onWall(room, run(room, values({{"depth_layers", 3}}, preset), kRamp), world);
        printf("%s %s: eA %.4f, bias %+.4f; with layers %.4f, %+.4f\n", method, preset, bare.eA, bare.bias, ended.eA, ended.bias);
        EXPECT_LT(ended.eA, 0.8 * bare.eA) << method << " " << preset;
        EXPECT_LT(std::abs(ended.bias), std::abs(bare.bias)) << method;
    }
}

TEST_F(LayeredTest, secondLayerShowsTheHiddenBoard) {
    // The second board is visible only in the second layer.
    const std::vector<Solid> world = {
        {Kind::plane, {0, 0, -8}, {0, 0, 1}}, {Kind::box, {0, 0, -6.6f}, {0.4f, 5, 0.05f}}, {Kind::box, {0, 0, -7.7f}, {0.5f, 5, 0.05f}}};
    const Room room = frameOf(world, 512, 296, 32);
    const Errors two = onWall(room, run(room, values({}, "reference"), kRamp), world),
                 one = onWall(room, run(room, values({{"depth_layers", 1}}, "reference"), kRamp), world);
    EXPECT_LT(two.eA, 0.3 * one.eA);
    EXPECT_LT(two.eA, 0.012);
    EXPECT_LT(one.bias, -0.02);
}

}  // namespace
}  // namespace obscura::test
