// SPDX-License-Identifier: GPL-3.0-or-later
// What publishing asks of outputs: versions in their names, manifests, and frames around a range.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

#include "core/base/file_hash.h"
#include "core/render/png.h"
#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CliPublishing : public CommandLineTest {
  protected:
    std::string hashOf(const std::string& file) const {
        return fmt::format("{:016x}", hashFile(folder / file).value());
    }
    nlohmann::json jsonOf(const std::string& file) const {
        return nlohmann::json::parse(readText(folder / file));
    }
    bool exists(const std::string& file) const { return fs::exists(folder / file); }
    /// How many files are in the folder.
    long files() const { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); }
};

TEST_F(CliPublishing, VersionsAreTheNextThatAreFree) {
    runJson(createArguments());
    const std::string set = "set hair.hairloom simulation.substeps=5 -o ";
    EXPECT_EQ(runJson(set + "hair_v###.hairloom")["versioned"], nlohmann::json({"hair_v001.hairloom"}));
    EXPECT_EQ(runJson(set + "hair_v###.hairloom --force")["versioned"],
              nlohmann::json({"hair_v002.hairloom"}));
    EXPECT_TRUE(exists("hair_v001.hairloom") && exists("hair_v002.hairloom"));
    // Whatever is behind the version, and however many digits it has.
    std::ofstream(folder / "hair_v41 notes.txt") << "kept";
    std::ofstream(folder / "hairy_v99.hairloom") << "another name";
    std::ofstream(folder / "hair_v99999999999999999999.hairloom") << "no version";
    runJson(set + "hair_v#.hairloom");
    EXPECT_TRUE(exists("hair_v42.hairloom"));
    // In folders, and again in the names within.
    runJson(set + "shot/v##/hair_v##.hairloom");
    runJson(set + "shot/v##/hair_v##.hairloom");
    EXPECT_TRUE(exists("shot/v01/hair_v01.hairloom") && exists("shot/v02/hair_v02.hairloom"));
    // What is no token, and names of inputs.
    runJson(set + "'curv###.hairloom'");
    EXPECT_TRUE(exists("curv###.hairloom"));
    runJson("set 'curv###.hairloom' simulation.substeps=6 -o v####.hairloom");
    EXPECT_TRUE(exists("v0001.hairloom"));
    // A job that fails takes none.
    EXPECT_EQ(run("set missing.hairloom simulation.substeps=5 -o gone/v##/hair.hairloom").exitCode, 1);
    EXPECT_FALSE(exists("gone"));
}

TEST_F(CliPublishing, OutputsOfOneJobShareTheirVersion) {
    runJson(createArguments());
    std::ofstream(folder / "b_v04.frames") << "taken";
    const auto report = runJson("simulate hair.hairloom --frames 2 -o a_v##.hairloom --record b_v##.frames");
    EXPECT_EQ(report["record"], "b_v05.frames");
    EXPECT_EQ(report["output"], "a_v05.hairloom");
    EXPECT_EQ(report["versioned"], nlohmann::json({"a_v05.hairloom", "b_v05.frames"}));
    EXPECT_EQ(readText(folder / "b_v04.frames"), "taken");
    // The record is an input of other jobs.
    EXPECT_EQ(run("export hair.hairloom --record b_v##.frames --frames 0,0 --format ply -o x.ply").exitCode,
              1);
    runJson("export hair.hairloom --record b_v05.frames --frames 0,0 --format ply -o x_v#.ply");
    EXPECT_TRUE(exists("x_v1.ply") && exists("x_v1.ply.report.json"));
}

