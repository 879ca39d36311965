// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <functional>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "core/operations/clump.h"
#include "core/operations/clump_centres.h"
#include "core/operations/collide.h"
#include "core/operations/curl.h"
#include "core/operations/drape.h"
#include "core/operations/flow.h"
#include "core/operations/head_places.h"
#include "core/operations/noise.h"
#include "core/operations/operation.h"
#include "core/operations/set_length.h"
#include "core/operations/smooth.h"
#include "core/operations/trim.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

constexpr float kHeadRadius = 0.09f;
const Vec3f kHeadCentre(0, 1.6f, 0);
constexpr std::size_t kStrands = 300;

FlowSettings flowOverTheHead() {
    FlowSettings settings;
    settings.crown = kHeadCentre + Vec3f(0, kHeadRadius, -0.02f);
    return settings;
}

Groom hairOnSphere(float length = 0.2f) {
    return straightHair(sphereScalp(kHeadRadius, 4, kHeadCentre), kStrands, 24, length);
}

/// Hair with bends, so that every operation finds something to do.
Groom wavyHair() {
    Groom groom = hairOnSphere();
    EXPECT_TRUE(flow(groom, flowOverTheHead()));
    NoiseSettings waves;
    waves.amplitude = 0.004f;
    EXPECT_TRUE(noise(groom, waves));
    return groom;
}

struct Tested {
    const char* name;
    std::function<Result<std::size_t>(Groom&, const Region&)> run;
    bool keepsLengths = true;
};

void PrintTo(const Tested& printed, std::ostream* out) {
    *out << printed.name;
}

template <class S>
Tested tested(const char* name, Result<std::size_t> (*apply)(Groom&, const S&, const Region&),
              S settings = {}, bool keepsLengths = true) {
    return {name, [=](Groom& groom, const Region& region) { return apply(groom, settings, region); },
            keepsLengths};
}

/// As a script has it.
Tested scripted(const char* name, const std::string& json, bool keepsLengths = true) {
    return {name,
            [json](Groom& groom, const Region& region) -> Result<std::size_t> {
                nlohmann::json parsed = nlohmann::json::parse(json);
                parsed["region"] = nlohmann::json::parse(fieldsToJson(region).dump());
                JsonReader reader(parsed, "o.json");
                const auto op = reader.string("op");
                const auto run = std::ranges::find(operations(), op, &Operation::name)->read(reader);
                reader.finish();
                if (auto status = reader.status(); !status) return tl::unexpected(status.error());
                return run(groom);
            },
            keepsLengths};
}

std::vector<Tested> testedOperations() {
    FlowSettings parted = flowOverTheHead();
    parted.parting = 1;
    parted.partingPoint = kHeadCentre + Vec3f(0.02f, kHeadRadius, 0);
    parted.whorlDegrees = 40;
    parted.seed = 9;
    TrimSettings cut;
    cut.planePoint = kHeadCentre;
    cut.planeNormal = Vec3f(0, -1, 0);
    cut.maxLength = 0.15f;
    cut.raggedness = 0.02f;
    SetLengthSettings longer;
    longer.length = 0.3f;
    longer.variation = 0.3f;
    SetLengthSettings shorter = longer;
    shorter.length = 0.08f;
    shorter.rescale = false;
    CollideSettings away;
    away.distance = 0.006f;
    return {
        tested("Flow", flow, parted),
        tested("Clump", clump),
        scripted("ClumpsInClumps", R"({"op": "clump", "levels": 3, "noise": 0.004, "noise3": 0.001})"),
        scripted("Formulas", R"({"op": "noise", "formulas": {"amplitude": "0.002 + 0.003*random"}})"),
        tested("Noise", noise),
        tested("Curl", curl),
        tested("Smooth", smooth),
        tested("Drape", drape),
        tested("Collide", collide, away),
        tested("Trim", trim, cut, false),
        tested("SetLength", setLength, longer, false),
        tested("CutLength", setLength, shorter, false),
        scripted("Wave", R"({"op": "wave"})"),
        scripted("Frizz", R"({"op": "frizz"})"),
        scripted("Straighten", R"({"op": "straighten"})"),
        scripted("Bend", R"({"op": "bend", "inwardDegrees": 90, "sidewaysDegrees": -30})"),
        scripted("Flyaways", R"({"op": "flyaways", "share": 0.5})"),
        scripted("Shrinkwrap", R"({"op": "shrinkwrap"})"),
        scripted("Part",
                 R"({"op": "part", "curve": [[0.01, 1.67, 0.06], [0.01, 1.69, 0], [0, 1.67, -0.06]]})"),
        scripted("Attract", R"({"op": "attract", "reach": 0, "curve": [[0, 1.6, -0.12], [0, 1.4, -0.14]]})"),
        scripted("Braid",
                 R"({"op": "braid", "curve": [[0, 1.58, -0.11], [0, 1.5, -0.12], [0, 1.3, -0.12]]})"),
        scripted("Bun", R"({"op": "bun"})"),
        scripted("Mirror", R"({"op": "mirror", "reach": 0.03})", false),
        scripted(
            "AttractAlong",
            R"({"op": "attract", "to": "along", "reach": 0, "curve": [[0, 1.6, -0.12], [0, 1.4, -0.14]]})")};
}

