// SPDX-License-Identifier: GPL-3.0-or-later
// What operations promise that are run by scripts alone, beyond what operations_test.cpp asks of all.

#include <gmock/gmock.h>

#include <optional>

#include "core/geometry/curve.h"
#include "core/operations/operation.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

constexpr float kHeadRadius = 0.09f;
const Vec3f kHeadCentre(0, 1.6f, 0);
constexpr std::size_t kStrands = 200;
constexpr std::size_t kPoints = 40;

std::string problemOf(const std::string& json) {
    const nlohmann::json parsed = nlohmann::json::parse(json);
    JsonReader reader(parsed, "o.json");
    const auto op = reader.string("op");
    std::ranges::find(operations(), op, &Operation::name)->read(reader);
    reader.finish();
    return reader.ok() ? "none" : reader.status().error().message();
}

std::size_t run(Groom& groom, const std::string& json) {
    const nlohmann::json parsed = nlohmann::json::parse(json);
    JsonReader reader(parsed, "o.json");
    const auto op = reader.string("op");
    const auto edit = std::ranges::find(operations(), op, &Operation::name)->read(reader);
    reader.finish();
    EXPECT_TRUE(reader.ok()) << reader.status().error().message();
    const auto touched = edit(groom);
    EXPECT_TRUE(touched) << touched.error().message();
    return touched.value_or(0);
}

/// Fallen down around the head.
Groom fallenHair(float length = 0.25f) {
    Groom groom = straightHair(sphereScalp(kHeadRadius, 4, kHeadCentre), kStrands, kPoints, length);
    run(groom, R"({"op": "flow", "crown": [0, 1.69, -0.02]})");
    return groom;
}

/// Mean angle between neighbouring segments, degrees.
double roughness(const Groom& groom) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto points = groom.strand(s);
        for (std::size_t i = 2; i < points.size(); ++i, ++count) {
            const Vec3f a = (points[i - 1] - points[i - 2]).normalized();
            const Vec3f b = (points[i] - points[i - 1]).normalized();
            sum += static_cast<double>(std::acos(std::clamp(a.dot(b), -1.0f, 1.0f)));
        }
    }
    return sum / static_cast<double>(count) * 180 / 3.14159265;
}

TEST(Wave, LiesFlatAgainstTheSkin) {
    Groom groom = makeGroom({0, 101}, std::vector<Vec3f>(101));
    auto& points = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3f(0.002f * static_cast<float>(i), 0, 0);
    ASSERT_EQ(run(groom, R"({"op": "wave", "amplitude": 0.006, "frequency": 20, "start": 0.01})"), 1u);
    float aside = 0;
    for (const Vec3f& point : groom.strand(0)) {
        EXPECT_NEAR(point.y(), 0, 1e-5f) << "+Y is out of the skin where there is none";
        aside = std::max(aside, std::abs(point.z()));
    }
    EXPECT_GT(aside, 0.004f);
    EXPECT_LT(aside, 0.02f);
    EXPECT_NEAR(polylineLength(groom.strand(0)), 0.2f, 1e-5f);
}

TEST(Frizz, KinksTheShareOfStrandsAndKeepsTheCourse) {
    const Groom before = fallenHair();
    Groom after = before;
    const std::size_t touched = run(after, R"({"op": "frizz", "share": 0.5, "frequency": 150})");
    EXPECT_NEAR(static_cast<double>(touched), 0.5 * kStrands, 0.15 * kStrands);
    EXPECT_GT(roughness(after), roughness(before) + 3);
    double strayed = 0;
    for (std::size_t s = 0; s < kStrands; ++s)
        strayed += static_cast<double>((after.strand(s).back() - before.strand(s).back()).norm()) / kStrands;
    EXPECT_LT(strayed, 0.04);
}

