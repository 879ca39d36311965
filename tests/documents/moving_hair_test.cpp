// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that moves and is drawn on the device, beside the same on the CPU.
#include "core/live/moving_hair.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/groom/poses.h"
#include "core/render/flip.h"
#include "core/render/picture.h"
#include "tests/documents/small_head.h"
#include "tests/documents/talking_groom.h"
#include "tests/gpu/test_backend.h"
#include "tests/simulation/hairy_ball.h"

namespace hairloom {
namespace {

constexpr float kFrame = 1.0f / 60;

class MovingHairTest : public testing::Test {
  protected:
    void SetUp() override {
        auto made = gpu::createDevice(gpu::testDevice());
        ASSERT_TRUE(made) << made.error().message();
        device_ = std::move(*made);
        kernels_ = std::make_shared<gpu_simulation::KernelLibrary>(*device_, "");
    }
    void TearDown() override {
        kernels_.reset();
        if (!device_) return;
        for (const std::string& message : device_->validationMessages()) ADD_FAILURE() << message;
    }

    /// A hairstyle that plays.
    struct Stage {
        GroomScene scene;
        const HeadMotion& motion;
        MovingHair hair;
        render::Renderer renderer;
    };
    MovingHair hairOf(const GroomScene& scene, const HeadMotion& motion, EngineKind engine,
                      const MovingStart& start) {
        auto hair = MovingHair::make(engine, *device_, kernels_, scene, motion.skin(), start);
        if (!hair) throw std::runtime_error(hair.error().message());
        return std::move(*hair);
    }
    std::unique_ptr<Stage> stageOf(const Groom& groom, const HeadMotion& motion, EngineKind engine) {
        auto scene = GroomScene::make(groom, {}, {});
        if (!scene) throw std::runtime_error(scene.error().message());
        MovingHair hair = hairOf(*scene, motion, engine, {motion.poseAt(0)});
        auto stage = std::make_unique<Stage>(
            Stage{std::move(*scene), motion, std::move(hair), render::Renderer(*device_)});
        render::RenderScene shown = stage->scene.scene();
        shown.camera = render::frame(render::View::ThreeQuarter, stage->scene.subject(), 1);
        shown.lights = render::studioLights(shown.camera);
        shown.lights.resize(1);
        EXPECT_TRUE(stage->renderer.setScene(shown));
        return stage;
    }
    void play(Stage& stage, int frames) {
        for (int f = 0; f < frames; ++f) {
            auto list = device_->createCommandList();
            ASSERT_TRUE(list) << list.error().message();
            const auto recorded = stage.hair.step(**list, kFrame, stage.motion);
            ASSERT_TRUE(recorded) << recorded.error().message();
            const auto shown = stage.hair.show(stage.renderer, stage.scene);
            ASSERT_TRUE(shown) << shown.error().message();
            auto submission = device_->submit(std::move(*list));
            ASSERT_TRUE(submission) << submission.error().message();
            stage.hair.submitted(*submission);
        }
    }
    static std::vector<Vec3f> positionsOf(Stage& stage) {
        std::vector<Vec3f> positions(stage.scene.rest().pointCount());
        const auto read = stage.hair.readPositions(positions);
        if (!read) throw std::runtime_error(read.error().message());
        return positions;
    }
    render::Image pictureOf(Stage& stage) {
        render::RenderOptions options;
        options.width = options.height = 96;
        options.frames = 4;
        options.samples = 1;
        const auto picture = render::renderPicture(*device_, stage.renderer, options);
        if (!picture) throw std::runtime_error(picture.error().message());
        return picture->image;
    }
    static float farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
        float distance = 0;
        for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, (a[i] - b[i]).norm());
        return distance;
    }

    std::unique_ptr<gpu::Device> device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
};

