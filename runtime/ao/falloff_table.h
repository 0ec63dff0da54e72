// The falloff of far_field and mipmap as a table.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// The falloff integrated along lines [Timonen 2013, eq. 3, factored into two dimensions]: 128 KB, written by a pass only when the falloff
// changes, so the cost per frame does not depend on the falloff.
class FalloffTable {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffTable& out);
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const char* passName);

private:
    gpu::Program m_program;
    gpu::Image m_table;
    Falloff m_falloff;
    bool m_filled = false;
};

}  // namespace obscura::ao
