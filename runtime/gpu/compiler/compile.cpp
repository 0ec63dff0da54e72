#include "gpu/compiler/compile.h"

#include <algorithm>
#include <deque>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

namespace obscura::gpu {

namespace {

namespace fs = std::filesystem;

struct Process {  // glslang's tables, once a process
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
};

bool readText(const fs::path& file, std::string& text) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return false;
    std::ifstream in(file, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(in), {});
    return bool(in);
}

fs::path absoluteOf(const fs::path& path) {
    std::error_code ignored;
    fs::path whole = fs::absolute(path, ignored).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

// Resolves includes. Names towards glslang, and so in its messages, are display names.
class Includer : public glslang::TShader::Includer {
public:
    Includer(const fs::path& root, std::vector<fs::path>& dependencies) : m_root(root), m_dependencies(dependencies) {}

    std::string display(const fs::path& file) {
        const fs::path relative = file.lexically_relative(m_root);
        const bool below = !relative.empty() && *relative.begin() != "..";
        std::string shown = (below ? m_root.filename() / relative : file).generic_string();
        m_files[shown] = file;
        return shown;
    }

    IncludeResult* includeLocal(const char* wanted, const char* includer, size_t depth) override {
        const auto from = m_files.find(includer);
        const fs::path beside = from == m_files.end() ? fs::path() : (from->second.parent_path() / wanted).lexically_normal();
        std::error_code ignored;
        return include(
            !beside.empty() && fs::is_regular_file(beside, ignored) ? beside : (m_root / wanted).lexically_normal(), wanted, depth);
    }
    IncludeResult* includeSystem(const char* wanted, const char*, size_t depth) override {
        const fs::path own = (m_root / wanted).lexically_normal();
        std::error_code ignored;
        return include(fs::is_regular_file(own, ignored) ? own : fs::path(OBSCURA_SHADER_INCLUDE) / wanted, wanted, depth);
    }
    void releaseInclude(IncludeResult*) override {}  // they live as long as the includer

private:
    IncludeResult* refuse(std::string why) {
        m_texts.push_back(std::move(why));
        m_results.push_back(std::make_unique<IncludeResult>("", m_texts.back().data(), m_texts.back().size(), nullptr));
        return m_results.back().get();
    }
    IncludeResult* include(const fs::path& file, const char* wanted, size_t depth) {
        constexpr size_t kMaxDepth = 40;
        if (depth > kMaxDepth) return refuse(fmt::format("'{}' includes itself, or includes go too deep", wanted));
        std::string text;
        if (!readText(file, text)) return refuse(fmt::format("'{}' is neither beside this file nor in the shader folder", wanted));
        if (std::find(m_dependencies.begin(), m_dependencies.end(), file) == m_dependencies.end()) m_dependencies.push_back(file);
        // glslang leaves #pragma once to whoever includes; headers shared with C++ carry it.
        if (text.find("#pragma once") != std::string::npos && !m_once.insert(file).second) text = "\n";
        m_texts.push_back(std::move(text));
        m_results.push_back(std::make_unique<IncludeResult>(display(file), m_texts.back().data(), m_texts.back().size(), nullptr));
        return m_results.back().get();
    }

    const fs::path m_root;
    std::vector<fs::path>& m_dependencies;
    std::map<std::string, fs::path> m_files;
    std::set<fs::path> m_once;
    std::deque<std::string> m_texts;
    std::vector<std::unique_ptr<IncludeResult>> m_results;
};

// glslang writes "ERROR: name:12: 'x' : undeclared identifier " and a line that counts the errors.
std::string messages(const std::string& log, const std::string& shown, std::string_view macros) {
    const std::string variant = macros.empty() ? "" : fmt::format(" (variant {})", macros);
    std::string text;
    size_t start = 0;
    while (start < log.size()) {
        const size_t end = std::min(log.find('\n', start), log.size());
        std::string line = log.substr(start, end - start);
        start = end + 1;
        while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.pop_back();
        const bool isError = line.starts_with("ERROR: ");
        if (isError) line.erase(0, 7);
        else if (line.starts_with("INTERNAL ERROR: ")) line.erase(0, 16);
        else continue;
        if (line.empty() || line.find("compilation errors.") != std::string::npos ||
            line.find("compilation terminated") != std::string::npos)
            continue;
        // Messages about the whole shader (linking) carry no place.
        const size_t colon = line.find(':');
        const bool placed = colon != std::string::npos && colon + 1 < line.size() && line[colon + 1] >= '0' && line[colon + 1] <= '9';
        if (!placed) line = shown + ": " + line;
        text += (text.empty() ? "" : "\n") + line + variant;
    }
    return text.empty() ? shown + ": does not compile" + variant : text;
}

// "A,B=2" as two #define lines.
std::string definitions(std::string_view macros) {
    std::string text;
    while (!macros.empty()) {
        const std::string_view macro = macros.substr(0, macros.find(','));
        macros.remove_prefix(std::min(macro.size() + 1, macros.size()));
        const size_t equals = macro.find('=');
        text += fmt::format("#define {} {}\n", macro.substr(0, equals), equals == std::string_view::npos ? "1" : macro.substr(equals + 1));
    }
    return text;
}

}  // namespace

std::vector<std::string> variantsOf(const fs::path& root, const std::string& name) {
    constexpr std::string_view kPragma = "#pragma variant ";
    std::vector<std::string> names{name};
    std::ifstream in(root / name);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(kPragma))
            names.push_back(name + ":" + line.substr(kPragma.size(), line.find_last_not_of(" \r") + 1 - kPragma.size()));
    return names;
}

