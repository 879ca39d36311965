// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <numbers>

namespace hairloom::cards {
namespace {

/// Where one of strands and level covers skin and the other does not.
constexpr float kCovers = 0.2f, kBare = 0.6f;  // shares of skin
constexpr float kHalf = 0.5f;
constexpr double kLine = 0.2;     // of skin that hair covers at the hairline: sparse hair is most alike there
constexpr double kSmoothMm = 4;   // of the hairline: single hairs make none
constexpr double kRimMm = 3;      // how wide a rim is
constexpr double kDarkest = 0.1;  // of the rim
constexpr double kFarthestMm = 5;  // that hairlines count as apart: a lock over a cheek is not all there is
constexpr double kEdgeMm = 1;      // inside of outlines, where holes are looked for

using Mask = std::vector<std::uint8_t>;

struct Size {
    int width, height;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};
Size sizeOf(const Print& print) {
    return {static_cast<int>(print.width), static_cast<int>(print.height)};
}

int pixelsOf(double mm, double pixelMm) {
    return std::max(1, static_cast<int>(std::lround(mm / pixelMm)));
}

/// Pixels of the largest connected piece.
std::size_t largestPiece(Mask mask, Size size) {
    std::size_t largest = 0;
    std::vector<std::size_t> open;
    for (std::size_t start = 0; start < mask.size(); ++start) {
        if (mask[start] == 0) continue;
        mask[start] = 0, open = {start};
        std::size_t count = 0;
        const auto take = [&](std::size_t next) {
            if (mask[next] != 0) mask[next] = 0, open.push_back(next);
        };
        while (!open.empty()) {
            const std::size_t at = open.back();
            open.pop_back(), ++count;
            const std::size_t x = at % static_cast<std::size_t>(size.width);
            if (x > 0) take(at - 1);
            if (x + 1 < static_cast<std::size_t>(size.width)) take(at + 1);
            if (at >= static_cast<std::size_t>(size.width)) take(at - static_cast<std::size_t>(size.width));
            if (at + static_cast<std::size_t>(size.width) < mask.size())
                take(at + static_cast<std::size_t>(size.width));
        }
        largest = std::max(largest, count);
    }
    return largest;
}

/// Sums over squares of 2 · reach + 1 pixels, cut at the borders.
std::vector<double> boxSums(std::span<const float> values, Size size, int reach) {
    const int columns = size.width + 1;
    std::vector<double> integral(static_cast<std::size_t>(columns) *
                                 static_cast<std::size_t>(size.height + 1));
    const auto corner = [&](int x, int y) -> double& {
        return integral[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            corner(x + 1, y + 1) = static_cast<double>(values[size.at(x, y)]) + corner(x, y + 1) +
                                   corner(x + 1, y) - corner(x, y);
    std::vector<double> sums(size.pixels());
    for (int y = 0; y < size.height; ++y) {
        const int top = std::max(0, y - reach), bottom = std::min(size.height, y + reach + 1);
        for (int x = 0; x < size.width; ++x) {
            const int left = std::max(0, x - reach), right = std::min(size.width, x + reach + 1);
            sums[size.at(x, y)] =
                corner(right, bottom) - corner(left, bottom) - corner(right, top) + corner(left, top);
        }
    }
    return sums;
}

/// Pixels of the head, by what is to be seen around them.
enum class Kind : std::uint8_t { background, skin, hair };
std::vector<Kind> kindsOf(const Print& print, double pixelMm) {
    const Size size = sizeOf(print);
    const int reach = pixelsOf(kSmoothMm / 2, pixelMm);
    const std::vector<double> hair = boxSums(print.hair, size, reach),
                              skin = boxSums(print.skin, size, reach);
    std::vector<Kind> kinds(size.pixels(), Kind::background);
    for (std::size_t i = 0; i < kinds.size(); ++i)
        if (print.hair[i] + print.skin[i] >= kHalf)
            kinds[i] = hair[i] >= kLine * (hair[i] + skin[i]) ? Kind::hair : Kind::skin;
    return kinds;
}

/// Pixels of hair beside pixels of skin. Borders to the background are none.
Mask hairline(const std::vector<Kind>& kinds, Size size) {
    Mask line(size.pixels(), 0);
    const auto isSkin = [&](int x, int y) {
        return x >= 0 && x < size.width && y >= 0 && y < size.height && kinds[size.at(x, y)] == Kind::skin;
    };
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            if (kinds[size.at(x, y)] == Kind::hair &&
                (isSkin(x - 1, y) || isSkin(x + 1, y) || isSkin(x, y - 1) || isSkin(x, y + 1)))
                line[size.at(x, y)] = 1;
    return line;
}

/// Squares of the distances of each pixel of a row to the nearest of `values`, which are squares already: the
/// lower envelope of parabolas (Felzenszwalb, Huttenlocher 2012).
void envelope(std::vector<double>& values, std::vector<double>& scratch) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const std::size_t n = values.size();
    std::vector<std::size_t> lowest;
    std::vector<double> from;
    for (std::size_t q = 0; q < n; ++q) {
        if (values[q] == kFar) continue;
        const auto at = static_cast<double>(q);
        double start = -kFar;
        while (!lowest.empty()) {
            const auto other = static_cast<double>(lowest.back());
            start = ((values[q] + at * at) - (values[lowest.back()] + other * other)) / (2 * (at - other));
            if (start > from.back()) break;
            lowest.pop_back(), from.pop_back();
            start = -kFar;
        }
        lowest.push_back(q), from.push_back(start);
    }
    if (lowest.empty()) return;
    scratch.resize(n);
    for (std::size_t q = 0, k = 0; q < n; ++q) {
        const auto at = static_cast<double>(q);
        while (k + 1 < lowest.size() && from[k + 1] < at) ++k;
        const double away = at - static_cast<double>(lowest[k]);
        scratch[q] = away * away + values[lowest[k]];
    }
    values.swap(scratch);
}

/// Of each pixel the square of the distance to the nearest that is marked, pixels²; infinite without any.
std::vector<double> squaresTo(const Mask& mask, Size size) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::vector<double> squares(size.pixels()), line, scratch;
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = mask[i] != 0 ? 0 : kFar;
    line.resize(static_cast<std::size_t>(size.height));
    for (int x = 0; x < size.width; ++x) {
        for (int y = 0; y < size.height; ++y) line[static_cast<std::size_t>(y)] = squares[size.at(x, y)];
        envelope(line, scratch);
        for (int y = 0; y < size.height; ++y) squares[size.at(x, y)] = line[static_cast<std::size_t>(y)];
    }
    line.resize(static_cast<std::size_t>(size.width));
    for (int y = 0; y < size.height; ++y) {
        const auto row = squares.begin() + static_cast<std::ptrdiff_t>(size.at(0, y));
        std::copy(row, row + size.width, line.begin());
        envelope(line, scratch);
        std::ranges::copy(line, row);
    }
    return squares;
}

void addApart(const Mask& line, const std::vector<double>& toOther, double pixelMm, ViewMeasures& view) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == 0) continue;
        const double mm = std::min(kFarthestMm, pixelMm * std::sqrt(toOther[i]));
        view.hairlineSquares += mm * mm, view.hairlinePixels += 1;
    }
}

