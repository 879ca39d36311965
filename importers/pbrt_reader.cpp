// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of pbrt's scenes, versions 3 and 4: shapes "curve" below transforms. Pieces that continue each
// other, as exporters cut a strand, become one curve again.

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "importers/curve_set.h"
#include "importers/obj_text.h"

namespace hairloom {
namespace {

std::string_view textOf(std::span<const std::byte> bytes) {
    const void* const characters = bytes.data();
    return {static_cast<const char*>(characters), bytes.size()};
}

bool isPbrt(std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    for (std::size_t at = text.find("Shape"); at != text.npos; at = text.find("Shape", at + 1)) {
        std::string_view rest = text.substr(at + 5);
        if (takeWord(rest) == "\"curve\"") return true;
    }
    return false;
}

/// Words, texts in quotes and brackets, with the line of each.
class Tokens {
  public:
    explicit Tokens(std::string_view text) : text_(text) {}

    /// The next one; empty at the end.
    std::string_view next() {
        const std::string_view token = peek();
        text_.remove_prefix(token.size());
        return token;
    }
    std::string_view peek() {
        while (!text_.empty()) {
            if (isBlank(text_.front())) {
                line_ += text_.front() == '\n';
                text_.remove_prefix(1);
            } else if (text_.front() == '#') {
                text_.remove_prefix(std::min(text_.find('\n'), text_.size()));
            } else {
                break;
            }
        }
        if (text_.empty()) return {};
        if (text_.front() == '[' || text_.front() == ']') return text_.substr(0, 1);
        if (text_.front() == '"') {
            const std::size_t end = text_.find('"', 1);
            return text_.substr(0, end == text_.npos ? end : end + 1);
        }
        std::size_t end = 0;
        while (end < text_.size() && !isBlank(text_[end]) && text_[end] != '[' && text_[end] != ']' &&
               text_[end] != '"' && text_[end] != '#')
            ++end;
        return text_.substr(0, end);
    }
    std::uint64_t line() const { return line_; }

  private:
    std::string_view text_;
    std::uint64_t line_ = 1;
};

std::string_view unquoted(std::string_view token) {
    if (token.size() < 2 || token.front() != '"' || token.back() != '"') return {};
    return token.substr(1, token.size() - 2);
}

using Matrix = Eigen::Matrix4d;

/// What a shape "curve" says.
struct Piece {
    CurveBasis basis = CurveBasis::Bezier;
    std::uint32_t degree = 3;
    std::vector<double> points;
    double width0 = 1, width1 = 1;

    std::size_t controls() const { return points.size() / 3; }
    std::size_t segments() const {
        return basis == CurveBasis::Bezier ? (controls() - 1) / degree : controls() - degree;
    }
};

class Parser {
  public:
    Parser(const std::string& file, std::string_view text) : file_(file), tokens_(text) {}

    Result<RawStrands> parse() {
        for (std::string_view token = tokens_.next(); !token.empty(); token = tokens_.next()) {
            if (auto status = statement(token); !status) return tl::unexpected(status.error());
        }
        RawStrands raw;
        for (auto& [key, set] : sets_) {
            if (auto status = appendCurves(file_, std::move(set), 0, raw); !status)
                return tl::unexpected(status.error());
        }
        if (raw.offsets.size() < 2)
            return failIn(file_, {}, "has no curves of its own",
                          included_.empty()
                              ? "expected shapes \"curve\""
                              : fmt::format("read the file that it includes, {}, by itself", included_));
        adoptAttributes(raw);
        raw.format = "pbrt curves";
        if (!included_.empty())
            raw.warnings.push_back(fileWarning(fmt::format("{} is included and not followed", included_),
                                               "Include", "read that file by itself"));
        return raw;
    }

  private:
    tl::unexpected<Error> wrong(std::string problem, std::string expected) const {
        return failIn(file_, Line{tokens_.line()}, std::move(problem), std::move(expected));
    }

