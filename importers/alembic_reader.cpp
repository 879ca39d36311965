// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of Alembic files, in Ogawa's container: the schemas AbcGeom_Curve_v1 and _v2 below transforms of any
// kind.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "importers/alembic_archive.h"
#include "importers/curve_set.h"

namespace hairloom {
namespace {

constexpr int kMaxDepth = 64;

bool startsWith(const AlembicMetadata& metadata, std::string_view key, std::string_view value) {
    const auto found = metadata.find(key);
    return found != metadata.end() && found->second.starts_with(value);
}

std::string valueOf(const AlembicMetadata& metadata, std::string_view key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
}

/// One operation of a transform: its kind in the upper four bits, and its numbers.
Result<Eigen::Affine3d> operation(int kind, std::span<const double> values) {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    constexpr double kRadians = M_PI / 180;
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const auto axis = [&](const Vector3d& direction, double degrees) {
        if (direction.norm() > 0) result.rotate(AngleAxisd(degrees * kRadians, direction.normalized()));
    };
    switch (kind) {
        case 0:
            result.scale(Vector3d(values[0], values[1], values[2]));
            break;
        case 1:
            result.translate(Vector3d(values[0], values[1], values[2]));
            break;
        case 2:
            axis(Vector3d(values[0], values[1], values[2]), values[3]);
            break;
        // Points are rows there: the matrix is the transpose of ours.
        case 3:
            result.matrix() = Eigen::Map<const Eigen::Matrix4d>(values.data());
            break;
        default:
            axis(Vector3d::Unit(kind - 4), values[0]);
            break;
    }
    return result;
}

/// A sample of a transform of the schema AbcGeom_Xform.
Result<Eigen::Affine3d> transformAt(const AlembicArchive& archive,
                                    const std::vector<AlembicProperty>& properties, const std::string& path,
                                    std::uint32_t sample) {
    constexpr std::array<std::size_t, 7> kNumbers{3, 3, 4, 16, 1, 1, 1};
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const AlembicProperty* const ops = findProperty(properties, ".ops");
    const AlembicProperty* const vals = findProperty(properties, ".vals");
    if (ops == nullptr || vals == nullptr) return result;
    const auto kinds = archive.integers(*ops, 0);
    if (!kinds) return tl::unexpected(kinds.error());
    const auto values = archive.doubles(*vals, sample);
    if (!values) return tl::unexpected(values.error());
    std::size_t at = 0;
    for (const std::int64_t op : *kinds) {
        const auto kind = static_cast<std::size_t>(op >> 4);
        if (op < 0 || kind >= kNumbers.size())
            return fail(fmt::format("{}: a transform has an operation {}", path, op),
                        "expected kinds 0 to 6");
        if (at + kNumbers[kind] > values->size())
            return fail(fmt::format("{}: a transform has {} numbers", path, values->size()),
                        "expected as many as its operations take");
        const auto one = operation(static_cast<int>(kind), std::span(*values).subspan(at, kNumbers[kind]));
        if (!one) return one;
        result = result * *one;
        at += kNumbers[kind];
    }
    if (!result.matrix().allFinite()) return fail(path + ": a transform is not finite", "expected numbers");
    return result;
}

CurveAttribute::Scope scopeOf(const AlembicMetadata& metadata) {
    using Scope = CurveAttribute::Scope;
    const std::string scope = valueOf(metadata, "geoScope");
    if (scope == "con") return Scope::Constant;
    if (scope == "uni") return Scope::Curve;
    if (scope == "var") return Scope::Knot;
    if (scope == "vtx" || scope == "fvr") return Scope::Point;
    return Scope::Unknown;
}

/// What leads from an object to the file: a transform of each level, with its samples.
struct Level {
    std::string path;
    std::vector<AlembicProperty> xform;
    std::uint32_t samples = 1;
    bool inherits = true;
};

class Reader {
  public:
    Reader(const AlembicArchive& archive, const std::string& file, bool frames)
        : archive_(archive), file_(file), frames_(frames) {}

    /// All that is needed of the archive.
    Status readAll() {
        if (auto status = visit(archive_.top(), {}, 0); !status)
            return tl::unexpected(inFile(status.error(), file_));
        if (curves_.empty()) return failIn(file_, {}, "has no curves", "expected hair as curves");
        return {};
    }

    Result<RawStrands> strands() {
        std::size_t frames = 0;
        for (const CurveSet& set : curves_) frames = std::max(frames, set.frames.size());
        for (CurveSet& set : curves_) {
            if (auto status = appendCurves(file_, std::move(set), frames, strands_); !status)
                return tl::unexpected(status.error());
        }
        adoptAttributes(strands_);
        strands_.format = "Alembic";
        return std::move(strands_);
    }

