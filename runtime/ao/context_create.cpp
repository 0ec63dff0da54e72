// create() and destroy(): adopting a host's device.
#include <string>

#include "ao/context.h"

namespace obscura::ao {
namespace {

constexpr uint32_t kMostViews = 16;

gpu::MemorySource memoryOf(const MemoryCallbacks& memory) {
    if (!memory.allocate) return {};
    gpu::MemorySource source;
    source.allocate = [memory](const VkMemoryRequirements& needs, bool mapped, bool image, gpu::MemoryBlock& block) {
        MemoryBlock given;
        const VkResult result = memory.allocate(memory.user, needs, mapped, image, given);
        block = {given.memory, given.offset, needs.size, static_cast<std::byte*>(given.mapped), given.token};
        return result;
    };
    source.free = [memory](
                      const gpu::MemoryBlock& block) { memory.free(memory.user, {block.memory, block.offset, block.mapped, block.token}); };
    return source;
}

Status adopt(const DeviceDesc& desc, const HostLog& log, Context** context) {
    const auto refuse = [&](const char* text) { return log((std::string("obscura: DeviceDesc::") + text).c_str()), Status::invalid; };
    if (!desc.instance) return refuse("instance is null");
    if (!desc.physicalDevice) return refuse("physicalDevice is null");
    if (!desc.device) return refuse("device is null");
    if (!desc.getInstanceProcAddr) return refuse("getInstanceProcAddr is null");
    if (!desc.framesInFlight)
        return refuse("framesInFlight is 0; it is the number of frames that you record before you wait for the first, 1 or more");
    if (desc.views < 1 || desc.views > kMostViews) return refuse("views is not from 1 to 16");
    if (!desc.memory.allocate != !desc.memory.free) return refuse("memory has one of its two functions; set both or neither");
    if (desc.format != VisibilityFormat::r16f && desc.format != VisibilityFormat::r8) return refuse("format is neither r16f nor r8");

    gpu::AdoptedDevice adopted;
    adopted.instance = desc.instance;
    adopted.physicalDevice = desc.physicalDevice;
    adopted.device = desc.device;
    adopted.queueFamily = desc.queueFamily;
    adopted.getInstanceProcAddr = desc.getInstanceProcAddr;
    // A call of record() takes the place of the one this many calls ago: of a frame that the GPU has finished, as a frame has at most
    // `views` calls.
    adopted.framesInFlight = desc.framesInFlight * desc.views;
    adopted.pipelineCache = desc.pipelineCache;
    adopted.allocator = desc.allocator;
    adopted.memory = memoryOf(desc.memory);
    if (desc.log)
        adopted.log = [log = desc.log, user = desc.logUser](
                          gpu::Severity severity, const char* line) { log(user, Severity(severity), line); };
    std::string error;
    struct Destroy {
        void operator()(Context* made) const { destroy(made); }
    };
    std::unique_ptr<Context, Destroy> made(new Context);
    made->log = log;
    made->format = desc.format;
    gpu::Status why = gpu::Status::ok;
    made->device = gpu::Device::adopt(adopted, error, &why);
    if (!made->device) return log(("obscura: " + error).c_str()), statusOf(why);
    made->outputs.resize(made->device->framesInFlight() + desc.views);
    made->views = desc.views;
    made->bent.resize(made->outputs.size());
    made->shaders.add(shaders());
    made->graph = std::make_unique<graph::Graph>(*made->device);
    made->executor = std::make_unique<graph::Executor>(*made->device);
    made->library = std::make_unique<Library>(*made->device, made->shaders);
    if (!made->library->valid()) return statusOf(made->device->failure());
    if (desc.format == VisibilityFormat::r8)
        if (const gpu::Status status = gpu::Program::compute(*made->device, made->shaders, "ao/common/output_r8.comp", {}, made->toR8);
            status != gpu::Status::ok)
            return statusOf(status);
    const Status status = setMethod(made.get(), "hbao", {});
    if (status == Status::ok) *context = made.release();
    return status;
}

}  // namespace

Status create(const DeviceDesc& desc, Context** context) noexcept {
    const HostLog log{desc.log, desc.logUser};
    if (!context) return log("obscura: create(): the pointer to the context is null"), Status::invalid;
    *context = nullptr;
    return guarded(log, [&] { return adopt(desc, log, context); });
}

void destroy(Context* context) noexcept {
    if (!context) return;
    context->outputs.clear();
    context->bent.clear();
    context->toR8 = {};
    context->library.reset();
    context->graph.reset();
    context->executor.reset();
    delete context;
}

}  // namespace obscura::ao
