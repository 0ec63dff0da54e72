// A left-handed engine by the README's recipe: camera and world look down +z.
#include "api/host.h"

namespace obscura::ao {
namespace {

class LeftHanded : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    test::Host m_host{m_device};
    void TearDown() override {
        m_host.clear();
        GpuTest::TearDown();
    }
};

TEST_F(LeftHanded, engineSeesTheSame) {
    test::Geometry g;
    g.visible = {40, 24};
    g.guard = {4, 4};
    const test::Picture picture = test::trace(g);
    const test::Shot shot{g, {test::Depth::reversed, VK_FORMAT_D32_SFLOAT}, {.kind = NormalKind::world}};
    Frame frame = m_host.frame(shot, picture);
    ASSERT_EQ(create(m_host.desc(), &m_host.context), Status::ok) << m_host.allSaid();
    ASSERT_EQ(setMethod(m_host.context, "hbao", {}), Status::ok);
    const std::vector<float> expected = m_host.pixels(m_host.record(frame), g.visible);

    // What such an engine has: its matrices and normals are those of the mirror image in z.
    const std::vector<std::byte> coded = test::encodeNormals(g, shot.normals, picture);
    std::vector<float> normals(coded.size() / sizeof(float));
    std::memcpy(normals.data(), coded.data(), coded.size());
    for (size_t i = 2; i < normals.size(); i += 4) normals[i] = -normals[i];
    frame.normals = m_host.floats("mirrored normals", VK_FORMAT_R32G32B32A32_SFLOAT, frame.size, normals);
    for (int row = 0; row < 4; ++row) frame.projection[8 + row] = -frame.projection[8 + row];
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if ((column == 2) != (row == 2)) frame.eyeFromWorld[4 * column + row] = -frame.eyeFromWorld[4 * column + row];
    EXPECT_EQ(m_host.record(frame).status, Status::invalid);
    EXPECT_TRUE(m_host.said("looks down +z")) << m_host.allSaid();

    // The README's lines.
    for (int row = 0; row < 4; ++row) frame.projection[8 + row] = -frame.projection[8 + row];
    for (int column = 0; column < 4; ++column) frame.eyeFromWorld[4 * column + 2] = -frame.eyeFromWorld[4 * column + 2];
    const Output output = m_host.record(frame);
    ASSERT_EQ(output.status, Status::ok) << m_host.allSaid();
    EXPECT_EQ(m_host.pixels(output, g.visible), expected);
}

}  // namespace
}  // namespace obscura::ao
