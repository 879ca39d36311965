// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/choice.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {
namespace {

/// The run that `isBetter` prefers, of those that `may` be chosen and neither diverge nor tremble.
template <class May, class Better>
std::optional<std::size_t> best(const WorkPrecision& measured, const May& may, const Better& isBetter) {
    std::optional<std::size_t> chosen;
    for (std::size_t r = 0; r < measured.runs.size(); ++r) {
        const WorkPrecisionRun& run = measured.runs[r];
        if (run.diverged || run.trembling > 0 || !may(run)) continue;
        if (!chosen || isBetter(run, measured.runs[*chosen])) chosen = r;
    }
    return chosen;
}

bool isCheaper(const WorkPrecisionRun& a, const WorkPrecisionRun& b) {
    return a.milliseconds.median < b.milliseconds.median;
}

constexpr double kEqual = 1.2;

double timeOf(const WorkPrecisionRun& run) {
    return run.milliseconds.median;
}
double errorOf(const WorkPrecisionRun& run) {
    return run.error.rmsMm;
}

/// How many times the larger is the smaller; both are above 0, or it is 1.
double ratio(double a, double b) {
    return a > 0 && b > 0 ? std::max(a / b, b / a) : 1;
}

template <class Same, class Other>
std::optional<std::size_t> pairOf(const WorkPrecision& measured, std::size_t index, const Same& same,
                                  const Other& other) {
    const WorkPrecisionRun& run = measured.runs[index];
    const auto isAlike = [&](const WorkPrecisionRun& candidate) {
        return &candidate != &run && ratio(same(candidate), same(run)) <= kEqual;
    };
    return best(measured, isAlike, [&](const WorkPrecisionRun& a, const WorkPrecisionRun& b) {
        return ratio(other(a), other(run)) > ratio(other(b), other(run));
    });
}

/// Whether the groom, as the CPU moves it, has that value of an axis.
bool hasValue(const Groom& groom, std::string_view field, double value) {
    const auto atLeast = [value](std::size_t count) { return value >= static_cast<double>(count); };
    if (field == kPointsAxis) return value == static_cast<double>(maxPoints(groom));
    if (field == kEngineAxis || field == kHairVolumeAxis) return value == 0;
    if (field == kHeadSeenAxis) return value == 1;
    if (field == kSpheresAxis) return atLeast(groom.spheres.size());
    if (field == kGuidesAxis) return atLeast(groom.strandCount());
    if (field == kHairsPerGuideAxis) return value == groom.interpolation.followPerGuide;
    const auto* setting = runtime::findField<runtime::SimulationSettings>(field);
    return !setting || value == runtime::fieldValue(groom.simulation, *setting);
}

}  // namespace

std::optional<std::size_t> pairOfEqualTime(const WorkPrecision& measured, std::size_t run) {
    return pairOf(measured, run, timeOf, errorOf);
}

std::optional<std::size_t> pairOfEqualError(const WorkPrecision& measured, std::size_t run) {
    return pairOf(measured, run, errorOf, timeOf);
}

std::optional<std::size_t> runOf(const WorkPrecision& measured, const Groom& groom) {
    const std::vector<GridAxis>& axes = measured.options.axes;
    for (std::size_t r = 0; r < measured.runs.size(); ++r) {
        bool same = true;
        for (std::size_t a = 0; a < axes.size() && same; ++a)
            same = hasValue(groom, axes[a].field, measured.runs[r].values[a]);
        if (same) return r;
    }
    return std::nullopt;
}

std::vector<std::size_t> runsAlong(const WorkPrecision& measured, std::size_t run, std::size_t axis) {
    std::vector<std::size_t> along;
    for (std::size_t r = 0; r < measured.runs.size(); ++r) {
        std::vector<double> values = measured.runs[r].values;
        values[axis] = measured.runs[run].values[axis];
        if (values == measured.runs[run].values) along.push_back(r);
    }
    return along;
}

std::optional<std::size_t> nextStep(const WorkPrecision& measured, std::size_t from) {
    const WorkPrecisionRun& now = measured.runs[from];
    const auto isMoreExact = [&](const WorkPrecisionRun& run) {
        return run.onFront && (now.diverged || run.error.rmsMm < now.error.rmsMm);
    };
    return best(measured, isMoreExact, isCheaper);
}

std::optional<std::size_t> cheapestWithinError(const WorkPrecision& measured, double rmsMm) {
    return best(
        measured, [&](const WorkPrecisionRun& run) { return run.error.rmsMm <= rmsMm; }, isCheaper);
}

std::optional<std::size_t> mostExactWithinTime(const WorkPrecision& measured, double milliseconds) {
    return best(
        measured, [&](const WorkPrecisionRun& run) { return run.milliseconds.median <= milliseconds; },
        [](const WorkPrecisionRun& a, const WorkPrecisionRun& b) { return a.error.rmsMm < b.error.rmsMm; });
}

std::string describeRun(const WorkPrecision& measured, std::size_t run) {
    std::string words;
    for (std::size_t a = 0; a < measured.options.axes.size(); ++a) {
        const GridAxis& axis = measured.options.axes[a];
        const double value = measured.runs[run].values[a];
        const std::string text = axisValueText(axis, value);
        if (!words.empty()) words += ", ";
        if (axis.field == kPointsAxis || axis.field == "substeps") {
            const std::string_view unit = axis.field == kPointsAxis ? "point" : "substep";
            words += fmt::format("{} {}{}", text, unit, value == 1 ? "" : "s");
        } else {
            words += fmt::format("{} {}", axis.field, text);
        }
    }
    return words;
}

}  // namespace hairloom
