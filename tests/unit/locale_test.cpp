// A host's locale changes nothing: neither the C locale of a GTK or Qt program nor the C++ one.
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <string>

#include <gtest/gtest.h>

#include "../shell.h"
#include "ao/settings_text.h"
#include "obscura/ao.h"

namespace obscura::ao {
namespace {

class Comma : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

void expectPoints() {
    const struct {
        const char* text;
        bool valid;
        float length, end;
    } texts[] = {{"quadratic:1.5", true, 1.5f, 0.0f}, {"ramp:0.385:1", true, 0.385f, 1.0f}, {"quadratic:2", true, 2.0f, 0.0f},
        {"constant:1234.5", true, 1234.5f, 0.0f}, {"quadratic:1,5", false, 0.0f, 0.0f}};
    for (const auto& [text, valid, length, end] : texts) {
        Falloff falloff;
        EXPECT_EQ(parseFalloff(text, falloff), valid) << text;
        if (!valid) continue;
        EXPECT_EQ(falloff.length, length) << text;
        EXPECT_EQ(falloff.end, end) << text;
        char again[64];
        formatFalloff(falloff, again, sizeof again);
        EXPECT_STREQ(again, text);
        EXPECT_EQ(falloffText(falloff), text);
    }
}

TEST(Locale, ofTheHostsCppLibraryChangesNothing) {
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    expectPoints();
    std::locale::global(before);
}

TEST(Locale, ofTheHostsCLibraryChangesNothing) {
    const test::TemporaryFolder folder;
    if (test::runShell(test::shellCommand("localedef -i de_DE -f UTF-8 {}", folder / "de_DE.UTF-8")).code != 0)
        GTEST_SKIP() << "localedef cannot make the locale de_DE.UTF-8";
    ::setenv("LOCPATH", folder.path().c_str(), 1);
    const char* locale = std::setlocale(LC_ALL, "de_DE.UTF-8");
    if (!locale) GTEST_SKIP() << "the C library does not take the locale that localedef made";
    char shown[8];
    std::snprintf(shown, sizeof shown, "%.1f", 1.5);
    EXPECT_STREQ(shown, "1,5") << "the locale has no effect";
    expectPoints();
    std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace obscura::ao
