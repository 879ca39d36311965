// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of USD: faces, values of corners, parts, units and axes, and what is odd about skins.

#include <gmock/gmock.h>

#include <cmath>

#include "core/animation/actor.h"
#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kStart = "#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n";

/// A quad and a triangle of five points, with what else stands in it.
std::string mesh(const std::string& name, const std::string& more = {}, const std::string& faces = "[4, 3]",
                 const std::string& indices = "[0, 1, 2, 3, 1, 4, 2]") {
    return "def Mesh \"" + name + "\"\n{\n    int[] faceVertexCounts = " + faces +
           "\n    int[] faceVertexIndices = " + indices +
           "\n    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)]\n" + more +
           "\n}\n";
}

class UsdHeads : public MeshFiles {
  protected:
    ImportedScene read(const std::string& text) const { return imported("head.usda", text); }
};

TEST_F(UsdHeads, FacesPartsAndTextureCoordinatesComeIn) {
    const std::string subset =
        "    def GeomSubset \"lips\"\n    {\n        uniform token elementType = \"face\"\n"
        "        uniform token familyName = \"parts\"\n        int[] indices = [1]\n    }\n";
    const ImportedScene scene = read(
        kStart +
        mesh("face",
             "    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1)] (interpolation = \"faceVarying\")\n"
             "    int[] primvars:st:indices = [0, 1, 2, 0, 1, 1, 2]\n" +
                 subset) +
        mesh("hat",
             "    double3 xformOp:translate = (0, 0, 1)\n"
             "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    rel material:binding = "
             "</mat/felt>\n"));
    EXPECT_EQ(scene.mesh.triangleCount(), 6u);
    EXPECT_THAT(scene.mesh.groupNames(), ElementsAre("lips", "face", "hat"));
    EXPECT_THAT(scene.mesh.materialNames(), ElementsAre("default", "felt"));
    EXPECT_EQ(scene.mesh.triangleGroups()[2], 0u) << "the triangle is the subset's";
    ASSERT_EQ(scene.mesh.cornerUvs().size(), 18u);
    EXPECT_EQ(scene.mesh.cornerUvs()[8], Vec2f(1, 1));
    EXPECT_THAT(warningsOf(scene), HasSubstr("1 meshes have no texture coordinates"));
    EXPECT_TRUE(scene.statesUnit && scene.statesUp);
    EXPECT_FLOAT_EQ(scene.mesh.bounds().max().z(), 1);
}

TEST_F(UsdHeads, OrientationHolesAndBadFacesAreSeen) {
    const auto z = [](const ImportedScene& scene) { return scene.mesh.triangleNormal(0).z(); };
    EXPECT_FLOAT_EQ(z(read(kStart + mesh("a"))), 1);
    EXPECT_FLOAT_EQ(z(read(kStart + mesh("a", "    uniform token orientation = \"leftHanded\"\n"))), -1);
    const std::string mirror =
        "    double3 xformOp:scale = (-1, 1, 1)\n    uniform token[] xformOpOrder = [\"xformOp:scale\"]\n";
    EXPECT_FLOAT_EQ(z(read(kStart + mesh("a", mirror))), 1) << "outside stays outside";
    const ImportedScene holed = read(kStart + mesh("a", "    int[] holeIndices = [0, 77, -1]\n"));
    EXPECT_EQ(holed.mesh.triangleCount(), 1u);
    EXPECT_THAT(warningsOf(holed), HasSubstr("1 faces that are holes"));
    const ImportedScene some = read(kStart + mesh("good") + mesh("beyond", "", "[3]", "[0, 1, 9]") +
                                    mesh("few", "", "[4]", "[0, 1]") + mesh("negative", "", "[-3]", "[]") +
                                    mesh("none", "", "[]", "[]"));
    EXPECT_EQ(some.mesh.triangleCount(), 3u);
    EXPECT_THAT(warningsOf(some), HasSubstr("/beyond has a face that refers to point 9 of 5"));
    const std::string refused = refusal("none.usda", kStart + mesh("beyond", "", "[3]", "[0, 1, 9]"));
    EXPECT_THAT(refused, HasSubstr("refers to point 9"));
    EXPECT_THAT(refusal("huge.usda", kStart + mesh("huge", "", "[2147483647, 2147483647]", "[0, 1, 2]")),
                HasSubstr("faces of more corners than indices"));
}

