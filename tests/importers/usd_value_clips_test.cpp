// SPDX-License-Identifier: GPL-3.0-or-later
// Value clips of USD: the numbers expected here are those that usd-core 26.11 reads from the same stages.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "importers/scene.h"
#include "importers/strands.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

class ValueClips : public testing::Test {
  protected:
    void SetUp() override {
        clip("c0", {{0, 10}, {1, 11}, {2, 12}});
        clip("c1", {{0, 20}, {1, 21}, {2, 30}});
        write("none", "over \"clip\"\n{\n}\n");
    }
    void write(const std::string& name, const std::string& text, const std::string& metadata = {}) const {
        std::ofstream(folder / (name + ".usda"), std::ios::binary)
            << "#usda 1.0\n(\n    metersPerUnit = 1\n    timeCodesPerSecond = 1\n"
            << metadata << ")\n"
            << text;
    }
    static std::string line(double y) { return fmt::format("[(0, {}, 0), (0, {}, 1)]", y, y); }
    /// Strands at heights, by times of the clip.
    void clip(const std::string& name, const std::vector<std::pair<double, double>>& heights) const {
        std::string samples;
        for (const auto& [time, y] : heights) samples += fmt::format("{}: {}, ", time, line(y));
        write(name, "over \"clip\"\n{\n    point3f[] points.timeSamples = {" + samples + "}\n}\n");
    }
    static std::string curves(const std::string& clips, const std::string& more = {}) {
        return "def BasisCurves \"hair\" (\n    clips = {\n        dictionary default = {\n" + clips +
               "\n            string primPath = \"/clip\"\n        }\n    }\n)\n{\n" +
               "    uniform token type = \"linear\"\n    int[] curveVertexCounts = [2]\n" + more + "}\n";
    }
    Result<ImportedStrands> read(const std::string& name, float rate = 2) const {
        StrandImportOptions options;
        options.frames = true;
        options.framesPerSecond = rate;
        return importStrands(folder / (name + ".usda"), options);
    }
    /// Heights of the root at each half second from the first sample on.
    std::vector<float> heights(const std::string& name) const {
        const auto imported = read(name);
        if (!imported) {
            ADD_FAILURE() << imported.error().message();
            return {};
        }
        std::vector<float> found;
        for (const auto& frame : imported->frames) found.push_back(frame[0].y());
        return found;
    }
    void expectHeights(const std::string& name, const std::vector<float>& expected) const {
        const auto found = heights(name);
        ASSERT_EQ(found.size(), expected.size()) << name << ": " << testing::PrintToString(found);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i], expected[i], 1e-5f) << name << " at half second " << i;
    }
    static std::string said(const ImportedStrands& imported) {
        std::string all;
        for (const Finding& finding : imported.warnings) all += finding.what + "; ";
        return all;
    }
    const TemporaryFolder folder;
};

constexpr const char* kTwo = "asset[] assetPaths = [@./c0.usda@, @./c1.usda@]\n";

TEST_F(ValueClips, FollowOneAnotherAtTheirTimes) {
    write("jump", curves(std::string(kTwo) + "double2[] active = [(0, 0), (3, 1)]\n"
                                             "double2[] times = [(0, 0), (3, 3), (3, 0), (6, 3)]"));
    expectHeights("jump", {10, 10.5f, 11, 11.5f, 12, 12, 20, 20.5f, 21, 25.5f, 30});
    // Without times of their own clips are in the stage's.
    write("plain", curves(std::string(kTwo) + "double2[] active = [(0, 0), (3, 1)]"));
    expectHeights("plain", {10, 10.5f, 11, 11.5f, 12, 21, 30});
    write("back", curves("asset[] assetPaths = [@./c0.usda@]\ndouble2[] active = [(1, 0)]\n"
                         "double2[] times = [(1, 0), (2, 2), (3, 0)]"));
    expectHeights("back", {10, 11, 12, 11, 10});
    // In any order.
    write("order", curves(std::string(kTwo) + "double2[] active = [(3, 1), (0, 0)]\n"
                                              "double2[] times = [(3, 3), (0, 0), (3, 0), (6, 3)]"));
    expectHeights("order", {10, 10.5f, 11, 11.5f, 12, 12, 20, 20.5f, 21, 25.5f, 30});
}

