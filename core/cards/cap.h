// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The cap under the cards: a thin surface just above the scalp that wears the first centimetre of all hairs,
// so that what is seen between cards is hair, and skin where hair gets sparse.

#include "core/cards/texture.h"

namespace hairloom::cards {

/// A part of the cap that faces one way; its texture looks straight on. World space, metres.
struct CapChart {
    Strip plane;                         ///< flat, of two stations: what its picture shows
    std::vector<std::uint32_t> strands;  ///< that its picture shows
    struct Vertex {
        Vec3f position_ws, normal_ws;  ///< unit, outwards
        Vec2f place;                   ///< in the picture, 0 … 1
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  ///< three a triangle, outwards
};

/// Hairs up to a length, laid on the planes that touch the skin at their roots. Those that stand straight up
/// lie as far aside as they cover skin for an eye that looks at it aslant. Strands have the numbers that they
/// have in `hair`.
Hair laidRoots(const Hair& hair);

/// Charts that hold all roots of `hair`, between them off the skin by `tolerance` (> 0, metres) and a little.
/// Empty where there are no strands. The same for any number of threads. Errors: stopped.
Result<std::vector<CapChart>> makeCap(const Hair& hair, float tolerance, Cancel cancel);

/// What a chart wears: strands as laidRoots() has them, `thickness` times as thick. `hair` gives their whole
/// lengths.
Picture bakeCap(const Hair& hair, const Hair& laid, const HairLight& light, const CapChart& chart,
                float thickness, std::uint32_t width, std::uint32_t height);

}  // namespace hairloom::cards
