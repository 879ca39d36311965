// SPDX-License-Identifier: GPL-3.0-or-later
// The reference's rods against numbers of other programs (rods.json beside the repository, which says how
// they were made): discrete elastic rods, another measure of strain on the same points, and the continuum
// that both come to.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/simulation/rod_fixture.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using namespace test;
using Json = nlohmann::json;

class RodNumbers : public testing::Test {
  protected:
    void SetUp() override {
        const auto path = outsideData() / "../reference/rods.json";
        std::ifstream file(path);
        if (!file) GTEST_SKIP() << path << " is not there";
        static const Json read = Json::parse(file);
        numbers_ = &read;
    }
    const Json& numbers(const char* table) const { return numbers_->at(table); }

  private:
    const Json* numbers_ = nullptr;
};

runtime::SimulationSettings settingsOf(const Json& row) {
    runtime::SimulationSettings s = bareRods();
    s.angularStiffness = row.at("s").get<float>();
    s.dampingTime = 0.01f;  // the weight comes slowly: softer coils have several places of rest
    if (row.contains("GJ_over_EI")) s.torsionRatio = row.at("GJ_over_EI").get<float>();
    return s;
}

/// Around an axis d, as the table says.
reference::Strands helixAlong(const Vec3d& d, const Json& row, int pointsPerTurn) {
    const double r = row.at("r").get<double>(), pitch = row.at("pitch").get<double>();
    const int turns = row.at("turns").get<int>();
    const Vec3d a = d.cross(Vec3d(0.3, 0.9, 0.1)).normalized(), b = d.cross(a);
    reference::Strands strands;
    for (int p = 0; p <= turns * pointsPerTurn; ++p) {
        const double t = kTau * p / pointsPerTurn;
        strands.restPositions_ss.push_back(r * (std::cos(t) - 1.0) * a + r * std::sin(t) * b +
                                           pitch * t / kTau * d);
    }
    strands.offsets = {0, static_cast<std::uint32_t>(strands.restPositions_ss.size())};
    return strands;
}

Vec3d vectorOf(const Json& row) {
    return {row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>()};
}

/// Of the tip, at rest.
double dropOf(const reference::Strands& strands, const runtime::SimulationSettings& s) {
    reference::Solver solver = solverOf(strands, s);
    const double rest = solver.positions_ws().back().y();
    EXPECT_LT(comeToRest(solver), 1e-6);
    return rest - solver.positions_ws().back().y();
}

/// Largest error of the drop as a share of it, of every `stride`th row.
double worstDrop(const Json& rows, const Vec3d& axis, int pointsPerTurn, std::size_t stride) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += stride) {
        const Json& row = rows[i];
        if (!row.at("GJ_over_EI").is_number()) continue;
        const double right = row.at("tip_drop").get<double>();
        const double error = dropOf(helixAlong(axis, row, pointsPerTurn), settingsOf(row)) / right - 1.0;
        if (std::abs(error) > std::abs(worst)) worst = error;
    }
    std::printf("%d points a turn: drop off by up to %.2f %%\n", pointsPerTurn, 100.0 * worst);
    return std::abs(worst);
}

TEST_F(RodNumbers, HangingHelices) {
    const Json& rows = numbers("table2_hanging_helices");
    EXPECT_LT(worstDrop(rows, -Vec3d::UnitY(), 12, 13), 0.04);
    EXPECT_LT(worstDrop(rows, -Vec3d::UnitY(), 24, 29), 0.01);
}

TEST_F(RodNumbers, HelicesOfOtherTwistStiffness) {
    const Json& rows = numbers("table2b_twist_stiffness");
    EXPECT_LT(worstDrop(rows, -Vec3d::UnitY(), 12, 3), 0.03);
    EXPECT_LT(worstDrop(rows, -Vec3d::UnitY(), 24, 7), 0.01);
}

TEST_F(RodNumbers, LevelHelices) {
    const Json& rows = numbers("table3_horizontal_helices");
    EXPECT_LT(worstDrop(rows, Vec3d::UnitX(), 12, 1), 0.03);
    EXPECT_LT(worstDrop(rows, Vec3d::UnitX(), 24, 1), 0.01);
}

