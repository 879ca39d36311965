// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/prepared_strands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/output_batch.h"
#include "core/base/parallel.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/curve.h"
#include "core/groom/point_width.h"
#include "core/groom/strand_subset.h"
#include "exporters/compare_attributes.h"

namespace hairloom {
namespace {

constexpr float kRootTolerance = 0.005f;  ///< metres; roots farther from the scalp float visibly

/// Half the fibre's diameter from the material, for grooms without a radius of their own.
std::vector<float> materialRadii(const HairMaterial& material, std::size_t points) {
    std::vector<float> radii(points);
    for (std::size_t i = 0; i < points; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(points - 1);
        radii[i] = material.rootRadius * (1.0f + t * (material.tipScale - 1.0f));
    }
    return radii;
}

enum class Usability { Good, CoincidentPoints, Unusable };

Usability usability(std::span<const Vec3f> strand) {
    if (strand.size() < 2) return Usability::Unusable;
    bool coincident = false;
    bool extended = false;
    for (std::size_t i = 0; i < strand.size(); ++i) {
        if (!strand[i].allFinite()) return Usability::Unusable;
        if (i == 0) continue;
        const bool same = (strand[i] - strand[i - 1]).norm() <= kCoincidentPoints;
        coincident = coincident || same;
        extended = extended || !same;
    }
    if (!extended) return Usability::Unusable;
    return coincident ? Usability::CoincidentPoints : Usability::Good;
}

/// Counts places and keeps the first, for one line of the report.
struct Tally {
    std::size_t count = 0;
    std::size_t first = 0;
    void add(std::size_t strand) {
        if (count++ == 0) first = strand;
    }
    std::string where() const {
        return count == 1 ? fmt::format("strand {}", first)
                          : fmt::format("strand {} and {} more", first, count - 1);
    }
};

class Preparer {
  public:
    Preparer(const Groom& groom, const StrandExportOptions& options, std::uint32_t target, StrandOrder order)
        : groom_(groom), options_(options), target_(target), order_(order), layers_(layersOfStrands(groom)) {
        result_.metresPerUnit = options.metresPerUnit;
        result_.up = options.up;
        radii_ = perPoint<float>(attribute::kRadius);
        widthChanges_ = widthChanges(groom);
        transparency_ = perPoint<float>(attribute::kTransparency);
        colours_ = perPoint<Vec3f>(attribute::kPointColour);
        const auto guides = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
        const bool areMixed = guides.size() == groom.strandCount() &&
                              std::ranges::find(guides, 0) != guides.end() &&
                              std::ranges::any_of(guides, [](std::uint8_t flag) { return flag != 0; });
        if (order == StrandOrder::layersAndGuides && areMixed) guides_ = guides;
    }

    PreparedStrands run() {
        const std::size_t strands = groom_.strandCount();
        const std::size_t points = target_ ? strands * target_ : groom_.pointCount();
        result_.positions.reserve(points);
        result_.thickness.reserve(points);
        std::vector<std::size_t> order(strands);
        std::iota(order.begin(), order.end(), std::size_t{0});
        if (order_ != StrandOrder::groom)
            std::ranges::stable_sort(
                order, {}, [&](std::size_t strand) { return std::pair(layers_[strand], isGuide(strand)); });
        for (const std::size_t strand : order) add(strand);
        addParts();
        addFrames();
        sayFindings();
        return std::move(result_);
    }

  private:
    template <class T>
    std::span<const T> perPoint(std::string_view name) const {
        const auto values = groom_.pointAttributes.view<T>(name);
        return values.size() == groom_.pointCount() ? values : std::span<const T>();
    }

