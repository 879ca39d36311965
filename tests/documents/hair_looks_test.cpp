// SPDX-License-Identifier: GPL-3.0-or-later
// What runtime assets tell the shaders of games of a hairstyle's look.
#include "core/documents/hair_looks.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/documents/hair_export.h"
#include "core/interpolation/follow_hairs.h"
#include "core/live/hair_look.h"
#include "hairloom/gpu.h"
#include "hairloom/hairloom.hpp"
#include "runtime/shaders/hair_types.h"
#include "tests/documents/small_head.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {
namespace {

/// Marschner's hair with streaks, white strands and dye that has grown out.
Groom streaked() {
    Groom groom = smallHead();
    groom.interpolation.followPerGuide = 5;
    groom.material.shadingModel = ShadingModel::marschner;
    groom.material.streakShare = 0.4f;
    groom.material.streakWidth = 0.01f;
    groom.material.greyShare = 0.2f;
    groom.material.dyeStrength = 0.7f;
    groom.material.dyeRegrowth = 0.02f;
    groom.material.tipMelanin = 0.5f;
    return groom;
}

class HairLooksTest : public testing::Test {
  protected:
    void write(const Groom& groom) {
        const auto report = exportHair(groom, {}, strandWriter("runtime"), folder_ / "a.hairrt", {});
        ASSERT_TRUE(report) << report.error().message();
        report_ = *report;
        bytes_ = readFile(folder_ / "a.hairrt").value();
        ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size(), &error_)) << error_.what();
        ASSERT_EQ(hl_asset_check(asset_.get(), &error_), HL_OK) << error_.what();
    }
    template <class T>
    std::vector<T> filled(std::uint32_t buffer) {
        hl_gpu_buffer_info info{};
        info.size = sizeof info;
        EXPECT_EQ(hl_gpu_buffer(asset_.get(), buffer, &info, &error_), HL_OK) << error_.what();
        EXPECT_EQ(info.bytes % sizeof(T), 0u);
        std::vector<T> values(info.bytes / sizeof(T));
        EXPECT_EQ(hl_gpu_fill(asset_.get(), buffer, values.data(), info.bytes, &error_), HL_OK)
            << error_.what();
        return values;
    }

    const TemporaryFolder folder_;
    ExportReport report_;
    std::vector<std::byte> bytes_;
    game::Asset asset_;
    game::Error error_;
};

TEST_F(HairLooksTest, EachHairHasTheStreaksDyeAndPigmentOfPictures) {
    const Groom groom = streaked();
    write(groom);
    const auto bindings = bindFollowHairs(groom, groom.interpolation).value();
    const LookWeights weights = weightsOfFollowHairs(groom, bindings).value();
    ASSERT_FALSE(weights.streaks.empty() || weights.dyes.empty() || weights.pigments.empty() ||
                 weights.lengths.empty());
    const auto shades = filled<shaders::HairShade>(HL_GPU_BUFFER_SHADES);
    const auto numbers = filled<std::uint32_t>(HL_GPU_BUFFER_NUMBERS);
    ASSERT_EQ(shades.size(), bindings.hairCount());
    std::size_t inStreaks = 0, white = 0;
    for (std::size_t h = 0; h < shades.size(); ++h) {
        const shaders::HairShade& shade = shades[h];
        const std::uint32_t number = numbers[h];
        EXPECT_EQ(shade.number, number);
        EXPECT_EQ(shade.material, 0u);
        EXPECT_NEAR(shade.streak, weights.streaks[number], 1e-5f);
        EXPECT_NEAR(shade.dye, weights.dyes[number], 1e-5f);
        EXPECT_NEAR(shade.pigment, weights.pigments[number], 1e-4f);
        EXPECT_NEAR(shade.length, weights.lengths[number], 4e-5f);
        EXPECT_EQ(shade.own, 0);
        inStreaks += shade.streak > 0.5f ? 1 : 0;
        white += shade.pigment == 0 ? 1 : 0;
    }
    EXPECT_GT(inStreaks, shades.size() / 10);
    EXPECT_GT(white, shades.size() / 20);
}

