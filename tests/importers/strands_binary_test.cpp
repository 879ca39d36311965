// SPDX-License-Identifier: GPL-3.0-or-later
// .hair and .tfx: every array comes through, counts that do not agree are told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/importers/strands_files.h"

namespace hairloom {
namespace {

using namespace strand_files;
using testing::HasSubstr;

void expectCurls(const Groom& groom, std::size_t strands, std::size_t points) {
    ASSERT_EQ(groom.strandCount(), strands);
    for (std::size_t s = 0; s < strands; ++s) {
        ASSERT_EQ(groom.strand(s).size(), points);
        for (std::size_t i = 0; i < points; ++i) EXPECT_EQ(groom.strand(s)[i], curlPoint(s, i, points));
    }
}

TEST(StrandsHair, ReadsEveryArrayAndHalvesTheThickness) {
    const auto imported = read(fullHair(9, 5));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "Yuksel hair");
    EXPECT_TRUE(imported->dropped.empty());
    expectCurls(imported->groom, 9, 5);
    const auto& attributes = imported->groom.pointAttributes;
    ASSERT_EQ(attributes.view<float>(attribute::kRadius).size(), 45u);
    EXPECT_FLOAT_EQ(attributes.view<float>(attribute::kRadius)[9], 0.0005f);
    EXPECT_FLOAT_EQ(attributes.view<float>(attribute::kTransparency)[7], 0.07f);
    EXPECT_FLOAT_EQ(attributes.view<Vec3f>(attribute::kPointColour)[1].y(), 0.004f);
}

TEST(StrandsHair, UsesTheDefaultsOfTheHeader) {
    ByteWriter writer;
    writeHairHeader(writer, {2, 6, 2, 2, 0.00008f, 0, {0.5f, 0.25f, 0.125f}});
    for (std::size_t s = 0; s < 2; ++s) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3f p = curlPoint(s, i, 3);
            writer.writeArray(std::span<const float>(p.data(), 3));
        }
    }
    const auto imported = read(bytesOf(writer));
    ASSERT_TRUE(imported) << imported.error().message();
    expectCurls(imported->groom, 2, 3);
    EXPECT_FLOAT_EQ(imported->groom.material.rootRadius, 0.00004f);
    EXPECT_EQ(imported->groom.material.rootColour, Vec3f(0.5f, 0.25f, 0.125f));
}

TEST(StrandsHair, DropsOnePointStrandsAndReportsThem) {
    ByteWriter writer;
    writeHairHeader(writer, {3, 5, 3, 0});
    for (const int segments : {1, 0, 1}) writer.write(static_cast<std::uint16_t>(segments));
    for (int i = 0; i < 15; ++i) writer.write(0.01f * static_cast<float>(i));
    const auto imported = read(bytesOf(writer));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strandCount(), 2u);
    ASSERT_EQ(imported->dropped.size(), 1u);
    EXPECT_EQ(imported->dropped[0].strand, 1u);
    EXPECT_EQ(imported->dropped[0].reason, DropReason::TooFewPoints);
}

TEST(StrandsHair, RefusesCountsThatDisagree) {
    Bytes more = fullHair(2, 4);
    more[4] = std::byte{3};
    EXPECT_FALSE(read(more));
    ByteWriter writer;
    writeHairHeader(writer, {2, 5, 2, 2});
    for (int i = 0; i < 15; ++i) writer.write(0.1f);
    const auto imported = read(bytesOf(writer));
    ASSERT_FALSE(imported);
    EXPECT_THAT(imported.error().message(), HasSubstr("2 strands of 2 segments need 6 points"));
}

TEST(StrandsTfx, Version4ReadsEverySection) {
    const auto imported = read(fullTfx4(5, 8));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "TressFX 4");
    expectCurls(imported->groom, 5, 8);
    EXPECT_TRUE(
        imported->groom.strandAttributes.view<Vec2f>(attribute::kRootUv)[2].isApprox(Vec2f(0.04f, 0.05f)));
    EXPECT_FLOAT_EQ(imported->groom.strandAttributes.view<float>("thickness_scale")[3], 0.3f);
    EXPECT_EQ(imported->groom.pointAttributes.view<Vec3f>(attribute::kPointColour)[4],
              Vec3f::Constant(0.25f));
}

TEST(StrandsTfx, Version3IsLeftHanded) {
    const auto imported = read(plainTfx3(4, 4));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "TressFX 3");
    const Vec3f p = curlPoint(2, 3, 4);
    EXPECT_EQ(imported->groom.strand(2)[3], Vec3f(p.x(), p.y(), -p.z()));
}

