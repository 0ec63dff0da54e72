// Multi-resolution ambient occlusion [Hoang and Low: Efficient Screen-Space Approach to High-Quality Multi-Scale Ambient
// Occlusion, The Visual Computer 2012]. Depth and normals are halved level by level. Each level samples a few texels around each texel:
// coarse levels find distant occluders, fine ones creases. Levels are combined from the coarsest to the finest:
//     c1 = max(own mean, far c1)   c2 = own sum + far c2   c3 = own number + far c3                    [eq. 10]
//     A = 1 - (1 - c1) (1 - c2 / c3)                                                                   [eq. 11]
// where "far" is the next coarser level, filtered and upsampled by a joint bilateral filter.
//
// Differences, some where the paper is incomplete:
// - Radii follow its text: the finest level has the whole projected reach [eq. 5 halves it]; `first_radius` 0.5 is eq. 5.
// - Bilateral weights are normalised [not in table 4]. Lengths are in reaches of the falloff, so the method works at any scale;
//   tolerance and threshold are 1 m at the paper's reach of 2 m.
// - Patterns are symmetric about the pixel, and it is not its own sample, at any radius. The paper's -R, -R + 2, ... is only if R is odd.
// - Levels keep depth, not positions: the chosen texel's depth is moved along its tangent plane to the middle of its block.
// - The falloff is the shared type; the paper's own is quadratic.
// Extensions (not in the preset `paper`): samples have the weight of their squared cosine, the fraction of the hemisphere below
// them, so that low neighbours do not hide high occluders; obscurance has a direction, so that coarse levels follow the normals of
// fine ones; the bilateral filter compares tangent planes.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes, as in the paper's
// table 7: downsample (n-1 times), sample (n), filter and upsample (n-1 each). The sample passes depend only on their own level, so a
// GPU can overlap them. `interleave` interleaves the samples of the finest level.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "ao/interleave.h"
#include "ao/multi_resolution/constants.h"

