// SPDX-License-Identifier: GPL-3.0-or-later
// Work-precision runs and effect costs from end to end on a few strands, and what is written of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/accuracy/choice.h"
#include "core/accuracy/compare_reports.h"
#include "core/accuracy/work_precision_report.h"
#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/cost/effect_cost.h"
#include "tests/accuracy/hair.h"
#include "tests/accuracy/xml_check.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Hair that falls from a horizontal start; loose, so that the runs differ.
Groom fallingHair() {
    Groom groom = straightHair(6, 12);
    groom.simulation.angularStiffness = 0;
    return groom;
}

WorkPrecisionOptions smallGrid() {
    WorkPrecisionOptions options;
    options.axes = {{"integrator", {0}}, {"substeps", {1, 8}}, {"points", {4, 12}}};
    options.time.frames = 8;
    options.strands = 4;
    options.repeats = 2;
    return options;
}

Result<WorkPrecision> measureSmall(const WorkPrecisionOptions& options) {
    const Groom groom = fallingHair();
    const auto motion = makeRigidMotion("spin", groom);
    return measureWorkPrecision(groom, **motion, options, EngineConverged(8));
}

TEST(WorkPrecision, TellsWhatIsKnownAfterEachRound) {
    WorkPrecisionOptions options = smallGrid();
    std::vector<WorkPrecision> rounds;
    options.partial = [&](const WorkPrecision& result) { rounds.push_back(result); };
    const auto result = measureSmall(options);
    ASSERT_TRUE(result.has_value()) << result.error().message();
    ASSERT_EQ(rounds.size(), options.repeats);
    for (const WorkPrecision& round : rounds) {
        ASSERT_EQ(round.runs.size(), result->runs.size());
        for (std::size_t r = 0; r < round.runs.size(); ++r) {
            EXPECT_EQ(round.runs[r].error.rmsMm, result->runs[r].error.rmsMm);
            EXPECT_GT(round.runs[r].milliseconds.median, 0);
        }
        EXPECT_TRUE(std::ranges::any_of(round.runs, &WorkPrecisionRun::onFront));
    }
}

TEST(WorkPrecision, EndsWhenItIsCancelled) {
    WorkPrecisionOptions options = smallGrid();
    int asked = 0;
    options.cancelled = [&] { return ++asked > 2; };
    const auto result = measureSmall(options);
    ASSERT_FALSE(result.has_value());
    EXPECT_THAT(result.error().message(), HasSubstr("cancelled"));
    EXPECT_EQ(asked, 3) << "nothing runs on";
}

TEST(WorkPrecision, MoreWorkIsMorePrecise) {
    std::size_t last = 0, total = 0;
    WorkPrecisionOptions options = smallGrid();
    options.progress = [&](std::size_t done, std::size_t of) {
        EXPECT_GT(done, last);
        last = done;
        total = of;
    };
    const auto result = measureSmall(options);
    ASSERT_TRUE(result.has_value()) << result.error().message();
    EXPECT_EQ(last, total);
    EXPECT_EQ(result->strands, 4u);
    EXPECT_EQ(result->groomStrands, 6u);
    EXPECT_EQ(result->groundTruthPoints, 12u);
    ASSERT_EQ(result->runs.size(), 4u);
    for (const WorkPrecisionRun& run : result->runs) {
        EXPECT_FALSE(run.diverged);
        EXPECT_GT(run.milliseconds.median, 0);
        EXPECT_LE(run.milliseconds.q1, run.milliseconds.q3);
        EXPECT_GT(run.error.rmsMm, 0);
        EXPECT_GE(run.error.maxMm, run.error.rmsMm);
        EXPECT_TRUE(run.trajectory.points_ws.empty()) << "nobody asked for it";
    }
    const WorkPrecisionRun &coarse = result->runs[0], &best = result->runs[3];
    EXPECT_THAT(best.values, ElementsAre(0, 8, 12));
    EXPECT_LT(best.error.rmsMm, 0.5 * coarse.error.rmsMm);
    EXPECT_TRUE(best.onFront) << "nothing is as exact as the run closest to the truth";
    EXPECT_THAT(result->notes, Contains(HasSubstr("4 of 6 strands")));
}

