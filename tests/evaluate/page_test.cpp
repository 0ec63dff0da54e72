// The gallery in a real browser: it opens from a file, loads no external resource, its table sorts, its slider moves, its
// images and error images are drawn, and it fits a narrow screen.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "browser.h"
#include "command.h"

namespace obscura::evaluate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Gallery : public testing::Test {
protected:
    // One small page for all tests: two frames, two presets, two falloffs, two references.
    static void SetUpTestSuite() {
        s_scratch = new TemporaryFolder();
        s_made =
            new Ended(runTool(shellCommand("--gallery {} --scene toasters --camera own,path:@4 --method none,hbao --preset default,8x4 "
                                           "--size 160x90 --rays 32 --frames 2 --seed 3",
                page())));
    }
    static void TearDownTestSuite() {
        delete s_made;
        delete s_scratch;
    }
    static fs::path page() { return *s_scratch / "gallery.html"; }

    void SetUp() override {
        ASSERT_EQ(s_made->code, 0) << s_made->error;
        std::string reason;
        m_browser = Browser::start(m_profile / "profile", reason);
        if (!m_browser) GTEST_SKIP() << reason;
    }
    void TearDown() override {
        if (!m_browser) return;
        EXPECT_TRUE(m_browser->requests().empty()) << m_browser->requests().front();
        EXPECT_TRUE(m_browser->errors().empty()) << m_browser->errors().front();
    }
    void open(int width, int height, bool dark = false) {
        ASSERT_TRUE(m_browser->open("file://" + page().string(), width, height, dark));
        m_browser->evaluate("Promise.all([...document.images].map(i => i.decode().catch(() => 0)))");
    }
    json ask(const std::string& expression) { return m_browser->evaluate(expression); }
    // Polls until `holds`, for some minutes at most: images are decoded asynchronously.
    template <class Holds> json askUntil(const std::string& expression, Holds holds) {
        json answer = ask(expression);
        for (int i = 0; i < 1500 && !holds(answer); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            answer = ask(expression);
        }
        return answer;
    }
    // Scrolls an element into view and returns its centre.
    std::pair<double, double> centre(const std::string& selector) {
        const json at = ask(fmt::format(
            "(() => {{ const e = document.querySelector('{}'); e.scrollIntoView({{block: 'center'}}); const r = e.getBoundingClientRect(); "
            "return [r.x + r.width / 2, r.y + r.height / 2]; }})()",
            selector));
        return {at[0], at[1]};
    }
    void click(const std::string& selector) {
        const auto [x, y] = centre(selector);
        m_browser->click(x, y);
    }
    // Screenshots are written to the folder OBSCURA_SCREENSHOTS, if set.
    void screenshot(const char* name) {
        const std::vector<std::byte> png = m_browser->screenshot();
        EXPECT_GT(png.size(), 10000u);
        if (const char* folder = std::getenv("OBSCURA_SCREENSHOTS"))
            std::ofstream(fs::path(folder) / name, std::ios::binary)
                .write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
    }

    static inline TemporaryFolder* s_scratch = nullptr;
    static inline Ended* s_made = nullptr;
    TemporaryFolder m_profile;
    std::unique_ptr<Browser> m_browser;
};

TEST_F(Gallery, sortsByAnyColumnBothWays) {
    open(1400, 1000);
    const std::string values = "[...document.querySelectorAll('#table tbody tr')].map(r => +r.cells[10].textContent)";
    EXPECT_EQ(ask("document.querySelectorAll('#table tbody tr').length"), 2 * 3 * 2 * 2);
    click("th button[data-key=ssim]");
    std::vector<double> ssim = ask(values);
    EXPECT_TRUE(std::is_sorted(ssim.begin(), ssim.end()));
    EXPECT_LT(ssim.front(), ssim.back());
    EXPECT_EQ(ask("document.querySelector('th button[data-key=ssim]').parentElement.getAttribute('aria-sort')"), "ascending");
    click("th button[data-key=ssim]");
    ssim = ask(values).get<std::vector<double>>();
    EXPECT_TRUE(std::is_sorted(ssim.rbegin(), ssim.rend()));
    // By keyboard: the button keeps focus.
    ask("document.querySelector('th button[data-key=label]').focus()");
    m_browser->evaluate("0");
    ask("document.activeElement.click()");
    std::vector<std::string> labels = ask("[...document.querySelectorAll('#table tbody tr')].map(r => r.cells[0].textContent)");
    EXPECT_EQ(labels.front(), "hbao");
    EXPECT_EQ(labels.back(), "none");
    EXPECT_EQ(ask("document.activeElement.dataset.key"), "label");
    screenshot("gallery-table.png");
}

