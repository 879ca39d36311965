// SPDX-License-Identifier: GPL-3.0-or-later
// The baked skin of a body against its mesh: at rest, posed by bones, and where there is nothing to bake.
#include "hairloom/body_field.h"

#include <gtest/gtest.h>

#include <array>

#include "core/base/parallel.h"
#include "core/geometry/mesh_solid.h"
#include "core/simulation/bake_body.h"
#include "core/simulation/scene_input.h"
#include "hairloom/body_push.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

using runtime::BonePose;
using runtime::Float3;
using runtime::PosedBody;

Float3 toEngine(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}
Vec3f fromEngine(Float3 v) {
    return {v.x, v.y, v.z};
}

/// A head on a neck: a ball of 9 cm, stretched downwards.
ScalpMesh headOnNeck() {
    PolygonSoup soup = test::icosphereSoup(4, 0.09f);
    for (Vec3f& p : soup.positions) {
        if (p.y() < 0) p = Vec3f(p.x(), 2 * p.y(), p.z());
    }
    return test::meshOf(soup);
}

/// Two bones that meet in the neck.
struct Rig {
    SkinWeights skin;

    explicit Rig(const ScalpMesh& mesh) {
        for (const Vec3f& p : mesh.positions()) {
            const float upper = std::clamp((p.y() + 0.12f) / 0.08f, 0.0f, 1.0f);
            skin.bones.push_back({0, 1, 0, 0});
            skin.weights.push_back({1 - upper, upper, 0, 0});
        }
    }
    HeadPose pose(const ScalpMesh& mesh, float degrees) const {
        HeadPose pose;
        pose.bones_ws.assign(2, Eigen::Affine3f::Identity());
        const Vec3f joint(0, -0.08f, 0);
        pose.bones_ws[1] = Eigen::Translation3f(joint) * Eigen::AngleAxisf(radians(degrees), Vec3f::UnitX()) *
                           Eigen::Translation3f(-joint);
        pose.scalpPositions_ws.resize(mesh.vertexCount());
        skinPositions(mesh.positions(), skin, pose.bones_ws, pose.scalpPositions_ws);
        return pose;
    }
};

BakedBody baked(const ScalpMesh& mesh, const SkinWeights& skin = {}) {
    auto body = bakeBody(mesh, skin);
    if (!body) throw std::runtime_error(body.error().message());
    EXPECT_EQ(body->field->problem(), "");
    return std::move(*body);
}

/// The rig names no bones, so that the field calls them by their number.
std::vector<BonePose> posesOf(const BakedBody& body, HeadPose pose) {
    for (const runtime::String& bone : body.field->bones)
        pose.body_ws.push_back(pose.bones_ws[bone == "bone 0" ? 0 : 1]);
    Groom groom;
    groom.body = body.field;
    return bodyAt(groom, pose);
}

/// A head, with two bones and as a whole, measured once.
struct Neck {
    ScalpMesh mesh = headOnNeck();
    Rig rig{mesh};
    BakedBody skinned = baked(mesh, rig.skin), whole = baked(mesh);
};
const Neck& neck() {
    static const Neck kNeck;
    return kNeck;
}

TEST(BodyField, IsTheDistanceToTheSkin) {
    const ScalpMesh& mesh = neck().mesh;
    const BakedBody& body = neck().whole;
    EXPECT_LE((*body.field).bytes(), 300'000u);
    EXPECT_LT(body.fit.worstGap, 1e-3f);
    EXPECT_LT(body.fit.worstBulge, 1e-3f);
    EXPECT_LT(body.fit.meanGap, 1e-4f);
    const MeshSolid solid(mesh.positions(), mesh.triangles());
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        const Vec3f point = test::randomPoint(random, 0.1f);
        const float exact = solid.signedDistance(point);
        const auto sample = (*body.field).at(toEngine(point));
        ASSERT_TRUE(std::isfinite(sample.distance));
        // Near the skin by small cells, elsewhere by large ones.
        EXPECT_NEAR(sample.distance, exact, std::abs(exact) < 0.004f ? 8e-4f : 1e-2f) << point.transpose();
    }
    EXPECT_TRUE(std::isinf((*body.field).at({5, 5, 5}).distance));
}