namespace obscura::ao::multi_resolution {
namespace {

constexpr float kDiskPoints = 16, kSquarePoints = 36;  // maximum per pixel, see sample.glsl
const char* const kPatterns[] = {"squares", "disk at the finest", "disks"};
enum : uint32_t { kMean, kDirected };
const char* const kEstimates[] = {"mean cosine", "directed"};
const char* const kEdges[] = {"depth", "plane"};
const Parameter kParameters[] = {
    {"levels", "", 2, 6, 5, true, {},
        "Number of resolutions, n. Each more doubles how far samples reach and costs a quarter of the one before. Too few: wide occlusion "
        "is lost."},
    {"max_radius", "texels", 1, 16, 7, false, {},
        "Longest sample distance within a level, r_max. Above the paper's 5 the same samples lie farther apart and small occluders are "
        "missed; too low: wide occlusion is lost."},
    {"first_radius", "", 0.25f, 2, 1, false, {},
        "Sample radius of the finest level, as a fraction of the falloff's projected reach; in texels it halves from level to level. 0.5 "
        "is the paper's equation 5. Too low: distant occluders are missed."},
    {"pattern", "", 0, 2, 1, true, {kPatterns, 3},
        "Sample pattern: up to 36 texels of a square, or 16 points on a disk, on the finest level as in the paper or on all levels. "
        "Squares cost more; disks miss small occluders."},
    kInterleave,
    {"obscurance", "", 0, 1, 1, true, {kEstimates, 2},
        "What samples add up to: a mean of cosines, as in the paper, or squared cosines with a direction, which finer levels evaluate "
        "along their own normals. Directed costs one more image a level."},
    {"gain", "", 0, 4, 1.7f, false, {}, "Factor on the obscurance of each level. Too low: too bright; too high: creases turn black."},
    {"threshold", "R", 0, 1000, 0.05f, false, {},
        "A coarser texel is the median of four if they lie within this many reaches of each other, else the second nearest. 0: always the "
        "second nearest. Too high: foreground and background mix at edges."},
    {"edges", "", 0, 1, 1, true, {kEdges, 2},
        "How the bilateral filter separates surfaces: by depth, as in the paper, or by distance from the tangent plane. By depth: slanted "
        "floors break up."},
    {"tolerance", "R", 0.001f, 1000, 0.1f, false, {},
        "Distance, in reaches, at which the bilateral filter takes two texels for different surfaces. Too low: blocks of coarse texels "
        "show; too high: occlusion bleeds across edges."},
};
const Setting kPaper[] = {{"levels", 4}, {"max_radius", 5}, {"obscurance", kMean}, {"gain", 1}, {"threshold", 0.5f}, {"edges", 0},
    {"tolerance", 0.5f}, {"temporal", 0.5f}, {"temporal_clip", 0}};
const Setting kFast[] = {{"levels", 3}, {"pattern", 2}};
const Setting kQuality[] = {{"pattern", 0}, {"gain", 1.8f}};
const Preset kPresets[] = {
    {"default", "5 levels, directed obscurance; tuned on Sponza, the atrium, the dragon and the toasters.", {}},
    {"paper", "As published: 4 levels, r_max 5, 16 points on the finest, history weight 0.5 if there are motion vectors.",
        {kPaper, std::size(kPaper)}},
    {"fast", "3 levels, 16 samples each: creases and contact shadows only.", {kFast, std::size(kFast)}},
    {"quality", "5 levels, up to 36 samples on each.", {kQuality, std::size(kQuality)}},
};
const MethodInfo kInfo{"multi_resolution", "Multi-resolution ambient occlusion",
    "Hoang, Low: Efficient Screen-Space Approach to High-Quality Multi-Scale Ambient Occlusion, The Visual Computer 2012",
    "A few samples at each of several resolutions, combined from coarse to fine. No noise.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}};

struct Obscurance {                      // see levels.glsl
    graph::ImageId numbers, directions;  // R32UI; without directions their image is one texel
};

struct Level {
    graph::ImageId depth, normals;
    Obscurance obscurance;
    shared::ivec2 size, origin, area;  // texels; obscurance is known in the area
    float texel;                       // px
};

// The next coarser level. Its area is what upsampling the finer level's area reads, plus one texel for the filter.
Level coarser(const Level& fine) {
    Level result{{}, {}, {}, {(fine.size.x + 1) / 2, (fine.size.y + 1) / 2}, {}, {}, fine.texel * 2.0f};
    const auto cover = [](int32_t size, int32_t origin, int32_t area, int32_t& coarseOrigin, int32_t& coarseArea) {
        coarseOrigin = std::max((origin + 1) / 2 - 2, 0);
        coarseArea = std::min((origin + area) / 2 + 2, size) - coarseOrigin;
    };
    cover(result.size.x, fine.origin.x, fine.area.x, result.origin.x, result.area.x);
    cover(result.size.y, fine.origin.y, fine.area.y, result.origin.y, result.area.y);
    return result;
}

class MultiResolution final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<MultiResolution>();
        const auto make = [&](const char* name, std::initializer_list<gpu::Constant> constants, gpu::Program& out) {
            return gpu::Program::compute(device, shaders, name, constants, out) == gpu::Status::ok;
        };
        bool made = make("ao/multi_resolution/downsample.comp", {}, result->m_downsample);
        for (const uint32_t directed : {0u, 1u}) {
            Programs& programs = result->m_programs[directed];
            made = made && make("ao/multi_resolution/sample.comp", {{0, directed}, falloffConstant(falloff)}, programs.sample) &&
                   make("ao/multi_resolution/filter.comp", {{0, directed}}, programs.filter) &&
                   make("ao/multi_resolution/combine.comp", {{0, directed}}, programs.combine) &&
                   make("ao/multi_resolution/finish.comp", {{0, directed}}, programs.finish) &&
                   make("ao/multi_resolution/sample_shared.comp", {{0, directed}, falloffConstant(falloff)}, programs.sampleShared) &&
                   make("ao/multi_resolution/finish.comp:GATHERED", {{0, directed}}, programs.finishGathered);
        }
        made = made && Gather::create(device, shaders, result->m_gather) == Status::ok;
        return made ? std::move(result) : nullptr;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const shared::View& view = inputs.view;
        const float reach = inputs.falloff.reach, perTolerance = 1.0f / (values["tolerance"] * reach);
        const float columns = std::abs(view.project.x) / view.pixelsPerMetre;
        const uint32_t planes = values.count("edges"), side = tileSide(values);
        const bool directed = values.count("obscurance") == kDirected;
        Programs& programs = m_programs[directed];
        std::vector<Level> levels{{inputs.depth, inputs.normals, {}, {int32_t(view.size.x), int32_t(view.size.y)},
            {int32_t(view.guard.x), int32_t(view.guard.y)}, {int32_t(view.visible.x), int32_t(view.visible.y)}, 1.0f}};
        while (levels.size() < values.count("levels"))
            levels.push_back(downsample(graph, inputs, levels.back(), values["threshold"] * reach));

        for (size_t i = levels.size(); i-- > 0;) {
            Level& level = levels[i];
            const bool isShared = i == 0 && side > 1;
            const shared::MultiResolutionSample constants{inputs.falloff, level.size, level.origin, level.area, level.texel,
                values["first_radius"], values["max_radius"], values["gain"], values.count("pattern") > (i ? 1u : 0u), isShared ? side : 1,
                columns, 2.5f / std::max(columns, 1.0f)};
            if (isShared) {
                const graph::ImageId shares =
                    graph.image("multi_resolution.shares", {VK_FORMAT_R16G16_SFLOAT, view.visible.x, view.visible.y});
                graph.pass(named("sample", level), programs.sampleShared)
                    .read(inputs.viewBlock)
                    .read(level.depth)
                    .read(level.normals)
                    .write(shares)
                    .constants(constants)
                    .dispatch(view.visible.x, view.visible.y);
                const graph::ImageId open = allOpen(graph, {view.visible.x, view.visible.y}, "multi_resolution.open");
                level.obscurance.numbers = m_gather.add(graph, inputs, shares, side, open);
                continue;
            }
            level.obscurance = obscurance(graph, "near", level, directed && i > 0);
            graph.pass(named("sample", level), programs.sample)
                .read(inputs.viewBlock)
                .read(level.depth)
                .read(level.normals)
                .write(level.obscurance.numbers)
                .write(level.obscurance.directions)
                .constants(constants)
                .dispatch(uint32_t(level.area.x), uint32_t(level.area.y));
        }
        graph::ImageId visibility;
        for (size_t i = levels.size() - 1; i-- > 0;) {
            Level &fine = levels[i], &coarse = levels[i + 1];
            const Obscurance filtered = obscurance(graph, "filtered", coarse, directed);
            graph.pass(named("filter", coarse), programs.filter)
                .read(inputs.viewBlock)
                .read(coarse.depth)
                .read(coarse.normals)
                .read(coarse.obscurance.numbers)
                .read(coarse.obscurance.directions)
                .write(filtered.numbers)
                .write(filtered.directions)
                .constants(shared::MultiResolutionFilter{coarse.origin, coarse.area, coarse.texel, perTolerance, planes})
                .dispatch(uint32_t(coarse.area.x), uint32_t(coarse.area.y));
            graph::Pass& upsample = graph.pass(named("upsample", fine), i          ? programs.combine
                                                                        : side > 1 ? programs.finishGathered
                                                                                   : programs.finish);
            upsample.read(inputs.viewBlock)
                .read(fine.depth)
                .read(fine.normals)
                .read(fine.obscurance.numbers)
                .read(coarse.depth)
                .read(coarse.normals)
                .read(filtered.numbers)
                .read(filtered.directions);
            if (i) {
                const Obscurance joined = obscurance(graph, "joined", fine, directed);
                upsample.read(fine.obscurance.directions).write(joined.numbers).write(joined.directions);
                fine.obscurance = joined;
            } else {
                visibility = graph.image("multi_resolution.visibility", {VK_FORMAT_R16_SFLOAT, view.visible.x, view.visible.y});
                upsample.write(visibility);
            }
            upsample
                .constants(shared::MultiResolutionUpsample{fine.origin, fine.area, coarse.origin, coarse.area, fine.texel, perTolerance,
                    planes, values.count("pattern") > 0 ? kDiskPoints : kSquarePoints})
                .dispatch(uint32_t(fine.area.x), uint32_t(fine.area.y));
        }
        return visibility;
    }

private:
    struct Programs {
        gpu::Program sample, filter, combine, finish, sampleShared, finishGathered;
    };

