// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/alternatives/hair_particles.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "tests/runtime/hair_block.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

constexpr float kFrame = 1.0f / 60.0f;

HairParticles makeParticles(const HairBlock& hair, const HairParticleSettings& settings, Host host = {}) {
    HairParticles::Result made = HairParticles::make(hair.view(), settings, std::move(host));
    EXPECT_EQ(made.error, "");
    return std::move(*made.particles);
}

HairParticleSettings reach(float radius, float stiffness, float friction) {
    HairParticleSettings s;
    s.radius = radius;
    s.stiffness = stiffness;
    s.friction = friction;
    return s;
}

/// The cubic spline in double precision, by its own formula in the distance over the radius.
double spline(double distance, double radius) {
    const double x = distance / radius, inside = std::max(1.0 - x, 0.0), half = std::max(0.5 - x, 0.0);
    return 16.0 / (std::numbers::pi * radius * radius * radius) *
           (inside * inside * inside - 4.0 * half * half * half);
}

/// Strands at 5 mm from each other carry 1/(5 mm)² of hair: 40,000 m per m³.
TEST(HairParticles, DensityOfAUniformBlockIsThatOfItsHair) {
    const HairBlock hair = blockOfHair(9, 9, 0.005f);
    const HairParticles particles = makeParticles(hair, reach(0.0125f, 1, 0));
    EXPECT_NEAR(particles.restDensities()[hair.middle()], 1.0f / (0.005f * 0.005f), 800.0f);
    EXPECT_NEAR(particles.masses()[hair.middle()], 0.005f, 1e-7f);
    // Outside of it there is no hair, so that a corner has an eighth, and more for what is its own.
    EXPECT_LT(particles.restDensities()[0], 0.35f / (0.005f * 0.005f));
    EXPECT_GT(particles.restDensities()[0], 0.05f / (0.005f * 0.005f));
}

TEST(HairParticles, DensitiesAreTheSumOverAllPairs) {
    const HairBlock hair = blockOfHair(6, 7, 0.004f);
    HairParticles particles = makeParticles(hair, reach(0.011f, 1, 1));
    std::vector<Float3> positions = shaken(hair.positions, 0.003f, 5), velocities(positions.size());
    // Far away, so that the grid of cells is another one.
    for (Float3& p : positions) p = p + Float3{3.0f, -2.0f, 7.0f};
    particles.apply(positions, velocities, kFrame);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        double density = 0.0;
        for (std::size_t j = 0; j < positions.size(); ++j)
            density += static_cast<double>(particles.masses()[j]) *
                       spline(static_cast<double>(length(positions[i] - positions[j])), 0.011);
        EXPECT_NEAR(static_cast<double>(particles.densities()[i]), density, 2e-4 * density) << i;
    }
}

/// A block pressed together by a tenth in each direction: within, densities are alike and nothing pushes, at
/// its sides hair goes outwards, with the gradient of the pressure by differences of the potential energy.
TEST(HairParticles, PressureIsTheGradientOfAnEnergy) {
    const HairBlock hair = blockOfHair(7, 7, 0.005f);
    HairParticles particles = makeParticles(hair, reach(0.012f, 0.01f, 0));
    std::vector<Float3> positions = shaken(hair.positions, 0.0005f, 3);
    for (Float3& p : positions) p = p * 0.9f;
    const auto pressed = [&](std::span<const Float3> at) {
        std::vector<Float3> velocities(at.size());
        particles.apply(at, velocities, kFrame);
        return velocities;
    };
    const std::vector<Float3> kicks = pressed(positions);
    EXPECT_GT(kicks[hair.at(6, 3, 3)].x, 0.0f);
    EXPECT_LT(kicks[hair.at(0, 3, 3)].x, 0.0f);
    // p/ρ² = d(e)/dρ of e = K (ρ0/ρ + ln ρ): −∂/∂x_i Σ m_j e(ρ_j) = m_i a_i. In doubles, by differences.
    const auto energy = [&](const std::vector<Float3>& at) {
        double sum = 0.0;
        for (std::size_t j = 0; j < at.size(); ++j) {
            double density = 0.0;
            for (std::size_t k = 0; k < at.size(); ++k) {
                const double x = static_cast<double>(at[j].x) - static_cast<double>(at[k].x);
                const double y = static_cast<double>(at[j].y) - static_cast<double>(at[k].y);
                const double z = static_cast<double>(at[j].z) - static_cast<double>(at[k].z);
                density += static_cast<double>(particles.masses()[k]) *
                           spline(std::sqrt(x * x + y * y + z * z), 0.012);
            }
            const double rest = static_cast<double>(particles.restDensities()[j]);
            if (density <= rest) continue;
            EXPECT_LT(density, 2.0 * rest) << "the pressure's limit has another energy";
            sum += static_cast<double>(particles.masses()[j]) * 0.01 *
                   (rest / density + std::log(density / rest) - 1.0);
        }
        return sum;
    };
    for (const std::size_t i : {hair.at(6, 3, 3), hair.at(1, 2, 0), hair.at(3, 3, 5)}) {
        std::vector<Float3> moved = positions;
        constexpr float kShift = 2e-5f;
        moved[i].x = positions[i].x + kShift;
        const double after = energy(moved), x1 = static_cast<double>(moved[i].x);
        moved[i].x = positions[i].x - kShift;
        const double force = -(after - energy(moved)) / (x1 - static_cast<double>(moved[i].x));
        const double kick = force / static_cast<double>(particles.masses()[i]) * static_cast<double>(kFrame);
        EXPECT_NEAR(static_cast<double>(kicks[i].x), kick, 0.02 * std::abs(kick) + 2e-5) << i;
    }
}