TEST(BodyField, IsPosedByBones) {
    const auto& [mesh, rig, body, whole] = neck();
    for (const float degrees : {0.0f, 20.0f, -35.0f}) {
        const HeadPose pose = rig.pose(mesh, degrees);
        const auto bones = posesOf(body, pose);
        const PosedBody posed((*body.field), bones);
        const MeshSolid truth(pose.scalpPositions_ws, mesh.triangles());
        Random random(4);
        int near = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3f point = test::randomPoint(random, 0.2f) - Vec3f(0, 0.05f, 0);
            const float exact = truth.signedDistance(point);
            if (std::abs(exact) > 0.004f) continue;
            ++near;
            const auto contact = posed.at(toEngine(point));
            EXPECT_NEAR(contact.distance, exact, 1.5e-3f) << degrees << "°: " << point.transpose();
            // The way out leads out.
            const Vec3f out = point + (2e-3f - contact.distance) * fromEngine(contact.normal_ws);
            EXPECT_GT(truth.signedDistance(out), 2e-4f);
            EXPECT_LT((fromEngine(posed.place(contact.point_ss)) - point).norm(), 3e-4f);
        }
        EXPECT_GT(near, 50);
    }
}

TEST(BodyField, BonesThatMoveAlikeAreAWhole) {
    const BakedBody& body = neck().skinned;
    const BonePose turned{{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {0.1f, -0.2f, 0.3f}};
    const std::vector<BonePose> both(body.field->bones.size(), turned);
    auto almost = both;
    almost[1].origin.x += 1e-7f;
    const PosedBody alike(*body.field, both), single(*body.field, {both.data(), 1}),
        apart(*body.field, almost);
    Random random(6);
    int near = 0;
    for (int i = 0; i < 4000; ++i) {
        const Float3 rest = toEngine(test::randomPoint(random, 0.2f));
        const float distance = body.field->at(rest).distance;
        if (!(std::abs(distance) < 0.005f)) continue;
        ++near;
        const Float3 at = turned.apply(rest);
        const auto contact = alike.at(at);
        EXPECT_EQ(contact.distance, single.at(at).distance);
        EXPECT_NEAR(contact.distance, 2 * distance, 1e-5f) << "twice as large";
        EXPECT_NEAR(contact.distance, apart.at(at).distance, 1e-4f);
        EXPECT_LT(length(alike.place(contact.point_ss) - at), 1e-6f);
        EXPECT_LE(alike.freeAround(at), std::max(contact.distance, 0.0f) + 2e-3f);
    }
    EXPECT_GT(near, 50);
    const std::vector<BonePose> flat(body.field->bones.size(), BonePose{{}, {}, {}, {}});
    const PosedBody gone(*body.field, flat);
    EXPECT_EQ(gone.flattened(), flat.size());
    EXPECT_TRUE(std::isinf(gone.at({0, 0, 0}).distance));
    EXPECT_TRUE(std::isinf(gone.freeAround({0, 0, 0})));
}

TEST(BodyField, ABoneWithoutSizeCarriesNoSkin) {
    const auto& [mesh, rig, body, whole] = neck();
    HeadPose pose = rig.pose(mesh, 10);
    pose.bones_ws[0].linear().setZero();
    const PosedBody posed((*body.field), posesOf(body, pose));
    EXPECT_EQ(posed.flattened(), 1u);
    const Vec3f top = pose.bones_ws[1] * Vec3f(0, 0.085f, 0);
    EXPECT_NEAR(posed.at(toEngine(top)).distance, -0.005f, 5e-4f) << "the head is there all the same";
    for (int i = -20; i < 20; ++i) {
        const auto contact = posed.at({0.01f * static_cast<float>(i), -0.1f, 0});
        EXPECT_TRUE(std::isinf(contact.distance) || runtime::isFinite(contact.normal_ws));
    }
}

TEST(BodyField, MovesAsAWholeWithoutSkin) {
    const BakedBody& body = neck().whole;
    HeadPose pose;
    pose.head_ws = Eigen::Translation3f(1, 2, 3) * Eigen::AngleAxisf(1, Vec3f(1, 2, 2).normalized());
    const PosedBody posed((*body.field), posesOf(body, pose));
    const auto contact = posed.at(toEngine(pose.head_ws * Vec3f(0, 0.092f, 0)));
    EXPECT_NEAR(contact.distance, 0.002f, 2e-4f);
    EXPECT_GT(fromEngine(contact.normal_ws).dot(pose.head_ws.linear() * Vec3f::UnitY()), 0.99f);
}

TEST(BodyField, IsTheSameForAnyNumberOfThreads) {
    const auto& [mesh, rig, four, whole] = neck();
    setThreadCount(1);
    const BakedBody one = baked(mesh, rig.skin);
    setThreadCount(0);
    EXPECT_EQ(one.field->distances, four.field->distances);
    EXPECT_EQ(one.field->values, four.field->values);
    EXPECT_EQ(one.field->skins, four.field->skins);
    EXPECT_EQ(one.field->palette, four.field->palette);
}

TEST(BodyField, LeavesOutWhatHairDoesNotReach) {
    const ScalpMesh& mesh = neck().mesh;
    BakeBodyOptions options;
    options.where = Box3f(Vec3f(-0.2f, 0, -0.2f), Vec3f(0.2f, 0.2f, 0.2f));
    const auto body = bakeBody(mesh, {}, {}, options);
    ASSERT_TRUE(body);
    EXPECT_LT(body->cell, neck().whole.cell) << "finer in as many bytes";
    EXPECT_NEAR(body->field->at({0, 0.088f, 0}).distance, -0.002f, 2e-4f);
    EXPECT_TRUE(std::isinf(body->field->at({0, -0.15f, 0}).distance));
}

TEST(BodyField, PartsInsideAreNoSkin) {
    PolygonSoup soup = test::icosphereSoup(4, 0.09f);
    test::append(soup, test::icosphereSoup(3, 0.015f), Vec3f(0.05f, 0, 0));  // an eye
    const BakedBody body = baked(test::meshOf(soup));
    const auto behind = (*body.field).at({0.03f, 0, 0});
    EXPECT_NEAR(behind.distance, -0.06f, 5e-3f) << "the eye is 5 mm away";
    EXPECT_GT(behind.gradient.x, 0.5f);
}

TEST(BodyField, SaysWhatCannotBeBaked) {
    const auto sheet = bakeBody(test::meshOf(test::gridSoup(8, 1)), {});
    ASSERT_FALSE(sheet);
    EXPECT_NE(sheet.error().message().find("encloses no space"), std::string::npos);
    const auto giant = bakeBody(test::meshOf(test::icosphereSoup(3, 90)), {});
    ASSERT_FALSE(giant);
    EXPECT_NE(giant.error().message().find("180"), std::string::npos) << giant.error().message();
    const ScalpMesh mesh = headOnNeck();
    Rig rig(mesh);
    rig.skin.weights.pop_back();
    rig.skin.bones.pop_back();
    EXPECT_FALSE(bakeBody(mesh, rig.skin));
}

TEST(BodyField, HostileTablesAreNone) {
    const runtime::BodyField& good = *neck().whole.field;
    const auto refused = [&](auto&& change) {
        runtime::BodyField bad = good;
        change(bad);
        return !bad.problem().empty();
    };
    EXPECT_TRUE(refused([](auto& f) { f.cell = 0; }));
    EXPECT_TRUE(refused([](auto& f) { f.size[0] = 0xffffffffu; }));
    EXPECT_TRUE(refused([](auto& f) { f.size[1] += 1; }));
    EXPECT_TRUE(refused([](auto& f) { f.distances.pop_back(); }));
    EXPECT_TRUE(refused([](auto& f) { f.skins[5] = 9; }));
    EXPECT_TRUE(refused([](auto& f) { f.blocks[3] = 0x7fff; }));
    EXPECT_TRUE(refused([](auto& f) { f.values.pop_back(); }));
    EXPECT_TRUE(refused([](auto& f) { f.palette[0] = {{1, 0, 0, 0}, {255, 0, 0, 0}}; }));
}

TEST(BodyField, BytesComeBackAndDamagedOnesAreRefused) {
    const runtime::BodyField& field = *neck().skinned.field;
    const std::vector<std::uint8_t> bytes = field.toBytes();
    const auto back = runtime::bodyFieldFromBytes(bytes);
    ASSERT_TRUE(back.field) << back.error;
    EXPECT_EQ(back.field->toBytes(), bytes);
    EXPECT_EQ(back.field->bones, field.bones);
    EXPECT_EQ(back.field->at({0.02f, 0.05f, 0}).distance, field.at({0.02f, 0.05f, 0}).distance);
    // Cut anywhere, and with more behind.
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 7)
        EXPECT_FALSE(runtime::bodyFieldFromBytes(std::span(bytes).first(length)).field) << length;
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(runtime::bodyFieldFromBytes(longer).field);
    // Every bit of the head, and some of the rest: refused, or another field that can be asked anywhere.
    Random random(5);
    for (std::size_t i = 0; i < 52 * 8 + 400; ++i) {
        std::vector<std::uint8_t> damaged = bytes;
        const std::size_t bit =
            i < 52 * 8 ? i : random.below(static_cast<std::uint32_t>(bytes.size())) * 8 + i % 8;
        damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        const auto read = runtime::bodyFieldFromBytes(damaged);
        if (!read.field) continue;
        const std::vector<BonePose> poses(std::max<std::size_t>(read.field->bones.size(), 1));
        const PosedBody posed(*read.field, poses);
        for (const Float3 p : {Float3{0, 0, 0}, Float3{0.09f, 0, 0}, Float3{0, -0.12f, 0.01f}})
            static_cast<void>(posed.at(p));
    }
}