  private:
    Status visit(const AlembicObject& object, const std::vector<Level>& above, int depth) {
        if (depth > kMaxDepth)
            return fail(object.path + " is nested too deep",
                        fmt::format("expected at most {} levels", kMaxDepth));
        const auto properties = archive_.properties(object);
        if (!properties) return tl::unexpected(properties.error());
        std::vector<Level> levels = above;
        if (const AlembicProperty* const xform = findProperty(*properties, ".xform")) {
            if (auto status = addLevel(object, *xform, levels); !status) return status;
        }
        const AlembicProperty* const geometry = findProperty(*properties, ".geom");
        if (geometry != nullptr && (startsWith(object.metadata, "schema", "AbcGeom_Curve_v") ||
                                    startsWith(geometry->metadata, "schema", "AbcGeom_Curve_v"))) {
            if (auto status = readCurves(object, *geometry, levels); !status) return status;
        }
        const auto children = archive_.children(object);
        if (!children) return tl::unexpected(children.error());
        for (const AlembicObject& child : *children) {
            if (auto status = visit(child, levels, depth + 1); !status) return status;
        }
        return {};
    }

    Status addLevel(const AlembicObject& object, const AlembicProperty& xform, std::vector<Level>& levels) {
        auto properties = archive_.properties(xform);
        if (!properties) return tl::unexpected(properties.error());
        Level level{object.path, std::move(*properties), 1, true};
        if (const AlembicProperty* const vals = findProperty(level.xform, ".vals"))
            level.samples = std::max(1u, changes(*vals));
        if (const AlembicProperty* const inherits = findProperty(level.xform, ".inherits")) {
            const auto value = archive_.integers(*inherits, 0);
            if (!value) return tl::unexpected(value.error());
            level.inherits = value->empty() || value->front() != 0;
        }
        if (!level.inherits) levels.clear();
        levels.push_back(std::move(level));
        return {};
    }

    /// Samples in time that are worth reading: of what stays, the first.
    static std::uint32_t changes(const AlembicProperty& property) {
        constexpr std::uint32_t kMaxFrames = 100'000;
        return property.lastChanged == 0 ? std::min(property.samples, 1u)
                                         : std::min(property.samples, kMaxFrames);
    }

    Result<Eigen::Affine3d> toFile(const std::vector<Level>& levels, std::uint32_t sample) const {
        Eigen::Affine3d result = Eigen::Affine3d::Identity();
        for (const Level& level : levels) {
            const auto one = transformAt(archive_, level.xform, level.path, sample);
            if (!one) return one;
            result = result * *one;
        }
        return result;
    }

    Result<std::vector<float>> pointsAt(const AlembicProperty& property, std::uint32_t sample) const {
        if (property.extent != 3) return fail(property.name + " has no vectors of three", "expected points");
        return archive_.floats(property, sample);
    }

    Status readCurves(const AlembicObject& object, const AlembicProperty& geometry,
                      const std::vector<Level>& levels) {
        const auto properties = archive_.properties(geometry);
        if (!properties) return tl::unexpected(properties.error());
        const AlembicProperty* const points = findProperty(*properties, "P");
        const AlembicProperty* const counts = findProperty(*properties, "nVertices");
        if (points == nullptr || counts == nullptr)
            return fail(object.path + " has no points or no counts", "expected P and nVertices");
        if (points->samples == 0) return {};
        CurveSet set;
        set.path = object.path;
        if (auto status = readForm(*properties, *counts, set); !status) return status;
        auto rest = pointsAt(*points, 0);
        if (!rest) return tl::unexpected(rest.error());
        set.points = std::move(*rest);
        const auto where = toFile(levels, 0);
        if (!where) return tl::unexpected(where.error());
        set.toFile = *where;
        if (auto status = readFrames(*points, levels, set); !status) return status;
        if (auto status = readAttributes(*properties, set); !status) return status;
        curves_.push_back(std::move(set));
        return {};
    }