TEST(WorkPrecision, ErrorsAreTheSameForAnyNumberOfThreads) {
    WorkPrecisionOptions options = smallGrid();
    options.axes.push_back({"threads", {1, 2}});
    options.repeats = 1;
    const std::size_t before = threadCount();
    const auto result = measureSmall(options);
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(threadCount(), before);
    for (std::size_t r = 0; r < result->runs.size(); r += 2) {
        EXPECT_EQ(result->runs[r].error.rmsMm, result->runs[r + 1].error.rmsMm);
        EXPECT_EQ(result->runs[r].stateHash, result->runs[r + 1].stateHash);
    }
}

TEST(WorkPrecision, WhatIsTooFarOffHasDivergedAndHasNoNumbers) {
    WorkPrecisionOptions options = smallGrid();
    options.divergedAboveMm = 1e-9;
    const auto result = measureSmall(options);
    ASSERT_TRUE(result.has_value());
    for (const WorkPrecisionRun& run : result->runs) {
        EXPECT_TRUE(run.diverged);
        EXPECT_FALSE(run.onFront);
        EXPECT_EQ(run.milliseconds.median, 0);
    }
    EXPECT_THAT(result->notes, Contains(HasSubstr("4 of 4 runs diverged")));
    EXPECT_THAT(workPrecisionCsv(*result), HasSubstr("verlet,1,4,,,,,,,,,,,,,,,1,0\n"));
    const auto drawing = parseXml(svg(workPrecisionPlot(*result, {})));
    EXPECT_TRUE(drawing.has_value()) << "a chart of nothing is still a drawing";
}

/// Springs feed curls: with backward Euler these never come to rest.
TEST(WorkPrecision, WhatTremblesAtRestIsNotRecommended) {
    Groom groom = straightHair(6, 24);
    std::vector<Vec3f> curls(groom.positions().begin(), groom.positions().end());
    for (std::size_t p = 0; p < curls.size(); ++p) {
        const float angle = 1.2f * static_cast<float>(p % 24);
        curls[p] += 0.008f * Vec3f(0, std::sin(angle), 1 - std::cos(angle));
    }
    const auto offsets = groom.offsets.view();
    groom = makeGroom({offsets.begin(), offsets.end()}, std::move(curls));
    const auto motion = makeRigidMotion("nod", groom);
    WorkPrecisionOptions options = smallGrid();
    options.axes = {{"strandModel", {1}}, {"substeps", {8}}};
    options.repeats = 1;
    options.divergedAboveMm = 1e6;
    groom.simulation.integrator = runtime::Integrator::implicitEuler;
    groom.simulation.angularStiffness = 0.7f;
    const auto result = measureWorkPrecision(groom, **motion, options, EngineConverged(8));
    ASSERT_TRUE(result.has_value()) << result.error().message();
    for (const WorkPrecisionRun& run : result->runs) {
        EXPECT_FALSE(run.diverged);
        EXPECT_FALSE(run.onFront);
        EXPECT_GT(run.trembling, 0.005);
    }
    EXPECT_THAT(result->notes, Contains(HasSubstr("trembles while the head is still")));
    groom.simulation.strandModel = runtime::StrandModel::rods;
    options.axes[0].values = {0};
    const auto rods = measureWorkPrecision(groom, **motion, options, EngineConverged(8));
    ASSERT_TRUE(rods.has_value());
    EXPECT_TRUE(std::ranges::any_of(rods->runs, &WorkPrecisionRun::onFront));
    EXPECT_TRUE(
        std::ranges::all_of(rods->runs, [](const WorkPrecisionRun& run) { return run.trembling == 0; }));
}

