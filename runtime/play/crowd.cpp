// SPDX-License-Identifier: MIT
#include "play/crowd.h"

#include <algorithm>
#include <cmath>

namespace hairloom::runtime {
namespace {

/// Of the limit, that a coarser level than the present one may use.
constexpr float kSpare = 0.75f;
/// Halvings of the range of limits: to a 16 millionth of it.
constexpr int kHalvings = 24;

Outcome checkCrowd(const hl_crowd_limits& limits, const Characters& characters) {
    const auto refuse = [](const char* what, double value, const char* expected) {
        return Refusal{HL_BAD_VALUE,
                       std::string(what) + " is " + std::to_string(value) + "; expected " + expected};
    };
    const auto least = [&](const char* what, double value) -> Outcome {
        if (value >= 0 && std::isfinite(value)) return std::nullopt;
        return refuse(what, value, "0 or more");
    };
    if (Outcome refused = least("error_pixels", limits.error_pixels)) return refused;
    if (Outcome refused = least("hair_pixels", limits.hair_pixels)) return refused;
    if (!(limits.milliseconds >= 0)) return refuse("milliseconds", limits.milliseconds, "0 or more");
    if (!(limits.speed > 0) || !std::isfinite(limits.speed)) return refuse("speed", limits.speed, "above 0");
    std::size_t number = 0;
    for (const hl_viewed& character : characters) {
        // Words take memory: only where they are needed.
        const auto who = [c = number++] { return "character " + std::to_string(c) + " "; };
        if (!character.hair || !character.hair->instance.hasLevels())
            return Refusal{HL_BAD_VALUE, who() + "has no instance that was made with HL_LEVELS"};
        if (Outcome refused = least("pixels_per_metre", character.pixels_per_metre))
            return Refusal{refused->code, who() + refused->words};
    }
    return std::nullopt;
}

struct CrowdPlan {
    const hl_crowd_limits& limits;
    Characters characters;

    float errorOf(const hl_viewed& character, std::uint32_t level) const {
        return character.hair->instance.predictedError(level, limits.strict != 0) *
               character.pixels_per_metre;
    }
    float hairShare(const hl_viewed& character) const {
        if (limits.hair_pixels == 0) return 1;
        const float pixels = 2 * character.hair->instance.rootRadius() * character.pixels_per_metre;
        return std::clamp(pixels / limits.hair_pixels, 1e-6f, 1.0f);
    }
    /// The finest level has no error, so there is one.
    std::uint32_t cheapest(const hl_viewed& character, float errorPixels) const {
        const std::uint32_t now = character.hair->instance.level();
        for (std::uint32_t level = HL_LEVEL_RIGID; level > 0; --level) {
            if (errorOf(character, level) <= (level > now ? kSpare : 1) * errorPixels) return level;
        }
        return HL_LEVEL_FINEST;
    }
    float millisecondsOf(const hl_viewed& character, std::uint32_t level) const {
        return character.hair->instance.predictedMilliseconds(level, hairShare(character)) / limits.speed;
    }
    float sum(float errorPixels) const {
        float milliseconds = 0;
        for (const hl_viewed& character : characters)
            milliseconds += millisecondsOf(character, cheapest(character, errorPixels));
        return milliseconds;
    }
    /// At which every character may be rigid.
    float greatestError() const {
        float greatest = 0;
        for (const hl_viewed& character : characters)
            greatest = std::max(greatest, errorOf(character, HL_LEVEL_RIGID));
        return greatest / kSpare * 1.001f;
    }
    /// The smallest error for all that the budget has room for, not below that of the limits.
    float limitOfAll() const {
        float low = limits.error_pixels, high = std::max(low, greatestError());
        if (sum(low) <= limits.milliseconds) return low;
        for (int i = 0; i < kHalvings; ++i) {
            const float middle = 0.5f * (low + high);
            (sum(middle) <= limits.milliseconds ? high : low) = middle;
        }
        return high;
    }
};

}  // namespace

Outcome planCrowd(const hl_crowd_limits& limits, Characters characters, hl_crowd_report& report) {
    if (Outcome refused = checkCrowd(limits, characters)) return refused;
    const CrowdPlan planner{limits, characters};
    const float errorPixels = planner.limitOfAll();
    report = {};
    // What a character is given depends on its present level, so all are looked at before any is changed.
    for (hl_viewed& character : characters) {
        character.level = planner.cheapest(character, errorPixels);
        character.error_pixels = planner.errorOf(character, character.level);
        character.milliseconds = planner.millisecondsOf(character, character.level);
        report.error_pixels = std::max(report.error_pixels, character.error_pixels);
        report.milliseconds += character.milliseconds;
    }
    report.within = report.error_pixels <= limits.error_pixels && report.milliseconds <= limits.milliseconds;
    for (const hl_viewed& character : characters)
        character.hair->instance.setLevel(character.level, planner.hairShare(character));
    return std::nullopt;
}

}  // namespace hairloom::runtime
