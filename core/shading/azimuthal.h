// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// N_p(θ_d, φ): the spread around the fibre of the paths R, TT and TRT (Marschner et al. 2003, section 5; Rünz
// 2012, Eq. 36–47), for one inclination θ_d. Radians; φ is the azimuth of the view against that of the light,
// 0 is back towards the light. Colours are linear RGB.

#include <array>
#include <span>
#include <vector>

#include "core/shading/optics.h"

namespace hairloom::shading {

enum class Lobe { R, TT, TRT };
inline constexpr std::array kLobes{Lobe::R, Lobe::TT, Lobe::TRT};
constexpr int order(Lobe lobe) {
    return static_cast<int>(lobe);
}
constexpr std::size_t index(Lobe lobe) {
    return static_cast<std::size_t>(lobe);
}

/// How far light turns on its way around the fibre, and so where it leaves.
enum class RootMethod {
    Exact,  ///< the true angles (Eq. 40); the offset of a ray is found by safeguarded Newton steps
    Cubic,  ///< Marschner's approximation of γ_t (Eq. 41 and 42); the offset follows in closed form
};

struct AzimuthalParameters {
    double ior = 1.55;                 ///< 1…3
    Vec3d absorption = Vec3d::Zero();  ///< RGB per fibre radius, >= 0
    /// Standard deviation of what roughness and uneven cross-sections add; from kMinAzimuthalWidth up,
    /// below it counts as none.
    double width = 0;
    /// Long over short axis, or the reverse, 0.5…2; changes TRT alone. Eq. 47 with φ_h as in Marschner et
    /// al., not with φ_d as printed; averaged over all turns of the fibre around its axis, because strands
    /// have none.
    double axisRatio = 1;
    double causticWidth =
        0.2;  ///< w_c, standard deviation of the Gaussian that replaces caustics; 0: none are replaced
    double causticFade = 0.3;  ///< Δη', above η' = 2, where caustics end: the Gaussian fades out over it
    double glint = 1;          ///< k_G, factor on the Gaussian; 1 keeps the energy
    RootMethod roots = RootMethod::Exact;

    bool operator==(const AzimuthalParameters&) const = default;
};
inline constexpr double kMinAzimuthalWidth = 0.035;  ///< 2 degrees
/// Where nothing else blurs a caustic, w_c is at least this: it would be infinite.
inline constexpr double kMinCausticWidth = 0.035;

/// All N of one inclination.
class AzimuthalProfile {
  public:
    AzimuthalProfile(const AzimuthalParameters& parameters, double thetaD);

    /// RGB per radian. Exact where width is 0, else by quadrature over the offset.
    Vec3d operator()(Lobe lobe, double phi) const;

    /// ½ ∫ A_p dh (Eq. 36): the share of light that takes the path; of all N dφ the sum, but for k_G ≠ 1.
    Vec3d energy(Lobe lobe) const;
    /// The same of all orders beyond TRT, which the model leaves out.
    Vec3d energyBeyond() const;

    /// N at φ = i·π/(kGridSize − 1), much faster than one by one. R has one channel.
    static constexpr std::size_t kGridSize = 181;
    struct Grid {
        std::array<float, kGridSize> r{};
        std::array<std::array<float, kGridSize>, 3> tt{}, trt{};
    };
    Grid grid() const;

  private:
    /// A cross-section with its caustic; TRT of an elliptic fibre has several.
    struct Section {
        CrossSection optics;
        double share = 1;       ///< of the average over the fibre's turns
        double causticPhi = 0;  ///< φ_c >= 0
        double fade = 0;        ///< 1: caustic replaced, 0: left alone
        Vec3d removed = Vec3d::Zero();
    };
    Section makeSection(double ior) const;
    double kept(const Section& section, double phi) const;
    Vec3d smooth(const Section& section, Lobe lobe, double phi) const;
    Vec3d causticGauss(const Section& section, double phi) const;
    Vec3d rough(const Section& section, Lobe lobe, double phi) const;
    bool isRough() const { return parameters_.width >= kMinAzimuthalWidth; }
    const std::vector<Section>& sections(Lobe lobe) const { return lobe == Lobe::TRT ? trt_ : circle_; }
    Grid pointwiseGrid() const;
    Grid roughGrid() const;
    void addRough(const Section& section, std::span<const Lobe> lobes, const std::vector<float>& weights,
                  Grid& grid) const;

    AzimuthalParameters parameters_;
    double thetaD_;
    std::vector<Section> circle_, trt_;
};

/// Where light that is reflected once inside piles up, across a fibre of this section (φ_c): that of a round
/// fibre, and the least and the greatest of an elliptic one as it turns around its axis (Eq. 47). 0 where
/// there is no caustic.
struct CausticAzimuths {
    double round, least, greatest;
};
CausticAzimuths causticAzimuths(double ior, double axisRatio);

/// Maps any angle to −π…π.
double wrapAngle(double angle);
/// The normal distribution of a circle's angle, from a sum over its turns.
double wrappedGauss(double angle, double deviation);

}  // namespace hairloom::shading
