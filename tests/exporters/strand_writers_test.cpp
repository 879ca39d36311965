// SPDX-License-Identifier: GPL-3.0-or-later
// Round trips through the writers, and what their reports say.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/file.h"
#include "core/groom/point_width.h"
#include "exporters/strands.h"
#include "tests/exporters/asset_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using test::helices;
using testing::HasSubstr;

class StrandWriters : public test::ExportTest {};

Result<ExportReport> writeHair(const Groom& groom, const fs::path& path,
                               const StrandExportOptions& options = {}) {
    return strandWriter("hair").write(groom, path, options);
}
Result<ExportReport> writeTfx(const Groom& groom, const fs::path& path,
                              const StrandExportOptions& options = {}) {
    return strandWriter("tfx").write(groom, path, options);
}

template <class T>
std::vector<T> ramp(std::size_t count, T scale) {
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = scale * (static_cast<float>(i + 1) / static_cast<float>(count));
    return values;
}

Groom decorated(const std::vector<std::uint32_t>& counts) {
    Groom groom = helices(counts);
    const std::size_t points = groom.pointCount();
    groom.pointAttributes.set(attribute::kRadius, ramp(points, 0.00007f));
    groom.pointAttributes.set(attribute::kTransparency, ramp(points, 0.5f));
    groom.pointAttributes.set(attribute::kPointColour, ramp(points, Vec3f(0.3f, 0.6f, 0.9f)));
    groom.strandAttributes.set(attribute::kRootUv, ramp(groom.strandCount(), Vec2f(1, 0.5f)));
    return groom;
}

void expectSamePositions(const Groom& a, const Groom& b) {
    ASSERT_EQ(std::vector(a.offsets.view().begin(), a.offsets.view().end()),
              std::vector(b.offsets.view().begin(), b.offsets.view().end()));
    for (std::size_t i = 0; i < a.pointCount(); ++i) ASSERT_EQ(a.positions()[i], b.positions()[i]);
}

template <class T>
void expectSameValues(const AttributeSet& a, const AttributeSet& b, std::string_view name) {
    ASSERT_FALSE(a.view<T>(name).empty());
    EXPECT_THAT(b.view<T>(name), testing::ElementsAreArray(a.view<T>(name).begin(), a.view<T>(name).end()))
        << name;
}

bool says(const ExportReport& report, std::string_view what) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](const Finding& finding) { return finding.what.find(what) != std::string::npos; });
}

TEST_F(StrandWriters, HairRoundTripIsExact) {
    const Groom groom = decorated({2, 17, 5, 64, 100});
    const auto report = writeHair(groom, folder / "a.hair");
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->strands, 5u);
    EXPECT_EQ(report->points, 188u);
    EXPECT_EQ(report->maxErrorMm.value(), 0.0);
    EXPECT_EQ(report->bytes, fs::file_size(folder / "a.hair"));
    const auto back = importStrands(folder / "a.hair");
    ASSERT_TRUE(back) << back.error().message();
    expectSamePositions(groom, back->groom);
    expectSameValues<float>(groom.pointAttributes, back->groom.pointAttributes, attribute::kRadius);
    expectSameValues<float>(groom.pointAttributes, back->groom.pointAttributes, attribute::kTransparency);
    expectSameValues<Vec3f>(groom.pointAttributes, back->groom.pointAttributes, attribute::kPointColour);
}

