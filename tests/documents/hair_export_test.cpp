// SPDX-License-Identifier: GPL-3.0-or-later
// What leaves a project, beside what the writers' own tests hold them to.
#include "core/documents/hair_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/file.h"
#include "core/documents/hair_import.h"
#include "core/operations/stack.h"
#include "core/simulation/bake_body.h"
#include "core/stability/certificate.h"
#include "hairloom/asset.h"
#include "importers/authored_settings.h"
#include "tests/documents/small_head.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;

class HairExportTest : public testing::Test {
  protected:
    const TemporaryFolder folder_;
};

double valueOf(const runtime::Asset& asset, std::string_view name) {
    for (const runtime::asset::Setting& setting : asset.settings) {
        if (asset.nameOf(setting) == name) return asset.valuesOf(setting)[0];
    }
    return -1;
}

TEST_F(HairExportTest, TheCertificateGoesIntoAssetAndReport) {
    const Groom groom = smallHead();
    HairToExport wanted;
    wanted.storms = 24;
    double share = 0;
    wanted.progress = [&](std::string_view, double done) {
        EXPECT_GE(done, share);
        share = done;
    };
    const auto report = exportHair(groom, wanted, strandWriter("runtime"), folder_ / "a.hairrt", {});
    ASSERT_TRUE(report) << report.error().message();
    CertificateOptions storms;
    storms.storms = 24;
    const Certificate found = certify(groom, storms).value();
    ASSERT_TRUE(report->safeLimits);
    EXPECT_EQ(report->safeLimits->storms, 24u);
    EXPECT_EQ(report->safeLimits->failed, found.failed.size());
    ASSERT_GT(found.limits.rootSpeed, 0) << "else zeros would do";
    const auto bytes = readFile(folder_ / "a.hairrt").value();
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset) << opened.error.words;
    EXPECT_FLOAT_EQ(static_cast<float>(valueOf(*opened.asset, "certificate.largestStep")),
                    static_cast<float>(found.limits.step));
    EXPECT_FLOAT_EQ(static_cast<float>(valueOf(*opened.asset, "certificate.rootSpeed")),
                    static_cast<float>(found.limits.rootSpeed));
    EXPECT_FLOAT_EQ(static_cast<float>(valueOf(*opened.asset, "certificate.turn")),
                    static_cast<float>(found.limits.turn));
    EXPECT_FLOAT_EQ(static_cast<float>(valueOf(*opened.asset, "certificate.wind")),
                    static_cast<float>(found.limits.wind));
    EXPECT_EQ(valueOf(*opened.asset, "certificate.storms"), 24);
}

TEST_F(HairExportTest, WithoutStormsThereIsNoCertificate) {
    const auto report = exportHair(smallHead(), {}, strandWriter("runtime"), folder_ / "a.hairrt", {});
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_FALSE(report->safeLimits);
    const auto bytes = readFile(folder_ / "a.hairrt").value();
    EXPECT_EQ(valueOf(*runtime::Asset::open(bytes).asset, "certificate.wind"), -1);
}

/// Of a file of a shell alone, the quickest that holds what stands for hair.
TEST_F(HairExportTest, CardsSayThatTheyLoseTheSkin) {
    Groom groom = smallHead();
    groom.interpolation.followPerGuide = 1;
    HairToExport wanted;
    wanted.levels.levels = "shell";
    wanted.levels.chain.directions = 1;
    wanted.levels.chain.mostSide = 64;
    const HairWriter* gltf = nullptr;
    for (const HairWriter& writer : hairWriters())
        if (writer.name == "gltf") gltf = &writer;
    ASSERT_TRUE(gltf);
    const auto skinFindings = [&] {
        const auto report = exportHair(groom, wanted, *gltf, folder_ / "a.glb", {});
        EXPECT_TRUE(report) << report.error().message();
        std::vector<std::string> found;
        for (const Finding& finding : report->findings)
            if (finding.where == "body") found.push_back(finding.what);
        return found;
    };
    EXPECT_THAT(skinFindings(), testing::IsEmpty());
    groom.body = bakeBodyOf(groom, nullptr).value().field;
    EXPECT_THAT(skinFindings(),
                testing::ElementsAre("the skin collider is left out: hair meets 1 spheres there"));
}

