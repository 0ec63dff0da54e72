// Long run: methods, presets, parameters, sizes and scenes change at random, seeded, under synchronization validation. No message may
// appear, memory must return to its initial value, and a warm frame creates no Vulkan object and records the same work as others of its
// kind. A few hundred frames in the regular suite; OBSCURA_SOAK sets another number.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>

#include <malloc.h>
#include <unistd.h>

#include "api/host.h"
#include "gpu/vulkan_counter.h"

namespace obscura::ao {
namespace {

uint64_t residentBytes() {
    malloc_trim(0);  // return freed heap pages to the system
    std::ifstream file("/proc/self/statm");
    uint64_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * uint64_t(sysconf(_SC_PAGESIZE));
}

class Soak : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    test::Host m_host{m_device};
    std::mt19937 m_random{20130717};
    std::vector<Frame> m_scenes;  // frames of several sizes, cameras and conventions
    test::VulkanCounter m_counter{m_device};
    struct Work {
        size_t dispatches = 0;
        uint64_t workgroups = 0;
        bool operator==(const Work&) const = default;
    };
    std::map<std::string, Work> m_work;   // of a warm frame, by kind
    uint32_t m_warm = 0, m_compared = 0;  // frames: warm ones, and those whose kind was recorded before
    uint64_t m_dispatches = 0;            // in warm frames
    std::string m_last;
    uint32_t m_streak = 0;  // frames of the same kind before this one

    void TearDown() override {
        m_host.clear();
        GpuTest::TearDown();
    }
    uint32_t any(uint32_t count) { return std::uniform_int_distribution<uint32_t>(0, count - 1)(m_random); }

