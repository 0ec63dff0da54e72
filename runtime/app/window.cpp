#include "app/window.h"

#include <algorithm>
#include <cmath>

#include "app/complaint.h"

namespace obscura::app {

namespace {

// GLFW passes error texts to a callback only.
std::string g_lastError;

GLFWmonitor* monitorOf(GLFWwindow* window) {
    int x, y, width, height, count = 0;
    glfwGetWindowPos(window, &x, &y);
    glfwGetWindowSize(window, &width, &height);
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    GLFWmonitor* best = nullptr;
    int bestArea = 0;
    for (int i = 0; i < count; ++i) {
        int mx, my;
        glfwGetMonitorPos(monitors[i], &mx, &my);
        const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
        if (!mode) continue;
        const int w = std::min(x + width, mx + mode->width) - std::max(x, mx);
        const int h = std::min(y + height, my + mode->height) - std::max(y, my);
        if (!best || (w > 0 && h > 0 && w * h > bestArea)) {
            best = monitors[i];
            bestArea = std::max(w, 0) * std::max(h, 0);
        }
    }
    return best;
}

}  // namespace

std::unique_ptr<Window> Window::open(const char* title, int width, int height, std::string& error) {
    g_lastError.clear();
    glfwSetErrorCallback([](int, const char* text) { g_lastError = oneLine(text); });
    if (!glfwInit()) {
        error = g_lastError.empty() ? "GLFW found no display" : g_lastError;
        return nullptr;
    }
    std::unique_ptr<Window> window(new Window);  // its destructor terminates GLFW
    if (!glfwVulkanSupported()) {
        error = "GLFW found no Vulkan driver that can present to this display";
        return nullptr;
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window->m_window = glfwCreateWindow(width, height, title, nullptr, nullptr);
    if (!window->m_window) {
        error = g_lastError.empty() ? "the window could not be opened" : g_lastError;
        return nullptr;
    }
    glfwSetWindowSizeLimits(window->m_window, 160, 90, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window->m_window, window.get());
    glfwSetKeyCallback(window->m_window, [](GLFWwindow* handle, int key, int, int action, int) {
        auto* self = static_cast<Window*>(glfwGetWindowUserPointer(handle));
        if (action != GLFW_RELEASE) self->m_pressed.push_back({key, action == GLFW_REPEAT});
    });
    glfwSetCursorPosCallback(window->m_window, [](GLFWwindow* handle, double x, double y) {
        static_cast<Window*>(glfwGetWindowUserPointer(handle))->m_pointer = {float(x), float(y)};
    });
    glfwSetMouseButtonCallback(window->m_window, [](GLFWwindow* handle, int button, int action, int) {
        auto* self = static_cast<Window*>(glfwGetWindowUserPointer(handle));
        if (action == GLFW_PRESS) self->m_clicked.push_back({button, self->m_pointer});
    });
    return window;
}

Window::~Window() {
    if (m_window) glfwDestroyWindow(m_window);
    glfwTerminate();
}

std::vector<const char*> Window::instanceExtensions() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return names ? std::vector<const char*>(names, names + count) : std::vector<const char*>();
}

VkResult Window::createSurface(VkInstance instance, const VkAllocationCallbacks* allocator, VkSurfaceKHR& surface) const {
    return glfwCreateWindowSurface(instance, m_window, allocator, &surface);
}

VkExtent2D Window::size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(m_window, &width, &height);
    if (glfwGetWindowAttrib(m_window, GLFW_ICONIFIED)) return {0, 0};
    return {uint32_t(std::max(width, 0)), uint32_t(std::max(height, 0))};
}

glm::vec2 Window::screenSize() const {
    int width = 0, height = 0;
    glfwGetWindowSize(m_window, &width, &height);
    return {float(std::max(width, 1)), float(std::max(height, 1))};
}

float Window::scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(m_window, &x, &y);
    return std::max(1.0f, std::max(x, y));
}

void Window::poll() {
    m_pressed.clear();
    m_clicked.clear();
    glfwPollEvents();
    glm::dvec2 mouse;
    glfwGetCursorPos(m_window, &mouse.x, &mouse.y);
    m_moved = glm::vec2(mouse - m_mouse);
    m_mouse = mouse;
    pollGamepad();
}

void Window::pollGamepad() {
    m_gamepad = {};
    GLFWgamepadstate state{};
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick)
        if (glfwGetGamepadState(joystick, &state)) break;
    const auto axis = [&](int index) {
        constexpr float kDeadZone = 0.15f;
        const float value = std::clamp(state.axes[index], -1.0f, 1.0f);
        return std::copysign(std::max(std::fabs(value) - kDeadZone, 0.0f) / (1.0f - kDeadZone), value);
    };
    // A trigger's axis rests at -1; a missing gamepad's is 0.
    const auto trigger = [&](int index) { return std::max(axis(index), 0.0f); };
    m_gamepad.left = {axis(GLFW_GAMEPAD_AXIS_LEFT_X), -axis(GLFW_GAMEPAD_AXIS_LEFT_Y)};
    m_gamepad.right = {axis(GLFW_GAMEPAD_AXIS_RIGHT_X), -axis(GLFW_GAMEPAD_AXIS_RIGHT_Y)};
    m_gamepad.lower = trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER);
    m_gamepad.raise = trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER);
    for (int i = 0; i <= GLFW_GAMEPAD_BUTTON_LAST; ++i) {
        if (state.buttons[i] && !m_buttons[i]) m_gamepad.pressed.push_back(i);
        m_buttons[i] = state.buttons[i];
    }
}

void Window::waitEvents(double seconds) { glfwWaitEventsTimeout(seconds); }

void Window::captureMouse(bool on) {
    if (on == m_captured) return;
    m_captured = on;
    glfwSetInputMode(m_window, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    glfwGetCursorPos(m_window, &m_mouse.x, &m_mouse.y);  // the pointer's jump does not count as movement
}

void Window::toggleFullScreen() {
    if (isFullScreen()) {
        glfwSetWindowMonitor(m_window, nullptr, m_restore[0], m_restore[1], m_restore[2], m_restore[3], GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* monitor = monitorOf(m_window);
    const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (!mode) return;
    glfwGetWindowPos(m_window, &m_restore[0], &m_restore[1]);
    glfwGetWindowSize(m_window, &m_restore[2], &m_restore[3]);
    glfwSetWindowMonitor(m_window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

}  // namespace obscura::app