TEST(BodyField, FreeSpaceIsFree) {
    const auto& [mesh, rig, body, whole] = neck();
    const HeadPose pose = rig.pose(mesh, 25);
    const PosedBody posed(*body.field, posesOf(body, pose));
    const MeshSolid truth(pose.scalpPositions_ws, mesh.triangles());
    Random random(6);
    int free = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3f point = test::randomPoint(random, 0.2f);
        const float away = posed.freeAround(toEngine(point));
        if (!(away > 0)) continue;
        ++free;
        EXPECT_GT(truth.signedDistance(point), away) << point.transpose();
    }
    EXPECT_GT(free, 500);
}

/// Hair of 60 strands that stands out from the posed skin, is bent into it here and there, and goes back out.
struct BentHair {
    static constexpr std::uint32_t kPoints = 16;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> rest, posed;

    BentHair(const Neck& neck, const PosedBody& body) {
        Random random(9);
        while (offsets.size() <= 60) {
            const auto root = static_cast<std::size_t>(random.uniform(0, 0.999f) *
                                                       static_cast<float>(neck.mesh.vertexCount()));
            const Vec3f at = neck.mesh.positions()[root];
            const Vec3f along = (0.3f * at.normalized() + test::randomPoint(random, 0.7f)).normalized();
            for (std::uint32_t p = 0; p < kPoints; ++p) {
                const Vec3f point = at + 0.008f * static_cast<float>(p) * along;
                rest.push_back(toEngine(point));
                Vec3f off = test::randomPoint(random, p % 3 == 2 ? 0.02f : 0.003f);
                if (p == 0) off.setZero();
                posed.push_back(body.place(toEngine(point)) + toEngine(off));
            }
            offsets.push_back(static_cast<std::uint32_t>(rest.size()));
        }
    }
};

