// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of USD files: BasisCurves, NurbsCurves and HermiteCurves of the stage, with its unit and axis.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "importers/authored_settings.h"
#include "importers/curve_set.h"
#include "importers/file_format.h"
#include "importers/hermite_curves.h"
#include "importers/sample_times.h"
#include "importers/scene_parts.h"
#include "importers/strand_parts.h"
#include "importers/usd_values.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 27u;  ///< of all curves, copies and frames counted

/// As valueAt(), of an attribute that is read once where `isLast`: what stays in time is taken from it.
UsdValue takeAt(UsdAttribute& attribute, double time, bool isLast) {
    return attribute.samples.empty() && isLast ? std::move(attribute.value) : valueAt(attribute, time);
}

CurveAttribute::Scope scopeOf(std::string_view interpolation) {
    using Scope = CurveAttribute::Scope;
    if (interpolation == "constant") return Scope::Constant;
    if (interpolation == "uniform") return Scope::Curve;
    if (interpolation == "varying") return Scope::Knot;
    if (interpolation == "vertex") return Scope::Point;
    return Scope::Unknown;
}

bool isWhole(std::string_view type) {
    return type.starts_with("int") || type.starts_with("uint") || type.starts_with("bool") ||
           type.starts_with("uchar");
}

/// Three numbers each.
std::vector<float> pointsOf(UsdValue value) {
    return value.components == 3 ? std::move(value.numbers).floats() : std::vector<float>();
}

std::string tokenOf(const UsdPrim& prim, std::string_view name, const char* otherwise) {
    const UsdAttribute* const attribute = prim.find(name);
    return attribute == nullptr || attribute->value.texts.empty() ? otherwise
                                                                  : attribute->value.texts.front();
}

class Reader {
  public:
    Reader(UsdStage stage, const std::string& file, const StrandImportOptions& options)
        : stage_(std::move(stage)), file_(file), options_(options) {}

    Result<RawStrands> run() {
        readStage();
        auto shown = shownPrims(stage_.root, UsdShape::Curves, firstTime(stage_.root));
        if (!shown) return tl::unexpected(inFile(shown.error(), file_));
        std::vector<std::string> reasons = stage_.notFollowed;
        reasons.insert(reasons.end(), shown->leftOut.begin(), shown->leftOut.end());
        if (shown->prims.empty())
            return failIn(file_, {},
                          reasons.empty() ? "has no curves" : "has no curves that show: " + firstOf(reasons),
                          "expected hair as BasisCurves, NurbsCurves or HermiteCurves");
        if (!shown->leftOut.empty())
            strands_.warnings.push_back(
                fileNote(firstOf(shown->leftOut), "stage", "these curves were left out"));
        if (auto status = planTimes(shown->prims); !status)
            return tl::unexpected(inFile(status.error(), file_));
        for (UsdShownPrim& curves : shown->prims) {
            if (auto status = readCurves(curves); !status)
                return tl::unexpected(inFile(status.error(), file_));
        }
        takeUsdSettings(stage_.root, file_, strands_);
        auto made = append();
        // Values that lie in files which are not there leave curves without points.
        if (made && made->offsets.size() < 2 && made->dropped.empty() && !reasons.empty())
            return failIn(file_, {}, "has no curves that show: " + firstOf(reasons),
                          "expected hair as BasisCurves, NurbsCurves or HermiteCurves");
        return made;
    }

  private:
    /// The first time of all, for what is shown; 0 where nothing changes.
    static double firstTime(const UsdPrim& prim) {
        double first = std::numeric_limits<double>::infinity();
        addFirst(prim, first);
        return std::isfinite(first) ? first : 0;
    }
    static void addFirst(const UsdPrim& prim, double& first) {
        for (const UsdAttribute& attribute : prim.attributes) {
            if (!attribute.samples.empty()) first = std::min(first, attribute.samples.begin()->first);
        }
        for (const UsdPrim& child : prim.children) addFirst(child, first);
    }

