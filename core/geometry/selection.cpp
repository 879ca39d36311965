// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "core/base/file.h"
#include "core/geometry/closest_point.h"

namespace hairloom {
namespace {

constexpr std::size_t kNamesShown = 20;

std::vector<bool> membership(const ScalpMesh& mesh, const FaceSet& faces) {
    std::vector<bool> member(mesh.triangleCount(), false);
    for (const std::uint32_t face : faces) member[face] = true;
    return member;
}

FaceSet members(const std::vector<bool>& member) {
    FaceSet faces;
    for (std::uint32_t t = 0; t < member.size(); ++t)
        if (member[t]) faces.push_back(t);
    return faces;
}

/// Calls visit(neighbour) for the up to three faces across the edges of `face`.
template <class Visit>
void forEachNeighbour(const ScalpMesh& mesh, std::uint32_t face, Visit visit) {
    const ScalpMesh::Connectivity& connectivity = mesh.connectivity();
    for (const auto halfedge : connectivity.fh_range(OpenMesh::FaceHandle(static_cast<int>(face)))) {
        const auto across = connectivity.opposite_face_handle(halfedge);
        if (across.is_valid()) visit(static_cast<std::uint32_t>(across.idx()));
    }
}

template <class Keep>
FaceSet filtered(const FaceSet& faces, Keep keep) {
    FaceSet kept;
    for (const std::uint32_t face : faces)
        if (keep(face)) kept.push_back(face);
    return kept;
}

std::optional<double> parseNumber(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

Result<double> numberBetween(std::string_view term, std::string_view text, double low, double high) {
    const std::optional<double> value = parseNumber(text);
    if (!value || *value < low || *value > high)
        return fail(fmt::format("selection '{}': '{}' is out of range", term, text),
                    fmt::format("expected a number from {} to {}", low, high));
    return *value;
}

/// "one of: …", for errors.
std::string someOf(std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const bool more = names.size() > kNamesShown;
    if (more) names.resize(kNamesShown);
    return fmt::format("expected one of: {}{}", fmt::join(names, ", "), more ? ", …" : "");
}

bool nameMatches(std::string_view name, std::string_view pattern) {
    if (!pattern.ends_with('*')) return name == pattern;
    pattern.remove_suffix(1);
    return name.starts_with(pattern);
}

/// A file may repeat a name; all parts of that name are meant.
Result<FaceSet> facesNamed(std::string_view term, std::string_view name, const FaceSet& current,
                           std::span<const std::uint32_t> perTriangle, const std::vector<std::string>& names,
                           const char* kind) {
    std::vector<bool> wanted(names.size(), false);
    for (std::size_t i = 0; i < names.size(); ++i) wanted[i] = names[i] == name;
    if (std::find(wanted.begin(), wanted.end(), true) != wanted.end())
        return filtered(current, [&](std::uint32_t face) { return wanted[perTriangle[face]]; });
    return fail(fmt::format("selection '{}': there is no {} '{}'", term, kind, name), someOf(names));
}

FaceSet facesUpright(const ScalpMesh& mesh, const FaceSet& current, double capDegrees) {
    const double minimum = std::cos(capDegrees * std::numbers::pi / 180) - 1e-6;
    return filtered(current, [&](std::uint32_t face) { return mesh.triangleNormal(face).y() >= minimum; });
}

FaceSet facesAbove(const ScalpMesh& mesh, const FaceSet& current, double fraction) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::uint32_t face : current)
        for (const std::uint32_t vertex : mesh.triangles()[face]) {
            low = std::min(low, static_cast<double>(mesh.positions()[vertex].y()));
            high = std::max(high, static_cast<double>(mesh.positions()[vertex].y()));
        }
    const double minimum = low + fraction * (high - low);
    return filtered(current, [&](std::uint32_t face) {
        double sum = 0;
        for (const std::uint32_t vertex : mesh.triangles()[face]) sum += mesh.positions()[vertex].y();
        return sum / 3 >= minimum;
    });
}

std::string_view trimmed(std::string_view text) {
    const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
    return text;
}

Result<FaceSet> facesListed(const ScalpMesh& mesh, const FaceSet& current, const std::string& path) {
    const Result<std::string> text = readTextFile(path);
    if (!text) return tl::unexpected(text.error());
    std::vector<std::uint32_t> wanted;
    std::uint64_t lineNumber = 0;
    const std::uint32_t faceCount = mesh.sourceFaces().empty() ? 0 : mesh.sourceFaces().back() + 1;
    for (std::size_t begin = 0; begin < text->size();) {
        const std::size_t end = std::min(text->find('\n', begin), text->size());
        const std::string_view line = trimmed(std::string_view(*text).substr(begin, end - begin));
        begin = end + 1;
        ++lineNumber;
        if (line.empty()) continue;
        std::uint32_t face = 0;
        const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), face);
        if (error != std::errc() || stop != line.data() + line.size())
            return failIn(path, Line{lineNumber}, fmt::format("'{}' is not a face", line.substr(0, 40)),
                          "expected one face number per line, from 0");
        if (face >= faceCount)
            return failIn(path, Line{lineNumber}, fmt::format("the mesh has no face {}", face),
                          fmt::format("expected a number below {}", faceCount));
        wanted.push_back(face);
    }
    std::sort(wanted.begin(), wanted.end());
    return filtered(current, [&](std::uint32_t face) {
        return std::binary_search(wanted.begin(), wanted.end(), mesh.sourceFaces()[face]);
    });
}

