#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spirv_cross/spirv_cross_c.h>

#include "gpu/compiler/compile.h"

namespace obscura::gpu {

namespace {

struct Context {
    spvc_context handle = nullptr;
    ~Context() {
        if (handle) spvc_context_destroy(handle);
    }
};

struct Access {
    bool reads, writes;
};

Access accessOf(spvc_compiler compiler, spvc_variable_id id, BindingKind kind) {
    if (kind == BindingKind::sampledImage || kind == BindingKind::uniformBuffer) return {true, false};
    bool nonReadable = spvc_compiler_has_decoration(compiler, id, SpvDecorationNonReadable);
    bool nonWritable = spvc_compiler_has_decoration(compiler, id, SpvDecorationNonWritable);
    if (kind == BindingKind::storageBuffer) {
        // glslang puts a block's qualifiers on each member; this gives what all of them share.
        const SpvDecoration* list = nullptr;
        size_t count = 0;
        if (spvc_compiler_get_buffer_block_decorations(compiler, id, &list, &count) == SPVC_SUCCESS)
            for (size_t i = 0; i < count; ++i) {
                nonReadable |= list[i] == SpvDecorationNonReadable;
                nonWritable |= list[i] == SpvDecorationNonWritable;
            }
    }
    return {!nonReadable, !nonWritable};
}

}  // namespace

bool reflect(Shader& shader, std::string& error) {
    Context context;
    spvc_parsed_ir ir = nullptr;
    spvc_compiler compiler = nullptr;
    spvc_resources resources = nullptr;
    const auto failed = [&] {
        error = fmt::format("reflection: {}", context.handle ? spvc_context_get_last_error_string(context.handle) : "out of memory");
        return false;
    };
    if (spvc_context_create(&context.handle) != SPVC_SUCCESS ||
        spvc_context_parse_spirv(context.handle, shader.spirv.data(), shader.spirv.size(), &ir) != SPVC_SUCCESS ||
        spvc_context_create_compiler(context.handle, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler) != SPVC_SUCCESS ||
        spvc_compiler_create_shader_resources(compiler, &resources) != SPVC_SUCCESS)
        return failed();

    struct Kind {
        spvc_resource_type type;
        BindingKind kind;
    };
    constexpr Kind kKinds[] = {{SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, BindingKind::sampledImage},
        {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, BindingKind::storageImage}, {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, BindingKind::uniformBuffer},
        {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, BindingKind::storageBuffer}};
    shader.bindings.clear();
    for (const Kind& kind : kKinds) {
        const spvc_reflected_resource* list = nullptr;
        size_t count = 0;
        if (spvc_resources_get_resource_list_for_type(resources, kind.type, &list, &count) != SPVC_SUCCESS) return failed();
        for (size_t i = 0; i < count; ++i) {
            Binding binding;
            binding.set = spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationDescriptorSet);
            binding.binding = spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationBinding);
            binding.kind = kind.kind;
            const Access access = accessOf(compiler, list[i].id, kind.kind);
            binding.reads = access.reads;
            binding.writes = access.writes;
            // The variable's name; an unnamed block goes by the block's.
            const char* own = spvc_compiler_get_name(compiler, list[i].id);
            binding.name = own && *own ? own : list[i].name ? list[i].name : "";
            if (spvc_type_get_num_array_dimensions(spvc_compiler_get_type_handle(compiler, list[i].type_id)) > 0) {
                error = fmt::format("'{}' is an array of descriptors; not every device can index those", binding.name);
                return false;
            }
            shader.bindings.push_back(std::move(binding));
        }
    }
    for (spvc_resource_type type :
        {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, SPVC_RESOURCE_TYPE_SUBPASS_INPUT}) {
        const spvc_reflected_resource* list = nullptr;
        size_t count = 0;
        if (spvc_resources_get_resource_list_for_type(resources, type, &list, &count) != SPVC_SUCCESS || count == 0) continue;
        error = fmt::format(
            "'{}': images are sampled through combined samplers (sampler2D and its like) only", list[0].name ? list[0].name : "");
        return false;
    }
    std::sort(shader.bindings.begin(), shader.bindings.end(),
        [](const Binding& a, const Binding& b) { return std::pair(a.set, a.binding) < std::pair(b.set, b.binding); });
    for (size_t i = 1; i < shader.bindings.size(); ++i) {
        const Binding &a = shader.bindings[i - 1], &b = shader.bindings[i];
        if (a.set != b.set || a.binding != b.binding) continue;
        error = fmt::format("'{}' and '{}' share set {} binding {}", a.name, b.name, a.set, a.binding);
        return false;
    }

    const spvc_reflected_resource* push = nullptr;
    size_t pushCount = 0, pushBytes = 0;
    if (spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &push, &pushCount) != SPVC_SUCCESS)
        return failed();
    if (pushCount && spvc_compiler_get_declared_struct_size(
                         compiler, spvc_compiler_get_type_handle(compiler, push[0].base_type_id), &pushBytes) != SPVC_SUCCESS)
        return failed();
    shader.pushConstantBytes = uint32_t(pushBytes);

    if (shader.stage == VK_SHADER_STAGE_COMPUTE_BIT) {
        spvc_specialization_constant axes[3] = {};
        spvc_compiler_get_work_group_size_specialization_constants(compiler, &axes[0], &axes[1], &axes[2]);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            if (axes[axis].id != 0) {
                error = "the workgroup size is written as numbers, not as local_size_x_id";
                return false;
            }
            shader.workgroup[axis] = spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, axis);
        }
    }
    return true;
}

void stripDebugInfo(std::vector<uint32_t>& spirv) {
    constexpr size_t kHeaderWords = 5;
    // OpSourceContinued, OpSource, OpSourceExtension, OpName, OpMemberName, OpLine, OpNoLine, OpModuleProcessed. OpString
    // stays: printf-like instructions refer to it.
    constexpr uint32_t kDropped[] = {2, 3, 4, 5, 6, 8, 317, 330};
    std::vector<uint32_t> kept(spirv.begin(), spirv.begin() + std::ptrdiff_t(std::min(kHeaderWords, spirv.size())));
    for (size_t at = kHeaderWords; at < spirv.size();) {
        const uint32_t words = spirv[at] >> 16, op = spirv[at] & 0xffffu;
        if (words == 0 || at + words > spirv.size()) return;  // not SPIR-V: leave it alone
        if (std::find(std::begin(kDropped), std::end(kDropped), op) == std::end(kDropped))
            kept.insert(kept.end(), spirv.begin() + std::ptrdiff_t(at), spirv.begin() + std::ptrdiff_t(at + words));
        at += words;
    }
    spirv = std::move(kept);
}

}  // namespace obscura::gpu
