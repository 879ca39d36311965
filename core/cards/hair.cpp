// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/hair.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"

namespace hairloom::cards {

Status check(const Hair& hair) {
    if (hair.strandCount() == 0) return fail("there are no strands", "at least two to make cards of");
    if (hair.strandCount() == 1) return fail("there is one strand", "at least two to make cards of");
    const std::size_t points = hair.offsets.back();
    if (hair.positions_ws.size() != points || hair.radii.size() != points || hair.albedo.size() != points ||
        hair.rootNormals_ws.size() != hair.strandCount()) {
        return fail("arrays of hair of different lengths");
    }
    float longest = 0;
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        const auto strand = hair.strand(s);
        if (strand.size() < 2) return fail(fmt::format("strand {} has fewer than two points", s));
        for (const Vec3f& point : strand) {
            if (!point.allFinite()) return fail(fmt::format("strand {} is not finite", s));
        }
        longest = std::max(longest, polylineLength(strand));
    }
    if (!(longest > 0)) return fail("all strands are of no length", "strands of some length");
    return {};
}

EvenHair evenHair(const Hair& hair, std::uint32_t stations) {
    EvenHair even;
    even.stations = stations;
    const std::size_t strands = hair.strandCount();
    even.points_ws.resize(strands * stations);
    even.lengths.resize(strands);
    even.weights.resize(strands);
    parallelFor(strands, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const auto strand = hair.strand(s);
            const auto points = resampleEvenly(strand, stations);
            std::copy(points.begin(), points.end(),
                      even.points_ws.begin() + static_cast<std::ptrdiff_t>(s * stations));
            even.lengths[s] = polylineLength(strand);
            float area = 0;
            for (std::size_t p = hair.offsets[s]; p + 1 < hair.offsets[s + 1]; ++p) {
                const float length = (hair.positions_ws[p + 1] - hair.positions_ws[p]).norm();
                area += length * (hair.radii[p] + hair.radii[p + 1]);
            }
            even.weights[s] = area;
        }
    });
    return even;
}

tl::unexpected<Error> stopped() {
    return fail("stopped before it was done", "expected it to run to its end");
}

}  // namespace hairloom::cards
