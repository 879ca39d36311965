// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/morph_meter.h"

#include <algorithm>

namespace hairloom {

MorphMeter::MorphMeter(const Groom& groom) : scalp_(groom.scalp), roots_(groom.rootBindings()) {}

void MorphMeter::add(const HeadPose& pose) {
    if (!scalp_ || pose.morphed_ss.size() != scalp_->vertexCount()) return;
    for (const SurfacePoint& root : roots_) {
        const Triangle& corners = scalp_->triangles()[root.triangle];
        Vec3f offset = Vec3f::Zero();
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t v = corners[static_cast<std::size_t>(c)];
            offset += root.barycentric[c] * (pose.morphed_ss[v] - scalp_->positions()[v]);
        }
        const float outward = offset.dot(scalp_->triangleNormal(root.triangle));
        found_.farthest = std::max(found_.farthest, offset.norm());
        found_.out = std::max(found_.out, outward);
        found_.in = std::max(found_.in, -outward);
    }
}

}  // namespace hairloom