    void makeScenes() {
        const VkExtent2D sizes[] = {{64, 36}, {96, 54}, {97, 61}, {160, 90}};
        for (uint32_t i = 0; i < 8; ++i) {
            test::Geometry g;
            g.visible = sizes[i % 4];
            g.guard = {8 * (i % 3), 8 * (i % 3)};
            g.camera.eye += glm::dvec3(0.7, -0.2, 0.5) * double(i / 4);
            g.orthographic = i == 5;
            const test::Picture picture = test::trace(g);
            const std::string set = " " + std::to_string(i);
            Frame f =
                m_host.frame({g, {i % 2 ? test::Depth::linear : test::Depth::reversed, VK_FORMAT_R32_SFLOAT}, {i == 3}}, picture, set);
            f.motion = m_host.floats("motion" + set, VK_FORMAT_R32G32_SFLOAT, f.size, std::vector<float>(picture.depth.size() * 2, 0.25f));
            m_scenes.push_back(f);
        }
    }
    // Random settings: a preset, a resolve preset, and one parameter in the cheaper part of its range.
    void choose(const MethodInfo& info, std::string& label) {
        const Preset& preset = info.presets[any(uint32_t(info.presets.size()))];
        MethodSettings settings;
        settings.preset = preset.id;
        const char* const resolves[] = {nullptr, "raw", "spatial", "temporal"};
        settings.resolve = resolves[any(4)];
        settings.falloff = {FalloffKind(any(5)), 0.5f + 0.5f * float(any(4)), 0.0f};
        Setting setting{};
        if (info.parameters.size() && any(2)) {
            const Parameter& parameter = info.parameters[any(uint32_t(info.parameters.size()))];
            setting = {parameter.id,
                parameter.minimum +
                    (std::min(parameter.maximum, 2.0f * std::max(parameter.initial, 1.0f)) - parameter.minimum) * float(any(5)) / 4.0f};
            settings.settings = {&setting, 1};
        }
        ASSERT_EQ(setMethod(m_host.context, info.id, settings), Status::ok) << m_host.allSaid();
        label = std::string(info.id) + "." + preset.id + "." + (settings.resolve ? settings.resolve : "") + "." +
                (setting.id ? setting.id : "") + std::to_string(setting.value) + std::to_string(int(settings.falloff.kind)) +
                std::to_string(settings.falloff.length);
    }
    void run(Frame f, const std::string& label) {
        m_counter.clear();
        const Output output = m_host.record(f);
        ASSERT_EQ(output.status, Status::ok) << label << "\n" << m_host.allSaid();
        m_streak = label == m_last ? m_streak + 1 : 0;
        m_last = label;
        if (label.empty() || m_streak < 3) return;  // the first ones create images and pipelines
        ++m_warm;
        for (const auto& [what, count] : m_counter.created) EXPECT_EQ(count, 0u) << what << " in a warm frame of " << label;
        const Work work{m_counter.dispatches.size(), m_counter.workgroups()};
        m_dispatches += work.dispatches;
        const auto [at, first] = m_work.try_emplace(label, work);
        m_compared += !first;
        EXPECT_EQ(work.dispatches, at->second.dispatches) << label;
        EXPECT_EQ(work.workgroups, at->second.workgroups) << label;
    }
    // Records the same frames of every method in turn; memory is measured afterwards.
    void round() {
        for (const MethodInfo* info : methods())
            for (const char* resolve : {"temporal", "raw"}) {
                MethodSettings settings;
                settings.resolve = resolve;
                ASSERT_EQ(setMethod(m_host.context, info->id, settings), Status::ok);
                for (int i = 0; i < 3; ++i) run(m_scenes[3], "");
            }
        for (int i = 0; i < 40; ++i) run(m_scenes[3], "");  // unused pool resources are released after many frames
    }
};

TEST_F(Soak, longRunLeaksNothingAndStaysWarm) {
    const char* asked = std::getenv("OBSCURA_SOAK");
    const uint32_t frames = asked ? uint32_t(std::strtoul(asked, nullptr, 10)) : 300;
    DeviceDesc desc = m_host.desc();
    desc.getInstanceProcAddr = &test::VulkanCounter::instanceProc;
    ASSERT_EQ(create(desc, &m_host.context), Status::ok);
    makeScenes();
    uint64_t device[2] = {}, resident[2] = {};
    uint32_t done = 0, switches = 0, cuts = 0, resizes = 0;
    const auto soak = [&](uint32_t until) {
        uint32_t scene = 0, index = 0;
        std::string label;
        for (bool first = true; done < until; first = false) {
            if (first || any(12) == 0) {
                choose(*methods()[any(uint32_t(methods().size()))], label);
                if (HasFatalFailure()) return;
                ++switches;
            }
            if (any(9) == 0) {
                const uint32_t next = any(uint32_t(m_scenes.size()));
                resizes += m_scenes[next].size.width != m_scenes[scene].size.width;
                scene = next;
            }
            Frame f = m_scenes[scene];
            f.index = index++;
            f.cut = any(20) == 0;
            cuts += f.cut;
            if (any(16) == 0) f.normals = {};
            if (any(16) == 0) f.motion = {};
            if (any(16) == 0) f.layers = {};
            if (any(16) == 0) f.volume = {};
            const bool whole = f.normals.image && f.motion.image && f.layers.thickness.image && f.volume.buffer;
            run(f, whole ? label + " scene " + std::to_string(scene) + (f.cut ? " cut" : "") : "");
            if (HasFatalFailure()) return;
            ++done;
        }
    };
    round();
    soak(frames / 2);  // nearly every pipeline is compiled by then; the driver never frees compiled code
    round();
    device[0] = memoryUse(m_host.context);
    resident[0] = residentBytes();
    soak(frames);
    round();
    device[1] = memoryUse(m_host.context);
    resident[1] = residentBytes();
    std::printf("  %u frames, %u switches, %u resizes, %u cuts; device memory %.2f to %.2f MiB, resident %.1f to %.1f MiB\n", done,
        switches, resizes, cuts, double(device[0]) / 1048576, double(device[1]) / 1048576, double(resident[0]) / 1048576,
        double(resident[1]) / 1048576);
    std::printf("  %u warm frames, %u compared with others of their kind\n", m_warm, m_compared);
    EXPECT_EQ(device[1], device[0]);
    EXPECT_GT(m_warm, frames / 30);
    EXPECT_GT(m_compared, frames / 60);
    EXPECT_GT(m_dispatches, m_warm);
    if (asked) {  // a short run cannot tell a leak from first use
        EXPECT_LE(double(resident[1]), 1.01 * double(resident[0]));
    }
}

}  // namespace
}  // namespace obscura::ao
