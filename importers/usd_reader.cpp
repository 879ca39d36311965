// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of USD files: BasisCurves and NurbsCurves below transforms, with the unit and axis of their stage.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include "importers/curve_set.h"
#include "importers/usd_stage.h"

namespace hairloom {
namespace {

/// The value at a time, or at the first one that there is: held between samples of numbers that do not match.
UsdValue valueAt(const UsdAttribute& attribute, double time) {
    if (attribute.samples.empty()) return attribute.value;
    const auto after = attribute.samples.lower_bound(time);
    if (after == attribute.samples.begin()) return after->second;
    if (after == attribute.samples.end()) return std::prev(after)->second;
    const auto before = std::prev(after);
    UsdValue value = before->second;
    if (value.numbers.size() != after->second.numbers.size()) return value;
    const double t = (time - before->first) / (after->first - before->first);
    for (std::size_t i = 0; i < value.numbers.size(); ++i)
        value.numbers.set(i, (1 - t) * value.numbers[i] + t * after->second.numbers[i]);
    return value;
}

/// As well, of an attribute that is read once: what stays in time is taken from it.
UsdValue takeAt(UsdAttribute& attribute, double time) {
    return attribute.samples.empty() ? std::move(attribute.value) : valueAt(attribute, time);
}

/// A rotation about axes in turn, the first letter first: "XYZ".
Eigen::Matrix3d eulerRotation(std::string_view axes, const std::vector<double>& degrees) {
    Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
    for (const char axis : axes) {
        const int index = axis - 'X';
        const double angle = degrees[static_cast<std::size_t>(index)] * M_PI / 180;
        result = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(index)).toRotationMatrix() * result;
    }
    return result;
}

/// Numbers that an operation of the name takes; 0 for one that is not known.
std::size_t numbersOf(std::string_view kind) {
    if (kind == "transform") return 16;
    if (kind == "orient") return 4;
    if (kind == "rotateX" || kind == "rotateY" || kind == "rotateZ") return 1;
    if (kind == "translate" || kind == "scale") return 3;
    constexpr std::array<std::string_view, 6> kOrders{"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    const bool euler =
        kind.starts_with("rotate") && std::ranges::find(kOrders, kind.substr(6)) != kOrders.end();
    return euler ? 3 : 0;
}

Eigen::Affine3d operation(std::string_view kind, const std::vector<double>& v) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (kind == "transform") {
        // Points are rows there: the matrix is the transpose of ours.
        result.matrix() = Eigen::Map<const Eigen::Matrix4d>(v.data());
    } else if (kind == "translate") {
        result.translate(Eigen::Vector3d(v[0], v[1], v[2]));
    } else if (kind == "scale") {
        result.scale(Eigen::Vector3d(v[0], v[1], v[2]));
    } else if (kind == "orient") {
        result.rotate(Eigen::Quaterniond(v[0], v[1], v[2], v[3]).normalized());
    } else if (v.size() == 1) {
        result.rotate(Eigen::AngleAxisd(v[0] * M_PI / 180, Eigen::Vector3d::Unit(kind.back() - 'X')));
    } else {
        result.rotate(eulerRotation(kind.substr(6), v));
    }
    return result;
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

class Reader {
  public:
    Reader(UsdStage stage, const std::string& file, bool frames)
        : stage_(std::move(stage)), file_(file), frames_(frames) {}

    Result<RawStrands> run() {
        readStage();
        if (auto status = visit(stage_.root, "", {}); !status)
            return tl::unexpected(inFile(status.error(), file_));
        if (curves_.empty()) return failIn(file_, {}, "has no curves", "expected hair as BasisCurves");
        std::size_t frames = 0;
        for (const CurveSet& set : curves_) frames = std::max(frames, set.frames.size());
        for (CurveSet& set : curves_) {
            const std::string path = set.path;
            if (auto status = appendCurves(file_, std::move(set), frames, strands_); !status) {
                // One set of several that contradicts itself leaves the others to be had.
                strands_.warnings.push_back(
                    fileWarning(status.error().problem, path, status.error().expected));
            }
        }
        adoptAttributes(strands_);
        strands_.format = "USD";
        return std::move(strands_);
    }

  private:
    using Above = std::vector<const UsdPrim*>;

    double number(std::string_view name, double otherwise) const {
        const auto found = stage_.metadata.find(name);
        return found == stage_.metadata.end() || found->second.numbers.empty()
                   ? otherwise
                   : found->second.numbers.front();
    }

    void readStage() {
        const double unit = number("metersPerUnit", 0);
        if (unit > 0 && std::isfinite(unit)) strands_.statedMetresPerUnit = static_cast<float>(unit);
        const auto up = stage_.metadata.find("upAxis");
        if (up != stage_.metadata.end() && !up->second.texts.empty())
            strands_.statedUp = up->second.texts.front() == "Z" ? UpAxis::Z : UpAxis::Y;
        const double rate = number("timeCodesPerSecond", number("framesPerSecond", 24));
        strands_.framesPerSecond = rate > 0 && std::isfinite(rate) ? static_cast<float>(rate) : 24;
        if (stage_.notFollowed.empty()) return;
        strands_.warnings.push_back(
            fileWarning(fmt::format("{} and {} more were not loaded", stage_.notFollowed.front(),
                                    stage_.notFollowed.size() - 1),
                        "composition", "flatten the stage (usdcat --flatten) to include everything"));
    }

    Status visit(UsdPrim& prim, const std::string& path, const Above& above) {
        Above levels = above;
        levels.push_back(&prim);
        if (!prim.isOver && (prim.type == "BasisCurves" || prim.type == "NurbsCurves")) {
            if (auto status = readCurves(prim, path, levels); !status) return status;
        }
        for (UsdPrim& child : prim.children) {
            if (auto status = visit(child, path + "/" + child.name, levels); !status) return status;
        }
        return {};
    }

    Result<Eigen::Affine3d> toFile(const Above& levels, double time) const {
        Eigen::Affine3d result = Eigen::Affine3d::Identity();
        for (const UsdPrim* prim : levels) {
            const UsdAttribute* const order = prim->find("xformOpOrder");
            if (order == nullptr) continue;
            for (const std::string& name : order->value.texts) {
                if (name == "!resetXformStack!") {
                    result = Eigen::Affine3d::Identity();
                    continue;
                }
                const auto one = transformOf(*prim, name, time);
                if (!one) return one;
                result = result * *one;
            }
        }
        if (!result.matrix().allFinite()) return fail("a transform is not finite", "expected numbers");
        return result;
    }

    Result<Eigen::Affine3d> transformOf(const UsdPrim& prim, std::string_view name, double time) const {
        constexpr std::string_view kInvert = "!invert!", kPrefix = "xformOp:";
        const bool inverse = name.starts_with(kInvert);
        if (inverse) name.remove_prefix(kInvert.size());
        const UsdAttribute* const attribute = prim.find(name);
        if (attribute == nullptr || !name.starts_with(kPrefix)) return Eigen::Affine3d::Identity();
        std::string_view kind = name.substr(kPrefix.size());
        kind = kind.substr(0, kind.find(':'));
        const UsdValue value = valueAt(*attribute, time);
        const std::size_t wanted = numbersOf(kind);
        if (wanted == 0 || value.numbers.size() != wanted)
            return fail(fmt::format("{} of {} has {} numbers", name, prim.name, value.numbers.size()),
                        fmt::format("expected {} of a known transform", wanted));
        const Eigen::Affine3d result = operation(kind, value.numbers.doubles());
        return inverse ? Eigen::Affine3d(result.inverse()) : result;
    }

    Status readCurves(UsdPrim& prim, const std::string& path, const Above& levels) {
        UsdAttribute* const points = prim.find("points");
        const UsdAttribute* const counts = prim.find("curveVertexCounts");
        if (points == nullptr || counts == nullptr) return {};
        const std::set<double> times = timesOf(*points, levels);
        const double first = times.empty() ? 0 : *times.begin();
        CurveSet set;
        set.path = path;
        for (const double count : valueAt(*counts, first).numbers.doubles()) {
            if (!(count >= 0 && count <= INT32_MAX))
                return fail(fmt::format("{}: a curve of {} points", path, count), "expected a count");
            if (count > 0) set.counts.push_back(static_cast<std::uint32_t>(count));
        }
        if (set.counts.empty()) return {};
        const auto where = toFile(levels, first);
        if (!where) return tl::unexpected(where.error());
        set.toFile = *where;
        readForm(prim, set);
        if (auto status = readFrames(*points, levels, times, set); !status) return status;
        set.points = pointsOf(takeAt(*points, first));
        if (set.points.empty()) return {};
        for (UsdAttribute& attribute : prim.attributes) addAttribute(prim, attribute, first, set);
        curves_.push_back(std::move(set));
        return {};
    }

    static std::string tokenOf(const UsdPrim& prim, std::string_view name, const char* otherwise) {
        const UsdAttribute* const attribute = prim.find(name);
        return attribute == nullptr || attribute->value.texts.empty() ? otherwise
                                                                      : attribute->value.texts.front();
    }

    static void readForm(const UsdPrim& prim, CurveSet& set) {
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

    /// All times at which points or transforms are given.
    static std::set<double> timesOf(const UsdAttribute& points, const Above& levels) {
        std::set<double> times;
        for (const auto& [time, value] : points.samples) times.insert(time);
        for (const UsdPrim* prim : levels) {
            for (const UsdAttribute& attribute : prim->attributes) {
                if (!attribute.name.starts_with("xformOp:")) continue;
                for (const auto& [time, value] : attribute.samples) times.insert(time);
            }
        }
        return times;
    }

    Status readFrames(const UsdAttribute& points, const Above& levels, const std::set<double>& times,
                      CurveSet& set) {
        if (times.size() < 2) return {};
        if (!frames_) {
            strands_.warnings.push_back(
                fileNote(fmt::format("the hair is animated: {} time samples, of which the first was imported",
                                     times.size()),
                         set.path, "import with --record to keep all of them"));
            return {};
        }
        for (const double time : times) {
            set.frames.push_back(pointsOf(valueAt(points, time)));
            const auto where = toFile(levels, time);
            if (!where) return tl::unexpected(where.error());
            set.frameToFile.push_back(*where);
        }
        const double step = *std::next(times.begin()) - *times.begin();
        if (curves_.empty() && step > 0) strands_.framesPerSecond /= static_cast<float>(step);
        return {};
    }

    void addAttribute(const UsdPrim& prim, UsdAttribute& attribute, double time, CurveSet& set) {
        constexpr std::string_view kPrimvar = "primvars:", kIndices = ":indices";
        const bool isWidth = attribute.name == "widths";
        if (!isWidth && !attribute.name.starts_with(kPrimvar)) return;
        if (attribute.name.ends_with(kIndices)) return;
        UsdValue value = takeAt(attribute, time);
        CurveAttribute added;
        added.name = isWidth ? "width" : attribute.name.substr(kPrimvar.size());
        if (value.numbers.empty()) {
            if (!value.texts.empty())
                strands_.warnings.push_back(
                    fileNote("string attributes of curves were left out", added.name));
            return;
        }
        // The colour that a viewer draws a whole object in is none of the hair's.
        if (added.name == "displayColor" && value.numbers.size() == 3) return;
        added.scope = scopeOf(attribute.interpolation);
        added.components = value.components;
        if (attribute.elementSize > 1 && attribute.elementSize <= 4)
            added.components *= static_cast<std::uint32_t>(attribute.elementSize);
        if (added.components > 4) return;
        UsdNumbers numbers = std::move(value.numbers);
        if (const UsdAttribute* const indices = prim.find(attribute.name + std::string(kIndices)))
            numbers = indexed(numbers, added.components, valueAt(*indices, time).numbers.doubles());
        if (isWhole(attribute.type)) {
            added.isFlag = attribute.type.starts_with("bool") || attribute.type.starts_with("uchar");
            for (const double number : numbers.doubles())
                added.whole.push_back(std::abs(number) < 9e15 ? static_cast<std::int64_t>(number) : 0);
        } else {
            added.numbers = std::move(numbers).floats();
        }
        set.attributes.push_back(std::move(added));
    }

    /// Values by their places; one that there is not is 0.
    static UsdNumbers indexed(const UsdNumbers& values, std::size_t components,
                              const std::vector<double>& places) {
        UsdNumbers found;
        for (const double place : places) {
            const bool is = place >= 0 && place < static_cast<double>(values.size() / components);
            for (std::size_t c = 0; c < components; ++c)
                found.push_back(is ? values[static_cast<std::size_t>(place) * components + c] : 0);
        }
        return found;
    }

    UsdStage stage_;
    const std::string& file_;
    bool frames_;
    std::vector<CurveSet> curves_;
    RawStrands strands_;
};

bool beginsWith(std::span<const std::byte> bytes, std::string_view start) {
    return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}
bool isUsdc(std::span<const std::byte> bytes) {
    return beginsWith(bytes, "PXR-USDC");
}
bool isUsd(std::span<const std::byte> bytes) {
    return beginsWith(bytes, "#usda") || isUsdc(bytes);
}

Result<RawStrands> readUsd(const std::string& file, std::vector<std::byte>&& bytes,
                           const StrandImportOptions& options) {
    auto stage = isUsdc(bytes) ? readUsdc(file, bytes)
                               : readUsda(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (!stage) return tl::unexpected(stage.error());
    std::vector<std::byte>().swap(bytes);
    return Reader(std::move(*stage), file, options.frames).run();
}

}  // namespace

StrandReader usdReader() {
    return {{"USD .usda or .usdc", {"usda", "usdc", "usd"}}, Recognition::Signature, isUsd, readUsd};
}

}  // namespace hairloom
