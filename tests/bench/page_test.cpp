// The page in a real browser, light and dark: it loads no external resource, draws its charts, and labels a dot on hover.
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "browser.h"
#include "page.h"
#include "rows.h"

namespace obscura::bench {
namespace {

namespace fs = std::filesystem;

TEST(BenchPage, drawsChartsAndLabelsDots) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("obscura-bench-page.{}", ::getpid());
    fs::create_directories(folder);
    std::vector<Row> rows{row("layered", "", 3.0, 0.03), row("hbao", "", 2.0, 0.06, true)};
    for (const double steps : {4.0, 8.0, 16.0}) {
        rows.push_back(row("hbao", fmt::format("steps={:g}", steps), 0.2 * steps, 0.3 / steps, true));
        rows.back().varied = "steps", rows.back().samples = steps;
    }
    std::ofstream(folder / "bench.html") << benchPage(results(rows));
    std::string reason;
    {
        auto browser = evaluate::Browser::start(folder / "profile", reason);
        if (!browser) GTEST_SKIP() << reason;
        for (const bool dark : {false, true}) {
            ASSERT_TRUE(browser->open("file://" + (folder / "bench.html").string(), dark ? 400 : 1200, 900, dark));
            EXPECT_EQ(browser->evaluate("document.documentElement.dataset.theme"), dark ? "dark" : "light");
            EXPECT_EQ(browser->evaluate("document.querySelectorAll('#fronts circle.dot').length"), 1);
            EXPECT_EQ(browser->evaluate("document.querySelectorAll('#fronts rect.dot').length"), 4);
            EXPECT_EQ(browser->evaluate("document.querySelectorAll('#growth .exponents tr').length"), 1);
            EXPECT_EQ(browser->evaluate("document.querySelectorAll('#table tbody tr').length"), 5);
            EXPECT_TRUE(browser->evaluate("document.documentElement.scrollWidth <= innerWidth").get<bool>());
        }
        const auto at = browser->evaluate(
            "(() => { const dot = document.querySelector('#fronts circle.dot'); dot.scrollIntoView({block: 'center'}); "
            "const r = dot.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()");
        browser->click(at[0], at[1]);
        EXPECT_EQ(browser->evaluate("document.querySelectorAll('#fronts circle.dot.marked').length"), 1);
        EXPECT_EQ(browser->evaluate("document.querySelector('#passes td').textContent"), "layered.only");
        browser->evaluate("document.querySelector('#fronts rect.dot').focus()");
        EXPECT_NE(browser->evaluate("document.getElementById('tip').textContent").get<std::string>().find("hbao"), std::string::npos);
        EXPECT_TRUE(browser->requests().empty()) << browser->requests().front();
        EXPECT_TRUE(browser->errors().empty()) << browser->errors().front();
    }
    fs::remove_all(folder);
}

}  // namespace
}  // namespace obscura::bench
