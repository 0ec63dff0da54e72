// libFuzzer on camera paths: any bytes give a path that has finite cameras at all times and can be saved and read again, or one line.
#include <cmath>

#include "scene/camera.h"
#include "target.h"

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    return obscura::fuzz::mutateJsonText(data, size, maxSize, seed,
        R"({"name":"a","scene":"atrium","duration":8,"loop":true,"events":[{"time":1}],
        "keys":[{"time":0,"eye":[0,1,4],"target":[0,1,0],"verticalFovDegrees":60},{"time":1,"eye":[4,1.5,0.3],"target":[0.2,1,0]},
        {"time":4,"eye":[0,2,-4],"target":[0,1,0.1],"verticalFovDegrees":70}]})");
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura;
    fuzz::expectOneLine([&] {
        const scene::CameraPath path = scene::loadCameraPath(fuzz::file("path.json", {data, size}));
        for (const float time : {0.0f, -3.0f, 0.5f * path.duration, path.duration, 1e6f, 1e30f, float(NAN)}) {
            const scene::Camera camera = path.at(time);
            for (int i = 0; i < 3; ++i)
                if (!std::isfinite(camera.eye[i]) || !std::isfinite(camera.target[i]) || !std::isfinite(camera.fovY)) std::abort();
        }
        const std::filesystem::path saved = fuzz::file("saved.json", {});
        path.save(saved);
        if (scene::loadCameraPath(saved).keys.size() != path.keys.size()) std::abort();
    });
    return 0;
}