TEST(Straighten, TakesCurlsOutAndLeavesTheFall) {
    const Groom fallen = fallenHair();
    Groom curled = fallen;
    run(curled, R"({"op": "curl", "radius": 0.005, "frequency": 25})");
    Groom straight = curled;
    run(straight, R"({"op": "straighten", "amount": 1, "over": 0.08})");
    EXPECT_LT(roughness(straight), 0.45 * roughness(curled));
    double apart = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        const auto a = (fallen.strand(s).back() - fallen.strand(s)[0]).normalized();
        const auto b = (straight.strand(s).back() - straight.strand(s)[0]).normalized();
        apart += static_cast<double>(a.dot(b)) / kStrands;
    }
    EXPECT_GT(apart, 0.9) << "they fall where they fell";
    Groom line = curled;
    run(line, R"({"op": "straighten", "amount": 1, "over": 0, "clearance": 0,
                  "region": {"point": [0, 1.6, 0], "normal": [0, 1, 0]}})");
    for (std::size_t s = 0; s < kStrands; s += 7) {
        if (curled.strand(s)[0].y() < 1.68f) continue;
        EXPECT_GT((line.strand(s).back() - line.strand(s)[0]).norm(), 0.0f);
    }
}

TEST(Bend, TurnsTipsTowardsTheHeadOrAwayFromIt) {
    const Groom before = fallenHair(0.35f);
    const auto distance = [](const Groom& groom, std::size_t s) {
        const Vec3f tip = groom.strand(s).back() - kHeadCentre;
        return std::hypot(tip.x(), tip.z());
    };
    for (const bool in : {true, false}) {
        Groom after = before;
        run(after, in ? R"({"op": "bend", "inwardDegrees": 80, "variation": 0})"
                      : R"({"op": "bend", "inwardDegrees": -80, "variation": 0})");
        std::size_t turned = 0;
        for (std::size_t s = 0; s < kStrands; ++s)
            turned += (distance(after, s) < distance(before, s)) == in ? 1 : 0;
        EXPECT_GT(turned, kStrands * 85 / 100) << (in ? "in" : "out");
    }
}

TEST(Flyaways, FewLeaveAndTheOthersStay) {
    const Groom before = fallenHair();
    Groom after = before;
    const std::size_t touched = run(after, R"({"op": "flyaways", "share": 0.1, "angleDegrees": 60})");
    EXPECT_GT(touched, kStrands / 20);
    EXPECT_LT(touched, kStrands / 5);
}

TEST(Shrinkwrap, DrawsHairToItsHeight) {
    Groom groom = fallenHair(0.12f);
    run(groom, R"({"op": "shrinkwrap", "strength": 1, "distance": 0.003, "variation": 0, "reach": 0.2})");
    run(groom, R"({"op": "shrinkwrap", "strength": 1, "distance": 0.003, "variation": 0, "reach": 0.2})");
    double height = 0;
    for (std::size_t s = 0; s < kStrands; ++s)
        height += static_cast<double>((groom.strand(s)[kPoints / 2] - kHeadCentre).norm() - kHeadRadius);
    EXPECT_NEAR(height / kStrands, 0.003, 0.0015);
}

TEST(Shrinkwrap, DrawsHairToAGroupOfTheHeadsFile) {
    Groom groom = fallenHair(0.12f);
    // Beside the head a wall that faces it, as the second group of the file.
    const ScalpMesh& head = *groom.scalp;
    constexpr float kWall = 0.2f;
    PolygonSoup soup;
    soup.positions.assign(head.positions().begin(), head.positions().end());
    for (const Triangle& triangle : head.triangles()) {
        soup.corners.insert(soup.corners.end(), triangle.begin(), triangle.end());
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        soup.faceGroups.push_back(0);
    }
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const auto& [y, z] : {std::pair(1.0f, -1.0f), {1.0f, 1.0f}, {2.4f, 1.0f}, {2.4f, -1.0f}})
        soup.positions.emplace_back(kWall, y, z);
    for (const std::uint32_t corner : {0u, 1u, 2u, 3u}) soup.corners.push_back(first + corner);
    soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    soup.faceGroups.push_back(1);
    soup.groupNames = {"head", "wall"};
    groom.scalp = std::make_shared<const ScalpMesh>(ScalpMesh::make(soup).value());
    const Groom before = groom;
    run(groom,
        R"({"op": "shrinkwrap", "strength": 1, "distance": 0.003, "variation": 0, "reach": 1, "group": 2})");
    std::size_t nearer = 0;
    for (std::size_t s = 0; s < kStrands; ++s)
        nearer += groom.strand(s).back().x() > before.strand(s).back().x() + 0.005f ? 1 : 0;
    EXPECT_GT(nearer, kStrands * 9 / 10);
    for (std::size_t s = 0; s < kStrands; ++s) EXPECT_LT(groom.strand(s).back().x(), kWall + 0.001f);
    const nlohmann::json third = {{"group", 3}};
    JsonReader reader(third, "o.json");
    const auto refused = std::ranges::find(operations(), "shrinkwrap", &Operation::name)->read(reader)(groom);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().expected, "expected 0 to 2");
}