TEST_F(UsdHeads, UnitsAndAxesAreThoseOfTheStageOrOfItsFormat) {
    const ImportedScene laid =
        read("#usda 1.0\n(\n    metersPerUnit = 0.1\n    upAxis = \"Z\"\n)\n" + mesh("a"));
    EXPECT_FLOAT_EQ(laid.mesh.bounds().sizes().x(), 0.2f);
    EXPECT_NEAR(laid.mesh.triangleNormal(0).y(), 1, 1e-6f);
    const ImportedScene unsaid = read("#usda 1.0\n" + mesh("a"));
    EXPECT_FALSE(unsaid.statesUnit);
    EXPECT_FLOAT_EQ(unsaid.metresPerUnit, 0.01f);
    EXPECT_THAT(warningsOf(unsaid), HasSubstr("states no unit"));
    const auto asked = importScene(folder / "head.usda", {0.1f});
    ASSERT_TRUE(asked);
    EXPECT_FLOAT_EQ(asked->metresPerUnit, 0.1f);
}

/// Two joints above each other, `weights` of a mesh bound to them.
std::string skinned(const std::string& weights, const std::string& skeleton, const std::string& more = {}) {
    return kStart + std::string("def SkelRoot \"c\"\n{\n    def Skeleton \"s\"\n    {\n") + skeleton +
           "    }\n" + mesh("m", "    rel skel:skeleton = </c/s>\n" + weights) + more + "}\n";
}
const std::string kJoints =
    "        uniform token[] joints = [\"root\", \"root/head\"]\n"
    "        uniform matrix4d[] restTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), "
    "((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,1,0,1))]\n"
    "        uniform matrix4d[] bindTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), "
    "((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,1,0,1))]\n";
const std::string kRigid =
    "    int[] primvars:skel:jointIndices = [1] (interpolation = \"constant\"\n elementSize = 1)\n"
    "    float[] primvars:skel:jointWeights = [1] (interpolation = \"constant\"\n elementSize = 1)\n";

TEST_F(UsdHeads, OddSkinsAreReadAsFarAsTheyGo) {
    const ImportedScene rigid = read(skinned(kRigid, kJoints));
    ASSERT_EQ(rigid.skeleton.bones().size(), 2u);
    EXPECT_EQ(rigid.skeleton.bones()[1].name, "head");
    EXPECT_EQ(rigid.skeleton.bones()[1].parent, 0u);
    ASSERT_EQ(rigid.skin.vertexCount(), rigid.mesh.vertexCount());
    EXPECT_EQ(rigid.skin.bones[0][0], 1u);
    EXPECT_TRUE(rigid.clips.empty()) << "a skeleton that nothing moves has no clip";
    const ImportedScene odd = read(
        skinned("    int[] primvars:skel:jointIndices = [0, 1, 1, 1, 7, 0, -1, 0, 0, 1] (interpolation = "
                "\"vertex\"\n "
                "elementSize = 2)\n"
                "    float[] primvars:skel:jointWeights = [1, 1, 2, 2, 1, 0, 1, 0, -1, nan] (interpolation = "
                "\"vertex\"\n elementSize = 2)\n",
                kJoints));
    EXPECT_FLOAT_EQ(odd.skin.weights[0][0], 0.5f) << "weights add up to 1";
    EXPECT_FLOAT_EQ(odd.skin.weights[1][0], 1) << "a joint that is named twice is one";
    EXPECT_THAT(warningsOf(odd), HasSubstr("2 weights name joints that there are not"));
    EXPECT_THAT(warningsOf(odd), HasSubstr("2 weights are negative or no numbers"));
    EXPECT_THAT(warningsOf(odd), HasSubstr("3 points have no weights"));
    for (const auto& [weights, skeleton, word] : std::vector<std::array<std::string, 3>>{
             {"    int[] primvars:skel:jointIndices = [0]\n    float[] primvars:skel:jointWeights = [1, 0]\n",
              kJoints, "1 joint indices and 2 weights"},
             {kRigid, "        uniform token[] joints = []\n", "has no joints"},
             {kRigid, "        uniform token[] joints = [\"a\"]\n", "neither rest nor bind transforms"},
             {kRigid + "    rel skel:skeleton = </nowhere>\n", kJoints, "/nowhere"}}) {
        const ImportedScene plain = read(skinned(weights, skeleton));
        EXPECT_TRUE(plain.skeleton.empty()) << word;
        EXPECT_THAT(warningsOf(plain), HasSubstr(word));
    }
    const ImportedScene outside = read(kStart + std::string("def Skeleton \"s\"\n{\n") + kJoints + "}\n" +
                                       mesh("m", "    rel skel:skeleton = </s>\n" + kRigid));
    EXPECT_THAT(warningsOf(outside), HasSubstr("lies in no SkelRoot"));
}

