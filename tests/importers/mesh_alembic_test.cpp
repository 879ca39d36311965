// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of Alembic: faces, values of corners, what is shown, and what moves.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>

#include "core/animation/actor.h"
#include "exporters/ogawa_builder.h"
#include "importers/point_cache.h"
#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kInt8 = static_cast<AlembicType>(2), kUint32 = static_cast<AlembicType>(5);

template <class T>
std::span<const std::byte> rawBytes(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

/// A quad and a triangle that look along +Z, clockwise as Alembic has them.
struct HeadInFile {
    std::vector<std::vector<float>> points{{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0}};  ///< per frame
    std::vector<std::int32_t> counts{4, 3}, indices{0, 3, 2, 1, 1, 2, 4};
    std::vector<float> uvs;  ///< of the points
    std::vector<float> normals;
    std::vector<std::int32_t> lips;  ///< faces of a set
    std::string schema = "AbcGeom_PolyMesh_v1";
};

/// An archive, object by object from its leaves.
class AlembicScene {
  public:
    AlembicChild mesh(const std::string& name, const HeadInFile& head) {
        AlembicCompound geometry = compound();
        std::vector<std::span<const std::byte>> samples;
        for (const auto& frame : head.points) samples.push_back(rawBytes(frame));
        geometry.arrays("P", AlembicType::Float, 3, samples, "geoScope=vtx;interpretation=point");
        geometry.array(".faceCounts", AlembicType::Int32, 1, rawBytes(head.counts));
        geometry.array(".faceIndices", AlembicType::Int32, 1, rawBytes(head.indices));
        if (!head.uvs.empty()) {
            AlembicCompound pair = compound();
            pair.array(".vals", AlembicType::Float, 2, rawBytes(head.uvs));
            pair.array(".indices", kUint32, 1, rawBytes(head.indices));
            geometry.compound("uv", pair, "geoScope=fvr;isGeomParam=true");
        }
        if (!head.normals.empty())
            geometry.array("N", AlembicType::Float, 3, rawBytes(head.normals), "geoScope=fvr");
        std::vector<AlembicChild> sets;
        if (!head.lips.empty()) {
            AlembicCompound set = compound(), properties = compound();
            set.array(".faces", AlembicType::Int32, 1, rawBytes(head.lips));
            properties.compound(".faceset", set, "schema=AbcGeom_FaceSet_v1");
            sets.push_back({"lips", "schema=AbcGeom_FaceSet_v1",
                            alembicObject(file_, metadata_, properties.write(), {})});
        }
        AlembicCompound properties = compound();
        properties.compound(".geom", geometry, "schema=" + head.schema);
        return {name, "schema=" + head.schema, alembicObject(file_, metadata_, properties.write(), sets)};
    }

    /// A transform of one operation over `children`, with its numbers at each time.
    AlembicChild below(const std::string& name, std::uint8_t operation,
                       const std::vector<std::vector<double>>& values, const AlembicChild& child,
                       bool isHidden = false) {
        AlembicCompound xform = compound(), properties = compound();
        xform.scalar(".ops", AlembicType::Uint8, 1, std::as_bytes(std::span(&operation, 1)));
        std::vector<std::span<const std::byte>> samples;
        for (const auto& numbers : values) samples.push_back(rawBytes(numbers));
        xform.scalars(".vals", AlembicType::Double, static_cast<std::uint32_t>(values[0].size()), samples);
        properties.compound(".xform", xform, "schema=AbcGeom_Xform_v3");
        const std::int8_t hidden = 0;
        if (isHidden) properties.scalar("visible", kInt8, 1, std::as_bytes(std::span(&hidden, 1)));
        return {name, "schema=AbcGeom_Xform_v3",
                alembicObject(file_, metadata_, properties.write(), std::span(&child, 1))};
    }

    AlembicChild instance(const std::string& name, const std::string& of) {
        AlembicCompound properties = compound();
        properties.scalar(".instanceSource", AlembicType::Text, 1,
                          std::as_bytes(std::span(of.c_str(), of.size() + 1)));
        return {name, "isInstance=1", alembicObject(file_, metadata_, properties.write(), {})};
    }

    std::string finish(std::span<const AlembicChild> objects, const AlembicTimes& times = {}) {
        const auto top = alembicObject(file_, metadata_, 0, objects);
        const auto bytes = finishAlembic(file_, metadata_, top, "_ai_Application=test", times);
        std::string text(bytes.size(), '\0');
        std::memcpy(text.data(), bytes.data(), bytes.size());
        return text;
    }
    std::string finish(const AlembicChild& object, const AlembicTimes& times = {}) {
        return finish(std::span(&object, 1), times);
    }

  private:
    AlembicCompound compound() { return AlembicCompound(file_, metadata_); }

    OgawaBuilder file_;
    std::vector<std::string> metadata_;
};

std::string fileOf(const HeadInFile& head, const AlembicTimes& times = {}) {
    AlembicScene scene;
    return scene.finish(scene.mesh("head", head), times);
}

constexpr std::uint8_t kTranslate = 1u << 4u, kTurnAboutY = 5u << 4u;

class AlembicHeads : public MeshFiles {
  protected:
    ImportedScene read(const std::string& bytes) const { return imported("head.abc", bytes); }
};

TEST_F(AlembicHeads, FacesSetsTextureCoordinatesAndNormalsComeIn) {
    HeadInFile head;
    head.uvs = {0, 0, 0.5f, 0, 0.5f, 0.5f, 0, 0.5f, 1, 0};
    for (int corner = 0; corner < 7; ++corner) head.normals.insert(head.normals.end(), {0.6f, 0, 0.8f});
    head.lips = {1, 9};
    const ImportedScene scene = read(fileOf(head));
    ASSERT_EQ(scene.mesh.triangleCount(), 3u);
    for (std::uint32_t t = 0; t < 3; ++t) EXPECT_FLOAT_EQ(scene.mesh.triangleNormal(t).z(), 1);
    for (const Vec3f& normal : scene.mesh.normals())
        EXPECT_LT((normal - Vec3f(0.6f, 0, 0.8f)).norm(), 1e-6f) << "the file's, not the faces'";
    EXPECT_THAT(scene.mesh.groupNames(), ElementsAre("lips", "head"));
    EXPECT_EQ(scene.mesh.triangleGroups()[2], 0u);
    EXPECT_THAT(warningsOf(scene), HasSubstr("1 faces of sets are not there"));
    ASSERT_EQ(scene.mesh.cornerUvs().size(), 9u);
    for (std::size_t corner = 0; corner < 9; ++corner) {
        const Vec3f at = scene.mesh.positions()[scene.mesh.triangles()[corner / 3][corner % 3]];
        EXPECT_EQ(scene.mesh.cornerUvs()[corner], Vec2f(at.x() / 2, at.y() / 2)) << corner;
    }
    EXPECT_TRUE(scene.skeleton.empty());
    head.schema = "AbcGeom_SubD_v1";
    EXPECT_THAT(warningsOf(read(fileOf(head))), HasSubstr("polygons of their cages"));
}

/// A sheet of 5 × 5 points, 10 cm wide, in as many frames as there are motions; `jaw` moves its last row on
/// top.
HeadInFile sheet(const std::vector<Eigen::Affine3f>& motions, const std::vector<Vec3f>& jaw) {
    HeadInFile head;
    head.counts.clear();
    head.indices.clear();
    head.points.clear();
    for (std::int32_t row = 0; row < 4; ++row) {
        for (std::int32_t column = 0; column < 4; ++column) {
            const std::int32_t at = 5 * row + column;
            head.counts.push_back(4);
            head.indices.insert(head.indices.end(), {at, at + 5, at + 6, at + 1});
        }
    }
    for (std::size_t frame = 0; frame < motions.size(); ++frame) {
        std::vector<float>& points = head.points.emplace_back();
        for (int p = 0; p < 25; ++p) {
            const Vec3f rest(0.025f * static_cast<float>(p % 5), 0.02f * static_cast<float>(p / 5),
                             0.001f * static_cast<float>(p % 3));
            const Vec3f at = motions[frame] * Vec3f(rest + (p >= 20 ? jaw[frame] : Vec3f::Zero()));
            points.insert(points.end(), {at.x(), at.y(), at.z()});
        }
    }
    return head;
}

Eigen::Affine3f turned(float degrees, const Vec3f& along) {
    return Eigen::Translation3f(along) *
           Eigen::AngleAxisf(degrees * std::numbers::pi_v<float> / 180, Vec3f(0.6f, 0.8f, 0));
}

/// Millimetres between the farthest vertex of a pose and the point of the file's frames nearest to it.
float farthestFrom(const std::vector<Vec3f>& positions_ws, const std::vector<float>& points) {
    float farthest = 0;
    for (const Vec3f& position : positions_ws) {
        float nearest = 1e9f;
        for (std::size_t p = 0; p < points.size(); p += 3)
            nearest = std::min(nearest, (position - Vec3f(points[p], points[p + 1], points[p + 2])).norm());
        farthest = std::max(farthest, nearest);
    }
    return 1e3f * farthest;
}

Actor actorOf(const ImportedScene& scene) {
    auto actor = Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton, scene.clips,
                             scene.skin, scene.morphs);
    if (!actor) throw std::runtime_error(actor.error().message());
    return std::move(*actor);
}

