// SPDX-License-Identifier: GPL-3.0-or-later
// The statements of a Wavefront OBJ that concern strands: v, l, f and curves.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>

#include "importers/curve_evaluation.h"
#include "importers/obj_text.h"
#include "importers/raw_strands.h"
#include "importers/strand_parts.h"

namespace hairloom {
namespace {

class Parser {
  public:
    Parser(const std::string& file, std::string_view text) : file_(file), lines_(text) {}

    Result<ObjStrandText> parse() {
        while (lines_.next()) {
            rest_ = lines_.rest();
            if (auto status = statement(lines_.keyword()); !status) return tl::unexpected(status.error());
        }
        endCurve();
        if (obj_.lineOffsets.size() > 1) tellUnused();
        placeEvaluated();
        return std::move(obj_);
    }

  private:
    Status statement(std::string_view keyword) {
        if (keyword == "v") return vertex();
        if (keyword == "l") return line();
        if (keyword == "f") return face();
        if (keyword == "curv") return curve();
        if (keyword == "o") named(object_);
        if (keyword == "g") named(group_);
        if (keyword == "deg") degree();
        if (keyword == "cstype") type();
        if (keyword == "parm") parameters();
        if (keyword == "end") endCurve();
        return {};
    }

    tl::unexpected<Error> wrong(std::string problem, std::string expected) const {
        return failIn(file_, Line{lines_.number()}, std::move(problem), std::move(expected));
    }

    Status vertex() {
        Vec3f position;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = takeWord(rest_);
            const auto value = parseNumber(word);
            if (!value) {
                return wrong(word.empty() ? fmt::format("a vertex has {} coordinates", axis)
                                          : fmt::format("'{}' is not a number", shortened(word)),
                             "expected three numbers after v");
            }
            position[axis] = static_cast<float>(*value);
        }
        if (obj_.vertices.size() == std::numeric_limits<std::uint32_t>::max()) {
            return wrong("more than 4,294,967,295 vertices", "expected fewer");
        }
        obj_.vertices.push_back(position);
        // x y z w of a rational curve; six numbers are a colour.
        const auto weight = parseNumber(takeWord(rest_));
        if (weight && takeWord(rest_).empty()) {
            weights_.resize(obj_.vertices.size(), 1.0f);
            weights_.back() = static_cast<float>(*weight);
        }
        return {};
    }

    /// Reads the statement's remaining words as vertex indices; of i/t/n the first counts, negative ones
    /// count back.
    Status indices(std::string_view what, std::vector<std::uint32_t>& target) {
        for (std::string_view word = takeWord(rest_); !word.empty(); word = takeWord(rest_)) {
            const auto index = parseWhole(word.substr(0, word.find('/')));
            if (!index) {
                return wrong(fmt::format("'{}' in a {} is not an index", shortened(word), what),
                             "expected whole numbers");
            }
            const auto count = static_cast<std::int64_t>(obj_.vertices.size());
            const std::int64_t fromZero = *index < 0 ? count + *index : *index - 1;
            if (fromZero < 0 || fromZero >= count) {
                return wrong(fmt::format("a {} refers to vertex {}", what, *index),
                             fmt::format("there are {} vertices before it", count));
            }
            target.push_back(static_cast<std::uint32_t>(fromZero));
            used_.resize(obj_.vertices.size());
            used_[target.back()] = true;
        }
        return {};
    }

    /// Lines come after their vertices, so a file that is cut short shows by these alone.
    void tellUnused() {
        used_.resize(obj_.vertices.size());
        const auto unused = std::ranges::count(used_, false);
        if (unused == 0) return;
        const auto first = std::ranges::find(used_, false) - used_.begin() + 1;
        obj_.warnings.push_back(fileWarning(
            fmt::format("{} vertices are in no line, curve or face; the first is vertex {}", unused, first),
            "vertices", "the file may be cut short: where strands are missing, write it again"));
    }

