// obscura-toasters: writes toasters.glb.
#include "meshkit/file_output.h"
#include "meshkit/glb_writer.h"
#include "toasters/toaster_scene.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

int main(int argc, char** argv) {
    CLI::App app{
        "Models and animates a tray of wind-up toasters and writes it as one GLB file.\n"
        "\n"
        "The toys waddle, hop over one another, bump, snap their jaws and pop their toast.\n"
        "Legs move by skinning, toast by a morph target, keys, heads and eyes by plain nodes.\n"
        "Each toy is a root node (toaster_0, toaster_1, ...) that can be shown on its own;\n"
        "the tray is the root node 'tray'. Lengths are metres, y is up, the tray stands on y = 0.\n"
        "The animation 'walk' loops. The same build always writes the same bytes."};
    app.footer("Example:\n  obscura-toasters --out content/toasters.glb");
    std::string out = "content/toasters.glb";
    app.add_option("-o,--out", out, "File to write; its folder is created if missing")->capture_default_str();
    app.failure_message(
        [](const CLI::App*, const CLI::Error& error) { return "obscura-toasters: " + std::string(error.what()) + "; see --help\n"; });
    CLI11_PARSE(app, argc, argv);
    try {
        const obscura::kit::Scene scene = obscura::toasters::buildScene();
        const std::vector<std::uint8_t> bytes = obscura::kit::writeGlb(scene);
        obscura::kit::writeFile(out, bytes);
        std::printf("%s: %zu triangles, %zu bytes\n", out.c_str(), scene.triangleCount(), bytes.size());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "obscura-toasters: %s\n", error.what());
        return 1;
    }
    return 0;
}
