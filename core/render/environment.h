// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// Light from all around, far away: radiance as real spherical harmonics up to order 2 (Ramamoorthi and
/// Hanrahan 2001), which is all that the broad lobes of skin and hair keep of it. Linear RGB. The order of
/// coefficients is 1, y, z, x, xy, yz, 3z² − 1, zx, x² − y².
struct Environment {
    std::array<Vec3f, 9> coefficients{};

    Environment() { coefficients.fill(Vec3f::Zero()); }
    /// Changes with height from `ground` (straight down) to `sky` (straight up).
    static Environment gradient(const Vec3f& sky, const Vec3f& ground);
    /// From an image of longitude and latitude: its middle is +Z, its right half +X, its upper edge +Y.
    /// Errors: no pixels, or values that are not finite.
    static Result<Environment> fromImage(const LinearImage& image, float scale = 1);

    bool dark() const;
    /// Of the harmonics, which may be negative where the image has strong contrasts.
    Vec3f radiance(const Vec3f& direction) const;
};

}  // namespace hairloom::render
