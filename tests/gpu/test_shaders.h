// Fixture: a temporary shaders/ folder with shaders written by the test, and a library filled from it.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../temporary_folder.h"
#include "gpu/compiler/compile.h"
#include "gpu/shader.h"

namespace obscura::test {

class TestShaders {
public:
    std::filesystem::path root() const { return m_folder.path() / "shaders"; }

    // Writes a file and always advances its modification time.
    void write(const std::string& name, const std::string& text) {
        const std::filesystem::path file = root() / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
        std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++m_writes));
    }

    // `includes`: where included files are looked for; empty: in root().
    gpu::Shader compile(const std::string& name, const std::filesystem::path& includes = {}) {
        gpu::Shader shader;
        std::string error;
        std::vector<std::filesystem::path> files;
        EXPECT_TRUE(gpu::compileShader(includes.empty() ? root() : includes, (root() / name).string(), shader, error, files)) << error;
        return shader;
    }

    std::string compileError(const std::string& name) {
        gpu::Shader shader;
        std::string error;
        std::vector<std::filesystem::path> files;
        EXPECT_FALSE(gpu::compileShader(root(), name, shader, error, files));
        return error;
    }

    // Writes a shader, compiles it and adds it to the library like an embedded one.
    void add(const std::string& name, const std::string& text, const std::filesystem::path& includes = {}) {
        write(name, text);
        const gpu::Shader shader = compile(name, includes);
        const std::string reflection = describe(shader);
        const gpu::EmbeddedShader embedded{name.c_str(), shader.spirv, reflection.c_str()};
        library.add({&embedded, 1});
    }

    gpu::ShaderLibrary library;

private:
    TemporaryFolder m_folder;
    int m_writes = 0;
};

}  // namespace obscura::test