    static std::string named(const char* name, const Level& level) {
        return std::string("multi_resolution.") + name + " 1/" + std::to_string(int(level.texel));
    }

    static Obscurance obscurance(graph::Graph& graph, const char* name, const Level& level, bool directed) {
        const uint32_t width = uint32_t(level.area.x), height = uint32_t(level.area.y);
        return {graph.image(named(name, level), {VK_FORMAT_R32_UINT, width, height}),
            graph.image(named(name, level) + " directions", {VK_FORMAT_R32_UINT, directed ? width : 1, directed ? height : 1})};
    }

    Level downsample(graph::Graph& graph, const Inputs& inputs, const Level& fine, float threshold) {
        Level result = coarser(fine);
        const uint32_t width = uint32_t(result.size.x), height = uint32_t(result.size.y);
        result.depth = graph.image(named("depth", result), {VK_FORMAT_R32_SFLOAT, width, height});
        result.normals = graph.image(named("normals", result), {VK_FORMAT_R32_UINT, width, height});
        graph.pass(named("downsample", result), m_downsample)
            .read(inputs.viewBlock)
            .read(fine.depth)
            .read(fine.normals)
            .write(result.depth)
            .write(result.normals)
            .constants(shared::MultiResolutionDownsample{fine.size, result.size, fine.texel, threshold})
            .dispatch(width, height);
        return result;
    }

    gpu::Program m_downsample;
    Programs m_programs[2];  // [directed]
    Gather m_gather;
};

}  // namespace

MethodEntry entry() { return {&kInfo, &MultiResolution::create}; }

}  // namespace obscura::ao::multi_resolution