const AlembicTimes kThreeFrames{3, 0.1, {1.0}};

TEST_F(AlembicHeads, PointsThatMovePlayAndWhatMovesAsAWholeIsABone) {
    const std::vector<Eigen::Affine3f> motions{turned(0, {0, 0, 0}), turned(25, {0.1f, 0, 0}),
                                               turned(-40, {0, 0.3f, 0.2f})};
    const std::vector<Vec3f> jaw{{0, 0, 0}, {0, 0.02f, 0}, {0, 0.005f, 0.01f}};
    const HeadInFile head = sheet(motions, jaw);
    const ImportedScene scene = read(fileOf(head, kThreeFrames));
    EXPECT_THAT(warningsOf(scene), testing::Not(HasSubstr("points")));
    ASSERT_EQ(scene.clips.size(), 1u);
    EXPECT_FLOAT_EQ(scene.clips[0].duration, 0.2f);
    const Actor actor = actorOf(scene);
    for (std::size_t frame = 0; frame < 3; ++frame) {
        const ActorPose pose = actor.poseAt(0, 0.1f * static_cast<float>(frame), Wrap::Clamp);
        EXPECT_LT(farthestFrom(pose.positions_ws, head.points[frame]), 1e-3f) << frame;
        // The bone goes with the head, not with the jaw.
        ASSERT_EQ(pose.boneMatrices_ws.size(), 1u);
        EXPECT_LT((pose.boneMatrices_ws[0].matrix() - motions[frame].matrix()).norm(), 1e-4f) << frame;
    }
    EXPECT_EQ(scene.skeleton.bones()[0].name, "head");
    // Between two times the head turns along the arc, and the jaw opens by half.
    const ActorPose between = actor.poseAt(0, 0.05f, Wrap::Clamp);
    std::vector<float> half = sheet({turned(12.5f, {0, 0, 0})}, {Vec3f(0, 0.01f, 0)}).points[0];
    for (std::size_t n = 0; n < half.size(); n += 3) half[n] += 0.05f;
    EXPECT_LT(farthestFrom(between.positions_ws, half), 1e-3f);
}

