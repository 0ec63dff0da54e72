// A shot of a captured frame: reads EXR and JSON, uploads depth and normals in the formats that methods read.
#include <algorithm>
#include <cmath>

#include <unistd.h>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "app/complaint.h"
#include "measure/shot.h"
#include "scene/json_text.h"

namespace obscura::measure {

namespace fs = std::filesystem;
using app::Complaint;

namespace {

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, from.size(), to);
}

// readCapture() expects NAME.json beside NAME.capture.exr. For other names, links in a temporary folder have that form; error messages name
// the user's files.
class Linked {
public:
    Linked(const fs::path& exr, const fs::path& json) : m_exr(exr), m_json(json) {
        m_folder = fs::temp_directory_path() / fmt::format("obscura-capture.{}", ::getpid());
        fs::create_directories(m_folder);
        fs::create_symlink(fs::absolute(exr), m_folder / "frame.capture.exr");
        fs::create_symlink(fs::absolute(json), m_folder / "frame.json");
    }
    ~Linked() {
        std::error_code ignored;
        fs::remove_all(m_folder, ignored);
    }
    truth::CapturedFrame read() const {
        try {
            return truth::readCapture(m_folder / "frame");
        } catch (const scene::Error& error) {
            std::string line = error.what();
            replaceAll(line, (m_folder / "frame.capture.exr").string(), m_exr.string());
            replaceAll(line, (m_folder / "frame.json").string(), m_json.string());
            replaceAll(line, "frame.json", m_json.filename().string());
            throw scene::Error(line);
        }
    }

private:
    fs::path m_exr, m_json, m_folder;
};

void expectFile(const char* option, const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) throw Complaint(fmt::format("{} {}: no such file", option, file.string()));
}

// Same encoding as shaders/shared/octahedral.glsl.
uint32_t packNormal(glm::vec3 n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(sum > 0.0f)) return 0;
    n /= sum;
    const glm::vec2 folded = (1.0f - glm::abs(glm::vec2(n.y, n.x))) * glm::vec2(n.x >= 0.0f ? 1.0f : -1.0f, n.y >= 0.0f ? 1.0f : -1.0f);
    return glm::packSnorm2x16(n.z >= 0.0f ? glm::vec2(n) : folded);
}

// Depth and packed normals as images, and the frame's view for the library.
struct OnGpu {
    gpu::Image depth, normals;
    ao::Frame lens;
};

template <class T>
gpu::Image upload(gpu::Device& device, VkFormat format, const glm::uvec2& size, const char* name, const std::vector<T>& texels) {
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    gpu::Image image;
    gpu::Status status = gpu::Image::create(device, {format, size.x, size.y, 1, 1, usage}, name, image);
    if (status == gpu::Status::ok)
        status = gpu::upload(device, image, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    if (status != gpu::Status::ok)
        throw Complaint(
            fmt::format("{}: {} while uploading the captured frame", device.caps().deviceName, gpu::name(status)), app::kFailed);
    return image;
}

std::shared_ptr<OnGpu> onGpu(gpu::Device& device, const truth::CapturedFrame& frame) {
    auto result = std::make_shared<OnGpu>();
    std::vector<uint32_t> normals(frame.normals.size());
    for (size_t i = 0; i < normals.size(); ++i) normals[i] = packNormal(frame.normals[i]);
    result->depth = upload(device, VK_FORMAT_R32_SFLOAT, frame.size, "captured depth", frame.depth);
    result->normals = upload(device, VK_FORMAT_R32_UINT, frame.size, "captured normals", normals);
    result->lens.size = {frame.size.x, frame.size.y};
    result->lens.guard = {frame.guard.x, frame.guard.y};
    std::copy_n(glm::value_ptr(frame.projection), 16, result->lens.projection);
    result->lens.depthKind = ao::DepthKind::linear;
    result->lens.normalEncoding = ao::NormalEncoding::octahedral32;
    result->lens.skyDepth = frame.skyDepth;
    return result;
}

graph::ImageId import(graph::Graph& graph, const char* name, const gpu::Image& image) {
    graph::External external;
    external.image = image.handle();
    external.view = image.view();
    external.desc = image.desc();
    external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return graph.import(name, external);
}

}  // namespace

void captureShot(Machine& machine, const Measurement& what, const TakeShot& take) {
    const double begun = app::now();
    expectFile("--capture", what.capture);
    expectFile("--camera", what.captureCamera);
    Shot shot;
    shot.scene = scene::utf8(what.capture.stem().stem().string());
    shot.camera = "capture";
    shot.frame = Linked(what.capture, what.captureCamera).read();
    if (!shot.frame.hasNormals()) {
        shot.frame.reconstructNormals();
        shot.remark = "no normals in the capture: reconstructed from depth";
    }
    constexpr uint32_t kNotCaptured = ao::kMotion | ao::kLayers | ao::kVolume;
    for (const Candidate& candidate : what.candidates)
        if (ao::needs(candidate.values) & kNotCaptured & ~uint32_t(ao::kMotion))
            throw Complaint(
                fmt::format("--method {}: needs depth layers or a volume, which a captured frame does not have; measure it on a --scene",
                    candidate.label()));
    shot.library = &machine.library();
    const std::shared_ptr<OnGpu> images = onGpu(machine.device(), shot.frame);
    shot.add = [&library = machine.library(), images](
                   graph::Graph& graph, const Candidate& candidate, const ao::Falloff& falloff, uint32_t index) {
        ao::Frame lens = images->lens;
        lens.index = index;
        const ao::Sources sources{
            import(graph, "captured depth", images->depth), import(graph, "captured normals", images->normals), {}, true};
        if (index == 0) library.discardHistory();
        const ao::Library::Added drawn = library.add(graph, lens, sources, falloff, candidate.values);
        return candidate.values.bentNormals ? std::vector{drawn.visibility, drawn.bentNormals} : std::vector{drawn.visibility};
    };
    shot.seconds = (app::now() - begun) * 1e-3;
    take(shot);
}

void forEachShot(Machine& machine, const Measurement& what, const TakeShot& take) {
    what.capture.empty() ? sceneShots(machine, what, take) : captureShot(machine, what, take);
}

}  // namespace obscura::measure
