// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/wind.h"

#include <limits>

#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

struct Double3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

SimulationSettings blowing(WindKind kind) {
    SimulationSettings s = springSettings();
    s.windKind = kind;
    s.windDirection = {0.8f, 0.0f, 0.4f};
    s.windSpeed = 5.0f;
    s.windGustiness = 0.4f;
    s.windSeed = 3;
    return s;
}
Float3 flowOf(const SimulationSettings& s) {
    return s.windDirection * (s.windSpeed / length(s.windDirection));
}

/// What wind.h says, in double precision.
Double3 airAt(const Wind& wind, Float3 at, double time) {
    Double3 sum{wind.mean.x, wind.mean.y, wind.mean.z};
    if (wind.kind == WindKind::uniform) return sum;
    const std::array<float, kWindModes> phases = windPhases(wind, time);
    double waves = 0.0;
    Double3 eddies;
    for (std::size_t m = 0; m < kWindModes; ++m) {
        const WindMode& mode = wind.modes[m];
        const double wave =
            std::sin(2.0 * std::numbers::pi * static_cast<double>(dot(mode.waveVector, at) + phases[m]));
        waves += wave;
        eddies.x += static_cast<double>(mode.amplitude.x) * wave;
        eddies.y += static_cast<double>(mode.amplitude.y) * wave;
        eddies.z += static_cast<double>(mode.amplitude.z) * wave;
    }
    if (wind.kind == WindKind::gusting) {
        const double share = 1.0 + static_cast<double>(wind.strength) *
                                       std::sin(0.5 * std::numbers::pi * waves / std::sqrt(kWindModes / 2.0));
        return {sum.x * share, sum.y * share, sum.z * share};
    }
    return {sum.x + eddies.x, sum.y + eddies.y, sum.z + eddies.z};
}
double lengthOf(Double3 v) {
    return std::hypot(v.x, v.y, v.z);
}
Double3 difference(Double3 a, Double3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

struct Statistics {
    Double3 mean;
    double deviation = 0.0;  ///< root mean square of the distance from the mean flow
    double minimum = 1e9;    ///< along the mean flow
};
Statistics statisticsOf(const Wind& wind) {
    constexpr int kCount = 40000;
    Statistics result;
    const Double3 flow{wind.mean.x, wind.mean.y, wind.mean.z};
    for (int n = 0; n < kCount; ++n) {
        // Golden-ratio steps in space and time, far beyond the sizes and times of gusts.
        const auto turn = [&](double step) { return static_cast<float>(40.0 * std::fmod(n * step, 1.0)); };
        const Double3 v = airAt(wind, {turn(0.8191725134), turn(0.6710436067), turn(0.5497004779)}, 0.77 * n);
        result.mean = {result.mean.x + v.x / kCount, result.mean.y + v.y / kCount,
                       result.mean.z + v.z / kCount};
        const double off = lengthOf(difference(v, flow));
        result.deviation += off * off / kCount;
        result.minimum =
            std::min(result.minimum, (v.x * flow.x + v.y * flow.y + v.z * flow.z) / lengthOf(flow));
    }
    result.deviation = std::sqrt(result.deviation);
    return result;
}

TEST(Wind, MeanAndDeviationAreThoseOfTheSettings) {
    for (const WindKind kind :
         {WindKind::uniform, WindKind::gusting, WindKind::turbulent, WindKind::vehicle}) {
        const SimulationSettings s = blowing(kind);
        const Statistics found = statisticsOf(makeWind(s));
        const Float3 flow = flowOf(s) * (kind == WindKind::vehicle ? -1.0f : 1.0f);
        EXPECT_NEAR(found.mean.x, flow.x, 0.03) << static_cast<int>(kind);
        EXPECT_NEAR(found.mean.y, flow.y, 0.03) << static_cast<int>(kind);
        EXPECT_NEAR(found.mean.z, flow.z, 0.03) << static_cast<int>(kind);
        if (kind == WindKind::uniform) {
            EXPECT_LT(found.deviation, 1e-6);
        } else if (kind == WindKind::gusting) {
            EXPECT_NEAR(found.deviation, 0.7 * 0.4 * 5.0, 0.07);
            EXPECT_GE(found.minimum, 0.6 * 5.0 - 1e-5);
            EXPECT_LT(found.minimum, 0.7 * 5.0);
        } else {
            EXPECT_NEAR(found.deviation, 0.4 * 5.0, 0.04);
        }
    }
}

TEST(Wind, FullGustinessDoesNotTurnAGustRound) {
    SimulationSettings s = blowing(WindKind::gusting);
    s.windGustiness = 1.0f;
    EXPECT_GE(statisticsOf(makeWind(s)).minimum, -1e-5);
}

TEST(Wind, IsContinuousInSpaceAndTime) {
    for (const WindKind kind : {WindKind::gusting, WindKind::turbulent, WindKind::vehicle}) {
        const Wind wind = makeWind(blowing(kind));
        for (int n = 0; n < 2000; ++n) {
            const double time = 0.013 * n;
            const Float3 at{0.01f * static_cast<float>(n % 97), 0.02f * static_cast<float>(n % 31), 0.3f};
            const Double3 here = airAt(wind, at, time);
            // Speeds of 5 m/s, waves of a third of a metre and more.
            EXPECT_LT(lengthOf(difference(airAt(wind, at, time + 1e-4), here)), 0.05);
            EXPECT_LT(lengthOf(difference(airAt(wind, at + Float3{1e-4f, -1e-4f, 0.0f}, time), here)), 0.02);
        }
    }
}

TEST(Wind, EddiesHaveNoDivergence) {
    const Wind wind = makeWind(blowing(WindKind::turbulent));
    for (const WindMode& mode : wind.modes) {
        EXPECT_NEAR(dot(mode.amplitude, mode.waveVector), 0.0f, 1e-5f);
        EXPECT_GT(length(mode.amplitude), 0.1f);
    }
}

TEST(Wind, FrozenEddiesDriftWithTheFlow) {
    for (const WindKind kind : {WindKind::turbulent, WindKind::vehicle}) {
        SimulationSettings s = blowing(kind);
        s.windFrequency = 0.0f;
        const Wind wind = makeWind(s);
        double still = 0.0;
        for (int n = 0; n < 100; ++n) {
            const Float3 at{0.03f * static_cast<float>(n), 0.1f, 0.0f};
            const Float3 downstream = at + wind.mean * 0.25f;
            EXPECT_LT(lengthOf(difference(airAt(wind, downstream, 0.25), airAt(wind, at, 0.0))), 1e-3);
            still = std::max(still, lengthOf(difference(airAt(wind, at, 0.25), airAt(wind, at, 0.0))));
        }
        EXPECT_GT(still, 1.0);
    }
}

TEST(Wind, TheSeedDecides) {
    SimulationSettings s = blowing(WindKind::turbulent);
    const Double3 first = airAt(makeWind(s), {0.1f, 0.2f, 0.3f}, 1.5);
    EXPECT_EQ(lengthOf(difference(airAt(makeWind(s), {0.1f, 0.2f, 0.3f}, 1.5), first)), 0.0);
    s.windSeed = 4;
    EXPECT_GT(lengthOf(difference(airAt(makeWind(s), {0.1f, 0.2f, 0.3f}, 1.5), first)), 1e-3);
}

TEST(Wind, TheInputReplacesTheFlowAndTheVehicleOpposesItsActor) {
    const SimulationSettings vehicle = blowing(WindKind::vehicle);
    const Float3 ride = flowOf(vehicle);
    EXPECT_LT(
        length(makeWind(vehicle, {{}, {0.0f, 0.0f, 3.0f}}).mean - (ride * -1.0f - Float3{0.0f, 0.0f, 3.0f})),
        1e-5f);
    const SimulationSettings turbulent = blowing(WindKind::turbulent);
    EXPECT_LT(length(makeWind(turbulent, {{}, {0.0f, 0.0f, 3.0f}}).mean - ride), 1e-5f);
    const Wind given = makeWind(turbulent, {Float3{0.0f, 1.0f, 0.0f}, {}});
    EXPECT_EQ(given.mean, (Float3{0.0f, 1.0f, 0.0f}));
    EXPECT_NEAR(statisticsOf(given).deviation, 0.4, 0.01);
    // The eddies keep their phases.
    EXPECT_EQ(windPhases(given, 12.5), windPhases(makeWind(turbulent), 12.5));
}

/// Free points 1 cm beside their roots, in `direction` from them, so light that they take on the air's speed.
struct Vane {
    Strands strands;
    SimulationSettings settings = springSettings();

    explicit Vane(SimulationSettings s, Float3 direction = {0.0f, 1.0f, 0.0f}) : settings(s) {
        const SimulationSettings still = bare();
        settings.gravity = still.gravity;
        settings.angularStiffness = 0.0f;
        settings.dampingTime = 0.0f;
        settings.clampedPoints = 1;
        settings.lengthIterations = 0;
        settings.substeps = 1;
        settings.airDrag = 20.0f;
        strands.add({}, direction, 0.01f, 2);
    }
    /// The point's speed after one step of 1 ms from rest, as a share of what broadside hair takes on.
    Float3 taken(const FrameInput& input, std::uint32_t* rejected = nullptr) const {
        Engine engine = makeEngine(strands, settings);
        FrameInput frame = input;
        const std::vector<RootFrame> roots = strands.roots();
        frame.roots_ws = roots;
        frame.dt = 1e-3f;
        engine.step(frame);
        if (rejected) *rejected = engine.lastStep().rejectedWinds;
        std::vector<Float3> v(2);
        engine.readVelocities(v);
        // Position Verlet keeps the velocity of the half step.
        return v[1] * (2.0f / (1.0f - std::exp(-20.0f * 1e-3f)));
    }
};

TEST(Wind, DragGrowsWithTheSineOfTheAngleToTheTangent) {
    const SimulationSettings s = blowing(WindKind::uniform);
    const Float3 flow = flowOf(s);
    const Float3 along = flow * (1.0f / length(flow)), up{0.0f, 1.0f, 0.0f};
    for (const float degrees : {0.0f, 30.0f, 90.0f}) {
        const float angle = degrees * std::numbers::pi_v<float> / 180.0f;
        const Vane vane(s, along * std::cos(angle) + up * std::sin(angle));
        EXPECT_LT(length(vane.taken({}) - flow * std::sin(angle)), 5e-3f) << degrees;
    }
}

TEST(Wind, TheEngineBlowsWhatTheFieldSays) {
    for (const WindKind kind :
         {WindKind::uniform, WindKind::gusting, WindKind::turbulent, WindKind::vehicle}) {
        const SimulationSettings s = blowing(kind);
        const Vane vane(s);
        for (const double time : {0.0, 1.3, 1e5}) {
            FrameInput input;
            input.time = time;
            const Float3 taken = vane.taken(input);
            const Wind wind = makeWind(s);
            const Double3 air = airAt(wind, {0.0f, 0.01f, 0.0f}, time);
            // Sine of the angle to the upright tangent; the kernel's own sine is good to 0.1 %.
            const double share = std::hypot(air.x, air.z) / lengthOf(air);
            EXPECT_LT(lengthOf(difference({taken.x, taken.y, taken.z},
                                          {air.x * share, air.y * share, air.z * share})),
                      0.03)
                << static_cast<int>(kind) << ' ' << time;
        }
    }
}

TEST(Wind, AScriptBlowsEvenWhereTheSettingsAreStill) {
    SimulationSettings s = blowing(WindKind::uniform);
    s.windSpeed = 0.0f;
    FrameInput input;
    input.wind_ws = Float3{0.0f, 0.0f, 7.0f};
    EXPECT_LT(length(Vane(s).taken(input) - *input.wind_ws), 5e-3f);
    // And its calm is a calm.
    s.windSpeed = 5.0f;
    input.wind_ws = Float3{};
    EXPECT_EQ(length(Vane(s).taken(input)), 0.0f);
}

TEST(Wind, AnActorRidesAgainstTheAirOfItsVehicleOnly) {
    FrameInput input;
    input.actorVelocity_ws = {0.0f, 0.0f, 6.0f};
    SimulationSettings s = blowing(WindKind::vehicle);
    s.windSpeed = 0.0f;
    s.windGustiness = 0.0f;
    EXPECT_LT(length(Vane(s).taken(input) - Float3{0.0f, 0.0f, -6.0f}), 5e-3f);
    s.windKind = WindKind::turbulent;
    EXPECT_EQ(length(Vane(s).taken(input)), 0.0f);
}

TEST(Wind, InvalidWindIsIgnoredAndCounted) {
    const Vane vane(blowing(WindKind::vehicle));
    std::uint32_t rejected = 0;
    FrameInput input;
    const Float3 expected = vane.taken(input, &rejected);
    EXPECT_EQ(rejected, 0u);
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 1e30f}) {
        input.wind_ws = Float3{0.0f, bad, 0.0f};
        input.actorVelocity_ws = {bad, 0.0f, 0.0f};
        EXPECT_EQ(vane.taken(input, &rejected), expected);
        EXPECT_EQ(rejected, 2u);
    }
}

