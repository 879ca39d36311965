// SPDX-License-Identifier: GPL-3.0-or-later
// Alembic files that Blender 5.0.1 and the Alembic library 1.8.12 wrote.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "importers/strands.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

class AlembicData : public testing::Test {
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

TEST_F(AlembicData, BlendersCurvesOfEveryTypeComeIn) {
    const Groom poly = read("blender/synthetic_poly.abc");
    ASSERT_EQ(poly.strandCount(), 12u);
    EXPECT_EQ(poly.pointCount(), 105u);
    EXPECT_EQ(poly.strand(6).size(), 33u);
    const auto radii = poly.pointAttributes.view<float>(attribute::kRadius);
    ASSERT_EQ(radii.size(), 105u);
    EXPECT_FLOAT_EQ(radii[0], 0.0001f) << "half of what the file calls width";
    EXPECT_FLOAT_EQ(radii[1], 0.00001f);

    const Groom catmullRom = read("blender/synthetic_catmull_rom.abc");
    ASSERT_EQ(catmullRom.pointCount(), 105u);
    for (std::size_t p = 0; p < 105; ++p) EXPECT_EQ(catmullRom.positions()[p], poly.positions()[p]);

    const Groom bezier = read("blender/synthetic_bezier.abc");
    ASSERT_EQ(bezier.strandCount(), 12u);
    for (std::size_t s = 0; s < 12; ++s) {
        ASSERT_EQ(bezier.strand(s).size(), 3 * (poly.strand(s).size() - 1) + 1);
        for (std::size_t i = 0; i < poly.strand(s).size(); ++i)
            EXPECT_LT((bezier.strand(s)[3 * i] - poly.strand(s)[i]).norm(), 1e-7f)
                << "through Blender's points";
    }
    EXPECT_FLOAT_EQ(bezier.pointAttributes.view<float>(attribute::kRadius)[3], 0.00001f)
        << "a width each knot";

    // Blender's own bounds of the drawn curve are what the evaluated points must keep to.
    const Groom nurbs = read("blender/synthetic_nurbs.abc");
    ASSERT_EQ(nurbs.strandCount(), 12u);
    EXPECT_NEAR(nurbs.bounds().max().y(), 0.1751f - 0.0001f, 1e-6f) << "bounds have the radius in them";
    EXPECT_NEAR(nurbs.bounds().min().y(), -0.001f, 1.1e-3f);
}

TEST_F(AlembicData, UnrealsAttributesFromTheRealLibrary) {
    StrandImportOptions metres;
    metres.isUnitAsked = true;
    const auto imported = importStrands(folder / "reference_groom.abc", metres);
    ASSERT_TRUE(imported) << imported.error().message();
    const Groom& groom = imported->groom;
    ASSERT_EQ(groom.strandCount(), 2u);
    EXPECT_EQ(read("reference_groom.abc").strand(0)[3], Vec3f(0, 0.03f, 0.01f)) << "Unreal's own unit";
    EXPECT_EQ(groom.pointCount(), 8u);
    EXPECT_EQ(groom.strand(0)[3], Vec3f(0, 3, 1));
    const AttributeSet& strands = groom.strandAttributes;
    EXPECT_EQ(strands.view<Vec2f>(attribute::kRootUv)[1], Vec2f(0.3f, 0.4f));
    EXPECT_EQ(strands.view<std::uint32_t>(attribute::kStrandId)[1], 1u);
    EXPECT_EQ(strands.view<std::uint8_t>(attribute::kGuide)[0], 0u);
    EXPECT_EQ(strands.view<std::int32_t>("groom_closest_guides_0")[1], 1);
    EXPECT_EQ(strands.view<std::int32_t>("groom_closest_guides_1")[0], 1);
    EXPECT_FLOAT_EQ(groom.pointAttributes.view<float>(attribute::kRadius)[7], 0.005f);
}

TEST_F(AlembicData, CutOrChangedAnywhereIsSaidOrReadButNeverHarms) {
    const auto whole = readFile(folder / "reference_groom.abc");
    ASSERT_TRUE(whole);
    for (std::size_t length = 0; length < whole->size(); length += 3) {
        const std::vector<std::byte> cut(whole->begin(),
                                         whole->begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_FALSE(importStrandsFromMemory("cut.abc", cut)) << length;
    }
    std::size_t refused = 0;
    for (std::size_t at = 8; at < whole->size(); ++at) {
        for (const int bits : {0xff, 0x80, 0x01}) {
            std::vector<std::byte> changed = *whole;
            changed[at] ^= static_cast<std::byte>(bits);
            const auto imported = importStrandsFromMemory("changed.abc", changed);
            if (imported) continue;
            ++refused;
            EXPECT_THAT(imported.error().message(), HasSubstr("changed.abc"));
        }
    }
    EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace hairloom