TEST_F(StrandWriters, PaintedWidthsAreInTheThickness) {
    Groom groom = decorated({2, 17, 5});
    const auto before = groom.pointAttributes.view<float>(attribute::kRadius);
    std::vector<float> changes;
    for (std::size_t p = 0; p < groom.pointCount(); ++p) changes.push_back(0.25f * static_cast<float>(p % 5));
    groom.pointAttributes.set(attribute::kWidthChange, changes);
    for (const std::string format : {"hair", "usda", "abc"}) {
        const fs::path name = "a." + format;
        const auto written = strandWriter(format).write(groom, folder / name, {});
        ASSERT_TRUE(written) << written.error().message();
        const auto back = importStrands(folder / name);
        ASSERT_TRUE(back) << back.error().message();
        const auto radii = back->groom.pointAttributes.view<float>(attribute::kRadius);
        ASSERT_EQ(radii.size(), before.size()) << name;
        for (std::size_t p = 0; p < radii.size(); ++p)
            EXPECT_FLOAT_EQ(radii[p], before[p] * (1 + changes[p])) << name;
        // They are not painted once more.
        EXPECT_FALSE(back->groom.pointAttributes.has(attribute::kWidthChange)) << name;
    }
    // Where the groom has no radii, those of its material are.
    groom.pointAttributes.erase(attribute::kRadius);
    ASSERT_TRUE(writeHair(groom, folder / "b.hair"));
    const auto wide = importStrands(folder / "b.hair");
    groom.pointAttributes.erase(attribute::kWidthChange);
    ASSERT_TRUE(writeHair(groom, folder / "c.hair"));
    const auto plain = importStrands(folder / "c.hair");
    ASSERT_TRUE(wide && plain);
    for (std::size_t p = 0; p < groom.pointCount(); ++p)
        EXPECT_FLOAT_EQ(wide->groom.pointAttributes.view<float>(attribute::kRadius)[p],
                        plain->groom.pointAttributes.view<float>(attribute::kRadius)[p] * (1 + changes[p]));
}

TEST_F(StrandWriters, TfxRoundTripIsExact) {
    const Groom groom = decorated({16, 16, 16});
    const auto report = writeTfx(groom, folder / "a.tfx");
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->maxErrorMm.value(), 0.0);
    EXPECT_FALSE(says(*report, "resampled"));
    const auto back = importStrands(folder / "a.tfx");
    ASSERT_TRUE(back) << back.error().message();
    expectSamePositions(groom, back->groom);
    expectSameValues<Vec2f>(groom.strandAttributes, back->groom.strandAttributes, attribute::kRootUv);
    expectSameValues<Vec3f>(groom.pointAttributes, back->groom.pointAttributes, attribute::kPointColour);
}

TEST_F(StrandWriters, TfxLayoutIsWhatTressFxReads) {
    ASSERT_TRUE(writeTfx(helices({8, 8}), folder / "a.tfx"));
    const auto bytes = readFile(folder / "a.tfx").value();
    ByteReader reader("a.tfx", bytes);
    EXPECT_EQ(reader.read<float>("version").value(), 4.0f);
    EXPECT_EQ(reader.read<std::uint32_t>("strands").value(), 2u);
    EXPECT_EQ(reader.read<std::uint32_t>("vertices").value(), 8u);
    EXPECT_EQ(reader.read<std::uint32_t>("positions").value(), 160u);
    // Loaders seek to the UVs whatever the offset says, so it is never 0.
    EXPECT_EQ(reader.read<std::uint32_t>("UVs").value(), 160u + 16u * 16u);
    ASSERT_EQ(bytes.size(), 160u + 16u * 16u + 2u * 8u);
    for (std::size_t vertex = 0; vertex < 16; ++vertex) {
        float inverseMass = -1;
        std::memcpy(&inverseMass, bytes.data() + 160 + vertex * 16 + 12, sizeof inverseMass);
        EXPECT_EQ(inverseMass, vertex % 8 < 2 ? 0.0f : 1.0f) << vertex;
    }
}