TEST_F(ValueClips, AreWeakerThanTheirOwnLayerAndStrongerThanOthers) {
    const std::string clips =
        "asset[] assetPaths = [@./c0.usda@]\ndouble2[] active = [(0, 0)]\ndouble2[] times = [(0, 0), (10, "
        "10)]";
    write("own", curves(clips, "    point3f[] points = " + line(99) + "\n"));
    EXPECT_TRUE(read("own")->frames.empty());
    EXPECT_FLOAT_EQ(read("own")->groom.positions()[0].y(), 99);
    write("sub",
          "def BasisCurves \"hair\"\n{\n    int[] curveVertexCounts = [2]\n    uniform token type = "
          "\"linear\"\n"
          "    point3f[] points.timeSamples = {0: " +
              line(5) + "}\n}\n");
    const std::string over = curves(clips).replace(0, 15, "over");
    write("root", over, "    subLayers = [@./sub.usda@]\n");
    expectHeights("root", {10, 10.5f, 11, 11.5f, 12});
    // Times of a layer are those of the clips that it names.
    write("moved", "", "    subLayers = [@./root.usda@ (offset = 10; scale = 2)]\n");
    expectHeights("moved", {10, 10.25f, 10.5f, 10.75f, 11, 11.25f, 11.5f, 11.75f, 12});
    write("referenced",
          "def \"h\" (\n    references = @./root.usda@</hair> (offset = 10; scale = 2)\n)\n{\n}\n");
    expectHeights("referenced", {10, 10.25f, 10.5f, 10.75f, 11, 11.25f, 11.5f, 11.75f, 12});
    // A stronger layer changes when clips play.
    write("later",
          "over \"hair\" (\n    clips = { dictionary default = {\n"
          "        double2[] times = [(0, 1), (10, 11)]\n    } }\n)\n{\n}\n",
          "    subLayers = [@./root.usda@]\n");
    expectHeights("later", {11, 11.5f, 12});
}

TEST_F(ValueClips, MissingValuesAreThoseOfTheManifestOrOfThoseBeside) {
    const std::string clips =
        "asset[] assetPaths = [@./c0.usda@, @./c1.usda@, @./none.usda@]\n"
        "double2[] active = [(0, 0), (2, 2), (3, 1)]\n"
        "double2[] times = [(0, 0), (2, 2), (3, 0), (5, 2)]\n";
    write("between", curves("asset[] assetPaths = [@./c0.usda@, @./c1.usda@, @./none.usda@]\n"
                            "double2[] active = [(0, 0), (3, 2), (5, 2), (7, 1)]\n"
                            "bool interpolateMissingClipValues = true"));
    expectHeights("between",
                  {10, 10.5f, 11, 11.5f, 12, 13.8f, 15.6f, 17.4f, 19.2f, 21, 22.8f, 24.6f, 26.4f, 28.2f, 30});
    write("manifest", "over \"clip\"\n{\n    point3f[] points = " + line(50) + "\n}\n");
    write("declared", curves(clips + "asset manifestAssetPath = @./manifest.usda@"));
    expectHeights("declared", {10, 10.5f, 11, 30.5f, 50, 35, 20, 20.5f, 21, 25.5f, 30});
    write("widths", "over \"clip\"\n{\n    float[] widths = [1]\n}\n");
    write("undeclared", curves(clips + "asset manifestAssetPath = @./widths.usda@"));
    EXPECT_FALSE(read("undeclared")) << "the manifest has no points";
}

TEST_F(ValueClips, TemplatesNameTheFilesThatAreThere) {
    clip("t.001", {{1, 1}});
    clip("t.003", {{3, 3}, {4, 9}});
    clip("t.005", {{5, 50}});
    const std::string clips =
        "string templateAssetPath = \"./t.###.usda\"\ndouble templateStartTime = 1\n"
        "double templateEndTime = 6\ndouble templateStride = 1\n";
    write("template", curves(clips));
    expectHeights("template", {1, 1.5f, 2, 2.5f, 3, 6, 9, 29.5f, 50});
    write("early", curves(clips + "double templateActiveOffset = -0.5"));
    const auto imported = read("early");
    ASSERT_TRUE(imported) << imported.error().message();
    // From 0.5 s or 1 s on, since 1 is held before.
    std::vector<float> last;
    for (const auto& frame : imported->frames) last.push_back(frame[0].y());
    ASSERT_GE(last.size(), 6u);
    EXPECT_FLOAT_EQ(last.back(), 50) << "from 4.5 s on";
    EXPECT_FLOAT_EQ(last[last.size() - 2], 9) << "at 4 s";
    EXPECT_FLOAT_EQ(last[last.size() - 3], 6) << "at 3.5 s";
}

