// Fixture: accuracy on stored captured frames, against references ray-traced in their geometry. The folder lies beside the
// project or is named by OBSCURA_ORACLE; without it these tests are skipped. Links Obscura::truth and needs
// OBSCURA_SOURCE_DIR.
#pragma once

#include <filesystem>

#include "ao/method_test.h"
#include "folders.h"
#include "truth/captured_frame.h"
#include "truth/metrics.h"

namespace obscura::test {

namespace fs = std::filesystem;

// A captured frame as a room's images; `frame` describes their formats and spaces.
inline Room roomOf(const truth::CapturedFrame& captured, ao::Frame& frame) {
    Room room;
    room.width = captured.size.x;
    room.height = captured.size.y;
    room.depth = captured.depth;
    for (const glm::vec3& n : captured.normals) room.normals.insert(room.normals.end(), {n.x, n.y, n.z, 0.0f});
    frame = room.frame();
    frame.guard = {captured.guard.x, captured.guard.y};
    frame.skyDepth = captured.skyDepth;
    std::memcpy(frame.projection, &captured.projection[0][0], sizeof(frame.projection));
    return room;
}

class OracleTest : public MethodTest {
protected:
    using MethodTest::MethodTest;

    fs::path folder() const { return oracleFolder(); }

    // A stored frame by its name.
    Room captured(const std::string& name, ao::Frame& frame) const {
        const fs::path folder = this->folder();
        if (!fs::exists(folder / (name + ".json")))
            skip("no " + (folder / name).string() + ".json; set OBSCURA_ORACLE to the stored references");
        return roomOf(truth::readCapture(folder / name), frame);
    }

    // name: "corner"; channel: "world.linear_1.5", of NAME.reference.exr. Metrics of obscurance over the valid visible pixels.
    truth::Metrics measure(const std::string& name, const ao::Values& values, const char* falloff, const std::string& channel) {
        ao::Frame frame;
        const Room room = captured(name, frame);
        const truth::CapturedFrame captured = truth::readCapture(folder() / name);
        truth::Plane visibility(captured.visible().x, captured.visible().y);
        visibility.values = run(room, frame, values, falloff);
        truth::Plane reference = truth::readExr(folder() / (name + ".reference.exr")).plane(channel);
        for (truth::Plane* plane : {&visibility, &reference})
            for (float& v : plane->values) v = 1.0f - v;  // both are obscurance
        const truth::Metrics metrics = truth::compare(visibility, reference, truth::Mask(captured.visibleMask()));
        printf("%-9s %s %s: eA %.4f, bias %+.4f, within 0.05 %.3f, SSIM %.3f\n", name.c_str(), m_method, channel.c_str(),
            double(metrics.raw.eA), double(metrics.raw.bias), double(metrics.raw.e5), double(metrics.ssim));
        return metrics;
    }
};

}  // namespace obscura::test
