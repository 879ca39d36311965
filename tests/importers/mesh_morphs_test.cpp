// SPDX-License-Identifier: GPL-3.0-or-later
// Morph targets that clips move: glTF in the ways that it can say them, FBX, and what does not fit.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/animation/actor.h"
#include "tests/importers/gltf_files.h"
#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A square of 0.2 m that looks up, two triangles.
const std::vector<float> kSquare{0, 0, 0, 0.2f, 0, 0, 0, 0, -0.2f, 0.2f, 0, -0.2f};
const std::vector<std::uint16_t> kCorners{0, 1, 2, 1, 3, 2};

class MeshMorphs : public MeshFiles {
  protected:
    MeshMorphs() {
        const int positions = buffer.view(kSquare), corners = buffer.view(kCorners);
        add(accessor(positions, kFloat, 4, "VEC3"));
        add(accessor(corners, kUnsignedShort, 6, "SCALAR"));
    }
    /// The number of an accessor.
    int add(const std::string& accessor) {
        accessors_ += (accessors_.empty() ? "" : ",") + accessor;
        return count_++;
    }
    int floats(const std::vector<float>& values, const char* type, std::size_t components) {
        return add(accessor(buffer.view(values), kFloat, values.size() / components, type));
    }
    /// Offsets that lift these corners by a metre each, others not at all.
    int lift(const std::vector<int>& corners, int count = 4) {
        std::vector<float> values(static_cast<std::size_t>(count) * 3);
        for (const int corner : corners) values[static_cast<std::size_t>(corner) * 3 + 1] = 1;
        return floats(values, "VEC3", 3);
    }
    static std::string primitive(const std::vector<int>& targets) {
        std::string list;
        for (const int target : targets)
            list += fmt::format(R"({}{{"POSITION":{}}})", list.empty() ? "" : ",", target);
        return fmt::format(R"({{"attributes":{{"POSITION":0}},"indices":1,"targets":[{}]}})", list);
    }
    /// `channel` joins the sampler's members; weights of node 0 at 0, 1 and 2 s.
    std::string clip(const std::vector<float>& weights, const std::string& interpolation = "LINEAR",
                     int node = 0, const std::vector<float>& times = {0, 1, 2}) {
        const int input = floats(times, "SCALAR", 1), output = floats(weights, "SCALAR", 1);
        return fmt::format(
            R"({{"name":"talk","channels":[{{"sampler":0,"target":{{"node":{},"path":"weights"}}}}],)"
            R"("samplers":[{{"input":{},"output":{},"interpolation":"{}"}}]}})",
            node, input, output, interpolation);
    }
    /// `mesh` and `node` join these; `more` joins the JSON at its top.
    std::string file(const std::string& primitives, const std::string& animations,
                     const std::string& mesh = {}, const std::string& node = {},
                     const std::string& more = {}) const {
        return fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
            R"("nodes":[{{"name":"head","mesh":0{}}},{{"name":"empty"}}],"meshes":[{{"name":"face","primitives":[{}]{}}}],)"
            R"("accessors":[{}],"animations":[{}],{}{}}})",
            node, primitives, mesh, accessors_, animations, buffer.json(), more);
    }
    /// Heights of the vertices at a time of the first clip, by where they rest: [x > 0][z < 0].
    static std::array<float, 4> heights(const ImportedScene& scene, float time) {
        const auto actor = Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton,
                                       scene.clips, scene.skin, scene.morphs);
        EXPECT_TRUE(actor) << actor.error().message();
        std::array<float, 4> result{};
        if (!actor || scene.clips.empty()) return result;
        const ActorPose pose = actor->poseAt(0, time, Wrap::Clamp);
        for (std::size_t v = 0; v < scene.mesh.vertexCount(); ++v) {
            const Vec3f& rest = scene.mesh.positions()[v];
            result[(rest.x() > 0.1f ? 1u : 0u) + (rest.z() < -0.1f ? 2u : 0u)] = pose.positions_ws[v].y();
        }
        return result;
    }
    GltfBuffer buffer;

  private:
    std::string accessors_;
    int count_ = 0;
};

