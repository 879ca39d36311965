// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/compare_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/groom/file/fields.h"
#include "core/groom/poses.h"
#include "core/groom/strand_subset.h"

namespace hairloom {
namespace {

template <class T>
double difference(const T& a, const T& b) {
    if constexpr (std::is_arithmetic_v<T>) {
        return std::abs(static_cast<double>(a) - static_cast<double>(b));
    } else {
        return static_cast<double>((a - b).cwiseAbs().maxCoeff());
    }
}

/// The largest difference, or nothing where the file has no such values. `sources` are the groom's elements
/// in order.
std::optional<double> largestDifference(const AttributeData& authored, const AttributeSet& read,
                                        std::string_view name, const std::vector<std::uint32_t>& sources) {
    return std::visit(
        [&]<class T>(const CowArray<T>& array) -> std::optional<double> {
            const auto values = read.view<T>(name);
            if (values.size() != sources.size()) return std::nullopt;
            double largest = 0;
            for (std::size_t i = 0; i < values.size(); ++i)
                largest = std::max(largest, difference(array[sources[i]], values[i]));
            return largest;
        },
        authored);
}

/// What a person authored, as against a tool's state and what follows from other things.
bool isAuthored(std::string_view name) {
    return name != attribute::kPosition && !isOperatorAttribute(name) && !name.starts_with(kPosePrefix) &&
           name != attribute::kLayer && name != attribute::kSelected && name != attribute::kHidden &&
           name != attribute::kRootTriangle && name != attribute::kRootBarycentric;
}

/// Alembic and USD hold attributes of any name: what is missing there was left out for a reason, which is a
/// finding of its own.
std::string wayToKeep(const ExportReport& report) {
    const bool holdsAny = report.format.starts_with("Alembic") || report.format.starts_with("USD");
    return holdsAny ? "keep the project" : "export to Alembic or USD as well, or keep the project";
}

void compareSet(const AttributeSet& authored, std::size_t elements, const AttributeSet& read,
                const std::vector<std::uint32_t>& sources, const std::string& of, ExportReport& report) {
    for (const auto& [name, data] : authored.all()) {
        if (!isAuthored(name) || sizeOf(data) != elements) continue;
        if (const auto largest = largestDifference(data, read, name, sources)) {
            report.attributes.push_back({name, *largest});
        } else {
            report.leftBehind.push_back({fmt::format("attribute \"{}\" of {}", name, of), wayToKeep(report)});
        }
    }
}

/// Of resampled strands no value of the file is that of a point of the groom: widths are compared with those
/// that were written, and of all else only what is missing is known.
void compareResampled(const Groom& groom, const PreparedStrands& prepared, float metresPerUnit,
                      const AttributeSet& read, ExportReport& report) {
    for (const auto& [name, data] : groom.pointAttributes.all()) {
        if (!isAuthored(name) || sizeOf(data) != groom.pointCount()) continue;
        if (!read.has(name)) {
            report.leftBehind.push_back({fmt::format("attribute \"{}\" of points", name), wayToKeep(report)});
        } else if (const auto radii = read.view<float>(name);
                   name == attribute::kRadius && radii.size() == prepared.thickness.size()) {
            double largest = 0;
            for (std::size_t i = 0; i < radii.size(); ++i)
                largest =
                    std::max(largest, difference(0.5f * metresPerUnit * prepared.thickness[i], radii[i]));
            report.attributes.push_back({name, largest});
        }
    }
}

template <class S>
bool same(const S& a, const S& b) {
    for (const auto& field : fieldsOf(a)) {
        for (std::uint32_t c = 0; c < field.components(); ++c) {
            if (field.get(a, c) != field.get(b, c)) return false;
        }
    }
    return true;
}

const std::string& layerName(const Groom& groom, std::uint32_t layer) {
    static const std::string kNone = Layer{}.name;
    return layer < groom.layers.size() ? groom.layers[layer].name : kNone;
}

/// Whether each strand of the file is in a layer of its layer's name.
bool haveSameLayers(const Groom& groom, const PreparedStrands& prepared, const Groom& read) {
    const std::vector<std::uint32_t> authored = layersOfStrands(groom), found = layersOfStrands(read);
    for (std::size_t s = 0; s < prepared.strandCount(); ++s) {
        if (layerName(groom, authored[prepared.sources[s]]) != layerName(read, found[s])) return false;
    }
    return true;
}

/// Layers of a name that several have, and those without strands, do not tell themselves apart.
void reportLayers(const Groom& groom, const PreparedStrands& prepared, const ImportedStrands& readBack,
                  ExportReport& report) {
    if (groom.layers.size() < 2) return;
    if (readBack.hasSettings && readBack.groom.layers.size() == groom.layers.size()) return;
    if (!haveSameLayers(groom, prepared, readBack.groom)) {
        report.leftBehind.push_back({fmt::format("{} layers", groom.layers.size()),
                                     "export to USD, Alembic or OBJ, which have them, or keep the project"});
        return;
    }
    report.leftBehind.push_back({"materials, locks and densities of layers", "keep the project"});
    std::set<std::uint32_t> used;
    const std::vector<std::uint32_t> authored = layersOfStrands(groom);
    for (const std::uint32_t source : prepared.sources) used.insert(authored[source]);
    if (used.size() < groom.layers.size())
        report.leftBehind.push_back(
            {fmt::format("{} layers without strands", groom.layers.size() - used.size()),
             "keep the project"});
}

void reportSettings(const Groom& groom, const PreparedStrands& prepared, const ImportedStrands& readBack,
                    ExportReport& report) {
    const Groom& read = readBack.groom;
    const bool carried = readBack.hasSettings;
    const auto leave = [&](std::string what, std::string fix) {
        report.leftBehind.push_back({std::move(what), std::move(fix)});
    };
    if (groom.interpolation.followPerGuide > 0 && !(carried && same(groom.interpolation, read.interpolation)))
        leave(fmt::format("{} follow hairs per strand", groom.interpolation.followPerGuide),
              "export the hairs instead of the guides, or interpolate in the other program");
    if (!groom.poses.empty() && !prepared.holdsPoses && read.poses != groom.poses)
        leave(fmt::format("{} poses that hair follows", groom.poses.size()),
              "export a take of the hair that follows them, or keep the project");
    if (!groom.spheres.empty() && !(carried && read.spheres.size() == groom.spheres.size()))
        leave(fmt::format("{} collision spheres", groom.spheres.size()),
              "place colliders in the other program");
    if (!(carried && read.simulation == groom.simulation && same(read.material, groom.material)))
        leave("material and settings of the simulation",
              "keep the project. `info` and `set --list` show them");
}

}  // namespace

void compareAttributes(const Groom& groom, const PreparedStrands& prepared, float metresPerUnit,
                       const ImportedStrands& readBack, ExportReport& report) {
    compareSet(groom.strandAttributes, groom.strandCount(), readBack.groom.strandAttributes, prepared.sources,
               "strands", report);
    if (prepared.isResampled) {
        compareResampled(groom, prepared, metresPerUnit, readBack.groom.pointAttributes, report);
    } else {
        std::vector<std::uint32_t> points;
        for (const std::uint32_t source : prepared.sources) {
            for (std::uint32_t p = groom.offsets[source]; p < groom.offsets[source + 1]; ++p)
                points.push_back(p);
        }
        compareSet(groom.pointAttributes, groom.pointCount(), readBack.groom.pointAttributes, points,
                   "points", report);
    }
    reportLayers(groom, prepared, readBack, report);
    reportSettings(groom, prepared, readBack, report);
}

}  // namespace hairloom
