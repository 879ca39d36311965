// SPDX-License-Identifier: GPL-3.0-or-later
// Melanin's three numbers, held against its spectra: what light a layer lets through, seen by the standard
// observer of 1931.
#include "core/shading/melanin.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace hairloom::shading {
namespace {

/// CIE standard illuminant D65 (ISO/CIE 11664-2), 380 to 780 nm.
constexpr std::array<double, 41> kD65{
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
    74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
const Vec3d kWhite(0.95047, 1, 1.08883);

double lobe(double nm, double middle, double below, double above) {
    const double x = (nm - middle) / (nm < middle ? below : above);
    return std::exp(-0.5 * x * x);
}
/// The CIE's colour matching functions of 1931, as Wyman, Sloan and Shirley 2013 fit them.
Vec3d observer(double nm) {
    return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
                0.065 * lobe(nm, 501.1, 20.4, 26.2),
            0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
            1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

/// X, Y and Z of D65 behind what lets `through(nm)` of it through; white is that of sRGB.
template <class Through>
Vec3d seen(Through&& through) {
    Vec3d sum = Vec3d::Zero(), all = Vec3d::Zero();
    for (std::size_t i = 0; i < kD65.size(); ++i) {
        const double nm = 380 + 10 * static_cast<double>(i);
        sum += kD65[i] * through(nm) * observer(nm);
        all += kD65[i] * observer(nm);
    }
    return sum.cwiseQuotient(all).cwiseProduct(kWhite);
}

/// IEC 61966-2-1.
const Eigen::Matrix3d kXyzFromRec709 = (Eigen::Matrix3d() << 0.4124564, 0.3575761, 0.1804375, 0.2126729,
                                        0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041)
                                           .finished();
/// ITU-R BT.709 to ACEScg after Bradford, as the Academy's transforms publish it.
const Eigen::Matrix3d kAcesCgFromRec709 = (Eigen::Matrix3d() << 0.6130974, 0.3395231, 0.0473795, 0.0701937,
                                           0.9163540, 0.0134523, 0.0206156, 0.1095698, 0.8698146)
                                              .finished();

/// The first-order absorption of red, green and blue of what absorbs `of(nm)`.
template <class Of>
Vec3d thin(Of&& of) {
    constexpr double kThin = 1e-4;
    const Eigen::Matrix3d toRec709 = kXyzFromRec709.inverse();
    const Vec3d white = toRec709 * seen([](double) { return 1.0; });
    const Vec3d through = toRec709 * seen([&](double nm) { return std::exp(-kThin * of(nm)); });
    return -through.cwiseQuotient(white).array().log().matrix() / kThin;
}

/// Donner and Jensen 2006, after Jacques 1996: their powers, with green's strength as ours.
double eumelanin(double nm) {
    const auto power = [](double at) { return std::pow(at / 550, -3.33); };
    static const double scale = absorption({1, 0}).y() / thin(power).y();
    return scale * power(nm);
}
double pheomelanin(double nm) {
    const auto power = [](double at) { return std::pow(at / 550, -4.75); };
    static const double scale = absorption({0, 1}).y() / thin(power).y();
    return scale * power(nm);
}

/// CIE 1976.
Vec3d lab(const Vec3d& xyz) {
    const auto f = [](double x) { return x > 0.008856 ? std::cbrt(x) : 7.787 * x + 16.0 / 116; };
    const Vec3d share = xyz.cwiseQuotient(kWhite);
    const double x = f(share.x()), y = f(share.y()), z = f(share.z());
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(Melanin, AbsorbsRedGreenAndBlueAsItsSpectraDo) {
    EXPECT_NEAR(seen([](double) { return 1.0; }).y(), 1, 1e-12);
    const Vec3d eu = thin(eumelanin).cwiseQuotient(absorption({1, 0}));
    const Vec3d ph = thin(pheomelanin).cwiseQuotient(absorption({0, 1}));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(eu[c], 1, 0.1) << "eumelanin, channel " << c;
        EXPECT_NEAR(ph[c], 1, 0.1) << "pheomelanin, channel " << c;
    }
}

/// Three numbers are not a spectrum: deep red-brown hair is furthest off. Taken for numbers of ACEScg, they
/// would be several times as far, so images are converted to it (tests/colour).
TEST(Melanin, HasTheColourOfItsSpectraInRec709) {
    double worst = 0, worstStraight = 0, sum = 0, sumStraight = 0;
    for (const Melanin melanin : {Melanin{0.05, 0}, Melanin{0.3, 0}, Melanin{0.3, 0.2}, Melanin{1.3, 0},
                                  Melanin{0.6, 1.5}, Melanin{0, 1}, Melanin{3, 0}, Melanin{8, 0}}) {
        for (const double radii : {0.5, 1.0, 2.0}) {
            const Vec3d spectral = lab(seen([&](double nm) {
                return std::exp(-radii *
                                (melanin.eumelanin * eumelanin(nm) + melanin.pheomelanin * pheomelanin(nm)));
            }));
            const Vec3d ours = (-radii * absorption(melanin)).array().exp();
            const Vec3d straight = kXyzFromRec709 * (kAcesCgFromRec709.inverse() * ours);
            const double off = (lab(kXyzFromRec709 * ours) - spectral).norm();
            const double offStraight = (lab(straight) - spectral).norm();
            worst = std::max(worst, off);
            worstStraight = std::max(worstStraight, offStraight);
            sum += off;
            sumStraight += offStraight;
            EXPECT_LT(off, 0.5 * offStraight + 1) << melanin.eumelanin << ", " << melanin.pheomelanin;
        }
    }
    EXPECT_LT(worst, 9);
    EXPECT_LT(sum / 24, 2.5);
    EXPECT_GT(worstStraight, 2 * worst);
    EXPECT_GT(sumStraight, 3 * sum);
}

}  // namespace
}  // namespace hairloom::shading
