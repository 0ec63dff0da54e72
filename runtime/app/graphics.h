// Device, shaders, graph and frames in flight of a program that draws, with or without a window.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/frames.h"
#include "render/renderer.h"

namespace obscura::app {

class Window;

class Graphics {
public:
    struct Choice {
        std::string device, validation = "off";  // part of a device's name; off, core or sync
        bool verbose = false;                    // prints the whole log, not only validation messages
        const char* program = "";                // begins lines of the log on stderr
        std::filesystem::path pipelineCache;     // empty: none
        const Window* window = nullptr;          // frames are presented on it; null: on none
    };
    explicit Graphics(const Choice& choice);  // throws Complaint
    // Waits for the GPU. Objects made with the device must be destroyed before.
    ~Graphics();
    Graphics(const Graphics&) = delete;

    gpu::Device& device() { return *m_device; }
    const std::string& deviceName() const { return m_device->caps().deviceName; }
    gpu::ShaderLibrary& shaders() { return m_shaders; }  // of the library and the renderer; a program may add its own
    graph::Graph& graph() { return *m_graph; }
    Frames& frames() { return *m_frames; }
    // Owned by the caller; throws Complaint.
    std::unique_ptr<render::Renderer> makeRenderer();

    // Throws Complaint for anything but ok, with the last log message.
    void expect(gpu::Status status, const char* doing) const;
    const std::vector<std::string>& messages() const { return m_messages; }  // warnings and errors so far
    std::string lastMessage() const { return m_messages.empty() ? "" : ": " + m_messages.back(); }
    bool pipelineCacheFound() const { return m_pipelineCacheFound; }  // a pipeline cache was on disk

    // The user's pipeline cache; empty without a cache folder.
    static std::filesystem::path pipelineCacheFile();

protected:
    void waitIdle();  // for the GPU, before a derived class destroys its objects

private:
    std::vector<std::string> m_messages;
    bool m_pipelineCacheFound = false;
    std::unique_ptr<gpu::Device> m_device;
    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<graph::Graph> m_graph;
    std::unique_ptr<Frames> m_frames;
};

}  // namespace obscura::app
