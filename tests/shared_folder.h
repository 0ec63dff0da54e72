// Folders that are not in the repository: third-party content ("content") and stored references ("oracle"). They lie in shared/ beside the
// project, unless an environment variable names another folder. Tests that need one are skipped without it.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace obscura::test {

inline std::filesystem::path sharedFolder(const char* variable, const char* name) {
    const char* named = std::getenv(variable);
    return named && *named ? std::filesystem::path(named) : std::filesystem::path(OBSCURA_SOURCE_DIR) / ".." / "shared" / name;
}

inline std::filesystem::path contentFolder() { return sharedFolder("OBSCURA_CONTENT", "content"); }
inline std::filesystem::path oracleFolder() { return sharedFolder("OBSCURA_ORACLE", "oracle"); }

}  // namespace obscura::test
