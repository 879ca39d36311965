// SPDX-License-Identifier: GPL-3.0-or-later
// The statements of a Wavefront OBJ that concern strands: v, l, f and curves of degree 1.

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <limits>

#include "importers/raw_strands.h"

namespace hairloom {
namespace {

/// Walks over a text by statements and words. A backslash before the line's end joins it with the next.
class Scanner {
  public:
    explicit Scanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

    bool atEnd() const { return at_ == end_; }
    std::uint64_t line() const { return line_; }

    /// The next word of the statement; empty at its end.
    std::string_view word() {
        skipBlanks();
        const char* begin = at_;
        while (at_ != end_ && !isBlank(*at_) && *at_ != '\n' && !joinsLines()) ++at_;
        return {begin, static_cast<std::size_t>(at_ - begin)};
    }

    void nextStatement() {
        while (at_ != end_ && *at_ != '\n') {
            if (joinsLines()) {
                skipJoin();
            } else {
                ++at_;
            }
        }
        if (at_ != end_) newLine();
    }

  private:
    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
    void newLine() {
        ++at_;
        ++line_;
    }
    bool joinsLines() const {
        if (*at_ != '\\') return false;
        const char* next = at_ + 1;
        if (next != end_ && *next == '\r') ++next;
        return next != end_ && *next == '\n';
    }
    void skipJoin() {
        while (*at_ != '\n') ++at_;
        newLine();
    }
    void skipBlanks() {
        while (at_ != end_) {
            if (isBlank(*at_)) {
                ++at_;
            } else if (joinsLines()) {
                skipJoin();
            } else {
                return;
            }
        }
    }

    const char* at_;
    const char* end_;
    std::uint64_t line_ = 1;
};

/// Beyond the range of float is infinity or zero, as elsewhere in the language.
std::optional<float> parseFloat(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    float value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size()) return std::nullopt;
    if (code == std::errc::result_out_of_range) return std::strtof(std::string(word).c_str(), nullptr);
    if (code != std::errc()) return std::nullopt;
    return value;
}

class Parser {
  public:
    Parser(const std::string& file, std::string_view text) : file_(file), scanner_(text) {}

    Result<ObjStrandText> parse() {
        while (!scanner_.atEnd()) {
            const std::string_view keyword = scanner_.word();
            Status status;
            if (keyword == "v") {
                status = vertex();
            } else if (keyword == "l") {
                status = indices("line", obj_.lineIndices);
                if (status) endLine();
            } else if (keyword == "f") {
                status = face();
            } else if (keyword == "deg") {
                status = degree();
            } else if (keyword == "curv") {
                status = curve();
            }
            if (!status) return tl::unexpected(status.error());
            scanner_.nextStatement();
        }
        return std::move(obj_);
    }

  private:
    tl::unexpected<Error> wrong(std::string problem, std::string expected) const {
        return failIn(file_, Line{scanner_.line()}, std::move(problem), std::move(expected));
    }

    Status vertex() {
        Vec3f position;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = scanner_.word();
            const auto value = parseFloat(word);
            if (!value) {
                return wrong(word.empty() ? fmt::format("a vertex has {} coordinates", axis)
                                          : fmt::format("'{}' is not a number", word.substr(0, 40)),
                             "expected three numbers after v");
            }
            position[axis] = *value;
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
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            std::int64_t index = 0;
            const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
            const auto [end, code] = std::from_chars(begin, word.data() + word.size(), index);
            const bool complete = end == word.data() + word.size() || *end == '/';
            if (code != std::errc() || !complete) {
                return wrong(fmt::format("'{}' in a {} is not an index", word.substr(0, 40), what),
                             "expected whole numbers");
            }
            const auto count = static_cast<std::int64_t>(obj_.vertices.size());
            const std::int64_t fromZero = index < 0 ? count + index : index - 1;
            if (fromZero < 0 || fromZero >= count) {
                return wrong(fmt::format("a {} names vertex {}", what, index),
                             fmt::format("{} vertices stand before it", count));
            }
            target.push_back(static_cast<std::uint32_t>(fromZero));
        }
        return {};
    }

    void endLine() { obj_.lineOffsets.push_back(static_cast<std::uint32_t>(obj_.lineIndices.size())); }

    Status face() {
        auto status = indices("face", obj_.faceIndices);
        obj_.faceOffsets.push_back(static_cast<std::uint32_t>(obj_.faceIndices.size()));
        obj_.faceLines.push_back(scanner_.line());
        return status;
    }

    Status degree() {
        const auto value = parseFloat(scanner_.word());
        degree_ = value ? *value : 0.0f;
        return {};
    }

    /// A curve of degree 1 passes through its control points; others do not, so their points are no strand.
    Status curve() {
        if (degree_ != 1.0f) {
            if (!skippedCurves_) {
                obj_.warnings.push_back(fileWarning(fmt::format("curves of degree {} were left out", degree_),
                                                    fmt::format("line {}", scanner_.line()),
                                                    "export them as polylines or with degree 1"));
            }
            skippedCurves_ = true;
            return {};
        }
        for (int end = 0; end < 2; ++end) {
            if (!parseFloat(scanner_.word()))
                return wrong("a curve has no range", "expected two numbers after curv");
        }
        auto status = indices("curve", obj_.lineIndices);
        if (status) endLine();
        return status;
    }

    std::string file_;
    Scanner scanner_;
    ObjStrandText obj_;
    float degree_ = 0;
    bool skippedCurves_ = false;
};

}  // namespace

Result<ObjStrandText> parseObjStrands(const std::string& file, std::string_view text) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    return Parser(file, text).parse();
}

}  // namespace hairloom