/// A term as "word:argument". Errors: an unknown word, a number out of range.
struct Term {
    std::string_view word, argument;
    double number = 0;
};
Result<Term> parseTerm(std::string_view term) {
    const std::size_t colon = term.find(':');
    if (term == "all" || term == "invert" || term == "connected") return Term{term, {}};
    Term parsed{term.substr(0, colon), {}};
    constexpr std::string_view kWords[] = {"group", "material", "cap", "above", "faces", "grow", "shrink"};
    if (colon == std::string_view::npos ||
        std::find(std::begin(kWords), std::end(kWords), parsed.word) == std::end(kWords))
        return fail(fmt::format("selection '{}': unknown term", term.substr(0, 80)),
                    "expected all, group:NAME, material:NAME, cap:DEGREES, above:F, faces:FILE, grow:N, "
                    "shrink:N, invert or connected");
    parsed.argument = term.substr(colon + 1);
    const bool isRings = parsed.word == "grow" || parsed.word == "shrink";
    if (!isRings && parsed.word != "cap" && parsed.word != "above") return parsed;
    constexpr double kMaxRings = 1e6;
    const auto number = numberBetween(term, parsed.argument, 0,
                                      isRings                ? kMaxRings
                                      : parsed.word == "cap" ? 180
                                                             : 1);
    if (!number) return tl::unexpected(number.error());
    if (isRings && *number != std::floor(*number))
        return fail(fmt::format("selection '{}': '{}' is not a whole number", term, parsed.argument),
                    "expected a whole number of rings");
    parsed.number = *number;
    return parsed;
}

/// Calls visit(term) for each until one fails.
template <class Visit>
Status forEachTerm(std::string_view expression, Visit visit) {
    for (std::size_t begin = 0; begin <= expression.size();) {
        const std::size_t end = std::min(expression.find(',', begin), expression.size());
        if (auto status = visit(trimmed(expression.substr(begin, end - begin))); !status) return status;
        begin = end + 1;
    }
    return {};
}

Result<FaceSet> applyTerm(const ScalpMesh& mesh, const FaceSet& current, std::string_view term) {
    const auto parsed = parseTerm(term);
    if (!parsed) return tl::unexpected(parsed.error());
    const auto& [word, argument, number] = *parsed;
    if (word == "all") return current;
    if (word == "invert") return invertSelection(mesh, current);
    if (word == "connected") {
        std::vector<FaceSet> pieces = connectedPieces(mesh, current);
        return pieces.empty() ? FaceSet{} : std::move(pieces.front());
    }
    if (word == "group")
        return facesNamed(term, argument, current, mesh.triangleGroups(), mesh.groupNames(), "group");
    if (word == "material")
        return facesNamed(term, argument, current, mesh.triangleMaterials(), mesh.materialNames(),
                          "material");
    if (word == "cap") return facesUpright(mesh, current, number);
    if (word == "above") return facesAbove(mesh, current, number);
    if (word == "faces") return facesListed(mesh, current, std::string(argument));
    return word == "grow" ? growSelection(mesh, current, static_cast<int>(number))
                          : shrinkSelection(mesh, current, static_cast<int>(number));
}

}  // namespace