TEST_F(Gallery, sliderFollowsPointerAndKeys) {
    open(1400, 1000);
    const std::string split = "+document.getElementById('split').value",
                      clip = "getComputedStyle(document.getElementById('picture-left')).clipPath";
    EXPECT_EQ(ask(split), 50);
    const auto [x, y] = centre("#slider");
    const double width = ask("document.getElementById('slider').getBoundingClientRect().width");
    m_browser->drag(x, y, x + 0.3 * width, y);
    EXPECT_NEAR(ask(split).get<double>(), 80.0, 2.0);
    const std::string after = ask(clip);
    const double before = ask(split);
    m_browser->key("ArrowLeft", 37);
    EXPECT_LT(ask(split).get<double>(), before);
    EXPECT_NE(ask(clip), after);
    // The screenshot shows the reference left of the handle and the method right of it.
    EXPECT_EQ(ask("document.getElementById('tag-left').textContent"), "world reference");
    EXPECT_NE(ask("document.getElementById('picture-left').src"), ask("document.getElementById('picture-right').src"));
    screenshot("gallery-slider.png");
}

TEST_F(Gallery, choosingAFrameChangesImagesAndErrors) {
    open(1400, 1000);
    const std::string sum =
        "(() => { const c = document.getElementById('error'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; "
        "let s = 0; for (const v of d) s += v; return s; })()";
    constexpr double kBlack = 160 * 90 * 255;  // opacity alone
    const auto drawn = [](const json& value) { return value.is_number() && value.get<double>() > kBlack + 160 * 90 * (12 * 2 + 16); };
    const json error = askUntil(sum, drawn), picture = ask("document.getElementById('picture-right').src"),
               numbers = ask("document.getElementById('numbers').textContent");
    EXPECT_TRUE(drawn(error)) << error;
    ask("(() => { const s = document.getElementById('shot'); s.value = '1'; s.dispatchEvent(new Event('change', {bubbles: true})); })()");
    EXPECT_NE(askUntil(sum, [&](const json& value) { return value != error; }), error);
    EXPECT_NE(ask("document.getElementById('picture-right').src"), picture);
    EXPECT_NE(ask("document.getElementById('numbers').textContent"), numbers);
    click("#grid button[data-name=none]");
    EXPECT_EQ(ask("document.getElementById('tag-right').textContent"), "none");
    click("#show-errors");
    EXPECT_EQ(ask("document.querySelectorAll('#grid canvas').length"), 3);
    EXPECT_EQ(ask("document.querySelectorAll('.charts svg').length"), 4);
    ask("(() => { const f = document.getElementById('filter'); f.value = 'none world'; f.dispatchEvent(new Event('input')); })()");
    EXPECT_EQ(ask("document.querySelectorAll('#table tbody tr').length"), 2 * 2);
}

TEST_F(Gallery, fitsANarrowDarkScreen) {
    open(390, 900, true);
    EXPECT_EQ(ask("document.documentElement.dataset.theme"), "dark");
    EXPECT_LE(ask("document.documentElement.scrollWidth"), 390);
    const std::string background = ask("getComputedStyle(document.body).backgroundColor");
    screenshot("gallery-narrow-dark.png");
    click("#theme");
    EXPECT_NE(ask("getComputedStyle(document.body).backgroundColor"), background);
}

}  // namespace
}  // namespace obscura::evaluate