TEST_F(MeshMorphs, LinearWeightsMoveWhatTheirTargetsHave) {
    const std::vector<int> targets{lift({1}), lift({1, 3})};
    const std::string talk = clip({0, 0, 1, 0, 0.5f, 0.25f});
    const auto scene =
        imported("a.gltf", file(primitive(targets), talk, R"(,"extras":{"targetNames":["brow","jaw"]})"));
    EXPECT_THAT(scene.warnings, IsEmpty());
    ASSERT_THAT(scene.morphs, SizeIs(2));
    EXPECT_EQ(scene.morphs[0].name, "brow");
    EXPECT_THAT(scene.morphs[0].vertices, SizeIs(1)) << "what it does not move takes no memory";
    ASSERT_THAT(scene.clips, SizeIs(1));
    EXPECT_EQ(scene.clips[0].name, "talk");
    EXPECT_EQ(scene.clips[0].duration, 2);
    const auto half = heights(scene, 0.5f), late = heights(scene, 1.5f);
    EXPECT_FLOAT_EQ(half[1], 0.5f);
    EXPECT_FLOAT_EQ(half[3], 0);
    EXPECT_FLOAT_EQ(late[1], 0.75f + 0.125f);
    EXPECT_FLOAT_EQ(late[3], 0.125f);
    EXPECT_FLOAT_EQ(late[0], 0);
}

TEST_F(MeshMorphs, NamesOfAnotherKindCountAsNone) {
    const int target = lift({1});
    const std::string talk = clip({0, 1, 0.5f});
    for (const char* const extras :
         {"null", "5", "[1]", R"({"targetNames":"brow"})", R"({"targetNames":[7]})"}) {
        const auto scene =
            imported("a.gltf", file(primitive({target}), talk, fmt::format(R"(,"extras":{})", extras)));
        ASSERT_THAT(scene.morphs, SizeIs(1)) << extras;
        EXPECT_EQ(scene.morphs[0].name, "face 0") << extras;
    }
}

TEST_F(MeshMorphs, StepsHoldAndCubicSplinesAreFollowed) {
    const int target = lift({1});
    const auto steps = imported("a.gltf", file(primitive({target}), clip({0, 1, 0.5f}, "STEP")));
    EXPECT_FLOAT_EQ(heights(steps, 0.99f)[1], 0);
    EXPECT_FLOAT_EQ(heights(steps, 1.99f)[1], 1);
    EXPECT_FLOAT_EQ(heights(steps, 2)[1], 0.5f);
    // Of two targets: in-tangents, values and out-tangents of a key each follow one another. The first is t³
    // in the first second and 1 + 3 (t − 1) in the second, the other stands at 2.
    const int other = lift({2});
    const auto cubic = imported("b.gltf", file(primitive({target, other}), clip({0, 0, 0, 2, 0, 0,  //
                                                                                 3, 0, 1, 2, 3, 0,  //
                                                                                 3, 0, 4, 2, 0, 0},
                                                                                "CUBICSPLINE")));
    for (float t = 0; t <= 1; t += 0.03f) EXPECT_NEAR(heights(cubic, t)[1], t * t * t, 5e-4f) << t;
    for (float t = 1; t <= 2; t += 0.03f) EXPECT_NEAR(heights(cubic, t)[1], 3 * t - 2, 1e-5f) << t;
    EXPECT_FLOAT_EQ(heights(cubic, 1.3f)[2], 2);
}

TEST_F(MeshMorphs, SparseOffsetsAndSeveralPrimitivesAreOneTarget) {
    const int places = buffer.view(std::vector<std::uint16_t>{3}),
              values = buffer.view(std::vector<float>{0, 2, 0});
    const int sparse = add(accessor(
        -1, kFloat, 4, "VEC3",
        fmt::format(
            R"("sparse":{{"count":1,"indices":{{"bufferView":{},"componentType":5123}},"values":{{"bufferView":{}}}}})",
            places, values)));
    // The second primitive lies a metre beside the first, without that target.
    const int aside = floats({1, 0, 0, 1.2f, 0, 0, 1, 0, -0.2f, 1.2f, 0, -0.2f}, "VEC3", 3),
              lifted = lift({0, 1, 2, 3});
    const std::string second = fmt::format(
        R"({{"attributes":{{"POSITION":{}}},"indices":1,"targets":[{{"NORMAL":{}}},{{"POSITION":{}}}]}})",
        aside, lifted, lifted);
    const auto scene =
        imported("a.gltf", file(primitive({sparse, lift({0})}) + "," + second, clip({0, 0, 1, 0.5f, 0, 0})));
    EXPECT_THAT(scene.warnings, IsEmpty());
    ASSERT_THAT(scene.morphs, SizeIs(2));
    EXPECT_THAT(scene.morphs[0].vertices, SizeIs(1));
    EXPECT_THAT(scene.morphs[1].vertices, SizeIs(5));
    const auto actor = Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton, scene.clips,
                                   scene.skin, scene.morphs);
    ASSERT_TRUE(actor);
    const ActorPose pose = actor->poseAt(0, 1, Wrap::Clamp);
    for (std::size_t v = 0; v < scene.mesh.vertexCount(); ++v) {
        const Vec3f& rest = scene.mesh.positions()[v];
        const float height = rest.x() > 0.5f                       ? 0.5f
                             : rest.x() > 0.1f && rest.z() < -0.1f ? 2.0f
                             : rest.x() < 0.1f && rest.z() > -0.1f ? 0.5f
                                                                   : 0.0f;
        EXPECT_FLOAT_EQ(pose.positions_ws[v].y(), height) << rest.transpose();
    }
}

