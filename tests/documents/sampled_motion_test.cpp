// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded motion at the times of a file, and what of a groom stands in USD and Alembic beside its curves.
#include "core/documents/sampled_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/documents/hair_export.h"
#include "importers/alembic_archive.h"
#include "importers/usd_stage.h"
#include "tests/documents/small_head.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

/// A point that falls: x is the time in frames, y its square.
std::vector<std::vector<Vec3f>> falling(int count) {
    std::vector<std::vector<Vec3f>> shapes;
    for (int i = 0; i < count; ++i)
        shapes.push_back({Vec3f(static_cast<float>(i), static_cast<float>(i * i), 0)});
    return shapes;
}

TEST(SampledMotion, ShuttersAreTwoNumbersAFrameApartAtMost) {
    const auto good = shutterFrom("-0.25:0.25", 3);
    ASSERT_TRUE(good);
    EXPECT_EQ(good->open, -0.25);
    EXPECT_EQ(good->close, 0.25);
    for (const char* text : {"", ":", "0.5", "0:", ":0.5", "0.5:0", "0:0", "-2:0", "0:1.5", "-0.6:0.6",
                             "nan:1", "0:inf", "0:0.5:1", "0,5:1", "a:b"})
        EXPECT_FALSE(shutterFrom(text, 3)) << text;
    EXPECT_FALSE(shutterFrom("0:0.5", 1));
    EXPECT_FALSE(shutterFrom("0:0.5", kMaxShutterSamples + 1));
}

TEST(SampledMotion, FramesOfTheRecordKeepTheirBitsAndOthersLieOnCurves) {
    MotionSampling sampling;
    sampling.before = 2;
    sampling.after = 2;
    sampling.firstFrame = 1001;
    sampling.shutter = {-0.25, 0.25, 3};
    const auto shapes = falling(8);
    const SampledMotion made = sampleMotion(shapes, sampling);
    const StrandFrames& frames = made.frames;
    EXPECT_EQ(frames.frameCount(), 4u);
    ASSERT_EQ(frames.points.size(), 12u);
    EXPECT_EQ(made.between, 8u);
    EXPECT_EQ(made.beyond, 0u);
    EXPECT_EQ(frames.numberOf(0), 1000.75);
    EXPECT_EQ(frames.numberOf(11), 1004.25);
    for (std::size_t i = 0; i < 12; ++i) {
        // A parabola is what it was.
        const double at = frames.numberOf(i) - 1001 + 2;
        EXPECT_NEAR(frames.points[i][0].x(), at, 1e-5);
        EXPECT_NEAR(frames.points[i][0].y(), at * at, 1e-4);
    }
    EXPECT_EQ(frames.points[4][0], shapes[3][0]);
}

TEST(SampledMotion, AShutterThatIsNeverShutHasNoTimeTwice) {
    MotionSampling sampling;
    sampling.shutter = {-0.5, 0.5, 3};
    const SampledMotion made = sampleMotion(falling(3), sampling);
    EXPECT_EQ(made.frames.frameCount(), 3u);
    ASSERT_EQ(made.frames.points.size(), 7u);
    for (std::size_t i = 0; i < 7; ++i)
        EXPECT_DOUBLE_EQ(made.frames.numberOf(i), -0.5 + 0.5 * static_cast<double>(i));
    EXPECT_EQ(made.beyond, 2u);
    EXPECT_NEAR(made.frames.points[0][0].x(), -0.5f, 1e-6f) << "goes on as it moves at the end";
    EXPECT_NEAR(made.frames.points[6][0].x(), 2.5f, 1e-6f);
}

TEST(SampledMotion, OtherRatesSeeTheSameMotion) {
    MotionSampling sampling;
    sampling.framesPerSecond = 24;
    const SampledMotion made = sampleMotion(falling(11), sampling);
    ASSERT_EQ(made.frames.points.size(), 5u) << "0, 2.5, 5, 7.5 and 10";
    EXPECT_NEAR(made.frames.points[1][0].x(), 2.5f, 1e-6f);
    EXPECT_EQ(made.frames.points[4][0], falling(11)[10][0]);
    EXPECT_EQ(made.between, 2u);
    EXPECT_EQ(sampleMotion(falling(1), sampling).frames.points.size(), 1u);
}

