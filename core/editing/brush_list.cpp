// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace hairloom::editing {
namespace {

using S = BrushSettings;

constexpr Field<S> kFields[] = {
    field<&S::radius>("radius", "m", 0.0001, 1, "brush radius"),
    field<&S::strength>("strength", "", 0, 1, "strength of one dab"),
    field<&S::depth>("depth", "m", 0, 10,
                     "depth of the brush in front of and behind its position, for strokes made in a view"),
    field<&S::clearance>("clearance", "m", 0, 0.01, "minimum distance of hair from the skin"),
    boolField<&S::collide>("collide", "keeps hair out of the head"),
    boolField<&S::invert>("invert", "inverts the brush"),
    boolField<&S::symmetric>("symmetric", "repeats each dab on the other side of the mirror plane"),
    field<&S::mirrorPoint>("mirrorPoint", "m", -kAnywhere, kAnywhere, "a point on the mirror plane"),
    field<&S::mirrorNormal>("mirrorNormal", "", -kAnywhere, kAnywhere, "normal of the mirror plane"),
    seedField<&S::seed>("seed", "random seed of the stroke"),
};

/// By their order in a tool bar.
const std::vector<BrushEntry>& entries() {
    static const std::vector<BrushEntry> sorted = [] {
        std::vector<BrushEntry> list = brushEntries();
        std::ranges::stable_sort(list, {}, [](const BrushEntry& entry) { return entry.info->order; });
        return list;
    }();
    return sorted;
}

std::size_t indexOf(std::string_view name) {
    const auto names = brushNames();
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

Status checkParameters(const BrushInfo& info, const BrushSettings& settings) {
    for (const auto& [name, value] : settings.parameters) {
        const auto known = std::find_if(info.parameters.begin(), info.parameters.end(),
                                        [&key = name](const BrushParameter& p) { return p.name == key; });
        if (known == info.parameters.end())
            return fail(fmt::format("{} has no parameter '{}'", info.name, name),
                        "expected one that `groom --list` lists");
        if (!withinRange(static_cast<double>(value), known->min, known->max))
            return tl::unexpected(errorOfWords(fmt::format(
                "{} {}", name, outOfRangeText(readableDecimal(value), known->min, known->max, known->unit))));
    }
    return {};
}

Status checkCurve(std::string_view name, const BrushCurve& curve) {
    const auto& values = curve.values();
    const bool good = values.size() <= BrushCurve::kMaxValues &&
                      std::all_of(values.begin(), values.end(), [](float v) { return v >= 0 && v <= 1; });
    if (good) return {};
    return fail(fmt::format("the {} has {} values or one out of range", name, values.size()),
                fmt::format("up to {} values from 0 to 1", BrushCurve::kMaxValues));
}

}  // namespace

std::span<const Field<BrushSettings>> fieldsOf(const BrushSettings&) {
    return kFields;
}

std::span<const std::string_view> brushNames() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> list;
        for (const BrushEntry& entry : entries()) list.push_back(entry.info->name);
        return list;
    }();
    return names;
}

const BrushInfo& brushInfo(std::string_view name) {
    return *entries()[indexOf(name)].info;
}

std::unique_ptr<Brush> makeBrush(std::string_view name) {
    const std::size_t index = indexOf(name);
    return index < entries().size() ? entries()[index].make() : nullptr;
}

Status checkStroke(const Stroke& stroke) {
    if (indexOf(stroke.tool) >= entries().size())
        return fail(fmt::format("there is no brush '{}'", stroke.tool),
                    fmt::format("one of {}", fmt::join(brushNames(), ", ")));
    if (auto status = checkFields(stroke.tool, stroke.settings); !status) return status;
    if (stroke.settings.mirrorNormal.isZero(0))
        return fail(stroke.tool + ": mirrorNormal is zero", "a direction");
    if (auto status = checkCurve("falloff", stroke.settings.falloff); !status) return status;
    if (auto status = checkCurve("profile", stroke.settings.profile); !status) return status;
    return checkParameters(brushInfo(stroke.tool), stroke.settings);
}

}  // namespace hairloom::editing