/// Of second order, where discrete elastic rods are of first: these leave the half segment at the clamp out.
TEST_F(RodNumbers, Cantilevers) {
    for (const Json& row : numbers("table1_cantilever")) {
        const double length = row.at("length").get<double>();
        const Vec3d right = vectorOf(row.at("tip"));
        const auto error = [&](std::size_t segments) {
            reference::Solver solver = solverOf(straightStrand(segments, length), settingsOf(row));
            EXPECT_LT(comeToRest(solver), 1e-6);
            return (solver.positions_ws().back() - right).norm() / length;
        };
        const double coarse = error(16), fine = error(64);
        const double theirs = (vectorOf(row.at("der_tip").at("64")) - right).norm() / length;
        std::printf(
            "L %.2f s %.1f: tip off by %.2f %% of the length, %.2f %% with 64 segments (theirs %.2f %%)\n",
            length, row.at("s").get<double>(), 100.0 * coarse, 100.0 * fine, 100.0 * theirs);
        EXPECT_LT(fine, coarse / 9.0);
        EXPECT_LT(fine, 0.5 * theirs);
        EXPECT_LT(fine, 0.01);
    }
}

/// Table 6: positions of the tip, at times.
using Way = std::vector<Vec3d>;

Way wayOf(const Json& row, double until) {
    Way result;
    for (std::size_t i = 0; i < row.at("times").size() && row.at("times")[i].get<double>() < until; ++i)
        result.push_back(vectorOf(row.at("tip")[i]));
    return result;
}

