// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/exported_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {

std::vector<std::int32_t> ExportedPart::vertexCounts(const PreparedStrands& strands) const {
    std::vector<std::int32_t> counts(strandCount);
    for (std::size_t s = 0; s < counts.size(); ++s)
        counts[s] = static_cast<std::int32_t>(strands.offsets[firstStrand + s + 1] -
                                              strands.offsets[firstStrand + s]);
    return counts;
}

std::array<Vec3f, 2> ExportedPart::extent(const PreparedStrands& strands, std::span<const Vec3f> all) const {
    Box3f bounds;
    for (const Vec3f& position : points(all)) bounds.extend(position);
    const Vec3f half = Vec3f::Constant(0.5f * std::ranges::max(widths(strands)));
    return {bounds.min() - half, bounds.max() + half};
}

std::span<const float> ExportedPart::numbers(const ExportedAttribute& attribute) const {
    const std::size_t size = attribute.components;
    return attribute.perPoint ? std::span(attribute.numbers).subspan(firstPoint * size, pointCount * size)
                              : std::span(attribute.numbers).subspan(firstStrand * size, strandCount * size);
}

std::span<const std::int32_t> ExportedPart::wholes(const ExportedAttribute& attribute) const {
    return attribute.perPoint ? std::span(attribute.whole).subspan(firstPoint, pointCount)
                              : std::span(attribute.whole).subspan(firstStrand, strandCount);
}

std::vector<Vec3f> pointVelocities(std::span<const std::span<const Vec3f>> samples, std::size_t sample,
                                   const StrandFrames& frames) {
    const std::size_t before = sample > 0 ? sample - 1 : 0, after = std::min(sample + 1, samples.size() - 1);
    const auto seconds = [&](std::size_t from, std::size_t to) {
        return (frames.numberOf(to) - frames.numberOf(from)) / frames.framesPerSecond;
    };
    std::vector<Vec3f> velocities(samples[sample].size());
    // Where steps are unlike, the shorter one counts for more.
    const double all = seconds(before, after);
    const double share = after > sample && sample > before ? seconds(before, sample) / all : 0.5;
    const auto ofNext = static_cast<float>((before == sample  ? 1
                                            : after == sample ? 0
                                                              : share) /
                                           std::max(seconds(sample, after), 1e-12));
    const auto ofLast = static_cast<float>((before == sample  ? 0
                                            : after == sample ? 1
                                                              : 1 - share) /
                                           std::max(seconds(before, sample), 1e-12));
    for (std::size_t p = 0; p < velocities.size(); ++p)
        velocities[p] = (samples[after][p] - samples[sample][p]) * ofNext +
                        (samples[sample][p] - samples[before][p]) * ofLast;
    return velocities;
}

std::vector<ExportedPart> exportedParts(const Groom& groom, const PreparedStrands& strands,
                                        NameGiver::Legal isLegal) {
    constexpr std::string_view kAlone = "hair", kGuides = "guides";
    NameGiver giver(isLegal);
    std::vector<ExportedPart> parts;
    const bool isOneLayer = std::ranges::all_of(
        strands.parts, [&](const PreparedPart& part) { return part.layer == strands.parts.front().layer; });
    for (const PreparedPart& prepared : strands.parts) {
        ExportedPart part;
        const bool isNamed = prepared.layer < groom.layers.size();
        const std::string& layer = isNamed ? groom.layers[prepared.layer].name : Layer{}.name;
        part.areGuides = prepared.areGuides;
        if (isOneLayer)
            part.name = part.areGuides ? kGuides : kAlone;
        else
            part.name = giver.give(part.areGuides ? fmt::format("{}_{}", layer, kGuides) : layer);
        // One layer of the name that layers have by themselves says nothing.
        if (part.name != layer && (!isOneLayer || layer != Layer{}.name)) part.displayName = layer;
        // What the hairs' prim has for a name, so that both are one layer.
        if (part.areGuides && part.displayName.empty()) part.displayName = kAlone;
        part.firstStrand = prepared.firstStrand;
        part.strandCount = prepared.strandCount;
        part.firstPoint = strands.offsets[part.firstStrand];
        part.pointCount = strands.offsets[part.firstStrand + part.strandCount] - part.firstPoint;
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace hairloom