/// Of runs that differ in one thing alone, the parts tell which.
TEST(WorkPrecision, PartsOfTheErrorTellStepsPointsAndModelApart) {
    // Of the groom's own setting there are parts, wherever it is.
    const auto partsOf = [](runtime::StrandModel model, std::uint32_t substeps, std::uint32_t points) {
        Groom groom = straightHair(6, points);
        groom.simulation.strandModel = model;
        groom.simulation.angularStiffness = 0.3f;
        groom.simulation.substeps = substeps;
        const auto motion = makeRigidMotion("spin", groom);
        WorkPrecisionOptions options = smallGrid();
        options.axes = {{"substeps", {1, 32}}, {"points", {4, 12}}};
        options.repeats = 1;
        const auto result = measureWorkPrecision(groom, **motion, options, EngineConverged(16));
        return result ? result->runs[*runOf(*result, groom)].parts : std::nullopt;
    };
    const auto coarse = partsOf(runtime::StrandModel::rods, 1, 4);
    const auto exact = partsOf(runtime::StrandModel::rods, 32, 12);
    const auto springs = partsOf(runtime::StrandModel::springs, 32, 12);
    ASSERT_TRUE(coarse && exact && springs);
    EXPECT_GT(coarse->step.rmsMm, 3 * exact->step.rmsMm);
    EXPECT_GT(coarse->points.rmsMm, 3 * exact->points.rmsMm);
    EXPECT_GT(exact->points.rmsMm, 0) << "the finest of the grid is coarser than twice as fine";
    EXPECT_GT(springs->model.rmsMm, 10 * exact->model.rmsMm) << "springs are no rods";
}

/// Fewer guides are cheaper and lose what makes strands different; who follows goes from its own root.
TEST(WorkPrecision, GuidesStandForTheStrandsAroundThem) {
    Groom groom = straightHair(12, 12);
    groom.simulation.angularStiffness = 0.3f;
    std::vector<Vec3f> bent(groom.positions().begin(), groom.positions().end());
    for (std::size_t p = 0; p < bent.size(); ++p) {
        const float along = bent[p].x(), strand = static_cast<float>(p / 12);
        bent[p].y() += 0.1f * strand * along * along;  // each a little more than the one before
    }
    const auto offsets = groom.offsets.view();
    const runtime::SimulationSettings settings = groom.simulation;
    groom = makeGroom({offsets.begin(), offsets.end()}, std::move(bent));
    groom.simulation = settings;
    const auto motion = makeRigidMotion("nod", groom);
    WorkPrecisionOptions options = smallGrid();
    options.axes = {{"guides", {1, 4, 12}}, {"hairsPerGuide", {0, 4000}}, {"substeps", {8}}};
    options.strands = 4;  // but all of them run
    const auto result = measureWorkPrecision(groom, **motion, options, EngineConverged(16));
    ASSERT_TRUE(result.has_value()) << result.error().message();
    EXPECT_EQ(result->strands, 12u);
    const auto& runs = result->runs;
    ASSERT_EQ(runs.size(), 6u);
    EXPECT_GT(runs[0].error.rmsMm, 2 * runs[2].error.rmsMm) << "one guide, and four";
    EXPECT_GT(runs[2].error.rmsMm, 2 * runs[4].error.rmsMm) << "four, and all";
    EXPECT_LT(runs[0].error.rmsMm, 30) << "at its own root, which are up to 55 mm apart";
    EXPECT_EQ(runs[0].error.rmsMm, runs[1].error.rmsMm) << "hairs that follow change no motion";
    EXPECT_GT(runs[5].milliseconds.q1, runs[4].milliseconds.q1) << "but cost time";
    EXPECT_THAT(result->notes, testing::Not(Contains(HasSubstr("hairsPerGuide"))));
}

TEST(WorkPrecision, OneStrandOfTwoPointsIsMeasured) {
    const Groom groom = straightHair(1, 2);
    const auto motion = makeRigidMotion("nod", groom);
    WorkPrecisionOptions options = smallGrid();
    options.axes = axesToTry(groom);
    options.repeats = 1;
    const auto result = measureWorkPrecision(groom, **motion, options, EngineConverged(8));
    ASSERT_TRUE(result.has_value()) << result.error().message();
    for (const WorkPrecisionRun& run : result->runs) EXPECT_FALSE(run.diverged);
}

