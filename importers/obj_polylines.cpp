// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ lines into strands. A line of three or more points is a strand as it stands; lines of two points are
// segments, which are chained where they share a vertex.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "importers/raw_strands.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// Up to two neighbours of each vertex along two-point lines, and what else chaining needs to know.
struct Node {
    std::array<std::uint32_t, 2> neighbours{kNone, kNone};
    std::uint8_t degree = 0;     ///< saturates at 3
    bool startsSegment = false;  ///< named first in some segment
    bool endsSegment = false;    ///< named second in some segment
    bool visited = false;
};

class Chains {
  public:
    Chains(const ObjStrandText& obj, RawStrands& raw, std::vector<std::uint32_t>& vertices)
        : obj_(obj), raw_(raw), vertices_(vertices), nodes_(obj.vertices.size()) {}

    void addSegment(std::uint32_t from, std::uint32_t to) {
        if (from == to) return;
        link(from, to);
        link(to, from);
        nodes_[from].startsSegment = true;
        nodes_[to].endsSegment = true;
    }

    /// The strand that the vertex's component makes; nothing when it was made before.
    void emit(std::uint32_t vertex, std::uint32_t strand) {
        if (nodes_[vertex].visited) return;
        const auto component = collect(vertex);
        std::uint32_t ends = 0;
        for (const std::uint32_t member : component) {
            if (touchesBranch(member)) return raw_.dropped.push_back({strand, DropReason::Branches});
            ends += nodes_[member].degree == 1 ? 1 : 0;
        }
        if (ends == 0) {
            const auto reason = component.size() > 1 ? DropReason::ClosedLoop : DropReason::TooFewPoints;
            return raw_.dropped.push_back({strand, reason});
        }
        walk(firstEnd(component));
        raw_.sourceIndices.push_back(strand);
    }

  private:
    void link(std::uint32_t from, std::uint32_t to) {
        Node& node = nodes_[from];
        if (node.neighbours[0] == to || node.neighbours[1] == to) return;
        if (node.degree < 2) node.neighbours[node.degree] = to;
        if (node.degree < 3) ++node.degree;
    }

    bool touchesBranch(std::uint32_t vertex) const {
        const Node& node = nodes_[vertex];
        if (node.degree > 2) return true;
        return std::any_of(node.neighbours.begin(), node.neighbours.end(), [&](std::uint32_t neighbour) {
            return neighbour != kNone && nodes_[neighbour].degree > 2;
        });
    }

    /// Where three lines meet, the neighbours beyond the second are unknown; they then count as another
    /// component.
    std::vector<std::uint32_t> collect(std::uint32_t vertex) {
        std::vector<std::uint32_t> component;
        std::vector<std::uint32_t> open{vertex};
        nodes_[vertex].visited = true;
        while (!open.empty()) {
            const std::uint32_t member = open.back();
            open.pop_back();
            component.push_back(member);
            for (const std::uint32_t neighbour : nodes_[member].neighbours) {
                if (neighbour == kNone || nodes_[neighbour].visited) continue;
                nodes_[neighbour].visited = true;
                open.push_back(neighbour);
            }
        }
        return component;
    }

    /// The end that the segments' direction leads away from; where both or neither do, the lower vertex.
    std::uint32_t firstEnd(const std::vector<std::uint32_t>& component) const {
        std::uint32_t best = kNone;
        bool bestLeads = false;
        for (const std::uint32_t member : component) {
            const Node& node = nodes_[member];
            if (node.degree != 1) continue;
            const bool leads = node.startsSegment && !node.endsSegment;
            if (best == kNone || (leads && !bestLeads) || (leads == bestLeads && member < best)) {
                best = member;
                bestLeads = leads;
            }
        }
        return best;
    }

    void walk(std::uint32_t end) {
        std::uint32_t previous = kNone;
        std::uint32_t current = end;
        while (current != kNone) {
            raw_.positions.push_back(obj_.vertices[current]);
            vertices_.push_back(current);
            const auto& neighbours = nodes_[current].neighbours;
            const std::uint32_t next = neighbours[0] != previous ? neighbours[0] : neighbours[1];
            previous = current;
            current = next;
        }
        raw_.offsets.push_back(static_cast<std::uint32_t>(raw_.positions.size()));
    }

    const ObjStrandText& obj_;
    RawStrands& raw_;
    std::vector<std::uint32_t>& vertices_;
    std::vector<Node> nodes_;
};

}  // namespace

Result<RawStrands> strandsFromLines(const std::string& file, const ObjStrandText& obj,
                                    std::vector<std::uint32_t>& vertices) {
    RawStrands raw;
    raw.format = "OBJ lines";
    raw.rootFirst = false;
    raw.parts = obj.parts;
    const std::size_t lineCount = obj.lineOffsets.size() - 1;
    const auto line = [&](std::size_t index) {
        return std::span(obj.lineIndices)
            .subspan(obj.lineOffsets[index], obj.lineOffsets[index + 1] - obj.lineOffsets[index]);
    };
    Chains chains(obj, raw, vertices);
    std::size_t segments = 0;
    std::size_t points = 0;
    for (std::size_t i = 0; i < lineCount; ++i) {
        points += line(i).size();
        if (line(i).size() != 2) continue;
        ++segments;
        chains.addSegment(line(i)[0], line(i)[1]);
    }
    if (points > std::size_t{kNone})
        return failIn(file, {}, "lines have more than 4,294,967,295 points", "fewer");
    raw.positions.reserve(points);
    std::uint32_t strand = 0;
    for (std::size_t i = 0; i < lineCount; ++i) {
        const auto indices = line(i);
        if (indices.size() == 2) {
            const std::size_t before = raw.sourceIndices.size() + raw.dropped.size();
            const std::size_t made = raw.sourceIndices.size();
            chains.emit(indices[0], strand);
            if (raw.sourceIndices.size() > made && !obj.lineParts.empty())
                raw.partOfStrand.push_back(obj.lineParts[i]);
            if (raw.sourceIndices.size() + raw.dropped.size() > before) ++strand;
            continue;
        }
        if (!obj.lineParts.empty()) raw.partOfStrand.push_back(obj.lineParts[i]);
        for (const std::uint32_t index : indices) raw.positions.push_back(obj.vertices[index]);
        vertices.insert(vertices.end(), indices.begin(), indices.end());
        raw.offsets.push_back(static_cast<std::uint32_t>(raw.positions.size()));
        raw.sourceIndices.push_back(strand++);
    }
    if (segments > 0 && strand < lineCount) {
        raw.warnings.push_back(
            fileNote(fmt::format("{} lines of two points were chained", segments), "lines"));
    }
    if (!obj.faceLines.empty()) {
        raw.warnings.push_back(fileNote(fmt::format("{} faces were left out", obj.faceLines.size()), "faces",
                                        "import them as a mesh"));
    }
    return raw;
}

}  // namespace hairloom