/// BodyPush without memory: looks everywhere, each time.
void pushByLookingEverywhere(const runtime::BodyField& field, const PosedBody& body,
                             std::span<const Float3> rest, std::span<Float3> hair) {
    constexpr float kKept = 0.0005f, kSlack = 1e-5f;
    static constexpr std::array<std::array<float, 4>, 3> kPlaces{
        {{-9, 111, 29, -3}, {-8, 72, 72, -8}, {-3, 29, 111, -9}}};
    const auto place = [](std::span<const Float3> of, std::size_t p, std::size_t i) {
        const Float3 a = of[p], b = of[p + 1], before = p > 0 ? of[p - 1] : a,
                     after = p + 2 < of.size() ? of[p + 2] : b;
        const auto& k = kPlaces[i];
        return before * (k[0] / 128) + a * (k[1] / 128) + b * (k[2] / 128) + after * (k[3] / 128);
    };
    const auto leastAt = [&](Float3 at) { return std::min(field.at(at).distance, kKept); };
    for (int round = 0; round < 6; ++round) {
        for (std::size_t p = 1; p < hair.size(); ++p) {
            for (int i = 0; i < 3; ++i) {
                const auto contact = body.at(hair[p]);
                const float least = leastAt(rest[p]);
                if (!(contact.distance < least - kSlack)) break;
                hair[p] = hair[p] + contact.normal_ws * (least - contact.distance);
            }
        }
        bool lifted = false;
        for (std::size_t p = 0; p + 1 < hair.size(); ++p) {
            const float most = length(hair[p + 1] - hair[p]);
            for (std::size_t i = p == 0 ? 1 : 0; i < kPlaces.size(); ++i) {
                const auto contact = body.at(place(hair, p, i));
                const float least = leastAt(place(rest, p, i));
                if (!(contact.distance < least - kSlack)) continue;
                const float share = (p == 0 ? 0 : kPlaces[i][1] / 128) + kPlaces[i][2] / 128;
                const Float3 lift = contact.normal_ws * ((least - contact.distance) / share);
                const float size = length(lift);
                const Float3 moved = size > most ? lift * (most / size) : lift;
                if (p > 0) hair[p] = hair[p] + moved;
                hair[p + 1] = hair[p + 1] + moved;
                lifted = true;
            }
        }
        if (!lifted) break;
    }
}

