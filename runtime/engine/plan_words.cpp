// SPDX-License-Identifier: MIT
// The plan in words.
#include <iomanip>
#include <sstream>
#include <string_view>

#include "hairloom/plan.h"

namespace hairloom::runtime {
namespace {

static_assert(kEffects.back().name && kStages.back().name && kReasons.back(), "a table lacks a line");

/// "# sphere(s)" of a number: "1 sphere", "2 spheres".
std::string filled(std::string_view words, float value, int digits) {
    std::ostringstream text;
    text << std::setprecision(digits);
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == '#') {
            text << value;
        } else if (words.substr(i).starts_with("(s)")) {
            text << (value == 1.0f ? "" : "s");
            i += 2;
        } else {
            text << words[i];
        }
    }
    return text.str();
}

const EffectInfo& infoOf(Effect effect) {
    return kEffects[static_cast<std::size_t>(effect)];
}
const StageInfo& infoOf(StageId stage) {
    return kStages[static_cast<std::size_t>(stage)];
}

}  // namespace

const char* effectName(Effect effect) {
    return infoOf(effect).name;
}

const char* stageName(StageId stage) {
    return infoOf(stage).name;
}

const char* stageFamily(StageId stage) {
    return infoOf(stage).family;
}

std::optional<Effect> stageEffect(StageId stage) {
    return infoOf(stage).effect;
}

std::string EffectPlan::why(Effect effect) const {
    const Decision& decision = decisions_[static_cast<std::size_t>(effect)];
    const EffectInfo& info = infoOf(effect);
    return std::string(info.name) + (decision.on ? ": on, " : ": off, ") +
           (decision.reason == Reason::authored
                ? filled(info.amount, decision.value, 4)
                : filled(kReasons[static_cast<std::size_t>(decision.reason)], decision.value, 6));
}

}  // namespace hairloom::runtime
