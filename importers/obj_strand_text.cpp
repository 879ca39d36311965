// SPDX-License-Identifier: GPL-3.0-or-later
// The statements of a Wavefront OBJ that concern strands: v, l, f and curves of degree 1.

#include <fmt/format.h>

#include <limits>

#include "importers/obj_text.h"
#include "importers/raw_strands.h"

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
        return std::move(obj_);
    }

  private:
    Status statement(std::string_view keyword) {
        if (keyword == "v") return vertex();
        if (keyword == "l") return line();
        if (keyword == "f") return face();
        if (keyword == "curv") return curve();
        if (keyword == "deg") degree();
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
                return wrong(fmt::format("a {} names vertex {}", what, *index),
                             fmt::format("{} vertices stand before it", count));
            }
            target.push_back(static_cast<std::uint32_t>(fromZero));
        }
        return {};
    }

    Status line() {
        auto status = indices("line", obj_.lineIndices);
        endLine();
        return status;
    }

    void endLine() { obj_.lineOffsets.push_back(static_cast<std::uint32_t>(obj_.lineIndices.size())); }

    Status face() {
        auto status = indices("face", obj_.faceIndices);
        obj_.faceOffsets.push_back(static_cast<std::uint32_t>(obj_.faceIndices.size()));
        obj_.faceLines.push_back(lines_.number());
        return status;
    }

    void degree() { degree_ = static_cast<float>(parseNumber(takeWord(rest_)).value_or(0)); }

    /// A curve of degree 1 passes through its control points; others do not, so their points are no strand.
    Status curve() {
        if (degree_ != 1.0f) {
            if (!skippedCurves_) {
                obj_.warnings.push_back(fileWarning(fmt::format("curves of degree {} were left out", degree_),
                                                    fmt::format("line {}", lines_.number()),
                                                    "export them as polylines or with degree 1"));
            }
            skippedCurves_ = true;
            return {};
        }
        for (int end = 0; end < 2; ++end) {
            if (!parseNumber(takeWord(rest_)))
                return wrong("a curve has no range", "expected two numbers after curv");
        }
        auto status = indices("curve", obj_.lineIndices);
        endLine();
        return status;
    }

    std::string file_;
    ObjLines lines_;
    std::string_view rest_;  ///< of the statement, behind the words read
    ObjStrandText obj_;
    float degree_ = 0;
    bool skippedCurves_ = false;
};

}  // namespace

Result<ObjStrandText> parseObjStrands(const std::string& file, std::string_view text) {
    return Parser(file, text).parse();
}

}  // namespace hairloom