TEST_F(StrandWriters, TfxResamplesToTheNearestAllowedCountAndSaysSo) {
    for (const auto& [points, expected] :
         {std::pair{5u, 4u}, {7u, 8u}, {20u, 16u}, {50u, 64u}, {200u, 64u}}) {
        const Groom groom = helices({points, points});
        const auto report = writeTfx(groom, folder / "a.tfx");
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->points, 2u * expected) << points;
        EXPECT_TRUE(says(*report, "resampled"));
        EXPECT_GT(report->maxErrorMm.value(), 0.0);
        EXPECT_LT(report->maxErrorMm.value(), 20.0);
        const auto back = importStrands(folder / "a.tfx");
        ASSERT_TRUE(back);
        EXPECT_EQ(back->groom.strand(1).front(), groom.strand(1).front());
        EXPECT_EQ(back->groom.strand(1).back(), groom.strand(1).back());
    }
    StrandExportOptions options;
    options.pointsPerStrand = 32;
    EXPECT_EQ(writeTfx(helices({20, 7}), folder / "b.tfx", options)->points, 64u);
    options.pointsPerStrand = 20;
    const auto refused = writeTfx(helices({20}), folder / "c.tfx", options);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("4, 8, 16, 32 or 64"));
    EXPECT_FALSE(fs::exists(folder / "c.tfx"));
}

TEST_F(StrandWriters, UnitsAndAxesComeBack) {
    StrandExportOptions options;
    options.metresPerUnit = 0.0254f;
    options.up = UpAxis::Z;
    const Groom groom = helices({8, 8});
    for (const auto& report :
         {writeHair(groom, folder / "a.hair", options), writeTfx(groom, folder / "a.tfx", options)}) {
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_LT(report->maxErrorMm.value(), 1e-3);
    }
    // Read as if Y were up: height is in z, 1.7 m are 66.9 inches.
    const auto raw = importStrands(folder / "a.hair");
    ASSERT_TRUE(raw);
    EXPECT_NEAR(raw->groom.strand(0)[0].z(), 1.7f / 0.0254f, 1e-4f);
}

TEST_F(StrandWriters, UnusableStrandsAreLeftOutAndReported) {
    Groom groom = helices({8, 8, 8, 8});
    auto& positions = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    positions[9].x() = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 17; i < 24; ++i) positions[i] = positions[16];
    positions[26] = positions[25];
    const auto report = writeHair(groom, folder / "a.hair");
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->strands, 2u);
    EXPECT_TRUE(says(*report, "2 strands without length"));
    EXPECT_TRUE(says(*report, "segments without length"));
    EXPECT_TRUE(says(*report, "no widths"));
    EXPECT_LT(report->maxErrorMm.value(), 1e-4);
    for (const Finding& finding : report->findings) {
        EXPECT_TRUE(finding.severity == Severity::Info || !finding.fix.empty()) << finding.what;
    }
}

TEST_F(StrandWriters, HairRefusesMoreSegmentsThanItCanCount) {
    const Groom groom = helices({65537});
    const auto report = writeHair(groom, folder / "a.hair");
    ASSERT_FALSE(report);
    EXPECT_THAT(report.error().message(), HasSubstr("at most 65535"));
    EXPECT_TRUE(writeHair(helices({65536}), folder / "a.hair"));
}

TEST_F(StrandWriters, RootsFarFromTheScalpAreReported) {
    PolygonSoup soup;
    soup.positions = {{-1, 1.69f, -1}, {-1, 1.69f, 1}, {1, 1.69f, 1}, {1, 1.69f, -1}};
    soup.corners = {0, 1, 2, 3};
    soup.offsets = {0, 4};
    Groom groom = helices({8, 8});
    groom.scalp = std::make_shared<const ScalpMesh>(ScalpMesh::make(soup).value());
    const auto report = writeHair(groom, folder / "a.hair");
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_TRUE(says(*report, "roots are up to 10 mm"));
}

TEST_F(StrandWriters, FailuresLeaveTheOldFile) {
    const auto path = folder / "a.tfx";
    ASSERT_TRUE(writeTfx(helices({8}), path));
    const auto before = readFile(path).value();
    EXPECT_FALSE(writeTfx(Groom(), path));
    StrandExportOptions options;
    options.metresPerUnit = -1;
    EXPECT_FALSE(writeTfx(helices({8}), path, options));
    EXPECT_FALSE(writeHair(helices({8}), folder / "missing" / "a.hair"));
    EXPECT_EQ(readFile(path).value(), before);
}