    Status line() {
        auto status = indices("line", obj_.lineIndices);
        endLine();
        return status;
    }

    void endLine() {
        obj_.lineOffsets.push_back(static_cast<std::uint32_t>(obj_.lineIndices.size()));
        obj_.lineParts.push_back(part());
    }

    void named(std::string& name) {
        name = rest_;
        part_.reset();
    }

    /// The part that lines and faces belong to from here on. Where a group has the name of its object as
    /// groups have names, without blanks, the object's is what people call it.
    std::uint32_t part() {
        if (part_) return *part_;
        const auto [known, isNew] =
            parts_.emplace(object_ + '\n' + group_, static_cast<std::uint32_t>(obj_.parts.size()));
        if (isNew) {
            const bool isOne = object_.empty() || group_.empty() || isNamedAfter(group_, object_);
            obj_.parts.push_back(
                {"/" + object_ + "/" + group_, isOne ? (object_.empty() ? group_ : object_) : std::string()});
        }
        part_ = known->second;
        return *part_;
    }

    /// Whether they are alike but for characters that became underscores, and a number behind.
    static bool isNamedAfter(std::string_view group, std::string_view object) {
        static constexpr auto isPlain = [](char c, bool) {
            return static_cast<unsigned char>(c) > 0x20 && c != 0x7f;
        };
        // Hairloom's own groups have no backslash, which would join lines at an end; others' may.
        return isGivenTo(group, object, isPlain) || isGivenTo(group, object, [](char c, bool isFirst) {
                   return isPlain(c, isFirst) && c != '\\';
               });
    }

    Status face() {
        auto status = indices("face", obj_.faceIndices);
        obj_.faceOffsets.push_back(static_cast<std::uint32_t>(obj_.faceIndices.size()));
        obj_.faceLines.push_back(lines_.number());
        obj_.faceParts.push_back(part());
        return status;
    }

    void degree() {
        const auto number = parseWhole(takeWord(rest_));
        degree_ = number && *number >= 1 && *number < 100 ? static_cast<std::uint32_t>(*number) : 0;
    }

    void type() {
        std::string_view word = takeWord(rest_);
        isRational_ = word == "rat";
        type_ = isRational_ ? takeWord(rest_) : word;
    }

    /// Knots of a B-spline; the name of their direction stands before them.
    void parameters() {
        takeWord(rest_);
        for (std::string_view word = takeWord(rest_); !word.empty(); word = takeWord(rest_)) {
            if (const auto knot = parseNumber(word)) knots_.push_back(*knot);
        }
    }

    /// A curve of degree 1 passes through its control points; others are evaluated at their `end`, when their
    /// knots are known.
    Status curve() {
        endCurve();
        for (int end = 0; end < 2; ++end) {
            if (!parseNumber(takeWord(rest_)))
                return wrong("a curve has no range", "expected two numbers after curv");
        }
        if (degree_ == 1) {
            auto status = indices("curve", obj_.lineIndices);
            endLine();
            return status;
        }
        curveLine_ = lines_.number();
        return indices("curve", controls_);
    }

    /// What evaluateCurve() takes; the knots of Bézier pieces that follow each other are `bezierKnots`.
    std::optional<CurveForm> form(std::vector<double>& bezierKnots) const {
        const auto count = static_cast<std::uint32_t>(controls_.size());
        CurveForm form{CurveBasis::Nurbs, CurveWrap::Open, degree_ + 1, {}};
        if (type_ == "cardinal") {
            form.basis = CurveBasis::CatmullRom;
        } else if (type_ == "bezier") {
            if (degree_ == 0 || (count - 1) % degree_ != 0) return std::nullopt;
            const std::uint32_t pieces = (count - 1) / degree_;
            for (std::uint32_t knot = 0; knot <= pieces; ++knot)
                bezierKnots.insert(bezierKnots.end(), degree_, knot);
            bezierKnots.insert(bezierKnots.begin(), 0);
            bezierKnots.push_back(pieces);
            form.knots = bezierKnots;
        } else if (type_ == "bspline") {
            // Writers in the wild leave knots out or give the wrong number of them.
            if (knots_.size() == controls_.size() + form.order) form.knots = knots_;
        } else {
            return std::nullopt;
        }
        return form;
    }

