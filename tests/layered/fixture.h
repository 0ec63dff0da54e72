// Fixture of layered, on frames of analytic solids with depth layers.
#pragma once

#include "ao/solids.h"

namespace obscura::test {

class LayeredTest : public MethodTest {
protected:
    LayeredTest() : MethodTest("layered") {}
};

}  // namespace obscura::test
