// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a single fibre makes of light from around. Radiance that varies slowly over the directions d, as
// e + b·d + dᵀQd with a symmetric Q without trace (spherical harmonics up to the second order), leaves the
// fibre towards the view as six moments of S cos θ_i times values of it in the fibre's frame: t along it,
// root to tip, f across it towards the view. No other moment is there, for S is even in φ.

#include "core/shading/tables.h"

namespace hairloom::shading {

/// ∫ S cos θ_i w(d) dω over all directions of light d. RGB.
struct SkyMoments {
    Vec3d even = Vec3d::Zero();          ///< w = 1
    Vec3d along = Vec3d::Zero();         ///< d·t
    Vec3d across = Vec3d::Zero();        ///< d·f
    Vec3d alongAlong = Vec3d::Zero();    ///< (3(d·t)² − 1)/2
    Vec3d alongAcross = Vec3d::Zero();   ///< (d·t)(d·f)
    Vec3d acrossAcross = Vec3d::Zero();  ///< (d·f)² − (d·(t×f))²
    /// cos³θ_i cos 3φ, for light from one side of hair, which has an edge.
    Vec3d third = Vec3d::Zero();
};

/// The moments over (sin θ_o + 1)/2: a row each, in the order of SkyMoments.
Table bakeSky(const DualScattering& model, std::uint32_t size = 32);

}  // namespace hairloom::shading
