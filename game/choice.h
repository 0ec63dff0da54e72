// What is chosen among the library's methods: one set of values for each, which of them runs, and how far occluders reach.
#pragma once

#include <string>
#include <vector>

#include "ao/method.h"

namespace obscura::game {

class Choice {
public:
    Choice();
    const ao::Values& values() const { return m_values[m_current]; }
    ao::Values& values() { return m_values[m_current]; }
    const ao::MethodInfo& info() const { return values().info(); }
    size_t current() const { return m_current; }
    static size_t count() { return ao::methods().size(); }
    void select(size_t index) { m_current = index; }
    void selectNext(int step);

    // From text, as on a command line; throw app::Complaint that lists what there is.
    void select(const std::string& id);
    void applyPreset(const std::string& id);        // to the selected method, from its initial values on
    void applyResolve(const std::string& id);       // likewise, over what is there
    void assign(const std::string& assignment);     // "METHOD.PARAMETER=VALUE", or "PARAMETER=VALUE" for the selected one
    void assignToAll(const std::string& parameter, const std::string& value);  // and to every other method that has it
    void setFalloff(const std::string& text);
    void read(const std::string& text);             // "METHOD[:PRESET][,PARAMETER=VALUE...]", as --compare takes it

    ao::Falloff falloff;

private:
    std::vector<ao::Values> m_values;  // in the order of ao::methods()
    size_t m_current = 0;
};

std::vector<std::string> methodIds();
// Which preset the values are at this moment; null when they are nobody's.
const ao::Preset* presetOf(const ao::Values& values);
// Which of ao::resolvePresets() they are at, and how they get there: what such presets set goes back to what the method's own has first.
const ao::Preset* resolveOf(const ao::Values& values);
void resolve(ao::Values& values, const ao::Preset& preset);
std::string label(const ao::Values& values);  // "hbao", "hbao 8x4", "hbao steps=4 temporal=0.9": the first preset goes without saying
std::string falloffText(const ao::Falloff& falloff);  // as setFalloff reads it
// The options that choose these values: --method ID --preset NAME or --set ..., or the same as one --compare.
std::string asOptions(const ao::Values& values, bool compare);
inline constexpr const char* kFalloffNames[] = {"exponential", "linear", "quadratic", "wendland", "constant", "ramp"};

}  // namespace obscura::game