TEST_F(CliPublishing, AManifestListsWhatWasWrittenFromWhat) {
    runJson(createArguments());
    runJson("simulate hair.hairloom --frames 2 --record hair.frames");
    const std::string arguments =
        "export hair.hairloom --format usda --record hair.frames --frames 0,1 -o out_v##.usda --manifest";
    const auto report = runJson(arguments);
    EXPECT_EQ(report["manifest"], "out_v01.usda.manifest.json");
    const auto manifest = jsonOf("out_v01.usda.manifest.json");
    EXPECT_THAT(manifest["program"], testing::StartsWith("hairloom-cli "));
    EXPECT_THAT(manifest["command"], HasSubstr(arguments));
    ASSERT_EQ(manifest["files"].size(), 2u) << manifest.dump(1);
    for (const auto& row : manifest["files"]) {
        const std::string name = row["name"];
        EXPECT_EQ(row["hash"], hashOf(name));
        EXPECT_EQ(row["bytes"], fs::file_size(folder / name));
    }
    EXPECT_EQ(manifest["files"][0]["name"], "out_v01.usda");
    std::map<std::string, nlohmann::json> inputs;
    for (const auto& row : manifest["inputs"]) inputs[row["name"]] = row;
    ASSERT_TRUE(inputs.contains("hair.hairloom")) << manifest.dump(1);
    EXPECT_EQ(inputs["hair.hairloom"]["hash"], hashOf("hair.hairloom"));
    const auto& groom = inputs["hair.hairloom"]["groom"];
    EXPECT_EQ(groom["strands"], 300);
    EXPECT_TRUE(groom["simulation"]["substeps"].is_number());
    EXPECT_EQ(groom["content_hash"].get<std::string>().size(), 16u);
    EXPECT_TRUE(inputs.contains("hair.frames")) << manifest.dump(1);
    // Nothing in it depends on when.
    runJson("export hair.hairloom --format ply -o a.ply --manifest");
    const std::string first = readText(folder / "a.ply.manifest.json");
    runJson("export hair.hairloom --format ply -o a.ply --manifest");
    EXPECT_EQ(readText(folder / "a.ply.manifest.json"), first);
}

TEST_F(CliPublishing, AManifestOfAProjectThatIsSavedOverItselfKnowsTheOldOne) {
    runJson(createArguments());
    const std::string old = hashOf("hair.hairloom");
    runJson("set hair.hairloom simulation.substeps=5 -o hair.hairloom --manifest");
    const auto manifest = jsonOf("hair.hairloom.manifest.json");
    EXPECT_EQ(manifest["inputs"][0]["hash"], old);
    EXPECT_NE(manifest["inputs"][0]["groom"]["simulation"]["substeps"], 5);
    EXPECT_EQ(manifest["files"][0]["hash"], hashOf("hair.hairloom"));
    EXPECT_NE(hashOf("hair.hairloom"), old);
}

TEST_F(CliPublishing, FoldersHaveTheirManifestInside) {
    runJson("reference --man pages --manifest");
    const auto manifest = jsonOf("pages/manifest.json");
    ASSERT_EQ(manifest["files"].size(), 2u);
    EXPECT_EQ(manifest["files"][0]["name"], "hairloom.1");
    EXPECT_EQ(manifest["files"][0]["hash"], hashOf("pages/hairloom.1"));
}

TEST_F(CliPublishing, ManifestsThatCannotBeAreRefusedBeforeTheWork) {
    runJson(createArguments());
    for (const char* wrong :
         {"info hair.hairloom --manifest", "validate hair.hairloom --manifest", "set --list --manifest",
          "set hair.hairloom simulation.substeps=5 -o - --manifest"}) {
        const auto outcome = run(wrong);
        EXPECT_EQ(outcome.exitCode, 2) << wrong << outcome.errors;
        EXPECT_THAT(outcome.errors, HasSubstr("manifest")) << wrong;
    }
    const long before = files();
    EXPECT_EQ(run("set hair.hairloom simulation.substeps=99999 -o x.hairloom --manifest").exitCode, 2);
    fs::create_directories(folder / "y.hairloom.manifest.json");
    EXPECT_EQ(run("set hair.hairloom simulation.substeps=5 -o y.hairloom --manifest").exitCode, 1);
    EXPECT_EQ(files(), before + 1) << "nothing but the folder in its way";
}

