// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is edited, and which parts of it changed.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {
class StackCache;
}

namespace hairloom::editing {

/// Parts of a document that observers care about; values are added up.
enum class Part : std::uint32_t {
    None = 0,
    Points = 1u << 0u,          ///< positions of strands that were there
    Strands = 1u << 1u,         ///< strands came or went: what is held per strand or point is void
    StrandFlags = 1u << 2u,     ///< selected, hidden, frozen
    Head = 1u << 3u,            ///< the mesh
    ScalpFaces = 1u << 4u,      ///< the selection that carries hair
    Density = 1u << 5u,         ///< of roots, per vertex of the mesh
    Placement = 1u << 6u,       ///< settings of it
    Spheres = 1u << 7u,         ///< collision spheres and body
    Physics = 1u << 8u,         ///< settings of the simulation
    Material = 1u << 9u,        ///< of the hair
    Interpolation = 1u << 10u,  ///< settings of follow hairs
    Layers = 1u << 11u,         ///< layers and group names
    Triangulation = 1u << 12u,  ///< of the roots
    History = 1u << 13u,        ///< what can be undone
    Dye = 1u << 14u,            ///< its mask, as it was painted
    Operators = 1u << 15u,      ///< of the stack, or their settings
    Masks = 1u << 16u,          ///< as they were painted, for operators
    Cards = 1u << 17u,          ///< levels' cards shaped by hand
    Widths = 1u << 18u,         ///< of hair, as they were painted
    Shadows = 1u << 19u,        ///< settings of them
    TimeLine = 1u << 20u,       ///< clips, keys and range
    MaskNames = 1u << 21u,      ///< of painted masks
    Everything = 0xffffffffu,
};
constexpr Part operator|(Part a, Part b) {
    return static_cast<Part>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
/// Any of `part`'s.
constexpr bool contains(Part parts, Part part) {
    return (static_cast<std::uint32_t>(parts) & static_cast<std::uint32_t>(part)) != 0;
}

constexpr Part without(Part parts, Part some) {
    return static_cast<Part>(static_cast<std::uint32_t>(parts) & ~static_cast<std::uint32_t>(some));
}

/// All of the strands: what shows where hair is, and which.
inline constexpr Part kHairParts =
    Part::Points | Part::Strands | Part::StrandFlags | Part::Layers | Part::Triangulation;
/// The head and where hair grows on it.
inline constexpr Part kScalpParts = Part::Head | Part::ScalpFaces | Part::Density;

struct Change {
    Part parts = Part::None;
    /// Ascending; the strands whose points or flags changed. Empty with Points or StrandFlags: any. Valid
    /// during the call.
    std::span<const std::uint32_t> strands;
};

/// The state that commands exchange parts of. What a project saves is in the groom.
struct Model {
    Groom groom;
    /// What the operators made last; null where nobody wants it kept.
    std::shared_ptr<StackCache> stackCache = nullptr;
};

}  // namespace hairloom::editing
