// The selected method, the parameter values of every method, and the falloff.
#pragma once

#include <string>
#include <vector>

#include "ao/method.h"
#include "settings.h"

namespace obscura::game {

class Choice {
public:
    Choice();
    const ao::Values& values() const { return m_values[m_current]; }
    ao::Values& values() { return m_values[m_current]; }
    const ao::Values& valuesOf(size_t method) const { return m_values[method]; }
    const ao::Values& valuesOf(const ao::MethodInfo& info) const;
    const ao::MethodInfo& info() const { return values().info(); }
    size_t current() const { return m_current; }
    static size_t count() { return ao::methods().size(); }
    void select(size_t index) { m_current = index; }
    void selectNext(int step);

    // From text, as on a command line. They throw app::Complaint, which lists the known names.
    void select(const std::string& id);
    void applyPreset(const std::string& id);     // to the selected method; its other parameters return to their initial values
    void applyResolve(const std::string& id);    // to the selected method, over its current values
    void resolveAll(const std::string& id);      // to every method
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
// The preset of the method and the one of ao::resolvePresets() over it that together equal the values. preset: null if none does; resolve:
// null if the preset's own serves.
struct Presets {
    const ao::Preset *preset = nullptr, *resolve = nullptr;
};
Presets presetsOf(const ao::Values& values);
// The resolve preset that the values hold, over any other settings; null if they hold none.
const ao::Preset* resolveOf(const ao::Values& values);
// Applies a resolve preset: parameters that any resolve preset sets first return to the values of the method's preset.
void resolve(ao::Values& values, const ao::Preset& preset);
void usePreset(ao::Values& values, const ao::Preset& preset);  // keeps the resolve preset
// "hbao", "hbao 8x4", "hbao 8x4, temporal", "hbao steps=4 denoise=0": the first preset's name is left out.
std::string label(const ao::Values& values);
// The options that choose these values: --method, and --preset or --set; or the value of --compare.
std::vector<Argument> methodOptions(const ao::Values& values);
std::string compareText(const ao::Values& values);

}  // namespace obscura::game
