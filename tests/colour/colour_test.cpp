// SPDX-License-Identifier: GPL-3.0-or-later
// Views and spaces of configs, held against OpenColorIO's own processors.
#include <OpenColorIO/OpenColorIO.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/base/parallel.h"
#include "core/colour/colour_choice.h"
#include "core/render/display_table.h"
#include "core/render/tone_map.h"
#include "core/shading/melanin.h"
#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::colour {
namespace {

namespace ocio = OCIO_NAMESPACE;
using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path studio() {
    return sourceDir() / "tests/colour/studio/config.ocio";
}

/// A folder of the test's own with a config of this text.
class Config : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) const {
        std::ofstream(folder_ / "config.ocio") << text;
        return folder_ / "config.ocio";
    }
    std::string refusal(const std::string& text) const {
        const auto read = ColourConfig::read(write(text));
        return read ? "" : read.error().message();
    }

    const TemporaryFolder folder_;
};

/// Light of all amounts, black and far above white, hair's browns among it, and alphas.
render::LinearImage light() {
    render::LinearImage image{512, 64, {}};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> stops(-14, 8), share(0, 1);
    for (std::uint32_t i = 0; i < image.width * image.height; ++i) {
        const float amount = i % 100 == 0 ? 0 : std::exp2(stops(random));
        const float brown = share(random);
        image.rgba.insert(image.rgba.end(), {amount, amount * (i % 3 == 0 ? brown : 1 - 0.6f * brown),
                                             amount * (i % 3 == 1 ? share(random) : 0.5f), share(random)});
    }
    return image;
}

/// The library alone: Rec. 709 by the config's own space of that name, one pixel at a time.
std::vector<float> byLibrary(const render::LinearImage& image, float exposure, const char* display,
                             const char* view) {
    const auto config = ocio::Config::CreateFromFile(studio().string().c_str());
    const auto toWorking = config->getProcessor("lin_rec709", "scene_linear")->getDefaultCPUProcessor();
    const auto toDisplay = config->getProcessor("scene_linear", display, view, ocio::TRANSFORM_DIR_FORWARD)
                               ->getDefaultCPUProcessor();
    std::vector<float> out = image.rgba;
    for (std::size_t i = 0; i < out.size(); i += 4) {
        for (std::size_t c = 0; c < 3; ++c) out[i + c] *= exposure;
        toWorking->applyRGB(&out[i]);
        toDisplay->applyRGB(&out[i]);
    }
    return out;
}

TEST(Colours, AreWithinACodeValueOfTheLibrarysOwnProcessor) {
    const render::LinearImage image = light();
    for (const auto& [display, view] :
         std::vector<std::pair<const char*, const char*>>{{"sRGB", "Film"},
                                                          {"sRGB", "Warm film"},
                                                          {"sRGB", "Un-tone-mapped"},
                                                          {"sRGB", "Raw"},
                                                          {"Rec. 1886", "Un-tone-mapped"}}) {
        const auto colours = chooseColours({studio().string(), display, view});
        ASSERT_TRUE(colours && *colours) << colours.error().message();
        const render::Image shown = render::showBy(*(*colours)->toDisplay, image, 1.5f);
        const std::vector<float> expected = byLibrary(image, 1.5f, display, view);
        int worst = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const int code = render::toByte(expected[i]);
            worst = std::max(worst, std::abs(code - int{shown.rgba[i]}));
        }
        EXPECT_LE(worst, 1) << view;
        EXPECT_NE(shown.rgba, render::toneMap(image, 1.5f).rgba) << view;
    }
}