TEST_F(HairLooksTest, MaterialsAreThoseOfPictures) {
    Groom groom = streaked();
    HairMaterial brows = groom.material;
    brows.shadingModel = ShadingModel::kajiya;
    brows.rootColour = Vec3f(0.1f, 0.2f, 0.3f);
    brows.streakShare = 0;
    groom.layers = {{"Base", true, false, 1, {}}, {"Brows", true, false, 1, brows}};
    std::vector<std::uint32_t> layers;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) layers.push_back(s % 2);
    groom.strandAttributes.set(attribute::kLayer, layers);
    write(groom);
    const auto materials = filled<shaders::HairMaterial>(HL_GPU_BUFFER_MATERIALS);
    ASSERT_EQ(materials.size(), 2u);
    const StrandMaterials shown = strandMaterials(groom, ViewFile{});
    const shaders::HairMaterial &base = materials[0], &other = materials[1];
    EXPECT_EQ(base.model, 1u);
    EXPECT_EQ(base.look.absorbs, 1u);
    EXPECT_NEAR(static_cast<double>(base.look.root.y), shown.material.look->root.y(), 1e-6);
    EXPECT_NEAR(static_cast<double>(base.look.streakTip.z), shown.material.look->streakTip.z(), 1e-6);
    EXPECT_NEAR(static_cast<double>(base.tilts.x), shown.material.fibre.marschner.tilt[0], 1e-6);
    EXPECT_NEAR(static_cast<double>(base.widths.z), shown.material.fibre.marschner.width[2], 1e-6);
    EXPECT_GT(base.scales.w, 0.1f) << "clumping";
    EXPECT_LE(base.scales.w, 1.5f);
    EXPECT_EQ(other.model, 0u);
    EXPECT_EQ(other.look.absorbs, 0u);
    EXPECT_FLOAT_EQ(other.look.root.z, 0.3f);
    EXPECT_FLOAT_EQ(other.primary.w, shown.others[0].primaryExponent);
    EXPECT_EQ(filled<float>(HL_GPU_BUFFER_TABLES).size(), std::size_t{HAIR_TABLE_FLOATS})
        << "of one material alone";
    const auto shades = filled<shaders::HairShade>(HL_GPU_BUFFER_SHADES);
    const std::vector<std::uint32_t> strands = materialsOfStrands(groom);
    const auto bindings = bindFollowHairs(groom, groom.interpolation).value();
    for (const shaders::HairShade& shade : shades)
        EXPECT_EQ(shade.material, strands[bindings.guideStrands[bindings.guides[shade.number][0]]]);
}

TEST_F(HairLooksTest, TablesAreOnlyWhereAMaterialHasUseForThem) {
    Groom groom = smallHead();
    groom.interpolation.followPerGuide = 3;
    write(groom);
    const std::size_t plain = bytes_.size();
    EXPECT_EQ(filled<float>(HL_GPU_BUFFER_TABLES), std::vector<float>{0}) << "something to bind";
    const auto materials = filled<shaders::HairMaterial>(HL_GPU_BUFFER_MATERIALS);
    ASSERT_EQ(materials.size(), 1u);
    EXPECT_EQ(materials[0].model, 0u);
    for (const shaders::HairShade& shade : filled<shaders::HairShade>(HL_GPU_BUFFER_SHADES)) {
        EXPECT_EQ(shade.pigment, 1);
        EXPECT_EQ(shade.streak + shade.dye, 0);
    }
    groom.material.shadingModel = ShadingModel::sadeghi;
    write(groom);
    EXPECT_GT(bytes_.size(), plain + 2 * HAIR_TABLE_FLOATS - 64);
    EXPECT_TRUE(std::ranges::any_of(report_.findings, [](const Finding& finding) {
        return finding.what.find("Sadeghi") != std::string::npos;
    }));
}

TEST_F(HairLooksTest, TheSameOnAnyNumberOfCores) {
    const Groom groom = streaked();
    setThreadCount(1);
    const HairLooks first = hairLooks(groom).value();
    setThreadCount(3);
    const HairLooks second = hairLooks(groom).value();
    setThreadCount(0);
    EXPECT_EQ(first.tables, second.tables);
    ASSERT_EQ(first.hairs.size(), second.hairs.size());
    EXPECT_EQ(std::memcmp(first.hairs.data(), second.hairs.data(), 8 * first.hairs.size()), 0);
    ASSERT_EQ(first.materials.size(), second.materials.size());
    EXPECT_EQ(std::memcmp(first.materials.data(), second.materials.data(),
                          sizeof first.materials[0] * first.materials.size()),
              0);
}

}  // namespace
}  // namespace hairloom::test
