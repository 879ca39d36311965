// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of Alembic files, in Ogawa's container: the schemas AbcGeom_Curve_v1 and _v2 below transforms of any
// kind, instances of them, too, where they are visible.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "importers/alembic_shown.h"
#include "importers/alembic_unreal.h"
#include "importers/curve_set.h"
#include "importers/file_format.h"
#include "importers/obj_text.h"
#include "importers/strand_parts.h"

namespace hairloom {
namespace {

constexpr const char* kGroupName = "groom_group_name";

/// Of all curves together, which instances make many from few, and of all frames.
constexpr std::uint64_t kMaxPoints = 200'000'000, kMaxFramePoints = 1'000'000'000;

CurveAttribute::Scope scopeOf(const AlembicMetadata& metadata) {
    using Scope = CurveAttribute::Scope;
    const std::string scope = valueOf(metadata, "geoScope");
    if (scope == "con") return Scope::Constant;
    if (scope == "uni") return Scope::Curve;
    if (scope == "var") return Scope::Knot;
    if (scope == "vtx" || scope == "fvr") return Scope::Point;
    return Scope::Unknown;
}

class Reader {
  public:
    Reader(const AlembicArchive& archive, const std::string& file, const StrandImportOptions& options)
        : archive_(archive), file_(file), options_(options) {}

    /// All that is needed of the archive.
    Status readAll() {
        const auto told = [&](const Error& error) { return tl::unexpected(inFile(error, file_)); };
        auto all = shownObjects(archive_, kAlembicCurves);
        if (!all) return told(all.error());
        found_ = std::move(all->objects);
        hidden_ = std::move(all->hidden);
        strands_.warnings = std::move(all->warnings);
        if (found_.empty()) return noCurves();
        if (auto status = findTimes(); !status) return told(status.error());
        for (const AlembicShownObject& found : found_) {
            if (auto status = readCurves(found); !status) return told(status.error());
        }
        if (hidden_.size() > 0) reportHidden();
        return {};
    }

    Result<RawStrands> strands() {
        narrowWholeNumbers(curves_, strands_.warnings);
        for (CurveSet& set : curves_) {
            const std::string path = set.path;
            if (auto status = appendCurves(file_, std::move(set), frameCount_, strands_); !status)
                return tl::unexpected(status.error());
            endPart(strands_, path, partNames_[path]);
        }
        adoptAttributes(strands_);
        strands_.format = "Alembic";
        return std::move(strands_);
    }

  private:
    Status noCurves() const {
        if (!hidden_.empty())
            return failIn(file_, {},
                          fmt::format("all its {} objects of curves are hidden, as {}", hidden_.size(),
                                      hidden_.front()),
                          "expected visible hair: show it where it was made, and export it again");
        return failIn(file_, {}, "has no curves", "expected hair as curves");
    }

    void reportHidden() {
        strands_.warnings.push_back(
            fileWarning(hidden_.size() == 1
                            ? "hair that is hidden was left out"
                            : fmt::format("{} objects of hair that are hidden were left out", hidden_.size()),
                        hidden_.front(), "show it where it was made, and export it again"));
    }

    static bool isText(const AlembicProperty& property) {
        return property.pod == AlembicPod::String && property.samples > 0;
    }

    /// The times of the record, whose first is that of the strands, too.
    Status findTimes() {
        std::vector<MovingProperty> moving;
        std::set<std::pair<std::uint32_t, std::uint32_t>> known;
        const auto add = [&](const std::string& path, const AlembicProperty* property) {
            if (property == nullptr || !property->moves()) return;
            if (!known.emplace(property->timeSampling, property->samples).second) return;
            moving.push_back({&archive_.times(property->timeSampling), property->samples, path});
        };
        for (const AlembicShownObject& found : found_) {
            add(found.path, findProperty(found.properties, "P"));
            for (const AlembicLevel& level : found.inherited.levels)
                add(level.path, hairloom::valuesOf(level));
        }
        if (moving.empty()) return {};
        const auto stated = parseNumber(valueOf(archive_.metadata(), "FramesPerTimeUnit"));
        const bool isRate = stated && *stated > 0 && *stated <= 1000;
        start_ = moving.front().times->at(0);
        for (const MovingProperty& property : moving) start_ = std::min(start_, property.times->at(0));
        std::uint32_t samples = 0;
        for (const MovingProperty& property : moving) samples = std::max(samples, property.samples);
        if (!options_.frames) {
            strands_.warnings.push_back(
                fileNote(fmt::format("the hair is animated: {} time samples, of which the first was imported",
                                     samples),
                         "time", "import with --record to keep all of them"));
            return {};
        }
        auto times = options_.everySample ? everySampleTime(moving)
                                          : recordTimes(moving, isRate ? *stated : 0,
                                                        static_cast<double>(options_.framesPerSecond));
        if (!times) return tl::unexpected(times.error());
        times_ = std::move(*times);
        frameCount_ = times_.seconds.size();
        strands_.framesPerSecond = static_cast<float>(times_.framesPerSecond);
        strands_.isResampled = times_.isResampled;
        if (!times_.words.empty()) strands_.warnings.push_back(fileNote(times_.words, "time"));
        return {};
    }

