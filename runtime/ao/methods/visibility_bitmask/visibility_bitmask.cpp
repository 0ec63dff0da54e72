// Visibility bitmask [Therrien, Levesque, Gilet: Screen Space Indirect Lighting with Visibility Bitmask, 2023], as used by engines after
// GTAO; a baseline method. Slices of the hemisphere through the view ray are GTAO's (gtao.cpp), but instead of two horizons a slice has 32
// sectors of equal angle about the normal, and every surface is `thickness` thick: a sample at d from the pixel covers the sectors from the
// angle of d to that of d - thickness v, so that light passes behind thin objects.
//     A = 1/N sum over slices of 1/32 * sum over covered sectors of rho(d of the first sample that covered it)
// The published sum has no falloff; the falloff `constant` reproduces it. A sector that is touched is covered, as published.
//
// `sectors` equal weight extends this, off by default: sectors have equal cosine-weighted solid angle, as in the definition of obscurance
// (equal angles weight the horizon too much), coverage is rounded, and samples in the tangent plane are left out. `axis` spaces slices
// evenly around the view ray.
//
// Bent normals: newly covered sectors count with the mean direction between the sample's front and back.
//
// Samples, noise, depth levels and denoiser are XeGTAO's, as in engines. Reads linear depth and normals, guard band
// included; writes visibility of the visible part. Passes: depths, sectors, denoise twice.
#include <iterator>

#include "ao/denoise.h"
#include "ao/depth_mips.h"
#include "ao/edge_blur.h"
#include "ao/slices.h"
#include "ao/visibility_bitmask/constants.h"

namespace obscura::ao::visibility_bitmask {
namespace {

const char* const kSectors[] = {"equal angle", "equal weight"};
const Parameter kParameters[] = {
    kSlices,
    kSliceSteps,
    {"thickness", "m", 0.001f, 1000, 0.25f, false, {},
        "Assumed thickness of everything. Too low: light leaks through solid objects; too high: dark halos around foreground objects."},
    {"sectors", "", 0, 1, 0, true, {kSectors, 2},
        "What the 32 sectors of a slice divide evenly: its angle, as published, or its cosine-weighted solid angle. Equal angles count "
        "occluders near the horizon too much."},
    kSliceAxis,
    kSliceMipOffset,
    kSliceDenoise,
};
const Setting kFilament[] = {{"slices", 4}, {"thickness", 0.5f}};
const Setting kTuned[] = {
    {"slices", 1}, {"steps", 9}, {"thickness", 0.5f}, {"sectors", 1}, {"axis", 1}, {"denoise", float(SliceBlur::surface)}};
const Setting kLow[] = {{"slices", 1}, {"steps", 2}};
const Setting kMedium[] = {{"slices", 2}, {"steps", 2}};
const Setting kUltra[] = {{"slices", 9}};
const Preset kPresets[] = {
    {"default", "3 slices x 3 steps per side, surfaces 0.25 m thick: Bevy's high.", {}},
    {"low", "1 slice x 2 steps: Bevy's low.", {kLow, std::size(kLow)}},
    {"medium", "2 slices x 2 steps: Bevy's medium.", {kMedium, std::size(kMedium)}},
    {"ultra", "9 slices x 3 steps: Bevy's ultra.", {kUltra, std::size(kUltra)}},
    {"filament", "4 slices x 3 steps, surfaces 0.5 m thick, as in Filament.", {kFilament, std::size(kFilament)}},
    {"tuned", "1 slice x 9 steps, surfaces 0.5 m thick, sectors of equal weight, slices around the view ray.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"visibility_bitmask", "Visibility bitmask",
    "Therrien, Levesque, Gilet: Screen Space Indirect Lighting with Visibility Bitmask, 2023",
    "A bitmask of 32 sectors for each slice through the view ray; samples of constant thickness cover sectors.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, true, true};

class VisibilityBitmask final : public Method {
public:
    template <bool bent> static std::unique_ptr<Method> create(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<VisibilityBitmask>();
        for (uint32_t cosine = 0; cosine < 2; ++cosine)
            if (gpu::Program::compute(device, shaders,
                    bent ? "ao/visibility_bitmask/sectors.comp:BENT" : "ao/visibility_bitmask/sectors.comp",
                    {{0, cosine}, falloffConstant(falloff)}, result->m_sectors[cosine]) != gpu::Status::ok)
                return nullptr;
        if (DepthMips::create(device, shaders, DepthMips::Filter::farthest, result->m_depths) != Status::ok) return nullptr;
        if (EdgeBlur::create(device, shaders, result->m_edgeBlur) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const shared::VisibilityBitmaskSectors constants{
            inputs.falloff, values.count("slices"), values.count("steps"), values["thickness"], values["mip_offset"], values.count("axis")};
        const graph::ImageId depths = m_depths.add(graph, inputs, "visibility_bitmask.depths", inputs.falloff.reach);
        const graph::ImageId noisy = graph.image("visibility_bitmask.visibility and edges", {VK_FORMAT_R32_UINT, visible.x, visible.y});
        const auto blur = SliceBlur(values.count("denoise"));
        RawBentNormals bent;
        graph::Pass& pass = graph.pass("visibility_bitmask.sectors", m_sectors[values.count("sectors")]);
        pass.read(inputs.viewBlock).read(inputs.normals).read(depths).write(noisy);
        if (values.bentNormals) pass.write((bent = sliceBent(graph, inputs, "visibility_bitmask.bent", blur)).image);
        pass.constants(constants).dispatch(visible.x, visible.y);

        const graph::ImageId visibility = m_edgeBlur.add(graph, noisy, blur == SliceBlur::edges, "visibility_bitmask.denoise");
        return {blur == SliceBlur::surface ? m_denoise.add(graph, inputs, visibility, "visibility_bitmask.blur") : visibility, bent};
    }

    // Rays farther behind a sample than its thickness have not been counted.
    Blocking blocking(const Inputs& inputs, const Values& values) const override { return {inputs.falloff.reach, values["thickness"]}; }

private:
    DepthMips m_depths;
    gpu::Program m_sectors[2];  // of equal angle, of equal weight
    EdgeBlur m_edgeBlur;
    Denoise m_denoise;
};

}  // namespace

MethodEntry entry() { return {&kInfo, &VisibilityBitmask::create<false>, &VisibilityBitmask::create<true>}; }

}  // namespace obscura::ao::visibility_bitmask
