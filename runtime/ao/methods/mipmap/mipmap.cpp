// Mipmapped ambient obscurance, the baseline of the far-field paper [Timonen: Screen-Space Far-Field Ambient Obscurance, HPG 2013, sec. 5].
// Along K directions the depth pyramid is sampled trilinearly at distances that grow by a factor, from the level whose texels are as wide
// as the sector, and once more at the edge of the image. Estimator (with the paper's slabs) and table are far_field's; only the source of
// the points differs. Sky takes no part in depths; a texel covers that part of its sector which is not sky.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: pyramid (one a level), obscurance.
#include <algorithm>
#include <iterator>

#include "ao/falloff_table.h"
#include "ao/mipmap/constants.h"

namespace obscura::ao::mipmap {
namespace {

const Parameter kParameters[] = {
    {"directions", "", 4, 64, 16, true, {}, "Directions on the screen, K. Cost grows with them. Too few: bands."},
    {"factor", "", 1.1f, 3, 1.5f, false, {},
        "Length of each step relative to the one before. Larger costs less; too large: small distant occluders are missed."},
    {"nearest", "px", 0, 100, 0, false, {},
        "Samples nearer than this are left out: the far field alone, to compare with far_field without its near field, which begins at 1.5 "
        "intervals."},
    {"thickness", "m", 0, 100, 0, false, {},
        "Thickness of surfaces; 0: endless. Above 0 a texel of the pyramid is the nearest depth instead of the mean, from one level. Too "
        "low: light leaks through solid objects."},
    {"jitter", "", 0, 1, 0, false, {},
        "Random turn of the directions of each pixel, as a fraction of half a sector: noise instead of bands."},
};
const Setting kDense[] = {{"directions", 64}, {"factor", 1.2f}};
const Setting kThin[] = {{"thickness", 0.1f}, {"jitter", 1}};
const Preset kPresets[] = {
    {"default", "The paper's setting: 16 directions, each step 1.5 times the one before.", {}},
    {"dense", "64 directions, each step 1.2 times the one before: shows how slowly it converges.", {kDense, std::size(kDense)}},
    {"thin", "Surfaces 10 cm thick: nearest-depth mipmaps, jittered.", {kThin, std::size(kThin)}},
};
const MethodInfo kInfo{"mipmap", "Mipmapped ambient obscurance", "Timonen: Screen-Space Far-Field Ambient Obscurance, HPG 2013, section 5",
    "Distant samples from a depth pyramid. The method that the far-field paper compares with.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, true};

class Mipmap final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind) {
        auto result = std::make_unique<Mipmap>();
        if (FalloffTable::create(device, shaders, result->m_table) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/mipmap/base.comp", {}, result->m_base) != gpu::Status::ok) return nullptr;
        const auto make = [&](const char* name, const std::vector<gpu::Constant>& constants, gpu::Program& program) {
            return gpu::Program::compute(device, shaders, name, constants, program) == gpu::Status::ok;
        };
        for (uint32_t thin = 0; thin < 2; ++thin)
            if (!make("ao/mipmap/reduce.comp", {{0, thin}}, result->m_reduce[thin]) ||
                !make("ao/mipmap/obscurance.comp", {{0, thin}}, result->m_obscurance[thin]))
                return nullptr;
        if (!make("ao/mipmap/obscurance.comp", {{0, 0}, {1, 1}}, result->m_larger)) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const shared::View& view = inputs.view;
        uint32_t mips = 1;
        while (std::max(view.size.x, view.size.y) >> mips) ++mips;
        const graph::ImageId pyramid = graph.image("mipmap.pyramid", {VK_FORMAT_R32G32_SFLOAT, view.size.x, view.size.y, 1, mips});
        graph.pass("mipmap.base", m_base).read(inputs.viewBlock).read(inputs.depth).writeMip(pyramid, 0).dispatch(view.size.x, view.size.y);
        const uint32_t nearest = values["thickness"] > 0.0f;
        const auto sizeOf = [&](uint32_t mip) {
            return shared::sizeOf(std::max(view.size.x >> mip, 1u), std::max(view.size.y >> mip, 1u));
        };
        for (uint32_t mip = 1; mip < mips; ++mip)
            graph.pass("mipmap.reduce", m_reduce[nearest])
                .readMip(pyramid, mip - 1)
                .writeMip(pyramid, mip)
                .constants(shared::MipmapReduce{sizeOf(mip - 1), sizeOf(mip)})
                .dispatch(std::max(view.size.x >> mip, 1u), std::max(view.size.y >> mip, 1u));

        float at = 1.0f, step = 1.0f;
        while (at < values["nearest"]) at += step *= values["factor"];
        const shared::MipmapObscurance constants{
            values.count("directions"), values["factor"], inputs.falloffDesc.length, values["thickness"], values["jitter"], at, step, mips};
        const graph::ImageId table = m_table.add(graph, inputs, "mipmap.table");
        const graph::ImageId visibility = graph.image("mipmap.visibility", {VK_FORMAT_R16_SFLOAT, view.visible.x, view.visible.y});
        const bool larger = !nearest && !(graph.made(pyramid) == graph.desc(pyramid));
        graph.pass("mipmap.obscurance", larger ? m_larger : m_obscurance[nearest])
            .read(inputs.viewBlock)
            .read(inputs.normals)
            .read(pyramid, graph::Sampling::linear)
            .read(table)
            .write(visibility)
            .constants(constants)
            .dispatch(view.visible.x, view.visible.y);
        return visibility;
    }

    Blocking blocking(const Inputs&, const Values& values) const override {
        return {Blocking::kEndless, values["thickness"] > 0.0f ? values["thickness"] : Blocking::kEndless};
    }

private:
    FalloffTable m_table;
    gpu::Program m_base, m_reduce[2], m_obscurance[2];  // endless, thin
    gpu::Program m_larger;                              // m_obscurance[0] where the pyramid's image is larger than the view
};

}  // namespace

MethodEntry entry() { return {.info = &kInfo, .create = &Mipmap::create, .perFalloff = false}; }

}  // namespace obscura::ao::mipmap