TEST_F(AlembicHeads, AFaceThatTalksHasNoBone) {
    const std::vector<Eigen::Affine3f> still(3, Eigen::Affine3f::Identity());
    const ImportedScene scene =
        read(fileOf(sheet(still, {{0, 0, 0}, {0, 0.02f, 0}, {0, 0, 0}}), kThreeFrames));
    EXPECT_TRUE(scene.skeleton.empty());
    ASSERT_EQ(scene.morphs.size(), 1u) << "frames at rest need none";
    EXPECT_EQ(scene.morphs[0].vertices.size(), 5u);
    const Actor actor = actorOf(scene);
    EXPECT_NEAR(actor.poseAt(0, 0.05f, Wrap::Clamp).positions_ws[24].y(), 0.09f, 1e-6f);
    EXPECT_NEAR(actor.poseAt(0, 0.2f, Wrap::Clamp).positions_ws[24].y(), 0.08f, 1e-6f);
    const ImportedScene same = read(fileOf(sheet(still, std::vector<Vec3f>(3, Vec3f::Zero())), kThreeFrames));
    EXPECT_TRUE(same.morphs.empty() && same.skeleton.empty());
}

TEST_F(AlembicHeads, PointsMoveInsideTransformsThatMove) {
    AlembicScene file;
    const std::vector<Eigen::Affine3f> still(3, Eigen::Affine3f::Identity());
    const HeadInFile head = sheet(still, {{0, 0, 0}, {0, 0.02f, 0}, {0, 0.01f, 0}});
    const auto body =
        file.below("body", kTranslate, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, file.mesh("head", head));
    const ImportedScene scene = read(file.finish(body, kThreeFrames));
    ASSERT_EQ(scene.skeleton.bones().size(), 1u);
    std::vector<float> gone = head.points[2];
    for (std::size_t n = 0; n < gone.size(); n += 3) gone[n] += 2;
    EXPECT_LT(farthestFrom(actorOf(scene).poseAt(0, 0.2f, Wrap::Clamp).positions_ws, gone), 1e-3f);
}

