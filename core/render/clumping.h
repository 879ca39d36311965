// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How unevenly hair fills space: what it lets through of a beam by what as many fibres would that stand at
// random.

#include <array>
#include <span>

namespace hairloom::render {

struct RenderStrands;

/// Of light on its way to points of the hair exp(−of(width) · n) arrives, where a beam so wide crosses n
/// fibres in the mean: 1 for fibres at random, less for hair in clumps, and more where the beam is hardly
/// wider than a fibre.
struct Clumping {
    /// Metres, widest first, each half of the one before.
    static constexpr std::array<float, 4> kWidths{0.005f, 0.0025f, 0.00125f, 0.000625f};
    std::array<float, kWidths.size()> values{1, 1, 1, 1};

    float widest() const { return values.front(); }
    /// Of any width in metres: between those that were measured by the logarithm, beyond them as theirs.
    float of(float width) const;
};

/// Traces rays from some points of the hair, the same for the same hair. 1 where no fibre is in anything's
/// way.
Clumping measureClumping(std::span<const RenderStrands> strands);

}  // namespace hairloom::render
