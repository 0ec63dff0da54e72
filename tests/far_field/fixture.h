// Fixture of far_field and mipmap.
#pragma once

#include "ao/falloff_table.h"
#include "ao/method_test.h"
#include "ao/methods/far_field/grid.h"

namespace obscura::test {

class FarFieldTest : public MethodTest {
protected:
    FarFieldTest() : MethodTest("far_field") {}
};

inline bool finite(const Picture& picture) {
    return std::all_of(picture.begin(), picture.end(), [](float v) { return v >= 0.0f && v <= 1.0f; });
}

}  // namespace obscura::test
