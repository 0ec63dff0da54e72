// Values of a method's parameters.
#pragma once

#include <span>
#include <vector>

#include "obscura/ao.h"

namespace obscura::ao {

// In the order of the method's parameter table. `info` is one of methods() (tests may have their own).
class Values {
public:
    explicit Values(const MethodInfo& info);  // initial values
    bool apply(const Preset& preset);         // initial values, then the preset's; false: it names a parameter that the method lacks
    void resolve(const Preset& preset);       // sets those parameters of one of resolvePresets() that the method has
    bool set(const char* id, float value);    // clamped; false: unknown id
    bool has(const char* id) const;
    float operator[](const char* id) const;  // asserts that it exists
    uint32_t count(const char* id) const { return uint32_t((*this)[id] + 0.5f); }
    const MethodInfo& info() const { return *m_info; }
    size_t index() const { return m_index; }  // of the method in registry(); kUnregistered for a test's own
    bool bentNormals = false;                 // the method also gives bent normals
    static constexpr size_t kUnregistered = ~size_t(0);
    std::span<const float> values() const { return m_values; }
    bool operator==(const Values&) const = default;

private:
    const MethodInfo* m_info;
    size_t m_index = kUnregistered;
    std::vector<float> m_values;
};

// Needs of a method with these values: its table's, and what optional parts of it read.
uint32_t needs(const Values& values);

// How much of the depth layers a method reads: the value of its parameter `depth_layers`, none if it has no such parameter.
enum class LayerMode : uint32_t { none, first, secondHalf, second };
LayerMode layerModeOf(const Values& values);

}  // namespace obscura::ao
