// Periodic animation curves.
#pragma once

#include <vector>

namespace obscura::kit {

/// A value over time: smooth (cubic Hermite) between keys, repeating after `period`.
/// Each period adds `gainPerPeriod`, so that a walked distance grows from lap to lap.
class Track {
public:
    struct Key {
        float time = 0.0f;
        float value = 0.0f;
        float slope = 0.0f;
    };

    /// Keys must be sorted by time and lie in [0, period).
    Track(float period, std::vector<Key> keys, float gainPerPeriod = 0.0f);

    float operator()(float time) const;

private:
    float m_period;
    float m_gain;
    std::vector<Key> m_keys;
};

/// 0 below `from`, 1 above `to`, smooth between.
float smoothStep(float from, float to, float value);

}  // namespace obscura::kit
