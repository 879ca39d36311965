// SPDX-License-Identifier: GPL-3.0-or-later
// USD files that Blender, OpenUSD and others wrote, and small ones of our own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/file.h"
#include "importers/strands.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

Result<ImportedStrands> readText(const std::string& text, const StrandImportOptions& options = {}) {
    return importStrandsFromMemory("hair.usda", std::as_bytes(std::span(text.data(), text.size())), options);
}

constexpr const char* kStage = R"(#usda 1.0
(
    "a comment" metersPerUnit = 0.01
    upAxis = "Z"
    timeCodesPerSecond = 30
    customLayerData = { string a = "}" dictionary b = { int c = 1 } }
)
def Xform "head" (kind = "group")
{
    double3 xformOp:translate = (10, 0, 0)
    float xformOp:rotateZ = 90
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]
    rel material:binding = </other>
    def BasisCurves "hair"
    {
        uniform token type = "linear"
        int[] curveVertexCounts = [2, 3]
        point3f[] points = [(1, 0, 0), (2, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 1)]
        point3f[] points.timeSamples = {
            0: [(1, 0, 0), (2, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 1)],
            1: [(1, 0, 1), (2, 0, 1), (0, 1, 1), (0, 2, 1), (0, 3, 2)],
        }
        float[] widths = [0.1, 0.2] (interpolation = "uniform")
        int[] primvars:groom_group_id = [7, 5] (interpolation = "uniform")
        bool[] primvars:groom_guide = [true, false] (interpolation = "uniform")
        float2[] primvars:st = [(0.5, 0.25), (1, 0)] (interpolation = "uniform")
        int[] primvars:st:indices = [1, 0]
        float[] primvars:wet = [1, 2, 3, 4, 5] (interpolation = "vertex")
    }
}
)";

TEST(Usd, StageTransformsAttributesAndIndices) {
    const auto imported = readText(kStage);
    ASSERT_TRUE(imported) << imported.error().message();
    const Groom& groom = imported->groom;
    EXPECT_EQ(imported->format, "USD");
    ASSERT_EQ(groom.strandCount(), 2u);
    // (1, 0, 0) turned to (0, 1, 0), moved to (10, 1, 0), in centimetres and Z up: (x, z, −y).
    EXPECT_LT((groom.strand(0)[0] - Vec3f(0.1f, 0, -0.01f)).norm(), 1e-7f);
    EXPECT_FLOAT_EQ(groom.pointAttributes.view<float>(attribute::kRadius)[4], 0.001f);
    EXPECT_FLOAT_EQ(groom.pointAttributes.view<float>("wet")[4], 5);
    EXPECT_EQ(groom.strandAttributes.view<Vec2f>(attribute::kRootUv)[0], Vec2f(1, 0));
    EXPECT_EQ(groom.strandAttributes.view<std::uint8_t>(attribute::kGuide)[0], 1u);
    EXPECT_EQ(groom.groupNames[groom.strandAttributes.view<std::uint32_t>(attribute::kGroup)[0]], "group 7");
    EXPECT_TRUE(imported->frames.empty());
    EXPECT_THAT(imported->warnings.front().what, HasSubstr("2 time samples"));
}

TEST(Usd, AStiffnessThatCannotBeOursKeepsItsNumbersUnderAnotherName) {
    for (const auto& [values, taken] : {std::pair("[0, 12.5]", true), {"[0.5, 40000]", false}}) {
        std::string stage = kStage;
        stage.insert(stage.find("        float[] primvars:wet"),
                     std::string("        float[] primvars:stiffness = ") + values +
                         " (interpolation = \"uniform\")\n");
        const auto imported = readText(stage);
        ASSERT_TRUE(imported) << imported.error().message();
        const AttributeSet& attributes = imported->groom.strandAttributes;
        EXPECT_EQ(attributes.has(attribute::kStiffness), taken) << values;
        EXPECT_EQ(attributes.view<float>(taken ? attribute::kStiffness : "stiffness_of_file").size(), 2u);
    }
}

TEST(Usd, StrandsThatMoveGiveTheirFrames) {
    StrandImportOptions options;
    options.frames = true;
    const auto imported = readText(kStage, options);
    ASSERT_TRUE(imported);
    ASSERT_EQ(imported->frames.size(), 2u);
    EXPECT_EQ(imported->framesPerSecond, 30);
    EXPECT_LT((imported->frames[1][0] - imported->frames[0][0] - Vec3f(0, 0.01f, 0)).norm(), 1e-7f);
}

TEST(Usd, DamageIsSaidWithItsLine) {
    const std::string whole = kStage;
    for (std::size_t length = 0; length < whole.size() - 3; ++length) {
        const auto imported = readText(whole.substr(0, length));
        EXPECT_FALSE(imported) << length;
    }
    std::string wrong = whole;
    wrong.replace(wrong.find("[2, 3]"), 6, "[2, 9]");
    EXPECT_THAT(readText(wrong).error().message(), HasSubstr("hair.usda"));
    wrong = whole;
    wrong.replace(wrong.find("(2, 0, 0)"), 9, "(2, 0)   ");
    EXPECT_THAT(readText(wrong).error().message(), HasSubstr("hair.usda:18: an element of 2 numbers"));
    EXPECT_FALSE(readText("#usda 1.0\n" + std::string(100000, '(')));
}

