// obscura-compile-shaders: GLSL files in, one C++ file out with their SPIR-V and reflection as constant arrays.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "gpu/compiler/compile.h"

namespace {

namespace fs = std::filesystem;
using obscura::gpu::Shader;

struct Options {
    fs::path root, out, depfile;
    std::string space;
    bool keepNames = false;
    std::vector<std::string> names;
};

constexpr const char* kUsage =
    "obscura-compile-shaders --root DIR --namespace NS --out FILE.cpp [--depfile FILE.d] [--names] SHADER...\n"
    "Compiles shaders, named relative to DIR, into `std::span<const gpu::EmbeddedShader> obscura::NS::shaders()`; a shader with lines\n"
    "`#pragma variant A,B=2` also once for each of them, with those macros, as SHADER:A,B=2.\n"
    "--names keeps variable names in the SPIR-V, for graphics debuggers.\n";

bool parse(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view arg = argv[i];
        if (arg == "--names") {
            options.keepNames = true;
        } else if (!arg.starts_with("--")) {
            options.names.emplace_back(arg);
        } else {
            if (i + 1 == argc) return false;
            const char* value = argv[++i];
            if (arg == "--root") options.root = value;
            else if (arg == "--namespace") options.space = value;
            else if (arg == "--out") options.out = value;
            else if (arg == "--depfile") options.depfile = value;
            else return false;
        }
    }
    return !options.root.empty() && !options.out.empty() && !options.space.empty();
}

std::string literal(std::string_view text) {
    std::string result = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

std::string code(const Options& options, const std::vector<Shader>& shaders) {
    std::string text = "// Made by obscura-compile-shaders from the files it names; edit those.\n#include \"gpu/shader.h\"\n\n";
    text += fmt::format("namespace obscura::{} {{\n\nstd::span<const ::obscura::gpu::EmbeddedShader> shaders();\n", options.space);
    if (shaders.empty()) return text + "std::span<const ::obscura::gpu::EmbeddedShader> shaders() { return {}; }\n\n}\n";
    text += "\nnamespace {\n\n";
    for (size_t i = 0; i < shaders.size(); ++i) {
        text += fmt::format("constexpr uint32_t kCode{}[] = {{  // {}", i, options.names[i]);
        for (size_t word = 0; word < shaders[i].spirv.size(); ++word) {
            if (word % 12 == 0) text += "\n    ";
            text += fmt::format("{:#x},", shaders[i].spirv[word]);
        }
        text += "\n};\n\n";
    }
    text += "const ::obscura::gpu::EmbeddedShader kShaders[] = {\n";
    for (size_t i = 0; i < shaders.size(); ++i)
        text += fmt::format("    {{{}, kCode{}, {}}},\n", literal(options.names[i]), i, literal(describe(shaders[i])));
    text += "};\n\n}  // namespace\n\nstd::span<const ::obscura::gpu::EmbeddedShader> shaders() { return kShaders; }\n\n";
    return text + fmt::format("}}  // namespace obscura::{}\n", options.space);
}

// By way of a temporary name, so that an interrupted build leaves no half file that looks new.
bool write(const fs::path& target, const std::string& text) {
    fs::path temporary = target;
    temporary += ".tmp";
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    std::error_code error;
    if (file) fs::rename(temporary, target, error);
    if (file && !error) return true;
    std::fprintf(stderr, "%s: cannot be written\n", target.string().c_str());
    fs::remove(temporary, error);
    return false;
}

std::string escaped(const fs::path& path) {  // as make and ninja read depfiles
    std::string result;
    for (char c : path.generic_string()) {
        if (c == ' ' || c == '#') result += '\\';
        if (c == '$') result += '$';
        result += c;
    }
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!parse(argc, argv, options)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    std::vector<std::string> names;
    for (const std::string& name : options.names)
        for (std::string& variant : obscura::gpu::variantsOf(options.root, name)) names.push_back(std::move(variant));
    options.names = std::move(names);
    std::vector<Shader> shaders;
    std::set<fs::path> read;
    bool good = true;
    for (const std::string& name : options.names) {
        Shader shader;
        std::string error;
        std::vector<fs::path> files;
        if (obscura::gpu::compileShader(options.root, name, shader, error, files)) {
            if (!options.keepNames) obscura::gpu::stripDebugInfo(shader.spirv);
        } else {
            std::fprintf(stderr, "%s\n", error.c_str());
            good = false;
        }
        read.insert(files.begin(), files.end());
        shaders.push_back(std::move(shader));
    }
    if (!good) return 1;
    if (!options.depfile.empty()) {
        std::string text = escaped(fs::absolute(options.out)) + ":";
        for (const fs::path& file : read) text += " \\\n  " + escaped(file);
        if (!write(options.depfile, text + "\n")) return 1;
    }
    return write(options.out, code(options, shaders)) ? 0 : 1;
}
