// SPDX-License-Identifier: GPL-3.0-or-later
// TressFX 1 and 2: text, a few named numbers, then strand after strand, a vertex a line with commas between.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>

#include "importers/obj_text.h"
#include "importers/raw_strands.h"

namespace hairloom {
namespace {

std::string_view textOf(std::span<const std::byte> bytes) {
    const void* const characters = bytes.data();
    return {static_cast<const char*>(characters), bytes.size()};
}

/// A line "version N" behind blanks and comments alone, or another of the head's, with strands behind it.
bool isTfxText(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes.first(std::min<std::size_t>(bytes.size(), 2048)));
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::string_view head = text;
    while (trimmed(text).starts_with('#')) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    const std::string_view word = takeWord(text);
    if (word == "version") {
        const auto number = parseNumber(takeWord(text));
        return number && *number >= 1 && *number < 8;
    }
    constexpr std::array<std::string_view, 6> kHead{"numStrands", "numHairStrands", "scale",
                                                    "rotation",   "translation",    "strand"};
    return std::ranges::find(kHead, word) != kHead.end() && head.find("numVerts") != std::string_view::npos;
}

class Parser {
  public:
    Parser(const std::string& file, std::string_view text) : file_(file), text_(text) {
        if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
    }

    Result<RawStrands> parse() {
        raw_.format = "TressFX 2 text";
        while (nextLine()) {
            if (auto status = statement(); !status) return tl::unexpected(status.error());
        }
        if (announced_ && *announced_ != raw_.offsets.size() - 1)
            return wrong(fmt::format("ends after {} strands", raw_.offsets.size() - 1),
                         fmt::format("numStrands says {}", *announced_));
        if (raw_.offsets.size() < 2) return wrong("has no strand", "expected lines 'strand I numVerts N'");
        if (!hasUvs_) raw_.rootUvs.clear();
        place();
        return std::move(raw_);
    }

  private:
    tl::unexpected<Error> wrong(std::string problem, std::string expected) const {
        return failIn(file_, Line{number_}, std::move(problem), std::move(expected));
    }

    /// The next line that says something, its commas as blanks.
    bool nextLine() {
        while (!text_.empty()) {
            const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
            line_.assign(text_.substr(0, end));
            const bool isPair = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
            text_.remove_prefix(std::min(text_.size(), end + (isPair ? 2 : 1)));
            ++number_;
            for (char& c : line_) c = c == ',' ? ' ' : c;
            rest_ = line_;
            if (!trimmed(rest_).empty() && trimmed(rest_).front() != '#') return true;
        }
        return false;
    }

    Status statement() {
        const std::string_view keyword = takeWord(rest_);
        if (keyword == "strand") return strand();
        if (keyword == "scale") return numbers("scale", std::span(&scale_, 1));
        if (keyword == "rotation") return numbers("rotation", std::span(rotation_));
        if (keyword == "translation") return numbers("translation", std::span(translation_));
        if (keyword == "numStrands" || keyword == "numHairStrands") {
            const auto count = parseWhole(takeWord(rest_));
            if (!count || *count < 0) return wrong("numStrands without a number", "expected a count");
            announced_ = static_cast<std::uint64_t>(*count);
        } else if (keyword == "bothEndsImmovable" && trimmed(rest_) == "1") {
            raw_.warnings.push_back(
                fileNote("both ends of the strands are marked immovable; Hairloom fixes the root alone",
                         "strand tips", "constrain the tips again where that was wanted"));
        } else if (parseNumber(keyword)) {
            return wrong("a vertex that belongs to no strand",
                         "expected as many lines behind 'strand' as numVerts says");
        }
        return {};
    }

    Status numbers(std::string_view what, std::span<double> target) {
        for (double& value : target) {
            const auto number = parseNumber(takeWord(rest_));
            if (!number || !std::isfinite(*number))
                return wrong(fmt::format("{} without its {} numbers", what, target.size()),
                             "expected numbers");
            value = *number;
        }
        return {};
    }

    /// "strand 0 numVerts 8 texcoord 0.5 0.25", then the vertices.
    Status strand() {
        takeWord(rest_);
        std::optional<std::int64_t> count;
        Vec2f uv = Vec2f::Zero();
        for (std::string_view word = takeWord(rest_); !word.empty(); word = takeWord(rest_)) {
            if (word == "numVerts") {
                count = parseWhole(takeWord(rest_));
            } else if (word == "texcoord") {
                std::array<double, 2> found{};
                if (auto status = numbers("texcoord", found); !status) return status;
                uv = Vec2f(static_cast<float>(found[0]), static_cast<float>(found[1]));
                hasUvs_ = true;
            }
        }
        if (!count || *count < 0) return wrong("a strand without numVerts", "expected 'strand I numVerts N'");
        // A vertex takes six bytes of text at the least.
        if (static_cast<std::uint64_t>(*count) > text_.size() / 6 + 1)
            return wrong(fmt::format("a strand of {} vertices, and {} bytes are left", *count, text_.size()),
                         "expected a whole file: export it again");
        for (std::int64_t i = 0; i < *count; ++i) {
            std::array<double, 3> position{};
            if (!nextLine())
                return wrong(fmt::format("ends after {} vertices of a strand", i),
                             fmt::format("numVerts says {}", *count));
            for (double& value : position) {
                const std::string_view word = takeWord(rest_);
                const auto number = parseNumber(word);
                if (!number)
                    return wrong(fmt::format("'{}' is no coordinate", shortened(word)),
                                 fmt::format("expected vertex {} of {}: three numbers", i + 1, *count));
                value = *number;
            }
            raw_.positions.push_back(Eigen::Map<const Eigen::Vector3d>(position.data()).cast<float>());
        }
        if (raw_.positions.size() > std::numeric_limits<std::uint32_t>::max())
            return wrong("more than 4,294,967,295 vertices", "expected fewer");
        raw_.offsets.push_back(static_cast<std::uint32_t>(raw_.positions.size()));
        raw_.rootUvs.push_back(uv);
        return {};
    }

    /// Scale, rotation (degrees about X, then Y, then Z) and translation of the file's head.
    void place() {
        if (scale_ == 1 && rotation_ == std::array<double, 3>{} && translation_ == std::array<double, 3>{})
            return;
        constexpr double kRadians = M_PI / 180;
        Eigen::Affine3d toFile = Eigen::Affine3d::Identity();
        toFile.translate(Eigen::Vector3d(translation_[0], translation_[1], translation_[2]));
        for (int axis = 2; axis >= 0; --axis)
            toFile.rotate(Eigen::AngleAxisd(rotation_[static_cast<std::size_t>(axis)] * kRadians,
                                            Eigen::Vector3d::Unit(axis)));
        toFile.scale(scale_);
        for (Vec3f& position : raw_.positions) position = (toFile * position.cast<double>()).cast<float>();
        raw_.warnings.push_back(
            fileNote("the scale, rotation and translation of the file's head were applied", "positions"));
    }

    const std::string& file_;
    std::string_view text_, rest_;
    std::string line_;
    std::uint64_t number_ = 0;
    std::optional<std::uint64_t> announced_;
    double scale_ = 1;
    std::array<double, 3> rotation_{}, translation_{};
    bool hasUvs_ = false;
    RawStrands raw_;
};

Result<RawStrands> readTfxText(const std::string& file, std::vector<std::byte>&& bytes,
                               const StrandImportOptions&) {
    return Parser(file, textOf(bytes)).parse();
}

}  // namespace

StrandReader tfxTextReader() {
    return {{"TressFX 2 text", {"tfx"}}, Recognition::Signature, isTfxText, readTfxText};
}

}  // namespace hairloom
