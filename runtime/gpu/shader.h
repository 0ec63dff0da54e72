// Shader code and its reflection. SPIR-V and its reflection are made at build time by obscura-compile-shaders and
// embedded; a ShaderLibrary finds them by name and swaps them when a source file is edited. A name is the file's path below the shaders
// folder and, for a variant, the macros that it is compiled with: "ao/hbao/horizons.comp", "ao/hbao/horizons.comp:DEPTH_LAYERS".
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace obscura::gpu {

enum class BindingKind : uint8_t { sampledImage, storageImage, uniformBuffer, storageBuffer };

struct Binding {
    uint32_t set = 0;
    uint32_t binding = 0;
    BindingKind kind = BindingKind::sampledImage;
    bool reads = true;    // false: declared writeonly
    bool writes = false;  // storage that is not declared readonly
    std::string name;
};

struct Shader {
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
    std::vector<uint32_t> spirv;
    std::vector<Binding> bindings;  // sorted by set, binding
    std::array<uint32_t, 3> workgroup{1, 1, 1};
    uint32_t pushConstantBytes = 0;
};

// The form in which the build embeds one.
struct EmbeddedShader {
    const char* name;
    std::span<const uint32_t> spirv;
    const char* reflection;  // as describe() writes it
};
std::string describe(const Shader& shader);              // one line of text
bool undescribe(std::string_view text, Shader& shader);  // false if malformed

inline std::string_view shaderFile(std::string_view name) { return name.substr(0, name.find(':')); }

// Compiles the GLSL shader of that name below `root`; on failure returns false and puts file, line and message in `error`. Implemented by
// runtime/gpu/compiler, so that programs which only run embedded shaders need not link glslang. `dependencies` receives every file read.
using CompileShader = std::function<bool(const std::filesystem::path& root, std::string_view name, Shader& out, std::string& error,
    std::vector<std::filesystem::path>& dependencies)>;

class ShaderLibrary {
public:
    void add(std::span<const EmbeddedShader> shaders);
    // Null if there is none of that name. The pointer stays valid; `generation` tells when its content changed.
    const Shader* find(std::string_view name) const;
    uint64_t generation(std::string_view name) const;

    // Hot reload: from now on poll() recompiles what was edited below `root` (the shaders folder).
    void watch(const std::filesystem::path& root, CompileShader compile);
    // Looks at file times; returns true when a shader changed. Cheap; call it a few times a second.
    bool poll();
    // Empty when every shader is good, else one text a broken shader.
    std::vector<std::string> errors() const;

private:
    struct Entry {
        Shader shader;
        uint64_t generation = 0;
        std::string error;
        std::vector<std::filesystem::path> files;
        std::filesystem::file_time_type stamp{};  // the newest of `files`
        uint64_t bytes = 0;                       // and their sizes added up: two saves may share one clock tick
    };
    std::map<std::string, Entry, std::less<>> m_entries;
    std::filesystem::path m_root;
    CompileShader m_compile;
};

}  // namespace obscura::gpu