    Status statement(std::string_view token) {
        if (token == "AttributeBegin" || token == "TransformBegin" || token == "ObjectBegin") {
            constexpr std::size_t kDeepest = 10'000;
            if (stack_.size() == kDeepest) return wrong("attributes lie too deep", "expected fewer levels");
            stack_.push_back(toWorld_);
        } else if (token == "AttributeEnd" || token == "TransformEnd" || token == "ObjectEnd") {
            if (stack_.empty())
                return wrong(fmt::format("{} ends what did not begin", token),
                             "expected its beginning before");
            toWorld_ = stack_.back();
            stack_.pop_back();
        } else if (token == "WorldBegin" || token == "Identity") {
            toWorld_.setIdentity();
        } else if (token == "Transform" || token == "ConcatTransform") {
            Matrix matrix;
            if (auto status = numbers(std::span(matrix.data(), 16)); !status) return status;
            toWorld_ = token == "Transform" ? matrix : Matrix(toWorld_ * matrix);
        } else if (token == "Translate" || token == "Scale") {
            Eigen::Vector3d by;
            if (auto status = numbers(std::span(by.data(), 3)); !status) return status;
            Eigen::Affine3d one = Eigen::Affine3d::Identity();
            token == "Scale" ? one.scale(by) : one.translate(by);
            toWorld_ = toWorld_ * one.matrix();
        } else if (token == "Rotate") {
            std::array<double, 4> by{};
            if (auto status = numbers(by); !status) return status;
            const Eigen::Vector3d axis(by[1], by[2], by[3]);
            if (!(axis.norm() > 0)) return wrong("Rotate about no axis", "expected an angle and an axis");
            const Eigen::Affine3d one(Eigen::AngleAxisd(by[0] * M_PI / 180, axis.normalized()));
            toWorld_ = toWorld_ * one.matrix();
        } else if (token == "Include" || token == "Import") {
            included_ = shortened(unquoted(tokens_.next()));
        } else if (token == "Shape" && unquoted(tokens_.peek()) == "curve") {
            tokens_.next();
            return shape();
        }
        return {};
    }

    /// Numbers, in brackets or not.
    Status numbers(std::span<double> target) {
        const bool isBracketed = tokens_.peek() == "[";
        if (isBracketed) tokens_.next();
        for (double& value : target) {
            const std::string_view token = tokens_.next();
            const auto number = parseNumber(token);
            if (!number || !std::isfinite(*number))
                return wrong(fmt::format("'{}' is no number", shortened(token)),
                             fmt::format("expected {} of them", target.size()));
            value = *number;
        }
        if (isBracketed && tokens_.next() != "]") return wrong("too many numbers", "expected ']'");
        return {};
    }

    /// A value or a list in brackets, as the parameter takes it.
    template <class Take>
    Status values(Take take) {
        if (tokens_.peek() != "[") return take(tokens_.next());
        tokens_.next();
        for (std::string_view token = tokens_.next(); token != "]"; token = tokens_.next()) {
            if (token.empty()) return wrong("a list has no end", "expected ']'");
            if (auto status = take(token); !status) return status;
        }
        return {};
    }

    Status shape() {
        Piece piece;
        while (tokens_.peek().starts_with('"')) {
            std::string_view declared = unquoted(tokens_.next());
            takeWord(declared);
            const std::string name(takeWord(declared));
            const auto status = values([&](std::string_view token) { return parameter(name, token, piece); });
            if (!status) return status;
        }
        if (piece.degree != 2 && piece.degree != 3)
            return wrong(fmt::format("a curve of degree {}", piece.degree), "expected 2 or 3");
        const std::size_t controls = piece.controls();
        if (piece.points.size() % 3 != 0 || controls < piece.degree + 1 ||
            (piece.basis == CurveBasis::Bezier && (controls - 1) % piece.degree != 0))
            return wrong(fmt::format("a curve of {} numbers in P", piece.points.size()),
                         fmt::format("expected whole points of a curve of degree {}", piece.degree));
        add(piece);
        return {};
    }

    Status parameter(const std::string& name, std::string_view token, Piece& piece) {
        if (name == "basis") {
            piece.basis = unquoted(token) == "bspline" ? CurveBasis::BSpline : CurveBasis::Bezier;
            return {};
        }
        if (name != "P" && name != "width" && name != "width0" && name != "width1" && name != "degree")
            return {};
        const auto number = parseNumber(token);
        if (!number || !std::isfinite(*number))
            return wrong(fmt::format("'{}' in {} is no number", shortened(token), name), "expected numbers");
        if (name == "P") piece.points.push_back(*number);
        if (name == "degree") piece.degree = *number == 2 ? 2 : *number == 3 ? 3 : 0;
        if (name == "width" || name == "width0") piece.width0 = *number;
        if (name == "width" || name == "width1") piece.width1 = *number;
        return {};
    }

