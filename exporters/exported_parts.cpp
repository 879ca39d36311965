// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/exported_parts.h"

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

std::vector<Vec3f> pointVelocities(std::span<const std::span<const Vec3f>> frames, std::size_t frame,
                                   double framesPerSecond) {
    const std::size_t before = frame > 0 ? frame - 1 : 0, after = std::min(frame + 1, frames.size() - 1);
    const auto perSecond = static_cast<float>(framesPerSecond / static_cast<double>(after - before));
    std::vector<Vec3f> velocities(frames[frame].size());
    for (std::size_t p = 0; p < velocities.size(); ++p)
        velocities[p] = (frames[after][p] - frames[before][p]) * perSecond;
    return velocities;
}

std::vector<ExportedPart> exportedParts(const Groom& groom, const PreparedStrands& strands,
                                        NameGiver::Legal isLegal) {
    constexpr std::string_view kAlone = "hair";
    NameGiver giver(isLegal);
    std::vector<ExportedPart> parts;
    for (const PreparedPart& prepared : strands.parts) {
        ExportedPart part;
        const bool isNamed = prepared.layer < groom.layers.size();
        const std::string& layer = isNamed ? groom.layers[prepared.layer].name : Layer{}.name;
        part.name = strands.parts.size() == 1 ? std::string(kAlone) : giver.give(layer);
        // One layer of the name that layers have by themselves says nothing.
        if (part.name != layer && (strands.parts.size() > 1 || layer != Layer{}.name))
            part.displayName = layer;
        part.firstStrand = prepared.firstStrand;
        part.strandCount = prepared.strandCount;
        part.firstPoint = strands.offsets[part.firstStrand];
        part.pointCount = strands.offsets[part.firstStrand + part.strandCount] - part.firstPoint;
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace hairloom
