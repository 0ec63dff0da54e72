// The same frame in every convention and format that ao.h accepts, for every method. Its visibility must equal that of the canonical frame:
// linear depth in R32F, eye-space normals in RGBA32F. Cases that change size, projection or camera have their own canonical frame.
// All methods share the passes that read formats, so hbao runs every case and each other method a different few of each kind, together all
// of them. The test preset `thorough` runs every case for every method.
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "api/host.h"

namespace obscura::ao {
namespace {

using test::Depth;
using test::DepthCoding;
using test::Geometry;
using test::Shot;

constexpr double kStep = 1.0 / 255.0;

struct Deviation {
    double mean = 0.0, worst = 0.0;  // of visibility
    size_t over = 0;                 // pixels that deviate by more than 2/255
    size_t where = 0;                // the worst pixel
};

Deviation deviation(const std::vector<float>& a, const std::vector<float>& b) {
    Deviation d;
    if (a.size() != b.size() || a.empty()) return {1.0, 1.0, a.size()};
    for (size_t i = 0; i < a.size(); ++i) {
        const double off = std::abs(double(a[i]) - b[i]);
        if (!(a[i] >= 0.0f && a[i] <= 1.0f) || !(b[i] >= 0.0f && b[i] <= 1.0f)) return {1.0, 1.0, a.size()};  // rejects NaN as well
        d.mean += off / double(a.size());
        if (off > d.worst) d.worst = off, d.where = i;
        d.over += off > 2.0 * kStep;
    }
    return d;
}

// One line of the printed table: the cases of one kind, and the case of largest deviation.
struct Row {
    std::string kind;
    size_t cases = 0;
    Deviation worst;
    std::string which;
    void add(const std::string& name, const Deviation& d) {
        ++cases;
        worst.mean = std::max(worst.mean, d.mean);
        worst.over = std::max(worst.over, d.over);
        if (d.worst >= worst.worst) which = name;
        worst.worst = std::max(worst.worst, d.worst);
        if (std::getenv("OBSCURA_EVERY_CASE"))  // to find the cause of a failure
            std::printf("    %-14s %-44s mean %.3f worst %.2f over %zu at %zu\n", kind.c_str(), name.c_str(), d.mean * 255, d.worst * 255,
                d.over, d.where);
    }
};

class Conventions : public test::GpuTest, public testing::WithParamInterface<const char*> {
protected:
    gpu::Device& m_device = test::device();
    test::Host m_host{m_device};
    const MethodInfo& m_info = *findMethod(GetParam());
    std::vector<Row> m_rows;
    double m_scale = 0.0;
    const bool m_every = std::getenv("OBSCURA_THOROUGH") || std::string(GetParam()) == "hbao";

    // All cases of a kind, or `count` of them in a run that is not thorough.
    template <class T> std::vector<T> some(const std::vector<T>& all, size_t count) const {
        if (m_every || count >= all.size()) return all;
        const size_t method = size_t(std::find(methods().begin(), methods().end(), &m_info) - methods().begin());
        std::vector<T> chosen;
        for (size_t i = 0; i < count; ++i) chosen.push_back(all[(method + i * all.size() / count) % all.size()]);
        return chosen;
    }

    void SetUp() override {
        GpuTest::SetUp();
        ASSERT_EQ(create(m_host.desc(), &m_host.context), Status::ok);
    }
    void TearDown() override {
        size_t cases = 0;
        for (const Row& row : m_rows) {
            std::printf("  %-20s %-16s %3zu cases | worst mean %6.3f | worst pixel %6.2f, at most %4zu over 2 (in 255ths) | %s\n",
                m_info.id, row.kind.c_str(), row.cases, row.worst.mean * 255, row.worst.worst * 255, row.worst.over, row.which.c_str());
            cases += row.cases;
        }
        std::printf("  %-20s %-16s %3zu cases\n", m_info.id, "all", cases);
        m_host.clear();
        GpuTest::TearDown();
    }
    Row& row(const std::string& kind) {
        m_rows.push_back({kind});
        return m_rows.back();
    }

