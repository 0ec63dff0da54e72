// Accuracy on the stored captured frames, against references that were ray-traced through their geometry. The folder is
// found beside the project or named by OBSCURA_ORACLE; without it these tests are skipped.
#include <cstdlib>

#include "horizon_split/bench.h"
#include "truth/metrics.h"

namespace obscura::test {
namespace {

namespace fs = std::filesystem;

class Oracle : public HorizonSplitTest {
protected:
    truth::Metrics measure(const std::string& name, const ao::Values& values) {
        const char* named = std::getenv("OBSCURA_ORACLE");
        const fs::path folder = named && *named ? fs::path(named) : fs::path(OBSCURA_SOURCE_DIR) / ".." / "shared" / "oracle";
        if (!fs::exists(folder / (name + ".json"))) skip("no " + (folder / name).string() + ".json; set OBSCURA_ORACLE to the stored references");

        const truth::CapturedFrame captured = truth::readCapture(folder / name);
        Room room;
        room.width = captured.size.x;
        room.height = captured.size.y;
        room.depth = captured.depth;
        for (const glm::vec3& n : captured.normals) room.normals.insert(room.normals.end(), {n.x, n.y, n.z, 0.0f});
        ao::Frame frame = room.frame();
        frame.guard = {captured.guard.x, captured.guard.y};
        frame.skyDepth = captured.skyDepth;
        std::memcpy(frame.projection, &captured.projection[0][0], sizeof(frame.projection));

        truth::Plane visibility(captured.visible().x, captured.visible().y);
        visibility.values = run(room, frame, values, "linear:1.5");
        truth::Plane reference = truth::readExr(folder / (name + ".reference.exr")).plane("world.linear_1.5");
        for (truth::Plane* plane : {&visibility, &reference})
            for (float& v : plane->values) v = 1.0f - v;  // both come as obscurance
        const truth::Metrics metrics = truth::compare(visibility, reference, truth::Mask(captured.visibleMask()));
        printf("%-9s eA %.4f, bias %+.4f, within 0.05 %.3f, SSIM %.3f\n", name.c_str(), double(metrics.raw.eA), double(metrics.raw.bias),
               double(metrics.raw.e5), double(metrics.ssim));
        return metrics;
    }
};

TEST_F(Oracle, corner) {
    const truth::Metrics metrics = measure("corner", values({}));
    EXPECT_LE(metrics.raw.eA, 0.006f);
    EXPECT_GE(metrics.raw.e5, 0.98f);
    EXPECT_GE(metrics.ssim, 0.99f);
}

TEST_F(Oracle, atrium) { EXPECT_LE(measure("atrium", values({})).raw.eA, 0.020f); }

TEST_F(Oracle, sphere) { EXPECT_LE(measure("sphere", values({})).raw.eA, 0.006f); }

TEST_F(Oracle, morePreciseWhereMoreIsSpent) {
    EXPECT_LT(measure("corner", values({}, "quality")).raw.eA, measure("corner", values({})).raw.eA);
    EXPECT_LT(measure("corner", values({})).raw.eA, measure("corner", values({}, "paper_fast")).raw.eA);
}

}  // namespace
}  // namespace obscura::test
