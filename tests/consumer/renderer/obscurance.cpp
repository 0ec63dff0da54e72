// Integration of Obscura into the renderer: creates the context, describes its frames, records.
#include "obscurance.h"

#include <algorithm>
#include <cstdio>

#include <obscura/ao.h>

namespace ao = obscura::ao;

Obscurance::Obscurance(const Renderer& renderer) {
    ao::DeviceDesc desc;
    desc.instance = renderer.instance;
    desc.physicalDevice = renderer.physicalDevice;
    desc.device = renderer.device;
    desc.queueFamily = renderer.queueFamily;
    desc.getInstanceProcAddr = vkGetInstanceProcAddr;
    desc.framesInFlight = Renderer::kFrames;
    desc.format = ao::VisibilityFormat::r8;
    desc.log = [](void*, ao::Severity, const char* line) { std::fprintf(stderr, "%s\n", line); };
    ao::create(desc, &m_context);
}

Obscurance::~Obscurance() { ao::destroy(m_context); }

bool Obscurance::use(const char* method) {
    ao::MethodSettings settings;
    settings.falloff = {ao::FalloffKind::quadratic, 1.0f};
    const ao::MethodInfo* info = ao::findMethod(method);
    settings.bentNormals = info && info->bentNormals;
    return ao::setMethod(m_context, method, settings) == ao::Result::ok;
}

uint64_t Obscurance::bytes() const { return ao::memoryUse(m_context); }

Obscurance::Picture Obscurance::record(VkCommandBuffer cmd, const Renderer& renderer) {
    ao::Frame frame;
    frame.size = renderer.size;
    frame.maxSize = largest;
    std::copy_n(renderer.camera.projection, 16, frame.projection);
    frame.depth = {renderer.depth, renderer.depthView, VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    frame.index = renderer.frame;
    const ao::Output output = ao::record(m_context, cmd, frame);
    if (output.status != ao::Result::ok) return {};
    return {output.image, output.layout, output.bentNormals};
}
