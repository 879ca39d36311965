// SPDX-License-Identifier: MIT
#pragma once
// What every way of moving strands asks of its input before it works with it.

#include <string>

#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Empty, or in words which settings lie outside their ranges, one line each.
std::string validationError(const SimulationSettings& settings);

/// Empty, or in words why these are not strands: offsets that do not match the points, fewer than 2 or more
/// than kMaxPoints points, a rotation that is none, a rest position that is no number within 1e6 m.
std::string validationError(const StrandsView& strands);

/// Adds a line to text when the value is not in low…high.
void refuseOutside(std::string& text, const char* name, double value, double low, double high);

/// Makes the rotation one of unit length; false where the root is no position.
inline bool usable(RootFrame& root) {
    return isFinite(root.position) && normalize(root.rotation);
}

inline constexpr float kFarthest = 1e6f;  ///< metres; squares of what lies farther leave single precision
/// usable(), and not beyond `limit` metres.
inline bool usableWithin(RootFrame& root, float limit) {
    return dot(root.position, root.position) <= limit * limit && normalize(root.rotation);
}

/// Linear in position, normalised linear in rotation. share 0…1; both rotations of unit length.
RootFrame between(const RootFrame& from, const RootFrame& to, float share);

}  // namespace hairloom::runtime