double largestDistance(const Way& a, const Way& b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

/// The same as a table's row says, with the reference.
template <class RootAt>
Way move(const reference::Strands& strands, const Json& row, double until, const RootAt& rootAt) {
    runtime::SimulationSettings s = settingsOf(row);
    s.dampingTime = 0.0f;
    reference::Solver solver = solverOf(strands, s);
    if (row.at("name").get<std::string>().starts_with("helix")) {
        reference::Solver resting = solverOf(strands, settingsOf(row));
        EXPECT_LT(comeToRest(resting), 1e-6);
        solver.setMotion(resting.positions_ws(),
                         std::vector<Vec3d>(strands.restPositions_ss.size(), Vec3d::Zero()));
    }
    constexpr double kFrame = 1.0 / 800.0;
    Way result;
    int frame = 0;
    for (const Json& time : row.at("times")) {
        if (!(time.get<double>() < until)) break;
        for (; frame < std::lround(time.get<double>() / kFrame); ++frame) {
            reference::Frame input = stillFrame(kFrame);
            input.roots_ws = {rootAt((frame + 1) * kFrame)};
            EXPECT_EQ(solver.step(input, {2, 4}).failed, 0u);
        }
        result.push_back(solver.positions_ws().back());
    }
    return result;
}

/// What discrete rods of few points lack, they lack for the half segment at the clamp and by their measure of
/// strain: these rods are nearer to what those come to.
TEST_F(RodNumbers, Motions) {
    constexpr double kUntil = 0.301;
    const auto row = [&](const std::string& name) -> const Json& {
        for (const Json& each : numbers("table6_dynamics"))
            if (each.at("name") == name) return each;
        throw std::runtime_error("no row " + name);
    };
    // Discrete rods are of first order: from the finest and those of half as many points follows the limit.
    const auto limit = [&](const std::string& fine, const std::string& finest) {
        const Json &coarseRow = row(fine), &row_ = row(finest);
        const Way coarse = wayOf(coarseRow, kUntil), way = wayOf(row_, kUntil);
        Way result;
        for (std::size_t i = 0; i < way.size(); ++i) {
            EXPECT_EQ(coarseRow.at("times")[i], row_.at("times")[i]);
            result.push_back(2.0 * way[i] - coarse[i]);
        }
        return result;
    };
    const auto expectNearer = [&](const Way& ours, const std::string& name, const Way& right) {
        const Way theirs = wayOf(row(name), kUntil);
        const double their = largestDistance(theirs, right), our = largestDistance(ours, right);
        std::printf("%s: %.3f mm from the limit, theirs %.3f mm\n", name.c_str(), 1e3 * our, 1e3 * their);
        EXPECT_LT(our, 0.35 * their) << name;
    };
    const auto still = [](double) { return reference::Root{}; };
    const Way fall = limit("straight_64seg_s0.5", "straight_128seg_s0.5");
    for (const int segments : {16, 32, 64}) {
        const std::string name = "straight_" + std::to_string(segments) + "seg_s0.5";
        expectNearer(move(straightStrand(static_cast<std::size_t>(segments), 0.16), row(name), kUntil, still),
                     name, fall);
    }
    const auto shaken = [](double t) {
        return reference::Root{Vec3d(0.03 * (1.0 - std::cos(2.0 * kTau * t)), 0.0, 0.0)};
    };
    const auto turned = [](double t) {
        const double angle =
            t < 0.1 ? 0.25 * kTau * 0.5 * (1.0 - std::cos(0.5 * kTau * t / 0.1)) : 0.25 * kTau;
        return reference::Root{Vec3d::Zero(),
                               reference::Quaterniond(Eigen::AngleAxisd(angle, Vec3d::UnitY()))};
    };
    for (const int points : {12, 24}) {
        const std::string end = std::to_string(points) + "ppt";
        const Json& shake = row("helix_shake_" + end);
        const auto strands =
            helixAlong(-Vec3d::UnitY(), Json{{"r", 0.008}, {"pitch", 0.02}, {"turns", 4}}, points);
        expectNearer(move(strands, shake, kUntil, shaken), "helix_shake_" + end,
                     limit("helix_shake_24ppt", "helix_shake_48ppt"));
        expectNearer(move(strands, row("helix_turn_" + end), kUntil, turned), "helix_turn_" + end,
                     limit("helix_turn_24ppt", "helix_turn_48ppt"));
    }
}

/// A rod that is curved in a plane at rest, held upside down: share of its speed across the plane that it has
/// after some time, when it got a little.
double growthAcross(double curvature, double weight, double torsionRatio) {
    constexpr double kLength = 0.2;
    constexpr int kSegments = 60;
    runtime::SimulationSettings s = bareRods();
    const double wanted = kGravity * std::pow(kLength, 3.0) / weight / runtime::kHairBendingStiffness;
    s.angularStiffness = static_cast<float>(wanted / (1.0 + wanted));
    s.torsionRatio = static_cast<float>(torsionRatio);
    s.dampingTime = 0.02f;
    reference::Strands strands = straightStrand(kSegments, kLength);
    Vec3d position = Vec3d::Zero();
    for (int p = 0; p <= kSegments; ++p) {
        strands.restPositions_ss[static_cast<std::size_t>(p)] = position;
        const double angle = curvature / kSegments * p;
        position += kLength / kSegments * Vec3d(std::sin(angle), -std::cos(angle), 0.0);
    }
    reference::Solver solver = solverOf(strands, s);
    EXPECT_LT(comeToRest(solver), 1e-6);
    std::vector<Vec3d> push(kSegments + 1, Vec3d::Zero());
    for (int p = 2; p <= kSegments; ++p) push[static_cast<std::size_t>(p)].z() = 1e-3 * p / kSegments;
    solver.setMotion(solver.positions_ws(), push);
    const auto across = [&] {
        double largest = 0.0;
        for (const Vec3d& x : solver.positions_ws()) largest = std::max(largest, std::abs(x.z()));
        return largest;
    };
    for (int frame = 0; frame < 60; ++frame) solver.step(stillFrame(0.02), {2, 2});
    const double before = across();
    for (int frame = 0; frame < 20; ++frame) solver.step(stillFrame(0.02), {2, 2});
    return across() / before;
}

/// Table 5b: hair that is curved more than some turns out of its plane under its weight.
TEST_F(RodNumbers, CurvedHairTwistsOutOfItsPlane) {
    const Json& thresholds = numbers("table5_bend_twist").at("thresholds");
    for (const auto& [key, ratio] : {std::pair{"down|0.7500", 0.75}, {"down|0.5000", 0.5}}) {
        for (const Json& row : thresholds.at(key)) {
            const double weight = row.at("Gamma").get<double>();
            if (weight > 110.0) continue;
            const double right = row.at("crossings").at(0).at("kappaL").get<double>();
            const double below = growthAcross(0.95 * right, weight, ratio);
            const double above = growthAcross(1.05 * right, weight, ratio);
            std::printf("%s weight %.0f: grows by %.3f below, %.3f above\n", key, weight, below, above);
            EXPECT_LT(below, 1.0) << key << ", " << weight;
            EXPECT_GT(above, 1.0) << key << ", " << weight;
        }
    }
}

}  // namespace
}  // namespace hairloom