TEST_F(MeshMorphs, WeightsOfRestStayInTheMeshAndTurnedNodesTurnOffsets) {
    // A turn of 90° about X takes Y to Z; its scale is 2.
    const std::string node = R"(,"rotation":[0.70710678,0,0,0.70710678],"scale":[2,2,2],"weights":[0.25])";
    const auto scene =
        imported("a.gltf", file(primitive({lift({0, 1, 2, 3})}), clip({0.25f, 1, 0}), {}, node));
    ASSERT_THAT(scene.morphs, SizeIs(1));
    EXPECT_EQ(scene.morphs[0].restWeight, 0.25f);
    EXPECT_NEAR(scene.mesh.bounds().min().z(), 0.5f, 1e-6f);
    EXPECT_NEAR((scene.morphs[0].offsets[0] - Vec3f(0, 0, 2)).norm(), 0, 1e-6f);
    const auto actor = Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton, scene.clips,
                                   scene.skin, scene.morphs);
    ASSERT_TRUE(actor);
    for (const Vec3f& p : actor->poseAt(0, 1, Wrap::Clamp).positions_ws) EXPECT_NEAR(p.z(), 2, 1e-5f);
    for (const Vec3f& p : actor->poseAt(0, 2, Wrap::Clamp).positions_ws) EXPECT_NEAR(p.z(), 0, 1e-5f);
    // A mesh that only morphs goes where the character is placed.
    ASSERT_FALSE(scene.skeleton.empty());
    EXPECT_EQ(scene.skeleton.bones()[scene.skin.bones[0][0]].name, "head");
    EXPECT_EQ(scene.skin.weights[0][0], 1);
}

