// The method under test and what its pictures are compared by.
#pragma once

#include "ao/method_test.h"

namespace obscura::test {

class HorizonSplitTest : public MethodTest {
protected:
    HorizonSplitTest() : MethodTest("horizon_split") {}
    using MethodTest::run;
    Picture run(const Room& room, const ao::Values& values) { return run(room, values, "linear:1.5"); }
};

// What `term` shows.
enum Term { kBoth, kHorizon, kNormalRays, kMarching };

}  // namespace obscura::test