class EveryOperation : public testing::TestWithParam<Tested> {
  protected:
    void TearDown() override { setThreadCount(0); }
};
INSTANTIATE_TEST_SUITE_P(Operations, EveryOperation, testing::ValuesIn(testedOperations()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(EveryOperation, KeepsRootsCountsAndLengthsAndStaysOutOfTheHead) {
    const Groom before = wavyHair();
    Groom after = before;
    const auto touched = GetParam().run(after, {});
    ASSERT_TRUE(touched) << touched.error().message();
    EXPECT_GT(*touched, kStrands / 10);
    ASSERT_EQ(after.pointCount(), before.pointCount());
    EXPECT_FALSE(hasErrors(validate(after)));
    std::size_t changed = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        const auto a = before.strand(s);
        const auto b = after.strand(s);
        EXPECT_EQ(a[0], b[0]) << "strand " << s;
        changed += !std::equal(a.begin(), a.end(), b.begin());
        for (std::size_t p = 1; p < b.size(); ++p) {
            // Facets lie up to 0.2 mm within the sphere.
            EXPECT_GT((b[p] - kHeadCentre).norm(), kHeadRadius - 2.5e-4f)
                << "strand " << s << ", point " << p;
            if (!GetParam().keepsLengths) continue;
            const float length = (a[p] - a[p - 1]).norm();
            EXPECT_NEAR((b[p] - b[p - 1]).norm(), length, 1e-4f * length)
                << "strand " << s << ", point " << p;
        }
    }
    EXPECT_EQ(changed, *touched);
}

TEST_P(EveryOperation, LeavesFrozenAndLockedStrandsAlone) {
    Groom before = wavyHair();
    std::vector<std::uint8_t> frozen(kStrands, 0);
    std::vector<std::uint32_t> layers(kStrands, 0);
    for (std::size_t s = 0; s < kStrands; ++s) {
        frozen[s] = s % 3 == 0;
        layers[s] = s % 3 == 1;
    }
    before.strandAttributes.set(attribute::kFrozen, frozen);
    before.strandAttributes.set(attribute::kLayer, layers);
    before.layers = {{"Free", true, false, 1, {}}, {"Locked", true, true, 1, {}}};
    Groom after = before;
    ASSERT_TRUE(GetParam().run(after, {}));
    for (std::size_t s = 0; s < kStrands; ++s) {
        if (s % 3 == 2) continue;
        const auto a = before.strand(s);
        const auto b = after.strand(s);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << "strand " << s;
    }
    after = before;
    after.layers[0].locked = true;
    EXPECT_EQ(GetParam().run(after, {}).value(), 0u);
    EXPECT_EQ(after.pointAttributes.version(attribute::kPosition),
              before.pointAttributes.version(attribute::kPosition));
}

TEST_P(EveryOperation, GivesTheSameBitsForAnyNumberOfThreads) {
    const Groom before = wavyHair();
    setThreadCount(1);
    Groom one = before;
    ASSERT_TRUE(GetParam().run(one, {}));
    setThreadCount(4);
    Groom four = before;
    ASSERT_TRUE(GetParam().run(four, {}));
    EXPECT_EQ(contentHash(one), contentHash(four));
}

TEST_P(EveryOperation, ReachesOnlyItsRegion) {
    const Groom before = wavyHair();
    Region region;
    region.point = kHeadCentre;
    region.normal = Vec3f(2, 0, 0);
    Groom after = before;
    ASSERT_TRUE(GetParam().run(after, region));
    for (std::size_t s = 0; s < kStrands; ++s) {
        if (before.strand(s)[0].x() >= 0) continue;
        const auto a = before.strand(s);
        const auto b = after.strand(s);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << "strand " << s;
    }
}

TEST(SetLength, GivesTheLengthWithVariationAndGradient) {
    for (const bool rescale : {true, false}) {
        Groom groom = wavyHair();
        SetLengthSettings settings;
        settings.length = 0.12f;
        settings.rescale = rescale;
        settings.clearance = 0;
        ASSERT_TRUE(setLength(groom, settings));
        for (std::size_t s = 0; s < kStrands; ++s)
            EXPECT_NEAR(polylineLength(groom.strand(s)), 0.12f, 1.2e-5f);

        settings.gradientPoint = kHeadCentre + Vec3f(0, kHeadRadius, 0);
        settings.gradientDistance = kHeadRadius;
        settings.farScale = 0.5f;
        settings.variation = 0.2f;
        ASSERT_TRUE(setLength(groom, settings));
        for (std::size_t s = 0; s < kStrands; ++s) {
            const float depth = (settings.gradientPoint.y() - groom.strand(s)[0].y()) / kHeadRadius;
            const float full = 0.12f * (1 - 0.5f * std::min(depth, 1.0f));
            EXPECT_LT(polylineLength(groom.strand(s)), full * 1.0001f);
            EXPECT_GT(polylineLength(groom.strand(s)), full * 0.7999f);
        }
    }
}

TEST(Trim, CutsAtThePlane) {
    Groom groom = wavyHair();
    TrimSettings settings;
    settings.planePoint = kHeadCentre + Vec3f(0, -0.03f, 0);
    settings.planeNormal = Vec3f(0, -3, 0);
    const std::size_t touched = trim(groom, settings).value();
    EXPECT_GT(touched, 0u);
    // Even resampling may round a corner at the very end.
    for (const Vec3f& p : groom.positions()) EXPECT_GT(p.y(), settings.planePoint.y() - 1e-3f);
    TrimSettings none;
    EXPECT_EQ(trim(groom, none).value(), 0u) << "nothing is longer than 5 m";
}

TEST(Flow, LaysHairDownAroundTheHead) {
    Groom groom = hairOnSphere(0.12f);
    FlowSettings settings = flowOverTheHead();
    settings.liftRoot = 0.008f;
    settings.liftTip = 0.004f;
    ASSERT_TRUE(flow(groom, settings));
    double height = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        const auto points = groom.strand(s);
        EXPECT_LT(points.back().y(), points[0].y() + 0.02f) << "strand " << s;
        height +=
            static_cast<double>((points[points.size() / 2] - kHeadCentre).norm() - kHeadRadius) / kStrands;
    }
    EXPECT_GT(height, 0.002) << "hair has volume";
    EXPECT_LT(height, 0.02) << "hair lies on the head";
}

