// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <functional>
#include <limits>

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
#include "core/operations/length_constraint.h"
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

TEST(LengthConstraint, RestoresLengthsTowardsThePoints) {
    std::vector<Vec3f> points{{0, 0, 0}, {0, 3, 0}, {0, 3, 5}};
    const std::vector<float> lengths{1, 2};
    restoreLengths(points, lengths);
    EXPECT_EQ(points[1], Vec3f(0, 1, 0));
    EXPECT_NEAR((points[2] - points[1]).norm(), 2, 1e-6f);
    EXPECT_NEAR((points[2] - points[1]).normalized().dot(Vec3f(0, 2, 5).normalized()), 1, 1e-6f);

    std::vector<Vec3f> turned{{0, 0, 0}, {0, 3, 0}, {0, 3, 5}};
    restoreLengthsByDirection(turned, lengths);
    EXPECT_LT((turned[2] - Vec3f(0, 1, 2)).norm(), 1e-6f);

    std::vector<Vec3f> collapsed{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    restoreLengths(collapsed, lengths);
    EXPECT_NEAR((collapsed[1] - collapsed[0]).norm(), 1, 1e-6f);
    EXPECT_NEAR((collapsed[2] - collapsed[1]).norm(), 2, 1e-6f);
}

float largestTurn(std::span<const Vec3f> points) {
    float largest = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const Vec3f a = points[i] - points[i - 1], b = points[i + 1] - points[i];
        largest = std::max(largest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi);
    }
    return largest;
}

/// Where points are drawn together the strand gets ahead of them; it goes on and does not turn round.
TEST(LengthConstraint, WhatIsDrawnTogetherDoesNotTurnRound) {
    for (const float share : {0.3f, 0.7f, 0.95f}) {
        std::vector<Vec3f> points;
        const std::vector<float> lengths(24, 0.005f);
        for (int i = 0; i < 25; ++i) {
            const float along = 0.005f * share * static_cast<float>(i);
            points.emplace_back(0.01f * std::sin(40 * along), along, 0);
        }
        const float asked = largestTurn(points);
        restoreLengths(points, lengths);
        EXPECT_LT(largestTurn(points), asked + 0.5f) << share;
        for (std::size_t i = 1; i < points.size(); ++i)
            EXPECT_NEAR((points[i] - points[i - 1]).norm(), 0.005f, 1e-7f);
    }
}

/// Hair whose end is carried farther than it reaches follows smoothly and as far as it can.
TEST(LengthConstraint, WhatIsDrawnApartFollowsAndIsSmooth) {
    const std::vector<float> lengths(30, 0.01f);
    std::vector<Vec3f> points, turnedOnly;
    for (int i = 0; i < 31; ++i) {
        const float share = std::clamp((static_cast<float>(i) - 8) / 12, 0.0f, 1.0f);
        points.emplace_back(0.12f * share * share * (3 - 2 * share), 0.01f * static_cast<float>(i), 0);
    }
    const Vec3f wanted = points.back();
    const float asked = largestTurn(points);
    turnedOnly = points;
    restoreLengths(points, lengths);
    restoreLengthsByDirection(turnedOnly, lengths);
    EXPECT_LT((points.back() - wanted).norm(), (turnedOnly.back() - wanted).norm());
    EXPECT_LT(largestTurn(points), asked + 30);
}

/// Answers as little as a query up to a distance may.
class LazySkin final : public SkinQuery {
  public:
    explicit LazySkin(const Skin& skin) : skin_(skin) {}
    SkinDistance distanceAt(const Vec3f& point) const override { return skin_.distanceAt(point); }
    SkinDistance distanceUpTo(const Vec3f& point, float enough) const override {
        const SkinDistance whole = skin_.distanceAt(point);
        if (!(whole.distance > enough)) return whole;
        return {0.5f * (enough + whole.distance), Vec3f::Constant(std::numeric_limits<float>::quiet_NaN())};
    }

  private:
    const Skin& skin_;
};

/// From a root on a head of radius kHeadRadius: a tangle that runs through it, with segments of many lengths,
/// some of none and some that turn back.
std::vector<Vec3f> tangle(Random& random) {
    const auto vector = [&] {
        const float x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        return Vec3f(x, y, random.uniform(-1, 1));
    };
    std::vector<Vec3f> points{kHeadCentre + vector().normalized() * kHeadRadius};
    const float longest = random.uniform(0.002f, 0.05f);
    for (int i = 0; i < 20; ++i) {
        Vec3f step = vector() * longest;
        if (random.below(8) == 0) step.setZero();
        if (random.below(8) == 0) step = 0.3f * (kHeadCentre - points.back());
        if (random.below(8) == 0 && i > 0) step = points[points.size() - 2] - points.back();
        points.push_back(points.back() + step);
    }
    return points;
}

TEST(LengthConstraint, KeepsTanglesOutsideAndAtTheirLengths) {
    const Skin skin(sphereScalp(kHeadRadius, 4, kHeadCentre));
    const LazySkin lazy(skin);
    constexpr float kClearance = 0.0015f;
    Random random(3);
    std::size_t moved = 0;
    for (int i = 0; i < 300; ++i) {
        const std::vector<Vec3f> before = tangle(random);
        const std::size_t first = 1 + random.below(4);
        std::vector<float> lengths;
        measureSegments(before, lengths);
        std::vector<Vec3f> whole = before, shortcut = before;
        moved += keepOutside(whole, lengths, skin, kClearance, first) ? 1 : 0;
        keepOutside(shortcut, lengths, lazy, kClearance, first);
        ASSERT_EQ(whole, shortcut) << "what a query leaves out makes no difference";
        float arc = 0;
        bool isFree = true;  // what lies before `first` is outside as well
        for (std::size_t p = 1; p < whole.size(); ++p) {
            arc += lengths[p - 1];
            if (p < first) {
                ASSERT_EQ(whole[p], before[p]);
                isFree = isFree && skin.distanceAt(whole[p]).distance >= std::min(kClearance, 0.5f * arc);
                continue;
            }
            ASSERT_NEAR((whole[p] - whole[p - 1]).norm(), lengths[p - 1], 1e-6f + 1e-5f * lengths[p - 1]);
            if (isFree) {
                ASSERT_GT(skin.distanceAt(whole[p]).distance, std::min(kClearance, 0.5f * arc) - 1.1e-4f)
                    << "tangle " << i << ", point " << p;
            }
        }
    }
    EXPECT_GT(moved, 200u);
}

/// A plane is reached by turning once, by no more than has to be.
TEST(LengthConstraint, TurnsASegmentOutByTheLeastAngle) {
    struct Floor final : SkinQuery {
        SkinDistance distanceAt(const Vec3f& point) const override { return {point.y(), Vec3f::UnitY()}; }
    };
    const Vec3f from(0, 0.002f, 0);
    const Vec3f down = Vec3f(0.6f, -0.8f, 0);
    const Vec3f end = placeOutside(Floor(), from, down, 0.01f, 0.001f);
    EXPECT_NEAR(end.y(), 0.001f, 1.01e-5f);
    EXPECT_NEAR((end - from).norm(), 0.01f, 1e-7f);
    EXPECT_NEAR(end.z(), 0, 1e-9f);
    EXPECT_GT(end.x(), 0.0099f);
    const Vec3f free = placeOutside(Floor(), from, Vec3f::UnitX(), 0.01f, 0.001f);
    EXPECT_EQ(free, Vec3f(0.01f, 0.002f, 0));
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
