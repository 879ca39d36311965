// SPDX-License-Identifier: GPL-3.0-or-later
// The advice on stable steps: its frequencies against dense eigenvalues and closed forms, its words and
// offers.
#include "hairloom/stable.h"

#include <Eigen/Eigenvalues>

#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Strands straight(std::uint32_t points, float segment) {
    Strands strands;
    strands.add({0.1f, 0.3f, 0.0f}, {0.6f, 0.8f, 0.0f}, segment, points);
    return strands;
}

/// Masses of an even rod, of mean 1.
Eigen::VectorXd evenMasses(int points) {
    Eigen::VectorXd m = Eigen::VectorXd::Ones(points);
    m(0) = m(points - 1) = 0.5;
    return m / m.mean();
}

/// √ of the greatest eigenvalue of M⁻¹K over the points from `first` on.
double fastestOf(const Eigen::MatrixXd& K, const Eigen::VectorXd& masses, int first) {
    const int free = static_cast<int>(masses.size()) - first;
    const Eigen::VectorXd inverse = masses.tail(free).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled =
        inverse.asDiagonal() * K.bottomRightCorner(free, free) * inverse.asDiagonal();
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues().maxCoeff());
}

TEST(Stable, FindsTheFastestWaveOfCoilSprings) {
    for (const std::uint32_t clamped : {1u, 2u}) {
        SimulationSettings s = bare();
        s.clampedPoints = clamped;
        s.lengthMethod = LengthMethod::springs;
        s.springFrequency = 150.0f;
        const Eigen::VectorXd m = evenMasses(12);
        Eigen::MatrixXd K = Eigen::MatrixXd::Zero(12, 12);
        for (int e = 0; e < 11; ++e) {
            const double k = std::pow(kTurn * 150.0, 2) * 2.0 / (1.0 / m(e) + 1.0 / m(e + 1));
            K(e, e) += k, K(e + 1, e + 1) += k, K(e, e + 1) -= k, K(e + 1, e) -= k;
        }
        const double expected = fastestOf(K, m, static_cast<int>(clamped));
        EXPECT_NEAR(fastestWaves(straight(12, 0.01f).view(), s).coils, expected, 1e-4 * expected);
    }
}

TEST(Stable, FindsTheFastestWaveOfAngularSprings) {
    for (const std::uint32_t clamped : {1u, 2u}) {
        SimulationSettings s = bare();
        s.clampedPoints = clamped;
        s.angularStiffness = 0.4f;
        s.angularCurve = {};
        constexpr int kPoints = 14;
        constexpr double l = 0.01;
        const Eigen::VectorXd m = evenMasses(kPoints);
        Eigen::MatrixXd K = Eigen::MatrixXd::Zero(kPoints, kPoints);
        for (int j = static_cast<int>(clamped) - 1; j + 1 < kPoints; ++j) {
            // The last clamped joint bends over half of its outer segment only; μ = m / h.
            const double reach = j == static_cast<int>(clamped) - 1 ? 0.5 * l : l;
            const double kappa = kHairBendingStiffness * 0.4 / 0.6 * m(j) / (j == 0 ? 0.5 * l : l) / reach;
            Eigen::VectorXd row = Eigen::VectorXd::Zero(kPoints);
            row(j + 1) += 1.0 / l, row(j) -= 1.0 / l;
            if (j > 0) row(j) -= 1.0 / l, row(j - 1) += 1.0 / l;
            K += kappa * row * row.transpose();
        }
        const double expected = fastestOf(K, m, static_cast<int>(clamped));
        EXPECT_NEAR(fastestWaves(straight(kPoints, 0.01f).view(), s).bending, expected, 1e-4 * expected);
    }
}

TEST(Stable, AHangingPairOfPointsSwingsAsAPendulum) {
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    EXPECT_NEAR(fastestWaves(straight(2, 0.25f).view(), s).tension, std::sqrt(9.81 / 0.25), 1e-4);
}

TEST(Stable, DefaultsAreStableWithWhateverHair) {
    for (const float segment : {1e-5f, 1e-3f, 0.1f}) {
        const StableAdvice advice = adviseStability(straight(32, segment).view(), {}, 0.25f);
        EXPECT_TRUE(advice.region.stable());
        EXPECT_EQ(advice.words, "");
        EXPECT_TRUE(advice.offers.empty());
    }
}

