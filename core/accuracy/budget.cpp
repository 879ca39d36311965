// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/budget.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/accuracy/work_precision.h"
#include "core/cost/without_effect.h"

namespace hairloom {
namespace {

constexpr std::array<std::string_view, 5> kMayGo = {"collisionRadius", "drag", "wind", "collision",
                                                    "angular"};

constexpr std::uint32_t kAttempts = 3;  ///< at times that can be relied upon

bool isNear(double time, double other) {
    return std::abs(time / other - 1) <= kSteadyShare;
}
bool isSteady(const Quartiles& times) {
    return times.q3 - times.q1 <= kSteadyShare * times.median;
}

/// One way to run the scene: with all strands, for its time, and a sample of them, for its error.
struct Candidate {
    SceneHair all, sample;
    Quartiles milliseconds;
    TrajectoryError error;
    bool sound = true;  ///< the sample stayed finite
    std::vector<GivenUp> effectsOff;
};

class Solver {
  public:
    Solver(const Groom& groom, const HeadMotion& motion, const BudgetOptions& options,
           const GroundTruthSource& groundTruth)
        : motion_(motion),
          options_(options),
          source_(groundTruth),
          poses_(posesOf(motion, options.time)),
          all_(sampleStrands(groom, groom.strandCount(), 0)),
          sample_(sampleStrands(groom, options.strands, options.seed)),
          axes_(axesToTry(groom)) {}

    Result<Budget> solve() {
        const auto authored = timed(all_);
        if (!authored) return tl::unexpected(authored.error());
        auto front = exactFirst();
        if (!front) return tl::unexpected(front.error());
        auto chosen = options_.withinMm ? cheapestWithin(*front) : mostAccurateThatFits(*front);
        if (!chosen) return tl::unexpected(chosen.error());
        if (!fits(chosen->milliseconds)) {
            if (auto status = giveUpFollowHairs(*chosen); !status) return tl::unexpected(status.error());
        }
        if (!fits(chosen->milliseconds)) {
            if (auto status = giveUpEffects(*chosen); !status) return tl::unexpected(status.error());
        }
        const auto again = timeAgain(*chosen);
        if (!again) return tl::unexpected(again.error());
        Budget budget;
        budget.millisecondsAgain = again->median;
        budget.fits =
            fits(chosen->milliseconds) && (!options_.withinMm || chosen->error.rmsMm <= *options_.withinMm);
        budget.milliseconds = chosen->milliseconds;
        budget.errorMm = chosen->error.rmsMm;
        budget.errorMaxMm = chosen->error.maxMm;
        budget.authoredMilliseconds = *authored;
        budget.givenUp = settingsGivenUp(chosen->all.groom);
        std::ranges::move(chosen->effectsOff, std::back_inserter(budget.givenUp));
        budget.groom = std::move(chosen->all.groom);
        budget.notes = std::move(notes_);
        return budget;
    }

  private:
    bool fits(const Quartiles& time) const {
        return !options_.milliseconds || time.median <= *options_.milliseconds;
    }
    void say(const std::string& what, std::size_t done = 0, std::size_t total = 1) const {
        if (options_.progress) options_.progress(what, done, total);
    }

    Result<double> timeOnce(const SceneHair& hair) const {
        if (options_.frameTime) return options_.frameTime(hair.groom);
        const auto outcome = runScene(hair, poses_, options_.time, {});
        if (!outcome) return tl::unexpected(outcome.error());
        return outcome->millisecondsPerFrame;
    }

    /// On a machine that is busy for a while, again.
    Result<Quartiles> timed(const SceneHair& hair) const {
        Quartiles result;
        for (std::uint32_t attempt = 0; attempt < kAttempts; ++attempt) {
            std::vector<double> times;
            for (std::uint32_t round = 0; round <= options_.repeats; ++round) {
                say("time of all strands", round, options_.repeats + 1);
                const auto once = timeOnce(hair);
                if (!once) return tl::unexpected(once.error());
                if (round > 0) times.push_back(*once);  // the first one warms up
            }
            result = quartiles(std::move(times));
            if (isSteady(result)) break;
        }
        return result;
    }

