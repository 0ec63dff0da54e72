// A GLFW window: size, keyboard and mouse input since the last poll. One window per program.
#pragma once

#include <memory>
#include <string>
#include <vector>

#define GLFW_INCLUDE_NONE
#include "gpu/api.h"  // Vulkan first: GLFW then declares its Vulkan functions

#include <GLFW/glfw3.h>
#include <glm/glm.hpp>

namespace obscura::app {

class Window {
public:
    // Null without a display or Vulkan; `error` is then one line. Size in GLFW's screen coordinates ("screen units" below).
    static std::unique_ptr<Window> open(const char* title, int width, int height, std::string& error);
    ~Window();
    Window(const Window&) = delete;

    std::vector<const char*> instanceExtensions() const;
    VkResult createSurface(VkInstance instance, const VkAllocationCallbacks* allocator, VkSurfaceKHR& surface) const;
    VkExtent2D size() const;  // pixels; 0 while minimised
    float scale() const;      // content scale of the monitor, at least 1
    bool closing() const { return glfwWindowShouldClose(m_window) != 0; }
    void close() { glfwSetWindowShouldClose(m_window, GLFW_TRUE); }

    void poll();
    void waitEvents(double seconds);  // sleeps until an event arrives or the time is over
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
    // The first gamepad; without one its sticks rest. Axes without their dead zone, -1 to 1, up and right positive.
    struct Gamepad {
        glm::vec2 left{0.0f}, right{0.0f};  // sticks
        float lower = 0.0f, raise = 0.0f;   // triggers, 0 to 1
        std::vector<int> pressed;           // GLFW codes of buttons that went down since the last poll
    };
    const Gamepad& gamepad() const { return m_gamepad; }
    glm::vec2 mouse() const { return m_mouse; }       // screen units
    glm::vec2 screenSize() const;                     // screen units, at least 1
    glm::vec2 mouseMoved() const { return m_moved; }  // pixels since the last poll
    void captureMouse(bool on);                       // hides the pointer; its movement is then unbounded
    bool mouseCaptured() const { return m_captured; }
    bool isFullScreen() const { return glfwGetWindowMonitor(m_window) != nullptr; }
    void toggleFullScreen();  // on the monitor that shows most of the window; without one it has no effect
    GLFWwindow* handle() const { return m_window; }

private:
    Window() = default;
    GLFWwindow* m_window = nullptr;
    std::vector<Press> m_pressed;
    std::vector<Click> m_clicked;
    glm::vec2 m_pointer{0.0f};  // pointer position at the last event: a click's position
    glm::dvec2 m_mouse{0.0};
    glm::vec2 m_moved{0.0f};
    bool m_captured = false;
    Gamepad m_gamepad;
    unsigned char m_buttons[GLFW_GAMEPAD_BUTTON_LAST + 1] = {};  // of the gamepad, at the last poll
    void pollGamepad();
    int m_restore[4] = {};  // x, y, width, height before full screen
};

}  // namespace obscura::app
