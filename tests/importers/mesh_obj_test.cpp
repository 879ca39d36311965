// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/obj_mesh.h"

#include <gmock/gmock.h>

#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

RawScene read(const std::string& text) {
    auto scene = readObjMesh("x.obj", text);
    EXPECT_TRUE(scene) << scene.error().message();
    return scene ? *scene : RawScene();
}

std::string refusal(const std::string& text) {
    const auto scene = readObjMesh("x.obj", text);
    EXPECT_FALSE(scene);
    return scene ? std::string() : scene.error().message();
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ObjMesh, KeepsFaceOrderAndMergesGroupsOfOneName) {
    const RawScene scene =
        read(kSquare +
             "f 1 2 3\ng body\nf 1 2 3 4\no head\nf 2 3 4\ng scalp top\nf 3 4 1\ng body\nusemtl skin\n"
             "f 4 1 2\n");
    EXPECT_THAT(scene.soup.groupNames, ElementsAre("default", "body", "head", "scalp top"));
    EXPECT_THAT(scene.soup.faceGroups, ElementsAre(0, 1, 2, 3, 1));
    EXPECT_THAT(scene.soup.materialNames, ElementsAre("default", "skin"));
    EXPECT_THAT(scene.soup.faceMaterials, ElementsAre(0, 0, 0, 0, 1));
    EXPECT_THAT(scene.soup.offsets, ElementsAre(0, 3, 7, 10, 13, 16));
    EXPECT_EQ(scene.soup.positions.size(), 4u) << "positions stay shared";
}

TEST(ObjMesh, IndicesCountBackwardsFromWhereTheyStand) {
    const RawScene scene = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -3 -1\n");
    EXPECT_THAT(scene.soup.corners, ElementsAre(0, 1, 2, 0, 1, 3));
    EXPECT_THAT(refusal("v 0 0 0\nf -2 -1 -1\n"), HasSubstr("x.obj:2: found '-2'"));
}

TEST(ObjMesh, ReadsEveryFormOfCorner) {
    const RawScene scene =
        read(kSquare + "vt 0.25 0.75\nvt 1 1 0\nvn 0 0 2\nf 1/1/1 2/2/1 3/1/1\nf 1/2/1 3/2/1 4/1/1\n");
    ASSERT_EQ(scene.soup.uvs.size(), 6u);
    EXPECT_EQ(scene.soup.uvs[0], Vec2f(0.25f, 0.75f));
    EXPECT_EQ(scene.soup.uvs[3], Vec2f(1, 1));
    ASSERT_EQ(scene.soup.normals.size(), 6u);
    EXPECT_EQ(scene.soup.normals[5], Vec3f(0, 0, 2));
    const RawScene mixed = read(kSquare + "vt 0.5 0.5\nvn 0 0 1\nf 1/1 2// 3//1 4/\n");
    EXPECT_TRUE(mixed.soup.normals.empty()) << "corners without a normal leave none";
    EXPECT_EQ(mixed.soup.uvs.size(), 4u);
    EXPECT_THAT(mixed.warnings, ElementsAre(HasSubstr("3 of 4 corners")));
}

TEST(ObjMesh, LinesMayContinueEndAnyhowAndCarryComments) {
    EXPECT_EQ(read("v 0 0 0 # origin\r\nv 1 \\\r\n 0 0\r\nv 0 1 0\r\nf 1 2 \\\r\n3").soup.corners.size(), 3u);
    EXPECT_EQ(read("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3").soup.corners.size(), 3u);
    EXPECT_EQ(read("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\\").soup.corners.size(), 3u);
    EXPECT_THAT(refusal("v 0 0 0\nv 1 \\\n0 0\n\nf 1 2 x\n"), HasSubstr("x.obj:5: found 'x'"));
}

TEST(ObjMesh, NumbersAreReadAsWrittenOrRefused) {
    const RawScene scene = read("v +1 -2. 3.5e1\nv 1e-400 .5 0\nv 0 0 1 0.5 nan 0.5\nf 1 2 3\n");
    EXPECT_EQ(scene.soup.positions[0], Vec3f(1, -2, 35));
    EXPECT_EQ(scene.soup.positions[1], Vec3f(0, 0.5f, 0));
    for (const char* bad : {"nan", "inf", "1e400", "1,5", "0x10", "1.2.3", "--1", ""}) {
        EXPECT_THAT(refusal(std::string("v 0 0 ") + bad + "\nf 1 1 1\n"), HasSubstr("x.obj:1: found")) << bad;
    }
}