TEST(Stable, OffersSubstepsWhereTheySuffice) {
    SimulationSettings s = springSettings();
    s.integrator = Integrator::velocityVerlet;
    const Strands strands = straight(16, 0.006f);
    const StableAdvice advice = adviseStability(strands.view(), s, 1.0f / 60.0f);
    EXPECT_EQ(advice.region.cause, Stiff::bending);
    EXPECT_GT(advice.region.factor, 1.0);
    EXPECT_NE(advice.words, "");
    ASSERT_GE(advice.offers.size(), 2u);
    SimulationSettings finer = advice.offers[0].settings;
    EXPECT_GT(finer.substeps, s.substeps);
    finer.substeps = s.substeps;
    EXPECT_EQ(finer, s) << "nothing else is changed";
    for (const StableOffer& offer : advice.offers) {
        EXPECT_LE(stableRegion(strands.view(), offer.settings, 1.0f / 60.0f).factor, 0.9) << offer.words;
        EXPECT_TRUE(validate(offer.settings).empty());
    }
    // One fewer would not do.
    SimulationSettings fewer = advice.offers[0].settings;
    --fewer.substeps;
    EXPECT_GT(stableRegion(strands.view(), fewer, 1.0f / 60.0f).factor, 0.9);
}

TEST(Stable, FindsTheStepAtWhichEachIntegratorFails) {
    const Strands strands = straight(16, 0.006f);
    SimulationSettings s = springSettings();
    const FastestWaves waves = fastestWaves(strands.view(), s);
    const auto isStableAt = [&](double h) {
        SimulationSettings one = s;
        one.substeps = 1;
        return stableRegion(strands.view(), one, static_cast<float>(h)).stable();
    };
    for (const Integrator integrator : {Integrator::velocityVerlet, Integrator::leapfrog, Integrator::rk4}) {
        s.integrator = integrator;
        const double longest = longestStableStep(waves, s);
        ASSERT_GT(longest, 1e-6);
        ASSERT_LT(longest, 1.0 / 60);
        EXPECT_TRUE(isStableAt(0.999 * longest));
        EXPECT_FALSE(isStableAt(1.001 * longest));
    }
    s.integrator = Integrator::verlet;
    EXPECT_TRUE(std::isinf(longestStableStep(waves, s))) << "solves its bending implicitly";
    s.integrator = Integrator::explicitEuler;
    s.dampingTime = 0.0f;
    EXPECT_EQ(longestStableStep(waves, s), 0.0) << "nothing damps what it amplifies";
}

TEST(Stable, OffersImplicitMethodsWhereSubstepsDoNotSuffice) {
    for (const Integrator integrator :
         {Integrator::velocityVerlet, Integrator::leapfrog, Integrator::rk4, Integrator::explicitEuler}) {
        SimulationSettings s = springSettings();
        s.integrator = integrator;
        s.dampingTime = 0.0f;
        const Strands strands = straight(32, 0.0003f);
        const StableAdvice advice = adviseStability(strands.view(), s, 1.0f / 60.0f);
        ASSERT_EQ(advice.offers.size(), 3u);
        EXPECT_EQ(advice.offers[0].settings.integrator, Integrator::verlet);
        EXPECT_EQ(advice.offers[1].settings.integrator, Integrator::implicitEuler);
        EXPECT_EQ(advice.offers[2].settings.strandModel, StrandModel::rods);
        EXPECT_EQ(std::isinf(advice.region.factor), integrator == Integrator::explicitEuler);
    }
}

TEST(Stable, KnowsThatDragIsStiffForForces) {
    SimulationSettings s = bare();
    s.airDrag = 1000.0f;
    s.integrator = Integrator::leapfrog;
    EXPECT_EQ(stableRegion(straight(8, 0.02f).view(), s, 1.0f / 60.0f).cause, Stiff::air);
    EXPECT_GT(stableRegion(straight(8, 0.02f).view(), s, 1.0f / 60.0f).factor, 1.0);
    s.integrator = Integrator::verlet;
    EXPECT_TRUE(stableRegion(straight(8, 0.02f).view(), s, 1.0f / 60.0f).stable());
}

/// Strands of 15 cm that turn by `turn` radians from root to tip, level where they grow.
Strands curled(float turn, std::uint32_t count = 3) {
    constexpr int kPoints = 24;
    Strands strands;
    for (std::uint32_t s = 0; s < count; ++s) {
        std::vector<Float3> strand{{0.01f * static_cast<float>(s), 0.0f, 0.0f}};
        for (int i = 1; i < kPoints; ++i) {
            const float angle = 1.5f + turn * static_cast<float>(i - 1) / (kPoints - 2);
            const Float3 way{std::sin(angle), -std::cos(angle), turn > 3.0f ? 0.3f : 0.0f};
            strand.push_back(strand.back() + way * (0.15f / (kPoints - 1)));
        }
        strands.add(strand);
    }
    return strands;
}