    void readStage() {
        const double unit = usdNumber(stage_.metadata, "metersPerUnit", 0);
        if (unit > 0 && std::isfinite(unit)) {
            strands_.statedMetresPerUnit = static_cast<float>(unit);
        } else {
            constexpr float kFallback = 0.01f;
            strands_.assumedMetresPerUnit = kFallback;
            if (!options_.isUnitAsked)
                strands_.warnings.push_back(
                    fileNote("the stage states no metersPerUnit; USD takes centimetres then", "unit",
                             "import with --unit where it is another"));
        }
        const auto up = stage_.metadata.find("upAxis");
        if (up != stage_.metadata.end() && !up->second.texts.empty())
            strands_.statedUp = up->second.texts.front() == "Z" ? UpAxis::Z : UpAxis::Y;
        const double rate = usdNumber(stage_.metadata, "timeCodesPerSecond",
                                      usdNumber(stage_.metadata, "framesPerSecond", 24));
        if (rate > 0 && std::isfinite(rate)) codesPerSecond_ = rate;
        for (const std::string& repeated : stage_.repeated)
            strands_.warnings.push_back({Severity::Error, "appears twice, and USD's own library refuses it",
                                         repeated, "write the file again with each name once"});
        if (!stage_.chosen.empty())
            strands_.warnings.push_back(
                fileNote(firstOf(stage_.chosen), "variants", "other variants were left out"));
        if (!stage_.notFollowed.empty())
            strands_.warnings.push_back(
                fileWarning(firstOf(stage_.notFollowed), "composition",
                            "put what is missing beside the file, or flatten the stage (usdcat --flatten)"));
    }

    /// When the frames are, over all curves: each property is looked up at these times.
    Status planTimes(const std::vector<UsdShownPrim>& curves) {
        std::set<double> times;
        for (const UsdShownPrim& one : curves) {
            for (const char* name : {"points", "tangents"}) {
                const UsdAttribute* const moving = one.prim->find(name);
                if (moving == nullptr) continue;
                for (const auto& [time, value] : moving->samples) times.insert(time);
            }
            addTimes(one.levels, times);
        }
        // What holds until values jump is no frame of its own.
        constexpr double kJump = 1e-6;
        for (auto time = times.begin(); time != times.end();) {
            const auto next = std::next(time);
            time = next != times.end() && *next - *time < kJump ? times.erase(time) : next;
        }
        times_.assign(times.begin(), times.end());
        if (!std::ranges::all_of(times_, [](double time) { return std::isfinite(time); }))
            return fail("a time of a sample is not finite", "expected time codes");
        if (times_.empty()) times_.push_back(0);
        if (times_.size() < 2) return {};
        if (!options_.frames) {
            strands_.warnings.insert(
                strands_.warnings.begin(),
                fileNote(fmt::format("the hair is animated: {} time samples, of which the first was imported",
                                     times_.size()),
                         "time", "import with --record to keep all of them"));
            return {};
        }
        // All times of the stage, none of which repeats.
        SampleTimes samples{std::numeric_limits<double>::infinity(), {}};
        for (const double time : times_) samples.times.push_back(time / codesPerSecond_);
        const MovingProperty moving{&samples, static_cast<std::uint32_t>(times_.size()), "the stage"};
        const auto planned =
            options_.everySample
                ? everySampleTime(std::span(&moving, 1))
                : recordTimes(std::span(&moving, 1), usdNumber(stage_.metadata, "framesPerSecond", 0),
                              static_cast<double>(options_.framesPerSecond));
        if (!planned) return tl::unexpected(planned.error());
        if (!planned->words.empty()) strands_.warnings.push_back(fileNote(planned->words, "time"));
        strands_.framesPerSecond = static_cast<float>(planned->framesPerSecond);
        strands_.isResampled = planned->isResampled;
        for (const double second : planned->seconds) frames_.push_back(second * codesPerSecond_);
        return {};
    }

    Status count(std::size_t points) {
        points_ += points;
        if (points_ <= kMaxPoints) return {};
        return fail("curves, their instances and frames have more points than are read",
                    fmt::format("expected at most {}", kMaxPoints));
    }

