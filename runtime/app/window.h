// A GLFW window: its size, what was pressed since the last poll, the mouse. One window a program.
#pragma once

#include <memory>
#include <string>
#include <vector>

#define GLFW_INCLUDE_NONE
#include "gpu/api.h"
#include <GLFW/glfw3.h>
#include <glm/glm.hpp>

namespace obscura::app {

class Window {
public:
    // Null, with a reason in one line, when there is no display or no Vulkan on it. Size in screen units.
    static std::unique_ptr<Window> open(const char* title, int width, int height, std::string& error);
    ~Window();
    Window(const Window&) = delete;

    std::vector<const char*> instanceExtensions() const;
    VkResult createSurface(VkInstance instance, const VkAllocationCallbacks* allocator, VkSurfaceKHR& surface) const;
    VkExtent2D size() const;  // pixels; 0 while minimised
    float scale() const;      // of the monitor, 1 on ordinary ones
    bool closing() const { return glfwWindowShouldClose(m_window) != 0; }
    void close() { glfwSetWindowShouldClose(m_window, GLFW_TRUE); }

    void poll();
    void waitEvents(double seconds);  // for when nothing need be drawn
    struct Press {
        int key;
        bool repeat;
    };
    const std::vector<Press>& pressed() const { return m_pressed; }  // since the last poll, GLFW key codes
    bool held(int key) const { return glfwGetKey(m_window, key) == GLFW_PRESS; }
    bool button(int button) const { return glfwGetMouseButton(m_window, button) == GLFW_PRESS; }
    struct Click {
        int button;
        glm::vec2 at;  // screen units, from the upper left corner
    };
    const std::vector<Click>& clicked() const { return m_clicked; }  // buttons that went down since the last poll
    glm::vec2 mouse() const { return m_mouse; }                      // screen units
    glm::vec2 screenSize() const;                                    // screen units, at least 1
    glm::vec2 mouseMoved() const { return m_moved; }  // pixels since the last poll
    void captureMouse(bool on);  // hides it; its movements go on without bounds
    bool mouseCaptured() const { return m_captured; }
    void toggleFullScreen();  // on the monitor that shows most of the window; stays as it is when there is none
    GLFWwindow* handle() const { return m_window; }

private:
    Window() = default;
    GLFWwindow* m_window = nullptr;
    std::vector<Press> m_pressed;
    std::vector<Click> m_clicked;
    glm::vec2 m_pointer{0.0f};  // at the last event, where a click that is already over was
    glm::dvec2 m_mouse{0.0};
    glm::vec2 m_moved{0.0f};
    bool m_captured = false;
    int m_restore[4] = {};  // x, y, width, height before full screen
};

}  // namespace obscura::app
