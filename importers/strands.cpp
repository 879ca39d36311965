// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/strands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/hash.h"
#include "core/base/stop_scope.h"
#include "core/groom/strand_subset.h"
#include "hairloom/strands.h"
#include "importers/attribute_units.h"
#include "importers/foreign_reader.h"
#include "importers/raw_strands.h"
#include "importers/strand_file.h"
#include "importers/strand_parts.h"
#include "importers/strand_roots.h"
#include "importers/strand_size.h"

namespace hairloom {
namespace {

Vec3f toMetresYUp(const Vec3f& position, const StrandImportOptions& options, bool mirrorZ) {
    Vec3f p = position;
    if (mirrorZ) p.z() = -p.z();
    if (options.up == UpAxis::Z) p = Vec3f(p.x(), p.z(), -p.y());
    return p * options.metresPerUnit;
}

/// Keeps what can be used of the strands, in metres and Y up, and compacts their attributes alike.
class Cleaner {
  public:
    Cleaner(RawStrands& raw, const StrandImportOptions& options) : raw_(raw), options_(options) {}

    void run() {
        const std::size_t strands = raw_.offsets.size() - 1;
        std::uint32_t begin = 0;
        offsets_.reserve(strands + 1);
        for (std::size_t strand = 0; strand < strands; ++strand) {
            const std::uint32_t end = raw_.offsets[strand + 1];
            const std::size_t kept = offsets_.size(), dropped = droppedPoints_.size();
            keep(strand, begin, end);
            if (offsets_.size() == kept) {
                droppedStrands_.push_back(static_cast<std::uint32_t>(strand));
                droppedPoints_.resize(dropped);
                for (std::uint32_t point = begin; point < end; ++point) droppedPoints_.push_back(point);
            }
            begin = end;
        }
        compactAttributes();
        raw_.positions.resize(written_);
        for (auto* values : {&raw_.thickness, &raw_.transparency}) {
            if (!values->empty()) values->resize(written_);
        }
        if (!raw_.colours.empty()) raw_.colours.resize(written_);
        if (!raw_.rootUvs.empty()) raw_.rootUvs.resize(offsets_.size() - 1);
        if (!raw_.thicknessScale.empty()) raw_.thicknessScale.resize(offsets_.size() - 1);
        raw_.offsets = std::move(offsets_);
        reportRepairs();
    }

    /// The first point of the strands that were kept, or of their frames, that is too far away for hair.
    const std::optional<FarPoint>& far() const { return far_; }

  private:
    void keep(std::size_t strand, std::uint32_t begin, std::uint32_t end) {
        const std::uint32_t source =
            raw_.sourceIndices.empty() ? static_cast<std::uint32_t>(strand) : raw_.sourceIndices[strand];
        const auto drop = [&](DropReason reason) { raw_.dropped.push_back({source, reason}); };
        if (end - begin < 2) return drop(DropReason::TooFewPoints);
        const std::size_t start = written_;
        for (std::uint32_t point = begin; point < end; ++point) {
            const Vec3f position = toMetresYUp(raw_.positions[point], options_, raw_.mirrorZ);
            if (!position.allFinite()) {
                written_ = start;
                return drop(DropReason::NotFinite);
            }
            if (written_ > start && (position - raw_.positions[written_ - 1]).norm() <= kCoincidentPoints)
                droppedPoints_.push_back(point);
            else
                place(point, position);
        }
        const std::size_t kept = written_ - start;
        if (kept < 2) {
            written_ = start;
            return drop(DropReason::ZeroLength);
        }
        if (kept < end - begin) noteRepair(source, end - begin - kept);
        lookFar(source, std::span<const Vec3f>(raw_.positions).subspan(start, kept));
        if (!raw_.rootUvs.empty()) raw_.rootUvs[offsets_.size() - 1] = raw_.rootUvs[strand];
        if (!raw_.thicknessScale.empty())
            raw_.thicknessScale[offsets_.size() - 1] = raw_.thicknessScale[strand];
        offsets_.push_back(static_cast<std::uint32_t>(written_));
    }

    void lookFar(std::uint32_t strand, std::span<const Vec3f> points) {
        for (std::size_t p = 0; p < points.size() && !far_; ++p) {
            const float reach = points[p].cwiseAbs().maxCoeff();
            // Frames may hold what is no number, too.
            if (!(reach <= kFarthestPoint)) far_ = FarPoint{strand, static_cast<std::uint32_t>(p), reach};
        }
    }

