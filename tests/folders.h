// Folders beside the project that tests read and skip without: stored references, and scenes. Needs OBSCURA_SOURCE_DIR.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace obscura::test {

// The folder that an environment variable names, else ../shared/NAME.
inline std::filesystem::path folderOf(const char* variable, const char* name) {
    const char* named = std::getenv(variable);
    return named && *named ? std::filesystem::path(named) : std::filesystem::path(OBSCURA_SOURCE_DIR) / ".." / "shared" / name;
}
inline std::filesystem::path oracleFolder() { return folderOf("OBSCURA_ORACLE", "oracle"); }
inline std::filesystem::path contentFolder() { return folderOf("OBSCURA_CONTENT", "content"); }

}  // namespace obscura::test
