// Fixture: runs one method on an analytic or captured frame, under validation. A suite derives from MethodTest and names the method.
#pragma once

#include <algorithm>
#include <set>
#include <string>

#include "ao/room.h"
#include "graph/executor.h"
#include "graph/read_back.h"

namespace obscura::test {

// Obscurance (1 - visibility) of the visible part, row by row.
using Picture = std::vector<float>;

class MethodTest : public GpuTest {
protected:
    explicit MethodTest(const char* method) : m_method(method) {}
    using Changes = std::vector<ao::Setting>;  // over a preset

    void SetUp() override {
        GpuTest::SetUp();
        m_shaders.add(ao::shaders());
        m_graph = std::make_unique<graph::Graph>(m_device);
        m_executor = std::make_unique<graph::Executor>(m_device);
        m_library = std::make_unique<ao::Library>(m_device, m_shaders);
    }
    void TearDown() override {
        m_library.reset();
        m_graph.reset();
        m_executor.reset();
        GpuTest::TearDown();
    }

    ao::Values values(const Changes& changes, const std::string& presetId = "default") const {
        const ao::MethodInfo& info = *ao::findMethod(m_method);
        ao::Values result(info);
        bool found = false;
        for (const ao::Preset& preset : info.presets)
            if (presetId == preset.id) found = result.apply(preset);
        EXPECT_TRUE(found) << presetId;
        for (const ao::Setting& change : changes) EXPECT_TRUE(result.set(change.id, change.value)) << change.id;
        return result;
    }

    // Without motion vectors each run begins without history.
    Picture run(const Room& room, const ao::Values& values, const char* falloff) {
        ao::Frame frame = room.frame();
        frame.cut = room.motion.empty();
        return run(room, frame, values, falloff);
    }

    // With the room's images; `frame` describes their formats and spaces.
    Picture run(const Room& room, const ao::Frame& frame, const ao::Values& values, const char* falloff) {
        const gpu::Image depth = room.image(m_device, false), normals = room.image(m_device, true);
        ao::Falloff rho;
        EXPECT_TRUE(ao::parseFalloff(falloff, rho));
        const auto import = [&](const char* name, const gpu::Image& image) {
            graph::External external{image.handle(), image.view(), image.desc()};
            external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            return m_graph->import(name, external);
        };
        m_device.nextFrame();
        m_graph->begin();
        ao::Sources sources;
        sources.depth = import("depth", depth);
        sources.normals = import("normals", normals);
        gpu::Image thickness, second, motion;
        if (!room.motion.empty()) sources.motion = import("motion", motion = room.motionImage(m_device));
        if (!room.thickness.empty()) sources.layers.thickness = import("thickness", thickness = room.layer(m_device, false));
        if (!room.second.empty()) sources.layers.second = import("second layer", second = room.layer(m_device, true));
        if (!room.bits.empty()) sources.volume = m_graph->upload("bits", room.bits.data(), room.bits.size() * sizeof(uint32_t));
        const ao::Library::Added added = m_library->add(*m_graph, frame, sources, rho, values);
        const graph::ImageId visibility = added.visibility;
        EXPECT_TRUE(bool(visibility));
        if (!visibility) return {};
        graph::ImageId probed;
        for (const auto& written : m_graph->written())
            if (m_graph->name(written.image) == m_probe) probed = written.image;
        EXPECT_TRUE(m_probe.empty() || probed) << m_probe;
        const gpu::Buffer back = readBack(*m_graph, visibility);
        gpu::Buffer probe, bent;
        EXPECT_EQ(bool(added.bentNormals), values.bentNormals);
        if (added.bentNormals) bent = readBack(*m_graph, added.bentNormals);
        if (probed) probe = readBack(*m_graph, probed);
        m_passes.clear();
        for (const auto& written : m_graph->written()) m_passes.insert(written.pass);
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor->execute(*m_graph, cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        if (probed) {
            m_probed = {m_graph->desc(probed).width, m_graph->desc(probed).height,
                m_graph->desc(probed).format == VK_FORMAT_R32G32_UINT ? 2u : 1u, {}};
            m_probed.words.resize(size_t(m_probed.width) * m_probed.height * m_probed.each);
            std::memcpy(m_probed.words.data(), probe.mapped(), m_probed.words.size() * 4);
        }
        m_bent.clear();
        for (size_t i = 0; bent && i < size_t(room.visibleWidth()) * room.visibleHeight(); ++i) {
            auto& texel = m_bent.emplace_back();
            for (size_t c = 0; c < 4; ++c) texel[c] = float(int8_t(bent.mapped()[4 * i + c])) / 127.0f;
        }
        Picture result = halvesOf(back);
        for (float& v : result) v = 1.0f - v;
        return result;
    }

    const char* m_method;
    gpu::Device& m_device = device();
    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<graph::Graph> m_graph;
    std::unique_ptr<graph::Executor> m_executor;
    std::unique_ptr<ao::Library> m_library;
    std::set<std::string> m_passes;            // of the last run
    std::vector<std::array<float, 4>> m_bent;  // bent normals and visibility of the last run, if it was asked for them
    std::string m_probe;  // name of an image with one or two 32-bit words a texel that a pass writes; run() reads it back into m_probed
    struct {
        uint32_t width = 0, height = 0, each = 1;
        std::vector<uint32_t> words;
        uint32_t at(uint32_t x, uint32_t y, uint32_t word = 0) const { return words.at((size_t(y) * width + x) * each + word); }
    } m_probed;
};

inline double mean(const Picture& picture) {
    double sum = 0.0;
    for (const float v : picture) sum += v;
    return sum / double(picture.size());
}
// Mean over the middle half of a visible row, where the ends of a wall that spans the frame are out of reach.
inline double rowMean(const Room& room, const Picture& picture, uint32_t y) {
    double sum = 0.0;
    const uint32_t width = room.visibleWidth();
    for (uint32_t x = width / 4; x < 3 * width / 4; ++x) sum += picture[size_t(y) * width + x];
    return sum / double(width / 2);
}
inline float highest(const Picture& picture) { return *std::max_element(picture.begin(), picture.end()); }

}  // namespace obscura::test
