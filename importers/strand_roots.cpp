// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/strand_roots.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/parallel.h"
#include "core/geometry/closest_point.h"
#include "importers/length_unit.h"

namespace hairloom {
namespace {

template <class T>
void reverseRun(std::vector<T>& values, std::size_t begin, std::size_t end) {
    if (values.empty()) return;
    std::reverse(values.begin() + static_cast<std::ptrdiff_t>(begin),
                 values.begin() + static_cast<std::ptrdiff_t>(end));
}

void reverseAttribute(RawAttribute& attribute, std::size_t begin, std::size_t end) {
    if (!attribute.perPoint) return;
    reverseRun(attribute.whole, begin, end);
    if (attribute.components == 1) return reverseRun(attribute.numbers, begin, end);
    for (std::size_t low = begin, high = end; low + 1 < high; ++low, --high) {
        for (std::size_t c = 0; c < attribute.components; ++c)
            std::swap(attribute.numbers[low * attribute.components + c],
                      attribute.numbers[(high - 1) * attribute.components + c]);
    }
}

void turn(RawStrands& raw, std::size_t begin, std::size_t end) {
    reverseRun(raw.positions, begin, end);
    reverseRun(raw.thickness, begin, end);
    reverseRun(raw.transparency, begin, end);
    reverseRun(raw.colours, begin, end);
    for (RawAttribute& attribute : raw.attributes) reverseAttribute(attribute, begin, end);
    for (std::vector<Vec3f>& frame : raw.frames) reverseRun(frame, begin, end);
}

/// Median distance of some roots to the head when all lengths are multiplied by `scale`.
double medianDistance(const RawStrands& raw, const SurfaceTree& tree, float scale) {
    constexpr std::size_t kEnough = 500;
    const std::size_t strands = raw.offsets.size() - 1;
    const std::size_t step = std::max<std::size_t>(1, strands / kEnough);
    std::vector<float> distances;
    for (std::size_t strand = 0; strand < strands; strand += step)
        distances.push_back(tree.closest(raw.positions[raw.offsets[strand]] * scale).distance);
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    return double{*middle};
}

}  // namespace

void orientToScalp(RawStrands& raw, const ScalpMesh& scalp) {
    constexpr float kClear = 2.0f;  ///< an end is plainly nearer when the other is this many times as far
    const SurfaceTree tree(scalp);
    const std::size_t strands = raw.offsets.size() - 1;
    std::vector<std::uint8_t> isTurned(strands);
    parallelFor(strands, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t strand = begin; strand < end; ++strand) {
            const float first = tree.closest(raw.positions[raw.offsets[strand]]).distance;
            const float last = tree.closest(raw.positions[raw.offsets[strand + 1] - 1]).distance;
            isTurned[strand] = last * kClear < first;
        }
    });
    if (2 * static_cast<std::size_t>(std::ranges::count(isTurned, 1)) <= strands) return;
    for (std::size_t strand = 0; strand < strands; ++strand)
        turn(raw, raw.offsets[strand], raw.offsets[strand + 1]);
    raw.warnings.push_back(fileNote(
        fmt::format("{} strands were reversed, because the last point of most is nearer to the scalp",
                    strands),
        "strands"));
}

Status checkRootDistance(const RawStrands& raw, const ScalpMesh& scalp, float metresPerUnit) {
    constexpr double kFar = 0.5;  ///< metres
    const SurfaceTree tree(scalp);
    const double far = std::max(kFar, double{scalp.bounds().sizes().maxCoeff()});
    const double found = medianDistance(raw, tree, 1);
    if (found <= far) return {};
    const LengthUnit* best = nullptr;
    double nearest = far;
    for (const LengthUnit& unit : lengthUnits()) {
        const double distance = medianDistance(raw, tree, static_cast<float>(unit.metres) / metresPerUnit);
        if (distance >= nearest) continue;
        best = &unit;
        nearest = distance;
    }
    return fail(fmt::format("its roots are {:.3g} m from the head (median)", found),
                best ? fmt::format("with the unit {} they would be {:.3g} m from it", best->name, nearest)
                     : "expected hair of this head. None of the units m, dm, cm, mm and inch puts it there");
}

}  // namespace hairloom