/// Else the roots below show through hair from the crown as a ring around the head.
TEST(Flow, ByDefaultHairFromAboveLiesOverThatWhichGrowsBelow) {
    Groom groom = hairOnSphere(0.12f);
    ASSERT_TRUE(flow(groom, FlowSettings()));
    const auto heightAt = [&](std::size_t point) {
        double height = 0;
        for (std::size_t s = 0; s < kStrands; ++s)
            height += static_cast<double>((groom.strand(s)[point] - kHeadCentre).norm() - kHeadRadius);
        return height / kStrands;
    };
    EXPECT_GT(heightAt(16), heightAt(6) + 0.001) << "at 8 cm and at 3 cm from the roots";
    EXPECT_LT(heightAt(16), 0.03);
}

TEST(Places, ThatNobodyNamedAreOnTopOfTheHead) {
    const Groom hair = wavyHair();
    const Vec3f top = topOfHead(hair);
    EXPECT_NEAR(top.y(), kHeadCentre.y() + kHeadRadius, 0.01f);
    TrimSettings cut, cutThere;
    cut.planeNormal = cutThere.planeNormal = Vec3f(1, 0, 0);
    cutThere.planePoint = top;
    SetLengthSettings shorter, shorterThere;
    shorter.gradientDistance = shorterThere.gradientDistance = kHeadRadius;
    shorter.farScale = shorterThere.farScale = 0.3f;
    shorterThere.gradientPoint = top;
    std::array<Groom, 4> made{hair, hair, hair, hair};
    ASSERT_TRUE(trim(made[0], cut) && trim(made[1], cutThere));
    ASSERT_TRUE(setLength(made[2], shorter) && setLength(made[3], shorterThere));
    EXPECT_EQ(contentHash(made[0]), contentHash(made[1]));
    EXPECT_EQ(contentHash(made[2]), contentHash(made[3]));
    EXPECT_NE(contentHash(made[0]), contentHash(hair));
    float shortest = 1, longest = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        shortest = std::min(shortest, polylineLength(made[2].strand(s)));
        longest = std::max(longest, polylineLength(made[2].strand(s)));
    }
    EXPECT_NEAR(longest, 0.1f, 0.01f);
    EXPECT_NEAR(shortest, 0.03f, 0.003f);
}

