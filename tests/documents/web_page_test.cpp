// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/web_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
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