    // The method at its defaults; its lengths and the falloff are multiplied by the scale of the world.
    void choose(double scale, std::vector<Setting> settings = {}) {
        for (const Parameter& parameter : m_info.parameters)
            if (std::string(parameter.unit) == "m") settings.push_back({parameter.id, float(parameter.initial * scale)});
        MethodSettings chosen;
        chosen.settings = {settings.data(), settings.size()};
        chosen.falloff = {FalloffKind::quadratic, float(1.5 * scale), 0.0f};
        ASSERT_EQ(setMethod(m_host.context, m_info.id, chosen), Status::ok) << m_host.allSaid();
        m_scale = scale;
    }
    std::vector<float> run(const Shot& shot, const test::Picture& picture) {
        if (m_scale != shot.geometry.scale) choose(shot.geometry.scale);
        const Output output = m_host.record(m_host.frame(shot, picture));
        EXPECT_EQ(output.status, Status::ok) << m_host.allSaid();
        return output.status == Status::ok ? m_host.pixels(output, shot.geometry.visible) : std::vector<float>{};
    }
    // Fails if mean or worst deviation exceeds the given number of 255ths.
    void within(const Row& row, double mean, double worst) const {
        EXPECT_LE(row.worst.mean, mean * kStep) << m_info.id << ", " << row.kind << ": " << row.which;
        EXPECT_LE(row.worst.worst, worst * kStep) << m_info.id << ", " << row.kind << ": " << row.which;
    }
};

struct Named {
    std::string name;
    DepthCoding coding;
};

std::vector<Named> depthCodings() {
    const std::pair<const char*, Depth> kinds[] = {{"standard", Depth::standard}, {"reversed", Depth::reversed},
        {"infinite", Depth::infinite}, {"reversed infinite", Depth::reversedInfinite}};
    const struct {
        const char* name;
        VkFormat format;
        VkImageLayout layout;
    } formats[] = {{"D16", VK_FORMAT_D16_UNORM, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL},
        {"X8D24", VK_FORMAT_X8_D24_UNORM_PACK32, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL},
        {"D24S8", VK_FORMAT_D24_UNORM_S8_UINT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL},
        {"D32", VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {"D32S8", VK_FORMAT_D32_SFLOAT_S8_UINT, VK_IMAGE_LAYOUT_GENERAL}, {"R32F", VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL}};
    std::vector<Named> codings;
    for (const auto& [name, kind] : kinds)
        for (const auto& f : formats) {
            if (!test::device().formatSupports(f.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) continue;
            codings.push_back({std::string(name) + " " + f.name, {kind, f.format, 1.0, 20.0, f.layout}});
            if (f.format != VK_FORMAT_D16_UNORM)
                codings.push_back({std::string(name) + " " + f.name + " 0.1 to 1000 m", {kind, f.format, 0.1, 1000.0, f.layout}});
        }
    return codings;
}

TEST_P(Conventions, giveTheVisibilityOfTheCanonicalFrame) {
    const Geometry base;
    const test::Picture seen = test::trace(base);
    const std::vector<float> canonical = run({base}, seen);
    const double open = std::accumulate(canonical.begin(), canonical.end(), 0.0) / double(canonical.size());
    EXPECT_LT(open, std::string(m_info.id) == "none" ? 1.01 : 0.995);  // the frame has obscurance
    // Formats that round are compared twice: with the canonical frame of the rounded values, and with the exact one.
    const auto judge = [&](const std::string& name, const Shot& shot, Row& rounded, Row& exact) {
        const std::vector<float> found = run(shot, seen);
        rounded.add(name, deviation(found, run({base}, test::decoded(base, shot.depth, shot.normals, seen))));
        exact.add(name, deviation(found, canonical));
    };
    {
        Row depth{"depth"}, fromExact{"depth, exact"}, coarse{"D16"}, coarseFromExact{"D16, exact"};
        for (const Named& named : some(depthCodings(), 4)) {
            const bool is16 = named.coding.format == VK_FORMAT_D16_UNORM;
            judge(named.name, {base, named.coding}, is16 ? coarse : depth, is16 ? coarseFromExact : fromExact);
        }
        for (const Row& row : {depth, fromExact, coarse}) within(row, 2, 2);
        within(coarseFromExact, 0.5, 255);
        m_rows.insert(m_rows.end(), {depth, fromExact, coarse, coarseFromExact});
    }
    {
        using enum NormalEncoding;
        struct Encoding {
            const char* name;
            NormalEncoding encoding;
            VkFormat format;
        };
        const std::vector<Encoding> encodings = {{"RGBA32F", signedFloat, VK_FORMAT_R32G32B32A32_SFLOAT},
            {"RGBA16F", signedFloat, VK_FORMAT_R16G16B16A16_SFLOAT}, {"RGBA16 snorm", signedFloat, VK_FORMAT_R16G16B16A16_SNORM},
            {"RGBA8 snorm", signedFloat, VK_FORMAT_R8G8B8A8_SNORM}, {"RGBA8", biased, VK_FORMAT_R8G8B8A8_UNORM},
            {"RGB10A2", biased, VK_FORMAT_A2B10G10R10_UNORM_PACK32}, {"RGBA16", biased, VK_FORMAT_R16G16B16A16_UNORM},
            {"RGBA16F", biased, VK_FORMAT_R16G16B16A16_SFLOAT}, {"octahedral", octahedral32, VK_FORMAT_R32_UINT}};
        Row normals{"normals"}, fromExact{"normals, exact"};
        for (const NormalKind kind : {NormalKind::eye, NormalKind::world})
            for (const Encoding& e : some(encodings, 1))
                judge(std::string(kind == NormalKind::eye ? "eye " : "world ") + e.name, {base, {}, {false, kind, e.encoding, e.format}},
                    normals, fromExact);
        within(normals, 2, 2);
        within(fromExact, 0.5, 255);
        m_rows.insert(m_rows.end(), {normals, fromExact});
        Row& none = row("no normals");
        none.add("reconstructed", deviation(run({base, {}, {true}}, seen), canonical));
        within(none, 0.5, 255);
    }
    {
        Row sizes{"projections"};
        std::vector<std::pair<std::string, Geometry>> geometries;
        const auto geometry = [&](const std::string& name) -> Geometry& { return geometries.emplace_back(name, base).second; };
        geometry("off-centre").shift = {0.15, -0.1};
        geometry("flipped y").flipped = true;
        geometry("orthographic").orthographic = true;
        Geometry& both = geometry("orthographic, off-centre, flipped");
        both.orthographic = both.flipped = true;
        both.shift = {-0.1, 0.15};
        const auto compare = [&](Row& into) {
            for (const auto& [name, g] : some(geometries, 2)) {
                const test::Picture picture = test::trace(g);
                const std::vector<float> own = run({g}, picture);
                for (const Depth kind : {Depth::standard, Depth::reversed, Depth::reversedInfinite})
                    if ((!g.orthographic || kind != Depth::reversedInfinite) && (g.visible.width < 10000 || kind == Depth::standard))
                        into.add(name, deviation(run({g, {kind, VK_FORMAT_D32_SFLOAT}, {false, NormalKind::world}}, picture), own));
            }
            within(into, 2, 2);
            m_rows.push_back(into);
            geometries.clear();
        };
        compare(sizes);
        // An off-centre image equals a part of a larger one, a flipped image equals it upside down. Noise and depth pyramids fall on
        // other points of the surfaces, so only the mean is compared.
        Row windows{"windows"};
        for (const bool orthographic : some<int>({false, true}, 1)) {
            Geometry wide = base;
            wide.visible = {224, 144};
            wide.orthographic = orthographic;
            const auto pictureOf = [&](const Geometry& g) { return run({g, {Depth::reversed, VK_FORMAT_D32_SFLOAT}}, test::trace(g)); };
            const std::vector<float> whole = pictureOf(wide);
            Geometry aside = wide, upside = wide;
            aside.shift = glm::dvec2(64, -32) / wide.focal();
            upside.flipped = true;
            const std::vector<float> part = pictureOf(aside), turned = pictureOf(upside);
            std::vector<float> seenAside, seenWhole, back;
            for (uint32_t y = 0; y < 144; ++y)
                for (uint32_t x = 0; x < 224; ++x) {
                    back.push_back(turned.at(size_t(143 - y) * 224 + x));
                    if (x >= 160 || y >= 112) continue;
                    seenAside.push_back(part.at(size_t(y) * 224 + x));
                    seenWhole.push_back(whole.at(size_t(y + 32) * 224 + x + 64));
                }
            windows.add(orthographic ? "orthographic, off-centre" : "off-centre", deviation(seenAside, seenWhole));
            windows.add(orthographic ? "orthographic, flipped" : "flipped", deviation(back, whole));
        }
        within(windows, 2.5, 255);
        m_rows.push_back(windows);
        Row odd{"sizes"};
        VkPhysicalDeviceProperties properties;  // hosts render depth, so it is an attachment
        test::device().vk().GetPhysicalDeviceProperties(test::device().physical(), &properties);
        const uint32_t widest = std::min(16384u, properties.limits.maxFramebufferWidth);
        for (const VkExtent2D size : {VkExtent2D{1, 1}, {2, 1}, {161, 91}, {97, 61}, {333, 5}, {3, 257}, {widest, 4}}) {
            Geometry& g = geometry(std::to_string(size.width) + "x" + std::to_string(size.height));
            g.visible = size;
            g.guard = {0, 0};
        }
        compare(odd);
    }
    {
        // The guard band shows only sky, so its size must not matter. Texels of depth pyramids start at the corner of the band: a band that
        // shifts them by a fraction of a texel samples the same image at other points.
        Row guards{"guard bands"}, odd{"odd guard bands"};
        for (const VkExtent2D guard : some<VkExtent2D>({{0, 0}, {16, 16}, {32, 16}, {48, 32}, {80, 48}, {8, 5}, {33, 17}}, 2)) {
            Geometry g = base;
            g.guard = guard;
            (guard.width % 16 ? odd : guards)
                .add(std::to_string(guard.width) + "x" + std::to_string(guard.height),
                    deviation(run({g, {Depth::reversedInfinite, VK_FORMAT_D32_SFLOAT}}, test::trace(g)), canonical));
        }
        within(guards, 0.5, 3);
        within(odd, 0.5, 255);
        m_rows.insert(m_rows.end(), {guards, odd});
    }
    {
        Row scales{"world scale"};
        for (const double scale : some<double>({0.01, 0.1, 0.37, 10.0, 100.0, 1000.0}, 1)) {
            Geometry g = base;
            g.scale = scale;
            const test::Picture picture = test::trace(g);
            char name[32];
            std::snprintf(name, sizeof(name), "%g", scale);
            scales.add(std::string(name) + " linear", deviation(run({g}, picture), canonical));
            scales.add(std::string(name) + " D32",
                deviation(run({g, {Depth::reversedInfinite, VK_FORMAT_D32_SFLOAT}, {false, NormalKind::world}}, picture), canonical));
        }
        within(scales, 2, 2);
        m_rows.push_back(scales);
    }
    {
        Row far{"far origin"};
        Geometry g = base;
        for (const double metres : some<double>({1e4, 1e6}, 1)) {
            g.origin = glm::dvec3(metres, 0.0, -metres);
            far.add(metres > 1e5 ? "1e6 m" : "1e4 m",
                deviation(run({g, {Depth::reversed, VK_FORMAT_D32_SFLOAT}, {false, NormalKind::world}}, seen), canonical));
        }
        if (m_info.needs) {
            choose(1.0, {{"temporal", 0.9f}});
            std::vector<float> pictures[2];
            for (const double metres : {0.0, 1e6}) {
                Geometry before = base;
                for (uint32_t i = 0; i < 8; ++i) {
                    Geometry now = base;
                    now.camera.eye += glm::dvec3(0.05, -0.02, 0.04) * double(i);
                    now.origin = before.origin = glm::dvec3(metres, 0.0, -metres);
                    const test::Picture picture = test::trace(now);
                    Frame f = m_host.frame({now, {}, {false, NormalKind::world}}, picture);
                    f.motion = m_host.floats("motion", VK_FORMAT_R32G32_SFLOAT, f.size, test::motionOf(now, before, picture));
                    f.index = i;
                    f.cut = i == 0;
                    pictures[metres > 0.0] = m_host.pixels(m_host.record(f), now.visible);
                    before = now;
                }
            }
            far.add("1e6 m, a history that moves", deviation(pictures[1], pictures[0]));
        }
        within(far, 2, 2);
        m_rows.push_back(far);
    }
}

INSTANTIATE_TEST_SUITE_P(all, Conventions, testing::ValuesIn(test::methodIds()), [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace obscura::ao