class UsdData : public testing::Test {
  protected:
    void SetUp() override {
        folder = outsideData() / "strands";
        if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no data from elsewhere";
    }
    Groom read(const std::string& name) const {
        auto imported = importStrands(folder / name);
        EXPECT_TRUE(imported) << name << ": " << imported.error().message();
        return imported ? imported->groom : Groom();
    }
    std::filesystem::path folder;
};

TEST_F(UsdData, BlendersCurvesAreThoseOfItsAlembicFiles) {
    for (const std::string type : {"poly", "catmull_rom", "bezier", "nurbs"}) {
        const Groom usd = read("blender/synthetic_" + type + ".usda");
        const Groom alembic = read("blender/synthetic_" + type + ".abc");
        ASSERT_EQ(usd.pointCount(), alembic.pointCount()) << type;
        for (std::size_t p = 0; p < usd.pointCount(); ++p)
            ASSERT_LT((usd.positions()[p] - alembic.positions()[p]).norm(), 1e-6f) << type << " " << p;
        const auto a = usd.pointAttributes.view<float>(attribute::kRadius);
        const auto b = alembic.pointAttributes.view<float>(attribute::kRadius);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t p = 0; p < a.size(); ++p) EXPECT_NEAR(a[p], b[p], 1e-8f) << type << " " << p;
        EXPECT_EQ(usd.strandAttributes.view<std::uint32_t>(attribute::kStrandId)[11], 11u);
        EXPECT_EQ(usd.strandAttributes.view<std::uint8_t>(attribute::kGuide)[10], 1u);
        EXPECT_FLOAT_EQ(usd.strandAttributes.view<Vec2f>(attribute::kRootUv)[1].x(), 0.083333336f);
        EXPECT_FLOAT_EQ(usd.strandAttributes.view<float>("strand_length")[11], 1);
    }
}

TEST_F(UsdData, BlendersBinaryFilesAreThoseOfItsText) {
    for (const std::string type : {"poly", "catmull_rom", "bezier", "nurbs"}) {
        const Groom binary = read("blender/synthetic_" + type + ".usdc");
        const Groom text = read("blender/synthetic_" + type + ".usda");
        ASSERT_EQ(binary.strandCount(), text.strandCount());
        EXPECT_TRUE(std::ranges::equal(binary.positions(), text.positions())) << type;
        EXPECT_EQ(binary.strandAttributes.all().size(), text.strandAttributes.all().size());
        EXPECT_EQ(binary.pointAttributes.all().size(), text.pointAttributes.all().size());
        EXPECT_TRUE(std::ranges::equal(binary.pointAttributes.view<float>(attribute::kRadius),
                                       text.pointAttributes.view<float>(attribute::kRadius)));
    }
}

TEST_F(UsdData, DamagedBinaryFilesAreReadOrRefused) {
    auto bytes = readFile(folder / "blender/synthetic_nurbs.usdc");
    ASSERT_TRUE(bytes);
    for (std::size_t end = 0; end < bytes->size(); end += 7)
        static_cast<void>(importStrandsFromMemory("cut", std::span(*bytes).first(end)));
    for (std::size_t at = 8; at < bytes->size(); ++at) {
        for (const int flipped : {0xff, 0x80, 0x01}) {
            std::vector<std::byte> damaged = *bytes;
            damaged[at] ^= static_cast<std::byte>(flipped);
            const auto imported = importStrandsFromMemory("damaged", damaged);
            EXPECT_TRUE(imported || !imported.error().problem.empty());
        }
    }
}

TEST_F(UsdData, CentimetresAndYUpGiveTheSameHair) {
    const Groom one = read("blender/synthetic_catmull_rom.usda");
    const Groom other = read("blender/synthetic_cm_yup.usda");
    ASSERT_EQ(one.pointCount(), other.pointCount());
    for (std::size_t p = 0; p < one.pointCount(); ++p)
        EXPECT_LT((one.positions()[p] - other.positions()[p]).norm(), 1e-6f) << p;
    EXPECT_NEAR(other.pointAttributes.view<float>(attribute::kRadius)[0], 0.0001f, 1e-9f);
}

TEST_F(UsdData, ParticleHairAndTestFilesComeIn) {
    EXPECT_EQ(read("tinyusdz_hair.usda").strandCount(), 10u);
    EXPECT_GT(read("tinyusdz_curves.usda").strandCount(), 10u);
    EXPECT_EQ(read("openusd_BasisCurves1.usda").strandCount(), 16u);
    EXPECT_EQ(read("openusd_basicCurves.usda").strandCount(), 7u);
    EXPECT_EQ(read("openusd_testUsdGeomBasisCurves.usda").strandCount(), 2u);
}

}  // namespace
}  // namespace hairloom