    void add(std::size_t strand) {
        const auto points = groom_.strand(strand);
        const Usability judged = usability(points);
        if (judged == Usability::Unusable) return unusable_.add(strand);
        if (judged == Usability::CoincidentPoints) coincident_.add(strand);
        const bool resample = target_ != 0 && points.size() != target_;
        if (resample) resampled_.add(strand);
        result_.isResampled = result_.isResampled || resample;
        const std::size_t count = resample ? target_ : points.size();
        if (resample) {
            for (const Vec3f& point : resampleEvenly(points, count)) addPosition(point);
        } else {
            for (const Vec3f& point : points) addPosition(point);
        }
        const std::size_t first = groom_.offsets[strand];
        addThickness(strand, points, first, count);
        append(result_.transparency, transparency_, points, first, count);
        append(result_.colours, colours_, points, first, count);
        result_.sources.push_back(static_cast<std::uint32_t>(strand));
        result_.offsets.push_back(static_cast<std::uint32_t>(result_.positions.size()));
    }

    void addParts() {
        for (std::size_t s = 0; s < result_.sources.size(); ++s) {
            const std::uint32_t source = result_.sources[s];
            const std::uint32_t layer = order_ == StrandOrder::groom ? 0 : layers_[source];
            if (result_.parts.empty() || result_.parts.back().layer != layer ||
                result_.parts.back().areGuides != isGuide(source))
                result_.parts.push_back({layer, isGuide(source), s, 0});
            ++result_.parts.back().strandCount;
        }
    }

    void addFrames() {
        if (!options_.frames) return;
        result_.frames.resize(options_.frames->points.size());
        parallelFor(result_.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t f = begin; f < end && !options_.watch.isCancelled(); ++f) {
                const std::span<const Vec3f> all = options_.frames->points[f];
                std::vector<Vec3f>& frame = result_.frames[f];
                frame.reserve(result_.positions.size());
                for (std::size_t s = 0; s < result_.sources.size(); ++s) {
                    const std::uint32_t first = groom_.offsets[result_.sources[s]];
                    const auto points = all.subspan(first, groom_.offsets[result_.sources[s] + 1] - first);
                    const std::size_t count = result_.offsets[s + 1] - result_.offsets[s];
                    const std::vector<Vec3f> even =
                        count == points.size() ? std::vector<Vec3f>() : resampleEvenly(points, count);
                    for (const Vec3f& point : even.empty() ? points : std::span<const Vec3f>(even))
                        frame.push_back(toFile(point, options_));
                }
            }
        });
    }

    bool isGuide(std::size_t strand) const { return !guides_.empty() && guides_[strand] != 0; }

    void addPosition(const Vec3f& position) { result_.positions.push_back(toFile(position, options_)); }

    void addThickness(std::size_t strand, std::span<const Vec3f> points, std::size_t first,
                      std::size_t count) {
        const std::size_t before = result_.thickness.size();
        const std::size_t layer = layers_[strand];
        const bool own = layer < groom_.layers.size() && groom_.layers[layer].material;
        if (radii_.empty() || own) {
            const auto radii = materialRadii(groom_.materialOf(layer), count);
            result_.thickness.insert(result_.thickness.end(), radii.begin(), radii.end());
        } else {
            append(result_.thickness, radii_, points, first, count);
        }
        std::vector<float> changes;
        append(changes, widthChanges_, points, first, count);
        for (std::size_t i = 0; i < changes.size(); ++i)
            result_.thickness[before + i] = widened(result_.thickness[before + i], changes[i]);
        for (std::size_t i = before; i < result_.thickness.size(); ++i) {
            result_.thickness[i] = 2.0f * result_.thickness[i] / options_.metresPerUnit;
        }
    }

    template <class T>
    void append(std::vector<T>& target, std::span<const T> values, std::span<const Vec3f> points,
                std::size_t first, std::size_t count) const {
        if (values.empty()) return;
        const auto own = values.subspan(first, points.size());
        if (count == points.size()) {
            target.insert(target.end(), own.begin(), own.end());
            return;
        }
        const auto resampled = resampleValues(points, own, count);
        target.insert(target.end(), resampled.begin(), resampled.end());
    }

