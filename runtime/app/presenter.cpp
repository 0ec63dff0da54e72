#include "app/presenter.h"

#include <algorithm>

#include "app/frames.h"

namespace obscura::app {

namespace {

VkSemaphore makeSemaphore(const gpu::Device& device) {
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    device.vk().CreateSemaphore(device.handle(), &info, device.allocator(), &semaphore);
    return semaphore;
}

}  // namespace

std::unique_ptr<Presenter> Presenter::create(gpu::Device& device, Window& window, bool vsync, std::string& error) {
    if (!device.caps().presentation || !device.vk().CreateSwapchainKHR) {
        error = device.caps().deviceName + " cannot present to a window (VK_KHR_swapchain is missing)";
        return nullptr;
    }
    std::unique_ptr<Presenter> presenter(new Presenter(device, window, vsync));
    if (!presenter->createSurface(error)) return nullptr;
    for (uint32_t i = 0; i < device.framesInFlight(); ++i) presenter->m_acquired.push_back(makeSemaphore(device));
    return presenter;
}

Presenter::~Presenter() {
    destroySwapchain();
    for (const VkSemaphore semaphore : m_acquired) m_device.vk().DestroySemaphore(m_device.handle(), semaphore, m_device.allocator());
    if (m_surface) m_device.vk().DestroySurfaceKHR(m_device.instance(), m_surface, m_device.allocator());
}

bool Presenter::createSurface(std::string& error) {
    const gpu::Api& vk = m_device.vk();
    if (m_window.createSurface(m_device.instance(), m_device.allocator(), m_surface) != VK_SUCCESS) {
        error = "no Vulkan surface could be created for the window";
        return false;
    }
    VkBool32 supported = VK_FALSE;
    vk.GetPhysicalDeviceSurfaceSupportKHR(m_device.physical(), m_device.queueFamily(), m_surface, &supported);
    VkSurfaceCapabilitiesKHR caps{};
    const VkResult known = vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(m_device.physical(), m_surface, &caps);
    uint32_t count = 0;
    vk.GetPhysicalDeviceSurfaceFormatsKHR(m_device.physical(), m_surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vk.GetPhysicalDeviceSurfaceFormatsKHR(m_device.physical(), m_surface, &count, formats.data());
    // The image is sRGB-encoded already, hence a UNORM format: an SRGB one would encode it twice.
    const auto plain = std::find_if(formats.begin(), formats.end(), [&](const VkSurfaceFormatKHR& f) {
        return (f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM ||
                   f.format == VK_FORMAT_A8B8G8R8_UNORM_PACK32) &&
               f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR && m_device.formatSupports(f.format, VK_FORMAT_FEATURE_BLIT_DST_BIT);
    });
    if (!supported || known != VK_SUCCESS || plain == formats.end() || !(caps.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) {
        error = m_device.caps().deviceName + " cannot present to this window";
        return false;
    }
    m_format = *plain;
    m_surfaceLost = false;
    return true;
}

VkPresentModeKHR Presenter::presentMode() const {
    if (m_vsync) return VK_PRESENT_MODE_FIFO_KHR;
    uint32_t count = 0;
    const gpu::Api& vk = m_device.vk();
    vk.GetPhysicalDeviceSurfacePresentModesKHR(m_device.physical(), m_surface, &count, nullptr);
    std::vector<VkPresentModeKHR> modes(count);
    vk.GetPhysicalDeviceSurfacePresentModesKHR(m_device.physical(), m_surface, &count, modes.data());
    for (const VkPresentModeKHR wanted : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
        if (std::find(modes.begin(), modes.end(), wanted) != modes.end()) return wanted;
    return VK_PRESENT_MODE_FIFO_KHR;
}

bool Presenter::createSwapchain() {
    const gpu::Api& vk = m_device.vk();
    VkSurfaceCapabilitiesKHR caps{};
    const VkResult known = vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(m_device.physical(), m_surface, &caps);
    if (known != VK_SUCCESS) {
        m_surfaceLost = known == VK_ERROR_SURFACE_LOST_KHR;
        return false;
    }
    VkExtent2D size = caps.currentExtent;
    if (size.width == ~0u) {  // the swapchain decides the surface's size
        const VkExtent2D window = m_window.size();
        size = {std::clamp(window.width, caps.minImageExtent.width, caps.maxImageExtent.width),
            std::clamp(window.height, caps.minImageExtent.height, caps.maxImageExtent.height)};
    }
    if (size.width == 0 || size.height == 0) return false;

    destroySwapchain();
    uint32_t images = std::max(caps.minImageCount, m_device.framesInFlight() + 1);
    if (caps.maxImageCount) images = std::min(images, caps.maxImageCount);
    const VkCompositeAlphaFlagBitsKHR alpha = caps.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                  ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                  : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = m_surface,
        .minImageCount = images,
        .imageFormat = m_format.format,
        .imageColorSpace = m_format.colorSpace,
        .imageExtent = size,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .preTransform = caps.currentTransform,
        .compositeAlpha = alpha,
        .presentMode = presentMode(),
        .clipped = VK_TRUE};
    if (const VkResult made = vk.CreateSwapchainKHR(m_device.handle(), &info, m_device.allocator(), &m_swapchain); made != VK_SUCCESS) {
        m_swapchain = VK_NULL_HANDLE;
        m_surfaceLost = made == VK_ERROR_SURFACE_LOST_KHR;
        return false;
    }
    uint32_t count = 0;
    vk.GetSwapchainImagesKHR(m_device.handle(), m_swapchain, &count, nullptr);
    m_images.resize(count);
    vk.GetSwapchainImagesKHR(m_device.handle(), m_swapchain, &count, m_images.data());
    for (uint32_t i = 0; i < count; ++i) m_rendered.push_back(makeSemaphore(m_device));
    m_size = size;
    m_stale = false;
    return true;
}

void Presenter::destroySwapchain() {
    m_device.waitIdle();
    for (const VkSemaphore semaphore : m_rendered) m_device.vk().DestroySemaphore(m_device.handle(), semaphore, m_device.allocator());
    m_rendered.clear();
    m_images.clear();
    if (m_swapchain) m_device.vk().DestroySwapchainKHR(m_device.handle(), m_swapchain, m_device.allocator());
    m_swapchain = VK_NULL_HANDLE;
}

bool Presenter::acquire(uint32_t slot) {
    m_slot = slot;
    const VkExtent2D window = m_window.size();
    if (window.width == 0 || window.height == 0) return false;
    if (m_surfaceLost) {
        destroySwapchain();
        m_device.vk().DestroySurfaceKHR(m_device.instance(), m_surface, m_device.allocator());
        m_surface = VK_NULL_HANDLE;
        m_stale = true;
        std::string error;
        if (!createSurface(error)) {
            m_surfaceLost = true;
            return false;
        }
    }
    if (window.width != m_size.width || window.height != m_size.height) m_stale = true;
    // A new swapchain that is out of date means that the window is being resized: one more attempt now, the next one next frame.
    for (int attempt = 0; attempt < 2; ++attempt) {
        if ((m_stale || !m_swapchain) && !createSwapchain()) return false;
        const VkResult result =
            m_device.vk().AcquireNextImageKHR(m_device.handle(), m_swapchain, UINT64_MAX, m_acquired[slot], VK_NULL_HANDLE, &m_image);
        if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
            m_stale = result == VK_SUBOPTIMAL_KHR;
            return true;
        }
        m_surfaceLost = result == VK_ERROR_SURFACE_LOST_KHR;
        m_stale = true;
        if (m_surfaceLost) return false;
    }
    return false;
}

void Presenter::add(graph::Graph& graph, graph::ImageId picture) {
    const gpu::ImageDesc desc{
        .format = m_format.format, .width = m_size.width, .height = m_size.height, .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    const graph::ImageId target = graph.import("window", {.image = m_images[m_image],
                                                             .desc = desc,
                                                             .layout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                             .layoutAfter = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                                             .stages = Frames::kAcquireStages});
    const gpu::ImageDesc source = graph.desc(picture);
    graph.pass("present")
        .use(picture, graph::Access::transferRead)
        .use(target, graph::Access::transferWrite, true)
        .keep()
        .record([=](const graph::PassContext& context) {
            const auto corner = [](const gpu::ImageDesc& d) { return VkOffset3D{int32_t(d.width), int32_t(d.height), 1}; };
            const VkImageBlit region{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                .srcOffsets = {{}, corner(source)},
                .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                .dstOffsets = {{}, corner(desc)}};
            context.device.vk().CmdBlitImage(context.cmd, context.image(picture), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                context.image(target), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
        });
}

gpu::Status Presenter::present() {
    const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &m_rendered[m_image],
        .swapchainCount = 1,
        .pSwapchains = &m_swapchain,
        .pImageIndices = &m_image};
    const VkResult result = m_device.vk().QueuePresentKHR(m_device.queue(), &info);
    if (result == VK_SUCCESS) return gpu::Status::ok;
    m_stale = true;
    m_surfaceLost = result == VK_ERROR_SURFACE_LOST_KHR;
    if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR || m_surfaceLost) return gpu::Status::ok;
    return gpu::fromVulkan(result);
}

}  // namespace obscura::app
