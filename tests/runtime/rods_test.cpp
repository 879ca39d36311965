// SPDX-License-Identifier: GPL-3.0-or-later
// Strands as elastic rods: statics against the Kirchhoff rod, shapes that are kept, and what nothing may
// break.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

SimulationSettings rods(float stiffness = 0.5f) {
    SimulationSettings s;
    s.strandModel = StrandModel::rods;
    s.angularStiffness = stiffness;
    s.angularCurve = Ramp();
    s.restGravity = 0.0f;
    s.sleepSpeed = 0.0f;
    s.substeps = 2;
    return s;
}

Float3 unit(Float3 v) {
    return v * (1.0f / length(v));
}

/// A right-handed helix about a line straight down, its first point at the origin.
struct Helix {
    double radius, pitch, turns;  // metres, metres, 1
    std::uint32_t pointsPerTurn;

    Strands strand(std::uint32_t count = 1) const {
        const Float3 down{0.0f, -1.0f, 0.0f};
        const Float3 a = unit(cross(down, {0.3f, 0.9f, 0.1f})), b = cross(down, a);
        const auto segments = static_cast<std::uint32_t>(turns * pointsPerTurn);
        Strands strands;
        for (std::uint32_t s = 0; s < count; ++s) {
            for (std::uint32_t p = 0; p <= segments; ++p) {
                const double t = 2.0 * std::numbers::pi * turns * p / segments;
                const auto across = static_cast<float>(radius * (std::cos(t) - 1.0));
                const auto along = static_cast<float>(radius * std::sin(t));
                const auto fallen = static_cast<float>(pitch * t / (2.0 * std::numbers::pi));
                strands.points.push_back(Float3{0.01f * static_cast<float>(s), 0.0f, 0.0f} + a * across +
                                         b * along + down * fallen);
            }
            strands.offsets.push_back(static_cast<std::uint32_t>(strands.points.size()));
        }
        return strands;
    }
};

float fastestOf(const Engine& engine) {
    std::vector<Float3> velocities(engine.pointCount());
    engine.readVelocities(velocities);
    float fastest = 0.0f;
    for (const Float3& v : velocities) fastest = std::max(fastest, length(v));
    return fastest;
}