    void sayFindings() {
        auto& findings = result_.findings;
        findings.push_back({Severity::Info,
                            fmt::format("positions are in units of {} m, {} up, right-handed",
                                        options_.metresPerUnit, options_.up == UpAxis::Y ? "Y" : "Z"),
                            "file", "set the same unit and axis in the importing program"});
        if (unusable_.count > 0) {
            findings.push_back({Severity::Warning,
                                fmt::format("{} strands without length, with points that are not finite or "
                                            "with fewer than two points were left out",
                                            unusable_.count),
                                unusable_.where(), "delete or redraw them"});
        }
        if (coincident_.count > 0 && target_ == 0) {
            findings.push_back(
                {Severity::Warning,
                 fmt::format(
                     "{} strands have segments without length, for which some engines reject the whole file",
                     coincident_.count),
                 coincident_.where(), "resample the strands"});
        }
        if (resampled_.count > 0) {
            findings.push_back(
                {Severity::Info,
                 fmt::format("{} strands were resampled to {} points", resampled_.count, target_),
                 resampled_.where(), "resample the groom to see the result before you export"});
        }
        if (radii_.empty()) {
            findings.push_back({Severity::Info, "the groom has no widths, so those of the material were used",
                                "radius", "give the strands a radius"});
        }
    }

    const Groom& groom_;
    const StrandExportOptions& options_;
    std::uint32_t target_;
    StrandOrder order_;
    std::span<const std::uint8_t> guides_;  ///< where they are kept apart
    std::vector<std::uint32_t> layers_;
    std::span<const float> radii_;
    std::span<const float> widthChanges_;
    std::span<const float> transparency_;
    std::span<const Vec3f> colours_;
    PreparedStrands result_;
    Tally unusable_;
    Tally coincident_;
    Tally resampled_;
};

void judgeRoots(const Groom& groom, const PreparedStrands& prepared, std::vector<Finding>& findings) {
    if (!groom.scalp || groom.scalp->triangleCount() == 0) return;
    const SurfaceTree tree(*groom.scalp, groom.scalpSelection);
    std::vector<float> distances(prepared.strandCount());
    parallelFor(distances.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            distances[i] = tree.closest(groom.strand(prepared.sources[i]).front()).distance;
        }
    });
    const auto farthest = std::max_element(distances.begin(), distances.end());
    const bool floating = *farthest > kRootTolerance;
    findings.push_back(
        {floating ? Severity::Warning : Severity::Info,
         fmt::format("roots are up to {:.3g} mm from the scalp", *farthest * 1000.0f),
         fmt::format("strand {}", prepared.sources[static_cast<std::size_t>(farthest - distances.begin())]),
         floating ? "bind the strands to the scalp" : ""});
}

/// What the target takes less of than there is, with the option that mends it.
void judgeLimits(const TargetLimits& limits, PreparedStrands& prepared) {
    Tally tooMany, tooFew, coincident;
    for (std::size_t strand = 0; strand < prepared.strandCount(); ++strand) {
        const std::uint32_t begin = prepared.offsets[strand], end = prepared.offsets[strand + 1];
        if (limits.points > 0 && end - begin > limits.points) tooMany.add(prepared.sources[strand]);
        if (end - begin < limits.fewestPoints) tooFew.add(prepared.sources[strand]);
        if (!limits.refusesCoincident) continue;
        const auto points = std::span(prepared.positions).subspan(begin, end - begin);
        if (std::ranges::adjacent_find(points) != points.end()) coincident.add(prepared.sources[strand]);
    }
    const auto say = [&](std::string what, std::string where, std::string fix) {
        prepared.findings.push_back({Severity::Error, std::move(what), std::move(where), std::move(fix)});
    };
    if (tooMany.count > 0)
        say(fmt::format("{} takes at most {} points per strand, but {} have more", limits.program,
                        limits.points, tooMany.count),
            tooMany.where(), fmt::format("export with --points {}", limits.points));
    if (tooFew.count > 0)
        say(fmt::format("{} needs {} points per strand or more, but {} have fewer", limits.program,
                        limits.fewestPoints, tooFew.count),
            tooFew.where(), fmt::format("export with --points {}", limits.fewestPoints));
    if (coincident.count > 0)
        say(fmt::format("{} rejects all strands if one segment has no length", limits.program),
            coincident.where(), "export with --points, which spaces points evenly");
    if (limits.strands > 0 && prepared.strandCount() > limits.strands)
        say(fmt::format("{} takes at most {} strands, but there are {}", limits.program, limits.strands,
                        prepared.strandCount()),
            "strands", "export guides, or the groom in parts");
}

