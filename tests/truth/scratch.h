// Fixture: text files in a temporary folder, and a check that an error is one line with the expected text.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "../temporary_folder.h"
#include "scene/gltf/gltf.h"

namespace obscura::test {

inline std::string readText(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeText(const std::filesystem::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

template <class Run>
void expectError(const Run& run, const std::string& part) {
    try {
        run();
        ADD_FAILURE() << "no error; expected one with \"" << part << '"';
    } catch (const scene::Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(part), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
}

}  // namespace obscura::test