TEST(WorkPrecision, SettingsWithoutEffectAreNamed) {
    WorkPrecisionOptions options = smallGrid();
    options.axes = {{"windFrequency", {1, 2}}};  // there is no wind
    options.repeats = 1;
    const auto result = measureSmall(options);
    ASSERT_TRUE(result.has_value());
    EXPECT_THAT(result->notes, Contains(HasSubstr("windFrequency 1, 2 gave the same motion to the bit")));
}

TEST(WorkPrecision, WrongGridsAreRefused) {
    WorkPrecisionOptions options = smallGrid();
    options.axes.push_back({"substeps", {3}});
    EXPECT_THAT(measureSmall(options).error().message(), HasSubstr("twice"));
    options = smallGrid();
    options.axes[1].values = {300};
    EXPECT_THAT(measureSmall(options).error().message(), HasSubstr("1 to 256"));
}

/// Numbers made by hand, so that what is written can be told in advance.
WorkPrecision known() {
    WorkPrecision result;
    result.options = smallGrid();
    result.options.axes = {{"integrator", {0, 5}}, {"substeps", {1, 8}}};
    result.groomStrands = 40;
    result.strands = 4;
    result.groundTruthName = "made";
    result.runs = {
        {.values = {0, 1},
         .milliseconds = {0.5, 1, 2},
         .error = {4, 8},
         .other = {3, 0.5, 0.04, 1, 2},
         .parts = ErrorParts{{3.5, 7}, {0.125, 1}, {0.25, 1}},
         .onFront = true,
         .stateHash = 1},
        {.values = {0, 8}, .milliseconds = {4, 5, 6}, .error = {0.25, 0.5}, .onFront = true, .stateHash = 2},
        {.values = {5, 1}, .diverged = true, .stateHash = 3},
        {.values = {5, 8}, .milliseconds = {7, 8, 9}, .error = {0.5, 1}, .stateHash = 4},
    };
    return result;
}

TEST(Report, CsvHasARowForEachRun) {
    EXPECT_EQ(workPrecisionCsv(known()),
              "integrator,substeps,ms_median,ms_q1,ms_q3,ms_all_strands,error_mm_rms,error_mm_max,drop_mm,"
              "after_shake_mm,head_depth_mm,sphere_depth_mm,rest_speed_mm_s,step_error_mm,points_error_mm,"
              "model_error_mm,diverged,on_front\n"
              "verlet,1,1,0.5,2,10,4,8,3,0.5,1,2,40,3.5,0.125,0.25,0,1\n"
              "verlet,8,5,4,6,50,0.25,0.5,0,0,0,0,0,,,,0,1\n"
              "rk4,1,,,,,,,,,,,,,,,1,0\n"
              "rk4,8,8,7,9,80,0.5,1,0,0,0,0,0,,,,0,0\n");
}

TEST(Report, TwoReportsAreComparedSettingBySetting) {
    const WorkPrecision before = known();
    WorkPrecision after = known();
    after.runs[0].milliseconds = {1.9, 2.1, 2.2};  // twice as slow; its quartiles overlapped
    after.runs[1].error.rmsMm = 0.5;
    after.runs[3].diverged = true;
    const auto result = compareReports(workPrecisionCsv(before), workPrecisionCsv(after));
    ASSERT_TRUE(result) << result.error().message();
    ASSERT_EQ(result->runs.size(), 4u);
    EXPECT_EQ(result->runs[0].setting, "integrator verlet, substeps 1");
    EXPECT_FALSE(result->runs[0].slower) << "within the spread of the first";
    EXPECT_TRUE(result->runs[1].lessExact);
    EXPECT_FALSE(result->runs[2].slower || result->runs[2].lessExact) << "diverged before and after";
    EXPECT_TRUE(result->runs[3].lessExact) << "diverges now";
    after = known();
    after.runs[0].milliseconds = {2.1, 2.2, 2.3};
    EXPECT_TRUE(compareReports(workPrecisionCsv(before), workPrecisionCsv(after))->runs[0].slower);
    EXPECT_TRUE(compareReports(workPrecisionCsv(after), workPrecisionCsv(before))->missing.empty());
    after.runs.erase(after.runs.begin());
    EXPECT_EQ(compareReports(workPrecisionCsv(before), workPrecisionCsv(after))->missing.size(), 1u);
}

