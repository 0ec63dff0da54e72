// Atomic file writes and the program's folders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace obscura::app {

// Writes to a temporary name beside `file`, then renames. On failure it removes the temporary file and throws Complaint.
void writeFile(const std::filesystem::path& file, std::span<const std::byte> bytes);
void writeFile(const std::filesystem::path& file, std::string_view text);
// Throws Complaint unless the file can be written. Call it before long work.
void expectWritable(const std::filesystem::path& file);
// Creates the folder if missing; throws Complaint unless files can be written in it.
void expectFolder(const std::filesystem::path& folder);

// An unused file name in the current folder: "stem-20240131-235959.png", then with -2, -3, ...
std::filesystem::path freshName(const std::string& stem, const std::string& extension);

std::string base64(std::span<const std::byte> bytes);
std::filesystem::path executableFolder();  // empty if unknown
std::filesystem::path cacheFolder();       // per user; may not exist yet; empty without XDG_CACHE_HOME and HOME

}  // namespace obscura::app