TEST_F(UsdHeads, InstancesOfACharacterHaveSkeletonsOfTheirOwn) {
    const std::string turning =
        "    def SkelAnimation \"nod\"\n    {\n        uniform token[] joints = [\"root/head\"]\n"
        "        float3[] translations = [(0, 1, 0)]\n        half3[] scales = [(1, 1, 1)]\n"
        "        quatf[] rotations.timeSamples = {\n            10: [(1, 0, 0, 0)],\n            34: "
        "[(0.7071068, "
        "0, 0, 0.7071068)],\n        }\n    }\n";
    std::string character =
        skinned(kRigid, kJoints + "        rel skel:animationSource = </c/nod>\n", turning);
    const ImportedScene twice = read(character +
                                     "def \"d\" (\n    instanceable = true\n    references = </c>\n)\n{\n"
                                     "    double3 xformOp:translate = (0, 0, 5)\n"
                                     "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n");
    ASSERT_EQ(twice.skeleton.bones().size(), 4u);
    ASSERT_EQ(twice.clips.size(), 1u);
    EXPECT_FLOAT_EQ(twice.clips[0].duration, 1);
    EXPECT_EQ(twice.clips[0].channels.size(), 2u);
    const auto actor =
        Actor::make(std::make_shared<const ScalpMesh>(twice.mesh), twice.skeleton, twice.clips, twice.skin);
    ASSERT_TRUE(actor) << actor.error().message();
    // A quarter about Z through (0, 1, z): (2, 0) goes to (1, 3).
    std::size_t found = 0;
    for (const Vec3f& p : actor->poseAt(0, 1, Wrap::Clamp).positions_ws)
        found += (p - Vec3f(1, 3, 0)).norm() < 1e-5f || (p - Vec3f(1, 3, 5)).norm() < 1e-5f;
    EXPECT_EQ(found, 2u);
}

TEST_F(UsdHeads, TransformsThatChangeMoveTheHead) {
    const ImportedScene scene = read(
        std::string("#usda 1.0\n(\n    metersPerUnit = 1\n    startTimeCode = 1\n    endTimeCode = 25\n)\n") +
        "def Xform \"body\"\n{\n    float xformOp:rotateY.timeSamples = {\n        1: 0,\n        25: 350,\n "
        "   }\n"
        "    uniform token[] xformOpOrder = [\"xformOp:rotateY\"]\n" +
        mesh("head") + "}\n");
    ASSERT_EQ(scene.skeleton.bones().size(), 1u);
    EXPECT_EQ(scene.skeleton.bones()[0].name, "body");
    ASSERT_EQ(scene.clips.size(), 1u);
    const auto actor =
        Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton, scene.clips, scene.skin);
    ASSERT_TRUE(actor) << actor.error().message();
    for (const float time : {0.0f, 0.21f, 0.5f, 0.83f, 1.0f}) {
        const float angle = radians(350 * time);
        const Vec3f expected(std::cos(angle), 0, -std::sin(angle));
        EXPECT_LT((actor->poseAt(0, time, Wrap::Clamp).positions_ws[1] - expected).norm(), 2e-5f) << time;
    }
}

}  // namespace
}  // namespace hairloom::test
