#include "app/overlay.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

namespace obscura::app {
namespace {

// Dear ImGui's Vulkan back end, 1.86 to 1.91. From 1.90.3 on the render pass is a field of the description; from 1.90 on fonts are
// uploaded by a command buffer of its own.
template <class Info>
bool initBackEnd(Info& info, VkRenderPass renderPass) {
    if constexpr (requires { info.RenderPass; }) {
        info.RenderPass = renderPass;
        return ImGui_ImplVulkan_Init(&info);
    } else {
        return ImGui_ImplVulkan_Init(&info, renderPass);
    }
}

bool uploadFonts(gpu::Device& device) {
#if IMGUI_VERSION_NUM >= 19000
    return ImGui_ImplVulkan_CreateFontsTexture();
#else
    const bool done = device.runNow([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); }) == gpu::Status::ok;
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return done;
#endif
}

}  // namespace

std::unique_ptr<Overlay> Overlay::create(
    gpu::Device& device, Window& window, VkFormat format, std::optional<float> wantedScale, std::string& error) {
    const float ofHeight = std::floor(float(window.size().height) / 540.0f) * 0.5f;
    const float scale = wantedScale.value_or(std::max(window.scale(), ofHeight));
    std::unique_ptr<Overlay> overlay(new Overlay(device));
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // no imgui.ini
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 4.0f;
    style.FrameRounding = 2.0f;
    style.Colors[ImGuiCol_WindowBg].w = 0.86f;
    style.ScaleAllSizes(scale);
    ImFontConfig font;
    font.SizePixels = std::round(13.0f * scale);
    ImGui::GetIO().Fonts->AddFontDefault(&font);

    error = "Dear ImGui could not be initialised on this device";
    if (!overlay->loadApi() || !overlay->createObjects(format)) return nullptr;
    overlay->m_glfwReady = ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance();
    info.PhysicalDevice = device.physical();
    info.Device = device.handle();
    info.QueueFamily = device.queueFamily();
    info.Queue = device.queue();
    info.PipelineCache = device.pipelineCache();
    info.DescriptorPool = overlay->m_pool;
    info.MinImageCount = std::max(2u, device.framesInFlight());
    info.ImageCount = info.MinImageCount;  // sets of vertex buffers that the back end rotates
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.Allocator = device.allocator();
    overlay->m_vulkanReady = overlay->m_glfwReady && initBackEnd(info, overlay->m_renderPass);
    if (!overlay->m_vulkanReady || !uploadFonts(device)) return nullptr;
    error.clear();
    return overlay;
}

Overlay::~Overlay() {
    m_device.waitIdle();
    if (m_vulkanReady) ImGui_ImplVulkan_Shutdown();
    if (m_glfwReady) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    if (!m_destroyFramebuffer || !m_destroyRenderPass) return;
    for (const VkFramebuffer framebuffer : m_framebuffers) m_destroyFramebuffer(m_device.handle(), framebuffer, m_device.allocator());
    m_destroyRenderPass(m_device.handle(), m_renderPass, m_device.allocator());
    m_device.vk().DestroyDescriptorPool(m_device.handle(), m_pool, m_device.allocator());
}

bool Overlay::loadApi() {
    // gpu::Api lacks these functions: nothing else uses render pass objects.
    const auto load = [&]<class F>(F& function, const char* name) {
        function = reinterpret_cast<F>(m_device.vk().GetDeviceProcAddr(m_device.handle(), name));
        return function != nullptr;
    };
    return load(m_createRenderPass, "vkCreateRenderPass") && load(m_destroyRenderPass, "vkDestroyRenderPass") &&
           load(m_createFramebuffer, "vkCreateFramebuffer") && load(m_destroyFramebuffer, "vkDestroyFramebuffer") &&
           load(m_beginRenderPass, "vkCmdBeginRenderPass") && load(m_endRenderPass, "vkCmdEndRenderPass");
}

bool Overlay::createObjects(VkFormat format) {
    m_framebuffers.assign(m_device.framesInFlight(), VK_NULL_HANDLE);
    // The graph makes the layout transitions before and after this render pass.
    const VkAttachmentDescription attachment{.format = format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS, .colorAttachmentCount = 1, .pColorAttachments = &reference};
    const VkRenderPassCreateInfo renderPass{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
        .subpassCount = 1,
        .pSubpasses = &subpass};
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
        .maxSets = 8,
        .poolSizeCount = 1,
        .pPoolSizes = &size};
    return m_createRenderPass(m_device.handle(), &renderPass, m_device.allocator(), &m_renderPass) == VK_SUCCESS &&
           m_device.vk().CreateDescriptorPool(m_device.handle(), &pool, m_device.allocator(), &m_pool) == VK_SUCCESS;
}

void Overlay::beginFrame() {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Overlay::skip() { ImGui::EndFrame(); }

bool Overlay::wantsKeys() const { return ImGui::GetIO().WantTextInput; }
bool Overlay::wantsMouse() const { return ImGui::GetIO().WantCaptureMouse; }

void Overlay::add(graph::Graph& graph, graph::ImageId picture, uint32_t slot) {
    ImGui::Render();
    if (ImGui::GetDrawData()->TotalVtxCount == 0) return;
    const gpu::ImageDesc desc = graph.desc(picture);
    graph.pass("overlay").use(picture, graph::Access::color).keep().record([this, picture, desc, slot](const graph::PassContext& context) {
        VkFramebuffer& framebuffer = m_framebuffers[slot];
        m_destroyFramebuffer(m_device.handle(), framebuffer, m_device.allocator());
        const VkImageView view = context.view(picture);
        const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
            .renderPass = m_renderPass,
            .attachmentCount = 1,
            .pAttachments = &view,
            .width = desc.width,
            .height = desc.height,
            .layers = 1};
        if (m_createFramebuffer(m_device.handle(), &info, m_device.allocator(), &framebuffer) != VK_SUCCESS) {
            framebuffer = VK_NULL_HANDLE;
            return;
        }
        const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
            .renderPass = m_renderPass,
            .framebuffer = framebuffer,
            .renderArea = {{}, {desc.width, desc.height}}};
        m_beginRenderPass(context.cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
        ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), context.cmd);
        m_endRenderPass(context.cmd);
    });
}

}  // namespace obscura::app
