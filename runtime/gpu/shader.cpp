// What shaders say of themselves, as text, and the library that finds them by name and follows their source files.
#include "gpu/shader.h"

#include <algorithm>
#include <charconv>
#include <fstream>

#include <fmt/format.h>

namespace obscura::gpu {

namespace {

namespace fs = std::filesystem;

struct StageName {
    VkShaderStageFlagBits stage;
    std::string_view name;
};
constexpr StageName kStages[] = {
    {VK_SHADER_STAGE_COMPUTE_BIT, "comp"}, {VK_SHADER_STAGE_VERTEX_BIT, "vert"}, {VK_SHADER_STAGE_FRAGMENT_BIT, "frag"}};

struct KindName {
    BindingKind kind;
    std::string_view name;
};
constexpr KindName kKinds[] = {{BindingKind::sampledImage, "sampledImage"}, {BindingKind::storageImage, "storageImage"},
    {BindingKind::uniformBuffer, "uniformBuffer"}, {BindingKind::storageBuffer, "storageBuffer"}};

// Cuts the text before the separator off the front; all of it where there is none.
std::string_view cut(std::string_view& text, char separator) {
    const size_t end = std::min(text.find(separator), text.size());
    const std::string_view front = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return front;
}

bool number(std::string_view text, uint32_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

bool binding(std::string_view text, Binding& out) {
    const std::string_view set = cut(text, '.'), slot = cut(text, ':'), kind = cut(text, ':'), access = cut(text, ':');
    const auto known = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KindName& k) { return k.name == kind; });
    if (!number(set, out.set) || !number(slot, out.binding) || known == std::end(kKinds)) return false;
    if (access != "r" && access != "w" && access != "rw" && access != "-") return false;
    out.kind = known->kind;
    out.reads = access.front() == 'r';
    out.writes = access.back() == 'w';
    out.name = text;
    return true;
}

// The files a shader is made of, found by its #include lines: embedded shaders do not carry the list, and compiling all of
// them just to learn it would delay the start. May name a file too many (a disabled #include), never one too few.
void collectFiles(const fs::path& file, const fs::path& root, std::vector<fs::path>& files) {
    if (std::find(files.begin(), files.end(), file) != files.end()) return;
    std::ifstream in(file);
    if (!in) return;
    files.push_back(file);
    for (std::string line; std::getline(in, line);) {
        size_t at = line.find_first_not_of(" \t");
        if (at == std::string::npos || line[at] != '#') continue;
        at = line.find_first_not_of(" \t", at + 1);
        if (at == std::string::npos || line.compare(at, 7, "include") != 0) continue;
        const size_t open = line.find_first_of("\"<", at), close = line.find_first_of("\">", open + 1);
        if (open == std::string::npos || close == std::string::npos) continue;
        const std::string wanted = line.substr(open + 1, close - open - 1);
        std::error_code ignored;
        const fs::path beside = (file.parent_path() / wanted).lexically_normal();
        collectFiles(line[open] == '"' && fs::exists(beside, ignored) ? beside : (root / wanted).lexically_normal(), root, files);
    }
}

// Newest time and sizes added up. kGone: there is no such file (the zero of file_time_type lies in the future).
struct FileState {
    fs::file_time_type time;
    uint64_t bytes;
};
constexpr fs::file_time_type kGone = fs::file_time_type::min();

// Asks for each file once, however many shaders include it.
class FileStates {
public:
    FileState of(const fs::path& file) {
        const auto [at, fresh] = m_seen.try_emplace(file, FileState{kGone, 0});
        if (!fresh) return at->second;
        std::error_code error;
        const fs::file_time_type time = fs::last_write_time(file, error);
        const uint64_t bytes = error ? 0 : fs::file_size(file, error);
        if (!error) at->second = {time, bytes};
        return at->second;
    }
    FileState of(const std::vector<fs::path>& files) {
        FileState all{kGone, 0};
        for (const fs::path& file : files) {
            const FileState one = of(file);
            all = {std::max(all.time, one.time), all.bytes + one.bytes};
        }
        return all;
    }

private:
    std::map<fs::path, FileState> m_seen;
};

}  // namespace

