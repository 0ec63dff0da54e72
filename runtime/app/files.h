// Files that are written whole or not at all, and where a program finds its folders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace obscura::app {

// Writes to a temporary name beside `file`, then renames. Throws Complaint and leaves nothing behind on failure.
void writeFile(const std::filesystem::path& file, std::span<const std::byte> bytes);
void writeFile(const std::filesystem::path& file, std::string_view text);
// Throws Complaint unless a file of that name can be written: asked before long work, so that it is not in vain.
void expectWritable(const std::filesystem::path& file);
// Makes the folder when it is missing; throws Complaint when nothing can be written there.
void expectFolder(const std::filesystem::path& folder);

// A name in the current folder that no file has yet: "stem-20240131-235959.png", then with -2, -3, ...
std::filesystem::path freshName(const std::string& stem, const std::string& extension);

std::string base64(std::span<const std::byte> bytes);
std::filesystem::path executableFolder();  // empty when the system does not tell
std::filesystem::path cacheFolder();       // of this program, per user; empty when there is none; may not exist yet

}  // namespace obscura::app