/// Whole turns are left out before they can overflow, and time keeps its fraction for centuries.
TEST(Wind, PhasesAreSoundAtAnyTime) {
    SimulationSettings s = springSettings();
    s.windSpeed = 150.0f;
    s.windGustSize = 0.01f;
    s.windFrequency = 20.0f;
    const Wind wind = makeWind(s);
    for (const double time : {0.0, 3.25, 1e6, -1e9, 1e17, 1e300, -1.7e308}) {
        for (const float phase : windPhases(wind, time)) EXPECT_LE(std::abs(phase), 0.5f) << time;
    }
    // A whole number of turns later it is the same phase.
    const double period = 1.0 / static_cast<double>(wind.modes[0].turnsPerSecond);
    EXPECT_NEAR(windPhases(wind, 0.3)[0], windPhases(wind, 0.3 + period * 1e6)[0], 1e-5);
}

/// What the air does at points around a sphere at the origin, in a wind of 1 m/s along x: measured by light
/// points that hang across the plane of x and the place, in which the air stays.
std::vector<Float3> airAround(std::span<const Float3> places, float radius, float shelter) {
    SimulationSettings s = blowing(WindKind::uniform);
    s.windDirection = {1.0f, 0.0f, 0.0f};
    s.windSpeed = 1.0f;
    s.windShelter = shelter;
    Vane vane(s);
    vane.strands = {};
    for (const Float3& place : places) {
        const Float3 across = cross(Float3{1.0f, 0.0f, 0.0f}, place);
        const float size = length(across);
        const Float3 along = size > 1e-6f ? across * (1.0f / size) : Float3{0.0f, 0.0f, 1.0f};
        vane.strands.add(place - along * 1e-4f, along, 1e-4f, 2);
    }
    Engine engine = makeEngine(vane.strands, vane.settings);
    const std::vector<RootFrame> roots = vane.strands.roots();
    const Sphere sphere{{}, radius};
    engine.step({1e-3f, 0.0, roots, std::span(&sphere, 1)});
    std::vector<Float3> velocities(engine.pointCount()), found;
    engine.readVelocities(velocities);
    for (std::size_t p = 1; p < velocities.size(); p += 2)
        found.push_back(velocities[p] * (2.0f / (1.0f - std::exp(-20.0f * 1e-3f))));
    return found;
}

