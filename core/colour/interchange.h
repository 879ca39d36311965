// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a space of a config stands to the primaries of Rec. 709, which everything here is computed in.

#include <OpenColorIO/OpenColorIO.h>

#include <string>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/render/linear_space.h"

namespace hairloom::colour {

/// Linear RGB of these chromaticities as those of ACES2065-1 (SMPTE ST 2065-1), adapted to its white after
/// Bradford as OpenColorIO's own transforms are.
Eigen::Matrix3d acesFrom(const render::LinearSpace& space);

/// Where linear Rec. 709 enters a config.
struct Entry {
    std::string space;       ///< of the config
    bool isAces = false;     ///< it is ACES2065-1; else it is linear Rec. 709 itself
    bool isAssumed = false;  ///< nothing in the config says so
};

/// By the role aces_interchange, else by the names under which configs have linear Rec. 709, else `working`.
Entry entryOf(const OCIO_NAMESPACE::Config& config, const std::string& working);

/// From linear Rec. 709 to `working`.
OCIO_NAMESPACE::GroupTransformRcPtr fromRec709(const Entry& entry, const std::string& working);

/// From `working` to the entry.
OCIO_NAMESPACE::ColorSpaceTransformRcPtr toEntry(const Entry& entry, const std::string& working);

/// What `working` is, by the matrix that leads from it to ACES2065-1. Errors: it is not linear.
Result<render::LinearSpace> linearSpaceOf(const OCIO_NAMESPACE::Config& config, const Entry& entry,
                                          const std::string& working);

}  // namespace hairloom::colour
