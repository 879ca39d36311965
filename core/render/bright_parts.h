// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The bright parts of an image of longitude and latitude, which lights stand for better than harmonics.

#include <vector>

#include "core/render/environment.h"

namespace hairloom::render {

/// A pixel that is bright against the mean.
struct BrightPixel {
    std::uint32_t x = 0, y = 0;
    Vec3d toLight_ws = Vec3d::Zero();
    Vec3d irradiance = Vec3d::Zero();  ///< linear RGB: its radiance times its solid angle
};

/// Cuts them in two again and again, along a row or column of the image where the summed variance of
/// directions, weighted by light, gets least (Viriyothai and Debevec 2009), the worst part first, until there
/// are `count` or none is wider than `extent` radians. Appends to `parts`; returns the place of the first,
/// which stands for all.
int cutBrightPixels(std::vector<BrightPixel> pixels, std::size_t count, double extent,
                    std::vector<BrightPart>& parts);

}  // namespace hairloom::render