TEST(Part, NoHairCrossesThePartingNearIt) {
    Groom groom = straightHair(sphereScalp(kHeadRadius, 4, kHeadCentre), kStrands, kPoints, 0.15f);
    // All hair leads to the left, across a parting that is to be.
    run(groom, R"({"op": "flow", "crown": [0, 0.001, 0], "sweep": [-5, 0, 0], "gravity": 0.3})");
    const auto crossed = [](const Groom& now) {
        std::size_t count = 0;
        for (std::size_t s = 0; s < kStrands; ++s) {
            const Vec3f root = now.strand(s)[0];
            if (root.y() < 1.66f || root.x() < 0.002f) continue;
            for (const Vec3f& point : now.strand(s))
                if (point.x() < -0.003f) {
                    ++count;
                    break;
                }
        }
        return count;
    };
    EXPECT_GT(crossed(groom), 5u);
    run(groom, R"({"op": "part", "curve": [[0, 1.66, 0.07], [0, 1.69, 0], [0, 1.66, -0.07]]})");
    EXPECT_EQ(crossed(groom), 0u);
}

TEST(Attract, DrawsTipsToTheCurve) {
    const Groom before = fallenHair();
    Groom after = before;
    run(after, R"({"op": "attract", "strength": 1, "reach": 0, "spread": 0.002,
                   "curve": [[0, 1.6, -0.12], [0, 1.5, -0.13], [0, 1.35, -0.13]]})");
    const auto away = [](const Groom& groom) {
        double sum = 0;
        for (std::size_t s = 0; s < kStrands; ++s) {
            const Vec3f tip = groom.strand(s).back();
            sum += static_cast<double>(std::hypot(tip.x(), tip.z() + 0.13f)) / kStrands;
        }
        return sum;
    };
    EXPECT_LT(away(after), 0.5 * away(before));
    Groom untouched = before;
    EXPECT_EQ(run(untouched, R"({"op": "attract"})"), 0u) << "nothing was drawn";
}

/// Of three locks a plait is made: along the curve their middles swing from side to side, one after the
/// other, and the one that crosses is in front.
TEST(Braid, ThreeLocksCrossOneAfterTheOther) {
    Groom groom = straightHair(sphereScalp(kHeadRadius, 4, kHeadCentre), 300, 200, 0.6f);
    run(groom, R"({"op": "braid", "width": 0.03, "widthTip": 0.03, "crossing": 0.06, "loose": 0, "tail": 0.02,
                   "curve": [[0, 1.6, -0.12], [0, 1.45, -0.12], [0, 1.25, -0.12]]})");
    // Where hair is at levels of the straight braid, by lock: locks are found by the side they begin on.
    std::vector<double> last(3, 0);
    std::vector<int> swings(3, 0);
    std::size_t levels = 0;
    std::vector<std::vector<std::uint32_t>> locks(3);
    const auto at = [&](std::uint32_t s, float level) -> std::optional<Vec3f> {
        const auto points = groom.strand(s);
        for (std::size_t i = points.size() - 1; i > 0; --i) {
            if (points[i].y() <= level && points[i - 1].y() > level && points[i].z() < -0.09f) {
                const float t = (points[i - 1].y() - level) / (points[i - 1].y() - points[i].y());
                return Vec3f(points[i - 1] + t * (points[i] - points[i - 1]));
            }
        }
        return std::nullopt;
    };
    // Thirds of the strands by the side of their roots, seen from behind.
    std::vector<std::pair<float, std::uint32_t>> bySide;
    for (std::uint32_t s = 0; s < 300; ++s) bySide.emplace_back(groom.strand(s)[0].x(), s);
    std::sort(bySide.begin(), bySide.end());
    for (std::size_t k = 0; k < bySide.size(); ++k) locks[k / 100].push_back(bySide[k].second);
    for (float level = 1.52f; level > 1.32f; level -= 0.004f, ++levels) {
        for (std::size_t lock = 0; lock < 3; ++lock) {
            double x = 0, spread = 0;
            std::vector<float> all;
            for (const std::uint32_t s : locks[lock]) {
                if (const auto point = at(s, level)) all.push_back(point->x());
            }
            ASSERT_GT(all.size(), 60u) << "level " << level;
            for (const float value : all) x += static_cast<double>(value) / static_cast<double>(all.size());
            for (const float value : all)
                spread += std::abs(static_cast<double>(value) - x) / static_cast<double>(all.size());
            EXPECT_LT(spread, 0.006) << "a lock holds together, level " << level;
            EXPECT_LT(std::abs(x), 0.011);
            if (last[lock] * x < 0) ++swings[lock];
            if (std::abs(x) > 0.003) last[lock] = x;
        }
    }
    for (const int swing : swings) EXPECT_GE(swing, 5) << "0.2 m of a braid that crosses twice in 0.06 m";
}

