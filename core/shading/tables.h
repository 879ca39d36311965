// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the shaders look up instead of computing it (Rünz 2012, section 6.6.2), baked from the models of this
// room. Baking uses all cores and gives the same bits for any number of them.

#include <cstdint>
#include <vector>

#include "core/shading/dual_scattering.h"

namespace hairloom::shading {

/// Rows of RGBA. Texel i of n along a side stands for the coordinate i/(n − 1) of 0…1, ends included.
struct Table {
    std::uint32_t width = 0, height = 0;
    std::vector<float> rgba;

    float* texel(std::uint32_t x, std::uint32_t y) { return &rgba[4 * (std::size_t{y} * width + x)]; }
    const float* texel(std::uint32_t x, std::uint32_t y) const {
        return &rgba[4 * (std::size_t{y} * width + x)];
    }
    /// Bilinear, as a sampler does; u along the width, v along the height, 0…1.
    std::array<double, 4> sample(double u, double v) const;
};

/// Sizes of the tables; each 8…1024.
struct TableSizes {
    std::uint32_t longitudinal = 256;  ///< both sides of the M table
    std::uint32_t azimuth = 256;       ///< N tables along cos φ
    std::uint32_t inclination = 32;    ///< and along θ_d
};

/// M_R, M_TT, M_TRT, each times its factor and cos θ_i / cos²θ_d (Eq. 33 and 50), and 2|θ_d|/π in alpha, by
/// (sin θ_i + 1)/2 and (sin θ_o + 1)/2. The N tables hold no cosine.
Table bakeLongitudinal(const Marschner& model, std::uint32_t size);
Table bakeLongitudinal(const SadeghiLongitudinal& model, std::uint32_t size);

/// By (cos φ + 1)/2 and 2|θ_d|/π.
struct MarschnerTables {
    Table longitudinal;
    Table transmitted;  ///< RGB: N_TT; alpha: N_R
    Table reflected;    ///< RGB: N_TRT; alpha: 1
};
MarschnerTables bakeMarschner(const Marschner& model, const TableSizes& sizes = {});
/// The same without `longitudinal`, which absorption does not change.
MarschnerTables bakeAzimuthal(const Marschner& model, const TableSizes& sizes = {});

struct SadeghiTables {
    Table longitudinal;
    Table azimuthal;  ///< N'_R, N'_TT, N'_TRT, 1 by (cos φ + 1)/2 and the strand's glint; `inclination` rows
};
SadeghiTables bakeSadeghi(const SadeghiParameters& model, const TableSizes& sizes = {});
/// The same bounded as `longitudinal` is.
SadeghiTables bakeSadeghi(const SadeghiParameters& model, const SadeghiLongitudinal& longitudinal,
                          const TableSizes& sizes);

/// Tables of dual scattering.
struct DualTables {
    Table profile;  ///< RGB: DualScattering::Profile by (cos φ + 1)/2 and 2|θ_d|/π
    /// By 2|θ_d|/π; its rows: ā_f and β̄_f²; ā_b and β̄_b²; tilt of ā_f, of ā_b, of all, and the variance of
    /// all; AverageScattering::first; second.
    Table averages;
    /// By the same, not for shaders: rows of AverageScattering's variances and tilts of each channel, forward
    /// before backward.
    Table variances;
};
DualTables bakeDual(const DualScattering& model, std::uint32_t azimuth = 64, std::uint32_t inclination = 16);

/// LongitudinalLobe::factorOut() of lobes without tilt, in red, by |sin θ| and the place of the width between
/// the two bounds; the same for all models.
Table bakeSpreadFactors();
inline constexpr double kMinSpread = 1 * kDegree, kLargestSpread = 60 * kDegree;

/// S cos θ_i as the shader computes it from the tables.
Vec3d lookUp(const MarschnerTables& tables, double sinThetaIn, double sinThetaOut, double cosPhi);
Vec3d lookUp(const SadeghiTables& tables, const SadeghiParameters& model, double sinThetaIn,
             double sinThetaOut, double cosPhi, double glint);

}  // namespace hairloom::shading
