// Fixture of horizon_split, with the falloff linear:1.5.
#pragma once

#include "ao/method_test.h"

namespace obscura::test {

class HorizonSplitTest : public MethodTest {
protected:
    HorizonSplitTest() : MethodTest("horizon_split") {}
    using MethodTest::run;
    Picture run(const Room& room, const ao::Values& values) { return run(room, values, "linear:1.5"); }
};

// Choices of the parameter `term`.
enum Term { kBoth, kHorizon, kNormalRays, kMarching };

}  // namespace obscura::test