class HairOut : public testing::Test {
  protected:
    static std::vector<RecordedFrame> turning(const Groom& groom, int count) {
        std::vector<RecordedFrame> frames;
        for (int f = 0; f < count; ++f) {
            RecordedFrame frame;
            const Eigen::AngleAxisf turn(0.1f * static_cast<float>(f), Vec3f::UnitY());
            for (const Vec3f& point : groom.positions()) frame.positions_ws.emplace_back(turn * point);
            for (const Vec3f& vertex : groom.scalp->positions())
                frame.pose.scalpPositions_ws.emplace_back(turn * vertex);
            frames.push_back(std::move(frame));
        }
        return frames;
    }
    const TemporaryFolder folder_;
};

TEST_F(HairOut, ShuttersReachEveryFormatThatMoves) {
    const Groom groom = smallHead();
    HairToExport wanted;
    wanted.frames = turning(groom, 6);
    wanted.framesBefore = wanted.framesAfter = 1;
    wanted.firstFrame = 1001;
    wanted.shutter = {-0.25, 0.25, 3};
    for (const std::string format : {"abc", "abc-unreal", "usda", "usdc"}) {
        SCOPED_TRACE(format);
        const HairWriter& writer = strandWriter(format);
        const fs::path path = folder_ / ("a." + writer.suffix());
        const auto report = exportHair(groom, wanted, writer, path, {});
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->frames, 4u);
        EXPECT_EQ(report->samples, 12u);
        EXPECT_LT(report->maxErrorMm.value(), 0.001);
        StrandImportOptions reading;
        reading.frames = true;
        const auto back = importStrands(path, reading);
        ASSERT_TRUE(back) << back.error().message();
        EXPECT_NEAR(back->framesPerSecond, 60, 1e-3) << "samples within a frame are exposures";
        reading.everySample = true;
        EXPECT_EQ(importStrands(path, reading)->frames.size(), 12u);
        if (format[0] == 'a') {
            const auto bytes = readFile(path).value();
            const auto archive = AlembicArchive::open("a.abc", bytes);
            ASSERT_TRUE(archive);
            EXPECT_TRUE(archive->times(1).isCyclic());
            EXPECT_NEAR(archive->times(1).at(0), 1000.75 / 60, 1e-9);
            EXPECT_NEAR(archive->times(1).at(5), 1002.25 / 60, 1e-9);
        } else {
            const auto stage = openUsdStage(path.string(), readFile(path).value(), {});
            ASSERT_TRUE(stage);
            EXPECT_EQ(stage->metadata.at("startTimeCode").numbers[0], 1001);
            EXPECT_EQ(stage->metadata.at("endTimeCode").numbers[0], 1004);
        }
    }
    wanted.frames.resize(2);
    EXPECT_FALSE(exportHair(groom, wanted, strandWriter("abc"), folder_ / "b.abc", {}))
        << "all frames are around those of the file";
    wanted.frames = turning(groom, 3);
    EXPECT_FALSE(exportHair(groom, wanted, strandWriter("ply"), folder_ / "b.ply", {})) << "holds one pose";
    EXPECT_TRUE(fs::is_empty(folder_.path()) || !fs::exists(folder_ / "b.ply"));
}