    /// Counts, basis, wrap and what NURBS have beside.
    Status readForm(const std::vector<AlembicProperty>& properties, const AlembicProperty& counts,
                    CurveSet& set) {
        const auto numbers = archive_.integers(counts, 0);
        if (!numbers) return tl::unexpected(numbers.error());
        for (const std::int64_t count : *numbers) {
            if (count < 0 || count > INT32_MAX)
                return fail(fmt::format("{}: a curve of {} points", set.path, count), "expected a count");
            if (count > 0) set.counts.push_back(static_cast<std::uint32_t>(count));
        }
        std::vector<std::int64_t> type{1, 0, 0, 0};
        if (const AlembicProperty* const basis = findProperty(properties, "curveBasisAndType")) {
            const auto values = archive_.integers(*basis, 0);
            if (!values) return tl::unexpected(values.error());
            if (values->size() >= 3) type = *values;
        }
        return setBasis(properties, type[0], type[1] != 0, type[2], set);
    }

    Status setBasis(const std::vector<AlembicProperty>& properties, std::int64_t type, bool closed,
                    std::int64_t basis, CurveSet& set) {
        enum { kCubic, kLinear, kVariable };
        enum { kNoBasis, kBezier, kBSpline, kCatmullRom };
        set.wrap = closed ? CurveWrap::Periodic : CurveWrap::Open;
        if (type == kVariable) {
            set.basis = CurveBasis::Nurbs;
            return readNurbs(properties, set);
        }
        // Straight lines, and what Blender writes for curves that pass through all their points.
        if (type == kLinear || basis == kNoBasis) return {};
        if (basis == kBezier)
            set.basis = CurveBasis::Bezier;
        else if (basis == kBSpline)
            set.basis = CurveBasis::BSpline;
        else if (basis == kCatmullRom)
            set.basis = CurveBasis::CatmullRom;
        else
            return fail(fmt::format("{}: curves of basis {}", set.path, basis),
                        "expected Bézier, B-spline or Catmull-Rom");
        return {};
    }

    Status readNurbs(const std::vector<AlembicProperty>& properties, CurveSet& set) {
        if (const AlembicProperty* const orders = findProperty(properties, ".orders")) {
            const auto values = archive_.integers(*orders, 0);
            if (!values) return tl::unexpected(values.error());
            for (const std::int64_t order : *values)
                set.orders.push_back(static_cast<std::uint32_t>(order & 0xff));
        }
        if (const AlembicProperty* const knots = findProperty(properties, ".knots")) {
            auto values = archive_.doubles(*knots, 0);
            if (!values) return tl::unexpected(values.error());
            set.knots = std::move(*values);
        }
        for (const char* name : {"w", ".positionWeights"}) {
            const AlembicProperty* const weights = findProperty(properties, name);
            if (weights == nullptr || !set.weights.empty()) continue;
            auto values = archive_.floats(*weights, 0);
            if (!values) return tl::unexpected(values.error());
            set.weights = std::move(*values);
        }
        return {};
    }

    Status readFrames(const AlembicProperty& points, const std::vector<Level>& levels, CurveSet& set) {
        std::uint32_t samples = changes(points);
        bool moves = false;
        for (const Level& level : levels) {
            moves = moves || level.samples > 1;
            samples = std::max(samples, level.samples);
        }
        if (samples < 2) return {};
        if (!frames_) {
            reportFrames(samples);
            return {};
        }
        const AlembicTimes& times = archive_.times(points.timeSampling);
        const double seconds = times.at(1) - times.at(0);
        if (seconds > 0) strands_.framesPerSecond = static_cast<float>(1 / seconds);
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            auto frame = pointsAt(points, sample);
            if (!frame) return tl::unexpected(frame.error());
            set.frames.push_back(std::move(*frame));
            if (!moves) continue;
            const auto where = toFile(levels, sample);
            if (!where) return tl::unexpected(where.error());
            set.frameToFile.push_back(*where);
        }
        return {};
    }

    void reportFrames(std::uint32_t samples) {
        if (std::exchange(framesReported_, true)) return;
        strands_.warnings.push_back(fileNote(
            fmt::format("the hair is animated: {} time samples, of which the first was imported", samples),
            "time", "import with --record to keep all of them"));
    }

    Status readAttributes(const std::vector<AlembicProperty>& properties, CurveSet& set) {
        for (const char* name : {"width", "uv"}) {
            if (const AlembicProperty* const property = findProperty(properties, name)) {
                if (auto status = addAttribute(*property, set); !status) return status;
            }
        }
        for (const char* name : {".arbGeomParams", ".userProperties"}) {
            const AlembicProperty* const compound = findProperty(properties, name);
            if (compound == nullptr || compound->kind != AlembicProperty::Kind::Compound) continue;
            const auto inside = archive_.properties(*compound);
            if (!inside) return tl::unexpected(inside.error());
            const bool ofCurves = std::string_view(name) == ".arbGeomParams";
            for (const AlembicProperty& property : *inside) {
                // Properties of the object, such as Blender's resolution, are of no curve.
                if (!ofCurves && property.kind != AlembicProperty::Kind::Array) continue;
                if (auto status = addAttribute(property, set); !status) return status;
            }
        }
        return {};
    }

