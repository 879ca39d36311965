// SPDX-License-Identifier: GPL-3.0-or-later
// What leaves a project, beside what the writers' own tests hold them to.
#include "core/documents/hair_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/file.h"
#include "core/documents/hair_import.h"
#include "core/operations/stack.h"
#include "core/stability/certificate.h"
#include "hairloom/asset.h"
#include "tests/documents/small_head.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;

class HairExportTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / "hairloom-hair-export";
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path folder_;
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

TEST_F(HairExportTest, StormsAreCancelledAndNothingIsWritten) {
    const std::atomic<bool> stop = true;
    HairToExport wanted;
    wanted.storms = 1000;
    wanted.cancel = &stop;
    EXPECT_FALSE(exportHair(smallHead(), wanted, strandWriter("runtime"), folder_ / "a.hairrt", {}));
    EXPECT_FALSE(fs::exists(folder_ / "a.hairrt"));
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

}  // namespace
}  // namespace hairloom::test