TEST_F(HairOut, GuidesStandBesideTheHairsInUsd) {
    Groom groom = smallHead();
    groom.layers.clear();
    groom.layers.emplace_back().name = "Fringe (left)";
    groom.layers.emplace_back().name = "Fringe (left)_guides";
    std::vector<std::uint32_t> layers(groom.strandCount(), 0);
    layers.back() = 1;
    groom.strandAttributes.set(attribute::kLayer, layers);
    HairToExport wanted;
    wanted.hair = ExportedHair::all;
    StrandExportOptions options;
    options.physics = true;
    for (const std::string format : {"usda", "usdc"}) {
        SCOPED_TRACE(format);
        const fs::path path = folder_ / ("a." + format);
        const auto report = exportHair(groom, wanted, strandWriter(format), path, options);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->strands, groom.strandCount() * 5);
        const auto stage = openUsdStage(path.string(), readFile(path).value(), {});
        ASSERT_TRUE(stage) << stage.error().message();
        EXPECT_TRUE(stage->repeated.empty());
        std::vector<std::string> names;
        const UsdPrim& root = stage->root.children.at(0);
        for (const UsdPrim& prim : root.children) names.push_back(prim.type + " " + prim.name);
        EXPECT_THAT(names, ElementsAre("BasisCurves Fringe__left_", "BasisCurves Fringe__left__guides",
                                       "BasisCurves Fringe__left__guides_2",
                                       "BasisCurves Fringe__left__guides_guides", "Mesh scalp",
                                       "Scope materials", "Scope physics"));
        EXPECT_EQ(root.children[0].find("purpose"), nullptr);
        EXPECT_EQ(root.children[0].find("physics:restShapePoints"), nullptr) << "hairs follow";
        const UsdPrim& guides = root.children[1];
        EXPECT_THAT(guides.find("purpose")->value.texts, ElementsAre("guide"));
        const std::size_t numbers = guides.find("points")->value.numbers.size();
        EXPECT_EQ(guides.find("physics:restShapePoints")->value.numbers.size(), numbers);
        EXPECT_EQ(guides.find("normals")->value.numbers.size(), numbers);
        const UsdPrim& physics = root.children[6];
        ASSERT_EQ(physics.children.size(), 4u);
        EXPECT_EQ(physics.children[0].type, "PhysicsScene");
        EXPECT_EQ(physics.children[2].type, "PhysicsAttachment");
        EXPECT_THAT(physics.children[2].find("physics:src0")->value.texts,
                    ElementsAre("/groom/Fringe__left__guides"));
        EXPECT_EQ(physics.children[2].find("physics:indices0")->value.numbers.size(),
                  (groom.strandCount() - 1) * groom.simulation.clampedPoints);
        const auto back = importStrands(path);
        ASSERT_TRUE(back) << back.error().message();
        ASSERT_EQ(back->groom.layers.size(), 2u);
        EXPECT_EQ(back->groom.layers[0].name, "Fringe (left)");
        EXPECT_EQ(back->groom.layers[1].name, "Fringe (left)_guides");
        const auto flags = back->groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
        EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(flags, 1)), groom.strandCount());
    }
    wanted.frames = turning(groom, 2);
    EXPECT_FALSE(exportHair(groom, wanted, strandWriter("usda"), folder_ / "b.usda", options)) << "moves";
    EXPECT_FALSE(exportHair(groom, {}, strandWriter("abc"), folder_ / "b.abc", options));
    EXPECT_FALSE(exportHair(groom, wanted, strandWriter("abc"), folder_ / "b.abc", {}))
        << "has one kind of strands";
    wanted.hair = ExportedHair::hairs;
    const auto alone = exportHair(groom, wanted, strandWriter("usda"), folder_ / "c.usda", {});
    ASSERT_TRUE(alone) << alone.error().message();
    EXPECT_EQ(alone->strands, groom.strandCount() * 4) << "guides where they were asked for alone";
}

TEST_F(HairOut, OneLayerHasHairsAndGuides) {
    HairToExport wanted;
    wanted.hair = ExportedHair::all;
    wanted.frames = turning(smallHead(), 3);
    const fs::path path = folder_ / "a.usdc";
    ASSERT_TRUE(exportHair(smallHead(), wanted, strandWriter("usdc"), path, {}));
    const auto back = importStrands(path);
    ASSERT_TRUE(back) << back.error().message();
    ASSERT_EQ(back->groom.layers.size(), 1u);
    EXPECT_EQ(back->groom.layers[0].name, Layer{}.name);
    EXPECT_EQ(back->groom.strandCount(), smallHead().strandCount() * 5);
}

TEST_F(HairOut, StiffnessesOfPhysicsAreThoseOfTheSettings) {
    Groom groom = smallHead();
    groom.material.rootRadius = 0.00004f;
    groom.material.tipScale = 1;
    groom.simulation.angularStiffness = 0.5f;
    groom.simulation.torsionRatio = 0.75f;
    StrandExportOptions options;
    options.physics = true;
    for (const float unit : {1.0f, 0.01f}) {
        options.metresPerUnit = unit;
        const fs::path path = folder_ / "a.usda";
        ASSERT_TRUE(exportHair(groom, {}, strandWriter("usda"), path, options));
        const auto stage = openUsdStage(path.string(), readFile(path).value(), {});
        ASSERT_TRUE(stage);
        const UsdPrim* const material = stage->root.children.at(0).child("physics")->child("hair");
        ASSERT_NE(material, nullptr);
        const auto value = [&](const char* name) { return material->find(name)->value.numbers[0]; };
        const double scale = static_cast<double>(unit);
        // s = 0.5 is hair of 80 micrometres by definition, and 0.75 that of Poisson's ratio 1/3.
        EXPECT_NEAR(value("physics:thickness"), 80e-6 / scale, 1e-9 / scale);
        EXPECT_NEAR(value("physics:bendStiffness"), 3.89e9 * scale, 1e5 * scale);
        EXPECT_NEAR(value("physics:twistStiffness"), 3.89e9 / (2 * (1 + 1.0 / 3)) * scale, 1e5 * scale);
        EXPECT_NEAR(value("physics:density"), 1300 * scale * scale * scale, 1e-3 * scale);
    }
}

}  // namespace
}  // namespace hairloom::test
