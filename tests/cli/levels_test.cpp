// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail by the command line, as docs/cli.md promises them.

#include <gmock/gmock.h>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class LodJob : public CommandLineTest {
  protected:
    void makeHair() {
        runJson("create --mesh '" + bustFile() +
                "' --scalp material:scalp --count 400 --placement dart --length 0.15 --points 10 --seed 3 -o "
                "hair.hairloom");
    }
};

TEST_F(LodJob, MakesAndMeasuresAChainThatIsTheSameForAnyThreads) {
    makeHair();
    const std::string arguments =
        "lod hair.hairloom --levels strands:0.5@64,cards:24@64,shell:300@32 --directions 2 -o ";
    const auto report = runJson(arguments + "one --threads 1");
    ASSERT_EQ(report["levels"].size(), 3u);
    for (const auto& level : report["levels"]) {
        for (const char* key : {"name", "kind", "hairs", "cards", "triangles", "bytes", "distance_m",
                                "coverage", "flip", "light", "silhouette_px", "ms_draw", "ms_move"})
            EXPECT_TRUE(level.contains(key)) << key;
        EXPECT_GT(level["triangles"], 0);
    }
    EXPECT_EQ(report["levels"][0]["kind"], "strands");
    EXPECT_EQ(report["levels"][0]["hairs"], 200);
    EXPECT_LE(report["levels"][1]["cards"], 24);
    for (const auto& name : report["files"])
        EXPECT_TRUE(fs::exists(folder / "one" / name.get<std::string>())) << name;
    runJson(arguments + "three --threads 3");
    for (const char* name : {"levels.glb", "cards-24.png", "cards-24_colour.png", "cards-24_colour.1.png"}) {
        EXPECT_EQ(readText(folder / "one" / name), readText(folder / "three" / name)) << name;
    }
}

TEST_F(LodJob, SaysWhatCannotBe) {
    makeHair();
    const auto spec = run("lod hair.hairloom -o out --levels braids:3");
    EXPECT_EQ(spec.exitCode, 1);
    EXPECT_THAT(spec.errors, HasSubstr("unknown kind"));
    const auto target = run("lod hair.hairloom -o out --levels cards:2@256 --directions 1 --target-px 0.01");
    EXPECT_EQ(target.exitCode, 1);
    EXPECT_THAT(target.errors, HasSubstr("more than the 0.01 asked for"));
    EXPECT_FALSE(fs::exists(folder / "out")) << "nothing is left of what failed";
    runJson(
        "create --mesh '" + bustFile() +
        "' --scalp material:scalp --count 1 --placement random --length 0.15 --points 10 -o one.hairloom");
    EXPECT_THAT(run("lod one.hairloom -o out").errors, HasSubstr("one strand; at least two"));
}

TEST_F(LodJob, CardsAreExportedAsGltf) {
    makeHair();
    const auto report =
        runJson("export hair.hairloom --format gltf --levels cards:12@64,shell:200@32 -o hair.glb");
    EXPECT_EQ(report["strands"], 400);
    EXPECT_EQ(report["levels"].size(), 2u);
    EXPECT_EQ(report["bytes"], fs::file_size(folder / "hair.glb"));
    EXPECT_TRUE(fs::exists(folder / "hair.glb.report.json"));
    const auto read = runJson("info hair.glb");
    EXPECT_GT(read["scalp"]["vertices"], 20) << "our own reader takes it for a mesh";
    EXPECT_TRUE(report["max_error_mm"].is_null()) << "no point of a strand is in the file";
    EXPECT_THAT(run("export hair.hairloom --format gltf --up z -o z.glb").errors, HasSubstr("metres, Y up"));
    EXPECT_FALSE(fs::exists(folder / "z.glb"));
    const auto few =
        runJson("export hair.hairloom --target cards --cards 8 --segments 1 --from-px 64 -o few.glb");
    EXPECT_EQ(few["format"], "gltf");
    ASSERT_EQ(few["levels"].size(), 4u);
    EXPECT_LE(few["levels"][0]["cards"], 8);
    EXPECT_LE(few["levels"][0]["triangles"], 8 * 4) << "one segment of at most two quads a card";
    EXPECT_NEAR(few["levels"][0]["distance_m"], 5.8, 0.01);
}

}  // namespace
}  // namespace hairloom::test
