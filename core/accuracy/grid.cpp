// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/groom/file/former_names.h"
#include "hairloom/strands.h"

namespace hairloom {
namespace {

constexpr double kFewestPoints = 2;
constexpr double kMaxThreads = 1024;

constexpr double kMaxSpheres = 4096;
constexpr double kMaxGuides = 1'000'000, kMaxHairsPerGuide = 4096;

/// An axis that is no setting: whole numbers, or choices by their index.
struct OwnAxis {
    std::string_view name;
    double min, max;
    std::vector<std::string_view> choices = {};
};
const OwnAxis* findOwn(std::string_view field) {
    static const std::vector<OwnAxis> all{{kPointsAxis, kFewestPoints, double{runtime::kMaxPoints}},
                                          {kThreadsAxis, 0, kMaxThreads},
                                          {kEngineAxis, 0, 1, {"cpu", "gpu"}},
                                          {kHeadSeenAxis, 0, 1, {"ends", "quarters"}},
                                          {kHairVolumeAxis, 0, 1},
                                          {kSpheresAxis, 0, kMaxSpheres},
                                          {kGuidesAxis, 1, kMaxGuides},
                                          {kHairsPerGuideAxis, 0, kMaxHairsPerGuide}};
    const auto found = std::ranges::find(all, field, &OwnAxis::name);
    return found == all.end() ? nullptr : &*found;
}

Status checkValue(const GridAxis& axis, double value) {
    if (const OwnAxis* own = findOwn(axis.field)) {
        if (value >= own->min && value <= own->max && value == std::floor(value)) return {};
        return fail(fmt::format("{} is {}", axis.field, value),
                    fmt::format("expected a whole number from {} to {}", own->min, own->max));
    }
    const auto* field = runtime::findField<runtime::SimulationSettings>(axis.field);
    if (!field || field->components() != 1) {
        return fail(fmt::format("there is no setting '{}' of one number", axis.field),
                    fmt::format("expected {}, {}, {}, {}, {}, {}, {}, {} or a field of the simulation",
                                kPointsAxis, kThreadsAxis, kEngineAxis, kHeadSeenAxis, kHairVolumeAxis,
                                kSpheresAxis, kGuidesAxis, kHairsPerGuideAxis));
    }
    runtime::SimulationSettings settings;
    if (runtime::setFieldValue(settings, *field, value)) return {};
    return fail(
        fmt::format("{} is {}", axis.field, value),
        fmt::format("expected {} to {}{}{}", field->min, field->max, *field->unit ? " " : "", field->unit));
}

std::span<const FormerMember> formerNames() {
    return formerMembers(runtime::SimulationSettings{});
}

/// Of an enumeration, by index; empty for what is a number.
std::vector<std::string_view> choicesOf(std::string_view field) {
    if (const OwnAxis* own = findOwn(field)) return own->choices;
    const auto* info = runtime::findField<runtime::SimulationSettings>(field);
    return info ? std::vector<std::string_view>(info->choices.begin(), info->choices.end())
                : std::vector<std::string_view>();
}

Result<double> parseValue(const std::string& field, const std::string& given) {
    const auto text = currentValue(formerNames(), field, given).get<std::string>();
    if (const auto choices = choicesOf(field); !choices.empty()) {
        const auto chosen = std::ranges::find(choices, text);
        if (chosen != choices.end()) return static_cast<double>(chosen - choices.begin());
        return fail(fmt::format("{} is '{}'", field, text),
                    fmt::format("expected one of {}", fmt::join(choices, ", ")));
    }
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size()) {
        return fail(fmt::format("{} is '{}'", field, text), "expected a number");
    }
    return value;
}

}  // namespace

bool isEnumeration(std::string_view field) {
    return !choicesOf(field).empty();
}

std::string axisValueText(const GridAxis& axis, double value) {
    const auto choices = choicesOf(axis.field);
    return choices.empty() ? fmt::format("{:.9g}", value)
                           : std::string(choices[static_cast<std::size_t>(value)]);
}

Result<GridAxis> parseAxis(std::string_view field, const std::vector<std::string>& values) {
    GridAxis axis{std::string(currentName(formerNames(), field)), {}};
    for (const std::string& text : values) {
        const auto value = parseValue(axis.field, text);
        if (!value) return tl::unexpected(value.error());
        if (std::ranges::find(axis.values, *value) == axis.values.end()) axis.values.push_back(*value);
    }
    if (auto status = checkAxis(axis); !status) return tl::unexpected(status.error());
    return axis;
}

Status checkAxis(const GridAxis& axis) {
    if (axis.values.empty()) return fail(fmt::format("{} has no values", axis.field), "expected one or more");
    for (const double value : axis.values) {
        if (auto status = checkValue(axis, value); !status) return status;
    }
    return {};
}

std::vector<std::vector<double>> combinations(const std::vector<GridAxis>& axes) {
    std::vector<std::vector<double>> all{{}};
    for (const GridAxis& axis : axes) {
        std::vector<std::vector<double>> longer;
        for (const auto& combination : all) {
            for (const double value : axis.values) {
                longer.push_back(combination);
                longer.back().push_back(value);
            }
        }
        all = std::move(longer);
    }
    return all;
}

std::optional<std::size_t> findAxis(const std::vector<GridAxis>& axes, std::string_view field) {
    const auto found = std::ranges::find(axes, field, &GridAxis::field);
    if (found == axes.end()) return std::nullopt;
    return static_cast<std::size_t>(found - axes.begin());
}

void applyValues(const std::vector<GridAxis>& axes, const std::vector<double>& values,
                 runtime::SimulationSettings& settings) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (const auto* field = runtime::findField<runtime::SimulationSettings>(axes[a].field)) {
            runtime::setFieldValue(settings, *field, values[a]);
        }
    }
}

}  // namespace hairloom