std::string describe(const Shader& shader) {
    std::string_view stage = "comp";
    for (const StageName& s : kStages)
        if (s.stage == shader.stage) stage = s.name;
    std::string text =
        fmt::format("{} {} {} {} {}", stage, shader.workgroup[0], shader.workgroup[1], shader.workgroup[2], shader.pushConstantBytes);
    for (const Binding& b : shader.bindings) {
        const char* access = b.reads && b.writes ? "rw" : b.reads ? "r" : b.writes ? "w" : "-";
        text += fmt::format(" {}.{}:{}:{}:{}", b.set, b.binding, kKinds[size_t(b.kind)].name, access, b.name);
    }
    return text;
}

bool undescribe(std::string_view text, Shader& shader) {
    Shader read;
    const std::string_view stage = cut(text, ' ');
    const auto known = std::find_if(std::begin(kStages), std::end(kStages), [&](const StageName& s) { return s.name == stage; });
    if (known == std::end(kStages)) return false;
    read.stage = known->stage;
    for (uint32_t& size : read.workgroup)
        if (!number(cut(text, ' '), size)) return false;
    if (!number(cut(text, ' '), read.pushConstantBytes)) return false;
    while (!text.empty()) {
        read.bindings.emplace_back();
        if (!binding(cut(text, ' '), read.bindings.back())) return false;
    }
    read.spirv = std::move(shader.spirv);
    shader = std::move(read);
    return true;
}

void ShaderLibrary::add(std::span<const EmbeddedShader> shaders) {
    for (const EmbeddedShader& embedded : shaders) {
        Entry& entry = m_entries[embedded.name];
        entry.shader = {};
        entry.shader.spirv.assign(embedded.spirv.begin(), embedded.spirv.end());
        entry.error =
            undescribe(embedded.reflection, entry.shader) ? "" : fmt::format("{}: its embedded description is malformed", embedded.name);
        ++entry.generation;
    }
}

const Shader* ShaderLibrary::find(std::string_view name) const {
    const auto found = m_entries.find(name);
    return found == m_entries.end() ? nullptr : &found->second.shader;
}

uint64_t ShaderLibrary::generation(std::string_view name) const {
    const auto found = m_entries.find(name);
    return found == m_entries.end() ? 0 : found->second.generation;
}

void ShaderLibrary::watch(const fs::path& root, CompileShader compile) {
    m_root = root;
    m_compile = std::move(compile);
    FileStates states;
    for (auto& [name, entry] : m_entries) {
        entry.files.clear();
        collectFiles((root / shaderFile(name)).lexically_normal(), root, entry.files);
        const FileState now = states.of(entry.files);
        entry.stamp = now.time;
        entry.bytes = now.bytes;
    }
}

bool ShaderLibrary::poll() {
    if (!m_compile) return false;
    FileStates states;
    bool changed = false;
    for (auto& [name, entry] : m_entries) {
        // An editor that saves by renaming leaves a moment without the file: nothing to do then.
        if (entry.files.empty() || states.of(entry.files.front()).time == kGone) continue;
        FileState now = states.of(entry.files);
        if (now.time == entry.stamp && now.bytes == entry.bytes) continue;

        Shader compiled;
        std::string error;
        std::vector<fs::path> read;
        const fs::path main = entry.files.front();
        const bool good = m_compile(m_root, name, compiled, error, read);
        // After a failure what was known stays watched: the repair may be in a file the compiler did not get to.
        if (good) entry.files = {main};
        for (const fs::path& file : read)
            if (std::find(entry.files.begin(), entry.files.end(), file) == entry.files.end()) entry.files.push_back(file);
        now = states.of(entry.files);  // as it was before compiling, so that a save during it is seen next time
        entry.stamp = now.time;
        entry.bytes = now.bytes;
        entry.error = good ? "" : error;
        if (!good || (compiled.spirv == entry.shader.spirv && describe(compiled) == describe(entry.shader))) continue;
        entry.shader = std::move(compiled);
        ++entry.generation;
        changed = true;
    }
    return changed;
}

std::vector<std::string> ShaderLibrary::errors() const {
    std::vector<std::string> list;
    for (const auto& [name, entry] : m_entries)
        if (!entry.error.empty()) list.push_back(entry.error);
    return list;
}

}  // namespace obscura::gpu
