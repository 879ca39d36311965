// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tables for hair whose absorption changes from place to place: those of tables.h for several absorptions
// above one another, with absorption as a third coordinate. Channels do not know each other, so a layer holds
// one channel and each of red, green and blue finds its own place. Between two layers the shader interpolates
// logarithms: light that takes one path of length l falls as exp(−σ l), for which that is exact.

#include "core/shading/sky_light.h"

namespace hairloom::shading {

/// A multiple of 3: three layers are baked at once, as the channels of one fibre.
inline constexpr std::uint32_t kAbsorptionLayers = 9;
/// Per fibre radius; what absorbs more looks the same.
inline constexpr double kMaxAbsorption = 8;

/// Absorption of a layer, 0 … kMaxAbsorption, closer to each other where there is light to see.
double absorptionOfLayer(std::uint32_t layer);

/// Between which layers an absorption lies.
struct LayerPlace {
    std::uint32_t low;  ///< the other is the next
    double part;        ///< 0…1 of the way, in absorption
};
LayerPlace layerPlace(double absorption);

/// Layer after layer from the top; each has rows of its own whose ends are the ends of the coordinate, as in
/// tables.h.
struct MarschnerLayers {
    Table longitudinal;
    Table azimuthal;  ///< N_TT, N_TRT, N_R, 1 by (cos φ + 1)/2 and, in each layer, 2|θ_d|/π
};
MarschnerLayers bakeMarschnerLayers(const MarschnerParameters& model,
                                    const TableSizes& sizes = {256, 256, 16});

struct SadeghiLayers {
    SadeghiTables tables;
    Table energies;  ///< TT, TRT relative to those of the model's own absorption; a row a layer, 2 wide
};
/// Lobes other than R take their colours from the absorption, as withAbsorption() has it; their tints are the
/// shader's.
SadeghiLayers bakeSadeghiLayers(const SadeghiParameters& model, const AzimuthalParameters& fibre,
                                const TableSizes& sizes = {});

struct DualLayers {
    Table profile;  ///< red: DualScattering::Profile by (cos φ + 1)/2 and, in each layer, 2|θ_d|/π
    /// By 2|θ_d|/π. Two rows a layer: ā_f, ā_b, and their variances times them; their tilts times them, and
    /// the albedo plus AverageScattering::first and plus second, which are never negative.
    Table averages;
    /// By (sin θ_o + 1)/2. Two rows a layer: SkyMoments::even, and along, across, alongAlong by it;
    /// alongAcross, acrossAcross and third by it, 0.
    Table sky;
};
DualLayers bakeDualLayers(const MarschnerParameters& model, std::uint32_t azimuth = 64,
                          std::uint32_t inclination = 16);
/// Of the colour of R and of tints only the mean counts, for a layer is no channel.
DualLayers bakeDualLayers(const SadeghiParameters& model, const AzimuthalParameters& fibre,
                          std::uint32_t azimuth = 64, std::uint32_t inclination = 16);

/// ā_f, ā_b and the moments across the fibre (θ_d = 0) as the shader finds them in DualLayers::averages; each
/// channel has its own absorption.
AverageScattering scatteringAcross(const Table& averages, const Vec3d& absorption);

}  // namespace hairloom::shading
