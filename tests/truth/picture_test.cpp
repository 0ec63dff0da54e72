// EXR files: complete on writing; on reading complete or refused with a reason.
#include <cstring>

#include "scratch.h"
#include "truth/picture.h"

namespace {

using namespace obscura::truth;
using obscura::test::expectError;
using obscura::test::TemporaryFolder;

Picture sample() {
    Picture picture;
    Plane z(37, 21), n(37, 21);
    for (size_t i = 0; i < z.pixels(); ++i) z.values[i] = 0.1f * float(i * i), n.values[i] = -1.0f / float(i + 1);
    picture.add("Z", z);
    picture.add("N.X", n);
    picture.add("world.quadratic_2", n);
    return picture;
}

TEST(Picture, roundTripsExactly) {
    const TemporaryFolder scratch;
    writeExr(scratch / "a.exr", sample());
    EXPECT_EQ(scratch.files().size(), 1u);
    const Picture back = readExr(scratch / "a.exr");
    ASSERT_EQ(back.channels.size(), 3u);
    for (const auto& channel : sample().channels) EXPECT_EQ(back.plane(channel.name).values, channel.values) << channel.name;
    const Picture some = readExr(scratch / "a.exr", {"Z", "N.X"});
    ASSERT_EQ(some.channels.size(), 2u);
    EXPECT_EQ(some.channels[0].name, "Z");
    EXPECT_EQ(some.channels[1].name, "N.X");
}

TEST(Picture, missingChannelIsNamedWithTheExistingOnes) {
    const TemporaryFolder scratch;
    writeExr(scratch / "a.exr", sample());
    expectError([&] { readExr(scratch / "a.exr", {"Z", "N.Y"}); }, "channel N.Y is missing; there are N.X, Z, world.quadratic_2");
    expectError([&] { sample().plane("R"); }, "no channel \"R\"");
}

TEST(Picture, everyTruncationIsAnError) {
    const TemporaryFolder scratch;
    writeExr(scratch / "a.exr", sample());
    const std::string bytes = obscura::test::readText(scratch / "a.exr");
    ASSERT_GT(bytes.size(), 1000u);
    for (size_t length = 0; length < bytes.size(); length += length < 700 ? 3 : 41) {
        obscura::test::writeText(scratch / "b.exr", bytes.substr(0, length));
        EXPECT_THROW(readExr(scratch / "b.exr"), obscura::scene::Error) << length;
    }
}

// A block with wrong line numbers would leave other lines unset.
TEST(Picture, misplacedLinesAreAnError) {
    const TemporaryFolder scratch;
    writeExr(scratch / "a.exr", sample());
    std::string bytes = obscura::test::readText(scratch / "a.exr");
    // Two blocks of lines: their offset table ends where the first block begins.
    size_t table = 8;
    uint64_t offsets[2] = {};
    for (; table + 16 < bytes.size(); ++table) {
        std::memcpy(offsets, &bytes[table], 16);
        if (offsets[0] == table + 16) break;
    }
    ASSERT_LT(offsets[1], bytes.size());
    ASSERT_EQ(bytes[offsets[1]], 16);
    bytes[offsets[1]] = 0;
    obscura::test::writeText(scratch / "b.exr", bytes);
    expectError([&] { readExr(scratch / "b.exr"); }, "scan lines are out of order");
}

TEST(Picture, damageNeverCrashes) {
    const TemporaryFolder scratch;
    writeExr(scratch / "a.exr", sample());
    const std::string bytes = obscura::test::readText(scratch / "a.exr");
    uint32_t random = 1;
    for (int i = 0; i < 250; ++i) {
        std::string damaged = bytes;
        for (int k = 0; k < 3; ++k) {
            random = random * 1664525u + 1013904223u;
            damaged[(random >> 8) % (i % 2 ? damaged.size() : 600)] = char(random >> 3);
        }
        obscura::test::writeText(scratch / "b.exr", damaged);
        try {
            readExr(scratch / "b.exr");
        } catch (const obscura::scene::Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
}

TEST(Picture, wrongFileTypesAreNamed) {
    const TemporaryFolder scratch;
    expectError([&] { readExr(scratch / "none.exr"); }, "is missing");
    obscura::test::writeText(scratch / "text.exr", "not a picture");
    expectError([&] { readExr(scratch / "text.exr"); }, "is not an OpenEXR file");
}

TEST(Picture, failedWriteKeepsTheOldFile) {
    const TemporaryFolder scratch;
    expectError([&] { writeExr(scratch / "no_folder/a.exr", sample()); }, "cannot be written");
    std::filesystem::create_directory(scratch / "taken");
    expectError([&] { writeExr(scratch / "taken", sample()); }, "cannot be replaced");
    expectError([&] { writeExr(scratch / "empty.exr", Picture{}); }, "nothing to write");
    EXPECT_EQ(scratch.files().size(), 1u);
}

}  // namespace
