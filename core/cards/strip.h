// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The strip that a bundle of strands lies on: a centre curve, and at each of its stations a direction across,
// a width and a bend.

#include <cstdint>
#include <span>
#include <vector>

#include "core/cards/hair.h"

namespace hairloom::cards {

/// Arrays are one a station, root first; world space, metres. A point of the surface at station k and x in
/// [-1, 1] across is centre + x·halfWidth·cross + bend·((x·halfWidth)² - spread)·normal.
struct Strip {
    std::vector<Vec3f> centre;
    std::vector<Vec3f> along;   ///< unit, towards the tip
    std::vector<Vec3f> cross;   ///< unit, perpendicular to `along`
    std::vector<Vec3f> normal;  ///< unit, outwards: along × cross
    std::vector<float> halfWidth;
    std::vector<float> bend;    ///< 1/m; 0 is flat
    std::vector<float> spread;  ///< m², mean square of the strands' places across

    std::size_t stations() const { return centre.size(); }
    float length() const;
    /// `x` as above.
    Vec3f at(std::size_t station, float x) const;
};

/// The strip of least weighted square distance from its strands, which hold at least one. Its stations are
/// those of the hair, so that point k of a strand belongs to station k.
Strip fitStrip(const EvenHair& hair, std::span<const std::uint32_t> strands,
               std::span<const Vec3f> rootNormals_ws);

/// How far a strand is from lying on the strip, mean m² over its points. A distance off the surface counts
/// whole; one across or along it little, since the strip is that much wider or longer. `enough`: stops at
/// what is more than that.
float offStrip(const Strip& strip, std::span<const Vec3f> points_ws, float enough);

/// The same as a vector of 3 numbers a station, whose squared norm is that distance for a strip that is flat.
void residual(const Strip& strip, std::span<const Vec3f> points_ws, std::span<float> out);

/// A strip of evenly spaced stations through the same bundle, as long as it takes to hold the ends of most
/// strands, as wide as holds nearly all.
Strip finishStrip(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& fitted,
                  std::uint32_t stations, std::span<const Vec3f> rootNormals_ws);

/// The strip that stands on `on` at right angles, flat: at each station it goes outwards and inwards as far
/// as nearly all strands are off `by`, the strip that is by them. Both have as many stations.
Strip crossingStrip(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& by,
                    const Strip& on);

/// The same with `along` and `normal` by its centre and `cross`.
Strip framed(Strip strip);

/// Where a point is on a strip.
struct StripPlace {
    float along = 0;          ///< 0 root … 1 tip, by length; beyond for points before or behind it
    float across = 0;         ///< metres
    float off = 0;            ///< metres outwards from the flat strip
    std::size_t station = 0;  ///< the one before it
    float share = 0;          ///< of the way to the next; below 0 and above 1 beyond the ends
    /// The station that it is nearest to.
    std::size_t nearest() const { return station + (share > 0.5f ? 1 : 0); }
};
/// The places of a strand's points, root first. A root is placed by its way over the scalp from where the
/// strip begins, points behind it by their way along the strand, and those farther on by the foot that is
/// nearest: where a strip rises from the scalp, feet alone would lie on its crease, all of them.
std::vector<StripPlace> placesOn(const Strip& strip, std::span<const Vec3f> points_ws);

}  // namespace hairloom::cards
