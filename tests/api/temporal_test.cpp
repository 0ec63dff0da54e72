// History through the API without Frame::motion: it follows the camera, so a scene at rest looks as with motion vectors.
#include <functional>

#include "api/host.h"

namespace obscura::ao {
namespace {

using test::Geometry;
using test::Picture;

constexpr int kFrames = 12;

class CameraHistory : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    test::Host m_host{m_device};

    void SetUp() override {
        GpuTest::SetUp();
        ASSERT_EQ(create(m_host.desc(), &m_host.context), Status::ok);
    }
    void TearDown() override {
        m_host.clear();
        GpuTest::TearDown();
    }
    void choose(const char* method) {
        const Setting settings[] = {{"temporal", 0.92f}};
        MethodSettings chosen;
        chosen.settings = {settings, 1};
        chosen.falloff = {FalloffKind::quadratic, 1.5f, 0.0f};
        ASSERT_EQ(setMethod(m_host.context, method, chosen), Status::ok) << m_host.allSaid();
    }
    // The last picture of a flight.
    std::vector<float> fly(const std::function<Geometry(int)>& path, bool hasMotion) {
        std::vector<float> last;
        for (int i = 0; i < kFrames; ++i) {
            const Geometry g = path(i);
            const Picture seen = test::trace(g);
            Frame f = m_host.frame({g}, seen);
            f.cut = i == 0;
            f.index = uint64_t(i);
            if (hasMotion && i > 0)
                f.motion = m_host.floats("motion", VK_FORMAT_R32G32_SFLOAT, f.size, test::motionOf(g, path(i - 1), seen));
            else if (hasMotion)
                f.motion = m_host.floats("motion", VK_FORMAT_R32G32_SFLOAT, f.size, std::vector<float>(2 * seen.depth.size(), 0.0f));
            const Output output = m_host.record(f);
            EXPECT_EQ(output.status, Status::ok) << m_host.allSaid();
            if (i + 1 == kFrames) last = m_host.pixels(output, g.visible);
        }
        return last;
    }
};

TEST_F(CameraHistory, ofAStillSceneIsThatOfMotionVectors) {
    struct Case {
        const char* name;
        std::function<void(Geometry&, int)> change;
    };
    const Case cases[] = {{"flight", [](Geometry&, int) {}}, {"orthographic", [](Geometry& g, int) { g.orthographic = true; }},
        {"flipped, off-centre",
            [](Geometry& g, int) {
                g.flipped = true;
                g.shift = {0.15, -0.1};
            }},
        {"jitter", [](Geometry& g, int i) { g.shift = glm::dvec2(i % 3 - 1, i % 4 - 1.5) * 0.3 / g.focal(); }},
        {"zoom", [](Geometry& g, int i) { g.zoom = 1.0 + 0.03 * i; }},
        {"orthographic zoom",
            [](Geometry& g, int i) {
                g.orthographic = true;
                g.zoom = 1.0 + 0.03 * i;
            }},
        {"wide", [](Geometry& g, int) { g.visible = {333, 40}; }}};
    for (const char* method : {"hbao", "gtao"})
        for (const Case& c : cases) {
            choose(method);
            const auto path = [&](int i) {
                Geometry g;
                g.camera.eye += glm::dvec3(0.03, -0.015, -0.05) * double(i);
                g.camera.target += glm::dvec3(-0.02, 0.01, 0.0) * double(i);
                c.change(g, i);
                return g;
            };
            const std::vector<float> moved = fly(path, true), camera = fly(path, false);
            ASSERT_EQ(moved.size(), camera.size());
            double mean = 0.0, worst = 0.0;
            size_t over = 0;
            for (size_t i = 0; i < moved.size(); ++i) {
                const double off = std::abs(double(moved[i]) - camera[i]) * 255.0;
                mean += off / double(moved.size());
                worst = std::max(worst, off);
                over += off > 2.0;
            }
            std::printf("  %-6s %-20s mean %.3f, worst %.1f, %.2f %% over 2 (in 255ths)\n", method, c.name, mean, worst,
                100.0 * double(over) / double(moved.size()));
            EXPECT_LE(mean, 0.1) << method << ", " << c.name;
            EXPECT_LE(double(over), 0.005 * double(moved.size())) << method << ", " << c.name;
        }
}

// Without motion images nobody can tell what moved by itself: the log says so, once.
TEST_F(CameraHistory, withoutMotionIsLoggedOnce) {
    const auto said = [&] {
        return std::count_if(m_host.lines.begin(), m_host.lines.end(),
            [](const std::string& line) { return line.find("`temporal` without Frame::motion") != std::string::npos; });
    };
    const auto path = [](int) { return Geometry{}; };
    choose("hbao");
    fly(path, true);
    EXPECT_EQ(said(), 0);
    fly(path, false);
    EXPECT_EQ(said(), 1) << m_host.allSaid();
    choose("gtao");
    fly(path, false);
    EXPECT_EQ(said(), 1);
}

}  // namespace
}  // namespace obscura::ao
