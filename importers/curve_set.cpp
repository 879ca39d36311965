// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/curve_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "importers/attribute_units.h"

namespace hairloom {
namespace {

using Scope = CurveAttribute::Scope;

/// What the curves of a set have one value of.
struct Sizes {
    std::size_t curves = 0, knots = 0, points = 0;

    std::size_t of(Scope scope) const {
        switch (scope) {
            case Scope::Constant:
                return 1;
            case Scope::Curve:
                return curves;
            case Scope::Knot:
                return knots;
            default:
                return points;
        }
    }
};

/// The scope that the number of values bears out, the stated one first: writers in the wild state others.
Scope scopeOf(const CurveAttribute& attribute, const Sizes& sizes) {
    const std::size_t count = attribute.count();
    if (attribute.scope != Scope::Unknown && count == sizes.of(attribute.scope)) return attribute.scope;
    for (const Scope scope : {Scope::Point, Scope::Knot, Scope::Curve, Scope::Constant}) {
        if (count == sizes.of(scope)) return scope;
    }
    return Scope::Unknown;
}

/// The components of one value at a point of a curve. `curve` counts curves, `controls` and `knots` are where
/// this one's begin.
struct Where {
    std::size_t curve, controls, knots, knotCount;
    std::span<const float> weights;  ///< of its control points, or empty
};

/// The point's shares of its control points, with the curve's own weights where it is rational.
CurvePoint rational(CurvePoint point, std::span<const float> weights) {
    if (weights.empty()) return point;
    double sum = 0;
    for (std::uint32_t k = 0; k < point.count; ++k) {
        point.weight[k] *= weights[point.index[k]];
        sum += point.weight[k];
    }
    for (std::uint32_t k = 0; k < point.count; ++k) point.weight[k] = sum != 0 ? point.weight[k] / sum : 0;
    return point;
}

std::uint32_t heaviest(const CurvePoint& point) {
    const auto end = point.weight.begin() + point.count;
    return point
        .index[static_cast<std::size_t>(std::max_element(point.weight.begin(), end) - point.weight.begin())];
}

/// Takes the values of one attribute to strands and points.
class AttributeSink {
  public:
    AttributeSink(const CurveAttribute& from, Scope scope, RawAttribute& to)
        : from_(from), scope_(scope), to_(to) {}

    void addStrand(const Where& where) {
        if (to_.perPoint) return;
        copy(scope_ == Scope::Curve ? where.curve : 0);
    }
    void addPoint(const Where& where, const CurvePoint& point) {
        if (!to_.perPoint) return;
        if (scope_ == Scope::Constant || scope_ == Scope::Curve) {
            copy(scope_ == Scope::Curve ? where.curve : 0);
        } else if (scope_ == Scope::Point) {
            if (from_.numbers.empty()) return copy(where.controls + heaviest(point));
            for (std::uint32_t c = 0; c < from_.components; ++c) {
                double value = 0;
                for (std::uint32_t k = 0; k < point.count; ++k)
                    value += point.weight[k] * number(where.controls + point.index[k], c);
                to_.numbers.push_back(static_cast<float>(value));
            }
        } else {
            const auto before = static_cast<std::size_t>(point.knot);
            // A closed curve ends at its first knot.
            const std::size_t a = before % where.knotCount, b = (before + 1) % where.knotCount;
            const double t = point.knot - static_cast<double>(before);
            if (from_.numbers.empty() || t == 0) return copy(where.knots + a);
            for (std::uint32_t c = 0; c < from_.components; ++c)
                to_.numbers.push_back(static_cast<float>((1 - t) * number(where.knots + a, c) +
                                                         t * number(where.knots + b, c)));
        }
    }

  private:
    double number(std::size_t element, std::uint32_t component) const {
        return double{from_.numbers[element * from_.components + component]};
    }
    void copy(std::size_t element) {
        for (std::uint32_t c = 0; c < from_.components; ++c) {
            const std::size_t at = element * from_.components + c;
            if (!from_.numbers.empty())
                to_.numbers.push_back(from_.numbers[at]);
            else
                to_.whole.push_back(static_cast<std::int32_t>(
                    std::clamp<std::int64_t>(from_.whole[at], INT32_MIN, INT32_MAX)));
        }
    }