TEST(Braid, BraidsAloneWhatItReaches) {
    const Groom before = fallenHair(0.4f);
    Groom after = before;
    const std::size_t touched = run(after, R"({"op": "braid", "reach": 0.1,
                                               "curve": [[0, 1.58, -0.11], [0, 1.3, -0.12]]})");
    EXPECT_GT(touched, 20u);
    EXPECT_LT(touched, kStrands - 20);
    EXPECT_EQ(run(after, R"({"op": "braid"})"), 0u) << "nothing was drawn";
}

TEST(Bun, WindsLongHairAboutItsAxis) {
    Groom groom = straightHair(sphereScalp(kHeadRadius, 4, kHeadCentre), kStrands, 120, 0.6f);
    run(groom, R"({"op": "bun", "centre": [0, 1.66, -0.1], "axis": [0, 0.6, -0.8]})");
    const Vec3f centre(0, 1.66f, -0.1f), axis = Vec3f(0, 0.6f, -0.8f).normalized();
    std::size_t inside = 0, count = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        const auto points = groom.strand(s);
        for (std::size_t i = points.size() - 20; i < points.size(); ++i, ++count) {
            const Vec3f away = points[i] - centre;
            const float high = away.dot(axis);
            const float wide = (away - high * axis).norm();
            inside += std::hypot(wide - 0.028f, high) < 0.018f + 0.004f ? 1 : 0;
        }
    }
    EXPECT_GT(inside, count * 9 / 10);
}

TEST(Mirror, GivesTheOtherSideTheShape) {
    Groom groom = fallenHair();
    run(groom, R"({"op": "curl", "region": {"normal": [1, 0, 0]}})");
    const Groom before = groom;
    run(groom, R"({"op": "mirror", "reach": 0.05})");
    std::size_t mirrored = 0;
    for (std::size_t s = 0; s < kStrands; ++s) {
        const auto now = groom.strand(s);
        if (now[0].x() > 0) {
            EXPECT_TRUE(std::ranges::equal(now, before.strand(s)));
            continue;
        }
        for (std::size_t other = 0; other < kStrands; ++other) {
            if (before.strand(other)[0].x() <= 0) continue;
            const auto model = before.strand(other);
            const Vec3f tip = model[kPoints - 1] - model[0], own = now[kPoints - 1] - now[0];
            if ((Vec3f(-tip.x(), tip.y(), tip.z()) - own).norm() < 1e-5f) {
                ++mirrored;
                break;
            }
        }
    }
    EXPECT_GT(mirrored, kStrands / 4);
}

TEST(DrawnCurve, ComplaintsNameTheMember) {
    using testing::HasSubstr;
    EXPECT_THAT(problemOf(R"({"op": "part", "curve": [[0, 1, 0]]})"), HasSubstr("/curve has one point"));
    EXPECT_THAT(problemOf(R"({"op": "part", "curve": [[0, 1], [0, 2, 0]]})"),
                HasSubstr("/curve is not a list"));
    EXPECT_THAT(problemOf(R"({"op": "part", "curve": [[0, 1, 0], [0, 1e9, 0]]})"), HasSubstr("/curve"));
    EXPECT_THAT(problemOf(R"({"op": "wave", "curve": [[0, 1, 0], [0, 2, 0]]})"), HasSubstr("curve"));
    EXPECT_EQ(problemOf(R"({"op": "part", "curve": []})"), "none");
}

}  // namespace
}  // namespace hairloom