TEST_F(StrandWriters, AlembicAndUsdCarryEveryAttribute) {
    Groom groom = decorated({2, 5, 64, 7});
    groom.strandAttributes.set(attribute::kStrandId, std::vector<std::uint32_t>{4, 9, 2, 7});
    groom.strandAttributes.set(attribute::kGuide, std::vector<std::uint8_t>{1, 0, 0, 1});
    groom.strandAttributes.set(attribute::kGroup, std::vector<std::uint32_t>{0, 1, 1, 0});
    groom.groupNames = {"group 3", "group 8"};
    groom.strandAttributes.set("temperature", std::vector<Vec3f>(4, Vec3f(1, 2, 3)));
    for (int k = 0; k < 3; ++k)
        groom.strandAttributes.set("groom_closest_guides_" + std::to_string(k),
                                   std::vector<std::int32_t>{0, 3, k, 0});
    groom.strandAttributes.set("groom_guide_weights", std::vector<Vec3f>(4, Vec3f(0.5f, 0.3f, 0.2f)));
    groom.pointAttributes.set("wetness", std::vector<float>(groom.pointCount(), 0.25f));
    for (const std::string format : {"abc", "abc-unreal", "usda", "usdc"}) {
        const fs::path path = folder / ("a." + strandWriter(format).suffix());
        for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
            StrandExportOptions options;
            options.metresPerUnit = 0.01f;
            options.up = up;
            const auto report = strandWriter(format).write(groom, path, options);
            ASSERT_TRUE(report) << report.error().message();
            EXPECT_EQ(report->format, format.starts_with("usd") ? "USD" : "Alembic");
            EXPECT_LT(report->maxErrorMm.value(), 0.001);
            std::set<std::string> carried;
            for (const ComparedAttribute& compared : report->attributes) {
                carried.insert(compared.name);
                EXPECT_LT(compared.maxError, compared.name == attribute::kRadius ? 1e-9 : 1e-30)
                    << compared.name;
            }
            for (const auto& [name, data] : groom.strandAttributes.all())
                EXPECT_TRUE(carried.contains(name)) << name;
            for (const auto& [name, data] : groom.pointAttributes.all()) {
                EXPECT_TRUE(name == attribute::kPosition || carried.contains(name)) << name;
            }
            StrandImportOptions importing;
            importing.metresPerUnit = 0.01f;
            importing.up = up;
            EXPECT_EQ(importStrands(path, importing)->groom.groupNames, groom.groupNames);
        }
    }
}

TEST_F(StrandWriters, WhatAFormatCannotCarryIsListedWithWhatToDo) {
    Groom groom = decorated({8, 8});
    groom.strandAttributes.set(attribute::kGuide, std::vector<std::uint8_t>{1, 0});
    groom.interpolation.followPerGuide = 5;
    const auto report = writeHair(groom, folder / "a.hair");
    ASSERT_TRUE(report);
    std::string left;
    for (const LeftBehind& one : report->leftBehind) {
        left += one.what + "\n";
        EXPECT_FALSE(one.fix.empty());
    }
    EXPECT_THAT(left, HasSubstr("\"guide\" of strands"));
    EXPECT_THAT(left, HasSubstr("5 follow hairs"));
    const auto json = toJson(*report);
    EXPECT_EQ(json["left_behind"].size(), report->leftBehind.size());
    EXPECT_EQ(json["attributes"].size(), report->attributes.size());
}

