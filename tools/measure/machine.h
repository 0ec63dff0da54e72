// What a measurement draws with: renderer, library and screen reference. Renders frames, reads images back and collects pass times.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ao/library.h"
#include "app/graphics.h"
#include "truth/screen_reference.h"

namespace obscura::measure {

class Machine : public app::Graphics {
public:
    struct Choice {
        std::string device, validation = "off";
        bool verbose = false;
    };
    explicit Machine(const Choice& choice);  // throws app::Complaint
    ~Machine();

    // A new renderer for a scene, so that no state of an earlier scene affects it. Destroys the last one.
    render::Renderer& newRenderer();
    render::Renderer& renderer() { return *m_renderer; }
    // Created on first use; throw app::Complaint.
    ao::Library& library();  // for captured frames
    truth::ScreenReference& screen();
    // Makes the method's pipelines for that kind of falloff in `library`; throws app::Complaint.
    void expectMethod(ao::Library& library, const ao::MethodInfo& info, ao::FalloffKind falloff);

    // Renders frames that `declare` fills; `declare` returns the images to read back after the last one. Throws app::Complaint.
    using Declare = std::function<std::vector<graph::ImageId>(graph::Graph&, uint32_t frame)>;
    struct Ran {
        std::vector<std::vector<std::byte>> images;  // tightly packed rows
        std::vector<gpu::PassTime> passes;           // medians over the timed frames, in execution order
        std::vector<graph::Timings> frames;          // every timed frame
        uint64_t bytes = 0;                          // Executor::frameBytes() of the last one
    };
    Ran run(uint32_t warmUp, uint32_t timed, const Declare& declare);

private:
    std::unique_ptr<render::Renderer> m_renderer;
    std::unique_ptr<ao::Library> m_library;
    std::unique_ptr<truth::ScreenReference> m_screen;
};

}  // namespace obscura::measure
