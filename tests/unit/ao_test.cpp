// The library without a GPU: falloffs, parameter tables, views from projection matrices.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "ao/prepare.h"
#include "ao/settings_text.h"

namespace obscura::ao {
namespace {

TEST(Falloff, parsesItsText) {
    Falloff f;
    ASSERT_TRUE(parseFalloff("quadratic:2", f));
    EXPECT_EQ(f.kind, FalloffKind::quadratic);
    EXPECT_FLOAT_EQ(f.length, 2.0f);
    ASSERT_TRUE(parseFalloff("ramp:0.385:1", f));
    EXPECT_FLOAT_EQ(f.end, 1.0f);
    for (const char* bad :
        {"", "quadratic", "quadratic:", "quadratic:-1", "quadratic:0", "quadratic:2x", "cubic:1", "ramp:1", "ramp:1:0.5", "linear:nan"})
        EXPECT_FALSE(parseFalloff(bad, f)) << bad;
    EXPECT_FALSE(parseFalloff(nullptr, f));
}

TEST(Falloff, textIsReadBackAsTheSameFalloff) {
    for (const char* text : {"exponential:0.5", "linear:1e-05", "quadratic:2", "wendland:0.1", "constant:1e+07", "ramp:0.385:1"}) {
        Falloff f;
        ASSERT_TRUE(parseFalloff(text, f)) << text;
        EXPECT_EQ(falloffText(f), text);
    }
    char small[8] = "unused!";
    EXPECT_EQ(formatFalloff({FalloffKind::ramp, 0.385f, 1.0f}, small, sizeof(small)), std::strlen("ramp:0.385:1"));
    EXPECT_STREQ(small, "ramp:0.");
    EXPECT_EQ(formatFalloff({}, nullptr, 0), std::strlen("quadratic:2"));
}

// A host may set a locale whose decimal point is a comma.
TEST(Falloff, valuesByFormula) {
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::exponential, 2.0f}, 1.0f), std::exp(-0.5f));
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::linear, 2.0f}, 1.0f), 0.5f);
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::quadratic, 2.0f}, 1.0f), 0.75f);
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::wendland, 2.0f}, 1.0f), 0.0625f * 3.0f);
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::constant, 2.0f}, 1.9f), 1.0f);
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::constant, 2.0f}, 2.1f), 0.0f);
    EXPECT_FLOAT_EQ(evaluate({FalloffKind::ramp, 1.0f, 3.0f}, 2.0f), 0.5f);
    for (uint32_t kind = 0; kind < 6; ++kind) {
        const Falloff f{FalloffKind(kind), 1.0f, 2.0f};
        EXPECT_FLOAT_EQ(evaluate(f, 0.0f), 1.0f);
        EXPECT_EQ(evaluate(f, reach(f) * 1.001f), 0.0f);
    }
}

TEST(Registry, tablesAreConsistent) {
    std::set<std::string> ids;
    for (const MethodInfo* info : methods()) {
        EXPECT_TRUE(ids.insert(info->id).second) << info->id << " twice";
        EXPECT_EQ(findMethod(info->id), info);
        ASSERT_GT(info->presets.size(), 0u);
        EXPECT_STREQ(info->presets[0].id, "default");
        for (const Parameter& p : info->parameters) {
            EXPECT_LE(p.minimum, p.initial) << info->id << "." << p.id;
            EXPECT_LE(p.initial, p.maximum) << info->id << "." << p.id;
            EXPECT_GT(std::string(p.sentence).size(), 10u) << info->id << "." << p.id;
        }
        for (const Preset& preset : info->presets) {
            Values values(*info);
            EXPECT_TRUE(values.apply(preset)) << info->id << " preset " << preset.id << " sets an unknown parameter";
            for (const Setting& s : preset.settings)
                EXPECT_FLOAT_EQ(values[s.id], s.value) << info->id << "." << s.id << " is out of range";
        }
    }
    EXPECT_TRUE(ids.count("none") && ids.count("hbao"));
    EXPECT_EQ(findMethod("no such"), nullptr);
}

TEST(Registry, valuesAreClampedAndRounded) {
    Values values(*findMethod("hbao"));
    EXPECT_TRUE(values.set("directions", 7.4f));
    EXPECT_EQ(values.count("directions"), 7u);
    EXPECT_TRUE(values.set("directions", 1e9f));
    EXPECT_EQ(values.count("directions"), 32u);
    EXPECT_TRUE(values.set("bias", std::nanf("")));
    EXPECT_FLOAT_EQ(values["bias"], 10.0f);
    EXPECT_FALSE(values.set("nothing", 1.0f));
}

