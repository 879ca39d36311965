// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/groom/file/former_names.h"
#include "hairloom/strands.h"

namespace hairloom {
namespace {

constexpr double kFewestPoints = 3;  // of which one is free even where two are clamped
constexpr double kMaxThreads = 1024;

struct Bounds {
    double min, max;
};

/// Range of the axes that are no settings.
Bounds ownBounds(std::string_view field) {
    if (field == kPointsAxis) return {kFewestPoints, static_cast<double>(runtime::kMaxPoints)};
    return {0, kMaxThreads};
}

bool isOwn(std::string_view field) {
    return field == kPointsAxis || field == kThreadsAxis;
}

Status checkValue(const GridAxis& axis, double value) {
    if (isOwn(axis.field)) {
        const Bounds bounds = ownBounds(axis.field);
        if (value >= bounds.min && value <= bounds.max && value == std::floor(value)) return {};
        return fail(fmt::format("{} is {}", axis.field, value),
                    fmt::format("expected a whole number from {} to {}", bounds.min, bounds.max));
    }
    const auto* field = runtime::findField<runtime::SimulationSettings>(axis.field);
    if (!field || field->components() != 1) {
        return fail(fmt::format("there is no setting '{}' of one number", axis.field),
                    fmt::format("expected {}, {} or a field of the simulation", kPointsAxis, kThreadsAxis));
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

Result<double> parseValue(const std::string& field, const std::string& given) {
    const auto text = currentValue(formerNames(), field, given).get<std::string>();
    if (const auto* info = runtime::findField<runtime::SimulationSettings>(field);
        info && !info->choices.empty()) {
        const auto chosen =
            std::ranges::find(info->choices, text, [](const char* name) { return std::string(name); });
        if (chosen != info->choices.end()) return static_cast<double>(chosen - info->choices.begin());
        return fail(fmt::format("{} is '{}'", field, text),
                    fmt::format("expected one of {}", fmt::join(info->choices, ", ")));
    }
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size()) {
        return fail(fmt::format("{} is '{}'", field, text), "expected a number");
    }
    return value;
}

}  // namespace

std::string axisValueText(const GridAxis& axis, double value) {
    const auto* field = runtime::findField<runtime::SimulationSettings>(axis.field);
    if (field && !field->choices.empty()) return field->choices[static_cast<std::size_t>(value)];
    return fmt::format("{:.9g}", value);
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