TEST(StrandsTfx, RefusesBadOffsetsByName) {
    const auto withField = [](std::size_t field, std::uint32_t value) {
        Bytes bytes = fullTfx4(3, 4);
        std::memcpy(bytes.data() + field, &value, sizeof value);
        const auto imported = read(bytes);
        return imported ? std::string() : imported.error().message();
    };
    EXPECT_THAT(withField(12, 0), HasSubstr("positions"));
    EXPECT_THAT(withField(12, 100), HasSubstr("after the header"));
    EXPECT_THAT(withField(12, 162), HasSubstr("multiple of 4"));
    EXPECT_THAT(withField(16, 0xFFFFFFF0u), HasSubstr("strand UVs"));
    EXPECT_THAT(withField(16, 176), HasSubstr("inside the positions"));
    EXPECT_THAT(withField(4, 0xFFFFFFFFu), HasSubstr("do not fit"));
    EXPECT_THAT(withField(8, 0xFFFFFFFFu), HasSubstr("do not fit"));
    Bytes bytes = fullTfx4(3, 4);
    const float version = 2.0f;
    std::memcpy(bytes.data(), &version, sizeof version);
    EXPECT_THAT(read(bytes).error().message(), HasSubstr("TressFX version 2"));
}

TEST(StrandsRepair, RemovesCoincidentPointsAndSaysSo) {
    Bytes bytes = plainTfx3(3, 4);
    std::memcpy(bytes.data() + 296 + 12, bytes.data() + 296, 12);
    const auto imported = read(bytes);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strand(0).size(), 3u);
    EXPECT_EQ(imported->groom.strand(1).size(), 4u);
    bool said = false;
    for (const Finding& warning : imported->warnings)
        said = said || warning.what.starts_with("1 points that coincided");
    EXPECT_TRUE(said);
}

TEST(StrandsRepair, DropsWhatIsNotFiniteOrHasNoLength) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Bytes bytes = fullTfx4(3, 4);
        std::memcpy(bytes.data() + 160 + 64 + 20, &bad, sizeof bad);
        for (int i = 1; i < 4; ++i)
            std::memcpy(bytes.data() + 160 + 128 + i * 16, bytes.data() + 160 + 128, 12);
        const auto imported = read(bytes);
        ASSERT_TRUE(imported) << imported.error().message();
        ASSERT_EQ(imported->groom.strandCount(), 1u);
        ASSERT_EQ(imported->dropped.size(), 2u);
        EXPECT_EQ(imported->dropped[0].reason, DropReason::NotFinite);
        EXPECT_EQ(imported->dropped[1].reason, DropReason::ZeroLength);
        EXPECT_EQ(imported->groom.strandAttributes.view<Vec2f>(attribute::kRootUv).size(), 1u);
        EXPECT_EQ(imported->groom.pointAttributes.view<Vec3f>(attribute::kPointColour).size(), 4u);
    }
}

TEST(StrandsUnits, ScalesAndTurnsZUp) {
    StrandImportOptions options;
    options.metresPerUnit = 0.01f;
    options.up = UpAxis::Z;
    const auto imported = read(fullTfx4(3, 4), options);
    ASSERT_TRUE(imported);
    const Vec3f p = curlPoint(1, 2, 4);
    EXPECT_TRUE(imported->groom.strand(1)[2].isApprox(Vec3f(p.x(), p.z(), -p.y()) * 0.01f));
}

TEST(StrandsUnits, NamesTheUnitThatWouldFit) {
    Bytes bytes = fullTfx4(70, 4);
    for (std::size_t i = 0; i < 70 * 4; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float value = 0;
            std::memcpy(&value, bytes.data() + 160 + i * 16 + axis * 4, 4);
            value *= 100;
            std::memcpy(bytes.data() + 160 + i * 16 + axis * 4, &value, 4);
        }
    }
    const auto imported = read(bytes);
    ASSERT_TRUE(imported);
    ASSERT_FALSE(imported->warnings.empty());
    EXPECT_THAT(imported->warnings.back().fix, HasSubstr("unit cm"));
    StrandImportOptions options;
    options.metresPerUnit = 0.01f;
    const auto asCentimetres = read(bytes, options);
    ASSERT_TRUE(asCentimetres);
    for (const Finding& warning : asCentimetres->warnings)
        EXPECT_EQ(warning.severity, Severity::Info) << warning.what;
}

TEST(StrandsTfx, HalfTheCountLeavesAGapThatIsReported) {
    Bytes bytes = fullTfx4(8, 4);
    const auto whole = read(bytes);
    ASSERT_TRUE(whole);
    EXPECT_TRUE(std::ranges::none_of(whole->warnings,
                                     [](const Finding& f) { return f.severity == Severity::Error; }));
    const std::uint32_t half = 4;
    std::memcpy(bytes.data() + 4, &half, sizeof half);
    const auto halved = read(bytes);
    ASSERT_TRUE(halved);
    const auto gap = std::ranges::find(halved->warnings, Severity::Error, &Finding::severity);
    ASSERT_NE(gap, halved->warnings.end());
    EXPECT_THAT(gap->what, testing::HasSubstr("are not used: the header has 4 strands of 4"));
}

}  // namespace
}  // namespace hairloom