// A projection, and the expected projection of a point.
struct Convention {
    const char* name;
    float m[16];  // columns
};
const float f = 1.5f, a = 0.8f, n = 0.1f, far_ = 100.0f;
const Convention kConventions[] = {
    {"standard", {f * a, 0, 0, 0, 0, -f, 0, 0, 0, 0, -far_ / (far_ - n), -1, 0, 0, -far_* n / (far_ - n), 0}},
    {"reversed", {f * a, 0, 0, 0, 0, -f, 0, 0, 0, 0, n / (far_ - n), -1, 0, 0, far_* n / (far_ - n), 0}},
    {"reversed infinite", {f * a, 0, 0, 0, 0, -f, 0, 0, 0, 0, 0, -1, 0, 0, n, 0}},
    {"flipped y", {f * a, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, -1, 0, 0, n, 0}},
    {"off-centre", {f * a, 0, 0, 0, 0, -f, 0, 0, 0.2f, -0.3f, 0, -1, 0, 0, n, 0}},
    {"orthographic", {0.2f, 0, 0, 0, 0, -0.25f, 0, 0, 0, 0, -1 / (far_ - n), 0, 0.1f, 0.05f, -n / (far_ - n), 1}},
    {"orthographic reversed", {0.2f, 0, 0, 0, 0, -0.25f, 0, 0, 0, 0, 1 / (far_ - n), 0, 0, 0, far_ / (far_ - n), 1}},
};

TEST(View, readsEveryDepthConventionFromTheMatrix) {
    for (const Convention& c : kConventions) {
        Frame frame;
        frame.size = {200, 120};
        frame.guard = {20, 10};
        std::copy(std::begin(c.m), std::end(c.m), frame.projection);
        shared::View view;
        const char* reason = nullptr;
        ASSERT_EQ(viewOf(frame, view, reason), Status::ok) << c.name << ": " << reason;
        EXPECT_EQ(view.visible.x, 160u);
        EXPECT_EQ(view.visible.y, 100u);
        const float point[3] = {0.7f, -0.4f, -5.0f};
        float clip[4];
        for (int row = 0; row < 4; ++row)
            clip[row] = c.m[row] * point[0] + c.m[4 + row] * point[1] + c.m[8 + row] * point[2] + c.m[12 + row];
        const float px = (clip[0] / clip[3] * 0.5f + 0.5f) * 200, py = (clip[1] / clip[3] * 0.5f + 0.5f) * 120, d = clip[2] / clip[3];
        const float depth = (d * view.linearize.x + view.linearize.y) / (d * view.linearize.z + view.linearize.w);
        EXPECT_NEAR(depth, 5.0f, 2e-3f) << c.name;
        const float scale = view.orthographic > 0.5f ? 1.0f : depth;
        EXPECT_NEAR((px * view.unproject.x + view.unproject.z) * scale, point[0], 2e-3f) << c.name;
        EXPECT_NEAR((py * view.unproject.y + view.unproject.w) * scale, point[1], 2e-3f) << c.name;
        const float upright = view.orthographic > 0.5f ? 1.0f : 5.0f;
        EXPECT_NEAR(point[0] / upright * view.project.x + view.project.z, px, 2e-2f) << c.name;
        EXPECT_GT(view.skyDepth, 50.0f) << c.name;
    }
}

TEST(View, refusesInvalidProjections) {
    Frame frame;
    shared::View view;
    const char* reason = nullptr;
    EXPECT_EQ(viewOf(frame, view, reason), Status::invalid);
    EXPECT_STREQ(reason, "Frame::size is zero");
    frame.size = {10, 10};
    EXPECT_EQ(viewOf(frame, view, reason), Status::invalid);
    frame.guard = {5, 0};
    EXPECT_EQ(viewOf(frame, view, reason), Status::invalid);
    EXPECT_NE(std::string(reason).find("guard"), std::string::npos);
}

// Shaders use only the features that DeviceDesc::device lists.
TEST(Shaders, useOnlyTheFeaturesNamedInTheHeader) {
    constexpr uint32_t kCapability = 17, kShader = 1, kExtendedFormats = 49,
                       kQuery = 50;  // SPIR-V capabilities; image queries need no feature
    const std::set<uint32_t> stated{kShader, kExtendedFormats, kQuery};
    EXPECT_GT(shaders().size(), 30u);
    for (const gpu::EmbeddedShader& shader : shaders())
        for (size_t at = 5; at < shader.spirv.size() && (shader.spirv[at] & 0xffff) == kCapability; at += shader.spirv[at] >> 16)
            EXPECT_TRUE(stated.count(shader.spirv[at + 1])) << shader.name << " declares capability " << shader.spirv[at + 1];
}

}  // namespace
}  // namespace obscura::ao