TEST_F(StrandWriters, EveryTargetOfEveryFormatIsWrittenAndReadBackByContent) {
    const Groom groom = decorated({17, 17});
    ASSERT_GE(strandWriters().size(), 2u);
    for (const HairWriter& writer : strandWriters()) {
        ASSERT_FALSE(writer.targets.empty()) << writer.name;
        for (const ExportTarget& target : writer.targets) {
            fs::remove(folder / "any.name");
            const auto report = writer.write(groom, folder / "any.name", target.options);
            ASSERT_TRUE(report) << target.name << ": " << report.error().message();
            EXPECT_EQ(report->strands, 2u) << target.name;
            EXPECT_LT(report->maxErrorMm.value(), 2.0) << target.name;
        }
    }
}

TEST_F(StrandWriters, ResampledStrandsCarryTheirWidthsAndClaimNoMore) {
    Groom groom = decorated({9, 17});
    groom.pointAttributes.set(attribute::kBasePosition,
                              std::vector<Vec3f>(groom.pointCount(), Vec3f::Zero()));
    StrandExportOptions options;
    options.pointsPerStrand = 8;
    options.metresPerUnit = 0.01f;
    const auto names = [](const ExportReport& report) {
        std::set<std::string> carried;
        for (const ComparedAttribute& one : report.attributes) carried.insert(one.name);
        return carried;
    };
    const auto abc = strandWriter("abc").write(groom, folder / "a.abc", options);
    ASSERT_TRUE(abc) << abc.error().message();
    EXPECT_TRUE(names(*abc).contains("radius"));
    for (const ComparedAttribute& one : abc->attributes) EXPECT_LT(one.maxError, 1e-6) << one.name;
    const auto lines = strandWriter("obj-lines").write(groom, folder / "a.obj", options);
    ASSERT_TRUE(lines) << lines.error().message();
    EXPECT_FALSE(names(*lines).contains("radius"));
    for (const ExportReport* report : {&*abc, &*lines})
        EXPECT_FALSE(names(*report).contains("base_position")) << "operators' own";
}

TEST_F(StrandWriters, StrandsThatMoveAreReadBackAtEveryFrame) {
    const Groom groom = decorated({9, 17});
    const auto frames = std::make_shared<StrandFrames>();
    frames->framesPerSecond = 30;
    frames->first = 5;
    for (int f = 0; f < 4; ++f) {
        std::vector<Vec3f> points(groom.positions().begin(), groom.positions().end());
        for (Vec3f& point : points)
            point += static_cast<float>(f) * Vec3f(0.01f, 0.1f * (point.y() - 1.7f), 0.003f);
        frames->points.push_back(std::move(points));
    }
    int animating = 0;
    for (const HairWriter& writer : strandWriters()) {
        if (!writer.animates) continue;
        ++animating;
        for (const ExportTarget& target : writer.targets) {
            StrandExportOptions options = target.options;
            options.frames = frames;
            const fs::path path = folder / ("moving." + writer.suffix());
            const auto report = writer.write(groom, path, options);
            ASSERT_TRUE(report) << target.name << ": " << report.error().message();
            EXPECT_EQ(report->frames, 4u);
            EXPECT_LT(report->maxErrorMm.value(), 0.001) << target.name;
            StrandImportOptions reading;
            reading.metresPerUnit = options.metresPerUnit;
            reading.up = options.up;
            reading.frames = true;
            const auto back = importStrands(path, reading);
            ASSERT_TRUE(back) << back.error().message();
            EXPECT_FLOAT_EQ(back->framesPerSecond, 30) << target.name;
            ASSERT_EQ(back->frames.size(), 4u);
            for (std::size_t p = 0; p < groom.pointCount(); ++p)
                EXPECT_LT((back->frames[3][p] - frames->points[3][p]).norm(), 1e-6f) << target.name;
        }
        StrandExportOptions fewer;
        fewer.frames = frames;
        fewer.pointsPerStrand = 5;
        const auto report = writer.write(groom, folder / ("fewer." + writer.name), fewer);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->points, 10u);
        EXPECT_LT(report->maxErrorMm.value(), 3.0);
    }
    EXPECT_EQ(animating, 4);
}

