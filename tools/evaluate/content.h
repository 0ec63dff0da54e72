// Scene lookup: the manifest of named scenes (content/scenes.json) and the folders that are searched for their files.
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
    std::string howToGet;                             // one line, shown if the file is missing
    std::optional<std::filesystem::path> flythrough;  // if the scene has one
    std::optional<scene::Camera> camera;              // the manifest's own view
};

// The source tree's content/, $OBSCURA_CONTENT, shared/content beside the source tree: the first that has the file.
std::optional<std::filesystem::path> findContent(const std::string& relative);

// All scenes of the manifest, with or without files. Throws app::Complaint or scene::Error.
std::vector<SceneFile> namedScenes();

// A scene by its manifest name or the path of a glTF file; its file exists. Throws app::Complaint, which lists the known names.
SceneFile findScene(const std::string& nameOrPath);

}  // namespace obscura::evaluate
