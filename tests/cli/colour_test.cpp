// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of a studio from the command line; tests/colour holds them against the library.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "core/colour/colour_choice.h"
#include "core/render/exr.h"
#include "core/render/png.h"
#include "tests/cli/command.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string studio() {
    return (sourceDir() / "tests/colour/studio/config.ocio").string();
}

class ColourOfImages : public CommandLineTest {
  protected:
    void SetUp() override {
        if (!colour::hasOpenColorIO()) GTEST_SKIP() << "built without OpenColorIO";
        CommandLineTest::SetUp();
        runJson("create --mesh '" + bustFile() +
                "' --scalp material:scalp --count 60 --length 0.2 --points 6 -o hair.hairloom");
    }
    nlohmann::json picture(const std::string& name, const std::string& more) const {
        return runJson("render hair.hairloom --engine software --size 48x48 --passes 1 -o " + name +
                       ".png --exr " + name + ".exr " + more);
    }
    std::string file(const std::string& name) const { return readText(folder / name); }
};

TEST_F(ColourOfImages, AreThoseOfTheViewAndFilesThoseOfTheScene) {
    EXPECT_EQ(picture("plain", "")["engine"], "software");
    const auto film = picture("film", "--color-config '" + studio() + "'")["color"];
    EXPECT_EQ(film["view"], "Film");
    EXPECT_EQ(film["scene_linear"], "ACEScg");
    EXPECT_EQ(film["interop_id"], "lin_ap1_scene");
    EXPECT_EQ(film["chromaticities"][0], 0.713);
    picture("raw", "--color-config '" + studio() + "' --display sRGB --view-transform Raw");
    EXPECT_NE(file("plain.png"), file("film.png"));
    EXPECT_NE(file("raw.png"), file("film.png"));
    // The scene is the same, whatever it is looked at through.
    EXPECT_EQ(file("raw.exr"), file("film.exr"));
    EXPECT_NE(file("plain.exr"), file("film.exr"));
    EXPECT_THAT(file("film.exr"), HasSubstr("lin_ap1_scene"));
    EXPECT_THAT(file("plain.exr"), HasSubstr("lin_rec709_scene"));
    EXPECT_THAT(file("plain.exr"), HasSubstr("chromaticities"));
    const auto rec709 = render::readExr(folder / "plain.exr");
    const auto acesCg = render::readExr(folder / "film.exr");
    const auto raw = render::readPng(folder / "raw.png");
    ASSERT_TRUE(rec709 && acesCg && raw);
    const auto config = colour::ColourConfig::read(studio());
    ASSERT_TRUE(config);
    std::vector<float> expected = rec709->rgba;
    render::convert(expected, *config->working().fromRec709);
    EXPECT_EQ(expected, acesCg->rgba);
}

TEST_F(ColourOfImages, SequencesAndLayersFollow) {
    const std::string view = "--color-config '" + studio() + "' --view-transform Film ";
    picture("turn", view + "--turntable 3 --strip strip.png --aov albedo,depth");
    picture("plain", "--turntable 3 --strip plain-strip.png --aov albedo,depth");
    EXPECT_NE(file("strip.png"), file("plain-strip.png"));
    EXPECT_NE(file("turn_0002.png"), file("plain_0002.png"));
    EXPECT_NE(file("turn_0002.exr"), file("plain_0002.exr"));
}

TEST_F(ColourOfImages, TheEnvironmentNamesAConfigAndNoneRefusesIt) {
    picture("plain", "");
    setenv("OCIO", studio().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    picture("film", "");
    const auto none = picture("none", "--color-config none");
    setenv("OCIO", "/nowhere/config.ocio", 1);  // NOLINT(concurrency-mt-unsafe)
    const auto lost = run("render hair.hairloom -o lost.png --json");
    unsetenv("OCIO");  // NOLINT(concurrency-mt-unsafe)
    EXPECT_NE(file("plain.png"), file("film.png"));
    EXPECT_EQ(file("plain.png"), file("none.png"));
    EXPECT_EQ(file("plain.exr"), file("none.exr"));
    EXPECT_FALSE(none.contains("color"));
    EXPECT_EQ(lost.exitCode, 1);
    EXPECT_THAT(lost.json()["error"]["what"].get<std::string>(), HasSubstr("$OCIO"));
    EXPECT_EQ(lost.json()["error"]["file"], "/nowhere/config.ocio");
    EXPECT_FALSE(std::filesystem::exists(folder / "lost.png"));
}

TEST_F(ColourOfImages, WhatIsNotThereIsNamedWithWhatIs) {
    const std::string config = "render hair.hairloom -o no.png --color-config '" + studio() + "' ";
    for (const auto& [words, expected] : std::vector<std::pair<std::string, std::string>>{
             {"--display P3", "expected one of sRGB, Rec. 1886"},
             {"--display 'Rec. 1886' --view-transform Film", "expected one of Un-tone-mapped"},
             {"--view-transform Lost", "lost.cube"}}) {
        const auto wrong = run(config + words);
        EXPECT_EQ(wrong.exitCode, 1) << words;
        EXPECT_THAT(wrong.errors, HasSubstr(expected));
        EXPECT_FALSE(std::filesystem::exists(folder / "no.png"));
    }
    EXPECT_THAT(run("render hair.hairloom -o no.png --view-transform Film").errors,
                HasSubstr("without a config"));
}

TEST_F(ColourOfImages, APageHasTheViewAndOtherFormatsHaveNone) {
    // The player itself is of ./dev web.
    std::filesystem::create_directory(folder / "player");
    for (const char* name : {"index.html", "player.js"}) std::ofstream(folder / "player" / name) << name;
    setenv("HAIRLOOM_WEB", (folder / "player").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    const std::string page = "export hair.hairloom --format web -o ",
                      config = " --color-config '" + studio() + "'";
    const auto plain = runJson(page + "plain"), film = runJson(page + "film" + config);
    const auto lost = run(page + "lost --view-transform Lost" + config);
    unsetenv("HAIRLOOM_WEB");  // NOLINT(concurrency-mt-unsafe)
    EXPECT_FALSE(plain.contains("color"));
    EXPECT_EQ(film["color"]["view"], "Film");
    EXPECT_EQ(file("plain/hair.js").find("\"view\""), std::string::npos);
    EXPECT_NE(file("film/hair.js").find("\"view\""), std::string::npos);
    EXPECT_EQ(lost.exitCode, 1);
    EXPECT_THAT(lost.errors, HasSubstr("lost.cube"));
    EXPECT_FALSE(std::filesystem::exists(folder / "lost"));
    const auto strands = run("export hair.hairloom --format tfx -o hair.tfx" + config);
    EXPECT_EQ(strands.exitCode, 2);
    EXPECT_THAT(strands.errors, HasSubstr("--format web"));
}

}  // namespace
}  // namespace hairloom::test
