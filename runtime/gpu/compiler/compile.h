// GLSL to SPIR-V 1.6 for Vulkan 1.3, with its reflection. Used at build time by obscura-compile-shaders and while running
// by hot reload; nothing else needs glslang.
#pragma once

#include "gpu/shader.h"

namespace obscura::gpu {

// A gpu::CompileShader. `name`: a path below `root` or an absolute one, and for a variant the macros that are defined, as in "x.comp:A,B=2"
// (without a value: 1). The stage follows from the extension: .comp, .vert or .frag. #include "x" looks beside the including file, then
// below `root`; #include <x> below `root`, then where the system's GLSL headers are. Needs no #extension line; a file with #pragma once
// counts once. `error`: one line a message, "shaders/ao/x.comp:12: message", paths from the root's own folder on. Any thread may call it.
bool compileShader(const std::filesystem::path& root, std::string_view name, Shader& out, std::string& error,
    std::vector<std::filesystem::path>& dependencies);

// Names under which the build embeds a shader: `name` itself and one for each line `#pragma variant A,B=2` of its file.
std::vector<std::string> variantsOf(const std::filesystem::path& root, const std::string& name);

// Bindings, workgroup and push constants of `shader.spirv`, which must still carry its names.
bool reflect(Shader& shader, std::string& error);

// Drops names, sources and line numbers.
void stripDebugInfo(std::vector<uint32_t>& spirv);

}  // namespace obscura::gpu
