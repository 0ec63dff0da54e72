#include "measure/measurement.h"

#include <cmath>

#include <fmt/format.h>

#include "app/arguments.h"
#include "app/complaint.h"

namespace obscura::measure {

namespace fs = std::filesystem;
using app::Complaint;

CameraChoice cameraOf(const std::string& text) {
    CameraChoice camera;
    camera.text = text;
    if (text == "own") return camera;
    if (text.starts_with("scene:")) {
        const std::vector<float> index = app::numbers(text.substr(6), ',');
        if (index.size() != 1 || index[0] < 0.0f || index[0] != std::floor(index[0]) || index[0] > 1e6f)
            throw Complaint(fmt::format("--camera {}: write scene:N, N counting the file's cameras from 0", text));
        camera.kind = CameraChoice::Kind::lens;
        camera.lens = int(index[0]);
    } else if (text.starts_with("path:")) {
        const size_t mark = text.rfind('@');
        const std::vector<float> at = mark == std::string::npos ? std::vector<float>() : app::numbers(text.substr(mark + 1), ',');
        if (at.size() != 1)
            throw Complaint(
                fmt::format("--camera {}: write path:FILE.json@SECONDS, or path:@SECONDS for the scene's own flythrough", text));
        camera.kind = CameraChoice::Kind::path;
        camera.file = text.substr(5, mark - 5);
        camera.at = at[0];
    } else if (fs::path(text).extension() == ".json") {
        camera.kind = CameraChoice::Kind::file;
        camera.file = text;
    } else {
        throw Complaint(fmt::format("--camera {}: write own, scene:N, path:FILE.json@SECONDS, or FILE.json", text));
    }
    return camera;
}

}  // namespace obscura::measure