/// What devices show, which cannot run the library.
TEST(Colours, TablesOfViewsAreWithinACodeValueOfThem) {
    for (const char* const view : {"Film", "Warm film", "Un-tone-mapped", "Raw"}) {
        const auto colours = chooseColours({studio().string(), "sRGB", view});
        ASSERT_TRUE(colours && *colours) << view;
        const render::DisplayTable table = render::bakeDisplayTable(*(*colours)->toDisplay);
        EXPECT_LE(table.worst, 1) << view << ", " << table.side << " a side, toe " << table.toe << ", top "
                                  << table.top;
        // Of other light than it was measured with.
        const render::LinearImage image = light();
        const render::Image exact = render::showBy(*(*colours)->toDisplay, image, 1);
        int worst = 0;
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
            const Vec3f shown = table.lookUp({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
            for (std::size_t c = 0; c < 3; ++c) {
                const int code = render::toByte(shown[static_cast<int>(c)]);
                worst = std::max(worst, std::abs(code - int{exact.rgba[i + c]}));
            }
        }
        EXPECT_LE(worst, 1) << view;
    }
}

TEST(Colours, HaveTheSameBitsOnAnyNumberOfThreads) {
    const auto colours = chooseColours({studio().string(), "sRGB", "Warm film"});
    ASSERT_TRUE(colours && *colours);
    std::vector<std::vector<float>> results;
    for (const std::size_t threads : {1u, 2u, 3u}) {
        setThreadCount(threads);
        results.push_back(light().rgba);
        render::convert(results.back(), *(*colours)->toDisplay);
    }
    setThreadCount(0);
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
    // A pixel's bits are its own: one at a time gives them, too.
    std::vector<float> alone = light().rgba;
    for (std::size_t i = 0; i < alone.size(); i += 4)
        (*colours)->toDisplay->apply(std::span(alone).subspan(i, 4));
    EXPECT_EQ(results[0], alone);
}

TEST(Colours, NotANumberIsShownAsBlack) {
    const auto colours = chooseColours({studio().string(), "sRGB", "Un-tone-mapped"});
    ASSERT_TRUE(colours && *colours);
    const float nan = std::nanf("");
    const render::Image shown = render::showBy(*(*colours)->toDisplay, {1, 1, {nan, nan, nan, 1}}, 1);
    EXPECT_EQ(shown.rgba[3], 255);
    EXPECT_LE(shown.rgba[0], 1);
}

TEST(ColourConfig, ListsDisplaysAndViewsTheDefaultFirst) {
    const auto config = ColourConfig::read(studio());
    ASSERT_TRUE(config) << config.error().message();
    ASSERT_EQ(config->displays().size(), 2u);
    EXPECT_EQ(config->displays()[0].name, "sRGB");
    EXPECT_THAT(config->displays()[0].views,
                ElementsAre("Film", "Warm film", "Un-tone-mapped", "Raw", "Lost"));
    const auto colours = chooseColours({studio().string(), {}, {}});
    ASSERT_TRUE(colours && *colours);
    EXPECT_EQ((*colours)->display, "sRGB");
    EXPECT_EQ((*colours)->view, "Film");
}

TEST(ColourConfig, KnowsAcesCgByItsMatrix) {
    const auto config = ColourConfig::read(studio());
    ASSERT_TRUE(config);
    EXPECT_EQ(config->working().name, "ACEScg");
    EXPECT_EQ(config->working().linear.interopId, "lin_ap1_scene");
    EXPECT_THAT(config->working().linear.chromaticities,
                ElementsAre(0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f));
    EXPECT_EQ(config->working().note, "");
}

/// ITU-R BT.709 to ACEScg after Bradford, as the Academy's transforms publish it.
TEST(ColourConfig, MelaninHasItsColourInAcesCg) {
    const double matrix[3][3] = {{0.6130974, 0.3395231, 0.0473795},
                                 {0.0701937, 0.9163540, 0.0134523},
                                 {0.0206156, 0.1095698, 0.8698146}};
    const auto config = ColourConfig::read(studio());
    ASSERT_TRUE(config);
    for (const shading::Melanin melanin :
         {shading::Melanin{0.05, 0}, shading::Melanin{0.3, 0.2}, shading::Melanin{1.3, 0},
          shading::Melanin{0.6, 1.5}, shading::Melanin{8, 0}}) {
        const Vec3d colour = shading::colourOfAbsorption(shading::absorption(melanin), 0.3);
        std::vector<float> pixel{static_cast<float>(colour.x()), static_cast<float>(colour.y()),
                                 static_cast<float>(colour.z()), 1};
        config->working().fromRec709->apply(pixel);
        for (std::size_t r = 0; r < 3; ++r) {
            const double expected =
                matrix[r][0] * colour.x() + matrix[r][1] * colour.y() + matrix[r][2] * colour.z();
            EXPECT_NEAR(pixel[r], expected, 2e-6 + 2e-5 * expected);
        }
    }
}

constexpr const char* kSmall = R"(ocio_profile_version: 1
search_path: luts
roles: {ROLES}
displays:
  sRGB:
    - !<View> {name: Raw, colorspace: light}
colorspaces:
  - !<ColorSpace>
    name: light
    bitdepth: 32f
SPACES
)";

