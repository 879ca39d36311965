// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/web_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "core/render/display_table.h"
#include "core/render/tone_map.h"
#include "tests/documents/small_head.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

void setVariable(const char* name, const std::string& value) {
#ifdef _WIN32
    _putenv_s(name, value.c_str());  // empty: removes it
#else
    value.empty() ? unsetenv(name) : setenv(name, value.c_str(), 1);
#endif
}

/// The page itself runs in `./dev web`, in a browser; here its player is two words.
class WebPage : public testing::Test {
  protected:
    WebPage() {
        fs::create_directories(folder_ / "player");
        EXPECT_TRUE(writeFileAtomically(folder_ / "player/index.html", std::string_view("<p>index")));
        EXPECT_TRUE(writeFileAtomically(folder_ / "player/player.js", std::string_view("player")));
        setVariable("HAIRLOOM_WEB", (folder_ / "player").string());
    }
    ~WebPage() override { setVariable("HAIRLOOM_WEB", ""); }
    WebPage(const WebPage&) = delete;
    WebPage& operator=(const WebPage&) = delete;

    const TemporaryFolder folder_;
};

std::string decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0, count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6u | static_cast<std::uint32_t>(digits.find(c));
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>(bits >> count & 255u);
        }
    }
    return bytes;
}

nlohmann::json sceneOf(const fs::path& page) {
    const auto script = readTextFile(page / "hair.js");
    if (!script) return {};
    const std::size_t begin = script->find('{');
    return nlohmann::json::parse(script->substr(begin, script->rfind('}') + 1 - begin));
}

TEST_F(WebPage, HasPlayerAssetAndHead) {
    const Groom groom = smallHead();
    const fs::path page = folder_ / "Zöpfe <b>";
    const auto report = exportWebPage(groom, {}, page);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->format, "web");
    EXPECT_EQ(report->strands, groom.strandCount());
    EXPECT_EQ(readTextFile(page / "player.js"), "player");
    EXPECT_EQ(readTextFile(page / "index.html"), "<p>index");
    const nlohmann::json scene = sceneOf(page);
    EXPECT_EQ(scene["title"], "Zöpfe <b>");
    EXPECT_EQ(decoded(scene["asset"]), readTextFile(page / "hair.hairrt")) << "as it is beside the page";
    EXPECT_EQ(decoded(scene["head"]["positions"]).size(), groom.scalp->vertexCount() * 12);
    EXPECT_EQ(decoded(scene["head"]["normals"]).size(), groom.scalp->vertexCount() * 6);
    const std::string triangles = decoded(scene["head"]["triangles"]);
    ASSERT_EQ(triangles.size(), groom.scalp->triangleCount() * 12);
    EXPECT_EQ(std::memcmp(triangles.data(), groom.scalp->triangles().data(), triangles.size()), 0);
    EXPECT_NEAR(scene["wind"][0], groom.simulation.windSpeed, 1e-5);
    std::uint64_t bytes = 0;
    for (const auto& file : fs::directory_iterator(page)) bytes += file.file_size();
    EXPECT_EQ(report->bytes, bytes);
    EXPECT_TRUE(exportWebPage(groom, {}, page)) << "over itself";
}

/// A shoulder on each channel, then sRGB.
class Shoulder final : public render::ColourTransform {
  public:
    void apply(std::span<float> rgba) const override {
        for (std::size_t i = 0; i < rgba.size(); ++i) {
            if (i % 4 != 3) rgba[i] = render::encodeSrgb(rgba[i] / (rgba[i] + 0.4f));
        }
    }
};

/// What no table can follow.
class Stripes final : public render::ColourTransform {
  public:
    void apply(std::span<float> rgba) const override {
        for (std::size_t i = 0; i < rgba.size(); ++i) {
            if (i % 4 != 3) rgba[i] = std::fmod(37 * rgba[i], 1.0f) < 0.5f ? 0.0f : 1.0f;
        }
    }
};

