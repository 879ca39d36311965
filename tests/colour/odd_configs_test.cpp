// SPDX-License-Identifier: GPL-3.0-or-later
// Configs as people write them: looks, views that displays share, spaces and views that are switched off,
// names of all kinds.
#include <OpenColorIO/OpenColorIO.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/colour/colour_choice.h"
#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::colour {
namespace {

namespace ocio = OCIO_NAMESPACE;
using testing::ElementsAre;
using testing::HasSubstr;

class OddConfig : public testing::Test {
  protected:
    /// `more` stands between roles and spaces.
    std::string write(const std::string& more, const std::string& spaces = "") {
        const std::string file = (folder_ / "config.ocio").string();
        std::ofstream(file)
            << "ocio_profile_version: 2\nsearch_path: luts\nroles: {default: lin_rec709, scene_linear: "
               "lin_rec709}\n"
            << more << "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
            << "  - !<ColorSpace>\n    name: half\n"
            << "    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, "
            << "0, 0, 0.5, 0, 0, 0, 0, 1]}\n"
            << spaces;
        return file;
    }
    /// What a view makes of 0.5; the message where there is none.
    static std::string shown(const std::string& file, const std::string& display = "",
                             const std::string& view = "") {
        const auto colours = chooseColours({file, display, view});
        if (!colours) return colours.error().message();
        std::vector<float> pixel{0.5f, 0.5f, 0.5f, 1};
        (*colours)->toDisplay->apply(pixel);
        const auto config = ocio::Config::CreateFromFile(file.c_str());
        std::array<float, 3> alone{0.5f, 0.5f, 0.5f};
        config
            ->getProcessor("scene_linear", (*colours)->display.c_str(), (*colours)->view.c_str(),
                           ocio::TRANSFORM_DIR_FORWARD)
            ->getDefaultCPUProcessor()
            ->applyRGB(alone.data());
        EXPECT_FLOAT_EQ(pixel[0], alone[0]) << "by the library alone";
        return std::to_string(pixel[0]);
    }

    const TemporaryFolder folder_;
};

constexpr const char* kLooks = R"(displays:
  screen:
    - !<View> {name: plain, colorspace: lin_rec709}
    - !<View> {name: dark, colorspace: lin_rec709, looks: dim}
    - !<View> {name: twice, colorspace: lin_rec709, looks: "dim, +dim"}
    - !<View> {name: back, colorspace: lin_rec709, looks: "dim, -dim"}
    - !<View> {name: gone, colorspace: lin_rec709, looks: nowhere}
    - !<View> {name: either, colorspace: lin_rec709, looks: "filed | dim"}
    - !<View> {name: unfiled, colorspace: lin_rec709, looks: filed}
looks:
  - !<Look>
    name: dim
    process_space: lin_rec709
    transform: !<MatrixTransform> {matrix: [0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 1]}
  - !<Look> {name: filed, process_space: lin_rec709, transform: !<FileTransform> {src: lost.cube}}
)";

TEST_F(OddConfig, LooksOfAViewAreFollowedAndMissingOnesAreNamed) {
    const std::string file = write(kLooks);
    EXPECT_EQ(shown(file, "", "plain"), "0.500000");
    EXPECT_EQ(shown(file, "", "dark"), "0.125000");
    EXPECT_EQ(shown(file, "", "twice"), "0.031250");
    EXPECT_EQ(shown(file, "", "back"), "0.500000");
    EXPECT_THAT(shown(file, "", "gone"), HasSubstr("nowhere"));
    EXPECT_EQ(shown(file, "", "either"), "0.125000");
    EXPECT_THAT(shown(file, "", "unfiled"), HasSubstr("lost.cube"));
}

TEST_F(OddConfig, SpacesThatAreSwitchedOffStillServeTheirViews) {
    const std::string file = write(
        "inactive_colorspaces: [half, lin_rec709]\ndisplays:\n  screen:\n"
        "    - !<View> {name: off, colorspace: half}\n");
    EXPECT_EQ(shown(file), "0.250000");
}

