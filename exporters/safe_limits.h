// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a game may do to a hairstyle without breaking it, as its certificate says
// (core/stability/certificate.h).

#include <cstdint>
#include <span>

#include "hairloom/field.h"

namespace hairloom {

/// All at once, with the certificate's margin to spare; zeros where nothing that was tried is safe.
struct SafeLimits {
    float largestStep = 0;                 ///< seconds
    float rootSpeed = 0;                   ///< of the head, m/s
    float turn = 0;                        ///< of the head, degrees a frame
    float wind = 0;                        ///< m/s
    std::uint32_t storms = 0, failed = 0;  ///< that were tried, and of those, that broke it beyond the limits
};
std::span<const runtime::Field<SafeLimits>> fieldsOf(const SafeLimits&);

}  // namespace hairloom