TEST_F(WebPage, HasAViewAsTheTableThatItLooksUp) {
    const Groom groom = smallHead();
    ASSERT_TRUE(exportWebPage(groom, {}, folder_ / "page"));
    EXPECT_FALSE(sceneOf(folder_ / "page").contains("view"));
    const Shoulder shoulder;
    const auto report = exportWebPage(groom, {}, folder_ / "page", &shoulder);
    ASSERT_TRUE(report) << report.error().message();
    const nlohmann::json view = sceneOf(folder_ / "page")["view"];
    render::DisplayTable table;
    table.side = view["side"];
    table.toe = view["toe"];
    table.top = view["top"];
    const std::string bytes = decoded(view["codes"]);
    ASSERT_EQ(bytes.size(), std::size_t{6} * table.side * table.side * table.side);
    for (std::size_t at = 0; at < bytes.size(); at += 6) {
        std::array<float, 4> code{};
        for (std::size_t c = 0; c < 3; ++c) {
            Eigen::half half;
            std::memcpy(&half, bytes.data() + at + 2 * c, 2);
            code[c] = static_cast<float>(half);
        }
        table.codes.push_back(code);
    }
    int worst = 0;
    for (float light = 0; light < 40; light = 1.05f * light + 0.001f) {
        for (const Vec3f& colour : {Vec3f(1, 1, 1), Vec3f(0.7f, 0.45f, 0.2f), Vec3f(0, 0.3f, 1)}) {
            std::vector<float> exact{light * colour.x(), light * colour.y(), light * colour.z(), 1};
            shoulder.apply(exact);
            const Vec3f shown = table.lookUp(light * colour);
            for (std::size_t c = 0; c < 3; ++c) {
                const int code = render::toByte(shown[static_cast<int>(c)]);
                worst = std::max(worst, std::abs(code - int{render::toByte(exact[c])}));
            }
        }
    }
    EXPECT_LE(worst, 1);
}

TEST_F(WebPage, SaysWhereATableCannotFollowAView) {
    const auto gentle = exportWebPage(smallHead(), {}, folder_ / "page", std::make_unique<Shoulder>().get());
    const auto bent = exportWebPage(smallHead(), {}, folder_ / "page", std::make_unique<Stripes>().get());
    ASSERT_TRUE(gentle && bent);
    EXPECT_EQ(bent->findings.size(), gentle->findings.size() + 1);
    EXPECT_THAT(bent->findings.back().what, testing::HasSubstr("of 255"));
    EXPECT_EQ(sceneOf(folder_ / "page")["view"]["side"], 129);
}

TEST_F(WebPage, WithoutPlayerOrHairNamesWhatHelpsAndLeavesNothing) {
    fs::remove(folder_ / "player/player.js");
    const auto without = exportWebPage(smallHead(), {}, folder_ / "page");
    ASSERT_FALSE(without);
    EXPECT_THAT(without.error().message(), testing::HasSubstr("./dev web"));
    EXPECT_TRUE(writeFileAtomically(folder_ / "player/player.js", std::string_view("player")));
    HairToExport wanted;
    wanted.layers = {"Fringe"};
    const auto noLayer = exportWebPage(smallHead(), wanted, folder_ / "page");
    ASSERT_FALSE(noLayer);
    EXPECT_THAT(noLayer.error().message(), testing::HasSubstr("Fringe"));
    EXPECT_FALSE(fs::exists(folder_ / "page"));
}

TEST_F(WebPage, PlayerIsFoundBesideInstalledPrograms) {
    setVariable("HAIRLOOM_WEB", "");
    EXPECT_TRUE(findWebPlayer(folder_ / "bin").empty());
    fs::create_directories(folder_ / "share/hairloom");
    fs::rename(folder_ / "player", folder_ / "share/hairloom/web");
    EXPECT_EQ(findWebPlayer(folder_ / "bin"), folder_ / "share/hairloom/web");
}

}  // namespace
}  // namespace hairloom
