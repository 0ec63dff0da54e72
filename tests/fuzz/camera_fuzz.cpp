// libFuzzer on camera files: any bytes give a camera with finite matrices, or one line.
#include <cmath>

#include "scene/camera.h"
#include "target.h"

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    return obscura::fuzz::mutateJsonText(
        data, size, maxSize, seed, R"({"eye":[1,2,3],"target":[0,0,0],"up":[0,1,0],"verticalFovDegrees":90,"near":0.5})");
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura;
    fuzz::expectOneLine([&] {
        const scene::Camera camera = scene::loadCamera(fuzz::file("camera.json", {data, size}));
        const glm::mat4 view = camera.view(), projection = camera.projection({640, 360}, {576, 324});
        for (int i = 0; i < 16; ++i)
            if (!std::isfinite(view[i / 4][i % 4]) || !std::isfinite(projection[i / 4][i % 4])) std::abort();
    });
    return 0;
}