TEST(Lee, NoAirGoesThroughTheSphereAndTheFarFieldIsOpen) {
    constexpr float kRadius = 0.1f;
    std::vector<Float3> front, far;
    for (int n = 0; n <= 90; n += 5) {
        const float angle = static_cast<float>(n) * std::numbers::pi_v<float> / 180.0f;
        // Just outside, or the collision takes the point.
        front.push_back(Float3{-std::cos(angle), std::sin(angle), 0.0f} * (1.003f * kRadius));
        far.push_back(Float3{-std::cos(angle), std::sin(angle), 0.0f} * (20.0f * kRadius));
    }
    const std::vector<Float3> skin = airAround(front, kRadius, 1.0f), away = airAround(far, kRadius, 1.0f);
    for (std::size_t n = 0; n < front.size(); ++n) {
        const Float3 normal = front[n] * (1.0f / length(front[n]));
        EXPECT_LT(std::abs(dot(skin[n], normal)), 0.02f) << n;
        // Potential flow slides by 3/2 sin θ (Lamb 1932, Article 96).
        EXPECT_NEAR(length(skin[n]), 1.5f * normal.y, 0.02f) << n;
        EXPECT_LT(length(away[n] - Float3{1.0f, 0.0f, 0.0f}), 0.01f) << n;
    }
}

