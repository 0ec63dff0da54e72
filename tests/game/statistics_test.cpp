// Spikes of frame times are named by the pass that grew.
#include <gtest/gtest.h>

#include "app/statistics.h"

namespace obscura::app {
namespace {

graph::Timings frame(uint64_t number, double a, double b) {
    graph::Timings timings;
    timings.frame = number;
    timings.milliseconds = a + b;
    timings.passes = {{"a", a}, {"b", b}};
    return timings;
}

TEST(Spikes, areNamedByThePassThatGrew) {
    Statistics statistics(64);
    uint64_t number = 1;
    for (int i = 0; i < 32; ++i) statistics.add(frame(number++, 4.0, 2.0));
    EXPECT_TRUE(statistics.spikes().empty());
    statistics.add(frame(number++, 4.5, 9.0));
    ASSERT_EQ(statistics.spikes().size(), 1u);
    EXPECT_EQ(statistics.spikes()[0].cause, "b");
    EXPECT_DOUBLE_EQ(statistics.spikes()[0].growth, 7.0);
    EXPECT_DOUBLE_EQ(statistics.spikes()[0].median, 6.0);
    // A pass that begins costs all of its time; the frame is a spike only if it is one as a whole.
    statistics.add(frame(number++, 4.0, 2.2));
    EXPECT_EQ(statistics.spikes().size(), 1u);
}

TEST(Spikes, ofRecordingAreTheCpus) {
    Statistics statistics(64);
    for (int i = 0; i < 32; ++i) statistics.addCpu(1.0, 16.0);
    statistics.addCpu(1.2, 40.0);  // waited for something else
    EXPECT_TRUE(statistics.spikes().empty());
    statistics.addCpu(5.0, 40.0);
    ASSERT_EQ(statistics.spikes().size(), 1u);
    EXPECT_EQ(statistics.spikes()[0].cause, "recording");
}

TEST(Spikes, startWithEnoughFramesForAMedian) {
    Statistics statistics(64);
    statistics.add(frame(1, 1.0, 1.0));
    statistics.add(frame(2, 1.0, 50.0));
    EXPECT_TRUE(statistics.spikes().empty());
}

}  // namespace
}  // namespace obscura::app