TEST(BodyPush, WhatIsNotLookedAtAgainIsAsItWas) {
    for (const float degrees : {0.0f, 25.0f, -60.0f}) {
        const auto bones = posesOf(neck().skinned, neck().rig.pose(neck().mesh, degrees));
        const auto& field = neck().skinned.field;
        const PosedBody body(*field, bones);
        const BentHair hair(neck(), body);
        std::vector<Float3> pushed = hair.posed, expected = hair.posed;
        runtime::BodyPush(field, {hair.offsets.begin(), hair.offsets.end()}, hair.rest).apply(bones, pushed);
        for (std::size_t h = 0; h + 1 < hair.offsets.size(); ++h)
            pushByLookingEverywhere(*field, body,
                                    std::span(hair.rest).subspan(hair.offsets[h], BentHair::kPoints),
                                    std::span(expected).subspan(hair.offsets[h], BentHair::kPoints));
        std::size_t moved = 0;
        for (std::size_t p = 0; p < pushed.size(); ++p) {
            EXPECT_EQ(pushed[p], expected[p]) << degrees << "°, point " << p;
            moved += pushed[p] == hair.posed[p] ? 0u : 1u;
        }
        EXPECT_GT(moved, 60u) << "there is something to push";
        EXPECT_LT(moved, pushed.size() / 2);
    }
}

}  // namespace
}  // namespace hairloom
