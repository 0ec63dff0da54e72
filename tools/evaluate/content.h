// Where scenes lie: the manifest of named ones (content/scenes.json) and the folders that may hold their files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"

namespace obscura::evaluate {

struct SceneFile {
    std::string name;                                 // "sponza", or a path as it was given
    std::filesystem::path file;                       // empty: not on this machine
    std::string howToGet;                             // one line, for then
    std::optional<std::filesystem::path> flythrough;  // where there is one
    std::optional<scene::Camera> camera;              // the manifest's own view
};

// The source tree's content/, $OBSCURA_CONTENT, shared/content beside the source tree: the first that has the file.
std::optional<std::filesystem::path> findContent(const std::string& relative);

// All of the manifest, found or not. Throws app::Complaint or scene::Error.
std::vector<SceneFile> namedScenes();

// A name of the manifest or the path of a glTF file; the file is there. Throws app::Complaint that says what there is.
SceneFile findScene(const std::string& nameOrPath);

}  // namespace obscura::evaluate