TEST(Lee, TheWakeCarriesTheDragAwayAtEveryDistance) {
    constexpr float kRadius = 0.1f;
    for (const float distance : {6.0f, 12.0f, 30.0f}) {  // radii
        // ∫ u (1 − u) dA over the plane is the drag by density and U² (Batchelor 1967, Section 5.12).
        std::vector<Float3> places;
        std::vector<double> edges{0.0};
        for (int n = 0; n < 400; ++n) edges.push_back(1e-3 * std::pow(4e5, n / 399.0));  // (ρ/R)², to 20 R
        for (std::size_t n = 0; n + 1 < edges.size(); ++n) {
            const auto across = static_cast<float>(std::sqrt(0.5 * (edges[n] + edges[n + 1])));
            places.push_back(Float3{distance, across, 0.0f} * kRadius);
        }
        const std::vector<Float3> air = airAround(places, kRadius, 1.0f);
        double lost = 0.0;
        for (std::size_t n = 0; n < air.size(); ++n) {
            const double u = static_cast<double>(air[n].x);
            lost += u * (1.0 - u) * (edges[n + 1] - edges[n]);
        }
        // The disc ends where the open flow around the sphere is still slower by what its dipole takes back.
        const double s = static_cast<double>(distance), rim = std::sqrt(s * s + edges.back());
        EXPECT_NEAR(lost, 0.47 / 2.0 + 1.0 / rim - s * s / (rim * rim * rim), 0.01) << distance;
    }
}