    void compactAttributes() {
        for (RawAttribute& attribute : raw_.attributes) {
            const auto& dropped = attribute.perPoint ? droppedPoints_ : droppedStrands_;
            remove(dropped, attribute.numbers, attribute.components);
            remove(dropped, attribute.whole, 1);
        }
        for (std::vector<Vec3f>& frame : raw_.frames) {
            remove(droppedPoints_, frame, 1);
            for (Vec3f& position : frame) position = toMetresYUp(position, options_, raw_.mirrorZ);
            for (std::size_t s = 0; s + 1 < offsets_.size() && frame.size() == written_; ++s) {
                lookFar(static_cast<std::uint32_t>(s),
                        std::span<const Vec3f>(frame).subspan(offsets_[s], offsets_[s + 1] - offsets_[s]));
            }
        }
    }

    /// Elements by their places, which ascend.
    template <class T>
    static void remove(std::span<const std::uint32_t> places, std::vector<T>& values,
                       std::size_t components) {
        if (values.empty() || places.empty()) return;
        std::size_t free = places.front() * components;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const std::size_t from = (places[i] + std::size_t{1}) * components;
            const std::size_t to = i + 1 < places.size() ? places[i + 1] * components : values.size();
            for (std::size_t at = from; at < to; ++at) values[free++] = values[at];
        }
        values.resize(free);
    }

    /// Moves a point to the next free place, which is never behind its own.
    void place(std::uint32_t point, const Vec3f& position) {
        raw_.positions[written_] = position;
        if (!raw_.thickness.empty()) raw_.thickness[written_] = raw_.thickness[point];
        if (!raw_.transparency.empty()) raw_.transparency[written_] = raw_.transparency[point];
        if (!raw_.colours.empty()) raw_.colours[written_] = raw_.colours[point];
        ++written_;
    }

    void noteRepair(std::uint32_t strand, std::size_t points) {
        if (repairedStrands_++ == 0) firstRepaired_ = strand;
        repairedPoints_ += points;
    }

    void reportRepairs() {
        if (repairedStrands_ == 0) return;
        raw_.warnings.push_back(fileWarning(
            fmt::format("{} points that coincided with the one before them were removed", repairedPoints_),
            repairedStrands_ == 1
                ? fmt::format("strand {}", firstRepaired_)
                : fmt::format("strand {} and {} more", firstRepaired_, repairedStrands_ - 1),
            "resample if every strand must have the same number of points"));
    }

