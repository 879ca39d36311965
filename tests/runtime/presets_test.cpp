// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/presets.h"

#include <set>
#include <string>

#include "tests/runtime/strand_fixture.h"
#include "tests/simulation/elastica.h"

namespace hairloom::runtime {
namespace {

TEST(Presets, AreFoundByNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const HairPreset& preset : presets()) {
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
        EXPECT_EQ(findPreset(preset.name), &preset);
        // Rünz 2012, Section 2: fibres are 50 to 120 µm thick.
        EXPECT_GE(preset.diameter, 50e-6);
        EXPECT_LE(preset.diameter, 120e-6);
    }
    EXPECT_EQ(names.size(), 3u);
    EXPECT_EQ(findPreset("angora"), nullptr);
    EXPECT_EQ(findPreset(""), nullptr);
}

/// E d²(1 − e²)/(16 ρ), worked out by hand from Table 1.
TEST(Presets, BendAsTheirCrossSectionsDo) {
    const auto stiffnessOf = [](const char* name) {
        const HairPreset* preset = findPreset(name);
        return bendingStiffness(preset->diameter, preset->eccentricity);
    };
    EXPECT_NEAR(stiffnessOf("ethiopian"), 5.0313e-4, 2e-8);
    EXPECT_NEAR(stiffnessOf("caucasian"), 4.2124e-4, 2e-8);
    EXPECT_NEAR(stiffnessOf("mongolian"), 7.5706e-4, 2e-8);
}

/// I = ∫ y² dA and A over the ellipse, by the midpoint rule along the thin axis.
TEST(Presets, TheMomentIsThatOfTheEllipseAboutItsLongAxis) {
    const double d = 90e-6, e = 0.8, a = d / 2.0, b = a * std::sqrt(1.0 - e * e);
    double area = 0.0, moment = 0.0;
    constexpr int kStrips = 200'000;
    for (int i = 0; i < kStrips; ++i) {
        const double y = b * (2.0 * (i + 0.5) / kStrips - 1.0);
        const double strip = 2.0 * a * std::sqrt(1.0 - y * y / (b * b)) * 2.0 * b / kStrips;
        area += strip;
        moment += y * y * strip;
    }
    EXPECT_NEAR(bendingStiffness(d, e) / (kYoungsModulus * moment / (kHairDensity * area)), 1.0, 1e-6);
    EXPECT_NEAR(bendingStiffness(80e-6, 0.0) / kHairBendingStiffness, 1.0, 1e-12) << "round hair";
}

TEST(Presets, SetStiffnessAndSectionAndLeaveTheRest) {
    for (const HairPreset& preset : presets()) {
        SimulationSettings settings;
        settings.windSpeed = 3.0f;
        applyPreset(preset, settings);
        EXPECT_TRUE(validate(settings).empty());
        const double s = static_cast<double>(settings.angularStiffness);
        const double ratio = static_cast<double>(settings.sectionRatio);
        EXPECT_NEAR(1.0 - ratio * ratio, preset.eccentricity * preset.eccentricity, 1e-6);
        EXPECT_NEAR(ratio * kHairBendingStiffness * s / (1.0 - s) /
                        bendingStiffness(preset.diameter, preset.eccentricity),
                    1.0, 1e-6)
            << "about the weak axis";
        SimulationSettings expected;
        expected.windSpeed = 3.0f;
        expected.angularStiffness = settings.angularStiffness;
        expected.angularCurve = {};
        expected.sectionRatio = settings.sectionRatio;
        EXPECT_EQ(settings, expected);
    }
    EXPECT_EQ(angularStiffnessOf(0.0), 0.0f);
}

/// How far the tip of a strand that leaves the skin level hangs down when it has come to rest, metres.
double droopOf(const HairPreset& preset, float length, std::uint32_t segments) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, length / static_cast<float>(segments), segments + 1);
    SimulationSettings s;
    applyPreset(preset, s);
    s.clampedPoints = 1;
    s.restGravity = 0.0f;
    s.airDrag = 0.0f;
    s.sleepSpeed = 0.0f;
    s.dampingTime = 0.05f;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 240);
    std::vector<Float3> speeds(engine.pointCount());
    engine.readVelocities(speeds);
    EXPECT_LT(runtime::length(speeds.back()), 1e-3f) << "has not come to rest";
    return static_cast<double>(-positionsOf(engine).back().y);
}

TEST(Presets, DroopTheSameWithAnyNumberOfSegments) {
    constexpr float kStrandLength = 0.06f;
    for (const HairPreset& preset : presets()) {
        const double right = test::solveElastica(bendingStiffness(preset.diameter, preset.eccentricity), 9.81,
                                                 static_cast<double>(kStrandLength))
                                 .drop;
        EXPECT_GT(right, 0.2 * static_cast<double>(kStrandLength)) << "the strand should bend";
        const double fine = droopOf(preset, kStrandLength, 32);
        EXPECT_NEAR(droopOf(preset, kStrandLength, 8) / fine, 1.0, 0.02) << preset.name;
        EXPECT_NEAR(droopOf(preset, kStrandLength, 16) / fine, 1.0, 0.02) << preset.name;
        // Steps of 1/480 s with damped bending hang 1 to 2 % too low.
        EXPECT_NEAR(fine / right, 1.0, 0.03) << preset.name << " against the heavy elastica";
    }
}

}  // namespace
}  // namespace hairloom::runtime