TEST_F(MeshMorphs, WhatDoesNotFitIsLeftOutAndTold) {
    const int good = lift({1}), few = lift({1}, 3);
    const int broken = floats({0, 0, 0, std::nanf(""), 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3);
    const auto wrongTargets =
        imported("a.gltf", file(primitive({few, good, broken, 77}), clip({0, 0, 0, 0,  //
                                                                          1, 1, 1, 1,  //
                                                                          0, 0, 0, 0})));
    ASSERT_THAT(wrongTargets.morphs, SizeIs(1));
    EXPECT_FLOAT_EQ(heights(wrongTargets, 1)[1], 1) << "the others play";
    EXPECT_THAT(warningsOf(wrongTargets),
                AllOf(HasSubstr("3 morph targets are left out"), HasSubstr("'face 0' (3 of 4 vertices)"),
                      HasSubstr("'face 2' (numbers that are not finite)"), HasSubstr("accessor 77")));
    const auto wrongCount = imported("b.gltf", file(primitive({good}), clip({0, 1})));
    EXPECT_THAT(wrongCount.clips, IsEmpty());
    EXPECT_THAT(warningsOf(wrongCount),
                AllOf(HasSubstr("clip 'talk'"), HasSubstr("3 times of keys with 2 numbers")));
    const float infinite = std::numeric_limits<float>::infinity();
    EXPECT_THAT(warningsOf(imported("c.gltf", file(primitive({good}), clip({0, infinite, 0})))),
                HasSubstr("not finite"));
    EXPECT_THAT(warningsOf(imported("d.gltf", file(primitive({good}), clip({0, 1, 0}, "WAVES")))),
                HasSubstr("'WAVES'"));
    EXPECT_THAT(warningsOf(imported("e.gltf", file(primitive({good}), clip({0, 1, 0}, "LINEAR", 1)))),
                HasSubstr("node 1 has none"));
    EXPECT_THAT(warningsOf(imported("f.gltf", file(primitive({good}), clip({0, 1, 0}, "LINEAR", 9)))),
                HasSubstr("node 9 has none"));
    // Beside a channel of bones the clip plays without them.
    const std::string turn = R"(,{"sampler":1,"target":{"node":0,"path":"translation"}}],)";
    std::string both = clip({0, 1});
    both.replace(both.find("],"), 2, turn);
    const int times = floats({0, 1}, "SCALAR", 1), places = floats({0, 0, 0, 1, 0, 0}, "VEC3", 3);
    both.replace(both.rfind("]}"), 2, fmt::format(R"(,{{"input":{},"output":{}}}]}})", times, places));
    const auto moved = imported("g.gltf", file(primitive({good}), both));
    ASSERT_THAT(moved.clips, SizeIs(1));
    EXPECT_THAT(moved.clips[0].channels, SizeIs(1));
    EXPECT_THAT(moved.clips[0].morphs, IsEmpty());
}

TEST_F(MeshMorphs, AThousandTargetsArePossibleAndTooManyVerticesAreLeftOut) {
    const int target = lift({1});
    std::vector<float> weights(1000, 0), last(1000, 0.001f);
    weights.insert(weights.end(), last.begin(), last.end());
    const auto scene = imported(
        "a.gltf", file(primitive(std::vector<int>(1000, target)), clip(weights, "LINEAR", 0, {0, 1})));
    ASSERT_THAT(scene.morphs, SizeIs(1000));
    EXPECT_NEAR(heights(scene, 1)[1], 1, 1e-4f);

    // A mesh of 20,000 vertices of which each of 300 targets moves all but one: 6 million, of which 4 are
    // taken.
    std::vector<float> many;
    std::vector<std::uint16_t> corners;
    for (std::uint16_t row = 0; row < 100; ++row) {
        for (std::uint16_t column = 0; column < 200; ++column) {
            many.insert(many.end(),
                        {0.001f * static_cast<float>(column), 0, -0.001f * static_cast<float>(row)});
            if (row == 99 || column == 199) continue;
            const auto at = static_cast<std::uint16_t>(row * 200 + column);
            for (const int corner : {at + 0, at + 1, at + 200, at + 1, at + 201, at + 200})
                corners.push_back(static_cast<std::uint16_t>(corner));
        }
    }
    const int positions = floats(many, "VEC3", 3);
    const int indices = add(accessor(buffer.view(corners), kUnsignedShort, corners.size(), "SCALAR"));
    std::string list;
    for (int t = 0; t < 300; ++t) list += fmt::format(R"({}{{"POSITION":{}}})", t == 0 ? "" : ",", positions);
    const auto large = imported(
        "b.gltf", file(fmt::format(R"({{"attributes":{{"POSITION":{}}},"indices":{},"targets":[{}]}})",
                                   positions, indices, list),
                       clip(std::vector<float>(600, 0.5f), "LINEAR", 0, {0, 1})));
    EXPECT_THAT(large.morphs, SizeIs(209));
    EXPECT_THAT(warningsOf(large), HasSubstr("all targets move more than 4194304 vertices"));
}

/// A square of 20 cm whose second corner "brow" lifts and whose third "jaw" does, in centimetres, with keys
/// of their percents at 0, 1 and 2 s. `shapes` joins the objects, `more` the connections.
std::string fbx(const std::string& shapes = {}, const std::string& more = {}) {
    constexpr const char* kKeys = "KeyTime: *3 {\n a: 0,46186158000,92372316000\n}\n";
    const auto shape = [](int id, const char* name, int corner) {
        return fmt::format(
            "Geometry: {}, \"Geometry::{}\", \"Shape\" {{\nVersion: 100\nIndexes: *1 {{\n a: {}\n}}\n"
            "Vertices: *3 {{\n a: 0,10,0\n}}\nNormals: *3 {{\n a: 0,0,0\n}}\n}}\n",
            id, name, corner);
    };
    const auto channel = [](int id, const char* name) {
        return fmt::format(
            "Deformer: {}, \"SubDeformer::{}\", \"BlendShapeChannel\" {{\nVersion: 100\nDeformPercent: 0\n"
            "FullWeights: *1 {{\n a: 100\n}}\n}}\n",
            id, name);
    };
    const auto curve = [&](int id, const char* values) {
        return fmt::format(
            "AnimationCurve: {}, \"AnimCurve::\", \"\" {{\nDefault: 0\nKeyVer: 4009\n{}KeyValueFloat: *3 "
            "{{\n "
            "a: {}\n}}\n}}\nAnimationCurveNode: {}, \"AnimCurveNode::DeformPercent\", \"\" {{\n}}\n",
            id, kKeys, values, id + 1);
    };
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\n"
           "GlobalSettings:  {\nVersion: 1000\nProperties70:  {\n"
           "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n}\n}\n"
           "Objects:  {\nGeometry: 1, \"Geometry::\", \"Mesh\" {\nVertices: *12 {\n a: "
           "0,0,0,20,0,0,0,0,-20,20,0,-20\n}\n"
           "PolygonVertexIndex: *4 {\n a: 0,1,3,-3\n}\nGeometryVersion: 124\n}\n"
           "Model: 2, \"Model::face\", \"Mesh\" {\nVersion: 232\n}\n" +
           shape(3, "brow", 1) + shape(4, "jaw", 2) +
           "Deformer: 5, \"Deformer::shapes\", \"BlendShape\" {\nVersion: 100\n}\n" + channel(6, "brow") +
           channel(7, "jaw") + curve(10, "0,100,50") + curve(12, "100,0,20") +
           "AnimationStack: 20, \"AnimStack::talk\", \"\" {\n}\nAnimationLayer: 21, \"AnimLayer::base\", "
           "\"\" {\n}\n" +
           shapes +
           "}\nConnections:  {\nC: \"OO\",2,0\nC: \"OO\",1,2\nC: \"OO\",5,1\nC: \"OO\",6,5\nC: "
           "\"OO\",7,5\nC: \"OO\",3,6\nC: "
           "\"OO\",4,7\n"
           "C: \"OO\",21,20\nC: \"OO\",11,21\nC: \"OO\",13,21\nC: \"OP\",11,6, \"DeformPercent\"\nC: "
           "\"OP\",13,7, "
           "\"DeformPercent\"\n"
           "C: \"OP\",10,11, \"d|DeformPercent\"\nC: \"OP\",12,13, \"d|DeformPercent\"\n" +
           more + "}\n";
}

TEST_F(MeshMorphs, BlendShapesOfFbxPlay) {
    const auto scene = imported("a.fbx", fbx());
    ASSERT_THAT(scene.morphs, SizeIs(2)) << warningsOf(scene);
    EXPECT_EQ(scene.morphs[0].name, "brow");
    ASSERT_THAT(scene.clips, SizeIs(1));
    EXPECT_EQ(scene.clips[0].name, "talk");
    EXPECT_NEAR(scene.clips[0].duration, 2, 1e-4f);
    const auto half = heights(scene, 0.5f), late = heights(scene, 1.5f);
    EXPECT_NEAR(half[1], 0.05f, 1e-6f);
    EXPECT_NEAR(half[2], 0.05f, 1e-6f);
    EXPECT_NEAR(late[1], 0.075f, 1e-6f);
    EXPECT_NEAR(late[2], 0.01f, 1e-6f);
    EXPECT_NEAR(late[0], 0, 1e-6f);
    EXPECT_NEAR(late[3], 0, 1e-6f);
    ASSERT_FALSE(scene.skeleton.empty());
    EXPECT_EQ(scene.skin.weights[0][0], 1) << "it goes where the character is placed";
}

TEST_F(MeshMorphs, InBetweenShapesOfFbxStayAtRestAndAreTold) {
    const std::string between =
        "Geometry: 8, \"Geometry::half\", \"Shape\" {\nVersion: 100\nIndexes: *1 {\n a: 1\n}\n"
        "Vertices: *3 {\n a: 0,2,0\n}\nNormals: *3 {\n a: 0,0,0\n}\n}\n";
    const auto scene = imported("a.fbx", fbx(between, "C: \"OO\",8,6\n"));
    EXPECT_THAT(scene.morphs, IsEmpty());
    EXPECT_THAT(warningsOf(scene), HasSubstr("in-between blend shapes"));
    EXPECT_EQ(scene.mesh.triangleCount(), 2u);
}

}  // namespace
}  // namespace hairloom::test