    /// Behind the curve before where it goes on from there, else as a new one.
    void add(Piece& piece) {
        raiseDegree(piece);
        for (std::size_t i = 0; i < piece.controls(); ++i) {
            const Eigen::Vector4d p =
                toWorld_ * Eigen::Map<const Eigen::Vector3d>(&piece.points[3 * i]).homogeneous();
            for (int axis = 0; axis < 3; ++axis)
                piece.points[3 * i + static_cast<std::size_t>(axis)] = p[axis] / (p[3] != 0 ? p[3] : 1);
        }
        const double scale = std::cbrt(std::abs(toWorld_.topLeftCorner<3, 3>().determinant()));
        piece.width0 *= scale;
        piece.width1 *= scale;
        auto [found, isNew] = sets_.try_emplace(piece.basis);
        CurveSet& set = found->second;
        if (isNew) {
            set.path = "Shape \"curve\"";
            set.basis = piece.basis;
            set.attributes.push_back({"width", CurveAttribute::Scope::Knot, 1, {}, {}});
        }
        const std::size_t shared = piece.basis == CurveBasis::Bezier ? 1 : 3;
        const bool goesOn = !set.counts.empty() && lastBasis_ == piece.basis && continues(set, piece, shared);
        lastBasis_ = piece.basis;
        const std::size_t skipped = goesOn ? shared : 0;
        for (std::size_t i = 3 * skipped; i < piece.points.size(); ++i)
            set.points.push_back(static_cast<float>(piece.points[i]));
        std::vector<float>& widths = set.attributes.front().numbers;
        const std::size_t segments = piece.segments();
        for (std::size_t k = goesOn ? 1 : 0; k <= segments; ++k) {
            const double t = static_cast<double>(k) / static_cast<double>(segments);
            widths.push_back(static_cast<float>((1 - t) * piece.width0 + t * piece.width1));
        }
        const auto added = static_cast<std::uint32_t>(piece.controls() - skipped);
        if (goesOn)
            set.counts.back() += added;
        else
            set.counts.push_back(added);
    }

    /// A parabola as the cubic that it is.
    static void raiseDegree(Piece& piece) {
        if (piece.degree == 3) return;
        std::vector<double> cubic;
        const auto point = [&](std::size_t i) {
            return Eigen::Map<const Eigen::Vector3d>(&piece.points[3 * i]);
        };
        const auto add = [&](const Eigen::Vector3d& p) { cubic.insert(cubic.end(), p.data(), p.data() + 3); };
        for (std::size_t segment = 0; segment < piece.segments(); ++segment) {
            std::array<Eigen::Vector3d, 3> quadratic;
            if (piece.basis == CurveBasis::Bezier) {
                quadratic = {point(2 * segment), point(2 * segment + 1), point(2 * segment + 2)};
            } else {
                const Eigen::Vector3d a = point(segment), b = point(segment + 1), c = point(segment + 2);
                quadratic = {0.5 * (a + b), b, 0.5 * (b + c)};
            }
            if (segment == 0) add(quadratic[0]);
            add((quadratic[0] + 2 * quadratic[1]) / 3);
            add((2 * quadratic[1] + quadratic[2]) / 3);
            add(quadratic[2]);
        }
        piece.points = std::move(cubic);
        piece.basis = CurveBasis::Bezier;
        piece.degree = 3;
    }

    static bool continues(const CurveSet& set, const Piece& piece, std::size_t shared) {
        if (set.counts.back() < shared) return false;
        const float* const tail = set.points.data() + set.points.size() - 3 * shared;
        double size = 0, off = 0;
        for (std::size_t i = 0; i < 3 * shared; ++i) {
            size = std::max(size, std::abs(piece.points[i]));
            off = std::max(off, std::abs(piece.points[i] - static_cast<double>(tail[i])));
        }
        constexpr double kRounding = 1e-6;  // texts have six digits
        return off <= kRounding * std::max(size, 1e-3);
    }

    const std::string& file_;
    Tokens tokens_;
    Matrix toWorld_ = Matrix::Identity();
    std::vector<Matrix> stack_;
    std::map<CurveBasis, CurveSet> sets_;
    CurveBasis lastBasis_ = CurveBasis::Linear;
    std::string included_;
};

Result<RawStrands> readPbrt(const std::string& file, std::vector<std::byte>&& bytes,
                            const StrandImportOptions&) {
    return Parser(file, textOf(bytes)).parse();
}

}  // namespace

StrandReader pbrtReader() {
    return {{"pbrt curves", {"pbrt"}}, Recognition::Structure, isPbrt, readPbrt};
}

}  // namespace hairloom