TEST_F(CliPublishing, HandlesAreSimulatedAroundTheFramesAtTheirTimes) {
    runJson(createArguments());
    std::ofstream(folder / "turn.json")
        << R"({"keys": [{"t": 0}, {"t": 0.5, "axis": [0, 1, 0], "degrees": 90}]})";
    const auto report =
        runJson("simulate hair.hairloom --motion turn.json --frames 4 --handles 2 --record with.frames");
    EXPECT_EQ(report["frames"], 4);
    EXPECT_EQ(report["handles"], 2);
    // Before its first key the motion stands still, as in a pre-roll.
    runJson("simulate hair.hairloom --motion turn.json --frames 6 --pre-roll 2 --record without.frames");
    const auto frame = [&](const std::string& record, int number) {
        runJson(fmt::format("export hair.hairloom --record {} --frames {},{} --format ply -o f.ply --force",
                            record, number, number));
        return readText(folder / "f.ply");
    };
    for (int number = 0; number < 6; ++number)
        EXPECT_EQ(frame("with.frames", number + 2), frame("without.frames", number)) << number;
    EXPECT_EQ(run("export hair.hairloom --record with.frames --frames 8,8 --format ply -o f.ply").exitCode,
              1);
    EXPECT_EQ(run("simulate hair.hairloom --frames 4 --handles 2").exitCode, 2);
    EXPECT_EQ(
        run("simulate hair.hairloom --frames 4 --handles 2 --record r.frames -o last.hairloom").exitCode, 2);
}

TEST_F(CliPublishing, HandlesAreExportedAroundTheFramesWithTheirNumbers) {
    runJson(createArguments());
    runJson("simulate hair.hairloom --frames 4 --handles 2 --fps 60 --record hair.frames");
    const std::string arguments =
        "export hair.hairloom --record hair.frames --format usda -o hair.usda --force ";
    EXPECT_EQ(runJson(arguments + "--frames 2,5 --handles 2 --start 1001")["frames"], 8);
    const std::string text = readText(folder / "hair.usda");
    EXPECT_THAT(text, HasSubstr("startTimeCode = 999\n"));
    EXPECT_THAT(text, HasSubstr("endTimeCode = 1006\n"));
    runJson(arguments + "--frames 2,5 --handles 2 --start 1001 --fps 30");
    EXPECT_THAT(readText(folder / "hair.usda"), HasSubstr("startTimeCode = 1000\n"));
    EXPECT_EQ(runJson(arguments + "--frames 3,3 --handles 1")["frames"], 3);
    EXPECT_THAT(readText(folder / "hair.usda"), HasSubstr("startTimeCode = 2\n"));

    EXPECT_THAT(run(arguments + "--frames 1,3 --handles 2").errors, HasSubstr("begins before the record"));
    EXPECT_THAT(run(arguments + "--frames 2,5 --handles 1 --fps 30").errors,
                HasSubstr("between frames of the file"));
    EXPECT_EQ(run(arguments + "--frames 2,6 --handles 2").exitCode, 1) << "the record ends before";
    EXPECT_EQ(run(arguments + "--frames 2,18446744073709551615 --handles 2").exitCode, 2) << "no such number";
    EXPECT_EQ(run("export hair.hairloom --handles 2 --format usda -o hair.usda").exitCode, 2);
}