TEST(Report, WhatIsNoReportIsNotCompared) {
    const std::string csv = workPrecisionCsv(known());
    EXPECT_THAT(compareReports("a,b\n1,2\n", csv).error().message(), HasSubstr("no column ms_median"));
    EXPECT_THAT(compareReports("", csv).error().message(), HasSubstr("no column"));
    EXPECT_THAT(compareReports(csv + "verlet,2\n", csv).error().message(), HasSubstr("2 columns"));
    EXPECT_THAT(compareReports(csv + "verlet,2,x,1,1,1,1,1,,,,,,,,,0,0\n", csv).error().message(),
                HasSubstr("ms_median is 'x'"));
    EXPECT_THAT(compareReports(csv.substr(0, csv.find('\n')), csv).error().message(),
                HasSubstr("no setting in common"));
}

TEST(Report, TheChartShowsFrontAndRest) {
    const Plot plot = workPrecisionPlot(known(), {.groom = "g", .motion = "nod", .commandLine = ""});
    std::size_t faint = 0, labelled = 0, points = 0;
    for (const Series& series : plot.series) {
        if (series.marker == Marker::None) continue;
        for (const PlotPoint& point : series.points) {
            ++points;
            faint += point.faint;
            labelled += !point.label.empty();
        }
    }
    EXPECT_EQ(points, 3u) << "the diverged one has no place";
    EXPECT_EQ(plot.series[1].name, "rk4 (1 of 2 diverged)") << "but is told of";
    EXPECT_EQ(faint, 1u);
    EXPECT_EQ(labelled, 2u);
    EXPECT_EQ(plot.x.scale, Scale::Logarithmic);
    EXPECT_TRUE(parseXml(svg(plot)).has_value());
}

TEST(Report, EachMeasureHasAChartAndAFrontOfItsOwn) {
    WorkPrecision result = known();
    EXPECT_THAT(frontBy(result, Measure::distance), ElementsAre(true, true, false, false));
    result.runs[3].other.returnMm = 0.1;  // slowest, and the only one that comes back
    result.runs[1].other.returnMm = 0.2;
    EXPECT_THAT(frontBy(result, Measure::afterShake), ElementsAre(true, true, false, true));
    const Plot plot = workPrecisionPlot(result, {}, Measure::drop);
    EXPECT_EQ(plot.y.title, "sag at rest");
    double lowest = 1e9;
    for (const Series& series : plot.series) {
        for (const PlotPoint& point : series.points) lowest = std::min(lowest, point.y);
    }
    EXPECT_EQ(lowest, 1e-3) << "none at all stands at the lower edge";
    EXPECT_EQ(valueOf(result.runs[0], Measure::depth), 2) << "the deeper of head and spheres";
}

TEST(Report, PartsOfTheErrorAreFourBarsForEachSettingThatHasThem) {
    WorkPrecision result = known();
    result.groundTruthUncertaintyMm = 0.01;
    const auto plot = partsPlot(result);
    ASSERT_TRUE(plot.has_value());
    ASSERT_EQ(plot->series.size(), 4u);
    ASSERT_EQ(plot->series[1].points.size(), 1u);
    EXPECT_EQ(plot->series[1].points[0].y, 0.125);
    EXPECT_EQ(plot->series[3].points[0].y, 0.01) << "the doubt of the reference";
    const std::string drawing = svg(*plot);
    ASSERT_TRUE(parseXml(drawing).has_value());
    EXPECT_THAT(drawing, HasSubstr("substeps 1: points 0.125 mm"));
    result.runs[0].parts.reset();
    EXPECT_FALSE(partsPlot(result).has_value());
}