double distanceToPolyline(const Vec3f& point, std::span<const Vec3f> polyline) {
    float best = (point - polyline[0]).squaredNorm();
    for (std::size_t i = 1; i < polyline.size(); ++i) {
        const Vec3f along = polyline[i] - polyline[i - 1];
        const float length = along.squaredNorm();
        const float t =
            length > 0 ? std::clamp((point - polyline[i - 1]).dot(along) / length, 0.0f, 1.0f) : 0.0f;
        best = std::min(best, (polyline[i - 1] + t * along - point).squaredNorm());
    }
    return std::sqrt(double{best});
}

double strandError(std::span<const Vec3f> strand, std::span<const Vec3f> readBack) {
    double error = 0;
    for (std::size_t i = 0; i < strand.size(); ++i) {
        const double distance = strand.size() == readBack.size() ? double{(strand[i] - readBack[i]).norm()}
                                                                 : distanceToPolyline(strand[i], readBack);
        error = std::max(error, distance);
    }
    return error;
}

}  // namespace

Vec3f toFile(const Vec3f& position, const StrandExportOptions& options) {
    Vec3f p = position;
    if (options.up == UpAxis::Z) p = Vec3f(p.x(), -p.z(), p.y());
    return options.metresPerUnit == 1.0f ? p : Vec3f(p / options.metresPerUnit);
}

Result<PreparedStrands> prepareStrands(const Groom& groom, const StrandExportOptions& options,
                                       std::uint32_t pointsPerStrand, StrandOrder order) {
    if (!(options.metresPerUnit > 0) || !std::isfinite(options.metresPerUnit)) {
        return fail(fmt::format("{} metres per unit", options.metresPerUnit), "expected a positive number");
    }
    if (pointsPerStrand == 1)
        return fail("1 point per strand", "expected 2 or more, or 0 to keep what there is");
    if (auto status = options.watch.at(0); !status) return tl::unexpected(status.error());
    auto prepared = Preparer(groom, options, pointsPerStrand, order).run();
    if (auto status = options.watch.at(0.2); !status) return tl::unexpected(status.error());
    if (prepared.sources.empty())
        return fail("the groom has no usable strand", "expected at least one to write");
    judgeLimits(options.limits, prepared);
    return prepared;
}

TargetLimits unityLimits() {
    return {"Unity", 64000, 128, 3, true};
}

std::vector<Vec2f> rootUvs(const Groom& groom, const PreparedStrands& strands) {
    const auto stored = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    const auto bindings = groom.rootBindings();
    const bool onScalp =
        groom.scalp && !groom.scalp->cornerUvs().empty() && bindings.size() == groom.strandCount();
    const auto isZero = [](const Vec2f& uv) { return uv == Vec2f::Zero(); };
    const bool isMadeUp = !stored.empty() && groom.scalp && groom.scalp->cornerUvs().empty() &&
                          std::ranges::all_of(stored, isZero);
    std::vector<Vec2f> uvs;
    if (isMadeUp) return uvs;
    for (const std::uint32_t source : strands.sources) {
        if (stored.size() == groom.strandCount())
            uvs.push_back(stored[source]);
        else if (onScalp)
            uvs.push_back(groom.scalp->uvAt(bindings[source].triangle, bindings[source].barycentric));
    }
    return uvs;
}