    Status readCurves(UsdShownPrim& curves) {
        UsdPrim& prim = *curves.prim;
        UsdAttribute* const points = prim.find("points");
        const UsdAttribute* const counts = prim.find("curveVertexCounts");
        if (points == nullptr || counts == nullptr) return {};
        const double first = times_.front();
        CurveSet set;
        set.path = curves.path;
        const UsdValue numbers = valueAt(*counts, first);
        for (std::size_t i = 0; i < numbers.numbers.size(); ++i) {
            const std::int64_t number = numbers.numbers.whole(i);
            if (number < 0 || number > INT32_MAX)
                return fail(fmt::format("{}: a curve of {} points", set.path, number), "expected a count");
            if (number > 0) set.counts.push_back(static_cast<std::uint32_t>(number));
        }
        if (set.counts.empty()) return {};
        const auto where = toFile(curves.levels, first);
        if (!where) return tl::unexpected(where.error());
        set.toFile = *where;
        readForm(prim, set);
        if (auto status = readFrames(curves, *points, set); !status) return status;
        set.points = pointsOf(takeAt(*points, first, curves.isLast));
        if (set.points.empty()) return {};
        if (auto status = count(set.points.size() / 3); !status) return status;
        for (UsdAttribute& attribute : prim.attributes) addAttribute(curves, attribute, first, set);
        addGroup(curves, set);
        if (curves.isGuide) addGuide(set);
        if (prim.type == "HermiteCurves") bendHermite(curves, set);
        parts_.push_back(prim.displayName);
        curves_.push_back(std::move(set));
        return {};
    }

    static void readForm(const UsdPrim& prim, CurveSet& set) {
        if (prim.type == "HermiteCurves") return;
        if (prim.type == "NurbsCurves") {
            set.basis = CurveBasis::Nurbs;
            if (const UsdAttribute* const orders = prim.find("order")) {
                for (const double order : orders->value.numbers.doubles())
                    set.orders.push_back(order >= 0 && order < 1000 ? static_cast<std::uint32_t>(order) : 0);
            }
            if (const UsdAttribute* const knots = prim.find("knots"))
                set.knots = knots->value.numbers.doubles();
            if (const UsdAttribute* const weights = prim.find("pointWeights"))
                set.weights = UsdNumbers(weights->value.numbers).floats();
            return;
        }
        const std::string wrap = tokenOf(prim, "wrap", "nonperiodic");
        set.wrap = wrap == "periodic" ? CurveWrap::Periodic
                   : wrap == "pinned" ? CurveWrap::Pinned
                                      : CurveWrap::Open;
        if (tokenOf(prim, "type", "cubic") == "linear") return;
        const std::string basis = tokenOf(prim, "basis", "bezier");
        set.basis = basis == "bspline"      ? CurveBasis::BSpline
                    : basis == "catmullRom" ? CurveBasis::CatmullRom
                                            : CurveBasis::Bezier;
    }

    Status readFrames(const UsdShownPrim& curves, const UsdAttribute& points, CurveSet& set) {
        if (frames_.empty()) return {};
        std::set<double> moving;
        addTimes(curves.levels, moving);
        if (points.samples.size() > 1) {
            for (const double time : frames_) {
                set.frames.push_back(pointsOf(valueAt(points, time)));
                if (auto status = count(set.frames.back().size() / 3); !status) return status;
            }
            const auto isOther = [&](const auto& frame) { return frame.size() != set.frames.front().size(); };
            if (std::ranges::any_of(set.frames, isOther)) {
                strands_.warnings.push_back(fileWarning("the number of points changes in time", set.path,
                                                        "these curves stay as they are at first"));
                set.frames.clear();
            }
        }
        if (moving.size() < 2) return {};
        for (const double time : frames_) {
            const auto where = toFile(curves.levels, time);
            if (!where) return tl::unexpected(where.error());
            set.frameToFile.push_back(*where);
        }
        return {};
    }

    /// Hermite curves are Bézier curves; what points have is of these' knots then.
    void bendHermite(UsdShownPrim& curves, CurveSet& set) {
        UsdAttribute* const tangents = curves.prim->find("tangents");
        std::uint64_t points = 0;
        for (const std::uint32_t size : set.counts) points += size;
        const auto bend = [&](std::vector<float>& numbers, double time) {
            const std::vector<float> along =
                tangents == nullptr ? std::vector<float>() : pointsOf(valueAt(*tangents, time));
            const bool fits = along.size() == numbers.size() && numbers.size() == 3 * points;
            if (fits) numbers = bezierOfHermite(set.counts, numbers, along);
            return fits;
        };
        if (!bend(set.points, times_.front())) {
            strands_.warnings.push_back(fileWarning("Hermite curves have not one tangent for each point",
                                                    set.path, "lines through their points were taken"));
            return;
        }
        for (std::size_t f = 0; f < set.frames.size(); ++f) {
            if (bend(set.frames[f], frames_[f])) continue;
            set.frames.clear();
            break;
        }
        for (std::uint32_t& size : set.counts) size = 3 * size - 2;
        set.basis = CurveBasis::Bezier;
        for (CurveAttribute& attribute : set.attributes) {
            if (attribute.count() == points) attribute.scope = CurveAttribute::Scope::Knot;
        }
    }