TEST(Report, ErrorPlotsAreForAxesOfNumbers) {
    EXPECT_FALSE(errorPlot(known(), 0).has_value()) << "integrators are no numbers";
    const auto plot = errorPlot(known(), 1);
    ASSERT_TRUE(plot.has_value());
    ASSERT_EQ(plot->series.size(), 2u);
    EXPECT_TRUE(std::isinf(plot->series[1].points[0].y)) << "diverged";
    EXPECT_DOUBLE_EQ(plot->series[0].points[1].y, 0.25);
}

TEST(Report, AllFilesAreWrittenAndThePageStandsAlone) {
    const TemporaryFolder own;
    const fs::path folder = own / "new" / "below";
    const auto names = writeWorkPrecision(known(), {"<g>", "nod", "hairloom-cli accuracy"}, folder);
    ASSERT_TRUE(names.has_value()) << names.error().message();
    EXPECT_THAT(*names,
                ElementsAre("data.csv", "work_precision.svg", "drop.svg", "after_shake.svg", "depth.svg",
                            "rest_speed.svg", "error_parts.svg", "error_vs_substeps.svg", "report.html"));
    const std::string page = *readTextFile(folder / "report.html");
    EXPECT_THAT(page, HasSubstr("&lt;g&gt;"));
    EXPECT_THAT(page, HasSubstr("hairloom-cli accuracy"));
    EXPECT_THAT(page, HasSubstr("windKind turbulent")) << "what was not varied is told, too";
    EXPECT_THAT(page, HasSubstr(*readTextFile(folder / "work_precision.svg")));
    EXPECT_THAT(page, testing::Not(HasSubstr("src=")));
    EXPECT_THAT(page, testing::Not(HasSubstr("href=")));
}

TEST(EffectCosts, EveryEffectReportsReasonAndCost) {
    Groom groom = straightHair(6, 8);
    groom.simulation.windSpeed = 2;
    const auto motion = makeRigidMotion("none", groom);
    EffectCostOptions options;
    options.time.frames = 3;
    options.repeats = 2;
    const auto costs = measureEffectCosts(groom, **motion, options);
    ASSERT_TRUE(costs.has_value()) << costs.error().message();
    EXPECT_GT(costs->milliseconds.median, 0);
    std::size_t on = 0;
    for (const EffectCost& effect : costs->effects) {
        EXPECT_FALSE(effect.why.empty()) << effect.name;
        const bool follows = effect.name == "torsion" || effect.name == "length" ||
                             effect.name == "continuousCollision" || effect.name == "solve";
        EXPECT_EQ(effect.on && !follows, effect.costMilliseconds.has_value()) << effect.name;
        EXPECT_EQ(effect.on && !follows, !effect.turnedOffBy.empty()) << effect.name;
        on += effect.on;
        if (effect.name == "wind") {
            EXPECT_THAT(effect.note, HasSubstr("without it drag is on"));
        }
        if (effect.name == "collision") {
            EXPECT_EQ(effect.why, "off, no spheres");
        }
        EXPECT_THAT(effect.note, testing::Not(HasSubstr("cannot be turned off"))) << effect.name;
    }
    EXPECT_GE(on, 4u);
}

TEST(EffectCosts, WithoutSpheresCollisionIsOff) {
    Groom groom = straightHair(6, 8);
    groom.spheres.push_back({"ball", Vec3f(0.1f, 1.45f, 0), 0.1f, ""});
    const auto motion = makeRigidMotion("none", groom);
    EffectCostOptions options;
    options.time.frames = 2;
    options.repeats = 1;
    const auto costs = measureEffectCosts(groom, **motion, options);
    ASSERT_TRUE(costs.has_value()) << costs.error().message();
    const auto collision = std::ranges::find(costs->effects, "collision", &EffectCost::name);
    ASSERT_NE(collision, costs->effects.end());
    EXPECT_TRUE(collision->on);
    EXPECT_EQ(collision->turnedOffBy, "no spheres");
    EXPECT_TRUE(collision->millisecondsOff.has_value());
}

}  // namespace
}  // namespace hairloom::test
