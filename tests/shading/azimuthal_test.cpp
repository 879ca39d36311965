// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/azimuthal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shading/cylinder_trace.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegrees = kPi / 180;

Vec3d integral(const AzimuthalProfile& profile, Lobe lobe, int steps) {
    Vec3d sum = Vec3d::Zero();
    for (int i = 0; i < steps; ++i)
        sum += profile(lobe, (i + 0.5) * 2 * kPi / steps - kPi) * (2 * kPi / steps);
    return sum;
}

// truth.md: a Monte-Carlo of 8 million rays through a smooth cylinder.
TEST(Azimuthal, EnergiesMatchTheReference) {
    const double expected[][4] = {
        {0, 0.0750, 0.8618, 0.0557}, {20, 0.0793, 0.8545, 0.0579}, {45, 0.1098, 0.8026, 0.0736}};
    for (const auto& row : expected) {
        const AzimuthalProfile profile({}, row[0] * kDegrees);
        EXPECT_NEAR(profile.energy(Lobe::R).x(), row[1], 2e-4);
        EXPECT_NEAR(profile.energy(Lobe::TT).x(), row[2], 2e-4);
        EXPECT_NEAR(profile.energy(Lobe::TRT).x(), row[3], 2e-4);
    }
    const double allOrders[][3] = {{0, 0.6984, 0.2113}, {20, 0.6913, 0.2066}, {45, 0.6663, 0.2039}};
    for (const auto& row : allOrders) {
        AzimuthalParameters parameters;
        parameters.absorption = Vec3d(0.2, 1, 0);
        const AzimuthalProfile profile(parameters, row[0] * kDegrees);
        Vec3d sum = profile.energyBeyond();
        for (const Lobe lobe : kLobes) sum += profile.energy(lobe);
        EXPECT_NEAR(sum.x(), row[1], 4e-4);
        EXPECT_NEAR(sum.y(), row[2], 4e-4);
        EXPECT_NEAR(sum.z(), 1, 1e-4);
    }
}

TEST(Azimuthal, AzimuthalIntegralIsTheEnergyOfThePath) {
    for (const double degrees : {0.0, 30.0, 47.0, 60.0, 80.0}) {
        AzimuthalParameters parameters;
        parameters.absorption = Vec3d(0, 0.3, 1.5);
        for (const double width : {0.0, 0.1, 0.5}) {
            parameters.width = width;
            const AzimuthalProfile profile(parameters, degrees * kDegrees);
            for (const Lobe lobe : kLobes) {
                const Vec3d energy = profile.energy(lobe);
                EXPECT_TRUE(integral(profile, lobe, width == 0 ? 4000 : 180).isApprox(energy, 6e-3))
                    << degrees << " " << width << " " << order(lobe);
            }
        }
    }
}

TEST(Azimuthal, EllipticFibresSpreadTheSameEnergy) {
    for (const double ratio : {0.8, 1.0, 1.2}) {
        AzimuthalParameters parameters;
        parameters.axisRatio = ratio;
        const AzimuthalProfile profile(parameters, 0.4);
        EXPECT_NEAR(integral(profile, Lobe::TRT, 4000).x(), profile.energy(Lobe::TRT).x(), 4e-4) << ratio;
        EXPECT_EQ(profile(Lobe::TT, 3.0).x(), AzimuthalProfile({}, 0.4)(Lobe::TT, 3.0).x());
    }
}

/// Where the turn of light with one inner reflection, 4 γ_t − 2 γ_i, is greatest of all offsets.
TEST(Azimuthal, CausticsLieWhereLightTurnsBack) {
    const auto turnsBackAt = [](double ior) {
        double greatest = 0;
        for (int i = 0; i <= 200'000; ++i) {
            const double h = i / 200'000.0;
            greatest = std::max(greatest, 4 * std::asin(h / ior) - 2 * std::asin(h));
        }
        return greatest;
    };
    for (const double ior : {1.2, 1.55, 1.9}) {
        const CausticAzimuths round = causticAzimuths(ior, 1);
        EXPECT_NEAR(round.round, turnsBackAt(ior), 1e-8);
        EXPECT_NEAR(round.least, round.round, 1e-9);
        EXPECT_NEAR(round.greatest, round.round, 1e-9);
    }
    EXPECT_EQ(causticAzimuths(2.1, 1).round, 0);
    // Eq. 47 across and along the long axis.
    const CausticAzimuths elliptic = causticAzimuths(1.55, 1.2);
    EXPECT_NEAR(elliptic.least, turnsBackAt(2 * 0.55 * 1.44 - 1.55 + 2), 1e-8);
    EXPECT_NEAR(elliptic.greatest, turnsBackAt(2 * 0.55 / 1.44 - 1.55 + 2), 1e-8);
    EXPECT_NEAR(causticAzimuths(1.55, 1 / 1.2).greatest, elliptic.greatest, 1e-12) << "either way round";
}

