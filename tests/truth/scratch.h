// Fixture: a temporary folder for one test, and a check that an error is one line with the expected text.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "scene/gltf/gltf.h"

namespace obscura::test {

class Scratch {
public:
    Scratch() {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        m_path = std::filesystem::temp_directory_path() / ("obscura_truth_" + std::to_string(::getpid()) + "_" + info->name());
        std::filesystem::create_directories(m_path);
    }
    ~Scratch() {
        std::error_code error;
        std::filesystem::remove_all(m_path, error);
    }
    const std::filesystem::path& path() const { return m_path; }
    std::filesystem::path operator/(const char* name) const { return m_path / name; }
    size_t files() const { return size_t(std::distance(std::filesystem::directory_iterator(m_path), {})); }

private:
    std::filesystem::path m_path;
};

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
