// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that Cinema 4D wrote as flat ribbons (thesis §4.1, Figure 7): 2n vertices for a strand of n particles,
// root to tip. There are n_v/(2n) strands; the thesis prints the inverse.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "importers/raw_strands.h"

namespace hairloom {
namespace {

constexpr std::array kOrders{RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge, RibbonOrder::Around};

/// Where a ribbon's vertices are, counted from its first.
struct Rung {
    std::uint32_t left;
    std::uint32_t right;
};
Rung rungOf(RibbonOrder order, std::uint32_t particle, std::uint32_t particles) {
    switch (order) {
        case RibbonOrder::EdgeAfterEdge:
            return {particle, particles + particle};
        case RibbonOrder::Around:
            return {particle, 2 * particles - 1 - particle};
        case RibbonOrder::Interleaved:
        case RibbonOrder::Detect:
            break;
    }
    return {2 * particle, 2 * particle + 1};
}
std::uint32_t particleOf(RibbonOrder order, std::uint32_t vertex, std::uint32_t particles) {
    switch (order) {
        case RibbonOrder::EdgeAfterEdge:
            return vertex % particles;
        case RibbonOrder::Around:
            return std::min(vertex, 2 * particles - 1 - vertex);
        case RibbonOrder::Interleaved:
        case RibbonOrder::Detect:
            break;
    }
    return vertex / 2;
}

class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t element) {
        while (parents_[element] != element) {
            parents_[element] = parents_[parents_[element]];
            element = parents_[element];
        }
        return element;
    }
    /// The lowest element represents its set.
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

std::span<const std::uint32_t> faceOf(const ObjStrandText& obj, std::size_t face) {
    return std::span(obj.faceIndices)
        .subspan(obj.faceOffsets[face], obj.faceOffsets[face + 1] - obj.faceOffsets[face]);
}

/// Vertices of each ribbon: all vertices that faces connect, which must be equally many runs of the file.
Result<std::uint32_t> ribbonSizeFromFaces(const std::string& file, const ObjStrandText& obj) {
    const auto count = static_cast<std::uint32_t>(obj.vertices.size());
    DisjointSets sets(count);
    for (std::size_t face = 0; face + 1 < obj.faceOffsets.size(); ++face) {
        const auto corners = faceOf(obj, face);
        for (std::size_t i = 1; i < corners.size(); ++i) sets.join(corners[0], corners[i]);
    }
    std::uint32_t size = 0;
    std::uint32_t begin = 0;
    for (std::uint32_t vertex = 1; vertex <= count; ++vertex) {
        if (vertex < count && sets.find(vertex) == begin) continue;
        if (vertex < count && sets.find(vertex) < begin) {
            return failIn(file, {},
                          fmt::format("faces join vertex {} with the ribbon of vertex {}", vertex + 1,
                                      sets.find(vertex) + 1),
                          "expected the vertices of each strand to follow each other");
        }
        const std::uint32_t found = vertex - begin;
        if (size == 0) size = found;
        if (found != size || found % 2 != 0 || found < 4) {
            return failIn(
                file, {},
                fmt::format("faces connect vertices {} to {}: {} vertices", begin + 1, vertex, found),
                size == found ? "expected ribbons of an even number of vertices, at least 4"
                              : fmt::format("expected {} as in the first ribbon", size));
        }
        begin = vertex;
    }
    return size;
}

Result<std::uint32_t> ribbonSize(const std::string& file, const ObjStrandText& obj,
                                 const StrandImportOptions& options) {
    const std::size_t count = obj.vertices.size();
    if (options.ribbonSegments == 0) {
        if (!obj.faceLines.empty()) return ribbonSizeFromFaces(file, obj);
        return failIn(file, {}, fmt::format("has {} vertices, but neither lines nor faces", count),
                      "expected the number of segments of a strand to be given");
    }
    const std::uint64_t size = 2 * (std::uint64_t{options.ribbonSegments} + 1);
    if (count % size != 0) {
        return failIn(
            file, {},
            fmt::format("{} vertices are not a multiple of {}, the vertices of a strand of {} segments",
                        count, size, options.ribbonSegments),
            fmt::format("{} are left over", count % size));
    }
    return static_cast<std::uint32_t>(size);
}

/// The first face that does not lie between two neighbouring rungs; the number of faces where there is none.
std::size_t firstMisfit(const ObjStrandText& obj, RibbonOrder order, std::uint32_t size) {
    for (std::size_t face = 0; face < obj.faceLines.size(); ++face) {
        std::uint32_t low = size;
        std::uint32_t high = 0;
        std::uint32_t ribbon = 0;
        bool oneRibbon = true;
        for (const std::uint32_t corner : faceOf(obj, face)) {
            if (low == size) ribbon = corner / size;
            oneRibbon = oneRibbon && corner / size == ribbon;
            const std::uint32_t particle = particleOf(order, corner % size, size / 2);
            low = std::min(low, particle);
            high = std::max(high, particle);
        }
        if (!oneRibbon || high > low + 1) return face;
    }
    return obj.faceLines.size();
}

/// Sum of the rungs' lengths; a ribbon read in the right order is narrow.
double totalWidth(const ObjStrandText& obj, RibbonOrder order, std::uint32_t size) {
    double sum = 0;
    for (std::size_t begin = 0; begin < obj.vertices.size(); begin += size) {
        for (std::uint32_t particle = 0; particle < size / 2; ++particle) {
            const Rung rung = rungOf(order, particle, size / 2);
            const double width = (obj.vertices[begin + rung.left] - obj.vertices[begin + rung.right]).norm();
            if (std::isfinite(width)) sum += width;
        }
    }
    return sum;
}

Result<RibbonOrder> findOrder(const std::string& file, const ObjStrandText& obj, std::uint32_t size,
                              RibbonOrder asked) {
    std::vector<RibbonOrder> fitting;
    std::size_t farthest = 0;
    for (const RibbonOrder order : kOrders) {
        if (asked != RibbonOrder::Detect && asked != order) continue;
        const std::size_t misfit = firstMisfit(obj, order, size);
        farthest = std::max(farthest, misfit);
        if (misfit == obj.faceLines.size()) fitting.push_back(order);
    }
    if (fitting.empty()) {
        return failIn(file, Line{obj.faceLines[farthest]},
                      "this face is not between neighbouring cross-sections of one hair ribbon",
                      fmt::format("expected ribbons of {} segments, or OBJ lines", size / 2 - 1));
    }
    return *std::min_element(fitting.begin(), fitting.end(), [&](RibbonOrder a, RibbonOrder b) {
        return totalWidth(obj, a, size) < totalWidth(obj, b, size);
    });
}

}  // namespace

