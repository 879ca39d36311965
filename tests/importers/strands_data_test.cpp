// SPDX-License-Identifier: GPL-3.0-or-later
// Strand files from elsewhere.

#include <gtest/gtest.h>

#include "tests/importers/strands_files.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

fs::path dataFile(const char* name) {
    return outsideData() / "strands" / name;
}

#define NEED_DATA(path) \
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not there"

void expectUniform(const Groom& groom, std::size_t strands, std::size_t points) {
    ASSERT_EQ(groom.strandCount(), strands);
    for (std::size_t s = 0; s < strands; ++s) ASSERT_EQ(groom.strand(s).size(), points) << s;
}

bool hasSizeWarning(const ImportedStrands& imported) {
    return std::any_of(imported.warnings.begin(), imported.warnings.end(),
                       [](const Finding& finding) { return finding.where == "size"; });
}

TEST(StrandsData, SintelTfx) {
    const auto path = dataFile("sintel_16pt.tfx");
    NEED_DATA(path);
    const auto imported = importStrands(path);
    ASSERT_TRUE(imported) << imported.error().message();
    expectUniform(imported->groom, 11400, 16);
    EXPECT_TRUE(imported->dropped.empty());
    EXPECT_FALSE(hasSizeWarning(*imported));
}

TEST(StrandsData, SintelHairInTenthsOfAnInchZUp) {
    const auto path = dataFile("sintel_uniform_zup.hair");
    const auto original = dataFile("sintel_16pt.tfx");
    NEED_DATA(path);
    StrandImportOptions options;
    options.metresPerUnit = 0.00254f;
    options.up = UpAxis::Z;
    const auto imported = importStrands(path, options);
    ASSERT_TRUE(imported) << imported.error().message();
    expectUniform(imported->groom, 2850, 16);
    EXPECT_FALSE(hasSizeWarning(*imported));
    // It was made from part of the .tfx with its X axis forward, which leaves a quarter turn about the
    // vertical.
    const auto whole = importStrands(original);
    ASSERT_TRUE(whole);
    const Vec3f found = imported->groom.strand(0)[7];
    const Vec3f turned(-found.z(), found.y(), found.x());
    float nearest = 1;
    for (std::size_t s = 0; s < whole->groom.strandCount(); ++s) {
        nearest = std::min(nearest, (whole->groom.strand(s)[7] - turned).norm());
    }
    EXPECT_LT(nearest, 1e-5f);

    const auto asMetres = importStrands(path);
    ASSERT_TRUE(asMetres);
    EXPECT_TRUE(hasSizeWarning(*asMetres));
}

TEST(StrandsData, BearTfxVersion3) {
    const auto path = dataFile("bear_v3.tfx");
    NEED_DATA(path);
    const auto imported = importStrands(path);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "TressFX 3");
    EXPECT_EQ(imported->groom.strandCount() + imported->dropped.size(), 48113u);
    EXPECT_TRUE(hasSizeWarning(*imported));
    StrandImportOptions options;
    options.metresPerUnit = 0.01f;
    const auto asCentimetres = importStrands(path, options);
    ASSERT_TRUE(asCentimetres);
    EXPECT_FALSE(hasSizeWarning(*asCentimetres));
}

TEST(StrandsData, PastaLinesInDescendingOrder) {
    const auto path = dataFile("pasta_1k.obj");
    NEED_DATA(path);
    const auto imported = importStrands(path);
    ASSERT_TRUE(imported) << imported.error().message();
    expectUniform(imported->groom, 2155, 41);
    // The first line is "l 41 40 … 1", and vertex 1 is at the top.
    EXPECT_EQ(imported->groom.strand(0).back(), Vec3f(9.98531246f, 25.5f, -0.526492774f));
}

TEST(StrandsData, BlenderPolylines) {
    for (const char* name : {"blender/synthetic_legacy_poly.obj", "blender/synthetic_poly_as_mesh.obj",
                             "blender/synthetic_legacy_poly_curv.obj"}) {
        const auto path = dataFile(name);
        NEED_DATA(path);
        const auto imported = importStrands(path);
        ASSERT_TRUE(imported) << imported.error().message();
        EXPECT_EQ(imported->groom.strandCount(), 12u) << name;
        EXPECT_EQ(imported->groom.strand(0).front(), Vec3f(0, 0, -0.003f)) << name;
    }
}

}  // namespace
}  // namespace hairloom
