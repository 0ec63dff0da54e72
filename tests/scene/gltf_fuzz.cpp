// libFuzzer on the glTF loader: any bytes end in a model or in one Error, and a model can be posed.
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "scene/gltf.h"
#include "scene/world.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura::scene;
    LoadOptions options;
    options.maxBytes = size_t(128) << 20;
    try {
        const std::shared_ptr<const Model> model = loadGltfMemory({data, size}, "fuzz", options);
        World world;
        world.add({model});
        for (const PosedPrimitive& entry : pose(world, 0.4f))
            for (const uint32_t index : entry.primitive->indices)
                if (index >= entry.positions.size()) std::abort();
    } catch (const Error& error) {
        if (std::strchr(error.what(), '\n') != nullptr) std::abort();
    }
    return 0;
}
