// A small scene: a floor and a moving box.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "../temporary_folder.h"

namespace obscura::test {

// Writes small.gltf and small.bin into the folder; returns the path of small.gltf. `scale` multiplies all lengths.
std::filesystem::path writeSmallScene(const std::filesystem::path& folder, float scale = 1.0f);

// The scene in a folder of its own, to which the game writes.
class SmallSceneTest : public testing::Test {
protected:
    std::string file(const std::string& name) const { return (m_folder / name).string(); }

    const TemporaryFolder m_folder;
    const std::string m_scene = writeSmallScene(m_folder.path()).string();
};

}  // namespace obscura::test
