// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a mean over all pixels does not see of a level: skin that its hair leaves bare or hides, hairlines
// that moved or are dark, scales, holes, and motion. Each has a limit, and a level that is beyond one fails.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/cards/judge.h"

namespace hairloom::cards {

/// What is looked at of a picture: a number a pixel, row by row.
struct Print {
    std::uint32_t width = 0, height = 0;
    std::vector<float> hair;   ///< share that hair covers
    std::vector<float> skin;   ///< share that shows the head
    std::vector<float> light;  ///< luminance of all that is seen
};
Print printOf(const Shot& shot);
/// Of squares of `by` pixels, their mean.
Print coarser(const Print& print, std::uint32_t by);

/// Of a level beside all strands, over all directions. Nothing where there is nothing to measure: no head, no
/// hairline, no piece of hair as large as it takes.
struct Measures {
    /// The largest connected piece of skin that strands cover and the level leaves bare, or that it covers
    /// and strands leave bare, as a flap before the forehead does; of one direction.
    std::optional<double> largestPatchCm2;
    /// Distance between the lines where hair gets to cover a fifth of the skin, root mean square of both
    /// ways. What is farther than 5 mm counts as that.
    std::optional<double> hairlineMm;
    /// Luminance that the darkest tenth of the 3 mm inside of that line stays below, times what strands have:
    /// below 1 is a dark rim.
    std::optional<double> rim;
    /// Power of light at 4 to 16 pixels, each octave alike, times that of the strands: above 1 are scales.
    std::optional<double> scaliness;
    /// How far points of hair are from where strands have them while the head nods, mean over points,
    /// directions and time, pixels.
    std::optional<double> motionPx;
    /// Share of what hair covers where the background shows through the level but not through the strands.
    std::optional<double> holes;
};

/// A measure as tables name it, and what a level may have of it.
struct Measure {
    std::string_view name;   ///< as JSON has it: "largest_patch_cm2"
    std::string_view label;  ///< "patch"
    std::string_view unit;   ///< "cm²"; empty: a factor
    std::optional<double> Measures::*value;
    double least = 0, most = 0;  ///< of a level that does not fail
    double scale = 1;            ///< of the unit shown: shares are in per cent
    /// What cannot be told apart where pixels are that many mm wide; null: pixels do not matter.
    double (*seen)(double pixelMm) = nullptr;

    /// `most`, or what pixels of that size let one see.
    double limit(double pixelMm) const;
    bool fails(const Measures& of, double pixelMm) const;
};
/// All, in the order of Measures.
std::span<const Measure> allMeasures();

/// Names of the measures that fail.
std::vector<std::string> failsOf(const Measures& measures, double pixelMm);
/// "patch 3.65 cm² (at most 0.1), rim 0.62 (0.8 to 1.2)": those that fail; empty where none does.
std::string failureWords(const Measures& measures, double pixelMm);

/// What a direction adds to the measures.
struct ViewMeasures {
    bool hasSkin = false;
    double patchMm2 = 0;
    double hairlineSquares = 0, hairlinePixels = 0;  ///< mm², number
    std::vector<float> strandsRim, levelRim;         ///< luminance of each pixel there
    double strandsPower = 0, levelPower = 0;
    double holes = 0, covered = 0;  ///< pixels
};
/// Pictures of one size.
ViewMeasures measureView(const Print& strands, const Print& level, double pixelMm);
/// All but motion.
Measures combined(std::span<const ViewMeasures> views);

}  // namespace hairloom::cards