    /// The sample of a property that stands at the first time.
    std::uint32_t first(const AlembicProperty& property) const {
        return archive_.momentOf(property, start_).nearest();
    }

    Result<std::vector<float>> pointsAt(const AlembicProperty& property, double seconds) {
        const SampleMoment moment = archive_.momentOf(property, seconds);
        auto before = archive_.floats(property, moment.before);
        if (!before || moment.share == 0) return before;
        const auto after = archive_.floats(property, moment.after);
        if (!after) return tl::unexpected(after.error());
        if (after->size() != before->size())
            return fail(fmt::format("{} has {} numbers at one time and {} at the next", property.name,
                                    before->size(), after->size()),
                        "expected as many points at all times");
        const auto share = static_cast<float>(moment.share);
        for (std::size_t i = 0; i < before->size(); ++i) (*before)[i] += share * ((*after)[i] - (*before)[i]);
        return before;
    }

    Status readCurves(const AlembicShownObject& found) {
        const AlembicProperty* const points = findProperty(found.properties, "P");
        const AlembicProperty* const counts = findProperty(found.properties, "nVertices");
        if (points == nullptr || counts == nullptr)
            return fail(found.path + " has no points or no counts", "expected P and nVertices");
        if (points->samples == 0) return {};
        if (points->extent != 3) return fail(points->name + " has no vectors of three", "expected points");
        CurveSet set;
        set.path = found.path;
        if (auto status = readForm(found.properties, *counts, set); !status) return status;
        auto rest = pointsAt(*points, start_);
        if (!rest) return tl::unexpected(rest.error());
        set.points = std::move(*rest);
        points_ += set.points.size() / 3;
        if (points_ > kMaxPoints)
            return fail(fmt::format("its curves and their instances have more than {} points", kMaxPoints),
                        "expected fewer");
        if (points_ * frameCount_ > kMaxFramePoints)
            return fail(fmt::format("{} frames of {} points are too many to keep", frameCount_, points_),
                        "ask for fewer frames a second (--fps)");
        const auto where = toFileAt(archive_, found.inherited.levels, start_);
        if (!where) return tl::unexpected(where.error());
        set.toFile = *where;
        if (auto status = readFrames(*points, found.inherited.levels, set); !status) return status;
        if (auto status = readAttributes(found, set); !status) return status;
        curves_.push_back(std::move(set));
        return {};
    }

    /// Counts, basis, wrap and what NURBS have beside.
    Status readForm(const std::vector<AlembicProperty>& properties, const AlembicProperty& counts,
                    CurveSet& set) {
        const auto numbers = archive_.integers(counts, first(counts));
        if (!numbers) return tl::unexpected(numbers.error());
        for (const std::int64_t count : *numbers) {
            if (count < 0 || count > INT32_MAX)
                return fail(fmt::format("{}: a curve of {} points", set.path, count), "expected a count");
            if (count > 0) set.counts.push_back(static_cast<std::uint32_t>(count));
        }
        std::vector<std::int64_t> type{1, 0, 0, 0};
        if (const AlembicProperty* const basis = findProperty(properties, "curveBasisAndType")) {
            const auto values = archive_.integers(*basis, first(*basis));
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
            const auto values = archive_.integers(*orders, first(*orders));
            if (!values) return tl::unexpected(values.error());
            for (const std::int64_t order : *values)
                set.orders.push_back(static_cast<std::uint32_t>(order & 0xff));
        }
        if (const AlembicProperty* const knots = findProperty(properties, ".knots")) {
            auto values = archive_.doubles(*knots, first(*knots));
            if (!values) return tl::unexpected(values.error());
            set.knots = std::move(*values);
        }
        for (const char* name : {"w", ".positionWeights"}) {
            const AlembicProperty* const weights = findProperty(properties, name);
            if (weights == nullptr || !set.weights.empty()) continue;
            auto values = archive_.floats(*weights, first(*weights));
            if (!values) return tl::unexpected(values.error());
            set.weights = std::move(*values);
        }
        return {};
    }

    Status readFrames(const AlembicProperty& points, const std::vector<AlembicLevel>& levels, CurveSet& set) {
        const bool isCarried = std::ranges::any_of(levels, [](const AlembicLevel& level) {
            const AlembicProperty* const values = hairloom::valuesOf(level);
            return values != nullptr && values->moves();
        });
        for (const double seconds : times_.seconds) {
            if (points.moves()) {
                auto frame = pointsAt(points, seconds);
                if (!frame) return tl::unexpected(frame.error());
                set.frames.push_back(std::move(*frame));
            }
            if (!isCarried) continue;
            const auto where = toFileAt(archive_, levels, seconds);
            if (!where) return tl::unexpected(where.error());
            set.frameToFile.push_back(*where);
        }
        return {};
    }

