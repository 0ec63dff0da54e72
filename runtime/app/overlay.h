// Dear ImGui over the frame's image. Call ImGui between beginFrame() and add(); add() draws it as a graph pass.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/window.h"
#include "graph/graph.h"

namespace obscura::app {

class Overlay {
public:
    // Null on failure; `error` is then one line. `format`: of the images that it draws into. `scale`: of text and panels; empty: the
    // monitor's, at least so much that text keeps its share of the window's height above 1080 px.
    static std::unique_ptr<Overlay> create(
        gpu::Device& device, Window& window, VkFormat format, std::optional<float> scale, std::string& error);
    ~Overlay();  // waits for the device
    Overlay(const Overlay&) = delete;

    void beginFrame();
    // Ends the ImGui frame and adds its pass. `slot`: Frames::slot(); the GPU has finished the slot's previous frame.
    void add(graph::Graph& graph, graph::ImageId picture, uint32_t slot);
    void skip();              // ends the ImGui frame without drawing
    bool wantsKeys() const;   // a text field has the keyboard
    bool wantsMouse() const;  // the pointer is over a panel

private:
    explicit Overlay(gpu::Device& device) : m_device(device) {}
    bool loadApi();
    bool createObjects(VkFormat format);

    gpu::Device& m_device;
    PFN_vkCreateRenderPass m_createRenderPass = nullptr;
    PFN_vkDestroyRenderPass m_destroyRenderPass = nullptr;
    PFN_vkCreateFramebuffer m_createFramebuffer = nullptr;
    PFN_vkDestroyFramebuffer m_destroyFramebuffer = nullptr;
    PFN_vkCmdBeginRenderPass m_beginRenderPass = nullptr;
    PFN_vkCmdEndRenderPass m_endRenderPass = nullptr;
    VkRenderPass m_renderPass = VK_NULL_HANDLE;
    VkDescriptorPool m_pool = VK_NULL_HANDLE;
    std::vector<VkFramebuffer> m_framebuffers;  // one a frame in flight
    bool m_glfwReady = false, m_vulkanReady = false;
};

}  // namespace obscura::app