    const CurveAttribute& from_;
    Scope scope_;
    RawAttribute& to_;
};

/// Values of elements that came before the attribute did, or that other curves do not have.
void pad(RawAttribute& attribute, std::size_t strands, std::size_t points) {
    const std::size_t elements = attribute.perPoint ? points : strands;
    const bool isNumber = attribute.type == RawAttribute::Type::Number;
    const std::size_t there =
        isNumber ? attribute.numbers.size() / attribute.components : attribute.whole.size();
    if (there < elements) attribute.absent.emplace_back(there, elements);
    if (isNumber)
        attribute.numbers.resize(elements * attribute.components);
    else
        attribute.whole.resize(elements);
}

template <class T>
void spread(std::vector<T>& values, std::size_t components, std::span<const std::uint32_t> offsets) {
    std::vector<T> spread;
    spread.reserve(offsets.back() * components);
    for (std::size_t strand = 0; !values.empty() && strand + 1 < offsets.size(); ++strand) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(strand * components);
        for (std::uint32_t point = offsets[strand]; point < offsets[strand + 1]; ++point)
            spread.insert(spread.end(), begin, begin + static_cast<std::ptrdiff_t>(components));
    }
    values = std::move(spread);
}

/// Values of strands become those of all their points.
void spread(RawAttribute& attribute, std::span<const std::uint32_t> offsets) {
    spread(attribute.numbers, attribute.components, offsets);
    spread(attribute.whole, 1, offsets);
    for (auto& [first, second] : attribute.absent) {
        first = offsets[first];
        second = offsets[second];
    }
    attribute.perPoint = true;
}

/// Each component of whole vectors is an attribute of its own.
void split(CurveAttribute attribute, std::vector<CurveAttribute>& parts) {
    if (attribute.whole.empty() || attribute.components == 1) {
        parts.push_back(std::move(attribute));
        return;
    }
    for (std::uint32_t c = 0; c < attribute.components; ++c) {
        CurveAttribute part{
            fmt::format("{}_{}", attribute.name, c), attribute.scope, 1, {}, {}, attribute.isFlag};
        for (std::size_t i = c; i < attribute.whole.size(); i += attribute.components)
            part.whole.push_back(attribute.whole[i]);
        parts.push_back(std::move(part));
    }
}

class Appender {
  public:
    Appender(const std::string& file, CurveSet curves, std::size_t frames, RawStrands& strands)
        : file_(file), curves_(std::move(curves)), frames_(frames), strands_(strands) {}

    Status run() {
        if (auto status = measure(); !status) return status;
        widthScale_ = std::cbrt(std::abs(curves_.toFile.linear().determinant()));
        strands_.frames.resize(frames_);
        openSinks();
        reserve();
        Where where{0, 0, 0, 1, {}};
        std::size_t knotValues = 0;
        for (; where.curve < sizes_.curves; ++where.curve) {
            const std::uint32_t controls = curves_.counts[where.curve];
            const CurveForm form = formOf(where.curve, controls, knotValues);
            if (!curves_.weights.empty())
                where.weights = std::span(curves_.weights).subspan(where.controls, controls);
            where.knotCount = std::max(1u, knotCount(form, controls));
            if (auto status = addCurve(where, form, controls); !status) return status;
            where.controls += controls;
            where.knots += knotCount(form, controls);
            knotValues += controls + form.order;
        }
        if (polylines_ > 0) {
            strands_.warnings.push_back(
                fileWarning(fmt::format("{} curves do not fit their basis ({})", polylines_, firstPolyline_),
                            curves_.path, "they were imported as lines through their control points"));
        }
        return {};
    }

  private:
    tl::unexpected<Error> wrong(const std::string& what, std::string expected) const {
        return failIn(file_, {}, fmt::format("{}: {}", curves_.path, what), std::move(expected));
    }

