// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/absorption_layers.h"

#include <algorithm>
#include <cmath>

namespace hairloom::shading {
namespace {

// σ = m u/(1 + m/σ_max − u): steps near 0 are an eleventh of even ones.
constexpr double kBend = 0.7;
static_assert(kAbsorptionLayers % 3 == 0);

Table makeTable(std::uint32_t width, std::uint32_t height) {
    return {width, height, std::vector<float>(std::size_t{4} * width * height)};
}

/// Absorptions of three layers, as the channels of one fibre.
Vec3d absorptionsOf(std::uint32_t firstLayer) {
    return {absorptionOfLayer(firstLayer), absorptionOfLayer(firstLayer + 1),
            absorptionOfLayer(firstLayer + 2)};
}

/// `at` gives the model of three layers.
template <class ModelOf>
DualLayers bakeDualOf(std::uint32_t azimuth, std::uint32_t inclination, const ModelOf& modelOf) {
    DualLayers layers{makeTable(azimuth, inclination * kAbsorptionLayers),
                      makeTable(inclination, 2 * kAbsorptionLayers), makeTable(32, 2 * kAbsorptionLayers)};
    for (std::uint32_t first = 0; first < kAbsorptionLayers; first += 3) {
        const auto model = modelOf(absorptionsOf(first));
        const DualScattering dual(model);  // which may look at the model
        const DualTables tables = bakeDual(dual, azimuth, inclination);
        const Table sky = bakeSky(dual, layers.sky.width);
        for (std::uint32_t c = 0; c < 3; ++c) {
            for (std::uint32_t y = 0; y < inclination; ++y) {
                for (std::uint32_t x = 0; x < azimuth; ++x) {
                    layers.profile.texel(x, (first + c) * inclination + y)[0] = tables.profile.texel(x, y)[c];
                }
                float* shares = layers.averages.texel(y, 2 * (first + c));
                float* tilts = layers.averages.texel(y, 2 * (first + c) + 1);
                shares[0] = tables.averages.texel(y, 0)[c];
                shares[1] = tables.averages.texel(y, 1)[c];
                shares[2] = tables.variances.texel(y, 0)[c];
                shares[3] = tables.variances.texel(y, 1)[c];
                tilts[0] = tables.variances.texel(y, 2)[c];
                tilts[1] = tables.variances.texel(y, 3)[c];
                tilts[2] = std::max(shares[0] + shares[1] + tables.averages.texel(y, 3)[c], 0.0f);
                tilts[3] = std::max(shares[0] + shares[1] + tables.averages.texel(y, 4)[c], 0.0f);
            }
            for (std::uint32_t x = 0; x < sky.width; ++x) {
                float* const low = layers.sky.texel(x, 2 * (first + c));
                float* const high = layers.sky.texel(x, 2 * (first + c) + 1);
                const float even = low[0] = sky.texel(x, 0)[c];
                for (std::uint32_t row = 1; row < 7; ++row)
                    (row < 4 ? low[row] : high[row - 4]) = sky.texel(x, row)[c] / std::max(even, 1e-6f);
            }
        }
    }
    return layers;
}

/// Bounded for hair that absorbs nothing.
SadeghiLongitudinal longitudinalOf(const SadeghiParameters& model, const AzimuthalParameters& fibre) {
    return {model, withAbsorption(model, fibre, Vec3d::Zero())};
}

}  // namespace

double absorptionOfLayer(std::uint32_t layer) {
    const double u = static_cast<double>(layer) / (kAbsorptionLayers - 1);
    return kBend * u / (1 + kBend / kMaxAbsorption - u);
}

LayerPlace layerPlace(double absorption) {
    const double sigma = std::clamp(absorption, 0.0, kMaxAbsorption);
    const double u = sigma * (1 + kBend / kMaxAbsorption) / (kBend + sigma);
    const double at = u * (kAbsorptionLayers - 1);
    const auto low = std::min(static_cast<std::uint32_t>(at), kAbsorptionLayers - 2);
    const double below = absorptionOfLayer(low), above = absorptionOfLayer(low + 1);
    return {low, std::clamp((sigma - below) / (above - below), 0.0, 1.0)};
}

MarschnerLayers bakeMarschnerLayers(const MarschnerParameters& model, const TableSizes& sizes) {
    MarschnerLayers layers;
    layers.azimuthal = makeTable(sizes.azimuth, sizes.inclination * kAbsorptionLayers);
    for (std::uint32_t first = 0; first < kAbsorptionLayers; first += 3) {
        MarschnerParameters three = model;
        three.azimuthal.absorption = absorptionsOf(first);
        const Marschner fibre(three);
        if (first == 0) layers.longitudinal = bakeLongitudinal(fibre, sizes.longitudinal);
        const MarschnerTables tables = bakeAzimuthal(fibre, sizes);
        for (std::uint32_t c = 0; c < 3; ++c) {
            for (std::uint32_t y = 0; y < sizes.inclination; ++y) {
                for (std::uint32_t x = 0; x < sizes.azimuth; ++x) {
                    float* texel = layers.azimuthal.texel(x, (first + c) * sizes.inclination + y);
                    texel[0] = tables.transmitted.texel(x, y)[c];
                    texel[1] = tables.reflected.texel(x, y)[c];
                    texel[2] = tables.transmitted.texel(x, y)[3];
                    texel[3] = 1;
                }
            }
        }
    }
    return layers;
}

SadeghiLayers bakeSadeghiLayers(const SadeghiParameters& model, const AzimuthalParameters& fibre,
                                const TableSizes& sizes) {
    SadeghiLayers layers{bakeSadeghi(model, longitudinalOf(model, fibre), sizes),
                         makeTable(2, kAbsorptionLayers)};
    const TransmittedEnergies own = transmittedEnergies(fibre, fibre.absorption);
    for (std::uint32_t first = 0; first < kAbsorptionLayers; first += 3) {
        const TransmittedEnergies three = transmittedEnergies(fibre, absorptionsOf(first));
        for (std::uint32_t c = 0; c < 3; ++c) {
            for (std::uint32_t x = 0; x < 2; ++x) {
                float* texel = layers.energies.texel(x, first + c);
                const int channel = static_cast<int>(c);
                texel[0] = static_cast<float>(three.tt[channel] / std::max(own.tt.maxCoeff(), 1e-12));
                texel[1] = static_cast<float>(three.trt[channel] / std::max(own.trt.maxCoeff(), 1e-12));
                texel[2] = texel[3] = 1;
            }
        }
    }
    return layers;
}

DualLayers bakeDualLayers(const MarschnerParameters& model, std::uint32_t azimuth,
                          std::uint32_t inclination) {
    return bakeDualOf(azimuth, inclination, [&](const Vec3d& absorptions) {
        MarschnerParameters three = model;
        three.azimuthal.absorption = absorptions;
        return Marschner(three);
    });
}

DualLayers bakeDualLayers(const SadeghiParameters& model, const AzimuthalParameters& fibre,
                          std::uint32_t azimuth, std::uint32_t inclination) {
    SadeghiParameters grey = model;
    for (SadeghiLobe* lobe : {&grey.r, &grey.tt, &grey.trt}) lobe->tint.setConstant(lobe->tint.mean());
    grey.r.colour.setConstant(grey.r.colour.mean());
    // Of the hair that all layers serve, as the tables of single scattering.
    const SadeghiLongitudinal longitudinal = longitudinalOf(model, fibre);
    return bakeDualOf(azimuth, inclination, [&](const Vec3d& absorptions) {
        return DualScattering(withAbsorption(grey, fibre, absorptions), longitudinal);
    });
}

AverageScattering scatteringAcross(const Table& averages, const Vec3d& absorption) {
    AverageScattering result;
    for (int c = 0; c < 3; ++c) {
        const LayerPlace place = layerPlace(absorption[c]);
        const auto between = [&](std::uint32_t row, std::size_t component) {
            const auto logarithm = [&](std::uint32_t layer) {
                const auto value = static_cast<double>(averages.texel(0, 2 * layer + row)[component]);
                return std::log(std::max(value, 1e-7));
            };
            const double low = logarithm(place.low);
            return std::exp(low + place.part * (logarithm(place.low + 1) - low));
        };
        result.forward[c] = between(0, 0);
        result.backward[c] = between(0, 1);
        const double albedo = result.forward[c] + result.backward[c];
        result.first[c] = between(1, 2) - albedo;
        result.second[c] = between(1, 3) - albedo;
    }
    return result;
}

}  // namespace hairloom::shading
