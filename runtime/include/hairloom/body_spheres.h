// SPDX-License-Identifier: MIT
#pragma once
// Spheres that stand for the skin of a body, which a field tells better.

#include <cstdint>
#include <span>

#include "hairloom/body_field.h"
#include "hairloom/memory.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Of each sphere of the body at rest, 1 where it stands for the skin, as Engine::setSkinSpheres() takes
/// them: its centre lies inside, and it comes out of the skin by a quarter of its radius at most. The same
/// holds along a capsule, or both ends stand for none. Hands and hats lie outside or bulge by more. Places
/// that the field does not reach tell nothing of a sphere, and a sphere whose centre it does not reach stands
/// for none.
Vector<std::uint8_t> spheresOfSkin(const BodyField& field, std::span<const Sphere> spheres_ss,
                                   std::span<const Capsule> capsules);

}  // namespace hairloom::runtime