    Status measure() {
        sizes_.curves = curves_.counts.size();
        std::uint64_t points = 0, knots = 0;
        for (std::size_t curve = 0; curve < sizes_.curves; ++curve) {
            points += curves_.counts[curve];
            knots += curves_.counts[curve] + orderOf(curve);
            sizes_.knots += knotCount(formOf(curve, 0, 0), curves_.counts[curve]);
        }
        sizes_.points = curves_.points.size() / 3;
        if (points != sizes_.points)
            return wrong(fmt::format("curves of together {} points", points),
                         fmt::format("the file has {} points", sizes_.points));
        if (curves_.basis == CurveBasis::Nurbs) mendKnots(static_cast<std::size_t>(knots));
        if (!curves_.orders.empty() && curves_.orders.size() != 1 && curves_.orders.size() != sizes_.curves)
            return wrong(fmt::format("{} orders", curves_.orders.size()),
                         fmt::format("expected one for each of {} curves", sizes_.curves));
        if (!curves_.weights.empty() && curves_.weights.size() != sizes_.points)
            return wrong(fmt::format("{} weights", curves_.weights.size()),
                         fmt::format("expected {}", sizes_.points));
        for (const auto& frame : curves_.frames) {
            if (frame.size() != curves_.points.size())
                return wrong(fmt::format("{} points at one time", frame.size() / 3),
                             fmt::format("expected {} at all times", sizes_.points));
        }
        return {};
    }

    /// Knots are as many as control points and order; some programs leave the first and the last out.
    void mendKnots(std::size_t expected) {
        const std::size_t found = curves_.knots.size();
        if (found == expected || found == 0) return;
        std::vector<double> mended;
        if (found + 2 * sizes_.curves == expected) {
            std::size_t at = 0;
            for (std::size_t curve = 0; curve < sizes_.curves; ++curve) {
                const std::size_t count = curves_.counts[curve] + orderOf(curve) - 2;
                if (count == 0 || count > found - at) break;
                mended.push_back(curves_.knots[at]);
                mended.insert(mended.end(), curves_.knots.begin() + static_cast<std::ptrdiff_t>(at),
                              curves_.knots.begin() + static_cast<std::ptrdiff_t>(at + count));
                at += count;
                mended.push_back(mended.back());
            }
            if (mended.size() != expected) mended.clear();
        }
        strands_.warnings.push_back(fileWarning(
            fmt::format("{} knots, where curves of these orders have {}", found, expected), curves_.path,
            mended.empty() ? "uniform knots were taken"
                           : "the first and the last of each curve were taken twice"));
        curves_.knots = std::move(mended);
    }

    std::uint32_t orderOf(std::size_t curve) const {
        if (curves_.orders.empty()) return 4;
        return curves_.orders[std::min(curve, curves_.orders.size() - 1)];
    }

    CurveForm formOf(std::size_t curve, std::uint32_t controls, std::size_t knotsBegin) const {
        CurveForm form{curves_.basis, curves_.wrap, orderOf(curve), {}};
        if (!curves_.knots.empty() && controls > 0)
            form.knots = std::span(curves_.knots).subspan(knotsBegin, controls + form.order);
        return form;
    }

    void openSinks() {
        const std::size_t strands = strands_.offsets.size() - 1, points = strands_.positions.size();
        for (CurveAttribute& attribute : curves_.attributes) split(std::move(attribute), parts_);
        curves_.attributes.clear();
        std::vector<std::pair<std::size_t, Scope>> open;
        for (CurveAttribute& part : parts_) {
            const Scope scope = scopeOf(part, sizes_);
            if (scope == Scope::Unknown || part.count() == 0) {
                if (part.count() > 0) reportLeftOut(part);
                open.emplace_back(SIZE_MAX, scope);
                continue;
            }
            tellScope(part, scope);
            scaleAttribute(part);
            std::size_t target = targetOf(part, scope, strands, points);
            // Said twice of the same curves: the first counts.
            if (std::ranges::find(open, target, &std::pair<std::size_t, Scope>::first) != open.end())
                target = SIZE_MAX;
            open.emplace_back(target, scope);
        }
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            if (open[i].first != SIZE_MAX)
                sinks_.emplace_back(parts_[i], open[i].second, strands_.attributes[open[i].first]);
        }
    }

    /// Other readers go by what the file says.
    void tellScope(const CurveAttribute& part, Scope scope) {
        if (part.scope == Scope::Unknown || part.scope == scope) return;
        constexpr std::array<std::string_view, 5> kNames{"", "constant", "uniform", "varying", "vertex"};
        const auto name = [&](Scope one) { return kNames[static_cast<std::size_t>(one)]; };
        strands_.warnings.push_back(
            fileNote(fmt::format("{} says that it is {} and has {} values, where that is {}", part.name,
                                 name(part.scope), part.count(), sizes_.of(part.scope)),
                     curves_.path, fmt::format("it was taken for {}", name(scope))));
    }

