// Surface and swapchain of a window. Handles resizing, minimising and a lost surface: acquire() then returns false, and the next frame
// tries again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/window.h"
#include "graph/graph.h"

namespace obscura::app {

class Presenter {
public:
    // Null if the device cannot present to the window; `error` is then one line.
    static std::unique_ptr<Presenter> create(gpu::Device& device, Window& window, bool vsync, std::string& error);
    ~Presenter();  // waits for the device
    Presenter(const Presenter&) = delete;

    // Call it after Frames::begin() for that slot. False: no swapchain image this frame.
    bool acquire(uint32_t slot);
    VkExtent2D size() const { return m_size; }
    VkSemaphore acquired() const { return m_acquired[m_slot]; }
    VkSemaphore rendered() const { return m_rendered[m_image]; }
    // Blits `picture` into the acquired image, as the frame's last pass.
    void add(graph::Graph& graph, graph::ImageId picture);
    // Call it after the frame's submission. Only deviceLost and outOfMemory are failures.
    gpu::Status present();

private:
    Presenter(gpu::Device& device, Window& window, bool vsync) : m_device(device), m_window(window), m_vsync(vsync) {}
    bool createSurface(std::string& error);
    bool createSwapchain();
    void destroySwapchain();
    VkPresentModeKHR presentMode() const;

    gpu::Device& m_device;
    Window& m_window;
    bool m_vsync;
    VkSurfaceKHR m_surface = VK_NULL_HANDLE;
    VkSwapchainKHR m_swapchain = VK_NULL_HANDLE;
    VkSurfaceFormatKHR m_format{};
    VkExtent2D m_size{};
    std::vector<VkImage> m_images;
    std::vector<VkSemaphore> m_acquired;  // one per frame in flight
    std::vector<VkSemaphore> m_rendered;  // one per image: presentation has surely ended only when the image is acquired again
    uint32_t m_slot = 0, m_image = 0;
    bool m_stale = true, m_surfaceLost = false;
};

}  // namespace obscura::app
