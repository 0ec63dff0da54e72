// The example method on an analytic frame. tests/ao/library_test.cpp runs it like every method.
#include "ao/method_test.h"

namespace obscura::test {
namespace {

struct ExampleMethod : MethodTest {
    ExampleMethod() : MethodTest("example") {}
};

TEST_F(ExampleMethod, isTheLastOfTheRegistry) { EXPECT_STREQ(ao::methods()[ao::methods().size() - 1]->id, "example"); }

TEST_F(ExampleMethod, higherBiasIsBrighter) {
    Room room;
    room.wall = -5.0f;
    room.build();
    const Picture low = run(room, values({{"bias", 0}, {"denoise", 0}}), "quadratic:2"),
                  high = run(room, values({{"bias", 0.5f}, {"denoise", 0}}), "quadratic:2");
    double lower = 0.0, higher = 0.0;
    for (const float obscurance : low) lower += obscurance;
    for (const float obscurance : high) higher += obscurance;
    EXPECT_GT(lower, 1.2 * higher);
    EXPECT_GT(higher, 0.0);
}

}  // namespace
}  // namespace obscura::test