    /// Lengths and places are in the object's space.
    void scaleAttribute(CurveAttribute& part) const {
        const AttributeUnit unit = attributeUnit(part.name, part.components);
        if (part.numbers.empty() || unit == AttributeUnit::None) return;
        if (unit == AttributeUnit::Length) {
            for (float& length : part.numbers) length = static_cast<float>(length * widthScale_);
            return;
        }
        for (std::size_t i = 0; i + 2 < part.numbers.size(); i += 3) {
            Eigen::Map<Vec3f> value(&part.numbers[i]);
            const Eigen::Vector3d there = value.cast<double>();
            value = (unit == AttributeUnit::Position ? Eigen::Vector3d(curves_.toFile * there)
                                                     : Eigen::Vector3d(curves_.toFile.linear() * there))
                        .cast<float>();
        }
    }

    /// Where the values go, by place in the list: made where it is new. SIZE_MAX where another set has the
    /// name with another type.
    std::size_t targetOf(const CurveAttribute& part, Scope scope, std::size_t strands, std::size_t points) {
        RawAttribute wanted;
        wanted.name = part.name;
        wanted.perPoint = scope == Scope::Point || scope == Scope::Knot;
        wanted.components = part.components;
        if (part.numbers.empty())
            wanted.type = part.isFlag ? RawAttribute::Type::Flag : RawAttribute::Type::Whole;
        for (std::size_t i = 0; i < strands_.attributes.size(); ++i) {
            const RawAttribute& there = strands_.attributes[i];
            if (there.name != wanted.name) continue;
            if (there.perPoint == wanted.perPoint && there.type == wanted.type &&
                there.components == wanted.components)
                return i;
            // Constant in one set of curves and of points in another: all values are kept as those of points.
            if (there.type == wanted.type && there.components == wanted.components) {
                if (wanted.perPoint) spread(strands_.attributes[i], strands_.offsets);
                return i;
            }
            reportLeftOut(part);
            return SIZE_MAX;
        }
        pad(wanted, strands, points);
        strands_.attributes.push_back(std::move(wanted));
        return strands_.attributes.size() - 1;
    }

    /// Room for a point for each control point, which is what lines have and other curves begin with.
    void reserve() {
        const std::size_t points = strands_.positions.size() + sizes_.points;
        strands_.positions.reserve(points);
        for (std::vector<Vec3f>& frame : strands_.frames) frame.reserve(points);
        strands_.offsets.reserve(strands_.offsets.size() + sizes_.curves);
        for (RawAttribute& attribute : strands_.attributes) {
            const std::size_t elements = attribute.perPoint ? points : strands_.offsets.capacity();
            if (attribute.type == RawAttribute::Type::Number)
                attribute.numbers.reserve(elements * attribute.components);
            else
                attribute.whole.reserve(elements);
        }
    }

    void reportLeftOut(const CurveAttribute& part) {
        strands_.warnings.push_back(
            fileWarning(fmt::format("{} has {} values, which do not fit {} curves of {} points", part.name,
                                    part.count(), sizes_.curves, sizes_.points),
                        curves_.path, "it was left out"));
    }

    Status addCurve(const Where& where, const CurveForm& form, std::uint32_t controls) {
        if (controls == 1) {
            // The import drops it with its reason.
            evaluated_ = {CurvePoint{}};
        } else if (!(isCached_ && controls == cachedControls_ && form.order == cachedOrder_ &&
                     form.knots.empty())) {
            auto evaluated = evaluateCurve(form, controls);
            isPolyline_ = !evaluated;
            if (!evaluated) {
                if (polylines_ == 0)
                    firstPolyline_ = fmt::format("curve {}: {}; {}", where.curve, evaluated.error().problem,
                                                 evaluated.error().expected);
                evaluated = evaluateCurve({CurveBasis::Linear, CurveWrap::Open, form.order, {}}, controls);
            }
            evaluated_ = std::move(*evaluated);
        }
        // Writers put curves of two points among cubic ones: their control points are all there is to go by.
        if (isPolyline_ && controls != 1) ++polylines_;
        isCached_ = controls != 1 && form.knots.empty();
        cachedControls_ = controls;
        cachedOrder_ = form.order;
        for (AttributeSink& sink : sinks_) sink.addStrand(where);
        for (const CurvePoint& even : evaluated_) {
            const CurvePoint point = rational(even, where.weights);
            strands_.positions.push_back(positionOf(point, where.controls, curves_.points, curves_.toFile));
            for (std::size_t f = 0; f < frames_; ++f) addFrame(f, point, where.controls);
            for (AttributeSink& sink : sinks_) sink.addPoint(where, point);
        }
        strands_.offsets.push_back(static_cast<std::uint32_t>(strands_.positions.size()));
        return {};
    }