/// Greatest speed in the last of ten seconds.
float fastestAfterTenSeconds(const Strands& strands, const SimulationSettings& settings) {
    Engine engine = makeEngine(strands, settings);
    std::vector<Float3> velocities(engine.pointCount());
    float fastest = 0.0f;
    for (int f = 0; f < 600; ++f) {
        run(engine, strands, 1);
        engine.readVelocities(velocities);
        for (const Float3& v : velocities)
            if (f >= 540) fastest = std::max(fastest, length(v));
    }
    return fastest;
}

TEST(Stable, SaysWhichSpringsTrembleAndWhatDoesNot) {
    for (const Integrator integrator : {Integrator::implicitEuler, Integrator::verlet}) {
        for (const float turn : {0.0f, 0.2f, 16.0f}) {
            SCOPED_TRACE(std::string(nameOf(integrator)) + " " + std::to_string(turn));
            SimulationSettings s = springSettings();
            s.integrator = integrator;
            const Strands strands = curled(turn);
            const StableAdvice advice = adviseStability(strands.view(), s, 1.0f / 60.0f);
            EXPECT_TRUE(advice.region.stable());
            EXPECT_EQ(advice.rest.strands, 3u);
            const bool trembles = turn > 1.0f;
            EXPECT_EQ(advice.rest.moving, trembles ? 3u : 0u);
            EXPECT_EQ(!advice.words.empty(), trembles);
            EXPECT_EQ(fastestAfterTenSeconds(strands, s) > 0.005f, trembles);
            ASSERT_EQ(!advice.offers.empty(), trembles);
            for (const StableOffer& offer : advice.offers)
                EXPECT_LT(fastestAfterTenSeconds(strands, offer.settings), 0.005f) << offer.words;
        }
    }
}

TEST(Stable, OffersNothingThatTrembles) {
    SimulationSettings s = springSettings();
    s.integrator = Integrator::leapfrog;
    s.substeps = 1;
    const StableAdvice advice = adviseStability(curled(16.0f).view(), s, 1.0f / 60.0f);
    EXPECT_FALSE(advice.region.stable());
    for (std::size_t i = 0; i + 1 < advice.offers.size(); ++i)
        EXPECT_EQ(advice.offers[i].settings.integrator, Integrator::leapfrog) << "of more substeps";
    EXPECT_EQ(advice.offers.back().settings.strandModel, StrandModel::rods);
}

/// The one curl among straight hair is among those that are tried; hair that is not damped does not count.
TEST(Stable, FindsTheStrandThatTrembles) {
    Strands strands = curled(0.0f, 300);
    const Strands curl = curled(16.0f, 1);
    strands.add(curl.points);
    SimulationSettings s = springSettings();
    s.integrator = Integrator::implicitEuler;
    EXPECT_EQ(tryRest(strands.view(), s, 1.0f / 60.0f).moving, 1u);
    s.dampingTime = 0.0f;
    EXPECT_FALSE(tryRest(curled(0.0f).view(), s, 1.0f / 60.0f).trembles());
    // Nobody waits for a trial of hours.
    s.substeps = kMaxSubsteps;
    EXPECT_EQ(tryRest(straight(kMaxPoints, 0.001f).view(), s, 1.0f / 60.0f).strands, 0u);
}

/// Largest position of a damped oscillator of ω h = `wave` after many substeps, relative to the start, as
/// position Verlet and explicit Euler take it with the share `kept` of the velocity.
double swingAfter(Integrator integrator, double wave, double kept) {
    double x = 1.0, u = 0.0, maximum = 0.0;
    for (int i = 0; i < 4000 && std::abs(x) < 1e9; ++i) {
        const double before = x, moving = kept * u;
        u = moving - wave * wave * before;
        x = before + (integrator == Integrator::explicitEuler ? moving : u);
        if (i > 3000 || std::abs(x) > 1e6) maximum = std::max(maximum, std::abs(x));
    }
    return maximum;
}

TEST(Stable, LimitsWithDampingAreThoseOfTheRecursion) {
    const double h = 1.0 / 480.0;
    for (const Integrator integrator : {Integrator::verlet, Integrator::explicitEuler}) {
        SimulationSettings s = springSettings();
        s.integrator = integrator;
        s.dampingTime = 0.1f;
        const double limit = stableLimit(s, h), kept = std::exp(-h / 0.1);
        EXPECT_LT(swingAfter(integrator, 0.98 * limit, kept), 1.0);
        EXPECT_GT(swingAfter(integrator, 1.02 * limit, kept), 2.0);
    }
}

}  // namespace
}  // namespace hairloom::runtime
