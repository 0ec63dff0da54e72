// The public header after the macros of other headers (MACROS_FIRST), or before them.
#ifdef MACROS_FIRST
#include "host_macros.h"
#endif
#include "obscura/ao.h"
#ifndef MACROS_FIRST
#include "host_macros.h"
#endif

namespace ao = obscura::ao;

ao::Result use(VkCommandBuffer cmd) {
    ao::Context* context = nullptr;
    ao::DeviceDesc desc;
    if (ao::create(desc, &context) != ao::Result::ok) return ao::Result::invalid;
    ao::MethodSettings settings;
    settings.falloff = {ao::FalloffKind::constant, 1.0f, 0.0f};
    const ao::Result set = ao::setMethod(context, "hbao", settings);
    ao::Frame frame;
    frame.normalKind = ao::NormalKind::world;
    frame.depth.layer = 1;
    const ao::Output output = ao::record(context, cmd, frame);
    ao::destroy(context);
    return output.status == ao::Result::ok ? set : output.status;
}