TEST_F(MovingHairTest, BothEnginesMoveAndDrawAlike) {
    const Groom groom = smallHead();
    const auto rigid = makeRigidMotion("nod", groom).value();
    const SkinnedNod skinned(groom);
    for (const HeadMotion* motion :
         {static_cast<const HeadMotion*>(rigid.get()), static_cast<const HeadMotion*>(&skinned)}) {
        const auto cpu = stageOf(groom, *motion, EngineKind::cpu);
        const auto gpu = stageOf(groom, *motion, EngineKind::gpu);
        play(*cpu, 36);
        play(*gpu, 36);
        EXPECT_LT(farthest(positionsOf(*cpu), positionsOf(*gpu)), 1e-4f);
        const auto before = pictureOf(*cpu);
        const auto flip = render::flipDifference(before, pictureOf(*gpu));
        ASSERT_TRUE(flip);
        // Shadow maps are fitted to where hair was a frame or two ago.
        EXPECT_LT(flip->mean, 0.02);
        const auto rest = stageOf(groom, *motion, EngineKind::cpu);
        EXPECT_GT(render::flipDifference(before, pictureOf(*rest))->mean, 0.03);
    }
}

/// A motion that says by how much hair follows its pose, from the first frame on.
class KeyedPose final : public HeadMotion {
  public:
    explicit KeyedPose(const HeadMotion& head) : head_(head) {}
    HeadPose poseAt(float time) const override {
        HeadPose pose = head_.poseAt(time);
        pose.poseAmounts = {std::min(1.0f, 0.3f + 2 * time)};
        return pose;
    }

  private:
    const HeadMotion& head_;
};

TEST_F(MovingHairTest, BothEnginesFollowPosesAlike) {
    Groom groom = smallHead();
    groom.simulation.strandModel = runtime::StrandModel::rods;
    std::vector<Vec3f> shape(groom.positions().begin(), groom.positions().end());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const Vec3f root = groom.strand(s)[0];
        for (std::uint32_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p)
            shape[p] = root + Eigen::AngleAxisf(0.5f, Vec3f::UnitZ()) * (shape[p] - root);
    }
    ASSERT_TRUE(putPose(groom, "Swept", shape));
    const auto nod = makeRigidMotion("nod", groom).value();
    const KeyedPose keyed(*nod);
    const auto cpu = stageOf(groom, keyed, EngineKind::cpu), gpu = stageOf(groom, keyed, EngineKind::gpu);
    const auto never = stageOf(groom, *nod, EngineKind::gpu);
    play(*cpu, 30);
    play(*gpu, 30);
    play(*never, 30);
    EXPECT_LT(farthest(positionsOf(*cpu), positionsOf(*gpu)), 1e-4f);
    EXPECT_GT(farthest(positionsOf(*never), positionsOf(*gpu)), 0.01f);
    // Amounts that the user sets while it plays.
    const std::vector<float> none{0.0f};
    for (Stage* stage : {cpu.get(), gpu.get()}) EXPECT_TRUE(stage->hair.setPoseAmounts(none));
    EXPECT_FALSE(gpu->hair.setPoseAmounts({}));
}

TEST_F(MovingHairTest, BothEnginesKeepRootsOnAFaceThatTalks) {
    test::TalkingGroom face(40);
    face.groom.interpolation.followPerGuide = 0;
    face.groom.material.rootRadius = 0.0008f;
    const auto talk = makeMotion("clip:talk", {}, face.groom);
    ASSERT_TRUE(talk) << talk.error().message();
    const auto cpu = stageOf(face.groom, **talk, EngineKind::cpu);
    const auto gpu = stageOf(face.groom, **talk, EngineKind::gpu);
    for (const int frames : {15, 12, 18}) {
        play(*cpu, frames);
        play(*gpu, frames);
        const auto here = positionsOf(*cpu), there = positionsOf(*gpu);
        const test::FaceAt now = test::talkAt(cpu->hair.time());
        EXPECT_LT(face.offSkin(here, now), 2e-5) << cpu->hair.time();
        EXPECT_LT(face.offSkin(there, now), 2e-5) << gpu->hair.time();
        EXPECT_LT(farthest(here, there), 1e-4f);
    }
    // The head is drawn where its morph targets have it, in the same light.
    const auto flip = render::flipDifference(pictureOf(*cpu), pictureOf(*gpu));
    ASSERT_TRUE(flip);
    EXPECT_LT(flip->mean, 0.02);
    const auto nod = makeMotion("clip:nod_and_turn", {}, face.groom);
    ASSERT_TRUE(nod);
    const auto still = stageOf(face.groom, **nod, EngineKind::gpu);
    play(*still, 1);
    EXPECT_GT(render::flipDifference(pictureOf(*gpu), pictureOf(*still))->mean, 0.005);
}