/// Luminance of what is seen inside of the hairline.
std::vector<float> rimOf(const Print& print, const std::vector<Kind>& kinds,
                         const std::vector<double>& toLine, double pixelMm) {
    const double reach = std::max(kRimMm / pixelMm, 1.0);
    std::vector<float> rim;
    for (std::size_t i = 0; i < toLine.size(); ++i)
        if (kinds[i] == Kind::hair && toLine[i] <= reach * reach) rim.push_back(print.light[i]);
    return rim;
}

/// The value that the darkest of them stay below.
double darkest(std::vector<float> values) {
    const auto at = static_cast<std::ptrdiff_t>(kDarkest * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, values.begin() + at);
    return static_cast<double>(values[static_cast<std::size_t>(at)]);
}

/// Power of light at wavelengths of 4 to 16 pixels in squares of 32 under a window of Hann.
class Spectrum {
  public:
    static constexpr int kSide = 32, kLow = 2, kHigh = 8;  // waves a square

    Spectrum() {
        for (int i = 0; i < kSide; ++i) {
            const double turn = 2 * std::numbers::pi * (i + 0.5) / kSide;
            window_[static_cast<std::size_t>(i)] = 0.5 - 0.5 * std::cos(turn);
            for (int k = 0; k <= kHigh; ++k)
                waves_[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] = std::polar(1.0, -turn * k);
        }
    }
    double power(const Print& print, int left, int top) const {
        const Size size = sizeOf(print);
        double weights = 0, mean = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const double w = windowAt(x, y);
                weights += w, mean += w * static_cast<double>(print.light[size.at(left + x, top + y)]);
            }
        mean /= weights;
        // By rows, then by columns; light is real, so that half of the waves tell all.
        std::array<std::array<std::complex<double>, kSide>, 2 * kHigh + 1> rows{};
        for (int y = 0; y < kSide; ++y) {
            std::array<double, kSide> line{};
            for (int x = 0; x < kSide; ++x)
                line[static_cast<std::size_t>(x)] =
                    windowAt(x, y) * (static_cast<double>(print.light[size.at(left + x, top + y)]) - mean);
            for (int k = 0; k <= kHigh; ++k) {
                std::complex<double> sum = 0;
                for (std::size_t x = 0; x < kSide; ++x)
                    sum += line[x] * waves_[static_cast<std::size_t>(k)][x];
                rows[static_cast<std::size_t>(kHigh + k)][static_cast<std::size_t>(y)] = sum;
                rows[static_cast<std::size_t>(kHigh - k)][static_cast<std::size_t>(y)] = std::conj(sum);
            }
        }
        double power = 0;
        for (int kx = -kHigh; kx <= kHigh; ++kx) {
            for (int ky = 0; ky <= kHigh; ++ky) {
                const int square = kx * kx + ky * ky;
                if (square < kLow * kLow || square > kHigh * kHigh || (ky == 0 && kx < 0)) continue;
                std::complex<double> sum = 0;
                for (std::size_t y = 0; y < kSide; ++y)
                    sum += rows[static_cast<std::size_t>(kHigh + kx)][y] *
                           waves_[static_cast<std::size_t>(ky)][y];
                // There are more waves the shorter they are: octaves count alike.
                power += std::norm(sum) / square;
            }
        }
        return power;
    }

  private:
    double windowAt(int x, int y) const {
        return window_[static_cast<std::size_t>(x)] * window_[static_cast<std::size_t>(y)];
    }
    std::array<double, kSide> window_{};
    std::array<std::array<std::complex<double>, kSide>, kHigh + 1> waves_{};
};