bool compileShader(const fs::path& givenRoot, std::string_view name, Shader& out, std::string& error, std::vector<fs::path>& dependencies) {
    static const Process process;
    error.clear();
    dependencies.clear();
    const std::string_view macros = name.substr(std::min(shaderFile(name).size() + 1, name.size()));
    const fs::path root = absoluteOf(givenRoot), file = absoluteOf(givenRoot / shaderFile(name));
    Includer includer(root, dependencies);
    const std::string shown = includer.display(file);
    dependencies.push_back(file);

    struct Stage {
        const char* extension;
        EShLanguage language;
        VkShaderStageFlagBits stage;
    };
    constexpr Stage kStages[] = {{".comp", EShLangCompute, VK_SHADER_STAGE_COMPUTE_BIT},
        {".vert", EShLangVertex, VK_SHADER_STAGE_VERTEX_BIT}, {".frag", EShLangFragment, VK_SHADER_STAGE_FRAGMENT_BIT}};
    const auto stage =
        std::find_if(std::begin(kStages), std::end(kStages), [&](const Stage& s) { return file.extension() == s.extension; });
    if (stage == std::end(kStages)) {
        error = shown + ": a shader's name ends in .comp, .vert or .frag";
        return false;
    }
    std::string source;
    if (!readText(file, source)) {
        error = shown + ": cannot be read";
        return false;
    }

    glslang::TShader shader(stage->language);
    const char* text = source.c_str();
    const int length = int(source.size());
    const char* shownName = shown.c_str();
    shader.setStringsWithLengthsAndNames(&text, &length, &shownName, 1);
    const std::string preamble = "#extension GL_GOOGLE_include_directive : enable\n" + definitions(macros);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, stage->language, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    constexpr auto kRules = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    if (!shader.parse(GetDefaultResources(), 460, false, kRules, includer)) {
        error = messages(shader.getInfoLog(), shown, macros);
        return false;
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kRules)) {
        error = messages(program.getInfoLog(), shown, macros);
        return false;
    }
    glslang::SpvOptions options;
    options.disableOptimizer = true;  // drivers optimize, and the build stays quick
    spv::SpvBuildLogger logger;
    Shader made;
    made.stage = stage->stage;
    glslang::GlslangToSpv(*program.getIntermediate(stage->language), made.spirv, &logger, &options);
    if (made.spirv.empty()) {
        error = shown + ": " + logger.getAllMessages();
        return false;
    }
    if (std::string why; !reflect(made, why)) {
        error = shown + ": " + why;
        return false;
    }
    out = std::move(made);
    return true;
}

}  // namespace obscura::gpu