/// What is written is read back, so that each reader is asked.
TEST_F(StrandWriters, APointBeyondAKilometreIsRefusedWithItsStrand) {
    Groom groom = helices({8, 8});
    for (const float metres : {1.5e3f, 1e12f}) {
        std::vector<Vec3f> points(groom.positions().begin(), groom.positions().end());
        points[11] = Vec3f(0, metres, 0);
        groom.pointAttributes.set(attribute::kPosition, points);
        for (const HairWriter& writer : strandWriters()) {
            StrandExportOptions options = writer.targets.front().options;
            options.pointsPerStrand = 8;
            const auto report = writer.write(groom, folder / ("far." + writer.name), options);
            ASSERT_FALSE(report) << writer.name;
            EXPECT_THAT(report.error().message(), HasSubstr("from the origin")) << writer.name;
            EXPECT_THAT(report.error().message(), HasSubstr("strand 1")) << writer.name;
            if (!writer.animates) continue;
            // At rest they are near.
            const Groom near = helices({8, 8});
            auto frames = std::make_shared<StrandFrames>();
            frames->points.assign(3, {near.positions().begin(), near.positions().end()});
            frames->points[2] = points;
            options.frames = frames;
            const auto moving = writer.write(near, folder / ("far." + writer.name), options);
            ASSERT_FALSE(moving) << writer.name;
            EXPECT_THAT(moving.error().message(), HasSubstr("from the origin")) << writer.name;
        }
    }
}

TEST_F(StrandWriters, TargetsSetWhatTheirProgramWantsAndNameWhatItDoesNotTake) {
    for (const char* const program : {"blender", "houdini", "jolt", "maya", "tressfx", "unity", "unreal"})
        EXPECT_NE(findTarget(preferredWriter(program), program), nullptr) << program;
    EXPECT_EQ(preferredWriter("unreal").name, "abc-unreal");
    EXPECT_EQ(findTarget(strandWriter("tfx"), "blender"), nullptr);
    const Groom groom = decorated({2, 5, 200, 7});
    const HairWriter& writer = preferredWriter("unity");
    StrandExportOptions options = findTarget(writer, "unity")->options;
    const auto fixes = [&] {
        const auto report = writer.write(groom, folder / ("u." + writer.suffix()), options);
        EXPECT_TRUE(report);
        std::vector<std::string> found;
        for (const Finding& finding : report->findings) {
            if (finding.severity == Severity::Error) found.push_back(finding.fix);
        }
        return found;
    };
    EXPECT_EQ(fixes(), (std::vector<std::string>{"export with --points 128", "export with --points 3"}));
    options.pointsPerStrand = 16;
    EXPECT_TRUE(fixes().empty()) << "the fix helps";
}

TEST_F(StrandWriters, ReportAsJson) {
    const auto report = writeTfx(helices({8}), folder / "a.tfx");
    ASSERT_TRUE(report);
    const auto json = toJson(*report);
    EXPECT_EQ(json.at("strands"), 1);
    EXPECT_EQ(json.at("points"), 8);
    EXPECT_EQ(json.at("bytes"), report->bytes);
    EXPECT_EQ(json.at("max_error_mm"), 0.0);
    ASSERT_FALSE(json.at("findings").empty());
    for (const char* key : {"severity", "what", "where", "fix"})
        EXPECT_TRUE(json["findings"][0].contains(key)) << key;
}

TEST_F(StrandWriters, RealHairSurvivesBothFormats) {
    const auto path = outsideData() / "strands/sintel_16pt.tfx";
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
    const auto original = importStrands(path);
    ASSERT_TRUE(original);
    ASSERT_TRUE(writeHair(original->groom, folder / "a.hair"));
    ASSERT_TRUE(writeTfx(original->groom, folder / "a.tfx"));
    for (const char* name : {"a.hair", "a.tfx"}) {
        const auto back = importStrands(folder / name);
        ASSERT_TRUE(back);
        expectSamePositions(original->groom, back->groom);
    }
}

}  // namespace
}  // namespace hairloom
