// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/effect_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "core/cost/without_effect.h"

namespace hairloom {
namespace {

/// Effects other than `name` that are on in one run and off in the other: they count in the difference.
std::string sideEffects(const std::string& name, const std::vector<EffectReport>& asIs,
                        const std::vector<EffectReport>& off) {
    std::string note;
    for (std::size_t e = 0; e < asIs.size() && e < off.size(); ++e) {
        if (asIs[e].name == name) {
            if (off[e].on) note += "it cannot be turned off completely; ";
        } else if (asIs[e].on != off[e].on) {
            note += fmt::format("without it {} is {}; ", off[e].name, off[e].on ? "on" : "off");
        }
    }
    if (!note.empty()) note.resize(note.size() - 2);
    return note;
}

/// One scene to be run in every round.
struct Variant {
    SceneHair hair;
    std::vector<double> times;
    SceneResult last;
};

/// The scene as it is and, for each effect that can be turned off, the scene without it.
struct Variants {
    Variant asIs;
    std::vector<std::optional<Variant>> without;  ///< for each effect
};

EffectCosts describe(const std::vector<EffectReport>& reports, Variants& variants) {
    EffectCosts costs;
    for (const EffectReport& report : reports) {
        EffectCost cost;
        cost.name = report.name;
        cost.on = report.on;
        cost.why = report.why;
        cost.bytes = report.bytes;
        variants.without.emplace_back();
        if (auto scene = report.on ? withoutEffect(variants.asIs.hair, report.name) : std::nullopt) {
            cost.turnedOffBy = scene->how;
            variants.without.back() = Variant{std::move(scene->hair), {}, {}};
        } else if (report.on) {
            cost.note = "no setting turns it off";
        }
        costs.effects.push_back(std::move(cost));
    }
    return costs;
}

void fillIn(const Variants& variants, std::size_t effect, EffectCosts& costs) {
    if (!variants.without[effect]) return;
    const Variant& off = *variants.without[effect];
    EffectCost& cost = costs.effects[effect];
    cost.note = sideEffects(cost.name, variants.asIs.last.effects, off.last.effects);
    if (off.last.nanCount > 0) {
        cost.note += cost.note.empty() ? "" : "; ";
        cost.note += "without it the hair was not finite";
        return;
    }
    cost.millisecondsOff = quartiles(off.times);
    std::vector<double> differences;
    for (std::size_t round = 0; round < off.times.size(); ++round) {
        differences.push_back(variants.asIs.times[round] - off.times[round]);
    }
    cost.costMilliseconds = quartiles(differences);
    const auto say = [&](const char* words) {
        cost.note += (cost.note.empty() ? "" : "; ") + std::string(words);
    };
    if (lostInSpread(*cost.costMilliseconds)) {
        say("the cost is smaller than the spread of the runs");
    } else if (!cost.price()) {
        say("a frame takes longer without it");
    }
}

/// A response that is authored and that this model of strands does not have.
void noteOtherModel(const runtime::SimulationSettings& settings, EffectCosts& costs) {
    const bool unused =
        settings.strandModel == runtime::StrandModel::rods &&
        (settings.collisionResponse != runtime::CollisionResponse::radial || settings.collisionSegments);
    if (!unused) return;
    for (EffectCost& cost : costs.effects) {
        if (cost.name != "collision") continue;
        cost.note += (cost.note.empty() ? "" : "; ") +
                     std::string(
                         "collisionResponse and collisionSegments are of springs alone: rods solve "
                         "their contacts together with the strand");
    }
}

}  // namespace

std::optional<double> EffectCost::price() const {
    if (!on) return 0.0;
    if (!costMilliseconds || lostInSpread(*costMilliseconds) || costMilliseconds->median <= 0)
        return std::nullopt;
    return costMilliseconds->median;
}

bool lostInSpread(const Quartiles& cost) {
    return cost.q1 <= 0 && cost.q3 >= 0;
}

Result<EffectCosts> measureEffectCosts(const Groom& groom, const HeadMotion& motion,
                                       const EffectCostOptions& options) {
    assert(options.repeats >= 1 && options.time.stepsPerFrame == 1);
    const std::vector<HeadPose> poses = posesOf(motion, options.time);
    Variants variants;
    variants.asIs.hair = sampleStrands(groom, std::min(groom.strandCount(), options.strands), 0);
    const double scale =
        static_cast<double>(groom.strandCount()) /
        static_cast<double>(std::max<std::size_t>(variants.asIs.hair.groom.strandCount(), 1));
    // Which effects there are to turn off is known after a first run, which also warms up.
    const auto first = runScene(variants.asIs.hair, poses, options.time, {});
    if (!first) return tl::unexpected(first.error());
    EffectCosts costs = describe(first->effects, variants);

    const auto offCount =
        std::ranges::count_if(variants.without, [](const auto& v) { return v.has_value(); });
    const std::size_t total = 1 + (1 + static_cast<std::size_t>(offCount)) * options.repeats;
    std::size_t done = 1;
    const auto runOnce = [&](Variant& variant) -> Status {
        if (options.cancelled && options.cancelled())
            return fail("measuring the effects was cancelled", "expected it to run to its end");
        auto result = runScene(variant.hair, poses, options.time, {});
        if (!result) return tl::unexpected(result.error());
        variant.times.push_back(scale * result->millisecondsPerFrame);
        variant.last = std::move(*result);
        if (options.progress) options.progress(++done, total);
        return {};
    };
    std::vector<std::vector<double>> stageTimes(costs.effects.size());
    for (std::uint32_t round = 0; round < options.repeats; ++round) {
        if (auto status = runOnce(variants.asIs); !status) return tl::unexpected(status.error());
        for (std::size_t e = 0; e < stageTimes.size(); ++e) {
            stageTimes[e].push_back(scale * variants.asIs.last.effects[e].milliseconds.value_or(0));
            if (!variants.without[e]) continue;
            if (auto status = runOnce(*variants.without[e]); !status) return tl::unexpected(status.error());
        }
    }

    costs.milliseconds = quartiles(variants.asIs.times);
    for (std::size_t e = 0; e < stageTimes.size(); ++e) {
        costs.effects[e].stageMilliseconds = quartiles(stageTimes[e]).median;
        fillIn(variants, e, costs);
    }
    noteOtherModel(groom.simulation, costs);
    return costs;
}

}  // namespace hairloom
