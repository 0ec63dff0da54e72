#include "toasters/toaster_script.h"

#include "toasters/toaster_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::toasters {

using kit::Track;

namespace {

using Keys = std::vector<Track::Key>;

constexpr float kTau = glm::two_pi<float>();

/// Keys for a walk that gathers speed, keeps it, and comes to a stop.
void walk(Keys& keys, float from, float start, float to, float end) {
    constexpr float kRamp = 0.45f;
    const float speed = (end - start) / (to - from - kRamp);
    keys.push_back({from, start, 0.0f});
    keys.push_back({from + kRamp, start + 0.5f * speed * kRamp, speed});
    keys.push_back({to - kRamp, end - 0.5f * speed * kRamp, speed});
    keys.push_back({to, end, 0.0f});
}

/// Moves all keys by whole laps so that their times lie within the loop, in order.
Track looped(Keys keys, float gain) {
    for (Track::Key& key : keys) {
        const float laps = std::floor(key.time / kDuration);
        key.time -= laps * kDuration;
        key.value -= laps * gain;
    }
    std::sort(keys.begin(), keys.end(), [](const Track::Key& a, const Track::Key& b) { return a.time < b.time; });
    return Track(kDuration, keys, gain);
}

float wrapped(float time) { return time - std::floor(time / kDuration) * kDuration; }

/// Both frogs follow one plan half a loop and half a lap apart: leap over the other on one
/// straight, walk on, and stand still on the opposite straight to be leapt over.
Script makeFrog(float delay) {
    const Course course{{-1.2f, 0.0f}, 0.55f, 0.55f};
    const float lap = course.length();
    const Hop hop{2.2f + delay, 0.78f};
    const float landing = hop.start + hop.duration();
    const float offset = delay > 0.0f ? 0.5f * lap : 0.0f;
    const float middle = 0.5f * lap + offset;
    constexpr float kHalfLeap = 0.55f;
    const float speed = 2.0f * kHalfLeap / hop.duration();

    Keys keys;
    keys.push_back({hop.start, middle - kHalfLeap, speed});
    keys.push_back({landing, middle + kHalfLeap, speed});
    walk(keys, landing + 0.1f, middle + kHalfLeap + 0.06f, 6.7f + delay, middle + 0.5f * lap);
    walk(keys, 8.1f + delay, middle + 0.5f * lap, 12.1f + delay, middle + lap - kHalfLeap - 0.06f);

    // One full spin in the air, so that each lap turns the toy twice in all.
    const Keys spin{{hop.start, 0.0f, 0.0f}, {landing, -kTau, 0.0f}};
    Script script{course, 1.0f, looped(keys, lap), looped(spin, -kTau), {}, {}, {}, {}};
    script.hops = {{wrapped(hop.start), hop.height}};
    script.snaps = {wrapped(3.5f + delay), wrapped(6.9f + delay), wrapped(8.35f + delay), wrapped(9.8f + delay)};
    script.pops = {{wrapped(4.6f + delay), 0.8f}};
    return script;
}

/// Two rivals charge each other twice, then each turns away, walks off and comes back.
Script makeRival(float direction) {
    const Course course{{1.2f, 0.0f}, 0.55f, 0.55f};
    constexpr float kContact = 0.184f;
    Keys keys{{0.0f, -1.3f, 0.5f}, {2.5f, -kContact, 0.5f}, {2.56f, -kContact - 0.02f, -1.0f}, {2.9f, -0.42f, 0.0f}, {3.9f, -0.42f, 0.0f},
        {4.15f, -0.48f, 0.0f}, {4.55f, -kContact, 1.1f}, {4.61f, -kContact - 0.03f, -1.5f}, {5.0f, -0.56f, 0.0f}};
    walk(keys, 6.35f, -0.56f, 8.3f, -1.5f);
    keys.push_back({9.35f, -1.5f, 0.0f});
    for (Track::Key& key : keys) {
        key.value *= direction;
        key.slope *= direction;
    }
    const float half = 0.5f * kTau * direction;
    const Keys turn{{5.4f, 0.0f, 0.0f}, {6.35f, half, 0.0f}, {8.35f, half, 0.0f}, {9.3f, 0.0f, 0.0f}};
    Script script{course, direction, looped(keys, 0.0f), looped(turn, 0.0f), {}, {}, {}, {}};
    script.bumps = {2.5f, 4.55f};
    if (direction > 0.0f) {
        script.snaps = {1.2f, 3.15f, 3.55f, 7.2f};
        script.pops = {{2.52f, 0.66f}};
    } else {
        script.snaps = {0.5f, 3.35f, 3.75f, 7.9f};
        script.pops = {{4.57f, 0.74f}};
    }
    return script;
}

/// The loner walks a narrow round, leaps and spins on the spot, and catches its toast on the move.
Script makeLoner() {
    const Course course{{0.0f, 0.0f}, 0.5f, 0.3f};
    const float lap = course.length();
    const Hop hop{7.4f, 0.32f};
    const float landing = hop.start + hop.duration();
    Keys keys;
    walk(keys, 2.2f, 0.9f, 7.0f, 0.9f + 0.5f * lap);
    walk(keys, 8.3f, 0.9f + 0.5f * lap, 11.6f, 0.9f + lap);
    const Keys spin{{hop.start, 0.0f, 0.0f}, {landing, -kTau, 0.0f}};
    Script script{course, 1.0f, looped(keys, lap), looped(spin, -kTau), {}, {}, {}, {}};
    script.hops = {hop};
    script.snaps = {1.75f, 4.4f, 8.15f};
    script.pops = {{2.25f, 0.95f}, {5.4f, 0.85f}};
    return script;
}

}  // namespace

float Hop::duration() const { return 2.0f * std::sqrt(2.0f * height / kGravity); }

std::vector<Script> makeScripts() {
    constexpr float kHalfLoop = 0.5f * kDuration;
    return {makeFrog(0.0f), makeFrog(kHalfLoop), makeRival(1.0f), makeRival(-1.0f), makeLoner()};
}

}  // namespace obscura::toasters
