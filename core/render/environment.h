// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// A bright part of an image around the scene, which a directional light stands for.
struct BrightPart {
    Vec3f toLight_ws = Vec3f::UnitY();  ///< unit, the mean
    Vec3f irradiance = Vec3f::Zero();   ///< linear RGB, perpendicular to that
    float extent = 0;                   ///< radians, standard deviation of its directions by both axes
    int first = -1, second = -1;        ///< parts that it may be cut into, or -1
};

/// Light from all around, far away: radiance as real spherical harmonics up to order 2 (Ramamoorthi and
/// Hanrahan 2001), which is all that the broad lobes of skin and hair keep of it. Linear RGB. The order of
/// coefficients is 1, y, z, x, xy, yz, 3z² − 1, zx, x² − y².
struct Environment {
    std::array<Vec3f, 9> coefficients{};
    std::vector<BrightPart> bright;  ///< besides; only those of brightRoots and what they are cut into count
    std::vector<int> brightRoots;

    Environment() { coefficients.fill(Vec3f::Zero()); }
    /// Changes with height from `ground` (straight down) to `sky` (straight up).
    static Environment gradient(const Vec3f& sky, const Vec3f& ground);
    /// From an image of longitude and latitude: its middle is +Z, its right half +X, its upper edge +Y.
    /// Pixels more than four times as bright as the mean are bright parts. Errors: no pixels, values that are
    /// not finite.
    static Result<Environment> fromImage(const LinearImage& image, float scale = 1);

    /// Joins light from all of another.
    void add(const Environment& other);
    /// Joins that of one direction, as far as harmonics show it.
    void add(const Vec3f& toLight_ws, const Vec3f& irradiance);

    /// No light at all.
    bool dark() const;
    /// Of the harmonics, without bright parts, which may be negative where the image has strong contrasts.
    Vec3f radiance(const Vec3f& direction) const;
};

}  // namespace hairloom::render