TEST_F(HairExportTest, StormsAreCancelledAndNothingIsWritten) {
    const std::atomic<bool> stop = true;
    HairToExport wanted;
    wanted.storms = 1000;
    wanted.cancel = &stop;
    EXPECT_FALSE(exportHair(smallHead(), wanted, strandWriter("runtime"), folder_ / "a.hairrt", {}));
    EXPECT_FALSE(fs::exists(folder_ / "a.hairrt"));
}

/// Hair that sinks, for as many frames.
HairToExport sinking(const Groom& groom, std::uint32_t frames) {
    HairToExport wanted;
    for (std::uint32_t f = 0; f < frames; ++f) {
        RecordedFrame frame;
        frame.framesPerSecond = 24;
        for (const Vec3f& point : groom.positions())
            frame.positions_ws.push_back(point - Vec3f(0, 0.001f * static_cast<float>(f), 0));
        wanted.frames.push_back(std::move(frame));
    }
    return wanted;
}

TEST_F(HairExportTest, MotionIsCancelledWhereverItIsAndNothingIsWritten) {
    const Groom groom = smallHead();
    for (const std::string format : {"usda", "usdc", "abc", "abc-unreal"}) {
        const fs::path path = folder_ / ("a." + format.substr(0, format.find('-')));
        HairToExport wanted = sinking(groom, 12);
        std::vector<double> shares;
        wanted.progress = [&](std::string_view, double share) { shares.push_back(share); };
        ASSERT_TRUE(exportHair(groom, wanted, strandWriter(format), path, {})) << format;
        EXPECT_TRUE(std::ranges::is_sorted(shares)) << format;
        EXPECT_GT(shares.back(), 0.95) << format;
        fs::remove(path);
        const std::set<double> each(shares.begin(), shares.end());
        EXPECT_GT(each.size(), 20u) << format;
        for (const double at : each) {
            std::atomic<bool> stop = false;
            wanted.cancel = &stop;
            bool isLate = false;
            wanted.progress = [&](std::string_view, double share) {
                isLate = isLate || stop;
                stop = share >= at;
            };
            const auto report = exportHair(groom, wanted, strandWriter(format), path, {});
            ASSERT_FALSE(report) << format << " at " << at;
            EXPECT_THAT(report.error().message(), testing::HasSubstr("stopped")) << format << " at " << at;
            EXPECT_FALSE(isLate) << format << " goes on behind " << at;
            EXPECT_FALSE(fs::exists(path)) << format << " at " << at;
        }
    }
}

TEST_F(HairExportTest, OperatorsComeBackFromUsdWhereThisVersionKnowsThem) {
    Groom groom = smallHead();
    groom.pointAttributes.set(attribute::kBasePosition,
                              std::vector<Vec3f>(groom.positions().begin(), groom.positions().end()));
    groom.operators = {newOperator("trim"), newOperator("noise")};
    const fs::path path = folder_ / "a.usda";
    ASSERT_TRUE(exportHair(groom, {}, strandWriter("usda"), path, {}));
    const auto back = importHairFor(smallHead(), path.string(), {});
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->groom.operators, groom.operators);
    Groom beside = back->groom;
    appendGuides(beside, smallHead());
    EXPECT_TRUE(beside.operators.empty()) << "strands that operators did not make";
    EXPECT_FALSE(beside.pointAttributes.has(attribute::kBasePosition));
    std::string text = readTextFile(path).value();
    const std::size_t at = text.find("trim");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 4, "trin");
    ASSERT_TRUE(writeFileAtomically(path, std::string_view(text)));
    const auto odd = importHairFor(smallHead(), path.string(), {});
    ASSERT_TRUE(odd) << odd.error().message();
    EXPECT_TRUE(odd->groom.operators.empty());
    EXPECT_FALSE(odd->groom.pointAttributes.has(attribute::kBasePosition));
    EXPECT_TRUE(std::ranges::any_of(odd->warnings, [](const Finding& f) { return f.where == "operators"; }));
}