TEST_F(AlembicHeads, PointsThatCannotPlayStayAndAreTold) {
    const std::vector<Eigen::Affine3f> still(3, Eigen::Affine3f::Identity());
    HeadInFile head = sheet(still, {{0, 0, 0}, {0, 0.02f, 0}, {0, 0.01f, 0}});
    head.points[2].resize(72);
    ImportedScene scene = read(fileOf(head, kThreeFrames));
    EXPECT_TRUE(scene.morphs.empty() && scene.clips.empty());
    EXPECT_THAT(warningsOf(scene), HasSubstr("head: at 0.2 s it has 24 points instead of 25"));
    head = sheet(still, {{0, 0, 0}, {0, NAN, 0}, {0, 0.01f, 0}});
    scene = read(fileOf(head, kThreeFrames));
    EXPECT_TRUE(scene.morphs.empty() && scene.clips.empty());
    EXPECT_THAT(warningsOf(scene), HasSubstr("head: at 0.1 s it has points that are no numbers"));
}

TEST(PointCaches, ReadAsManyTimesAsTheyMayAndTheLast) {
    RawScene scene;
    scene.soup.positions.assign(1u << 16u, Vec3f::Zero());
    scene.soup.positions[1] = Vec3f(1, 1, 1);
    PointCache cache(scene);
    PointCache::Mesh mesh{"head", 0, 1u << 16u, {}, {}, true};
    for (int s = 0; s < 300; ++s) mesh.seconds.push_back(static_cast<float>(s) / 30);
    const std::vector<Vec3f> rest = scene.soup.positions;
    mesh.read = [&](std::size_t sample) -> Result<std::vector<Vec3f>> {
        std::vector<Vec3f> points = rest;
        points[7].x() += static_cast<float>(sample);
        return points;
    };
    cache.add(std::move(mesh));
    Clip clip;
    ASSERT_TRUE(cache.finish(clip));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_THAT(scene.warnings[0], HasSubstr("19660800 points at all of their times"));
    // Every other of 300, but for the first, at rest, and the last.
    EXPECT_EQ(scene.morphs.size(), 150u);
    EXPECT_EQ(clip.duration, 299.0f / 30);
    const std::vector<float> weights = morphWeights(scene.morphs, clip, 4.5f / 30, Wrap::Clamp);
    EXPECT_NEAR(morphedPositions(scene.soup.positions, scene.morphs, weights)[7].x(), 4.5f, 1e-4f);
}