    Vec3f pointOf(const CurvePoint& point) const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double weights = 0;
        for (std::uint32_t k = 0; k < point.count; ++k) {
            const std::uint32_t vertex = controls_[point.index[k]];
            const double weight =
                point.weight[k] * (isRational_ && vertex < weights_.size() ? double{weights_[vertex]} : 1.0);
            sum += weight * obj_.vertices[vertex].cast<double>();
            weights += weight;
        }
        return (weights != 0 ? Eigen::Vector3d(sum / weights) : sum).cast<float>();
    }

    void endCurve() {
        if (controls_.empty()) return;
        std::vector<double> bezierKnots;
        const auto known = form(bezierKnots);
        const auto points = known ? evaluateCurve(*known, static_cast<std::uint32_t>(controls_.size()))
                                  : Result<std::vector<CurvePoint>>(fail(""));
        if (points) {
            evaluated_.push_back(
                {obj_.lineIndices.size(), obj_.lineIndices.size() + points->size(), evaluatedPoints_.size()});
            for (const CurvePoint& point : *points) evaluatedPoints_.push_back(pointOf(point));
            obj_.lineIndices.resize(obj_.lineIndices.size() + points->size());
        } else {
            if (!saidPolyline_)
                obj_.warnings.push_back(fileWarning(
                    fmt::format("a curve of type '{}', degree {} and {} control points became a line through "
                                "these points",
                                shortened(type_), degree_, controls_.size()),
                    fmt::format("line {}", curveLine_), "export curves as bezier, bspline or cardinal"));
            saidPolyline_ = true;
            obj_.lineIndices.insert(obj_.lineIndices.end(), controls_.begin(), controls_.end());
        }
        endLine();
        controls_.clear();
        knots_.clear();
    }

    /// Points on curves stand behind the file's own vertices, to which indices count back while it is read.
    void placeEvaluated() {
        const auto first = static_cast<std::uint32_t>(obj_.vertices.size());
        for (const Evaluated& curve : evaluated_) {
            for (std::size_t i = curve.begin; i < curve.end; ++i)
                obj_.lineIndices[i] = first + static_cast<std::uint32_t>(curve.point + i - curve.begin);
        }
        obj_.vertices.insert(obj_.vertices.end(), evaluatedPoints_.begin(), evaluatedPoints_.end());
    }

    /// Line indices that are to name evaluated points from `point` on.
    struct Evaluated {
        std::size_t begin, end, point;
    };

    std::string file_;
    ObjLines lines_;
    std::string_view rest_;  ///< of the statement, behind the words read
    ObjStrandText obj_;
    std::string object_, group_;         ///< as the last `o` and `g` say
    std::optional<std::uint32_t> part_;  ///< of these, where it is known
    std::unordered_map<std::string, std::uint32_t> parts_;
    std::string type_ = "bspline";
    bool isRational_ = false;
    std::uint32_t degree_ = 1;
    std::vector<bool> used_;               ///< vertices that something names; those behind are not
    std::vector<float> weights_;           ///< of vertices that have one; 1 of those behind
    std::vector<std::uint32_t> controls_;  ///< of the curve that is open
    std::vector<double> knots_;
    std::uint64_t curveLine_ = 0;
    std::vector<Evaluated> evaluated_;
    std::vector<Vec3f> evaluatedPoints_;
    bool saidPolyline_ = false;
};

}  // namespace

Result<ObjStrandText> parseObjStrands(const std::string& file, std::string_view text) {
    return Parser(file, text).parse();
}

}  // namespace hairloom