    RawStrands& raw_;
    const StrandImportOptions& options_;
    std::vector<std::uint32_t> offsets_{0};
    std::optional<FarPoint> far_;
    std::vector<std::uint32_t> droppedStrands_, droppedPoints_;  ///< of the file, ascending
    std::size_t written_ = 0;
    std::size_t repairedStrands_ = 0;
    std::size_t repairedPoints_ = 0;
    std::uint32_t firstRepaired_ = 0;
};

void takeThickness(RawStrands& raw, Groom& groom, float metresPerUnit) {
    if (!raw.thickness.empty()) {
        // Thickness is a diameter: renderers of these files draw it as a width. What has none has the
        // material's.
        for (std::size_t strand = 0; strand < groom.strandCount(); ++strand) {
            const std::uint32_t first = groom.offsets[strand], end = groom.offsets[strand + 1];
            for (std::uint32_t point = first; point < end; ++point) {
                float& value = raw.thickness[point];
                const float t = static_cast<float>(point - first) / static_cast<float>(end - first - 1);
                if (std::isnan(value))
                    value = groom.material.rootRadius * (1 + t * (groom.material.tipScale - 1));
                else
                    value = std::isfinite(value) && value > 0 ? 0.5f * value * metresPerUnit : 0;
            }
        }
        groom.pointAttributes.set(attribute::kRadius, std::move(raw.thickness));
        return;
    }
    constexpr float kThinnest = 5e-6f;
    constexpr float kThickest = 0.001f;
    const float radius = 0.5f * raw.defaultThickness * metresPerUnit;
    if (radius >= kThinnest && radius <= kThickest) {
        groom.material.rootRadius = radius;
        groom.material.tipScale = 1;
    }
}

template <class Vector>
CowArray<Vector> vectorsOf(const std::vector<float>& numbers) {
    constexpr auto kComponents = static_cast<std::size_t>(Vector::RowsAtCompileTime);
    std::vector<Vector> values(numbers.size() / kComponents);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = Eigen::Map<const Vector>(&numbers[i * kComponents]);
    return CowArray<Vector>(std::move(values));
}

AttributeData dataOf(RawAttribute& attribute) {
    switch (attribute.type) {
        case RawAttribute::Type::Whole:
            return CowArray<std::int32_t>(std::move(attribute.whole));
        case RawAttribute::Type::Index:
            return CowArray<std::uint32_t>({attribute.whole.begin(), attribute.whole.end()});
        case RawAttribute::Type::Flag:
            return CowArray<std::uint8_t>({attribute.whole.begin(), attribute.whole.end()});
        default:
            break;
    }
    switch (attribute.components) {
        case 2:
            return vectorsOf<Vec2f>(attribute.numbers);
        case 3:
            return vectorsOf<Vec3f>(attribute.numbers);
        case 4:
            return vectorsOf<Vec4f>(attribute.numbers);
        default:
            return CowArray<float>(std::move(attribute.numbers));
    }
}

/// Whether the values are what Hairloom itself means by the name.
bool isAsMeantHere(const RawAttribute& attribute) {
    const bool isNumber = attribute.type == RawAttribute::Type::Number;
    if (attribute.name == attribute::kStiffness) {
        const auto isFactor = [](float value) { return value >= 0 && value <= runtime::kMostStiffness; };
        return isNumber && attribute.components == 1 && std::ranges::all_of(attribute.numbers, isFactor);
    }
    if (attribute.name == attribute::kTransparency || attribute.name == attribute::kDye ||
        attribute.name == attribute::kMelanin)
        return isNumber && attribute.components == 1;
    if (attribute.name == attribute::kStrandColour) return isNumber && attribute.components == 3;
    // Groups, guides and ids have been given their types by adoptAttributes(), layers by the one format that
    // has them.
    const bool adopted = attribute.name == attribute::kLayer || attribute.name == attribute::kGroup ||
                         attribute.name == attribute::kGuide || attribute.name == attribute::kStrandId;
    return adopted &&
           (attribute.type == RawAttribute::Type::Index || attribute.type == RawAttribute::Type::Flag);
}

/// A name that means something else here gets another.
std::string importedName(const RawAttribute& attribute) {
    constexpr std::array kPointNames{attribute::kPosition, attribute::kRadius, attribute::kPointColour,
                                     attribute::kTransparency, attribute::kDye};
    constexpr std::array kStrandNames{
        attribute::kRootTriangle, attribute::kRootBarycentric, attribute::kRootUv, attribute::kFrozen,
        attribute::kSelected,     attribute::kHidden,          attribute::kLayer,  attribute::kStrandColour,
        attribute::kDye,          attribute::kMelanin,         attribute::kGroup,  attribute::kGuide,
        attribute::kStiffness,    attribute::kStrandId};
    const auto among = [&](const auto& names) {
        return std::ranges::find(names, attribute.name) != names.end();
    };
    const bool known = attribute.perPoint ? among(kPointNames) : among(kStrandNames);
    return known && !isAsMeantHere(attribute) ? attribute.name + "_of_file" : attribute.name;
}

/// Lengths, places and vectors become metres, Y up.
void toMetres(RawAttribute& attribute, const StrandImportOptions& options, bool mirrorZ) {
    const AttributeUnit unit = attributeUnit(attribute.name, attribute.components);
    if (attribute.type != RawAttribute::Type::Number || unit == AttributeUnit::None) return;
    if (unit == AttributeUnit::Length) {
        if (options.metresPerUnit == 1) return;
        for (float& length : attribute.numbers) length *= options.metresPerUnit;
        return;
    }
    for (std::size_t i = 0; i + 2 < attribute.numbers.size(); i += 3) {
        Eigen::Map<Vec3f> value(&attribute.numbers[i]);
        value = toMetresYUp(value, options, mirrorZ);
    }
}

void takeAttributes(RawStrands& raw, Groom& groom) {
    for (RawAttribute& attribute : raw.attributes) {
        AttributeSet& set = attribute.perPoint ? groom.pointAttributes : groom.strandAttributes;
        std::string name = importedName(attribute);
        set.set(name, dataOf(attribute));
    }
    groom.groupNames = std::move(raw.groupNames);
}

Groom makeFrom(RawStrands& raw, float metresPerUnit) {
    Groom groom = makeGroom(std::move(raw.offsets), std::move(raw.positions));
    takeThickness(raw, groom, metresPerUnit);
    if (!raw.transparency.empty())
        groom.pointAttributes.set(attribute::kTransparency, std::move(raw.transparency));
    if (!raw.colours.empty()) groom.pointAttributes.set(attribute::kPointColour, std::move(raw.colours));
    if (!raw.rootUvs.empty()) groom.strandAttributes.set(attribute::kRootUv, std::move(raw.rootUvs));
    if (!raw.thicknessScale.empty())
        groom.strandAttributes.set("thickness_scale", std::move(raw.thicknessScale));
    takeAttributes(raw, groom);
    if (!raw.layerNames.empty()) groom.layers.clear();
    for (const std::string& name : raw.layerNames) groom.layers.emplace_back().name = name;
    if (raw.defaultColour) groom.material.rootColour = groom.material.tipColour = *raw.defaultColour;
    return groom;
}

/// The options with the unit and axis that the file itself states.
StrandImportOptions stated(RawStrands& raw, StrandImportOptions options) {
    if (!raw.statedMetresPerUnit && raw.assumedMetresPerUnit && !options.isUnitAsked &&
        options.metresPerUnit == 1.0f)
        options.metresPerUnit = *raw.assumedMetresPerUnit;
    if (raw.statedMetresPerUnit) {
        const float unit = *raw.statedMetresPerUnit;
        if (options.metresPerUnit != 1.0f && std::abs(options.metresPerUnit / unit - 1) > 1e-4f) {
            raw.warnings.push_back(fileNote(
                fmt::format("the file states its unit, {} m, so the requested one is not used", unit),
                "unit"));
        }
        options.metresPerUnit = unit;
    }
    if (raw.statedUp) options.up = *raw.statedUp;
    return options;
}

/// Layers as the file authored them, where its parts are of these by name; else those of the parts.
void takeLayers(const Groom& authored, Groom& groom, bool hasParts) {
    if (!hasParts) {
        groom.layers = authored.layers;
        return;
    }
    std::vector<std::uint32_t> places;
    for (const Layer& layer : groom.layers) {
        const auto found = std::ranges::find(authored.layers, layer.name, &Layer::name);
        if (found == authored.layers.end()) return;
        places.push_back(static_cast<std::uint32_t>(found - authored.layers.begin()));
    }
    std::vector<std::uint32_t> layers = layersOfStrands(groom);
    for (std::uint32_t& layer : layers) layer = places[layer];
    groom.layers = authored.layers;
    if (groom.layers.size() > 1) groom.strandAttributes.set(attribute::kLayer, std::move(layers));
}

/// Operators, where the file has what they start from, and its strands are what they made.
void takeOperators(const Groom& authored, std::uint64_t shape, ImportedStrands& result) {
    Groom& groom = result.groom;
    if (authored.operators.empty()) return;
    const bool isBased =
        groom.pointAttributes.view<Vec3f>(attribute::kBasePosition).size() == groom.pointCount();
    if (isBased && hashOf(groom.positions()) == shape) {
        groom.operators = authored.operators;
        return;
    }
    dropOperators(groom);
    result.warnings.push_back(
        fileNote("the operators were left out, since strands are not those that they made", "operators",
                 "keep the project, or export in metres with Y up"));
}

void takeSettings(const RawStrands& raw, ImportedStrands& result) {
    const Groom& authored = *raw.authored;
    result.hasSettings = true;
    result.groom.simulation = authored.simulation;
    result.groom.material = authored.material;
    result.groom.shadows = authored.shadows;
    result.groom.interpolation = authored.interpolation;
    result.groom.placement = authored.placement;
    result.groom.spheres = authored.spheres;
    result.groom.maskNames = authored.maskNames;
    takeLayers(authored, result.groom, !raw.parts.empty());
    takeOperators(authored, raw.authoredShape, result);
}

/// Attribute values that no consumer could use become the nearest that they can.
template <class T, class Usable>
void repairValues(std::vector<T>& values, std::string_view name, std::vector<Finding>& warnings,
                  const T& instead, Usable usable) {
    std::size_t repaired = 0;
    for (T& value : values) {
        if (usable(value)) continue;
        value = instead;
        ++repaired;
    }
    if (repaired > 0) {
        warnings.push_back(fileWarning(fmt::format("{} values of {} are not finite", repaired, name),
                                       std::string(name), "they were set to a neutral value"));
    }
}

void repairAttributes(RawStrands& raw) {
    const auto finite = [](const auto& value) { return value.allFinite(); };
    const auto finiteNumber = [](float value) { return std::isfinite(value); };
    repairValues(raw.transparency, "transparency", raw.warnings, 0.0f, finiteNumber);
    repairValues(raw.thicknessScale, "strand thickness", raw.warnings, 1.0f, finiteNumber);
    repairValues(raw.colours, "colours", raw.warnings, Vec3f(Vec3f::Ones()), finite);
    for (RawAttribute& attribute : raw.attributes)
        repairValues(attribute.numbers, attribute.name, raw.warnings, 0.0f, finiteNumber);
    repairValues(raw.rootUvs, "root UVs", raw.warnings, Vec2f(Vec2f::Zero()), finite);
}

}  // namespace