void addScales(const Print& strands, const Print& level, ViewMeasures& view) {
    static const Spectrum spectrum;
    constexpr int kSide = Spectrum::kSide;
    constexpr double kFull = 0.9;  // of a square that hair covers in both
    const Size size = sizeOf(strands);
    const auto isFull = [&](const Print& print, int left, int top) {
        double sum = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                sum += static_cast<double>(print.hair[size.at(left + x, top + y)]);
        return sum >= kFull * kSide * kSide;
    };
    for (int top = 0; top + kSide <= size.height; top += kSide / 2) {
        for (int left = 0; left + kSide <= size.width; left += kSide / 2) {
            if (!isFull(strands, left, top) || !isFull(level, left, top)) continue;
            view.strandsPower += spectrum.power(strands, left, top);
            view.levelPower += spectrum.power(level, left, top);
        }
    }
}

void addHoles(const Print& strands, const Print& level, double pixelMm, ViewMeasures& view) {
    constexpr float kClosed = 0.95f;
    const Size size = sizeOf(strands);
    std::vector<float> isOpen(size.pixels());
    for (std::size_t i = 0; i < isOpen.size(); ++i)
        isOpen[i] = strands.hair[i] + strands.skin[i] < kClosed ? 1.0f : 0.0f;
    // Away from outlines, which have a measure of their own.
    const std::vector<double> open = boxSums(isOpen, size, pixelsOf(kEdgeMm, pixelMm));
    for (std::size_t i = 0; i < isOpen.size(); ++i) {
        if (strands.hair[i] < kHalf) continue;
        view.covered += 1;
        if (open[i] == 0 && level.hair[i] + level.skin[i] < kHalf) view.holes += 1;
    }
}

/// The limits of docs/levels.md stand here and nowhere else.
constexpr std::array<Measure, 6> kMeasures{{
    {"largest_patch_cm2", "patch", "cm²", &Measures::largestPatchCm2, 0, 0.1, 1,
     [](double pixelMm) { return 4 * pixelMm * pixelMm / 100; }},
    {"hairline_mm", "hairline", "mm", &Measures::hairlineMm, 0, 1.5, 1,
     [](double pixelMm) { return pixelMm; }},
    {"rim", "rim", "", &Measures::rim, 0.8, 1.2},
    {"scaliness", "scales", "", &Measures::scaliness, 1 / 1.5, 1.5},
    {"motion_px", "motion", "px", &Measures::motionPx, 0, 1.5},
    {"holes", "holes", "%", &Measures::holes, 0, 0.005, 100},
}};

}  // namespace

Print printOf(const Shot& shot) {
    Print print{shot.width, shot.height, shot.coverage, shot.skin, {}};
    print.light.reserve(shot.all.size());
    for (const Vec3f& rgb : shot.all) print.light.push_back(luminance(rgb));
    return print;
}

Print coarser(const Print& print, std::uint32_t by) {
    if (by == 1) return print;
    Print result{print.width / by, print.height / by, {}, {}, {}};
    const float share = 1 / static_cast<float>(by * by);
    using Values = std::vector<float> Print::*;
    for (const Values values : {&Print::hair, &Print::skin, &Print::light}) {
        for (std::size_t y = 0; y < result.height; ++y) {
            for (std::size_t x = 0; x < result.width; ++x) {
                float sum = 0;
                for (std::size_t j = 0; j < by; ++j)
                    for (std::size_t i = 0; i < by; ++i)
                        sum += (print.*values)[(y * by + j) * print.width + x * by + i];
                (result.*values).push_back(share * sum);
            }
        }
    }
    return result;
}