Result<FaceSet> selectFaces(const ScalpMesh& mesh, std::string_view expression) {
    FaceSet current(mesh.triangleCount());
    for (std::uint32_t t = 0; t < current.size(); ++t) current[t] = t;
    std::string_view emptiedBy;
    const Status done = forEachTerm(expression, [&](std::string_view term) -> Status {
        Result<FaceSet> next = applyTerm(mesh, current, term);
        if (!next) return tl::unexpected(next.error());
        if (next->empty() && !current.empty()) emptiedBy = term;
        current = std::move(*next);
        return {};
    });
    if (!done) return tl::unexpected(done.error());
    if (current.empty())
        return fail(fmt::format("selection '{}' is empty after '{}'", expression, emptiedBy),
                    "expected at least one face");
    return current;
}

Status checkSelection(std::string_view expression) {
    return forEachTerm(expression, [](std::string_view term) -> Status {
        if (const auto parsed = parseTerm(term); !parsed) return tl::unexpected(parsed.error());
        return {};
    });
}

Result<FaceSet> facesOfGroups(const ScalpMesh& mesh, std::span<const std::string> names) {
    std::vector<bool> wanted(mesh.groupNames().size(), false);
    for (const std::string& name : names) {
        bool known = false;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            if (!nameMatches(mesh.groupNames()[i], name)) continue;
            known = wanted[i] = true;
        }
        if (!known) return fail(fmt::format("the mesh has no group '{}'", name), someOf(mesh.groupNames()));
    }
    FaceSet faces;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
        if (wanted[mesh.triangleGroups()[t]]) faces.push_back(t);
    return faces;
}

Result<FaceSet> facesOnSurface(const ScalpMesh& mesh, const FaceSet& faces, const ScalpMesh& surface) {
    constexpr float kOn_m = 0.005f;
    const SurfaceTree tree(surface);
    FaceSet on;
    float nearest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t face : faces) {
        const Triangle& corners = mesh.triangles()[face];
        const Vec3f middle =
            (mesh.positions()[corners[0]] + mesh.positions()[corners[1]] + mesh.positions()[corners[2]]) / 3;
        const SurfaceTree::Hit hit = tree.closest(middle);
        nearest = std::min(nearest, hit.distance);
        const bool facesAlike =
            mesh.triangleNormal(face).dot(surface.triangleNormal(hit.surface.triangle)) > 0;
        if (hit.distance <= kOn_m && facesAlike) on.push_back(face);
    }
    if (on.empty())
        return fail(
            fmt::format("no face of the head lies on this scalp; the nearest is {:.3g} m away", nearest),
            "expected a scalp in the unit and place of the head, facing outwards");
    return on;
}

FaceSet growSelection(const ScalpMesh& mesh, const FaceSet& faces, int rings) {
    std::vector<bool> member = membership(mesh, faces);
    FaceSet front = faces, next;
    for (int ring = 0; ring < rings && !front.empty(); ++ring) {
        next.clear();
        for (const std::uint32_t face : front)
            forEachNeighbour(mesh, face, [&](std::uint32_t neighbour) {
                if (member[neighbour]) return;
                member[neighbour] = true;
                next.push_back(neighbour);
            });
        std::swap(front, next);
    }
    return members(member);
}

FaceSet shrinkSelection(const ScalpMesh& mesh, const FaceSet& faces, int rings) {
    return invertSelection(mesh, growSelection(mesh, invertSelection(mesh, faces), rings));
}

FaceSet invertSelection(const ScalpMesh& mesh, const FaceSet& faces) {
    std::vector<bool> member = membership(mesh, faces);
    member.flip();
    return members(member);
}

std::vector<FaceSet> connectedPieces(const ScalpMesh& mesh, const FaceSet& faces) {
    std::vector<bool> open = membership(mesh, faces);
    std::vector<std::pair<double, FaceSet>> pieces;
    for (const std::uint32_t seed : faces) {
        if (!open[seed]) continue;
        FaceSet piece{seed};
        open[seed] = false;
        for (std::size_t i = 0; i < piece.size(); ++i)
            forEachNeighbour(mesh, piece[i], [&](std::uint32_t neighbour) {
                if (!open[neighbour]) return;
                open[neighbour] = false;
                piece.push_back(neighbour);
            });
        std::sort(piece.begin(), piece.end());
        pieces.emplace_back(selectionArea(mesh, piece), std::move(piece));
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<FaceSet> result;
    result.reserve(pieces.size());
    for (auto& piece : pieces) result.push_back(std::move(piece.second));
    return result;
}

double selectionArea(const ScalpMesh& mesh, const FaceSet& faces) {
    double area = 0;
    for (const std::uint32_t face : faces) area += mesh.triangleArea(face);
    return area;
}

}  // namespace hairloom