    /// Of the choice, once all has been tried; where that differs, what it took then is what it takes.
    Result<Quartiles> timeAgain(Candidate& chosen) const {
        auto again = timed(chosen.all);
        for (std::uint32_t attempt = 1; attempt < kAttempts && again; ++attempt) {
            if (isNear(again->median, chosen.milliseconds.median)) break;
            chosen.milliseconds = *again;
            again = timed(chosen.all);
        }
        return again;
    }

    /// The runs that no other is both as fast and as exact as.
    Result<std::vector<WorkPrecisionRun>> exactFirst() {
        WorkPrecisionOptions measuring;
        measuring.axes = axes_;
        measuring.time = options_.time;
        measuring.strands = options_.strands;
        measuring.repeats = options_.repeats;
        measuring.seed = options_.seed;
        measuring.progress = [this](std::size_t done, std::size_t total) {
            say("time and error of a sample", done, total);
        };
        auto result = measureWorkPrecision(all_.groom, motion_, measuring, source_);
        if (!result) return tl::unexpected(result.error());
        notes_ = std::move(result->notes);
        std::vector<WorkPrecisionRun> front;
        std::ranges::copy_if(result->runs, std::back_inserter(front), &WorkPrecisionRun::onFront);
        std::ranges::sort(front, {}, [](const WorkPrecisionRun& run) { return run.error.rmsMm; });
        if (front.empty())
            return fail("no settings keep the hair of this scene finite and let it come to rest",
                        "expected a scene that can be simulated");
        return front;
    }

    SceneHair at(const SceneHair& hair, const std::vector<double>& values) const {
        const double points = values[*findAxis(axes_, kPointsAxis)];
        const bool asAuthored = points == maxPoints(all_.groom);
        SceneHair result = asAuthored ? hair : resampledHair(hair, static_cast<std::uint32_t>(points));
        applyValues(axes_, values, result.groom.simulation);
        return result;
    }

    /// Along the front times fall, so that what fits begins at one place.
    Result<Candidate> mostAccurateThatFits(const std::vector<WorkPrecisionRun>& front) const {
        std::size_t tooSlow = 0, enough = front.size() - 1;
        std::optional<Candidate> found;
        while (!found || tooSlow < enough) {
            const std::size_t middle = found ? (tooSlow + enough) / 2 : enough;
            Candidate candidate{at(all_, front[middle].values),
                                at(sample_, front[middle].values),
                                {},
                                front[middle].error,
                                true,
                                {}};
            const auto time = timed(candidate.all);
            if (!time) return tl::unexpected(time.error());
            candidate.milliseconds = *time;
            const bool first = !found;
            if (first && !fits(*time)) return candidate;  // not even the fastest
            if (fits(*time)) {
                enough = middle;
                found = std::move(candidate);
            } else {
                tooSlow = middle + 1;
            }
        }
        return std::move(*found);
    }

    /// Along the front, where times fall with exactness.
    Result<Candidate> cheapestWithin(const std::vector<WorkPrecisionRun>& front) const {
        const WorkPrecisionRun* run = &front.front();
        for (const WorkPrecisionRun& other : front) {
            const bool isExact = other.error.rmsMm <= *options_.withinMm;
            if (isExact && other.milliseconds.median < run->milliseconds.median) run = &other;
        }
        Candidate candidate{at(all_, run->values), at(sample_, run->values), {}, run->error, true, {}};
        const auto time = timed(candidate.all);
        if (!time) return tl::unexpected(time.error());
        candidate.milliseconds = *time;
        return candidate;
    }

    /// Half of them, and half of those, while frames with them are drawn and take too long.
    Status giveUpFollowHairs(Candidate& chosen) const {
        std::uint32_t& hairs = chosen.all.groom.interpolation.followPerGuide;
        while (options_.frameTime && !fits(chosen.milliseconds) && hairs > 1) {
            hairs /= 2;
            const auto time = timed(chosen.all);
            if (!time) return tl::unexpected(time.error());
            chosen.milliseconds = *time;
        }
        return {};
    }

    Status measure(Candidate& candidate) const {
        const auto time = timed(candidate.all);
        if (!time) return tl::unexpected(time.error());
        candidate.milliseconds = *time;
        const auto outcome = runScene(candidate.sample, poses_, options_.time, groundTruth_->followed);
        if (!outcome) return tl::unexpected(outcome.error());
        candidate.sound = outcome->trajectory.finite && outcome->nanCount == 0;
        if (candidate.sound) candidate.error = compare(outcome->trajectory, groundTruth_->trajectory);
        return {};
    }