std::string small(const std::string& roles, const std::string& spaces = "") {
    std::string text = kSmall;
    text.replace(text.find("ROLES"), 5, roles);
    return text.replace(text.find("SPACES"), 6, spaces);
}

TEST_F(Config, WithoutAnInterchangeIsTakenForRec709AndSaysSo) {
    const auto config = ColourConfig::read(write(small("scene_linear: light")));
    ASSERT_TRUE(config) << config.error().message();
    EXPECT_EQ(config->working().linear.interopId, "lin_rec709_scene");
    EXPECT_THAT(config->working().note, HasSubstr("aces_interchange"));
    std::vector<float> pixel{0.25f, 0.5f, 4, 0.5f};
    config->working().fromRec709->apply(pixel);
    EXPECT_THAT(pixel, ElementsAre(0.25f, 0.5f, 4, 0.5f));
}

/// As in the configs of ACES 1, which have no interchange.
TEST_F(Config, FindsLinearRec709ByItsName) {
    const auto config = ColourConfig::read(write(small("scene_linear: wide", R"(
  - !<ColorSpace>
    name: Utility - Linear - sRGB
    to_reference: !<MatrixTransform> {matrix: [0.4124564, 0.3575761, 0.1804375, 0, 0.2126729, 0.7151522, 0.072175, 0, 0.0193339, 0.119192, 0.9503041, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: wide
    to_reference: !<MatrixTransform> {matrix: [0.6369580, 0.1446169, 0.1688810, 0, 0.2627002, 0.6779981, 0.0593017, 0, 0, 0.0280727, 1.0609851, 0, 0, 0, 0, 1]})")));
    ASSERT_TRUE(config) << config.error().message();
    EXPECT_EQ(config->working().linear.interopId, "lin_rec2020_scene");
    EXPECT_EQ(config->working().note, "");
}

TEST_F(Config, OfUnknownPrimariesGetsTheirChromaticities) {
    // Twice the colour of Rec. 709's red, green and blue: the same chromaticities but for white's name.
    const auto config = ColourConfig::read(write(small("scene_linear: odd", R"(
  - !<ColorSpace>
    name: lin_rec709
  - !<ColorSpace>
    name: odd
    to_reference: !<MatrixTransform> {matrix: [0.8, 0.2, 0, 0, 0.1, 0.9, 0, 0, 0, 0.2, 0.8, 0, 0, 0, 0, 1]})")));
    ASSERT_TRUE(config) << config.error().message();
    const render::LinearSpace& odd = config->working().linear;
    EXPECT_EQ(odd.interopId, "");
    // Its white is that of Rec. 709, adapted to ACES'.
    EXPECT_NEAR(odd.chromaticities[6], 0.32168, 1e-4);
    EXPECT_NEAR(odd.chromaticities[7], 0.33767, 1e-4);
    for (std::size_t p = 0; p < 3; ++p) EXPECT_GT(odd.chromaticities[2 * p + 1], 0);
}

TEST_F(Config, ThatIsWrongSaysWhere) {
    EXPECT_THAT(refusal("roles: {a: [}\n"), HasSubstr("config.ocio:1: "));
    EXPECT_THAT(refusal(""), HasSubstr("config.ocio"));
    EXPECT_THAT(refusal("ocio_profile_version: 9\n"), HasSubstr("config.ocio"));
    EXPECT_THAT(refusal(small("default: light")), HasSubstr("scene_linear"));
    EXPECT_THAT(refusal(small("scene_linear: gone")), HasSubstr("scene_linear"));
    EXPECT_THAT(refusal(small("scene_linear: bent", R"(
  - !<ColorSpace>
    name: lin_rec709
  - !<ColorSpace>
    name: bent
    to_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]})")),
                HasSubstr("not linear"));
    EXPECT_THAT(ColourConfig::read(folder_.path()).error().message(), HasSubstr(folder_.path().string()));
    EXPECT_THAT(ColourConfig::read("ocio://default").error().message(), HasSubstr("no built-in configs"));
}

/// What the library follows until the program ends.
TEST_F(Config, ThatDefinesASpaceByItselfIsRefused) {
    const std::string spaces = R"(
  - !<ColorSpace>
    name: lin_rec709
  - !<ColorSpace>
    name: one
    to_reference: !<ColorSpaceTransform> {src: two, dst: lin_rec709}
  - !<ColorSpace>
    name: two
    to_reference: !<GroupTransform>
      children:
        - !<ColorSpaceTransform> {src: one, dst: lin_rec709}
  - !<ColorSpace>
    name: three
    from_reference: !<ColorSpaceTransform> {src: lin_rec709, dst: three}
)";
    EXPECT_THAT(refusal(small("scene_linear: one", spaces)), HasSubstr("defined by itself"));
    std::string text = small("scene_linear: light", spaces);
    text.replace(text.find("colorspace: light}"), 18, "colorspace: three}");
    const auto config = ColourConfig::read(write(text));
    ASSERT_TRUE(config) << config.error().message();
    const auto view = config->view("sRGB", "Raw");
    ASSERT_FALSE(view);
    EXPECT_THAT(view.error().message(), HasSubstr("'three' is defined by itself"));
}

#ifndef _WIN32
TEST_F(Config, ThatReadsADeviceIsRefused) {
    std::string text = small("scene_linear: light", R"(
  - !<ColorSpace>
    name: endless
    from_reference: !<FileTransform> {src: /dev/zero}
)");
    text.replace(text.find("colorspace: light}"), 18, "colorspace: endless}");
    const auto endless = ColourConfig::read(write(text));
    ASSERT_TRUE(endless) << endless.error().message();
    const auto view = endless->view("sRGB", "Raw");
    ASSERT_FALSE(view);
    EXPECT_THAT(view.error().message(), HasSubstr("/dev/zero"));
}
#endif

TEST(ColourConfig, NamesWhatThereIsWhereADisplayOrViewIsNot) {
    const auto message = [](const ColourChoice& choice) {
        const auto colours = chooseColours(choice);
        return colours ? "" : colours.error().message();
    };
    const std::string file = studio().string();
    EXPECT_THAT(message({file, "P3", ""}), HasSubstr("no display 'P3'; expected one of sRGB, Rec. 1886"));
    EXPECT_THAT(message({file, "Rec. 1886", "Film"}),
                HasSubstr("has no view 'Film'; expected one of Un-tone"));
    EXPECT_THAT(message({file, "sRGB", "Lost"}), HasSubstr("lost.cube"));
    EXPECT_THAT(message({kNoConfig, "sRGB", ""}), HasSubstr("without a config"));
    EXPECT_THAT(message({"/nowhere/config.ocio", "", ""}), HasSubstr("/nowhere/config.ocio"));
}

TEST(ColourConfig, IsWhatTheEnvironmentNames) {
    setenv("OCIO", "/nowhere/studio.ocio", 1);  // NOLINT(concurrency-mt-unsafe)
    const auto lost = chooseColours({});
    const auto none = chooseColours({kNoConfig, {}, {}});
    setenv("OCIO", studio().string().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    const auto found = chooseColours({{}, {}, "Raw"});
    unsetenv("OCIO");  // NOLINT(concurrency-mt-unsafe)
    ASSERT_FALSE(lost);
    EXPECT_THAT(lost.error().message(), HasSubstr("$OCIO names this file"));
    EXPECT_TRUE(none && !*none);
    ASSERT_TRUE(found && *found);
    EXPECT_EQ((*found)->view, "Raw");
    const auto unset = chooseColours({});
    EXPECT_TRUE(unset && !*unset);
}

}  // namespace
}  // namespace hairloom::colour