TEST_F(OddConfig, DisplaysAndViewsThatAreSwitchedOffAreNotThere) {
    const std::string file = write(
        "active_displays: [second, first]\nactive_views: [b]\ndisplays:\n"
        "  first:\n    - !<View> {name: a, colorspace: half}\n"
        "    - !<View> {name: b, colorspace: lin_rec709}\n"
        "  second:\n    - !<View> {name: b, colorspace: half}\n"
        "  third:\n    - !<View> {name: b, colorspace: half}\n");
    const auto config = ColourConfig::read(file);
    ASSERT_TRUE(config) << config.error().message();
    std::vector<std::string> names;
    for (const Display& display : config->displays()) {
        names.push_back(display.name);
        EXPECT_THAT(display.views, ElementsAre("b"));
    }
    EXPECT_THAT(names, ElementsAre("second", "first"));
    EXPECT_EQ(shown(file), "0.250000");
    EXPECT_THAT(shown(file, "first", "a"), HasSubstr("no view 'a'; expected one of b"));
    EXPECT_THAT(shown(file, "third"), HasSubstr("no display 'third'; expected one of second, first"));
}

TEST_F(OddConfig, ViewsThatDisplaysShareAreTheirs) {
    const std::string file = write(
        "shared_views:\n  - !<View> {name: common, colorspace: half}\ndisplays:\n"
        "  own:\n    - !<View> {name: mine, colorspace: lin_rec709}\n"
        "    - !<Views> [common]\n  borrowed:\n    - !<Views> [common]\n");
    EXPECT_EQ(shown(file, "own", "common"), "0.250000");
    EXPECT_EQ(shown(file, "borrowed"), "0.250000");
    EXPECT_THAT(shown(file, "borrowed", "mine"), HasSubstr("expected one of common"));
}

TEST_F(OddConfig, NamesMayBeOfAnyScript) {
    const std::string display = "Büro 🎬 監視", view = "Ansicht „ß“ <b>";
    const std::string file = write("displays:\n  \"" + display + "\":\n    - !<View> {name: \"" + view +
                                   "\", colorspace: half}\n");
    EXPECT_EQ(shown(file, display, view), "0.250000");
    EXPECT_THAT(shown(file, display, "ansicht"), HasSubstr(view));
}

TEST_F(OddConfig, ALutThatComesLaterIsReadThen) {
    const std::string file = write("displays:\n  screen:\n    - !<View> {name: filed, colorspace: filed}\n",
                                   "  - !<ColorSpace>\n    name: filed\n"
                                   "    from_scene_reference: !<FileTransform> {src: film.spi1d}\n");
    EXPECT_THAT(shown(file), HasSubstr("film.spi1d"));
    std::filesystem::create_directory(folder_ / "luts");
    const auto writeLut = [&](const char* end) {
        std::ofstream(folder_ / "luts/film.spi1d") << "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n"
                                                   << end << "\n}\n";
    };
    writeLut("0.5");
    EXPECT_EQ(shown(file), "0.250000");
    writeLut("0.25");
    EXPECT_EQ(shown(file), "0.125000") << "it has changed";
    writeLut("what");
    EXPECT_THAT(shown(file), HasSubstr("film.spi1d"));
}

TEST_F(OddConfig, AnEnvironmentThatNamesAFolderOrNothingSaysSo) {
    setenv("OCIO", folder_.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    const auto folder = chooseColours({});
    setenv("OCIO", "", 1);  // NOLINT(concurrency-mt-unsafe)
    const auto empty = chooseColours({});
    unsetenv("OCIO");  // NOLINT(concurrency-mt-unsafe)
    ASSERT_FALSE(folder);
    EXPECT_THAT(folder.error().message(), HasSubstr("$OCIO names this file"));
    EXPECT_TRUE(empty && !*empty);
}

}  // namespace
}  // namespace hairloom::colour