    /// A plain property, or the pair of values and indices into them.
    Status addAttribute(const AlembicProperty& property, CurveSet& set) {
        if (property.kind != AlembicProperty::Kind::Compound)
            return addValues(property, nullptr, property, set);
        const auto inside = archive_.properties(property);
        if (!inside) return tl::unexpected(inside.error());
        const AlembicProperty* const values = findProperty(*inside, ".vals");
        if (values == nullptr) return {};
        return addValues(*values, findProperty(*inside, ".indices"), property, set);
    }

    Status addValues(const AlembicProperty& values, const AlembicProperty* indices,
                     const AlembicProperty& named, CurveSet& set) {
        if (values.samples == 0) return {};
        if (values.pod == AlembicPod::String || values.pod == AlembicPod::WideString) {
            strands_.warnings.push_back(fileNote("string attributes of curves were left out", named.name));
            return {};
        }
        CurveAttribute attribute;
        attribute.name = named.name;
        attribute.scope = scopeOf(named.metadata);
        attribute.components = values.extent;
        // "arrayExtent=3" of scalars: three to each element.
        const std::string array = valueOf(named.metadata, "arrayExtent");
        if (array.size() == 1 && array[0] > '1' && array[0] <= '9')
            attribute.components *= static_cast<std::uint32_t>(array[0] - '0');
        const bool whole = values.pod < AlembicPod::Half;
        attribute.isFlag = values.pod <= AlembicPod::Uint8;
        if (whole) {
            auto read = archive_.integers(values, 0);
            if (!read) return tl::unexpected(read.error());
            attribute.whole = std::move(*read);
        } else {
            auto read = archive_.floats(values, 0);
            if (!read) return tl::unexpected(read.error());
            attribute.numbers = std::move(*read);
        }
        if (attribute.components > 4 ||
            (whole ? attribute.whole : std::vector<std::int64_t>()).size() + attribute.numbers.size() == 0)
            return {};
        if (indices != nullptr) {
            if (auto status = expand(attribute, *indices); !status) return status;
        }
        set.attributes.push_back(std::move(attribute));
        return {};
    }

    Status expand(CurveAttribute& attribute, const AlembicProperty& indices) const {
        const auto places = archive_.integers(indices, 0);
        if (!places) return tl::unexpected(places.error());
        const std::size_t count = attribute.count(), components = attribute.components;
        std::vector<float> numbers;
        std::vector<std::int64_t> whole;
        for (const std::int64_t place : *places) {
            if (place < 0 || static_cast<std::size_t>(place) >= count)
                return fail(fmt::format("{} has an index {}", attribute.name, place),
                            fmt::format("it has {} values", count));
            for (std::size_t c = 0; c < components; ++c) {
                const std::size_t at = static_cast<std::size_t>(place) * components + c;
                if (attribute.numbers.empty())
                    whole.push_back(attribute.whole[at]);
                else
                    numbers.push_back(attribute.numbers[at]);
            }
        }
        attribute.numbers = std::move(numbers);
        attribute.whole = std::move(whole);
        return {};
    }

    const AlembicArchive& archive_;
    const std::string& file_;
    bool frames_;
    bool framesReported_ = false;
    std::vector<CurveSet> curves_;
    RawStrands strands_;
};

bool isAlembic(std::span<const std::byte> bytes) {
    constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1a\n";
    const auto starts = [&](std::string_view text) {
        return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
    };
    return starts("Ogawa") || starts(kHdf5);
}

Result<RawStrands> readAlembic(const std::string& file, std::vector<std::byte>&& bytes,
                               const StrandImportOptions& options) {
    if (std::to_integer<int>(bytes[0]) == 0x89)
        return failIn(file, Byte{0}, "is an Alembic file in HDF5, from before version 1.5",
                      "expected Ogawa: export it again, or run abcconvert -toOgawa");
    const auto archive = AlembicArchive::open(file, bytes);
    if (!archive) return tl::unexpected(archive.error());
    Reader reader(*archive, file, options.frames);
    if (auto status = reader.readAll(); !status) return tl::unexpected(status.error());
    std::vector<std::byte>().swap(bytes);
    return reader.strands();
}

}  // namespace

StrandReader alembicReader() {
    return {{"Alembic .abc", {"abc"}}, Recognition::Signature, isAlembic, readAlembic};
}

}  // namespace hairloom