// A path's rays, deflected once more by random amounts, against N: azimuth by azimuth.
TEST(Azimuthal, ProfilesMatchTracedRays) {
    constexpr int kBins = 36;
    constexpr int kRays = 80000;
    for (const double degrees : {0.0, 25.0, 60.0}) {
        for (const double absorption : {0.0, 0.2, 1.0}) {
            test::CylinderTrace cylinder;
            cylinder.absorption = absorption;
            AzimuthalParameters parameters;
            parameters.absorption = Vec3d::Constant(absorption);
            parameters.width = 0.15;
            parameters.causticWidth = 0;
            Random random(17);
            std::array<std::array<double, kBins>, 3> traced{};
            for (int i = 0; i < kRays; ++i) {
                // Even in the angle of incidence, for few rays graze and much of R is theirs.
                const double gamma = ((i + random.uniformDouble()) / kRays - 0.5) * kPi;
                const double share = std::cos(gamma) * kPi / 2 / kRays;
                cylinder.trace(degrees * kDegrees, std::sin(gamma), 2, random, [&](const test::Exit& exit) {
                    const double phi = std::atan2(exit.direction.y(), exit.direction.x()) +
                                       0.15 * test::normalNumber(random);
                    const auto bin = static_cast<std::size_t>((phi / (2 * kPi) + 2) * kBins) % kBins;
                    traced[static_cast<std::size_t>(exit.order)][bin] +=
                        exit.weight * share * kBins / (2 * kPi);
                });
            }
            const AzimuthalProfile profile(parameters, degrees * kDegrees);
            for (const Lobe lobe : kLobes) {
                double peak = 0;
                std::array<double, kBins> model{};
                for (int b = 0; b < kBins; ++b) {
                    for (int k = 0; k < 5; ++k) {
                        model[static_cast<std::size_t>(b)] +=
                            profile(lobe, (b + (k + 0.5) / 5) * 2 * kPi / kBins).x() / 5;
                    }
                    peak = std::max(peak, model[static_cast<std::size_t>(b)]);
                }
                for (std::size_t b = 0; b < kBins; ++b) {
                    EXPECT_NEAR(traced[index(lobe)][b], model[b], 0.045 * peak)
                        << "θ " << degrees << " σ " << absorption << " p " << order(lobe) << " bin " << b;
                }
            }
        }
    }
}

TEST(Azimuthal, TransmittedLightEndsWhereGrazingRaysLeave) {
    const AzimuthalProfile profile({}, 0);
    const double end = 2 * std::asin(1 / 1.55);  // of φ, at h = 1
    EXPECT_EQ(profile(Lobe::TT, end - 0.01).x(), 0);
    EXPECT_GT(profile(Lobe::TT, end + 0.01).x(), 0);
    EXPECT_NEAR(profile(Lobe::TT, kPi).x(), 0.5 * std::pow(1 - std::pow(0.55 / 2.55, 2), 2) / (2 - 2 / 1.55),
                1e-9);
}

TEST(Azimuthal, CausticsAreFiniteAndContinuous) {
    for (const double width : {0.1, 0.25}) {
        AzimuthalParameters parameters;
        parameters.causticWidth = width;
        double before = -1;
        for (double degrees = 20; degrees < 80; degrees += 0.5) {
            const AzimuthalProfile profile(parameters, degrees * kDegrees);
            double maximum = 0;
            for (double phi = 0; phi < kPi; phi += 0.01)
                maximum = std::max(maximum, profile(Lobe::TRT, phi).x());
            EXPECT_LT(maximum, 0.3) << degrees;
            if (before >= 0) {
                EXPECT_NEAR(maximum, before, 0.2 * maximum) << degrees;
            }
            before = maximum;
        }
    }
}