TEST(Lee, TheAirStandsBehindAndSettingsBlend) {
    const std::vector<Float3> places{{0.15f, 0.0f, 0.0f}, {0.5f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}};
    const auto full = airAround(places, 0.1f, 1.0f), half = airAround(places, 0.1f, 0.5f),
               none = airAround(places, 0.1f, 0.0f);
    EXPECT_LT(length(full[0]), 0.02f);
    EXPECT_LT(full[0].x, full[1].x);
    EXPECT_LT(full[1].x, full[2].x);
    for (std::size_t n = 0; n < places.size(); ++n) {
        EXPECT_NEAR(none[n].x, 1.0f, 5e-3f);
        EXPECT_NEAR(half[n].x, 0.5f * (full[n].x + none[n].x), 1e-3f);
    }
}

TEST(Lee, ASphereWithoutASizeCastsNone) {
    const std::vector<Float3> places{{0.15f, 0.0f, 0.0f}};
    for (const float radius : {1e-20f, 1e-30f, 1e-8f})
        EXPECT_NEAR(airAround(places, radius, 1.0f)[0].x, 1.0f, 5e-3f);
}

TEST(Lee, RodsBehindASphereHardlyMove) {
    const auto blown = [](float shelter) {
        SimulationSettings s;
        s.angularStiffness = 0.001f;
        s.windKind = WindKind::uniform;
        s.windDirection = {1.0f, 0.0f, 0.0f};
        s.windSpeed = 4.0f;
        s.windShelter = shelter;
        Strands strands;
        strands.add({0.16f, 0.03f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.006f, 10);
        Engine engine = makeEngine(strands, s);
        const Sphere sphere{{}, 0.12f};
        run(engine, strands, 60, 1.0f / 60.0f, std::span(&sphere, 1));
        return length(positionsOf(engine).back() - strands.points.back());
    };
    const float open = blown(0.0f);
    EXPECT_GT(open, 0.01f);
    EXPECT_LT(blown(1.0f), 0.25f * open);
}

}  // namespace
}  // namespace hairloom::runtime
