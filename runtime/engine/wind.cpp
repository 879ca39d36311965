// SPDX-License-Identifier: MIT
#include "hairloom/wind.h"

#include <cmath>

namespace hairloom::runtime {
namespace {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Sequence {
  public:
    explicit Sequence(std::uint64_t seed) : state_(seed) {}
    float uniform() {
        state_ += 0x9e3779b97f4a7c15ull;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        z ^= z >> 31;
        return static_cast<float>(z >> 40) * 0x1p-24f;
    }
    Float3 direction() {
        while (true) {
            const Float3 v{2.0f * uniform() - 1.0f, 2.0f * uniform() - 1.0f, 2.0f * uniform() - 1.0f};
            const float squared = dot(v, v);
            if (squared > 0.01f && squared <= 1.0f) return v * (1.0f / std::sqrt(squared));
        }
    }

  private:
    std::uint64_t state_;
};

Float3 authoredFlow(const SimulationSettings& settings) {
    const float size = length(settings.windDirection);
    if (!(size > 0.0f)) return {};
    const float speed = settings.windKind == WindKind::vehicle ? -settings.windSpeed : settings.windSpeed;
    return settings.windDirection * (speed / size);
}

/// A random direction across another.
Float3 across(Sequence& random, Float3 direction) {
    while (true) {
        const Float3 v = cross(direction, random.direction());
        const float size = length(v);
        if (size > 0.1f) return v * (1.0f / size);
    }
}

}  // namespace

Wind makeWind(const SimulationSettings& settings, const WindInput& input) {
    Wind wind{};
    wind.kind = settings.windKind;
    const Float3 authored = authoredFlow(settings);
    wind.mean = input.mean_ws.value_or(authored);
    if (wind.kind == WindKind::vehicle) wind.mean = wind.mean - input.actorVelocity_ws;
    if (wind.kind == WindKind::uniform) return wind;
    const bool eddies = wind.kind != WindKind::gusting;
    wind.strength = eddies ? 0.0f : settings.windGustiness;
    // Independent waves add in squares: this amplitude makes the root mean square of the eddies
    // windGustiness.
    const float amplitude =
        length(wind.mean) * settings.windGustiness * std::sqrt(2.0f / static_cast<float>(kWindModes));
    Sequence random(settings.windSeed);
    for (WindMode& mode : wind.modes) {
        const Float3 direction = random.direction();
        mode.waveVector = direction * ((0.5f + random.uniform()) / settings.windGustSize);
        mode.turnsPerSecond = (0.5f + random.uniform()) * settings.windFrequency;
        mode.turns = random.uniform();
        if (!eddies) continue;
        mode.amplitude = across(random, direction) * amplitude;
        mode.turnsPerSecond += dot(mode.waveVector, authored);
    }
    return wind;
}

std::array<float, kWindModes> windPhases(const Wind& wind, double time,
                                         const std::array<double, 3>& origin_ws) {
    std::array<float, kWindModes> phases{};
    for (std::size_t m = 0; m < kWindModes; ++m) {
        // Whole turns go before the product: it may leave the range of a double, or have no fraction left.
        const double rate = static_cast<double>(wind.modes[m].turnsPerSecond);
        const double past = rate == 0.0 ? 0.0 : std::remainder(time, 1.0 / rate) * rate;
        const Float3 wave = wind.modes[m].waveVector;
        double turns = static_cast<double>(wind.modes[m].turns) - past;
        const double waves[] = {static_cast<double>(wave.x), static_cast<double>(wave.y),
                                static_cast<double>(wave.z)};
        for (std::size_t k = 0; k < 3; ++k) turns += std::remainder(waves[k] * origin_ws[k], 1.0);
        phases[m] = static_cast<float>(turns - std::round(turns));
    }
    return phases;
}

}  // namespace hairloom::runtime
