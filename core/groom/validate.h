// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Every invariant of a groom that does not hold, said so that it can be mended.

#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

enum class Severity { Info, Warning, Error };
std::string_view severityName(Severity severity);

struct Finding {
    Severity severity;
    std::string what;   ///< "positions are not finite"
    std::string where;  ///< "strand 17, point 3 and 4 more", or the field's name
    std::string fix;    ///< what to do about it; may be empty
};

/// Structure (offsets, array lengths and types), geometry (finite, ≥ 2 points, no zero-length segment,
/// plausible size), binding (triangle in the selection, barycentrics, root on the scalp), spheres, layers,
/// groups, and every setting within its range. One finding per kind with the first place and the number of
/// places. Errors are what would break a consumer; an empty list means none.
std::vector<Finding> validate(const Groom& groom);

/// What every consumer leans on before it looks at a value: offsets, array lengths and types, indices into
/// strands, scalp, layers and groups. Error: the first thing that does not hold. Loading and saving a project
/// check it.
Status checkStructure(const Groom& groom);

/// The part of validate() that concerns layers, spheres, settings and the time line; all of them errors.
std::vector<Finding> validateSettings(const Groom& groom);

/// The part of validate() that concerns widths no hair has: what Blender gives hair without any.
std::vector<Finding> findThickHair(const Groom& groom);

bool hasErrors(const std::vector<Finding>& findings);

}  // namespace hairloom