TEST_F(AlembicHeads, InstancesStandInTheirPlacesAndTheHiddenAreLeftOut) {
    AlembicScene file;
    const std::array objects{file.below("one", kTranslate, {{0, 0, 1}}, file.mesh("head", {})),
                             file.below("two", kTranslate, {{0, 0, 5}}, file.instance("copy", "/one/head")),
                             file.below("away", kTranslate, {{0, 0, 99}}, file.mesh("hat", {}), true)};
    const ImportedScene scene = read(file.finish(objects));
    EXPECT_EQ(scene.mesh.triangleCount(), 6u);
    EXPECT_FLOAT_EQ(scene.mesh.bounds().min().z(), 1);
    EXPECT_FLOAT_EQ(scene.mesh.bounds().max().z(), 5);
    EXPECT_THAT(warningsOf(scene), HasSubstr("/away/hat is hidden"));
    AlembicScene hidden;
    const auto only = hidden.below("away", kTranslate, {{0, 0, 0}}, hidden.mesh("hat", {}), true);
    EXPECT_THAT(refusal("hidden.abc", hidden.finish(only)), HasSubstr("/away/hat is hidden"));
    AlembicScene circle;
    const auto itself = circle.below("a", kTranslate, {{0, 0, 0}}, circle.instance("b", "/a"));
    EXPECT_THAT(refusal("circle.abc", circle.finish(itself)), HasSubstr("too deep"));
    AlembicScene nowhere;
    EXPECT_FALSE(refusal("nowhere.abc", nowhere.finish(nowhere.instance("b", "/gone"))).empty());
}

TEST_F(AlembicHeads, TransformsThatChangeMoveTheHeadFromItsFirstTime) {
    AlembicScene file;
    const auto body = file.below("body", kTurnAboutY, {{0}, {90}, {180}}, file.mesh("head", {}));
    const ImportedScene scene = read(file.finish(body, {3, 0.5, {2.0}}));
    ASSERT_EQ(scene.skeleton.bones().size(), 1u);
    EXPECT_EQ(scene.skeleton.bones()[0].name, "body");
    ASSERT_EQ(scene.clips.size(), 1u);
    EXPECT_FLOAT_EQ(scene.clips[0].duration, 1);
    const auto actor =
        Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton, scene.clips, scene.skin);
    ASSERT_TRUE(actor) << actor.error().message();
    for (const float time : {0.0f, 0.2f, 0.5f, 1.0f}) {
        const float angle = std::numbers::pi_v<float> * time;
        const Vec3f expected(2 * std::cos(angle), 0, -2 * std::sin(angle));
        bool isThere = false;
        for (const Vec3f& p : actor->poseAt(0, time, Wrap::Clamp).positions_ws)
            isThere = isThere || (p - expected).norm() < 1e-4f;
        EXPECT_TRUE(isThere) << time;
    }
}

TEST_F(AlembicHeads, MeshesThatContradictThemselvesAreNamed) {
    const std::vector<std::pair<std::function<void(HeadInFile&)>, std::string>> wrong{
        {[](HeadInFile& head) { head.indices[4] = 5; }, "refers to point 5 of 5"},
        {[](HeadInFile& head) { head.indices[0] = -1; }, "refers to point -1 of 5"},
        {[](HeadInFile& head) {
             head.counts = {4, -3};
         },
         "a face of -3 corners"},
        {[](HeadInFile& head) {
             head.counts = {4, 2147483647};
         },
         "more corners than indices"},
        {[](HeadInFile& head) { head.counts = {4}; }, "7 indices for faces of 4 corners"},
        {[](HeadInFile& head) { head.points[0].clear(); }, "refers to point 0 of 0"},
        {[](HeadInFile& head) { head.counts.clear(), head.indices.clear(); }, "has no faces"}};
    for (const auto& [spoil, word] : wrong) {
        HeadInFile head;
        spoil(head);
        EXPECT_THAT(refusal("bad.abc", fileOf(head)), HasSubstr(word));
        AlembicScene file;
        const std::array beside{file.mesh("good", {}), file.mesh("bad", head)};
        const ImportedScene scene = read(file.finish(beside));
        EXPECT_EQ(scene.mesh.triangleCount(), 3u) << word;
        EXPECT_THAT(warningsOf(scene), HasSubstr("/bad")) << "the good one comes in, the other is named";
    }
}

TEST_F(AlembicHeads, FilesCutAnywhereAreRefused) {
    HeadInFile head;
    head.lips = {1};
    const std::string whole = fileOf(head);
    for (std::size_t length = 8; length < whole.size(); length += 97)
        EXPECT_THAT(refusal("cut.abc", whole.substr(0, length)), HasSubstr("cut.abc")) << length;
}

}  // namespace
}  // namespace hairloom::test