namespace {

/// How far strands that move are off, in millimetres; they must be as many frames.
Result<double> frameError(const PreparedStrands& prepared, const StrandExportOptions& options,
                          const ImportedStrands& readBack, const std::filesystem::path& path) {
    if (readBack.frames.size() != prepared.frames.size())
        return failIn(path.string(), {},
                      fmt::format("reads back as {} samples in time", readBack.frames.size()),
                      fmt::format("{} were written", prepared.frames.size()));
    double farthest = 0;
    for (std::size_t f = 0; f < prepared.frames.size(); ++f) {
        const double share = static_cast<double>(f) / static_cast<double>(prepared.frames.size());
        if (auto status = options.watch.at(0.9 + 0.1 * share); !status) return tl::unexpected(status.error());
        if (readBack.frames[f].size() != prepared.frames[f].size())
            return failIn(path.string(), {},
                          fmt::format("reads back with {} points in sample {}", readBack.frames[f].size(), f),
                          fmt::format("{} were written", prepared.frames[f].size()));
        for (std::size_t p = 0; p < prepared.frames[f].size(); ++p) {
            const Vec3f off = toFile(readBack.frames[f][p], options) - prepared.frames[f][p];
            farthest = std::max(farthest, static_cast<double>(off.norm()));
        }
    }
    return 1000 * farthest * static_cast<double>(options.metresPerUnit);
}

}  // namespace

Result<ExportReport> writeAndCompare(const Groom& groom, PreparedStrands prepared,
                                     const StrandExportOptions& options, const std::filesystem::path& path,
                                     FileContents contents) {
    const auto bytes = std::visit([](const auto& all) { return std::as_bytes(std::span(all)); }, contents);
    const std::size_t size = bytes.size(), points = prepared.positions.size();
    if (auto status = options.watch.at(0.5); !status) return tl::unexpected(status.error());
    if (auto status = writeFileAtomically(path, bytes); !status) return tl::unexpected(status.error());
    StrandImportOptions importOptions;
    importOptions.metresPerUnit = options.metresPerUnit;
    importOptions.isUnitAsked = true;
    importOptions.up = options.up;
    importOptions.frames = importOptions.everySample = options.frames != nullptr;
    if (auto status = options.watch.at(0.6); !status) return tl::unexpected(status.error());
    // What went into a device cannot be had back.
    std::error_code code;
    const bool isFile = std::filesystem::is_regular_file(whereWritten(path), code);
    if (isFile) contents = {};
    std::vector<Vec3f>().swap(prepared.positions);
    const auto readBack = isFile ? importStrands(path, importOptions)
                                 : importStrandsFromMemory(path.string(), bytes, importOptions);
    if (!readBack) return tl::unexpected(readBack.error());
    if (auto status = options.watch.at(0.9); !status) return tl::unexpected(status.error());
    if (readBack->groom.strandCount() != prepared.strandCount()) {
        return failIn(path.string(), {},
                      fmt::format("reads back as {} strands", readBack->groom.strandCount()),
                      fmt::format("{} were written", prepared.strandCount()));
    }
    ExportReport report;
    report.format = readBack->format;
    report.strands = prepared.strandCount();
    report.points = points;
    report.bytes = size;
    double farthest = 0;  // mm
    for (std::size_t strand = 0; strand < prepared.strandCount(); ++strand) {
        const double error =
            strandError(groom.strand(prepared.sources[strand]), readBack->groom.strand(strand));
        farthest = std::max(farthest, error * 1000.0);
    }
    if (options.frames) {
        const auto off = frameError(prepared, options, *readBack, path);
        if (!off) return tl::unexpected(off.error());
        report.frames = options.frames->frameCount();
        report.samples = prepared.frames.size();
        farthest = std::max(farthest, *off);
    }
    report.maxErrorMm = farthest;
    compareAttributes(groom, prepared, options.metresPerUnit, *readBack, report);
    report.findings = std::move(prepared.findings);
    report.names = std::move(prepared.names);
    judgeRoots(groom, prepared, report.findings);
    report.findings.insert(report.findings.end(), readBack->warnings.begin(), readBack->warnings.end());
    return report;
}

}  // namespace hairloom