    void addAttribute(const UsdShownPrim& curves, UsdAttribute& attribute, double time, CurveSet& set) {
        constexpr std::string_view kPrimvar = "primvars:", kIndices = ":indices", kWidths = "primvars:widths";
        const UsdPrim& prim = *curves.prim;
        const UsdAttribute* const primvar = prim.find(kWidths);
        const bool isPrimvar = primvar != nullptr && primvar->hasValue();
        // The primvar goes before the attribute, as the schema of curves has it.
        const bool isWidth = attribute.name == (isPrimvar ? kWidths : "widths");
        if (!isWidth && !attribute.name.starts_with(kPrimvar)) return;
        if (attribute.name.ends_with(kIndices) || attribute.type == "rel") return;
        const UsdAttribute* const indices = prim.find(attribute.name + std::string(kIndices));
        UsdValue value = takeAt(attribute, time, curves.isLast);
        CurveAttribute added;
        added.name = isWidth ? "width" : attribute.name.substr(kPrimvar.size());
        if (!isWidth && isGivenTo(added.name, attribute.displayName, isLegalInUsd))
            added.name = attribute.displayName;
        added.scope = scopeOf(attribute.interpolation);
        if (value.numbers.empty()) return addTexts(value, indices, time, std::move(added), set);
        // The colour that a viewer draws a whole object in is none of the hair's.
        if (added.name == "displayColor" && value.numbers.size() == 3) return;
        added.components = value.components;
        if (attribute.elementSize > 1 && attribute.elementSize <= 4)
            added.components *= static_cast<std::uint32_t>(attribute.elementSize);
        if (added.components > 4) {
            strands_.warnings.push_back(fileNote(
                fmt::format("has {} numbers a value; it was left out", added.components), added.name));
            return;
        }
        UsdNumbers numbers = std::move(value.numbers);
        if (indices != nullptr) numbers = indexed(numbers, added.components, valueAt(*indices, time).numbers);
        if (isWhole(attribute.type)) {
            added.isFlag = attribute.type.starts_with("bool") || attribute.type.starts_with("uchar");
            for (std::size_t i = 0; i < numbers.size(); ++i) added.whole.push_back(numbers.whole(i));
        } else {
            added.numbers = std::move(numbers).floats();
        }
        set.attributes.push_back(std::move(added));
    }

    /// Values by their places; one that there is not is 0.
    static UsdNumbers indexed(const UsdNumbers& values, std::size_t components, const UsdNumbers& places) {
        UsdNumbers found;
        found.keep(values.kind());
        for (std::size_t i = 0; i < places.size(); ++i) {
            const std::int64_t place = places.whole(i);
            const bool is = place >= 0 && static_cast<std::size_t>(place) < values.size() / components;
            for (std::size_t c = 0; c < components; ++c) {
                const std::size_t at = is ? static_cast<std::size_t>(place) * components + c : 0;
                if (values.kind() == UsdNumbers::Kind::Whole)
                    found.pushWhole(is ? values.whole(at) : 0);
                else
                    found.push_back(is ? values[at] : 0);
            }
        }
        return found;
    }

    /// Of texts, the names of groups alone have a use.
    void addTexts(const UsdValue& value, const UsdAttribute* indices, double time, CurveAttribute added,
                  CurveSet& set) {
        if (value.texts.empty()) return;
        if (added.name != "groom_group_name") {
            strands_.warnings.push_back(fileNote("string attributes of curves were left out", added.name));
            return;
        }
        if (indices != nullptr) {
            const UsdNumbers places = valueAt(*indices, time).numbers;
            for (std::size_t i = 0; i < places.size(); ++i) {
                const auto place = static_cast<std::size_t>(places.whole(i));
                added.whole.push_back(place < value.texts.size() ? textIndex(value.texts[place]) : 0);
            }
        } else {
            for (const std::string& text : value.texts) added.whole.push_back(textIndex(text));
        }
        set.attributes.push_back(std::move(added));
    }

