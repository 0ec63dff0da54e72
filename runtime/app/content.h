// Content lookup: the folders that are searched, the manifest of named scenes (content/scenes.json) and the files that it names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"

namespace obscura::app {

// Folders that are searched, in this order: the source tree's content/ (or, installed, share/obscura beside the program's folder),
// $OBSCURA_CONTENT, and shared/content beside the source tree.
std::vector<std::filesystem::path> contentFolders();
std::optional<std::filesystem::path> findContent(const std::string& relative);
// The first of these files in the first folder that has one.
std::optional<std::filesystem::path> findContent(const std::vector<std::string>& relatives);
// A file of the project's own, a manifest; throws Complaint if no folder has it.
std::filesystem::path expectContent(const std::string& relative);

// Toys of toasters.glb set down in a scene, without their tray.
struct ToyGroup {
    glm::vec3 at{0.0f};  // centre of their tray, world
    float turn = 0.0f;   // radians about y
    float scale = 1.0f;
    float time = 0.0f;  // seconds ahead of the world
};

// An entry of the manifest.
struct SceneInfo {
    std::string name, title;
    std::vector<std::string> files;  // any of these, relative to a content folder
    std::string howToGet;            // one line, shown if no file is found
    std::string flythrough;          // file relative to a content folder
    float floor = 0.0f;              // height that toys and walkers stand on, metres
    glm::vec3 eye{0.0f}, target{0.0f};
    glm::vec2 walkMin{-1e6f}, walkMax{1e6f};  // x and z that a walker stays within
    float exposure = 1.0f;
    float toyScale = 1.0f;  // of toys that the player drops
    std::vector<ToyGroup> toys;
};

// A scene and its files on this machine.
struct SceneFile {
    SceneInfo info;                                   // of a scene that is not named: its name only, the file's without extension
    bool named = false;                               // in the manifest
    std::filesystem::path file;                       // empty: not on this machine
    std::optional<std::filesystem::path> flythrough;  // if the scene has one
    std::optional<scene::Camera> camera() const;      // the manifest's own view
};

// All scenes of the manifest, with or without files. Throws Complaint or scene::Error.
std::vector<SceneFile> namedScenes();
// A scene by its manifest name, whose file may be missing, or the path of a glTF file. Throws Complaint, which lists the known names.
SceneFile findScene(const std::string& nameOrPath);
// As findScene(), but throws Complaint if the file is missing.
SceneFile expectScene(const std::string& nameOrPath);
// The same for several, whose names differ: files of equal names get as many parts of their paths as tell them apart, "before-hall" and
// "after-hall". A scene that is named twice is a Complaint.
std::vector<SceneFile> expectScenes(const std::vector<std::string>& namesOrPaths);

// A loaded scene and where it stands in the world.
struct PlacedScene {
    scene::Instance instance;          // placement: identity, or a power of ten for a file in another unit than metres
    scene::Bounds bounds;              // as placed, at time 0
    std::vector<std::string> remarks;  // one line each: what was ignored, repaired or scaled
};
// The animation that a name asks for: "all", "none", a name or an index of the model's. Throws Complaint, which lists the known names.
int animationOf(const scene::Model& model, const std::string& name);
// Cameras, animations, material variants and extensions of a model, and what becomes of each, one line each.
std::string contentList(const scene::Model& model);
// Scenes of the manifest are in metres. Other files are scaled by powers of ten until their radius lies between 0.25 m and 120 m. Throws
// scene::Error, and Complaint if there is nothing to draw.
PlacedScene loadScene(const SceneFile& file, const std::string& animation = "all");

}  // namespace obscura::app