TEST(HairParticles, HairAtRestFeelsNothing) {
    const HairBlock hair = blockOfHair(6, 6, 0.005f);
    HairParticles particles = makeParticles(hair, reach(0.0f, 10, 20));
    EXPECT_NEAR(particles.radius(), 2.5f * 0.005f, 1e-5f) << "chosen from the spacing";
    std::vector<Float3> velocities(hair.positions.size(), Float3{1, 2, 3});
    const auto report = particles.apply(hair.positions, velocities, kFrame);
    EXPECT_GT(report.pairs, hair.positions.size() * 6);
    for (const Float3& v : velocities) EXPECT_LT(length(v - Float3{1, 2, 3}), 1e-5f);
}

TEST(HairParticles, PairsKeepTheMomentum) {
    const HairBlock hair = blockOfHair(7, 8, 0.005f);
    HairParticles particles = makeParticles(hair, reach(0.013f, 2, 30));
    std::vector<Float3> positions = shaken(hair.positions, 0.004f, 9);
    for (Float3& p : positions) p = p * 0.7f;
    std::vector<Float3> velocities = shaken(std::vector<Float3>(positions.size()), 2.0f, 4);
    const auto before = momentumOf(velocities, particles.masses());
    const std::vector<Float3> first = velocities;
    particles.apply(positions, velocities, kFrame);
    const auto after = momentumOf(velocities, particles.masses());
    double exchanged = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i)
        exchanged += static_cast<double>(particles.masses()[i] * length(velocities[i] - first[i]));
    EXPECT_GT(exchanged, 0.1);
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(after[axis], before[axis], 1e-5 * exchanged) << axis;
}

TEST(HairParticles, SameBitsForAnyNumberOfThreads) {
    const HairBlock hair = blockOfHair(9, 9, 0.005f);
    std::vector<std::vector<Float3>> results;
    for (const Host& host : {Host{}, hostWithThreads(1), hostWithThreads(6), hostWithThreads(3, true)}) {
        HairParticles particles = makeParticles(hair, reach(0.012f, 1, 5), host);
        std::vector<Float3> positions = shaken(hair.positions, 0.004f, 2);
        std::vector<Float3> velocities = shaken(std::vector<Float3>(positions.size()), 1.0f, 8);
        particles.apply(positions, velocities, kFrame);
        results.push_back(velocities);
    }
    for (const auto& other : results)
        EXPECT_EQ(std::memcmp(other.data(), results[0].data(), other.size() * sizeof(Float3)), 0);
}

TEST(HairParticles, BadInputIsRefusedOrLeftOut) {
    const HairBlock hair = blockOfHair(4, 4, 0.005f);
    const auto error = [&](HairParticleSettings s) { return HairParticles::make(hair.view(), s).error; };
    EXPECT_NE(error(reach(-1, 1, 1)).find("radius"), std::string::npos);
    EXPECT_NE(error(reach(0, std::numeric_limits<float>::quiet_NaN(), 1)).find("stiffness"),
              std::string::npos);
    EXPECT_NE(error(reach(0, 1, 2000)).find("friction"), std::string::npos);
    EXPECT_FALSE(HairParticles::make({}, {}).error.empty());
    HairParticles particles = makeParticles(hair, {});
    std::vector<Float3> positions = hair.positions, velocities(positions.size());
    positions[3].x = std::numeric_limits<float>::quiet_NaN();
    positions[5].y = 1e30f;
    velocities[7].z = std::numeric_limits<float>::infinity();
    // One that is far away makes the cells larger, and no more of them.
    positions[9] = {9e5f, 0, 0};
    EXPECT_EQ(particles.apply(positions, velocities, kFrame).leftOut, 3u);
    EXPECT_EQ(velocities[7].z, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        if (i != 7) {
            EXPECT_TRUE(isFinite(velocities[i])) << i;
        }
    }
    const std::vector<Float3> kept = velocities;
    EXPECT_EQ(particles.apply(positions, velocities, 0.0f).pairs, 0u);
    EXPECT_EQ(particles.apply(std::span(positions).first(3), velocities, kFrame).pairs, 0u);
    EXPECT_EQ(std::memcmp(kept.data(), velocities.data(), kept.size() * sizeof(Float3)), 0);
}

}  // namespace
}  // namespace hairloom::runtime
