// SPDX-License-Identifier: GPL-3.0-or-later
// Small files of the kinds that people's hair lies in, written by Blender 5.3, the Alembic library and
// gltfpack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/base/file.h"
#include "importers/scene.h"
#include "importers/strands.h"
#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

class FieldData : public testing::Test {
  protected:
    void SetUp() override {
        folder = outsideData() / "field";
        if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no data from elsewhere";
    }
    ImportedStrands read(const std::string& name, const StrandImportOptions& options = {}) const {
        auto imported = importStrands(folder / name, options);
        EXPECT_TRUE(imported) << name << ": " << imported.error().message();
        return imported ? std::move(*imported) : ImportedStrands();
    }
    ImportedStrands record(const std::string& name, float framesPerSecond = 0) const {
        StrandImportOptions options;
        options.frames = true;
        options.framesPerSecond = framesPerSecond;
        return read(name, options);
    }
    std::filesystem::path folder;
};

TEST_F(FieldData, ReconstructedHairComesIn) {
    EXPECT_EQ(read("points_100_a_strand.ply").groom.strandCount(), 24u);
    StrandImportOptions fifty;
    fifty.pointsPerStrand = 50;
    EXPECT_EQ(read("points_100_a_strand.ply", fifty).groom.strandCount(), 48u);
    EXPECT_EQ(read("counted_strands.data").groom.strandCount(), 11u);
    const auto seven = read("seven_floats_a_point.bin");
    EXPECT_EQ(seven.groom.strandCount(), 6u);
    EXPECT_TRUE(seven.groom.pointAttributes.has("label"));
    EXPECT_EQ(read("tressfx2_text.tfx").groom.strandCount(), 20u);
    const auto ribbons = read("ribbons_of_unlike_length.obj");
    EXPECT_EQ(ribbons.groom.strandCount(), 20u);
    ASSERT_TRUE(ribbons.ribbons);
    EXPECT_EQ(ribbons.ribbons->fewestSegments, 3u);
    EXPECT_EQ(ribbons.ribbons->mostSegments, 11u);
}

TEST_F(FieldData, AlembicInstancesStandInTheirPlaces) {
    const auto imported = read("instances.abc");
    ASSERT_EQ(imported.groom.strandCount(), 2u);
    const Vec3f apart = imported.groom.strand(1)[0] - imported.groom.strand(0)[0];
    EXPECT_EQ(apart, Vec3f(0, 5, 0));
}

TEST_F(FieldData, AlembicObjectsHaveTheirOwnGroups) {
    const auto imported = read("group_id_on_object.abc");
    EXPECT_EQ(imported.groom.groupNames.size(), 2u);
    const auto groups = imported.groom.strandAttributes.view<std::uint32_t>(attribute::kGroup);
    ASSERT_EQ(groups.size(), imported.groom.strandCount());
    EXPECT_EQ(std::set<std::uint32_t>(groups.begin(), groups.end()).size(), 2u);
    const auto& names = imported.groom.groupNames;
    EXPECT_TRUE(std::ranges::find(names, "group 0") != names.end());
    EXPECT_TRUE(std::ranges::find(names, "group 3") != names.end());
    ASSERT_EQ(imported.groom.layers.size(), 2u);
    EXPECT_EQ(imported.groom.layers[0].name, "fringe");
    EXPECT_EQ(imported.groom.layers[1].name, "main");
}

TEST_F(FieldData, EachPropertyIsLookedUpByTime) {
    const auto still = record("points_still_transform_24hz.abc");
    EXPECT_FLOAT_EQ(still.framesPerSecond, 24);
    EXPECT_EQ(still.frames.size(), 4u);
    EXPECT_FALSE(still.isResampled);
    // Five frames at 24 a second in both, whatever has samples within a frame.
    for (const char* name : {"blender_xsamples2.abc", "blender_gsamples2.abc"}) {
        const auto imported = record(name);
        EXPECT_FLOAT_EQ(imported.framesPerSecond, 24) << name;
        ASSERT_EQ(imported.frames.size(), 5u) << name;
        // The object moves by the time: one unit a second.
        const Vec3f moved = imported.frames[4][0] - imported.frames[0][0];
        EXPECT_NEAR(moved.norm(), 4 / 24.0f, 1e-5f) << name;
    }
    const auto fine = record("blender_xsamples2.abc", 48);
    ASSERT_EQ(fine.frames.size(), 10u);
    EXPECT_NEAR((fine.frames[7][0] - fine.frames[0][0]).norm(), 3.5f / 24, 1e-5f)
        << "half a frame before the end";
}

TEST_F(FieldData, UnevenTimesBecomeEvenOnesAndSaySo) {
    const auto imported = record("uneven_times.abc");
    EXPECT_FLOAT_EQ(imported.framesPerSecond, 20);
    ASSERT_EQ(imported.frames.size(), 9u);
    EXPECT_TRUE(imported.isResampled);
    const auto said = std::ranges::find(imported.warnings, "time", &Finding::where);
    ASSERT_NE(said, imported.warnings.end());
    EXPECT_THAT(said->what, testing::HasSubstr("at uneven times"));
    // Between the samples at 0.15 and 0.4 s all goes straight.
    const Vec3f begin = imported.frames[3][1], end = imported.frames[8][1];
    for (int f = 4; f < 8; ++f) {
        const float t = static_cast<float>(f - 3) / 5;
        EXPECT_LT((imported.frames[static_cast<std::size_t>(f)][1] - (begin + t * (end - begin))).norm(),
                  1e-6f);
    }
    const auto asked = record("uneven_times.abc", 60);
    EXPECT_EQ(asked.frames.size(), 25u);
}

TEST_F(FieldData, MeshoptIsUnpacked) {
    const auto plain = importScene(folder / "head.obj");
    const auto packed = importScene(folder / "head_meshopt.glb");
    ASSERT_TRUE(plain) << plain.error().message();
    ASSERT_TRUE(packed) << packed.error().message();
    EXPECT_EQ(packed->mesh.triangleCount(), 1080u);
    // Fourteen bits of a head.
    EXPECT_LT((packed->mesh.bounds().min() - plain->mesh.bounds().min()).norm(), 1e-3f);
    EXPECT_LT((packed->mesh.bounds().max() - plain->mesh.bounds().max()).norm(), 1e-3f);
}

TEST_F(FieldData, DamagedMeshoptIsSaid) {
    const auto whole = readFile(folder / "head_meshopt.glb");
    ASSERT_TRUE(whole);
    const TemporaryFolder own;
    const auto file = own / "damaged.glb";
    std::size_t refused = 0;
    for (std::size_t at = whole->size() - 4700; at < whole->size(); at += 450) {
        std::vector<std::byte> changed = *whole;
        for (std::size_t i = at; i < std::min(at + 40, changed.size()); ++i) changed[i] ^= std::byte{0xff};
        ASSERT_TRUE(writeFileAtomically(file, std::span<const std::byte>(changed)));
        refused += importScene(file) ? 0 : 1;
    }
    EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace hairloom
