// SPDX-License-Identifier: MIT
#include "engine/moving_body.h"

#include <algorithm>
#include <cmath>

namespace hairloom::runtime {

void MovingBody::take(const BodyField& field, std::span<const BonePose> from, std::span<const BonePose> to,
                      std::uint32_t substeps) {
    at_.resize(std::size_t{substeps} + 1);
    between_.resize(to.size());
    const auto mix = [](Float3 a, Float3 b, float t) { return a + (b - a) * t; };
    for (std::uint32_t i = 0; i <= substeps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(substeps);
        for (std::size_t b = 0; b < to.size(); ++b) {
            between_[b] = i == substeps
                              ? to[b]
                              : BonePose{mix(from[b].x, to[b].x, t), mix(from[b].y, to[b].y, t),
                                         mix(from[b].z, to[b].z, t), mix(from[b].origin, to[b].origin, t)};
        }
        at_[i].take(field, between_);
    }
}

bool MovingBody::touch(std::uint32_t substep, Float3 point_ws, float reach, BodyTouch& touch) const {
    const PosedBody& now = at_[substep + 1];
    const PosedBody::Contact contact = now.at(point_ws);
    if (!(contact.distance <= reach)) return false;
    touch = {contact.normal_ws, contact.distance,
             now.place(contact.point_ss) - at_[substep].place(contact.point_ss)};
    return true;
}

Floats bodyClearances(const RestShape& shape, const BodyField& body) {
    Floats clearances(shape.planeFloats, 0.0f);
    for (const Block& block : shape.blocks) {
        const std::size_t size = planeSize(block);
        const float* const rest = shape.planes.data() + block.firstPlane * kRestPlanes;
        float* const own = clearances.data() + block.firstPlane;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const RootFrame& root = shape.restRoots[block.strandOfLane[lane]];
            Float3 at = root.position;
            for (std::uint32_t p = 0; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                own[i] = std::min(body.at(at).distance, 1.0f);
                at = at + rotate(root.rotation, Float3{rest[i], rest[size + i], rest[2 * size + i]});
            }
        }
    }
    return clearances;
}

}  // namespace hairloom::runtime
