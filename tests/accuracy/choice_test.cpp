// SPDX-License-Identifier: GPL-3.0-or-later
// What a measured grid offers, on grids that are made up.
#include "core/accuracy/choice.h"

#include <gtest/gtest.h>

#include "core/accuracy/run_preview.h"
#include "tests/accuracy/hair.h"

namespace hairloom::test {
namespace {

/// Substeps 1, 2, 4, 8 with one number of points each, their times and errors; an error of 0 has diverged.
WorkPrecision grid(const std::vector<std::pair<double, double>>& timesAndErrors) {
    WorkPrecision made;
    made.options.axes = {{"substeps", {}}, {std::string(kPointsAxis), {12}}};
    std::vector<std::pair<double, double>> pairs;
    double substeps = 1;
    for (const auto& [ms, mm] : timesAndErrors) {
        made.options.axes[0].values.push_back(substeps);
        WorkPrecisionRun run;
        run.values = {substeps, 12};
        run.milliseconds = {ms, ms, ms};
        run.diverged = mm == 0;
        run.error.rmsMm = mm;
        made.runs.push_back(run);
        pairs.emplace_back(ms, run.diverged ? std::numeric_limits<double>::infinity() : mm);
        substeps *= 2;
    }
    const std::vector<bool> front = paretoFront(pairs);
    for (std::size_t r = 0; r < front.size(); ++r) made.runs[r].onFront = front[r];
    return made;
}

TEST(Choice, FindsWhereTheGroomIs) {
    const WorkPrecision measured = grid({{1, 8}, {2, 3}, {4, 1}});
    Groom groom = straightHair(6, 12);
    groom.simulation.substeps = 2;
    EXPECT_EQ(runOf(measured, groom), 1u);
    groom.simulation.substeps = 3;
    EXPECT_FALSE(runOf(measured, groom)) << "was not measured";
    groom = straightHair(6, 11);
    groom.simulation.substeps = 2;
    EXPECT_FALSE(runOf(measured, groom)) << "other points";
}

TEST(Choice, TheGroomIsMovedByTheCpuAllStrandsAndAllSpheres) {
    WorkPrecision measured;
    measured.options.axes = {{std::string(kEngineAxis), {0, 1}}, {std::string(kGuidesAxis), {3, 9}}};
    for (auto& values : combinations(measured.options.axes))
        measured.runs.push_back({.values = std::move(values)});
    EXPECT_EQ(runOf(measured, straightHair(6, 12)), 1u) << "of 9 guides there are no more than 6";
}

TEST(Choice, PairsAreAlikeInOneThingAndDifferMostInTheOther) {
    const WorkPrecision measured = grid({{1, 8}, {1.1, 2}, {1.15, 6}, {0.9, 0}, {5, 2.2}, {1.05, 0.5}});
    EXPECT_EQ(pairOfEqualTime(measured, 0), 5u);
    EXPECT_EQ(pairOfEqualTime(measured, 5), 0u);
    EXPECT_EQ(pairOfEqualError(measured, 1), 4u);
    EXPECT_EQ(pairOfEqualError(measured, 4), 1u);
    EXPECT_FALSE(pairOfEqualTime(measured, 4)) << "nothing takes as long";
    EXPECT_FALSE(pairOfEqualError(measured, 0)) << "what diverges is no pair";
}

TEST(Choice, OffersWhatIsBetterAndNothingElse) {
    // The third costs more than the second and is no nearer.
    const WorkPrecision measured = grid({{1, 8}, {2, 3}, {4, 5}, {8, 1}});
    EXPECT_EQ(nextStep(measured, 0), 1u);
    EXPECT_EQ(nextStep(measured, 1), 3u) << "passes the one that buys nothing";
    EXPECT_EQ(nextStep(measured, 2), 1u) << "cheaper and nearer";
    EXPECT_FALSE(nextStep(measured, 3));
    EXPECT_EQ(cheapestWithinError(measured, 5), 1u);
    EXPECT_EQ(cheapestWithinError(measured, 1), 3u);
    EXPECT_FALSE(cheapestWithinError(measured, 0.5));
    EXPECT_EQ(mostExactWithinTime(measured, 7.9), 1u);
    EXPECT_EQ(mostExactWithinTime(measured, 100), 3u);
    EXPECT_FALSE(mostExactWithinTime(measured, 0.5));
}

TEST(Choice, NeverOffersWhatDiverged) {
    const WorkPrecision measured = grid({{1, 0}, {2, 3}, {4, 0}});
    EXPECT_EQ(cheapestWithinError(measured, 100), 1u);
    EXPECT_EQ(mostExactWithinTime(measured, 100), 1u);
    EXPECT_FALSE(mostExactWithinTime(measured, 1));
    EXPECT_EQ(nextStep(measured, 0), 1u) << "from a setting that diverges";
    EXPECT_FALSE(nextStep(measured, 1));
}

TEST(Choice, NeverOffersWhatTrembles) {
    WorkPrecision measured = grid({{1, 1}, {2, 3}});
    measured.runs[0].trembling = 0.02;
    EXPECT_EQ(cheapestWithinError(measured, 100), 1u);
    EXPECT_EQ(mostExactWithinTime(measured, 100), 1u);
}

TEST(Choice, SettingsInWords) {
    const WorkPrecision measured = grid({{1, 8}, {2, 3}});
    EXPECT_EQ(describeRun(measured, 0), "1 substep, 12 points");
    EXPECT_EQ(describeRun(measured, 1), "2 substeps, 12 points");
}

TEST(Choice, TriesWhatTheGroomHasAndWhatIsAroundIt) {
    Groom groom = straightHair(6, 13);
    groom.simulation.substeps = 3;
    auto axes = axesToTry(groom);
    ASSERT_EQ(axes.size(), 2u);
    EXPECT_EQ(axes[0].values, (std::vector<double>{1, 2, 3, 4, 8, 16, 32}));
    EXPECT_EQ(axes[1].values, (std::vector<double>{4, 6, 13}));
    groom.simulation.strandModel = runtime::StrandModel::springs;
    axes = axesToTry(groom);
    EXPECT_EQ(axes[1].field, "lengthIterations");
}

TEST(Choice, AlongAnAxisNothingElseChanges) {
    WorkPrecision measured;
    measured.options.axes = {{"substeps", {1, 2}}, {std::string(kPointsAxis), {6, 12, 24}}};
    for (auto& values : combinations(measured.options.axes)) measured.runs.push_back({.values = values});
    EXPECT_EQ(runsAlong(measured, 4, 0), (std::vector<std::size_t>{1, 4}));
    EXPECT_EQ(runsAlong(measured, 4, 1), (std::vector<std::size_t>{3, 4, 5}));
}

TEST(RunPreview, HasThePointsOfTheGroomWhateverRan) {
    const Groom groom = straightHair(6, 12);
    const auto motion = makeRigidMotion("nod", groom);
    WorkPrecision measured;
    measured.options.axes = {{"substeps", {2}}, {std::string(kPointsAxis), {5, 12}}};
    measured.options.time.frames = 8;
    for (auto& values : combinations(measured.options.axes)) measured.runs.push_back({.values = values});
    const auto coarse = previewRun(groom, **motion, measured, 0, {});
    const auto own = previewRun(groom, **motion, measured, 1, {});
    ASSERT_TRUE(coarse && own);
    ASSERT_EQ(own->positions_ws.size(), 9u);
    // Twelve points: the very simulation.
    Groom same = groom;
    same.simulation.substeps = 2;
    auto simulation = Simulation::make(same, own->poses.front(), {});
    ASSERT_TRUE(simulation.has_value());
    const SceneTime& time = measured.options.time;
    for (std::size_t frame = 1; frame < own->poses.size(); ++frame) {
        const float at = static_cast<float>(frame), rate = time.framesPerSecond;
        simulation->step(
            1 / rate, stepOf(**motion, own->poses[frame - 1], (at - 1) / rate, at / rate, time.posesWithin));
    }
    const auto last = simulation->positions_ws();
    for (std::size_t p = 0; p < last.size(); ++p) {
        EXPECT_LT((own->positions_ws.back()[p] - last[p]).norm(), 1e-6f);
        EXPECT_LT((coarse->positions_ws.back()[p] - last[p]).norm(), 0.02f) << "near, by other points";
    }
    EXPECT_FALSE(previewRun(groom, **motion, measured, 0, [] { return true; }));
    EXPECT_EQ(strandsFarthestApart(groom, *coarse, *own, 0.5).size(), 3u);
    EXPECT_TRUE(strandsFarthestApart(groom, *own, *own, 0.5).empty());
    RunPreview moved = *own;
    moved.positions_ws[3][groom.offsets[4] + 7] += Vec3f(0.1f, 0, 0);
    EXPECT_EQ(strandsFarthestApart(groom, moved, *own, 0), std::vector<std::uint32_t>{4});
}

}  // namespace
}  // namespace hairloom::test
