// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/body_push.h"

#include "core/base/parallel.h"
#include "core/simulation/scene_input.h"

namespace hairloom {

static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));

std::optional<runtime::BodyPush> makeBodyPush(const Groom& groom, std::span<const std::uint32_t> offsets,
                                              std::span<const Vec3f> rest_ss) {
    if (!groom.body || rest_ss.empty()) return std::nullopt;
    return runtime::BodyPush(groom.body, {offsets.begin(), offsets.end()},
                             {reinterpret_cast<const runtime::Float3*>(rest_ss.data()), rest_ss.size()});
}

void pushOutOfBody(const runtime::BodyPush& push, const Groom& groom, const HeadPose& pose,
                   std::span<Vec3f> points_ws) {
    runtime::Host host;
    host.parallelFor = parallelFor;
    push.apply(bodyAt(groom, pose), {reinterpret_cast<runtime::Float3*>(points_ws.data()), points_ws.size()},
               host);
}

}  // namespace hairloom
