// The selected method, the parameter values of every method, and the falloff.
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

    // From text, as on a command line. They throw app::Complaint, which lists the known names.
    void select(const std::string& id);
    void applyPreset(const std::string& id);     // to the selected method; its other parameters return to their initial values
    void applyResolve(const std::string& id);    // to the selected method, over its current values
    void assign(const std::string& assignment);  // "METHOD.PARAMETER=VALUE", or "PARAMETER=VALUE" for the selected one
    void assignToAll(const std::string& parameter, const std::string& value);  // and to all other methods that have it
    void setFalloff(const std::string& text);
    void read(const std::string& text);  // "METHOD[:PRESET][,PARAMETER=VALUE...]", as --compare takes it

    ao::Falloff falloff;

private:
    std::vector<ao::Values> m_values;  // in the order of ao::methods()
    size_t m_current = 0;
};

std::vector<std::string> methodIds();
// The method's preset that equals the values; null if none does.
const ao::Preset* presetOf(const ao::Values& values);
// The one of ao::resolvePresets() that equals the values; null if none does. resolve() applies one: parameters that any of them sets first
// return to the values of the method's preset.
const ao::Preset* resolveOf(const ao::Values& values);
void resolve(ao::Values& values, const ao::Preset& preset);
std::string label(const ao::Values& values);  // "hbao", "hbao 8x4", "hbao steps=4 temporal=0.9": the first preset's name is left out
// The options that choose these values: --method ID --preset NAME or --set ..., or the same as one --compare.
std::string asOptions(const ao::Values& values, bool compare);

}  // namespace obscura::game