TEST(Azimuthal, TheCubicKeepsTheEnergyAndItsCausticsAreFinite) {
    for (const double degrees : {0.0, 30.0, 47.0, 60.0}) {
        for (const double width : {0.0, 0.2}) {
            AzimuthalParameters parameters;
            parameters.roots = RootMethod::Cubic;
            parameters.width = width;
            parameters.causticWidth = 0.05;
            const AzimuthalProfile profile(parameters, degrees * kDegrees);
            for (const Lobe lobe : kLobes) {
                EXPECT_NEAR(integral(profile, lobe, width == 0 ? 4000 : 180).x(), profile.energy(lobe).x(),
                            8e-3 * profile.energy(Lobe::TT).x())
                    << degrees << " " << width << " " << order(lobe);
            }
            const AzimuthalProfile::Grid grid = profile.grid();
            for (std::size_t i = 0; i < AzimuthalProfile::kGridSize; ++i) {
                EXPECT_LT(grid.trt[0][i], 1.0f) << degrees << " " << width << " " << i;
                if (i % 12 == 0) {
                    const double phi = static_cast<double>(i) * kPi / (AzimuthalProfile::kGridSize - 1);
                    EXPECT_NEAR(static_cast<double>(grid.trt[0][i]), profile(Lobe::TRT, phi).x(), 1e-3) << i;
                }
            }
        }
    }
}

TEST(Azimuthal, GlintsScaleTheCausticAlone) {
    AzimuthalParameters parameters;
    const AzimuthalProfile plain(parameters, 0.2);
    parameters.glint = 3;
    const AzimuthalProfile strong(parameters, 0.2);
    EXPECT_GT(strong(Lobe::TRT, 0.3).x(), 1.5 * plain(Lobe::TRT, 0.3).x());
    EXPECT_EQ(strong(Lobe::TT, 2.5).x(), plain(Lobe::TT, 2.5).x());
}

// The thesis solves Eq. 42 instead of Eq. 40. What that costs is in docs/rendering.md.
TEST(Azimuthal, CubicApproximatesTheExactAngles) {
    for (const double degrees : {0.0, 15.0, 30.0, 40.0, 60.0}) {
        AzimuthalParameters parameters;
        const AzimuthalProfile exact(parameters, degrees * kDegrees);
        parameters.roots = RootMethod::Cubic;
        const AzimuthalProfile cubic(parameters, degrees * kDegrees);
        for (const Lobe lobe : kLobes) {
            double difference = 0;
            for (int i = 0; i < 720; ++i) {
                const double phi = (i + 0.5) * kPi / 720;
                difference += std::abs(exact(lobe, phi).x() - cubic(lobe, phi).x()) * 2 * kPi / 720;
            }
            EXPECT_LT(difference, 0.075 * exact.energy(lobe).x()) << degrees << " " << order(lobe);
        }
    }
}

// The roots of Eq. 42 are angles, so h is their sine. Section 5.2 takes the arcsine, which no angle over 1
// has.
TEST(Azimuthal, OffsetsAreTheSinesOfTheRoots) {
    for (const double degrees : {0.0, 45.0}) {
        AzimuthalParameters parameters;
        const AzimuthalProfile exact(parameters, degrees * kDegrees);
        parameters.roots = RootMethod::Cubic;
        const AzimuthalProfile cubic(parameters, degrees * kDegrees);
        // Reflected light does not enter: its cubic is the line −2γ, which is exact.
        for (const double phi : {0.5, 1.9, 2.5, 3.0}) {
            EXPECT_GT(exact(Lobe::R, phi).x(), 0);
            EXPECT_NEAR(cubic(Lobe::R, phi).x(), exact(Lobe::R, phi).x(), 1e-9) << phi;
        }
    }
}

TEST(Azimuthal, RowsAgreeWithSinglePoints) {
    for (const double width : {0.0, 0.06, 0.2, 0.6}) {
        for (const double ratio : {1.0, 1.15}) {
            AzimuthalParameters parameters;
            parameters.absorption = Vec3d(0.1, 0.5, 2);
            parameters.width = width;
            parameters.axisRatio = ratio;
            const AzimuthalProfile profile(parameters, 0.5);
            const AzimuthalProfile::Grid grid = profile.grid();
            for (std::size_t i = 0; i < AzimuthalProfile::kGridSize; i += 12) {
                const double phi = static_cast<double>(i) * kPi / (AzimuthalProfile::kGridSize - 1);
                const double tolerance = 1e-3;
                EXPECT_NEAR(static_cast<double>(grid.r[i]), profile(Lobe::R, phi).x(), tolerance * 0.05);
                for (std::size_t c = 0; c < 3; ++c) {
                    const int channel = static_cast<int>(c);
                    EXPECT_NEAR(static_cast<double>(grid.tt[c][i]), profile(Lobe::TT, phi)[channel],
                                tolerance)
                        << i;
                    EXPECT_NEAR(static_cast<double>(grid.trt[c][i]), profile(Lobe::TRT, phi)[channel],
                                tolerance * 0.1)
                        << i;
                }
            }
        }
    }
}

}  // namespace
}  // namespace hairloom::shading
