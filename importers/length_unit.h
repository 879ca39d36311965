// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a size can be a head's or a human's, and in which unit it could.

#include <optional>
#include <span>
#include <string>

namespace hairloom {

struct LengthUnit {
    const char* name;
    double metres;  ///< in one of it
};
/// m, dm, cm, mm and inch.
std::span<const LengthUnit> lengthUnits();

/// That in which `size` units can be a head, a bust or a whole human, and the most usual one; null where
/// none.
const LengthUnit* fittingUnit(double size);

/// Empty when `size` units of `metresPerUnit` metres, the largest extent of a mesh, can be a head, a bust or
/// a whole human (0.12 … 2.6 m). Else a sentence that names the size and the unit (m, dm, cm, mm, inch) that
/// would fit best.
std::optional<std::string> implausibleSize(double size, double metresPerUnit);

}  // namespace hairloom
