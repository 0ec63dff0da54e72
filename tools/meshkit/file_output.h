// Writes files of the content generators.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace obscura::kit {

/// Writes under a temporary name and renames, so that readers never see an incomplete file.
/// Creates the folder if it is missing; throws std::runtime_error with a one-line reason.
void writeFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace obscura::kit