Result<RawStrands> strandsFromRibbons(const std::string& file, const ObjStrandText& obj,
                                      const StrandImportOptions& options) {
    const auto size = ribbonSize(file, obj, options);
    if (!size) return tl::unexpected(size.error());
    const auto order = findOrder(file, obj, *size, options.ribbonOrder);
    if (!order) return tl::unexpected(order.error());

    RawStrands raw;
    raw.format = "Cinema 4D hair OBJ";
    raw.rootFirst = false;
    const std::uint32_t particles = *size / 2;
    raw.positions.reserve(obj.vertices.size() / 2);
    raw.offsets.reserve(obj.vertices.size() / *size + 1);
    for (std::size_t begin = 0; begin < obj.vertices.size(); begin += *size) {
        for (std::uint32_t particle = 0; particle < particles; ++particle) {
            const Rung rung = rungOf(*order, particle, particles);
            const Vec3f& left = obj.vertices[begin + rung.left];
            const Vec3f& right = obj.vertices[begin + rung.right];
            const bool centre = options.ribbonParticle == RibbonParticle::Centre;
            raw.positions.push_back(centre ? Vec3f(0.5f * left + 0.5f * right) : left);
        }
        raw.offsets.push_back(static_cast<std::uint32_t>(raw.positions.size()));
    }
    return raw;
}

}  // namespace hairloom
