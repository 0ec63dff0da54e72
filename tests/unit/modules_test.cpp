// Allowed includes between modules, checked for every include of every module.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "obscura/ao.h"

namespace {

namespace fs = std::filesystem;
const fs::path kRoot = OBSCURA_SOURCE_DIR;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"gpu", {}},
    {"graph", {"gpu"}},
    {"ao", {"graph", "gpu"}},
    {"scene", {}},
    {"voxel", {"scene"}},
    {"truth", {"scene", "gpu", "graph", "ao"}},  // the screen reference is a graph pass; it uses the falloff type of ao
    {"render", {"graph", "gpu", "ao", "scene", "voxel"}},
    {"app", {"gpu", "graph", "ao", "scene", "render"}},
};

const std::set<std::string> kForbiddenInLibrary = {"GLFW", "imgui", "tiny_gltf", "tinygltf", "openvdb", "embree"};

std::vector<std::pair<fs::path, std::string>> includes(const fs::path& folder) {
    std::vector<std::pair<fs::path, std::string>> result;
    static const std::regex kInclude("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp") continue;
        std::ifstream in(entry.path());
        std::smatch match;
        for (std::string line; std::getline(in, line);)
            if (std::regex_search(line, match, kInclude)) result.push_back({entry.path(), match[1]});
    }
    return result;
}

TEST(Modules, includeOnlyTheModulesTheyMay) {
    size_t seen = 0;
    for (const auto& [module, allowed] : kMayInclude) {
        if (!fs::exists(kRoot / "runtime" / module)) continue;
        for (const auto& [file, header] : includes(kRoot / "runtime" / module)) {
            const std::string first = header.substr(0, header.find('/'));
            ++seen;
            if (first == module || !kMayInclude.count(first) || header.find('/') == std::string::npos) continue;
            EXPECT_TRUE(allowed.count(first)) << fs::relative(file, kRoot) << " includes " << header;
        }
    }
    EXPECT_GT(seen, 50u);
}

TEST(Modules, theLibraryIncludesNoWindowOrFileFormats) {
    for (const char* module : {"gpu", "graph", "ao"})
        for (const auto& [file, header] : includes(kRoot / "runtime" / module))
            for (const std::string& word : kForbiddenInLibrary)
                EXPECT_EQ(header.find(word), std::string::npos) << fs::relative(file, kRoot) << " includes " << header;
}

TEST(Modules, openVdbStaysInTwoSourceFiles) {
    size_t seen = 0;
    for (const char* folder : {"runtime", "game", "tools"})
        for (const auto& [file, header] : includes(kRoot / folder))
            if (header.starts_with("openvdb/") || header.starts_with("nanovdb/")) {
                EXPECT_TRUE(file.filename() == "sparse.cpp" || file.filename() == "nano_grid.cpp") << file;
                ++seen;
            }
    EXPECT_GT(seen, 0u);
}

TEST(Modules, thePublicHeaderNeedsOnlyVulkan) {
    for (const auto& [file, header] : includes(kRoot / "runtime/ao/include"))
        EXPECT_TRUE(header == "cstddef" || header == "cstdint" || header == "vulkan/vulkan_core.h") << header;
}

// json_text.h replaces bytes that are not UTF-8; the JSON library's own function throws on them.
TEST(Modules, jsonIsWrittenByOneFunction) {
    for (const char* folder : {"runtime", "game", "tools"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            if (entry.path().extension() != ".cpp" || entry.path().string().find("/meshkit/") != std::string::npos) continue;
            std::ifstream in(entry.path());
            for (std::string line; std::getline(in, line);) EXPECT_EQ(line.find(".dump("), std::string::npos) << entry.path() << line;
        }
}

TEST(Modules, eachHasAReadme) {
    for (const auto& entry : fs::directory_iterator(kRoot / "runtime"))
        EXPECT_TRUE(!entry.is_directory() || fs::exists(entry.path() / "README.md")) << entry.path();
}

TEST(Modules, theReadmeListsEveryMethod) {
    std::ifstream in(kRoot / "README.md");
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    for (const obscura::ao::MethodInfo* info : obscura::ao::methods())
        EXPECT_NE(text.find("\n| `" + std::string(info->id) + "` | "), std::string::npos) << info->id;
    EXPECT_NE(text.find("(content/methods.jpg)"), std::string::npos);
    EXPECT_TRUE(fs::exists(kRoot / "content/methods.jpg"));
}

TEST(Modules, topLevelHasOnlyTheAgreedEntries) {
    const std::set<std::string> agreed = {"CMakeLists.txt", "CMakePresets.json", "README.md", "LICENSE", "runtime", "game", "shaders",
        "content", "tests", "tools", "build", "out"};
    for (const auto& entry : fs::directory_iterator(kRoot)) {
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(name[0] == '.' || agreed.count(name)) << name;
    }
}

}  // namespace
