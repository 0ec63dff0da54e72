// Runs the game as a child process.
#include "program.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include "../temporary_folder.h"

namespace obscura::test {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

Ran run(const std::vector<std::string>& arguments, const char* program) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out", err = folder / "err";
    std::vector<char*> argv{const_cast<char*>(program)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(::open(out.c_str(), O_CREAT | O_WRONLY, 0644), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), O_CREAT | O_WRONLY, 0644), STDERR_FILENO);
        ::unsetenv("DISPLAY");
        ::unsetenv("WAYLAND_DISPLAY");
        ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
        ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
        ::execv(program, argv.data());
        ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), bytesOf(out), bytesOf(err)};
}

Decoded decodePng(const fs::path& file) {
    Decoded decoded;
    const std::string bytes = bytesOf(file);
    // stb_image accepts truncated files, so check for the final IEND chunk.
    if (bytes.size() < 12 || bytes.compare(bytes.size() - 8, 4, "IEND") != 0) return decoded;
    int channels = 0;
    unsigned char* texels = stbi_load_from_memory(
        reinterpret_cast<const unsigned char*>(bytes.data()), int(bytes.size()), &decoded.width, &decoded.height, &channels, 3);
    if (texels) decoded.rgb.assign(texels, texels + size_t(decoded.width) * size_t(decoded.height) * 3);
    stbi_image_free(texels);
    return decoded;
}

}  // namespace obscura::test
