// SPDX-License-Identifier: GPL-3.0-or-later
// N over a whole row of angles at once, for the tables. Where the azimuthal width blurs it, the light of each
// offset is put into bins of one degree that are then blurred: no root is solved.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shading/azimuthal.h"
#include "core/shading/cubic.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kBins = 2 * (static_cast<int>(AzimuthalProfile::kGridSize) - 1);
constexpr double kBin = 2 * kPi / kBins;
constexpr int kOffsets = 160;  // steps in γ; light of neighbours lands less than two bins apart

using Row = std::array<float, AzimuthalProfile::kGridSize>;

/// Light by azimuth, −π…π − kBin.
struct Bins {
    std::array<float, kBins> values{};

    void add(double phi, double amount) {
        const double x = (phi / (2 * kPi) + 2.5) * kBins;  // |φ| is below two and a half turns
        const double low = std::floor(x);
        const auto i = static_cast<std::size_t>(low) % kBins;
        const double t = x - low;
        values[i] += static_cast<float>(amount * (1 - t));
        values[(i + 1) % kBins] += static_cast<float>(amount * t);
    }
};

/// Half of a wrapped Gaussian's samples, from its middle on; `weights` add up to 1 / kBin over both halves.
std::vector<float> kernel(double deviation) {
    // Sharing light between two bins has blurred it by a triangle, whose variance is a sixth of a bin
    // squared.
    const double rest = std::sqrt(std::max(deviation * deviation - kBin * kBin / 6, kBin * kBin / 16));
    const int reach = std::min(static_cast<int>(std::ceil(4.5 * rest / kBin)), kBins / 2 - 1);
    std::vector<float> weights;
    double sum = 0;
    for (int k = 0; k <= reach; ++k) {
        weights.push_back(static_cast<float>(wrappedGauss(k * kBin, rest)));
        sum += (k == 0 ? 1 : 2) * static_cast<double>(weights.back());
    }
    for (float& w : weights) w /= static_cast<float>(sum * kBin);
    return weights;
}

/// Adds `factor` times the blurred bins at 0…π.
void blur(const Bins& bins, const std::vector<float>& weights, float factor, Row& row) {
    const std::size_t reach = weights.size() - 1;
    // Index `reach` is φ = 0.
    std::array<float, AzimuthalProfile::kGridSize + kBins> line{};
    for (std::size_t i = 0; i < row.size() + 2 * reach; ++i) {
        line[i] = bins.values[(i + kBins / 2 + kBins - reach) % kBins];
    }
    for (std::size_t k = 0; k <= reach; ++k) {
        const float w = factor * weights[k];
        const float* left = &line[reach - k];
        const float* right = &line[reach + k];
        if (k == 0) {
            for (std::size_t i = 0; i < row.size(); ++i) row[i] += w * left[i];
        } else {
            for (std::size_t i = 0; i < row.size(); ++i) row[i] += w * (left[i] + right[i]);
        }
    }
}

}  // namespace

AzimuthalProfile::Grid AzimuthalProfile::pointwiseGrid() const {
    Grid grid;
    for (std::size_t i = 0; i < kGridSize; ++i) {
        const double phi = static_cast<double>(i) * kBin;
        grid.r[i] = static_cast<float>((*this)(Lobe::R, phi).x());
        const Vec3d tt = (*this)(Lobe::TT, phi);
        const Vec3d trt = (*this)(Lobe::TRT, phi);
        for (std::size_t c = 0; c < 3; ++c) {
            grid.tt[c][i] = static_cast<float>(tt[static_cast<int>(c)]);
            grid.trt[c][i] = static_cast<float>(trt[static_cast<int>(c)]);
        }
    }
    return grid;
}

void AzimuthalProfile::addRough(const Section& section, std::span<const Lobe> lobes,
                                const std::vector<float>& weights, Grid& grid) const {
    std::array<std::array<Bins, 3>, 3> bins;
    const double etaPrime = section.optics.indices().perpendicular;
    for (int i = 0; i < kOffsets; ++i) {
        const double gamma = (i + 0.5) * (kPi / 2) / kOffsets;
        const double h = std::sin(gamma);
        const double inside = std::asin(h / etaPrime);
        const CrossSection::Ray ray = section.optics.at(h);
        for (const Lobe lobe : lobes) {
            const int p = order(lobe);
            const double turned = parameters_.roots == RootMethod::Exact
                                      ? 2 * p * inside - 2 * gamma
                                      : CubicDeflection(p, etaPrime)(gamma);
            const double share = lobe == Lobe::TRT ? kept(section, turned) : 1;
            const double weight = 0.5 * share * std::cos(gamma) * (kPi / 2) / kOffsets;
            const Vec3d amount = weight * attenuation(ray, p);
            for (std::size_t c = 0; c < (lobe == Lobe::R ? 1 : 3); ++c) {
                bins[index(lobe)][c].add(p * kPi + turned, amount[static_cast<int>(c)]);
                bins[index(lobe)][c].add(-p * kPi - turned, amount[static_cast<int>(c)]);
            }
        }
    }
    const auto share = static_cast<float>(section.share);
    for (const Lobe lobe : lobes) {
        for (std::size_t c = 0; c < (lobe == Lobe::R ? 1 : 3); ++c) {
            Row& row = lobe == Lobe::R ? grid.r : lobe == Lobe::TT ? grid.tt[c] : grid.trt[c];
            blur(bins[index(lobe)][c], weights, share, row);
        }
        if (lobe != Lobe::TRT || section.fade == 0) continue;
        for (std::size_t i = 0; i < kGridSize; ++i) {
            const Vec3d glint = section.share * causticGauss(section, static_cast<double>(i) * kBin);
            for (std::size_t c = 0; c < 3; ++c)
                grid.trt[c][i] += static_cast<float>(glint[static_cast<int>(c)]);
        }
    }
}

AzimuthalProfile::Grid AzimuthalProfile::roughGrid() const {
    Grid grid;
    const std::vector<float> weights = kernel(parameters_.width);
    if (parameters_.axisRatio == 1) {
        addRough(circle_.front(), kLobes, weights, grid);
        return grid;
    }
    addRough(circle_.front(), std::span(kLobes).first(2), weights, grid);
    for (const Section& section : trt_) addRough(section, std::span(kLobes).last(1), weights, grid);
    return grid;
}

AzimuthalProfile::Grid AzimuthalProfile::grid() const {
    return isRough() ? roughGrid() : pointwiseGrid();
}

}  // namespace hairloom::shading