TEST(Flow, APartingSendsHairToTheSideOfItsRoot) {
    Groom groom = hairOnSphere(0.12f);
    FlowSettings settings = flowOverTheHead();
    settings.parting = 1;
    settings.partingPoint = kHeadCentre + Vec3f(0, kHeadRadius, 0);
    settings.partingReach = 10;
    ASSERT_TRUE(flow(groom, settings));
    for (std::size_t s = 0; s < kStrands; ++s) {
        const auto points = groom.strand(s);
        for (const Vec3f& p : points)
            EXPECT_GE(p.x() * (points[0].x() < 0 ? -1.0f : 1.0f), -1e-3f) << "strand " << s;
    }
}

TEST(Clump, DrawsStrandsTogetherTowardsTheTip) {
    const Groom before = wavyHair();
    Groom after = before;
    ClumpSettings settings;
    settings.spacing = 0.03f;
    settings.strength = 1;
    settings.variation = 0;
    ASSERT_TRUE(clump(after, settings));
    const auto centres = chooseCentres(before, settings.spacing, settings.seed);
    double apartBefore = 0;
    double apartAfter = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        EXPECT_LE((before.strand(s)[0] - before.strand(centres[s])[0]).norm(), settings.spacing);
        EXPECT_EQ(centres[centres[s]], centres[s]) << "a leader leads itself";
        for (std::size_t other = 0; other < s; ++other) {
            if (centres[s] != s || centres[other] != other) continue;
            EXPECT_GT((before.strand(s)[0] - before.strand(other)[0]).norm(), settings.spacing);
        }
        apartBefore +=
            static_cast<double>((before.strand(s).back() - before.strand(centres[s]).back()).norm());
        apartAfter += static_cast<double>((after.strand(s).back() - after.strand(centres[s]).back()).norm());
    }
    EXPECT_LT(apartAfter, 0.6 * apartBefore);
}

TEST(Curl, WindsAStraightStrandAboutItsAxis) {
    Groom groom = makeGroom({0, 201}, std::vector<Vec3f>(201));
    auto& points = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3f(0, -0.001f * static_cast<float>(i), 0);
    CurlSettings settings;
    settings.radius = 0.005f;
    settings.frequency = 20;
    settings.start = 0;
    ASSERT_EQ(curl(groom, settings).value(), 1u);
    // A helix of radius r and k radians a metre of axis has √(1 + (rk)²) metres of hair a metre of axis;
    // turned segments keep the helix's slope.
    const float slope = 1 / std::sqrt(1 + std::pow(0.005f * 2 * kPi * 20, 2.0f));
    const auto curled = groom.strand(0);
    EXPECT_NEAR(curled[0].y() - curled[200].y(), 0.2f * slope, 0.2f * 0.02f);
    EXPECT_NEAR(polylineLength(curled), 0.2f, 1e-5f);
}

TEST(Drape, TurnsSegmentsDown) {
    Groom groom = makeGroom({0, 3}, {Vec3f(0, 0, 0), Vec3f(0.1f, 0, 0), Vec3f(0.2f, 0, 0)});
    DrapeSettings settings;
    settings.amount = 1;
    ASSERT_TRUE(drape(groom, settings));
    const auto points = groom.strand(0);
    const Vec3f halfway(0.1f * std::sqrt(0.5f), -0.1f * std::sqrt(0.5f), 0);
    EXPECT_LT((points[1] - halfway).norm(), 1e-6f);
    EXPECT_LT((points[2] - halfway - Vec3f(0, -0.1f, 0)).norm(), 1e-6f);
}

TEST(Operations, SettingsOutOfRangeAndMissingScalpsAreRefused) {
    Groom groom = makeGroom({0, 2}, {Vec3f(0, 0, 0), Vec3f(0, 0.1f, 0)});
    const auto noScalp = flow(groom, {});
    ASSERT_FALSE(noScalp);
    EXPECT_THAT(noScalp.error().message(), testing::HasSubstr("no scalp"));
    EXPECT_FALSE(collide(groom, {}));
    CurlSettings settings;
    settings.radius = -1;
    const auto outOfRange = curl(groom, settings);
    ASSERT_FALSE(outOfRange);
    EXPECT_EQ(outOfRange.error().message(), "curl: radius is -1; expected 0 to 0.1 m");
}

}  // namespace
}  // namespace hairloom