    void addFrame(std::size_t frame, const CurvePoint& point, std::size_t controls) {
        const auto& points = curves_.frames.empty()
                                 ? curves_.points
                                 : curves_.frames[std::min(frame, curves_.frames.size() - 1)];
        const auto& toFile = curves_.frameToFile.empty()
                                 ? curves_.toFile
                                 : curves_.frameToFile[std::min(frame, curves_.frameToFile.size() - 1)];
        strands_.frames[frame].push_back(positionOf(point, controls, points, toFile));
    }

    static Vec3f positionOf(const CurvePoint& point, std::size_t controls, std::span<const float> points,
                            const Eigen::Affine3d& toFile) {
        const auto control = [&](std::uint32_t k) {
            return Eigen::Map<const Vec3f>(&points[3 * (controls + point.index[k])]);
        };
        if (point.count == 1 && toFile.matrix().isIdentity(0)) return control(0);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::uint32_t k = 0; k < point.count; ++k) sum += point.weight[k] * control(k).cast<double>();
        return (toFile * sum).cast<float>();
    }

    const std::string& file_;
    CurveSet curves_;
    std::size_t frames_;
    RawStrands& strands_;
    Sizes sizes_;
    double widthScale_ = 1;
    std::vector<CurveAttribute> parts_;
    std::vector<AttributeSink> sinks_;
    std::vector<CurvePoint> evaluated_;
    std::size_t polylines_ = 0;
    std::string firstPolyline_;
    bool isPolyline_ = false;
    bool isCached_ = false;
    std::uint32_t cachedControls_ = 0, cachedOrder_ = 0;
};

}  // namespace

Status appendCurves(const std::string& file, CurveSet curves, std::size_t frames, RawStrands& strands) {
    if (auto status = Appender(file, std::move(curves), frames, strands).run(); !status) return status;
    for (RawAttribute& attribute : strands.attributes)
        pad(attribute, strands.offsets.size() - 1, strands.positions.size());
    return {};
}

void narrowWholeNumbers(std::vector<CurveSet>& sets, std::vector<Finding>& warnings) {
    std::map<std::string, std::vector<std::int64_t>> wide;
    const auto isWide = [](std::int64_t value) { return value < INT32_MIN || value > INT32_MAX; };
    for (const CurveSet& set : sets) {
        for (const CurveAttribute& attribute : set.attributes) {
            if (std::ranges::any_of(attribute.whole, isWide)) wide[attribute.name];
        }
    }
    if (wide.empty()) return;
    for (const CurveSet& set : sets) {
        for (const CurveAttribute& attribute : set.attributes) {
            const auto found = wide.find(attribute.name);
            if (found != wide.end())
                found->second.insert(found->second.end(), attribute.whole.begin(), attribute.whole.end());
        }
    }
    for (auto& [name, values] : wide) {
        std::ranges::sort(values);
        values.erase(std::unique(values.begin(), values.end()), values.end());
        warnings.push_back(fileWarning(
            fmt::format("{} has numbers of 64 bits, which are more than are kept", name), name,
            fmt::format("its {} different values were numbered from 0 in their order", values.size())));
    }
    for (CurveSet& set : sets) {
        for (CurveAttribute& attribute : set.attributes) {
            const auto found = wide.find(attribute.name);
            if (found == wide.end()) continue;
            for (std::int64_t& value : attribute.whole)
                value = std::ranges::lower_bound(found->second, value) - found->second.begin();
        }
    }
}

}  // namespace hairloom