/// Hair that falls onto a ball that nods; follow hairs lie between strands, on which no contact holds them.
TEST_F(MovingHairTest, BothEnginesKeepDrawnHairOutOfTheSkin) {
    Groom groom = test::hairyBody();
    groom.interpolation.followPerGuide = 40;
    groom.material.rootRadius = 5e-4f;
    const auto motion = makeRigidMotion("nod", groom);
    ASSERT_TRUE(motion) << motion.error().message();
    const auto gpu = stageOf(groom, **motion, EngineKind::gpu),
               cpu = stageOf(groom, **motion, EngineKind::cpu);
    play(*gpu, 24);
    play(*cpu, 24);
    EXPECT_LT(farthest(positionsOf(*cpu), positionsOf(*gpu)), 2e-3f);
    const render::Image beside = pictureOf(*cpu);
    EXPECT_LT(render::flipDifference(beside, pictureOf(*gpu))->mean, 0.01);
    const auto effects = gpu->hair.stats().effects;
    const auto body = std::ranges::find(effects, "body", &EffectReport::name);
    ASSERT_NE(body, effects.end());
    EXPECT_GT(body->bytes, groom.body->bytes());
    // Without skin it hangs through the ball.
    groom.body.reset();
    const auto through = stageOf(groom, **motion, EngineKind::gpu);
    play(*through, 24);
    EXPECT_GT(render::flipDifference(beside, pictureOf(*through))->mean, 0.03);
}

TEST_F(MovingHairTest, BothEnginesDrawLayersAsDenseAndInTheColoursTheyHave) {
    Groom groom = smallHead();
    HairMaterial red = groom.material;
    red.rootColour = red.tipColour = Vec3f(0.9f, 0.02f, 0.02f);
    HairMaterial pale = groom.material;
    pale.shadingModel = ShadingModel::marschner;
    pale.eumelanin = 0.1f;
    groom.layers = {{"Base", true, false, 1, {}},
                    {"Red", true, false, 2, red},
                    {"Pale", true, false, 0.5f, pale},
                    {"Hidden", false, false, 1, {}}};
    std::vector<std::uint32_t> layers(groom.strandCount());
    for (std::uint32_t s = 0; s < layers.size(); ++s) layers[s] = s % 4;
    groom.strandAttributes.set(attribute::kLayer, layers);
    const auto motion = makeRigidMotion("nod", groom).value();
    const auto cpu = stageOf(groom, *motion, EngineKind::cpu);
    const auto gpu = stageOf(groom, *motion, EngineKind::gpu);
    play(*cpu, 12);
    play(*gpu, 12);
    const auto drawn = pictureOf(*cpu);
    const auto flip = render::flipDifference(drawn, pictureOf(*gpu));
    ASSERT_TRUE(flip);
    EXPECT_LT(flip->mean, 0.02);
    for (Layer& layer : groom.layers) layer.material.reset();
    const auto plain = stageOf(groom, *motion, EngineKind::cpu);
    play(*plain, 12);
    EXPECT_GT(render::flipDifference(drawn, pictureOf(*plain))->mean, 0.03) << "the colours are seen";
}

TEST_F(MovingHairTest, AnotherEngineGoesOnWithoutAStep) {
    for (const auto model : {runtime::StrandModel::springs, runtime::StrandModel::rods}) {
        Groom groom = smallHead();
        groom.simulation.strandModel = model;
        const auto motion = makeRigidMotion("nod", groom).value();
        const auto steady = stageOf(groom, *motion, EngineKind::cpu);
        const auto changing = stageOf(groom, *motion, EngineKind::cpu);
        for (const EngineKind engine : {EngineKind::gpu, EngineKind::cpu, EngineKind::gpu}) {
            play(*steady, 6);
            play(*changing, 6);
            const auto before = positionsOf(*changing);
            const auto state = changing->hair.state();
            ASSERT_TRUE(state) << state.error().message();
            const double time = changing->hair.time();
            changing->hair = hairOf(changing->scene, *motion, engine,
                                    {motion->poseAt(static_cast<float>(time)), *state, time});
            EXPECT_EQ(changing->hair.engine(), engine);
            EXPECT_LT(farthest(before, positionsOf(*changing)), 1e-6f);
        }
        play(*steady, 6);
        play(*changing, 6);
        EXPECT_LT(farthest(positionsOf(*steady), positionsOf(*changing)), 1e-6f);
    }
}