/// What is odd in text and in numbers.
Groom oddSettings() {
    Groom groom = smallHead();
    groom.simulation.windSpeed = 0.1f;
    groom.material.rootColour = Vec3f(0.1f, 1.0f / 3, 0.7f);
    groom.layers[0].name = "a \"b\" \\ ä {};";
    groom.spheres[0].name = "c\n\td";
    return groom;
}

TEST_F(HairExportTest, ANameOfAnotherFormatIsTold) {
    const Groom groom = oddSettings();
    const auto told = [&](const char* name, const char* format) {
        const auto report = exportHair(groom, {}, strandWriter(format), folder_ / name, {});
        EXPECT_TRUE(report) << name;
        return report && std::ranges::any_of(report->findings, [](const Finding& finding) {
                   return finding.what.rfind("the name ends in", 0) == 0;
               });
    };
    EXPECT_TRUE(told("hair.usda", "usdc")) << "USD's own library opens it as text, and fails";
    EXPECT_TRUE(told("hair.ABC", "usdc"));
    EXPECT_FALSE(told("hair.usdc", "usdc"));
    EXPECT_FALSE(told("hair.USDA", "usda"));
    EXPECT_FALSE(told("hair.usd", "usdc")) << "no format's own name";
    EXPECT_FALSE(told("hair.abc", "abc-unreal"));
    EXPECT_FALSE(told("hair", "usdc"));
}

TEST_F(HairExportTest, SettingsAreCustomDataOfUsdAndComeBackBitForBit) {
    const Groom groom = oddSettings();
    for (const char* const format : {"usda", "usdc"}) {
        const fs::path path = folder_ / (std::string("settings.") + format);
        ASSERT_TRUE(exportHair(groom, {}, strandWriter(format), path, {}));
        const auto back = importHairFor(smallHead(), path.string(), {});
        ASSERT_TRUE(back) << back.error().message();
        EXPECT_EQ(settingsText(back->groom), settingsText(groom)) << format;
        EXPECT_TRUE(back->warnings.empty()) << format;
    }
}

TEST_F(HairExportTest, SettingsOfOlderUsdAreAnAttribute) {
    const Groom groom = oddSettings();
    const fs::path path = folder_ / "older.usda";
    ASSERT_TRUE(exportHair(groom, {}, strandWriter("usda"), path, {}));
    std::string text = readTextFile(path).value();
    const std::size_t begin = text.find(" (\n    customData"), at = text.find("string settings = ", begin);
    ASSERT_NE(at, std::string::npos);
    const std::string line = text.substr(at, text.find('\n', at) - at);
    const std::size_t end = text.find("{\n", text.find(")\n", at));
    text.replace(begin, end + 2 - begin, "\n{\n    custom string hairloom:" + line.substr(7) + "\n");
    ASSERT_TRUE(writeFileAtomically(path, std::string_view(text)));
    const auto back = importHairFor(smallHead(), path.string(), {});
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(settingsText(back->groom), settingsText(groom));
}

TEST_F(HairExportTest, OtherCustomDataOfUsdIsReadOver) {
    const fs::path path = folder_ / "other.usda";
    ASSERT_TRUE(exportHair(smallHead(), {}, strandWriter("usda"), path, {}));
    std::string text = readTextFile(path).value();
    const std::string_view key = "customData = {";
    text.insert(
        text.find(key) + key.size(),
        "\n        dictionary \"my tool\" = { int[] a = [1, 2]; string[] b = [\"x\"] string hairloom = "
        "\"}\" }\n        asset c = @a.png@\n        matrix2d d = ((1, 0), (0, 1))\n"
        "        float3[] e = [(1, 2, 3)]\n        dictionary empty = {}\n        bool f = 1\n");
    ASSERT_TRUE(writeFileAtomically(path, std::string_view(text)));
    const auto back = importHairFor(smallHead(), path.string(), {});
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(settingsText(back->groom), settingsText(smallHead()));
    std::string deep;
    for (int i = 0; i < 2000; ++i) deep += "dictionary a = {";
    const std::size_t at = text.find("dictionary empty");
    ASSERT_TRUE(writeFileAtomically(path, std::string_view(text.substr(0, at) + deep)));
    const auto refused = importHairFor(smallHead(), path.string(), {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), testing::HasSubstr("nested too deep"));
}

}  // namespace
}  // namespace hairloom::test
