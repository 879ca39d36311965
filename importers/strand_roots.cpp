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

/// What makes a point as it was read another: the unit, and the axis that points up.
struct Reading {
    const LengthUnit* unit = nullptr;  ///< as it was read where it is null
    bool otherUp = false;
};

/// Median distance of some roots to the head when they are read another way.
double medianDistance(const RawStrands& raw, const SurfaceTree& tree, const Reading& reading,
                      const StrandImportOptions& options) {
    constexpr std::size_t kEnough = 500;
    const std::size_t strands = raw.offsets.size() - 1;
    const std::size_t step = std::max<std::size_t>(1, strands / kEnough);
    const float scale =
        reading.unit ? static_cast<float>(reading.unit->metres) / options.metresPerUnit : 1.0f;
    std::vector<float> distances;
    for (std::size_t strand = 0; strand < strands; strand += step) {
        Vec3f root = scale * raw.positions[raw.offsets[strand]];
        // Z up was made Y up, or would be.
        if (reading.otherUp)
            root = options.up == UpAxis::Z ? Vec3f(root.x(), -root.z(), root.y())
                                           : Vec3f(root.x(), root.z(), -root.y());
        distances.push_back(tree.closest(root).distance);
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    return double{*middle};
}

/// "the unit inch and Z up (--unit inch --up z)"
std::string wordsFor(const Reading& reading, const StrandImportOptions& options) {
    const char* const axis = options.up == UpAxis::Z ? "y" : "z";
    std::string words, asked;
    if (reading.unit) {
        words = fmt::format("the unit {}", reading.unit->name);
        asked = fmt::format("--unit {}", reading.unit->name);
    }
    if (reading.otherUp) {
        words += fmt::format("{}{} up", words.empty() ? "" : " and ", axis[0] == 'z' ? 'Z' : 'Y');
        asked += fmt::format("{}--up {}", asked.empty() ? "" : " ", axis);
    }
    return fmt::format("{} ({})", words, asked);
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

Status checkRootDistance(RawStrands& raw, const ScalpMesh& scalp, const StrandImportOptions& options) {
    constexpr double kFar = 0.5;       ///< metres
    constexpr double kBeside = 0.01;   ///< metres: farther away another reading is looked for
    constexpr double kPlainly = 0.25;  ///< of the distance is left with one that is plainly right
    const SurfaceTree tree(scalp);
    const double far = std::max(kFar, double{scalp.bounds().sizes().maxCoeff()});
    const double found = medianDistance(raw, tree, {}, options);
    if (found <= kBeside) return {};
    Reading best;
    double nearest = found;
    const bool canTurn = !raw.statedUp, canScale = !raw.statedMetresPerUnit;
    for (const bool otherUp : {false, true}) {
        if (otherUp && !canTurn) continue;
        const auto consider = [&](const Reading& reading) {
            const double distance = medianDistance(raw, tree, reading, options);
            if (distance >= nearest) return;
            best = reading;
            nearest = distance;
        };
        consider({nullptr, otherUp});
        for (const LengthUnit& unit : lengthUnits()) {
            if (canScale) consider({&unit, otherUp});
        }
    }
    const bool isPlain = nearest < kPlainly * found && nearest <= far;
    const std::string with =
        isPlain ? fmt::format("with {} they would lie {:.3g} m from it", wordsFor(best, options), nearest)
                : std::string();
    if (found > far)
        return fail(
            fmt::format("its roots are {:.3g} m from the head (median)", found),
            isPlain
                ? with
                : "expected hair of this head; neither of the units m, dm, cm, mm and inch puts it there, "
                  "nor another axis up");
    if (isPlain)
        raw.warnings.push_back(
            fileWarning(fmt::format("its roots are {:.3g} m from the head (median)", found), "roots", with));
    return {};
}

}  // namespace hairloom
