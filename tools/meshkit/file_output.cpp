#include "meshkit/file_output.h"

#include <fstream>
#include <stdexcept>

namespace obscura::kit {

void writeFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    if (path.filename().empty() || std::filesystem::is_directory(path))
        throw std::runtime_error("cannot write " + path.string() + ": it names a folder");
    std::error_code error;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
    if (error) throw std::runtime_error("cannot make folder " + path.parent_path().string() + ": " + error.message());
    std::filesystem::path partial = path;
    partial += ".partial";
    {
        std::ofstream file(partial, std::ios::binary | std::ios::trunc);
        file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        file.close();
        if (!file) {
            std::filesystem::remove(partial, error);
            throw std::runtime_error("cannot write " + partial.string());
        }
    }
    std::filesystem::rename(partial, path, error);
    if (error) throw std::runtime_error("cannot rename " + partial.string() + " to " + path.string() + ": " + error.message());
}

}  // namespace obscura::kit