    Result<std::vector<Candidate>> withOneEffectLess(const Candidate& from) const {
        const auto outcome = runScene(from.sample, poses_, options_.time, {});
        if (!outcome) return tl::unexpected(outcome.error());
        std::vector<Candidate> candidates;
        for (const EffectReport& effect : outcome->effects) {
            if (!effect.on || std::ranges::find(kMayGo, effect.name) == kMayGo.end()) continue;
            auto all = withoutEffect(from.all, effect.name);
            auto sample = withoutEffect(from.sample, effect.name);
            if (!all || !sample) continue;
            Candidate candidate{std::move(all->hair), std::move(sample->hair), {}, {}, true, from.effectsOff};
            candidate.effectsOff.push_back({effect.name, "on", "off"});
            if (auto status = measure(candidate); !status) return tl::unexpected(status.error());
            const bool faster = candidate.milliseconds.median < from.milliseconds.median;
            if (candidate.sound && faster) candidates.push_back(std::move(candidate));
        }
        return candidates;
    }

    Status giveUpEffects(Candidate& chosen) {
        const std::uint32_t finest = maxPoints(all_.groom);
        auto groundTruth = source_.compute(resampledHair(sample_, finest), motion_, options_.time,
                                           {drawnStrands(sample_.groom, source_.maxStrands(), options_.seed),
                                            evenShares(WorkPrecisionOptions{}.pointsCompared)});
        if (!groundTruth) return tl::unexpected(groundTruth.error());
        groundTruth_ = std::move(*groundTruth);
        while (!fits(chosen.milliseconds)) {
            auto candidates = withOneEffectLess(chosen);
            if (!candidates) return tl::unexpected(candidates.error());
            if (candidates->empty()) return {};
            chosen = std::move(*best(*candidates, chosen));
        }
        return {};
    }

    /// The most exact one that fits; else the one that loses least for the time that it saves.
    std::vector<Candidate>::iterator best(std::vector<Candidate>& candidates, const Candidate& from) const {
        return std::ranges::min_element(candidates, {}, [&](const Candidate& c) {
            const double saved = from.milliseconds.median - c.milliseconds.median;
            const double lost = std::max(0.0, c.error.rmsMm - from.error.rmsMm);
            return fits(c.milliseconds) ? std::pair(0, c.error.rmsMm) : std::pair(1, lost / saved);
        });
    }

    std::vector<GivenUp> settingsGivenUp(const Groom& chosen) const {
        std::vector<GivenUp> list;
        const auto compareNumbers = [&](const char* what, std::uint32_t from, std::uint32_t to) {
            if (to < from) list.push_back({what, std::to_string(from), std::to_string(to)});
        };
        const runtime::SimulationSettings &from = all_.groom.simulation, &to = chosen.simulation;
        compareNumbers("substeps", from.substeps, to.substeps);
        compareNumbers("lengthIterations", from.lengthIterations, to.lengthIterations);
        compareNumbers("points", maxPoints(all_.groom), maxPoints(chosen));
        compareNumbers("followPerGuide", all_.groom.interpolation.followPerGuide,
                       chosen.interpolation.followPerGuide);
        return list;
    }

    const HeadMotion& motion_;
    const BudgetOptions& options_;
    const GroundTruthSource& source_;
    std::vector<HeadPose> poses_;
    SceneHair all_, sample_;
    std::vector<GridAxis> axes_;
    std::optional<GroundTruth> groundTruth_;
    std::vector<std::string> notes_;
};

}  // namespace

bool Budget::busy() const {
    return !isSteady(milliseconds) || !isNear(millisecondsAgain, milliseconds.median);
}

Result<Budget> solveBudget(const Groom& groom, const HeadMotion& motion, const BudgetOptions& options,
                           const GroundTruthSource& groundTruth) {
    assert(options.milliseconds.has_value() != options.withinMm.has_value() && options.repeats >= 1 &&
           options.strands >= 1);
    if (groom.strandCount() == 0) return fail("the groom has no strands", "expected strands to simulate");
    return Solver(groom, motion, options, groundTruth).solve();
}

}  // namespace hairloom
