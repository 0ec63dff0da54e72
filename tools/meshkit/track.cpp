#include "meshkit/track.h"

#include <algorithm>
#include <cmath>

namespace obscura::kit {

Track::Track(float period, std::vector<Key> keys, float gainPerPeriod) : m_period(period), m_gain(gainPerPeriod), m_keys(std::move(keys)) {
    Key next = m_keys.front();
    next.time += m_period;
    next.value += m_gain;
    m_keys.push_back(next);
}

float Track::operator()(float time) const {
    const float laps = std::floor((time - m_keys.front().time) / m_period);
    const float local = time - laps * m_period;
    const auto after = std::upper_bound(m_keys.begin() + 1, m_keys.end() - 1, local, [](float t, const Key& key) { return t < key.time; });
    const Key& a = *(after - 1);
    const Key& b = *after;
    const float span = b.time - a.time;
    const float u = (local - a.time) / span;
    const float u2 = u * u;
    const float u3 = u2 * u;
    return laps * m_gain + (2 * u3 - 3 * u2 + 1) * a.value + (u3 - 2 * u2 + u) * span * a.slope + (3 * u2 - 2 * u3) * b.value +
           (u3 - u2) * span * b.slope;
}

float smoothStep(float from, float to, float value) {
    const float u = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
    return u * u * (3.0f - 2.0f * u);
}

}  // namespace obscura::kit
