// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a groom has of each of its poses; core/groom/poses.h is what can be done with them.

#include <cstdint>
#include <span>
#include <string>

#include "hairloom/field.h"
#include "hairloom/ramp.h"

namespace hairloom {

/// fieldsOf() describes the members but the name.
struct GroomPose {
    std::string name;  ///< unique in the groom, 1 to kMaxPoseName bytes
    float amount = 0;
    std::uint32_t mask = 0;
    bool invert = false;
    runtime::Ramp ramp;

    friend bool operator==(const GroomPose&, const GroomPose&) = default;
};
std::span<const runtime::Field<GroomPose>> fieldsOf(const GroomPose&);

}  // namespace hairloom