    Status readAttributes(const AlembicShownObject& found, CurveSet& set) {
        for (const char* name : {"width", "uv"}) {
            if (const AlembicProperty* const property = findProperty(found.properties, name)) {
                if (auto status = addAttribute(*property, set); !status) return status;
            }
        }
        for (const char* name : {".arbGeomParams", ".userProperties"}) {
            const AlembicProperty* const compound = findProperty(found.properties, name);
            if (compound == nullptr || compound->kind != AlembicProperty::Kind::Compound) continue;
            const auto inside = archive_.properties(*compound);
            if (!inside) return tl::unexpected(inside.error());
            const bool ofCurves = std::string_view(name) == ".arbGeomParams";
            for (const AlembicProperty& property : *inside) {
                if (property.name.ends_with("_AbcGeomScope")) continue;
                // Properties of the object, such as Blender's resolution, are of no curve.
                const bool isOfObject = !ofCurves && property.kind != AlembicProperty::Kind::Array;
                if (isOfObject && !isOfHair(property)) continue;
                if (property.name == kGroupName) {
                    if (auto status = addGroupNames(property, found.path, set); !status) return status;
                    continue;
                }
                if (auto status = addAttribute(property, set); !status) return status;
            }
        }
        for (const auto& [name, property] : found.inherited.ofObjects) {
            if (name == kGroupName && isText(property)) {
                auto text = archive_.text(property, first(property));
                if (!text) return tl::unexpected(text.error());
                partNames_.emplace(found.path, *text);
                continue;
            }
            const bool isKnown =
                std::ranges::find(set.attributes, name, &CurveAttribute::name) != set.attributes.end();
            if (isKnown) continue;
            if (auto status = addAttribute(property, set); !status) return status;
        }
        return {};
    }

    /// A text is the name of all curves of an object; texts are of a strand each, as they stand or by
    /// indices.
    Status addGroupNames(const AlembicProperty& property, const std::string& path, CurveSet& set) {
        std::vector<AlembicProperty> inside;
        if (property.kind == AlembicProperty::Kind::Compound) {
            auto read = archive_.properties(property);
            if (!read) return tl::unexpected(read.error());
            inside = std::move(*read);
        }
        const AlembicProperty* const values = inside.empty() ? &property : findProperty(inside, ".vals");
        if (values == nullptr || !isText(*values)) return {};
        const auto texts = archive_.texts(*values, first(*values));
        if (!texts) return tl::unexpected(texts.error());
        if (texts->empty()) return {};
        if (texts->size() == 1) {
            partNames_.emplace(path, texts->front());
            return {};
        }
        CurveAttribute attribute;
        attribute.name = kGroupName;
        attribute.scope = scopeOf(property.metadata);
        std::map<std::string, std::int64_t> known;
        for (const std::string& text : *texts) {
            const auto [place, isNew] =
                known.emplace(text, static_cast<std::int64_t>(strands_.groupTexts.size()));
            if (isNew) {
                const auto before = std::ranges::find(strands_.groupTexts, text);
                place->second = before - strands_.groupTexts.begin();
                if (before == strands_.groupTexts.end()) strands_.groupTexts.push_back(text);
            }
            attribute.whole.push_back(place->second);
        }
        if (const AlembicProperty* const indices = findProperty(inside, ".indices")) {
            if (auto status = expand(attribute, *indices); !status) return status;
        }
        set.attributes.push_back(std::move(attribute));
        return {};
    }

    /// A plain property, or the pair of values and indices into them.
    Status addAttribute(const AlembicProperty& property, CurveSet& set) {
        if (isOfUnrealFile(property.name)) return {};
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
            auto read = archive_.integers(values, first(values));
            if (!read) return tl::unexpected(read.error());
            attribute.whole = std::move(*read);
        } else {
            auto read = archive_.floats(values, first(values));
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
        const auto places = archive_.integers(indices, first(indices));
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
    const StrandImportOptions& options_;
    std::vector<AlembicShownObject> found_;
    std::vector<std::string> hidden_;  ///< paths
    std::uint64_t points_ = 0;
    double start_ = 0;  ///< seconds
    RecordTimes times_;
    std::size_t frameCount_ = 0;
    std::vector<CurveSet> curves_;
    std::map<std::string, std::string> partNames_;  ///< that objects give themselves, by path
    RawStrands strands_;
};

Result<RawStrands> readAlembic(const std::string& file, std::vector<std::byte>&& bytes,
                               const StrandImportOptions& options) {
    if (std::to_integer<int>(bytes[0]) == 0x89)
        return failIn(file, Byte{0}, "is an Alembic file in HDF5, from before version 1.5",
                      "expected Ogawa: export it again, or run abcconvert -toOgawa");
    const auto archive = AlembicArchive::open(file, bytes);
    if (!archive) return tl::unexpected(archive.error());
    Reader reader(*archive, file, options);
    if (auto status = reader.readAll(); !status) return tl::unexpected(status.error());
    const bool isUnreal = hasUnrealSchema(*archive);
    std::vector<std::byte>().swap(bytes);
    auto strands = reader.strands();
    if (strands && isUnreal) assumeUnrealUnit(options, *strands);
    return strands;
}

}  // namespace

StrandReader alembicReader() {
    return {{"Alembic .abc", {"abc"}}, Recognition::Signature, startsLikeAlembic, readAlembic};
}

}  // namespace hairloom
