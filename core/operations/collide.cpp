// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/collide.h"

#include "core/operations/operation.h"

namespace hairloom {
namespace {

using S = CollideSettings;

constexpr Field<S> kFields[] = {
    field<&S::distance>(
        "distance", "m", 0, 0.1,
        "minimum distance of points from the skin; near the root, half the distance along the strand"),
};

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> collide(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("collide", settings); !status) return tl::unexpected(status.error());
    if (!groom.scalp) return fail("collide: the groom has no scalp", "bind it to one first");
    return editStrands(groom, region, {settings.distance}, [](StrandEdit&) {});
}

Operation collideOperation() {
    return operation<S, collide>("collide", 90, "pushes strands out of the head");
}

}  // namespace hairloom
