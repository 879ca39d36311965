// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The cap under the cards: a thin surface just above the scalp that wears the first centimetre of all hairs,
// so that what is seen between cards is hair, and skin where hair gets sparse.

#include <array>

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
    /// Share of the skin that strands hide, seen straight on, by squares of the plane, row by row.
    std::vector<float> hidden;
    /// Mean coverage that its picture is to have, by the same squares. Empty: as leaveToCards() has it.
    std::vector<float> wanted;
};

/// Hairs up to a length, laid on the planes that touch the skin at their roots. Those that stand straight up
/// lie as far aside as they cover skin for an eye that looks at it aslant. Strands have the numbers that they
/// have in `hair`.
struct LaidRoots {
    Hair hair;
    std::vector<Vec3f> grown_ws;  ///< where each point was before
};
LaidRoots laidRoots(const Hair& hair);

/// Charts that hold all roots of `hair`, between them off the skin by `tolerance` (> 0, metres) and a little.
/// Empty where there are no strands. The same for any number of threads. Errors: stopped.
Result<std::vector<CapChart>> makeCap(const Hair& hair, float tolerance, Cancel cancel);

/// What a chart wears: strands as laidRoots() has them, `thickness` times as thick. `hair` gives their whole
/// lengths.
Picture bakeCap(const Hair& hair, const LaidRoots& laid, const HairLight& light, const CapChart& chart,
                float thickness, std::uint32_t width, std::uint32_t height);

/// Sets CapChart::hidden.
void setHidden(const Hair& hair, CapChart& chart);

/// A triangle of a card, and the picture that it shows there.
struct WornTriangle {
    const Picture* picture;
    std::array<Vec3f, 3> at_ws;
    std::array<Vec2f, 3> place;  ///< in the picture, 0 … 1
};

/// Makes what bakeCap() made as dense as CapChart::wanted says. Without that, thins it where cards cover the
/// skin and strands leave some of it bare: cap and cards show the same hairs, and twice as many hide too
/// much.
void leaveToCards(std::span<const WornTriangle> cards, const CapChart& chart, Picture& picture);

}  // namespace hairloom::cards
