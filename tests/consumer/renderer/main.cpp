// renderer [FOLDER]: renders several methods at two sizes, then with a size that changes every frame, and checks each image: the floor is
// open, the crease below the wall is dark. Writes the images to FOLDER as METHOD-WIDTHxHEIGHT.pgm.
#include <cmath>
#include <cstdio>
#include <string>

#include "obscurance.h"
#include "renderer.h"

namespace {

bool passed = true;

void expect(bool condition, const char* what, const char* method) {
    if (!condition) std::printf("WRONG: %s: %s\n", method, what);
    passed = passed && condition;
}

// Mean visibility of the sky, of the floor within 40 cm of the wall, and of the floor more than 1.5 m from wall and box.
void look(const Renderer& renderer, const std::vector<uint8_t>& picture, const char* method) {
    struct {
        double sum = 0.0;
        unsigned count = 0;
        double mean() const { return sum / count; }
        void add(double v) { sum += v, ++count; }
    } sky, crease, open;
    for (uint32_t y = 0; y < renderer.size.height; ++y)
        for (uint32_t x = 0; x < renderer.size.width; ++x) {
            const float z = renderer.depthAt(x, y), ndcY = 2.0f * (float(y) + 0.5f) / float(renderer.size.height) - 1.0f;
            const double value = picture[size_t(y) * renderer.size.width + x] / 255.0;
            const bool floor = z > 0.0f && std::fabs(z * ndcY / 1.2f - 1.5f) < 0.01f;
            if (z == 0.0f) sky.add(value);
            else if (floor && z > 5.6f) crease.add(value);
            else if (floor && z < 2.5f) open.add(value);
        }
    std::printf("%-14s %ux%u: sky %.3f, open floor %.3f, crease %.3f\n", method, renderer.size.width, renderer.size.height, sky.mean(),
        open.mean(), crease.mean());
    expect(sky.mean() == 1.0, "the sky is not open", method);
    expect(open.mean() > 0.95, "the open floor is dark", method);
    expect(crease.mean() < open.mean() - 0.07 && crease.mean() > 0.4, "the crease is not darker, or black", method);
}

bool write(const std::string& name, const Renderer& renderer, const std::vector<uint8_t>& picture) {
    std::FILE* file = std::fopen(name.c_str(), "wb");
    if (!file) return false;
    std::fprintf(file, "P5 %u %u 255\n", renderer.size.width, renderer.size.height);
    const bool complete = std::fwrite(picture.data(), 1, picture.size(), file) == picture.size();
    return std::fclose(file) == 0 && complete;
}

}  // namespace

int main(int argc, char** argv) {
    Renderer renderer;
    {
        Obscurance obscurance(renderer);
        for (const char* method : {"hbao", "gtao", "far_field"}) {
            expect(obscurance.use(method), "setMethod", method);
            for (const VkExtent2D size : {VkExtent2D{320, 180}, VkExtent2D{213, 121}}) {
                renderer.resize(size.width, size.height);
                for (int frame = 0; frame < 4; ++frame) {
                    const VkCommandBuffer cmd = renderer.begin();
                    const Obscurance::Picture picture = obscurance.record(cmd, renderer);
                    const bool bends = std::string(method) != "far_field";
                    expect(bool(picture.bentNormals) == bends, "bent normals are missing, or a surprise", method);
                    if (!picture.image) return std::printf("WRONG: %s: record\n", method), 1;
                    renderer.end(picture.image, picture.layout, 1);
                }
                const std::vector<uint8_t> picture = renderer.wait();
                look(renderer, picture, method);
                if (argc > 1) {
                    const std::string name =
                        std::string(argv[1]) + "/" + method + "-" + std::to_string(size.width) + "x" + std::to_string(size.height) + ".pgm";
                    expect(write(name, renderer, picture), "the picture cannot be written", method);
                }
            }
        }
        // Dynamic resolution: between half and all of 320 x 180, each frame another size. No device memory is allocated.
        obscurance.largest = {320, 180};
        for (const char* method : {"gtao", "far_field"}) {
            expect(obscurance.use(method), "setMethod", method);
            uint64_t bytes = 0;
            for (uint32_t frame = 0; frame < 24; ++frame) {
                const uint32_t share = frame * 7 % 13;  // of 12
                renderer.resize(160 + 160 * share / 12, 90 + 90 * share / 12);
                const VkCommandBuffer cmd = renderer.begin();
                const Obscurance::Picture picture = obscurance.record(cmd, renderer);
                if (!picture.image) return std::printf("WRONG: %s: record\n", method), 1;
                renderer.end(picture.image, picture.layout, 1);
                if (frame == 4) bytes = obscurance.bytes();
                expect(frame < 4 || obscurance.bytes() <= bytes, "memory grows with the size", method);
                if (frame % 6 == 5) look(renderer, renderer.wait(), method);
            }
        }
        expect(!obscurance.use("no such method"), "an unknown method is taken", "setMethod");
    }
    expect(renderer.validationMessages == 0, "validation has something to say", "Vulkan");
    return passed ? 0 : 1;
}
