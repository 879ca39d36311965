// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <vector>

#include "core/base/smooth_step.h"
#include "core/operations/lay_along.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct ShrinkwrapSettings {
    float strength = 0.8f;
    float distance = 0.004f;
    float reach = 0.06f;
    float variation = 0.5f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
    std::uint32_t group = 0;
};
using S = ShrinkwrapSettings;

constexpr Field<S> kFields[] = {
    field<&S::strength>("strength", "", 0, 1, "how far points move to the skin, as a share of the distance"),
    field<&S::distance>("distance", "m", 0, 0.1, "target height above the skin"),
    field<&S::reach>("reach", "m", 0.001, 1, "height above the skin beyond which hair is not affected"),
    field<&S::variation>("variation", "", 0, 1, "largest random reduction of the height per strand"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the variation"),
    field<&S::group>(
        "group", "", 0, 65535,
        "group of the head file to wrap to, such as a cap or a helmet, numbered from 1: 0 is the whole head"),
};
constexpr const char* kFormulaFields[] = {"strength", "distance", "reach", "variation"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

/// That group alone.
Result<std::shared_ptr<const Skin>> skinOfGroup(const ScalpMesh& head, std::uint32_t number) {
    const std::size_t count = head.triangleGroups().empty() ? 0 : head.groupNames().size();
    if (number > count)
        return fail(fmt::format("shrinkwrap: group {} of the head's file", number),
                    fmt::format("expected 0 to {}", count));
    PolygonSoup soup;
    soup.positions.assign(head.positions().begin(), head.positions().end());
    for (std::uint32_t face = 0; face < head.triangleCount(); ++face) {
        if (head.triangleGroups()[face] != number - 1) continue;
        const Triangle& corners = head.triangles()[face];
        soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    }
    auto mesh = ScalpMesh::make(soup);
    if (!mesh) return tl::unexpected(mesh.error());
    return std::make_shared<const Skin>(std::make_shared<const ScalpMesh>(std::move(*mesh)));
}

Result<std::size_t> shrinkwrap(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("shrinkwrap", varied.base()); !status)
        return tl::unexpected(status.error());
    if (!groom.scalp) return fail("shrinkwrap: the groom has no scalp", "bind it to one first");
    std::shared_ptr<const Skin> group;
    if (varied.base().group > 0) {
        auto made = skinOfGroup(*groom.scalp, varied.base().group);
        if (!made) return tl::unexpected(made.error());
        group = std::move(*made);
    }
    const EditOptions options{varied.base().clearance, Turns::asBefore, true};
    return editStrands(groom, region, options, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const Skin& onto = group ? *group : *strand.skin;
        const float height =
            settings.distance * (1 - settings.variation * strand.random(settings.seed).uniform());
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            arc += strand.lengths[i - 1];
            const SkinDistance skin = onto.distanceAt(strand.points[i]);
            const float fade = 1 - smoothStep(0.5f * settings.reach, settings.reach, skin.distance);
            const float wanted = std::min(height, 0.5f * arc);
            strand.points[i] += settings.strength * fade * (wanted - skin.distance) * skin.outward;
        }
        // Along the way that they were drawn to, which hugs the skin: directions alone would leave where it
        // curves.
        layAlong(strand.points, strand.lengths,
                 std::vector<Vec3f>(strand.points.begin(), strand.points.end()));
    });
}

}  // namespace

Operation shrinkwrapOperation() {
    return variedOperation<S, shrinkwrap, kFormulaFields>(
        "shrinkwrap", 26, "wraps strands to the skin of the head or to a group of its file");
}

}  // namespace hairloom