TEST_F(ValueClips, MoveWhatLiesBelowAndDeclareNothing) {
    write("turn",
          "over \"clip\"\n{\n    over \"hair\"\n    {\n"
          "        double3 xformOp:translate.timeSamples = {0: (0, 0, 0), 4: (0, 4, 0)}\n"
          "        float[] primvars:new.timeSamples = {0: [1]}\n    }\n}\n");
    const std::string text =
        "def Xform \"head\" (\n    clips = { dictionary default = {\n"
        "        asset[] assetPaths = [@./turn.usda@]\n        double2[] active = [(0, 0)]\n"
        "        string primPath = \"/clip\"\n    } }\n)\n{\n    def BasisCurves \"hair\"\n    {\n"
        "        uniform token type = \"linear\"\n        int[] curveVertexCounts = [2]\n"
        "        point3f[] points = [(0, 0, 0), (0, 1, 0)]\n        double3 xformOp:translate\n"
        "        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    }\n}\n";
    write("moving", text);
    expectHeights("moving", {0, 0.5f, 1, 1.5f, 2, 2.5f, 3, 3.5f, 4});
    EXPECT_FALSE(read("moving")->groom.strandAttributes.has("new"));

    // Heads, too: a jump is two keys.
    write("jumping",
          "over \"clip\"\n{\n    double3 xformOp:translate.timeSamples = {0: (0, 0, 0), 4: (0, 4, 0)}\n}\n");
    write("head",
          "def Xform \"head\" (\n    clips = { dictionary default = {\n"
          "        asset[] assetPaths = [@./jumping.usda@]\n        double2[] active = [(0, 0)]\n"
          "        double2[] times = [(0, 0), (2, 2), (2, 0), (4, 2)]\n"
          "        string primPath = \"/clip\"\n    } }\n)\n{\n    double3 xformOp:translate\n"
          "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    def Mesh \"skin\"\n    {\n"
          "        int[] faceVertexCounts = [3]\n        int[] faceVertexIndices = [0, 1, 2]\n"
          "        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, 1)]\n    }\n}\n");
    const auto scene = importScene(folder / "head.usda");
    ASSERT_TRUE(scene) << scene.error().message();
    ASSERT_EQ(scene->clips.size(), 1u);
    ASSERT_EQ(scene->clips[0].channels.size(), 1u);
    const auto& track = scene->clips[0].channels[0].translation;
    const auto heightAt = [&](float time) {
        for (std::size_t k = 0; k + 1 < track.times.size(); ++k) {
            if (time < track.times[k] || time > track.times[k + 1]) continue;
            const float share = (time - track.times[k]) / (track.times[k + 1] - track.times[k]);
            return (1 - share) * track.values[k].y() + share * track.values[k + 1].y();
        }
        return track.values.back().y();
    };
    for (const auto& [time, y] :
         std::vector<std::pair<float, float>>{{0, 0}, {1, 1}, {1.9f, 1.9f}, {2.1f, 0.1f}, {4, 2}})
        EXPECT_NEAR(heightAt(time), y, 1e-4f) << "at " << time << " s";
}

TEST_F(ValueClips, WhatIsMissingIsNamed) {
    const auto errorOf = [&](const std::string& clips) {
        write("wrong", curves(clips));
        const auto imported = read("wrong");
        return imported ? said(*imported) : imported.error().message();
    };
    EXPECT_THAT(
        errorOf("asset[] assetPaths = [@./gone.usda@]\ndouble2[] active = [(0, 0)]"),
        HasSubstr("the clip \"./gone.usda\" of the value clips \"default\" of /hair: there is no such file"));
    EXPECT_THAT(errorOf("asset[] assetPaths = [@../c0.usda@]\ndouble2[] active = [(0, 0)]"),
                HasSubstr("outside the folder"));
    EXPECT_THAT(errorOf("asset[] assetPaths = [@./c0.usda@]\ndouble2[] active = [(0, 5)]"),
                HasSubstr("/hair: clip 5 is active, of 1"));
    EXPECT_THAT(errorOf("asset[] assetPaths = [@./c0.usda@]"), HasSubstr("no clip is active"));
    EXPECT_THAT(errorOf("string templateAssetPath = \"x.##.usda\""), HasSubstr("names no files"));
    write("part",
          curves("asset[] assetPaths = [@./c0.usda@, @./gone.usda@]\ndouble2[] active = [(0, 0), (9, 1)]"));
    const auto imported = read("part");
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_THAT(said(*imported), HasSubstr("gone.usda")) << "the reason is a warning where there is hair";
}

}  // namespace
}  // namespace hairloom
