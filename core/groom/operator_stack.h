// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The operators of a groom: edits of its strands that stay open. The points of a groom that has some are what
// the operators make of its base shape, in order; core/operations/stack.h runs them.

#include <cstdint>
#include <string>
#include <string_view>

namespace hairloom {

struct Operator {
    std::string op;               ///< a name of stackOperators()
    std::string settings = "{}";  ///< what it has in a script beside its name, as a JSON object
    bool enabled = true;
    float weight = 1;          ///< 0 … 1, share of what it does to strands
    std::uint32_t number = 0;  ///< of a sculpt: its strokes are the point attribute sculptAttribute(number)

    bool operator==(const Operator&) const = default;
};

inline constexpr std::size_t kMaxOperators = 64;
/// The operator that holds brush strokes.
inline constexpr const char* kSculpt = "sculpt";

/// "sculpt.3": float3 per point, in the frame of the segment that ends there, as a share of its length; what
/// is added to the segment. 0 at roots.
inline constexpr std::string_view kSculptPrefix = "sculpt.";
inline std::string sculptAttribute(std::uint32_t number) {
    return std::string(kSculptPrefix) + std::to_string(number);
}

}  // namespace hairloom
