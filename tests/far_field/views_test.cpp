// Views that strain the representation of points: long focal lengths, wide fields of view, pixels that are not square, great depths, and
// sky.
#include <bit>

#include "far_field/fixture.h"

namespace obscura::test {
namespace {

// A room with `depthAt(x, y)`, metres, seen with focal lengths of fx and fy px; surfaces face the camera.
template <class DepthAt> Room facing(uint32_t width, uint32_t height, uint32_t guard, float fx, float fy, DepthAt depthAt) {
    Room room;
    room.width = width;
    room.height = height;
    room.guard = guard;
    room.build();
    room.projection[0] = 2.0f * fx / float(width);
    room.projection[5] = -2.0f * fy / float(height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const size_t i = size_t(y) * width + x;
            room.depth[i] = depthAt(x, y);
            room.normals[4 * i + 1] = 0.0f;
            room.normals[4 * i + 2] = 1.0f;
        }
    return room;
}
constexpr float kSky = 1e4f;

// Mean over columns x0 ... x1 - 1 of the buffers and the middle half of the visible rows.
double columnsMean(const Room& room, const Picture& picture, uint32_t x0, uint32_t x1) {
    double sum = 0.0;
    const uint32_t height = room.visibleHeight();
    for (uint32_t y = height / 4; y < 3 * height / 4; ++y)
        for (uint32_t x = x0; x < x1; ++x) sum += picture[size_t(y) * room.visibleWidth() + x - room.guard];
    return sum / double((x1 - x0) * (3 * height / 4 - height / 4));
}

class FarFieldViews : public FarFieldTest {
protected:
    // 256 directions without averages and with samples every 3 px: close to the limit.
    ao::Values fine(float averaging = 0.0f) const {
        return values({{"directions", 32}, {"segments", 8}, {"averaging", averaging}, {"interval", 3}, {"longest", 0.25f}, {"near", 16},
            {"alternate", 0}});
    }
};

// A plane is open however small its pixels are: depths of points must be exact to a fraction of a pixel's size.
TEST_F(FarFieldViews, planesAreOpenAtLongFocalLengths) {
    for (const float focal : {500.0f, 3000.0f, 12000.0f})
        for (const float z : {0.9995f, 2.003f, 77.7f, 6001.3f}) {
            const Room room = facing(192, 128, 16, focal, focal, [&](uint32_t, uint32_t) { return z; });
            for (const char* preset : {"default", "fast", "paper_16x2", "paper_saao", "thin"})
                EXPECT_LT(highest(run(room, values({}, preset), "exponential:1")), 1e-3f)
                    << preset << ", " << z << " m, " << focal << " px";
            Room solid = room;
            solid.thickness.assign(room.depth.size(), 0.1f);
            EXPECT_LT(highest(run(solid, values({}, "layers"), "exponential:1")), 1e-3f) << "layers, " << z << " m, " << focal << " px";
        }
}

// The right part of the image is nearer than everything else, so it is open, whatever the sums over the lines to its left.
TEST_F(FarFieldViews, nearSurfacesBesideManyFarLinesAreOpen) {
    for (const float farther : {30.0f, 300.0f, 3000.0f}) {
        const Room room = facing(512, 96, 16, 400.0f, 400.0f, [&](uint32_t x, uint32_t) { return x < 432 ? farther : 2.053f; });
        for (const char* preset : {"default", "paper_8x2", "paper_16x2", "paper_saao"}) {
            const Picture picture = run(room, values({}, preset), "exponential:1");
            float most = 0.0f;
            for (uint32_t y = 0; y < room.visibleHeight(); ++y)
                for (uint32_t x = 440 - room.guard; x < room.visibleWidth(); ++x)
                    most = std::max(most, picture[y * room.visibleWidth() + x]);
            EXPECT_LT(most, 1e-3f) << preset << ", " << farther << " m";
        }
    }
}

// A post 3 m away before a background of 500 m, seen so obliquely that a view ray runs farther sideways than ahead, darkens the wall beside
// it as a point for every pixel says.
TEST_F(FarFieldViews, postAtTheEdgeOfAWideViewCounts) {
    for (const bool mirrored : {false, true}) {
        // q = -1.7 at the left edge; the wall ends at -1.3, the post at -1.2
        const Room room = facing(340, 96, 0, 100.0f, 100.0f, [&](uint32_t x, uint32_t) {
            const uint32_t from = mirrored ? 339 - x : x;
            return from < 40 ? 4.0f : from < 50 ? 3.0f : 500.0f;
        });
        const uint32_t x0 = mirrored ? 310 : 10, x1 = mirrored ? 330 : 30;
        const double expected = columnsMean(room, run(room, fine(3), "exponential:2"), x0, x1);
        EXPECT_GT(expected, 0.01);
        for (const char* preset : {"default", "paper_16x2"})
            for (const float slope : {-1.0f, 1.0f, 2.0f, -2.0f}) {
                const double found = columnsMean(room, run(room, values({{"slope", slope}}, preset), "exponential:2"), x0, x1);
                EXPECT_NEAR(found, expected, 0.16 * expected) << preset << ", slope " << slope << (mirrored ? ", mirrored" : "");
            }
    }
}

// Pixels twice as wide as high, or as high as wide, show the same wall on the same floor.
TEST_F(FarFieldViews, pixelsNeedNotBeSquare) {
    const Room square = crease(320, 240, 32);
    const auto shrunk = [&](uint32_t across, uint32_t down) {
        Room room = square;
        room.width = square.width / across;
        room.height = square.height / down;
        room.guard = 16;
        for (uint32_t y = 0; y < room.height; ++y)
            for (uint32_t x = 0; x < room.width; ++x) {
                const size_t to = size_t(y) * room.width + x;
                const float slope = -((float(y) + 0.5f) / float(room.height) * 2.0f - 1.0f) / -room.projection[5];
                const float z = slope < 0.0f ? room.floor / slope : 1e4f;
                const bool onWall = z > -room.wall;
                room.depth[to] = onWall ? -room.wall : z;
                for (size_t c = 0; c < 4; ++c) room.normals[4 * to + c] = c == (onWall ? 2u : 1u) ? 1.0f : 0.0f;
            }
        room.depth.resize(size_t(room.width) * room.height);
        room.normals.resize(room.depth.size() * 4);
        return room;
    };
    const auto exact = [](double a) {  // as exactAtWall() in walls_test.cpp
        double sum = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const double m = (i + 0.5) / 4000;
            sum += std::exp(-a / m) * std::sqrt(1.0 - m * m);
        }
        return sum * 2.0 / 3.14159265358979 / 4000;
    };
    for (const char* method : {"far_field", "mipmap"}) {
        m_method = method;
        for (const auto& [across, down] : {std::pair{1u, 1u}, {2u, 1u}, {1u, 2u}}) {
            const Room room = across * down == 1 ? square : shrunk(across, down);
            const bool mip = std::string(method) == "mipmap";
            const Picture picture =
                run(room, mip ? values({}, "dense") : values({{"directions", 16}, {"longest", 0.25f}}), "exponential:1");
            double worst = 0.0;
            int rows = 0;
            for (uint32_t y = 0; y < room.visibleHeight(); ++y) {
                const size_t i = size_t(y + room.guard) * room.width + room.width / 2;
                const double a = -room.wall - room.depth[i];
                if (room.normals[4 * i + 1] < 0.5f || a < 0.1 || a > 1.5) continue;
                worst = std::max(worst, std::abs(rowMean(room, picture, y) - exact(a)));
                ++rows;
            }
            EXPECT_GT(rows, 10);
            EXPECT_LT(worst, mip ? 0.03 : 0.02) << method << ", pixels " << across << ":" << down;
        }
    }
    m_method = "far_field";
}

// Sky counts as open: posts and poles before it darken the wall beside them by what they cover, no more and no less.
TEST_F(FarFieldViews, postsBeforeSkyBlockWhatTheyCover) {
    struct Case {
        uint32_t width, top, bottom;  // px; the post spans rows top ... bottom - 1
    };
    for (const auto& [width, top, bottom] : {Case{2, 0, 160}, {8, 0, 160}, {40, 0, 160}, {2, 60, 100}, {8, 60, 100}, {40, 80, 160}}) {
        const Room room = facing(320, 160, 16, 280.0f, 280.0f, [&](uint32_t x, uint32_t y) {
            return x < 120 ? 4.0f : x >= 160 && x < 160 + width && y >= top && y < bottom ? 3.0f : kSky;
        });
        const auto beside = [&](const ao::Values& with) { return columnsMean(room, run(room, with, "exponential:2"), 40, 110); };
        m_method = "far_field";
        const double expected = beside(fine());
        EXPECT_GT(expected, 0.005);
        for (const char* preset : {"default", "paper_8x2", "paper_16x2", "paper_saao"}) {
            // Slabs block less than the surface between points; that is another test's business.
            const double found = beside(preset[0] == 'p' ? values({{"estimator", 2}, {"longest", 0.5f}}, preset) : values({}));
            EXPECT_NEAR(found, expected, 0.3 * expected) << preset << ", " << width << " x " << bottom - top << " px";
        }
        // The pyramid averages over squares, so narrow posts fade, but they do not vanish.
        m_method = "mipmap";
        const double found = beside(values({}));
        EXPECT_GT(found, (width < 40 ? 0.04 : 0.5) * expected) << width << " x " << bottom - top << " px";
        EXPECT_LT(found, 1.1 * expected) << width << " x " << bottom - top << " px";
    }
}

// A picture and its mirror image, of a post in front of a step. Tiles of interleaving and the checkerboard of turned directions do not
// mirror, so means over 7 columns or rows are compared.
TEST_F(FarFieldViews, mirroredPicturesMirror) {
    for (const uint32_t width : {192u, 161u}) {
        const Room room = facing(width, 110, 16, 170.0f, 170.0f, [&](uint32_t x, uint32_t y) {
            return x > 60 && x < 65 ? 3.0f : x < 90 ? 3.8f : y < 50 ? 4.0f : 4.4f;
        });
        for (const bool across : {false, true}) {
            Room other = room;
            for (uint32_t y = 0; y < room.height; ++y)
                for (uint32_t x = 0; x < width; ++x)
                    other.depth[size_t(y) * width + x] =
                        room.depth[size_t(across ? y : room.height - 1 - y) * width + (across ? width - 1 - x : x)];
            for (const char* preset : {"default", "sparse", "fast", "paper_8x2", "paper_16x2", "paper_saao", "thin", "mipmap"}) {
                const bool mipmap = preset[0] == 'm', sparse = preset[0] == 's';
                m_method = mipmap ? "mipmap" : "far_field";
                const ao::Values with = mipmap ? values({}) : sparse ? values({{"lines", 1}}) : values({{"jitter", 0}}, preset);
                const Picture one = run(room, with, "exponential:1"), two = run(other, with, "exponential:1");
                const uint32_t w = room.visibleWidth(), h = room.visibleHeight();
                double sum = 0.0;
                const uint32_t length = across ? w : h, beside = across ? h : w;
                for (uint32_t at = 3; at + 3 < length; ++at) {
                    double difference = 0.0;
                    for (uint32_t u = at - 3; u <= at + 3; ++u)
                        for (uint32_t v = 0; v < beside; ++v)
                            difference += across ? double(one[v * w + u]) - double(two[v * w + w - 1 - u])
                                                 : double(one[u * w + v]) - double(two[(h - 1 - u) * w + v]);
                    sum += std::abs(difference) / (7.0 * beside);
                }
                const double tolerance = sparse || (!mipmap && with.count("interleave")) ? 0.025 : 0.008;
                EXPECT_LT(sum / (length - 6), tolerance * mean(one)) << preset << ", " << width << " px" << (across ? " across" : " down");
            }
        }
    }
    m_method = "far_field";
}

// The paper's interleaving averages neighbours within 3 % of the pixel's depth; the default asks for the tangent plane, within 1 %.
TEST_F(FarFieldViews, neighboursOfInterleavingAreAskedFor) {
    m_probe = "far_field.surfaces";
    for (const float step : {0.005f, 0.02f, 0.05f}) {
        const Room room = facing(96, 96, 8, 80.0f, 80.0f, [&](uint32_t x, uint32_t) { return x < 48 ? 4.0f : 4.0f * (1.0f - step); });
        const auto averaged = [&](float neighbours) {
            run(room, values({{"neighbours", neighbours}}, "paper_saao"), "exponential:1");
            return std::bit_cast<float>(m_probed.at(39, 40, 1));  // beside the step
        };
        const float mixed = 4.0f * (1.0f - step / 3.0f);
        EXPECT_NEAR(averaged(0), step < 0.01f ? mixed : 4.0f, 1e-4f) << step;
        EXPECT_NEAR(averaged(1), step < 0.03f ? mixed : 4.0f, 1e-4f) << step;
    }
    run(facing(96, 96, 8, 80.0f, 80.0f, [](uint32_t, uint32_t) { return 4.0f; }), values({}, "paper_saao"), "exponential:1");
    EXPECT_TRUE(m_passes.count("far_field.gather")) << "the preset has the paper's test";
}

// The blur after interleaving leaves sky open and does not lighten what is in front of it.
TEST_F(FarFieldViews, blurKeepsSkyAndSurfacesApart) {
    const Room room = facing(192, 128, 16, 200.0f, 200.0f, [&](uint32_t x, uint32_t y) { return x >= 100 ? kSky : y < 64 ? 4.0f : 3.0f; });
    for (const char* preset : {"fast", "paper_saao"}) {
        for (const Room* r : {&room}) {
            const Picture raw = run(*r, values({{"blur", 0}}, preset), "exponential:2"),
                          blurred = run(*r, values({{"blur", 0.5f}}, preset), "exponential:2");
            const uint32_t width = r->visibleWidth(), height = r->visibleHeight();
            for (uint32_t y = 0; y < height; ++y)
                for (uint32_t x = 0; x < width; ++x) {
                    const auto sky = [&](uint32_t u, uint32_t v) { return r->depth[size_t(v + 16) * r->width + u + 16] > 9e3f; };
                    float least = 1.0f;
                    for (uint32_t v = y > 2 ? y - 2 : 0; v < std::min(y + 3, height); ++v)
                        for (uint32_t u = x > 2 ? x - 2 : 0; u < std::min(x + 3, width); ++u)
                            if (!sky(u, v)) least = std::min(least, raw[v * width + u]);
                    if (sky(x, y)) ASSERT_EQ(blurred[y * width + x], 0.0f) << preset << " " << x << " " << y;
                    else ASSERT_GE(blurred[y * width + x], least - 1e-3f) << preset << " " << x << " " << y;
                }
        }
    }
}

}  // namespace
}  // namespace obscura::test