TEST_F(MovingHairTest, NoPointCrosses) {
    Groom groom = smallHead(16);
    groom.interpolation.followPerGuide = 60;
    const auto motion = makeRigidMotion("nod", groom).value();
    const auto stage = stageOf(groom, *motion, EngineKind::gpu);
    play(*stage, 3);
    const gpu::Traffic before = device_->traffic();
    play(*stage, 10);
    const gpu::Traffic after = device_->traffic();
    const auto points = stage->scene.scene().strands.front().positions_ws.size_bytes();
    EXPECT_LT((after.toDevice - before.toDevice) / 10, points / 100);
    EXPECT_LT((after.fromDevice - before.fromDevice) / 10, 64'000u);
}

TEST_F(MovingHairTest, ALiveFrameIsReportedLater) {
    const Groom groom = smallHead();
    const auto motion = makeRigidMotion("nod", groom).value();
    auto scene = GroomScene::make(groom, {}, {}).value();
    auto simulation = Simulation::make(groom, motion->poseAt(0));
    ASSERT_TRUE(simulation);
    auto hair = DeviceHair::make(*device_, kernels_, scene, nullptr, motion->poseAt(0));
    ASSERT_TRUE(hair) << hair.error().message();
    EXPECT_EQ(hair->latestFrame().frame, 0u);
    for (int f = 1; f <= 12; ++f) {
        const float time = kFrame * static_cast<float>(f);
        auto list = device_->createCommandList().value();
        ASSERT_TRUE(hair->record(*list, kFrame, static_cast<double>(time), motion->poseAt(time)));
        auto submission = device_->submit(std::move(list)).value();
        hair->submitted(submission);
        ASSERT_TRUE(submission->wait());
        if (f < 12) simulation->step(kFrame, motion->poseAt(time));
    }
    const DeviceFrame& frame = hair->latestFrame();
    const SimulationStats stats = simulation->stats();
    EXPECT_EQ(frame.frame, 11u);
    EXPECT_NEAR(static_cast<double>(frame.report.fastest), 1e-3 * stats.fastestMmPerSecond, 0.02);
    EXPECT_NEAR(frame.kineticEnergy, stats.energy, 0.01 * stats.energy);
    EXPECT_NEAR(frame.maxStretch, stats.maxStretch, 1e-3);
    EXPECT_NEAR(frame.maxPenetration, 1e-3 * stats.maxPenetrationMm, 1e-4);
    EXPECT_EQ(frame.nanCount, 0u);
}

TEST_F(MovingHairTest, EditsArriveInTheNextFrame) {
    const Groom groom = smallHead();
    const auto motion = makeRigidMotion("none", groom).value();
    auto scene = GroomScene::make(groom, {}, {}).value();
    auto hair = DeviceHair::make(*device_, kernels_, scene, nullptr, {});
    ASSERT_TRUE(hair);
    const auto step = [&](const HeadPose& pose) {
        auto list = device_->createCommandList().value();
        EXPECT_TRUE(hair->record(*list, kFrame, 0, pose));
        hair->submitted(device_->submit(std::move(list)).value());
        std::vector<Vec3f> positions(groom.pointCount());
        EXPECT_TRUE(hair->readPositions(positions));
        return positions;
    };
    const auto rest = step({});
    // A sphere that swallows the tips pushes them out at once.
    CollisionSphere wide;
    wide.radius = 0.2f;
    hair->setSpheres({wide});
    EXPECT_GT(farthest(rest, step({})), 0.01f);
    HeadPose moved;
    moved.head_ws.translate(Vec3f(0.02f, 0, 0));
    const auto shifted = step(moved);
    EXPECT_NEAR(shifted[0].x() - rest[0].x(), 0.02f, 1e-5f);
    runtime::SimulationSettings heavy = groom.simulation;
    heavy.gravity = {0, -200, 0};
    ASSERT_TRUE(hair->setSettings(heavy));
    EXPECT_EQ(hair->engine().settings().gravity.y, groom.simulation.gravity.y);
    step(moved);
    EXPECT_EQ(hair->engine().settings().gravity.y, -200.0f);
}

TEST_F(MovingHairTest, SettingsAndCollidersReachBothEngines) {
    const Groom groom = smallHead();
    const auto motion = makeRigidMotion("none", groom).value();
    const auto scene = GroomScene::make(groom, {}, {}).value();
    for (const EngineKind engine : {EngineKind::cpu, EngineKind::gpu}) {
        SCOPED_TRACE(engineName(engine));
        MovingHair hair = hairOf(scene, *motion, engine, {});
        const auto after = [&](int frames) {
            for (int f = 0; f < frames; ++f) EXPECT_TRUE(hair.step(kFrame, HeadPose()));
            std::vector<Vec3f> positions(groom.pointCount());
            EXPECT_TRUE(hair.readPositions(positions));
            return positions;
        };
        const auto rest = after(1);
        CollisionSphere wide;
        wide.radius = 0.2f;
        hair.setColliders({wide});
        EXPECT_GT(farthest(rest, after(1)), 0.01f);
        hair.setColliders({});
        runtime::SimulationSettings heavy = groom.simulation;
        heavy.gravity = {0, -200, 0};
        ASSERT_TRUE(hair.setSettings(heavy));
        after(30);
        const SimulationStats stats = hair.stats();
        EXPECT_EQ(stats.frames, 32u);
        EXPECT_EQ(stats.nanCount, 0u);
        EXPECT_FALSE(stats.effects.empty());
        runtime::SimulationSettings wrong = heavy;
        wrong.substeps = 0;
        EXPECT_FALSE(hair.setSettings(wrong));
        EXPECT_NEAR(hair.time(), 32 * kFrame, 1e-4);
        EXPECT_GT(farthest(rest, after(1)), 0.005f) << "gravity of 200 m/s² is felt";
    }
}

TEST_F(MovingHairTest, OnlyTheCpuHasOtherMethods) {
    const Groom groom = smallHead();
    SimulationOptions options;
    options.method = SimulationMethod::projective;
    auto hair = MovingHair::onCpu(groom, {}, options);
    ASSERT_TRUE(hair) << hair.error().message();
    ASSERT_TRUE(hair->step(kFrame, HeadPose()));
    EXPECT_FALSE(hair->setSettings(groom.simulation)) << "it is made with them";
    EXPECT_EQ(hair->state().value(), nullptr);
}

TEST(GroomSceneTest, HairsAreTheSameWhileOnlyPointsAndLooksDiffer) {
    const Groom groom = smallHead();
    Groom other = groom;
    other.pointAttributes.edit<Vec3f>(attribute::kPosition)[3].x() += 0.01f;
    other.material.rootRadius *= 2;
    other.simulation.windSpeed += 1;
    other.spheres.clear();
    EXPECT_TRUE(drawSameHairs(groom, other));
    ++other.interpolation.followPerGuide;
    EXPECT_FALSE(drawSameHairs(groom, other)) << "more follow hairs";
    other = groom;
    other.strandAttributes.set(attribute::kHidden, std::vector<std::uint8_t>(groom.strandCount(), 0));
    EXPECT_FALSE(drawSameHairs(groom, other)) << "other strands may be shown";
    other = groom;
    other.scalp.reset();
    EXPECT_FALSE(drawSameHairs(groom, other));
}

TEST(GroomSceneTest, WispsWidenWithSpeed) {
    const Groom groom = smallHead();
    auto scene = GroomScene::make(groom, {}, {}).value();
    const auto tips = [&](const Vec3f& velocity) {
        const std::vector<Vec3f> velocities(groom.pointCount(), velocity);
        scene.pose(groom.positions(), velocities, {});
        const auto drawn = scene.scene().strands.front().positions_ws;
        double spread = 0;
        const std::size_t each = std::size_t{groom.interpolation.followPerGuide} * 8;
        for (std::size_t g = 0; g < groom.strandCount(); ++g) {
            Vec3f middle = Vec3f::Zero();
            for (std::size_t h = 0; h < 4; ++h) middle += drawn[g * each + h * 8 + 7] / 4;
            for (std::size_t h = 0; h < 4; ++h)
                spread += static_cast<double>((drawn[g * each + h * 8 + 7] - middle).norm());
        }
        return spread;
    };
    const double still = tips(Vec3f::Zero());
    // Eq. 22: by the half at the tip, where hairs follow one guide alone.
    EXPECT_GT(tips(Vec3f(0, 0, 3.3f)), 1.1 * still);
}

}  // namespace
}  // namespace hairloom