TEST(ObjMesh, InvalidIndicesAreReportedWithTheirLine) {
    EXPECT_THAT(refusal(kSquare + "f 1 2 5\n"),
                HasSubstr("x.obj:5: a face refers to vertex 5; the file has 4 vertices"));
    EXPECT_THAT(refusal(kSquare + "f 0 1 2\n"), HasSubstr("x.obj:5: found '0'"));
    EXPECT_THAT(refusal(kSquare + "f 1 2 99999999999999999999\n"), HasSubstr("x.obj:5"));
    EXPECT_EQ(read(kSquare + "f 5 2 3\nv 7 7 7\n").soup.corners[0], 4u) << "a vertex may come after its face";
}

TEST(ObjMesh, FacesOfTwoCornersAreLeftOutAndCounted) {
    const RawScene scene = read(kSquare + "f 1 2\nf\nf 1 2 3\n");
    EXPECT_THAT(scene.soup.offsets, ElementsAre(0, 3));
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("2 faces with fewer than three corners")));
}

using ObjFile = MeshFiles;

TEST_F(ObjFile, WhatIsNoMeshIsRefusedByName) {
    EXPECT_THAT(MeshFiles::refusal("points.obj", kSquare), HasSubstr("has no faces (4 points)"));
    EXPECT_THAT(MeshFiles::refusal("lines.obj", kSquare + "l 1 2 3 4\n"), HasSubstr("has no faces"));
    EXPECT_THAT(MeshFiles::refusal("wide.obj", std::string("\xff\xfev\0 \0", 6)), HasSubstr("UTF-16"));
    EXPECT_THAT(MeshFiles::refusal("none.obj", ""), HasSubstr("is empty"));
}

TEST_F(ObjFile, MissingMaterialFileIsAWarning) {
    const auto missing = import("a.obj", "mtllib gone.mtl\n" + kSquare + "usemtl skin\nf 1 2 3 4\n");
    ASSERT_TRUE(missing);
    EXPECT_THAT(missing->warnings, ElementsAre(HasSubstr("'gone.mtl' was not found")));
    EXPECT_THAT(missing->mesh.materialNames(), ElementsAre("skin"));
    write("here.mtl", "newmtl skin\n");
    EXPECT_TRUE(import("b.obj", "mtllib here.mtl\n" + kSquare + "f 1 2 3 4\n")->warnings.empty());
}

TEST_F(ObjFile, AnImplausibleSizeNamesTheUnitThatWouldFit) {
    const auto head = [](const std::string& size) {
        return "v 0 0 0\nv " + size + " 0 0\nv 0 " + size + " 0\nf 1 2 3\n";
    };
    const auto warningOf = [&](const std::string& size) {
        const auto scene = import("head.obj", head(size));
        return scene && !scene->warnings.empty() ? scene->warnings.front() : std::string();
    };
    EXPECT_EQ(warningOf("0.25"), "");
    EXPECT_EQ(warningOf("1.8"), "");
    EXPECT_THAT(warningOf("17"), HasSubstr("unit dm"));
    EXPECT_THAT(warningOf("175"), HasSubstr("unit cm"));
    EXPECT_THAT(warningOf("250"), HasSubstr("unit mm"));
    EXPECT_THAT(warningOf("69"), HasSubstr("unit inch"));
    EXPECT_THAT(warningOf("1e6"), HasSubstr("No unit"));
    MeshImportOptions decimetres;
    decimetres.metresPerUnit = 0.1f;
    const auto scene = importScene(write("human.obj", head("17")), decimetres);
    ASSERT_TRUE(scene);
    EXPECT_TRUE(scene->warnings.empty());
    EXPECT_NEAR(scene->mesh.bounds().sizes().x(), 1.7f, 1e-6f);
    EXPECT_EQ(scene->metresPerUnit, 0.1f);
}

TEST_F(ObjFile, NamesAreMadeFitForJson) {
    const auto scene = import("a.obj", kSquare + "g kopf\xc3\xa4\xff\x01\nf 1 2 3 4\n");
    ASSERT_TRUE(scene);
    EXPECT_THAT(scene->mesh.groupNames(), ElementsAre("kopf\xc3\xa4??"));
}

}  // namespace
}  // namespace hairloom::test