std::string_view dropReasonName(DropReason reason) {
    constexpr std::array<std::string_view, 5> names{"fewer than two points", "not finite", "zero length",
                                                    "lines branch", "closed loop"};
    return names[static_cast<std::size_t>(reason)];
}

namespace {

Status checkUnit(const StrandImportOptions& asked) {
    if (asked.metresPerUnit > 0 && std::isfinite(asked.metresPerUnit)) return {};
    return fail(fmt::format("{} metres per unit", asked.metresPerUnit), "expected a positive number");
}

/// Where a reader says no more than what is wrong.
constexpr const char* kReadableFile = "expected a whole file that can be read: export it again";

Result<ImportedStrands> importRaw(const std::string& file, Result<RawStrands> raw,
                                  const StrandImportOptions& asked) {
    if (!raw) return tl::unexpected(raw.error());
    const StrandImportOptions options = stated(*raw, asked);
    if (auto status = checkStop(); !status) return tl::unexpected(inFile(status.error(), file));
    layersFromParts(*raw);
    Cleaner cleaner(*raw, options);
    cleaner.run();
    std::sort(raw->dropped.begin(), raw->dropped.end(),
              [](const DroppedStrand& a, const DroppedStrand& b) { return a.strand < b.strand; });
    if (raw->offsets.size() < 2) {
        if (raw->dropped.empty()) return failIn(file, {}, "holds no strand", "expected at least one");
        return failIn(file, {},
                      fmt::format("none of its {} strands can be used; the first: {}", raw->dropped.size(),
                                  dropReasonName(raw->dropped.front().reason)),
                      "expected strands of two or more finite points");
    }
    if (cleaner.far())
        return tl::unexpected(
            inFile(tooFar(*cleaner.far(), raw->offsets, raw->positions, options.metresPerUnit), file));
    if (options.scalp && options.scalp->triangleCount() > 0) {
        if (!raw->rootFirst) orientToScalp(*raw, *options.scalp);
        if (auto near = checkRootDistance(*raw, *options.scalp, options); !near)
            return tl::unexpected(inFile(near.error(), file));
    }
    if (auto status = checkStop(); !status) return tl::unexpected(inFile(status.error(), file));
    repairAttributes(*raw);
    if (auto finding = implausibleSize(raw->offsets, raw->positions, options.metresPerUnit)) {
        raw->warnings.push_back(std::move(*finding));
    }
    ImportedStrands result;
    result.format = std::move(raw->format);
    result.dropped = std::move(raw->dropped);
    result.warnings = std::move(raw->warnings);
    for (RawAttribute& attribute : raw->attributes) toMetres(attribute, options, raw->mirrorZ);
    result.groom = makeFrom(*raw, options.metresPerUnit);
    for (Finding& finding : findThickHair(result.groom)) result.warnings.push_back(std::move(finding));
    if (raw->authored) takeSettings(*raw, result);
    result.frames = std::move(raw->frames);
    result.framesPerSecond = raw->framesPerSecond;
    result.isResampled = raw->isResampled;
    result.ribbons = raw->ribbons;
    return result;
}

}  // namespace

Result<ImportedStrands> importStrandsFromMemory(const std::string& file, std::span<const std::byte> bytes,
                                                const StrandImportOptions& options) {
    if (auto status = checkUnit(options); !status) return tl::unexpected(status.error());
    return importRaw(file, readStrandFile(file, {bytes.begin(), bytes.end()}, options, {}), options);
}

Result<ImportedStrands> importStrands(const std::filesystem::path& path, const StrandImportOptions& options) {
    if (auto status = checkUnit(options); !status) return tl::unexpected(status.error());
    auto imported = importRaw(path.string(), readStrandsInChild(path, options), options);
    if (!imported) return tl::unexpected(expecting(imported.error(), kReadableFile));
    // The parts fit each other, and no process but this one says so.
    if (auto status = checkStructure(imported->groom); !status)
        return tl::unexpected(expecting(inFile(status.error(), path.string()), kReadableFile));
    return imported;
}

}  // namespace hairloom
