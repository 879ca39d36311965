// SPDX-License-Identifier: MIT
#include "runtime/wind.h"

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

}  // namespace

Wind makeWind(const SimulationSettings& settings) {
    Wind wind{};
    const float size = length(settings.windDirection);
    if (!(size > 0.0f)) return wind;
    wind.mean = settings.windDirection * (settings.windSpeed / size);
    // Independent waves add in squares: this amplitude makes the root mean square of the gusts windGustiness.
    const float amplitude =
        settings.windSpeed * settings.windGustiness * std::sqrt(2.0f / static_cast<float>(kWindModes));
    Sequence random(settings.windSeed);
    for (WindMode& mode : wind.modes) {
        mode.amplitude = random.direction() * amplitude;
        mode.waveVector = random.direction() * ((0.5f + random.uniform()) / settings.windGustSize);
        mode.turnsPerSecond = (0.5f + random.uniform()) * settings.windFrequency;
        mode.turns = random.uniform();
    }
    return wind;
}

std::array<float, kWindModes> windPhases(const Wind& wind, double time) {
    std::array<float, kWindModes> phases{};
    for (std::size_t m = 0; m < kWindModes; ++m) {
        const double turns = static_cast<double>(wind.modes[m].turns) -
                             static_cast<double>(wind.modes[m].turnsPerSecond) * time;
        phases[m] = static_cast<float>(turns - std::round(turns));
    }
    return phases;
}

}  // namespace hairloom::runtime