    std::int64_t textIndex(const std::string& text) {
        auto found = std::ranges::find(strands_.groupTexts, text);
        if (found == strands_.groupTexts.end()) found = strands_.groupTexts.insert(found, text);
        return found - strands_.groupTexts.begin();
    }

    /// Number and name of a group that an object states for all its curves: as a primvar that they inherit,
    /// or as what Blender makes of a property of an object.
    void addGroup(const UsdShownPrim& curves, CurveSet& set) {
        for (const char* name : {"groom_group_id", "groom_group_name"}) {
            if (std::ranges::find(set.attributes, name, &CurveAttribute::name) != set.attributes.end())
                continue;
            const UsdAttribute* const found = ofLevels(curves, name);
            if (found == nullptr) continue;
            const UsdValue value = valueAt(*found, times_.front());
            CurveAttribute added;
            added.name = name;
            added.scope = CurveAttribute::Scope::Constant;
            if (!value.texts.empty() && added.name == "groom_group_name")
                added.whole.push_back(textIndex(value.texts.front()));
            else if (!value.numbers.empty() && added.name == "groom_group_id")
                added.whole.push_back(value.numbers.whole(0));
            if (!added.whole.empty()) set.attributes.push_back(std::move(added));
        }
    }

    static const UsdAttribute* ofLevels(const UsdShownPrim& curves, std::string_view name) {
        for (auto level = curves.levels.rbegin(); level != curves.levels.rend(); ++level) {
            for (const char* prefix : {"primvars:", "userProperties:", ""}) {
                const UsdAttribute* const found = level->prim->find(prefix + std::string(name));
                if (found != nullptr && found->hasValue()) return found;
            }
        }
        return nullptr;
    }

    static void addGuide(CurveSet& set) {
        constexpr const char* kGuide = "groom_guide";
        if (std::ranges::find(set.attributes, kGuide, &CurveAttribute::name) != set.attributes.end()) return;
        CurveAttribute guide;
        guide.name = kGuide;
        guide.scope = CurveAttribute::Scope::Constant;
        guide.whole = {1};
        guide.isFlag = true;
        set.attributes.push_back(std::move(guide));
    }

    Result<RawStrands> append() {
        narrowWholeNumbers(curves_, strands_.warnings);
        std::size_t frames = 0;
        for (const CurveSet& set : curves_) {
            if (!set.frames.empty() || !set.frameToFile.empty()) frames = frames_.size();
        }
        std::vector<std::string> broken;
        for (std::size_t i = 0; i < curves_.size(); ++i) {
            const std::string path = curves_[i].path;
            if (auto status = appendCurves(file_, std::move(curves_[i]), frames, strands_); !status) {
                // One set of several that contradicts itself leaves the others to be had.
                strands_.warnings.push_back(
                    {Severity::Error, status.error().problem, path, status.error().expected});
                broken.push_back(fmt::format("{}; {}", status.error().problem, status.error().expected));
            }
            endPart(strands_, path, parts_[i]);
        }
        if (strands_.offsets.size() < 2 && !broken.empty())
            return failIn(file_, {}, "has no curves that can be read: " + firstOf(broken),
                          "expected counts that add up to the points");
        adoptAttributes(strands_);
        strands_.format = "USD";
        return std::move(strands_);
    }

    UsdStage stage_;
    const std::string& file_;
    const StrandImportOptions& options_;
    double codesPerSecond_ = 24;
    std::vector<double> times_, frames_;  ///< time codes: of all samples, and of the record
    std::uint64_t points_ = 0;
    std::vector<CurveSet> curves_;
    std::vector<std::string> parts_;  ///< what people call each of them
    RawStrands strands_;
};

Result<RawStrands> readUsd(const std::string& file, std::vector<std::byte>&& bytes,
                           const StrandImportOptions& options) {
    auto stage = openUsdStage(file, std::move(bytes), options.folder);
    std::vector<std::byte>().swap(bytes);
    if (!stage) return tl::unexpected(stage.error());
    return Reader(std::move(*stage), file, options).run();
}

}  // namespace

StrandReader usdReader() {
    return {{"USD .usda, .usdc or .usdz", {"usda", "usdc", "usd", "usdz"}},
            Recognition::Signature,
            startsLikeUsd,
            readUsd};
}

}  // namespace hairloom