ViewMeasures measureView(const Print& strands, const Print& level, double pixelMm) {
    const Size size = sizeOf(strands);
    ViewMeasures view;
    Mask bare(size.pixels()), flap(size.pixels());
    for (std::size_t i = 0; i < bare.size(); ++i) {
        view.hasSkin = view.hasSkin || strands.skin[i] > 0 || level.skin[i] > 0;
        bare[i] = strands.skin[i] < kCovers && level.skin[i] >= kBare ? 1 : 0;
        flap[i] = level.skin[i] < kCovers && level.hair[i] >= kBare && strands.skin[i] >= kBare ? 1 : 0;
    }
    const std::size_t largest =
        std::max(largestPiece(std::move(bare), size), largestPiece(std::move(flap), size));
    view.patchMm2 = static_cast<double>(largest) * pixelMm * pixelMm;
    const std::vector<Kind> ownKinds = kindsOf(strands, pixelMm), otherKinds = kindsOf(level, pixelMm);
    const Mask own = hairline(ownKinds, size), other = hairline(otherKinds, size);
    const std::vector<double> toOwn = squaresTo(own, size), toOther = squaresTo(other, size);
    addApart(own, toOther, pixelMm, view);
    addApart(other, toOwn, pixelMm, view);
    view.strandsRim = rimOf(strands, ownKinds, toOwn, pixelMm);
    view.levelRim = rimOf(level, otherKinds, toOther, pixelMm);
    addScales(strands, level, view);
    addHoles(strands, level, pixelMm, view);
    return view;
}

Measures combined(std::span<const ViewMeasures> views) {
    ViewMeasures all;
    for (const ViewMeasures& view : views) {
        all.hasSkin = all.hasSkin || view.hasSkin;
        all.patchMm2 = std::max(all.patchMm2, view.patchMm2);
        all.hairlineSquares += view.hairlineSquares, all.hairlinePixels += view.hairlinePixels;
        std::ranges::copy(view.strandsRim, std::back_inserter(all.strandsRim));
        std::ranges::copy(view.levelRim, std::back_inserter(all.levelRim));
        all.strandsPower += view.strandsPower, all.levelPower += view.levelPower;
        all.holes += view.holes, all.covered += view.covered;
    }
    Measures measures;
    if (all.hasSkin) measures.largestPatchCm2 = all.patchMm2 / 100;
    if (all.hairlinePixels > 0) measures.hairlineMm = std::sqrt(all.hairlineSquares / all.hairlinePixels);
    if (!all.strandsRim.empty() && !all.levelRim.empty()) {
        const double wanted = darkest(std::move(all.strandsRim));
        if (wanted > 0) measures.rim = darkest(std::move(all.levelRim)) / wanted;
    }
    constexpr double kFlat = 1e-9;  // rounding
    if (all.strandsPower > kFlat) measures.scaliness = all.levelPower / all.strandsPower;
    if (all.covered > 0) measures.holes = all.holes / all.covered;
    return measures;
}

std::span<const Measure> allMeasures() {
    return kMeasures;
}

double Measure::limit(double pixelMm) const {
    return seen == nullptr ? most : std::max(most, seen(pixelMm));
}

bool Measure::fails(const Measures& of, double pixelMm) const {
    const std::optional<double>& measured = of.*value;
    return measured && !(*measured >= least && *measured <= limit(pixelMm));
}

std::vector<std::string> failsOf(const Measures& measures, double pixelMm) {
    std::vector<std::string> names;
    for (const Measure& measure : kMeasures)
        if (measure.fails(measures, pixelMm)) names.emplace_back(measure.name);
    return names;
}

std::string failureWords(const Measures& measures, double pixelMm) {
    std::string words;
    for (const Measure& measure : kMeasures) {
        if (!measure.fails(measures, pixelMm)) continue;
        const double most = measure.scale * measure.limit(pixelMm);
        const std::string unit = measure.unit.empty() ? "" : " " + std::string(measure.unit);
        words += fmt::format("{}{} {:.3g}{} ({})", words.empty() ? "" : ", ", measure.label,
                             measure.scale * *(measures.*measure.value), unit,
                             measure.least > 0 ? fmt::format("{:.2g} to {:.2g}", measure.least, most)
                                               : fmt::format("at most {:.2g}", most));
    }
    return words;
}

}  // namespace hairloom::cards