TEST_F(CliPublishing, HandlesAreRenderedWithTheirNumbers) {
    runJson(createArguments());
    runJson("simulate hair.hairloom --frames 4 --handles 1 --record hair.frames");
    const std::string arguments =
        "render hair.hairloom --record hair.frames --engine software --size 32x32 --passes 1 -o p/i.png ";
    fs::create_directories(folder / "p");
    EXPECT_EQ(runJson(arguments + "--frames 1,4,3 --start 1001")["pictures"], 2);
    EXPECT_TRUE(exists("p/i_1001.png") && exists("p/i_1002.png"));
    EXPECT_EQ(runJson(arguments + "--frames 1,4 --handles 1")["pictures"], 6);
    EXPECT_TRUE(exists("p/i_0000.png") && exists("p/i_0005.png"));
    EXPECT_EQ(runJson(arguments + "--frames 1,4 --handles 1 --start 1001")["pictures"], 6);
    EXPECT_TRUE(exists("p/i_1000.png") && exists("p/i_1005.png"));
    EXPECT_EQ(readText(folder / "p/i_1000.png"), readText(folder / "p/i_0000.png"));
    for (const char* frames :
         {"18446744073709551610,18446744073709551612 --handles 5", "0,0,9223372036854775808 --handles 2",
          "18446744073709551615,18446744073709551615"})
        EXPECT_EQ(run(arguments + "--frames " + frames).exitCode, 2) << frames;
    for (const char* wrong : {"--frames 1,4 --handles 2", "--frames 1,4 --handles 1 --start 0", "--handles 1",
                              "--turntable 4 --handles 1", "--turntable 4 --start 9"})
        EXPECT_EQ(run(arguments + wrong).exitCode, 2) << wrong;
}

TEST_F(CliPublishing, ReviewsHaveTextInTheirImagesAndASheet) {
    runJson(createArguments());
    runJson("simulate hair.hairloom --frames 3 --motion nod --record hair.frames");
    runJson("simulate hair.hairloom --frames 3 --motion none --record still.frames");
    const std::string arguments =
        "render hair.hairloom --record hair.frames --engine software --size 200x120 --passes 1 --frames 0,2 ";
    const auto plain = runJson(arguments + "-o plain.png --exr plain.exr");
    const auto report =
        runJson(arguments + "-o burnt.png --exr burnt.exr --strip sheet.png --columns 2 --against " +
                "still.frames --burn-in 'frame,take,settings,error,for review'");
    ASSERT_EQ(report["errors"].size(), 3u);
    EXPECT_EQ(report["errors"][2]["frame"], 2);
    EXPECT_GT(report["errors"][2]["error_mm_max"].get<double>(),
              report["errors"][2]["error_mm"].get<double>());
    EXPECT_FALSE(plain.contains("errors"));
    EXPECT_NE(readText(folder / "plain_0001.png"), readText(folder / "burnt_0001.png"));
    EXPECT_EQ(readText(folder / "plain_0001.exr"), readText(folder / "burnt_0001.exr"))
        << "only what is looked at";
    const auto plainImage = render::readPng(folder / "plain_0001.png");
    const auto burnt = render::readPng(folder / "burnt_0001.png"),
               sheet = render::readPng(folder / "sheet.png");
    ASSERT_TRUE(plainImage && burnt && sheet);
    EXPECT_EQ(sheet->width, 400u);
    EXPECT_EQ(sheet->height, 240u);
    for (std::size_t y = 0; y < 120; ++y) {
        // Text is in the lower left corner: five lines.
        const auto at = [&](const render::LinearImage& image, std::size_t x) {
            return image.rgba[4 * (y * image.width + x)];
        };
        EXPECT_EQ(at(*burnt, 199), at(*plainImage, 199));
        if (y < 120 - 59) {
            EXPECT_EQ(at(*burnt, 0), at(*plainImage, 0)) << y;
        }
        // The second image is at the right of the first row.
        for (const std::size_t x : {0u, 7u, 100u}) EXPECT_EQ(at(*sheet, 200 + x), at(*burnt, x));
    }
    EXPECT_EQ(sheet->rgba[4 * (399 + 400 * 239) + 3], 0) << "the place of a fourth image";
    for (const char* wrong : {"--burn-in error", "--columns 2", "--burn-in 'frame,,take'"})
        EXPECT_EQ(run(arguments + "-o x.png " + wrong).exitCode, 2) << wrong;
    EXPECT_EQ(run(arguments + "-o x.png --burn-in error --against missing.frames").exitCode, 1);
    EXPECT_FALSE(exists("x_0000.png"));
}

}  // namespace
}  // namespace hairloom::test