double rmsBetween(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double apart = static_cast<double>(length(a[i] - b[i]));
        sum += apart * apart;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// --- Statics ---

/// Tip drops of the Kirchhoff rod, solved as a boundary value problem and, by another program, as discrete
/// rods refined to their limit; the two agree to a micrometre. Round hair of 80 µm, GJ/EI 0.75, clamped at
/// the top.
struct HangingHelix {
    double radius, pitch, turns, stiffness, drop;  // mm, mm, 1, 1, mm
};
class HangingHelices : public testing::TestWithParam<HangingHelix> {};

TEST_P(HangingHelices, DropAsTheKirchhoffRodDoes) {
    const HangingHelix& given = GetParam();
    for (const std::uint32_t pointsPerTurn : {12u, 24u}) {
        const Strands strand =
            Helix{1e-3 * given.radius, 1e-3 * given.pitch, given.turns, pointsPerTurn}.strand();
        Engine engine = makeEngine(strand, rods(static_cast<float>(given.stiffness)));
        run(engine, strand, 600);
        const double drop = 1e3 * static_cast<double>(strand.points.back().y - positionsOf(engine).back().y);
        EXPECT_NEAR(drop / given.drop, 1.0, pointsPerTurn == 12 ? 0.046 : 0.012)
            << pointsPerTurn << " points a turn";
        EXPECT_LT(fastestOf(engine), 1e-4f);
    }
}
INSTANTIATE_TEST_SUITE_P(
    Table, HangingHelices,
    testing::Values(HangingHelix{3, 10, 4, 0.2, 1.296}, HangingHelix{8, 6, 2, 0.2, 12.564},
                    HangingHelix{8, 30, 6, 0.2, 84.464}, HangingHelix{12, 10, 6, 0.2, 290.298},
                    HangingHelix{5, 20, 4, 0.5, 2.655}, HangingHelix{8, 20, 4, 0.5, 14.120},
                    HangingHelix{12, 10, 4, 0.5, 61.740}, HangingHelix{12, 30, 4, 0.9, 8.440}));

TEST(Rods, ManyPointsAndSubstepsDropAsFewDo) {
    // 3 mm, 20 mm, 4 turns, by the same programs 14.120 mm.
    for (const std::uint32_t pointsPerTurn : {32u, 127u}) {
        for (const std::uint32_t substeps : {2u, 16u, 64u}) {
            const Strands strand = Helix{8e-3, 20e-3, 4, pointsPerTurn}.strand();
            SimulationSettings s = rods();
            s.substeps = substeps;
            Engine engine = makeEngine(strand, s);
            run(engine, strand, 360);
            const float drop = strand.points.back().y - positionsOf(engine).back().y;
            EXPECT_NEAR(drop, 14.120e-3f, pointsPerTurn == 32 ? 0.07e-3f : 0.03e-3f)
                << pointsPerTurn << ", " << substeps;
        }
    }
}

TEST(Rods, TwistStiffnessDecidesWhatACoilDrops) {
    // 8 mm, 20 mm, 4 turns, s 0.5.
    for (const auto& [ratio, drop] : {std::pair{0.1f, 48.045}, {0.5f, 18.826}, {1.0f, 11.468}}) {
        const Strands strand = Helix{8e-3, 20e-3, 4, 24}.strand();
        SimulationSettings s = rods();
        s.torsionRatio = ratio;
        Engine engine = makeEngine(strand, s);
        run(engine, strand, 600);
        const double fell = 1e3 * static_cast<double>(strand.points.back().y - positionsOf(engine).back().y);
        EXPECT_NEAR(fell / drop, 1.0, 0.03) << "GJ/EI " << ratio;
    }
}

// --- Shape ---

TEST(Rods, ShapeThatCarriesItsWeightDoesNotMove) {
    const Strands strand = Helix{6e-3, 15e-3, 5, 16}.strand();
    SimulationSettings s = rods(0.3f);
    s.restGravity = 1.0f;
    Engine engine = makeEngine(strand, s);
    run(engine, strand, 120);
    EXPECT_LT(rmsBetween(positionsOf(engine), strand.points), 2e-6);
}

/// Shapes that no hair of theirs could hold: it is made as stiff as it takes.
TEST(Rods, AnyShapeIsHeldAndComesBack) {
    Strands level, upright;
    level.add({}, {1.0f, 0.0f, 0.0f}, 0.012f, 26);
    upright.add({}, unit({0.07f, 1.0f, 0.0f}), 0.012f, 26);
    for (const Strands& strand : {level, upright, Helix{10e-3, 20e-3, 6, 12}.strand()}) {
        for (const float stiffness : {0.03f, 0.3f, 0.6f}) {
            SimulationSettings s = rods(stiffness);
            s.restGravity = 1.0f;
            Engine engine = makeEngine(strand, s);
            for (int frame = 0; frame < 120; ++frame) {
                const auto t = static_cast<float>(frame);
                const std::vector<RootFrame> roots =
                    strand.roots({0.05f * std::sin(0.7f * t), 0.0f, 0.05f * std::cos(0.9f * t)});
                engine.step({1.0f / 60.0f, frame / 60.0, roots});
            }
            run(engine, strand, 900);
            EXPECT_LT(rmsBetween(positionsOf(engine), strand.points), 1e-4) << stiffness;
        }
    }
}

TEST(Rods, CurlsComeBackAfterAShake) {
    const Strands strand = Helix{8e-3, 20e-3, 4, 12}.strand(40);
    SimulationSettings s = rods();
    s.restGravity = 1.0f;
    Engine engine = makeEngine(strand, s);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> anywhere(-0.1f, 0.1f);
    for (int frame = 0; frame < 120; ++frame) {
        const Float3 shift =
            frame % 3 == 0 ? Float3{anywhere(random), anywhere(random), anywhere(random)} : Float3{};
        const std::vector<RootFrame> roots =
            strand.roots(shift, turnAbout({0.0f, 1.0f, 0.0f}, 8.0f * anywhere(random)));
        engine.step({1.0f / 60.0f, frame / 60.0, roots});
    }
    run(engine, strand, 600);
    EXPECT_LT(rmsBetween(positionsOf(engine), strand.points), 1e-3);
    EXPECT_LT(fastestOf(engine), 1e-3f);
}

TEST(Rods, FoldedHairUnfolds) {
    // The root turns over at once: the first free vertex is bent back by 180°. Hair as stiff as this stands
    // up.
    Strands strand;
    strand.add({}, {0.0f, -1.0f, 0.0f}, 0.005f, 12);
    Engine engine = makeEngine(strand, rods(0.8f));
    const Quat over = turnAbout({1.0f, 0.0f, 0.0f}, 3.14159f);
    for (int frame = 0; frame < 300; ++frame) {
        const std::vector<RootFrame> roots{{{}, over}};
        engine.step({1.0f / 60.0f, frame / 60.0, roots});
    }
    EXPECT_GT(positionsOf(engine).back().y, 0.0549f);
    EXPECT_LT(fastestOf(engine), 1e-3f);
}

TEST(Rods, SegmentsKeepTheirLength) {
    const Strands strand = Helix{8e-3, 20e-3, 4, 12}.strand();
    Engine engine = makeEngine(strand, rods(0.1f));
    for (int frame = 0; frame < 60; ++frame) {
        const std::vector<RootFrame> roots =
            strand.roots({0.2f * std::sin(static_cast<float>(frame)), 0.0f, 0.0f});
        engine.step({1.0f / 60.0f, frame / 60.0, roots});
    }
    EXPECT_LT(engine.measure().maxStretch, 1e-5);
}

// --- Energy ---

TEST(Rods, EnergyDoesNotGrowWhileTheHeadIsStill) {
    Strands strand;
    strand.add({}, {1.0f, 0.0f, 0.0f}, 0.01f, 17);
    SimulationSettings s = rods();
    s.dampingTime = 0.0f;
    s.airDrag = 0.0f;
    s.bendDampingTime = 0.0f;
    s.substeps = 8;
    Engine engine = makeEngine(strand, s);
    const std::vector<RootFrame> roots = strand.roots();
    double highest = engine.measure().potentialEnergy;
    for (int frame = 0; frame < 600; ++frame) {
        engine.step({1.0f / 60.0f, frame / 60.0, roots});
        const Measurements m = engine.measure();
        // Where it began it had no energy of motion or shape; those are never negative.
        EXPECT_LT(m.kineticEnergy + m.potentialEnergy, highest + 1e-5);
    }
}

// --- Contacts ---

TEST(Rods, HairRestsOnASphereOutsideIt) {
    Strands strand;
    for (int i = 0; i < 20; ++i)
        strand.add({0.002f * static_cast<float>(i - 10), 0.15f, 0.0f}, {0.0f, 0.0f, 1.0f}, 0.008f, 24);
    SimulationSettings s = rods(0.1f);
    s.substeps = 4;
    Engine engine = makeEngine(strand, s);
    const Sphere sphere{{0.0f, 0.0f, 0.06f}, 0.1f};
    run(engine, strand, 600, 1.0f / 60.0f, {&sphere, 1});
    EXPECT_LT(engine.measure().maxPenetration, 0.5e-3);
    EXPECT_LT(fastestOf(engine), 2e-3f);
    // Some of it lies on the sphere.
    bool touches = false;
    for (const Float3& p : positionsOf(engine)) touches = touches || length(p - sphere.center_ws) < 0.1025f;
    EXPECT_TRUE(touches);
}

TEST(Rods, AFastSphereDoesNotPassThrough) {
    Strands strand;
    strand.add({}, {0.0f, -1.0f, 0.0f}, 0.01f, 21);
    Engine engine = makeEngine(strand, rods(0.2f));
    const std::vector<RootFrame> roots = strand.roots();
    std::vector<Sphere> spheres{{{0.0f, -0.15f, -0.5f}, 0.03f}};
    for (int frame = 0; frame < 10; ++frame) engine.step({1.0f / 60.0f, frame / 60.0, roots, spheres});
    for (int frame = 0; frame < 4; ++frame) {
        spheres[0].center_ws.z += 0.18f;  // eleven metres a second
        engine.step({1.0f / 60.0f, (10 + frame) / 60.0, roots, spheres});
    }
    EXPECT_GT(positionsOf(engine).back().z, 0.0f);  // taken along
}

// --- What nothing may break ---

struct Storm {
    unsigned seed;
    float airDrag, dampingTime;
};

TEST(Rods, NoStormLeavesATrace) {
    std::mt19937 random(11);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    const auto spread = [&](float low, float high) {
        return low * std::pow(high / low, between(0.0f, 1.0f));
    };
    std::size_t calm = 0;
    constexpr std::size_t kStorms = 120;
    for (std::size_t storm = 0; storm < kStorms; ++storm) {
        const auto points = static_cast<std::uint32_t>(spread(3.0f, 200.0f));
        Strands strand;
        if (storm % 2 == 0) {
            strand.add({}, {1.0f, 0.0f, 0.0f}, spread(0.005f, 1.5f) / static_cast<float>(points - 1), points);
        } else {
            const float turns = between(0.5f, 8.0f);
            const auto each = std::max(4u, static_cast<std::uint32_t>(static_cast<float>(points) / turns));
            strand =
                Helix{spread(0.001f, 0.03f), spread(0.002f, 0.05f), std::floor(turns) + 1.0, each}.strand();
        }
        if (strand.points.size() > kMaxPoints) continue;
        SimulationSettings s = rods(between(0.05f, 0.97f));
        s.substeps = 1 + random() % 4;
        s.restGravity = static_cast<float>(random() % 2);
        s.bendDampingTime = random() % 2 ? 0.03f : 0.0f;
        s.clampedPoints = 1 + random() % 2;
        s.torsionRatio = spread(0.3f, 2.0f);
        if (storm % 3 == 0) s.sectionRatio = spread(0.2f, 1.0f);
        s.teleportDistance = 10000.0f;
        Engine engine = makeEngine(strand, s);
        std::vector<RootFrame> roots(1);
        std::vector<Sphere> spheres(random() % 3, Sphere{{}, spread(0.01f, 0.2f)});
        for (int frame = 0; frame < 120; ++frame) {
            if (random() % 4 == 0)
                roots[0].position = {between(-5.0f, 5.0f), between(-5.0f, 5.0f), between(-5.0f, 5.0f)};
            if (random() % 3 == 0) {
                roots[0].rotation = {between(-1.0f, 1.0f), between(-1.0f, 1.0f), between(-1.0f, 1.0f), 0.1f};
                normalize(roots[0].rotation);
            }
            for (Sphere& sphere : spheres) {
                sphere.center_ws = roots[0].position +
                                   Float3{between(-0.5f, 0.5f), between(-0.5f, 0.5f), between(-0.5f, 0.5f)};
            }
            FrameInput input{spread(1e-3f, 1.0f), static_cast<double>(frame), roots, spheres};
            if (random() % 2) input.wind_ws = Float3{between(-300.0f, 300.0f), between(-50.0f, 50.0f), 0.0f};
            engine.step(input);
            ASSERT_EQ(engine.lastStep().restoredStrands, 0u) << "storm " << storm << ", frame " << frame;
        }
        for (int frame = 0; frame < 300; ++frame)
            engine.step({1.0f / 60.0f, 200.0 + frame / 60.0, roots, spheres});
        EXPECT_EQ(engine.measure().nanCount, 0u) << "storm " << storm;
        EXPECT_LT(engine.measure().maxStretch, 1e-4) << "storm " << storm;
        if (fastestOf(engine) < 5e-3f) ++calm;
        EXPECT_LT(fastestOf(engine), 0.5f) << "storm " << storm;
    }
    EXPECT_GE(calm, kStorms * 95 / 100);
}

TEST(Rods, GoOnFromWhereSpringsWere) {
    const Strands strand = Helix{8e-3, 20e-3, 3, 12}.strand();
    SimulationSettings s = rods();
    s.strandModel = StrandModel::springs;
    Engine engine = makeEngine(strand, s);
    run(engine, strand, 10);
    const std::vector<Float3> before = positionsOf(engine);
    s.strandModel = StrandModel::rods;
    ASSERT_EQ(engine.setSettings(s), "");
    const std::vector<RootFrame> roots = strand.roots();
    engine.step({1e-4f, 0.2, roots});
    EXPECT_LT(rmsBetween(positionsOf(engine), before), 1e-3);
    EXPECT_EQ(engine.lastStep().restoredStrands, 0u);
}

/// As long as frames are no coarser than the root's own motion.
TEST(Rods, FrameRatesAgree) {
    Strands strands = Helix{8e-3, 20e-3, 4, 12}.strand();
    strands.add({0.05f, 0.0f, 0.0f}, {0.8f, -0.6f, 0.0f}, 0.015f, 16);
    const auto endOf = [&](int framesPerSecond) {
        Engine engine = makeEngine(strands, rods());
        for (int f = 1; f <= 3 * framesPerSecond / 2; ++f) {
            const double t = static_cast<double>(f) / framesPerSecond;
            const auto swing = static_cast<float>(std::sin(2.0 * std::numbers::pi * t));
            const auto roots =
                strands.roots({0.03f * swing, 0.0f, 0.0f}, turnAbout({0.0f, 1.0f, 0.0f}, 0.3f * swing));
            engine.step({1.0f / static_cast<float>(framesPerSecond), t, roots});
        }
        return positionsOf(engine);
    };
    const std::vector<Float3> fine = endOf(240);
    for (const int framesPerSecond : {24, 30, 60, 144})
        EXPECT_LT(rmsBetween(endOf(framesPerSecond), fine), 1e-3) << framesPerSecond;
}

TEST(Rods, MoveAlikeWhereverTheirOriginIs) {
    const Strands strands = tuft(40);
    SimulationSettings s = rods(0.3f);
    s.windSpeed = 4.0f;
    s.windFrequency = 0.0f;
    s.friction = 0.0f;  // whether a point sticks or slides would turn rounding into tenths of a millimetre
    const std::vector<Sphere> spheres{{{0.1f, 0.02f, 0.0f}, 0.05f}};
    // Walks ten kilometres away, with positions measured from an origin that follows every few frames.
    const auto walked = [&](bool follows, double start) {
        Engine engine = makeEngine(strands, s);
        for (int f = 1; f <= 120; ++f) {
            const double walk = 0.02 * f;
            const double origin = start + (follows ? std::floor(walk / 0.25) * 0.25 : 0.0);
            const auto x = static_cast<float>(start + walk - origin);
            std::vector<Sphere> near = spheres;
            near.front().center_ws.x += x;
            FrameInput input{1.0f / 60.0f, f / 60.0, {}, near};
            const auto roots = strands.roots({x, 0.0f, 0.0f});
            input.roots_ws = roots;
            input.origin_ws = {origin, 0.0, 0.0};
            engine.step(input);
        }
        std::vector<Float3> positions = positionsOf(engine);
        const auto last =
            static_cast<float>(follows ? 0.02 * 120 - std::floor(0.02 * 120 / 0.25) * 0.25 : 2.4);
        for (Float3& position : positions) position.x -= last;
        return positions;
    };
    const std::vector<Float3> still = walked(false, 0.0);
    EXPECT_LT(rmsBetween(walked(true, 0.0), still), 1e-4);
    // A mean flow without waves is the same everywhere; eddies that stand still are not.
    SimulationSettings calm = s;
    calm.windGustiness = 0.0f;
    std::swap(s, calm);
    const std::vector<Float3> here = walked(true, 0.0);
    EXPECT_LT(rmsBetween(walked(true, 1e4), here), 1e-6);
    std::swap(s, calm);
    EXPECT_GT(rmsBetween(walked(true, 1e4), still), 1e-3) << "the wind is that of the place";
}

TEST(Rods, OneCurlAmongStraightStrandsChangesNoneOfThem) {
    Strands straight;
    for (int i = 0; i < 64; ++i)
        straight.add({0.01f * static_cast<float>(i), 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.005f, 25);
    Strands mixed = straight;
    const Strands curl = Helix{4e-3, 10e-3, 2, 12}.strand();
    mixed.points.insert(mixed.points.end(), curl.points.begin(), curl.points.end());
    mixed.offsets.push_back(static_cast<std::uint32_t>(mixed.points.size()));
    Engine alone = makeEngine(straight, rods()), together = makeEngine(mixed, rods());
    run(alone, straight, 30);
    run(together, mixed, 30);
    std::vector<Float3> rest = positionsOf(together);
    rest.resize(straight.points.size());
    EXPECT_EQ(positionsOf(alone), rest);
}

}  // namespace
}  // namespace hairloom::runtime
