// SPDX-License-Identifier: GPL-3.0-or-later
// What games call: hairloom.h plays assets with the bits of the editor's simulation, and takes no wrong word.

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "core/simulation/clip_motion.h"
#include "core/simulation/simulation.h"
#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_samples.h"
#include "tests/exporters/character_sample.h"
#include "tests/runtime/allocations.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

using game::Asset;
using game::Error;
using game::Frame;
using game::Instance;
using game::kNothing;
using testing::HasSubstr;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFrame = 1.0f / 60.0f;

Groom hairOfADome() {
    Groom groom = dome(5, 2, 12, 0.15f);
    groom.interpolation.followPerGuide = 7;
    groom.simulation.windSpeed = 2;
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}, {"neck", Vec3f(0, 1.5f, 0), 0.06f, ""}};
    return groom;
}

class RuntimeLibrary : public AssetTest {
  protected:
    /// Opened; the bytes live as long as this.
    Asset opened(const Groom& groom) {
        bytes_ = written(groom);
        Asset asset;
        Error error;
        EXPECT_TRUE(asset.open(bytes_.data(), bytes_.size(), &error)) << error.what();
        return asset;
    }
    Groom readBack() const { return importStrands(folder / "a.hairrt")->groom; }

    std::vector<std::byte> bytes_;
};

TEST_F(RuntimeLibrary, GivesTheBitsOfTheEditorsSimulation) {
    for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
        for (const char* const name : {"nod", "spin"}) {
            Groom groom = hairOfADome();
            groom.simulation.strandModel = model;
            if (model == runtime::StrandModel::springs) groom.simulation.substeps = 8;
            Instance hair;
            ASSERT_TRUE(hair.make(opened(groom), HL_GUIDES));
            const Groom asset = readBack();
            const auto motion = makeRigidMotion(name, asset).value();
            auto simulation = Simulation::make(asset, motion->poseAt(0)).value();
            Frame frame(kFrame);
            std::array<float, 12> head = rows(motion->poseAt(0).head_ws.matrix());
            frame.head = head.data();
            ASSERT_TRUE(hair.reset(frame));
            for (int f = 1; f <= 40; ++f) {
                const HeadPose pose = motion->poseAt(static_cast<float>(f) * kFrame);
                simulation.step(kFrame, pose);
                head = rows(pose.head_ws.matrix());
                frame.time += static_cast<double>(kFrame);
                ASSERT_TRUE(hair.step(frame));
                ASSERT_EQ(hair.hash(), simulation.stats().stateHash) << name << ", frame " << f;
            }
            std::vector<float> points;
            ASSERT_TRUE(hair.readGuides(points));
            for (std::size_t p = 0; p < asset.pointCount(); ++p)
                ASSERT_EQ(Vec3f(points[3 * p], points[3 * p + 1], points[3 * p + 2]),
                          simulation.positions_ws()[p]);
        }
    }
}

TEST_F(RuntimeLibrary, SleepsForNothingAndWakesWithTheSameBits) {
    Groom groom = hairOfADome();
    groom.simulation.windSpeed = 0;
    Instance hair;
    ASSERT_TRUE(hair.make(opened(groom), HL_GUIDES));
    const Groom asset = readBack();
    auto simulation = Simulation::make(asset, HeadPose()).value();
    std::array<float, 12> head{};
    Frame frame(kFrame);
    frame.head = head.data();
    HeadPose pose;
    bool slept = false;
    for (int f = 1; f <= 400; ++f) {
        if (f > 300) pose.head_ws.translation().x() = 0.001f * static_cast<float>(f - 300);
        head = rows(pose.head_ws.matrix());
        if (f == 1) {
            ASSERT_TRUE(hair.reset(frame));
        }
        simulation.step(kFrame, pose);
        frame.time += static_cast<double>(kFrame);
        ASSERT_TRUE(hair.step(frame));
        ASSERT_EQ(hair.hash(), simulation.stats().stateHash) << f;
        slept = slept || (f == 300 && hair.describe().asleep == hair.describe().guides);
    }
    EXPECT_TRUE(slept);
    EXPECT_EQ(hair.describe().asleep, 0u);
    const std::uint64_t before = hair.hash();
    ASSERT_TRUE(hair.set("windSpeed", 4));
    for (int f = 0; f < 20; ++f) {
        ASSERT_TRUE(hair.step(frame));
    }
    EXPECT_NE(hair.hash(), before);
}

TEST_F(RuntimeLibrary, FollowsTheBonesOfAClipAsTheEditorDoes) {
    const Character made = character();
    const Asset asset = opened(made.groom);
    const hl_asset_info info = asset.describe();
    ASSERT_GT(info.bones, 0u);
    ASSERT_GT(info.scalp_vertices, 0u);
    std::vector<std::uint32_t> indices, sources(info.scalp_vertices);
    for (std::uint32_t b = 0; b < info.bones; ++b) {
        hl_bone bone{};
        ASSERT_EQ(hl_asset_bone(asset.get(), b, &bone, nullptr), HL_OK);
        indices.push_back(bone.index);
        EXPECT_EQ(std::string(bone.name, bone.name_bytes), made.actor->skeleton().bones()[bone.index].name);
    }
    ASSERT_EQ(hl_asset_scalp_sources(asset.get(), sources.data(), sources.size(), nullptr), HL_OK);
    const auto motion = makeClipMotion(made.actor, made.actor->clips().front().name, made.groom).value();
    auto simulation = Simulation::make(made.groom, motion->poseAt(0)).value();
    Instance byBones, byVertices;
    ASSERT_TRUE(byBones.make(asset, HL_GUIDES));
    ASSERT_TRUE(byVertices.make(asset, HL_GUIDES));
    std::vector<float> bones(12 * indices.size()), vertices(3 * sources.size());
    Frame frame(kFrame);
    frame.bones = bones.data();
    frame.bone_count = indices.size();
    const auto pose = [&](const HeadPose& head) {
        for (std::size_t b = 0; b < indices.size(); ++b) {
            const auto matrix = rows(head.bones_ws[indices[b]].matrix());
            std::copy(matrix.begin(), matrix.end(), bones.begin() + static_cast<std::ptrdiff_t>(12 * b));
        }
        for (std::size_t v = 0; v < sources.size(); ++v) {
            const auto& all = made.groom.scalp->sourceVertices();
            const auto found = std::ranges::find(all, sources[v]) - all.begin();
            const Vec3f& at = head.scalpPositions_ws[static_cast<std::size_t>(found)];
            for (int axis = 0; axis < 3; ++axis) vertices[3 * v + static_cast<std::size_t>(axis)] = at[axis];
        }
    };
    Frame byMesh = frame;
    byMesh.scalp = vertices.data();
    byMesh.scalp_count = sources.size();
    pose(motion->poseAt(0));
    ASSERT_TRUE(byBones.reset(frame));
    ASSERT_TRUE(byVertices.reset(byMesh));
    std::vector<float> a, b;
    float farthest = 0;
    for (int f = 1; f <= 30; ++f) {
        const HeadPose head = motion->poseAt(static_cast<float>(f) * kFrame);
        pose(head);
        simulation.step(kFrame, head);
        frame.time = byMesh.time = static_cast<double>(f) * static_cast<double>(kFrame);
        ASSERT_TRUE(byBones.step(frame));
        ASSERT_TRUE(byVertices.step(byMesh));
        ASSERT_TRUE(byBones.readGuides(a));
        ASSERT_TRUE(byVertices.readGuides(b));
        for (std::size_t p = 0; p < made.groom.pointCount(); ++p) {
            const Vec3f at = simulation.positions_ws()[p];
            farthest = std::max({farthest, (Vec3f(a[3 * p], a[3 * p + 1], a[3 * p + 2]) - at).norm(),
                                 (Vec3f(b[3 * p], b[3 * p + 1], b[3 * p + 2]) - at).norm()});
        }
    }
    EXPECT_LT(farthest, 0.0005f) << "rest positions and weights are rounded";
    EXPECT_GT((simulation.positions_ws()[0] - made.groom.positions()[0]).norm(), 0.001f) << "the clip moves";
}

TEST_F(RuntimeLibrary, ThreadsAndCopiesOfTheFileChangeNoBit) {
    Groom groom = dome(9, 1, 16, 0.2f);
    groom.interpolation.followPerGuide = 3;
    groom.simulation.windSpeed = 4;
    const Asset asset = opened(groom);
    const hl_jobs jobs{nullptr, [](void*, std::size_t count, std::size_t grain,
                                   void (*body)(void*, std::size_t, std::size_t), void* context) {
                           std::vector<std::thread> threads;
                           for (std::size_t begin = 0; begin < count; begin += grain)
                               threads.emplace_back(body, context, begin, std::min(begin + grain, count));
                           for (std::thread& thread : threads) thread.join();
                       }};
    Instance serial, threaded;
    ASSERT_TRUE(serial.make(asset, HL_HAIRS));
    ASSERT_TRUE(threaded.make(asset, HL_HAIRS, &jobs));
    std::fill(bytes_.begin(), bytes_.end(), std::byte{0xdd});  // the instances are on their own now
    Frame frame;
    for (int f = 1; f < 20; ++f) {
        frame.time = f / 60.0;
        ASSERT_TRUE(serial.step(frame));
        ASSERT_TRUE(threaded.step(frame));
    }
    EXPECT_EQ(serial.hash(), threaded.hash());
    std::vector<float> a, b;
    ASSERT_TRUE(serial.readHairs(a));
    ASSERT_TRUE(threaded.readHairs(b));
    EXPECT_EQ(a, b);
}

TEST_F(RuntimeLibrary, StepsAndReadOutAskForNoMemoryAndWhatIsHeldWasSaidBefore) {
    Groom groom = helices(std::vector<std::uint32_t>(3000, 24));
    groom.interpolation.followPerGuide = 2;
    groom.simulation.windSpeed = 2;
    groom.spheres = {{"near", Vec3f(0.5f, 1.5f, 0), 0.1f, "", 1}, {"far", Vec3f(0.5f, 1.1f, 0), 0.05f, ""}};
    const Asset asset = opened(groom);
    const hl_asset_info info = asset.describe();
    for (const std::uint32_t what : {HL_GUIDES, HL_HAIRS}) {
        Instance hair;
        ASSERT_TRUE(hair.make(asset, what));
        const std::size_t stated = info.guides_memory + (what == HL_HAIRS ? info.hairs_memory : 0);
        Frame frame;
        std::vector<float> points;
        std::size_t before = 0;
        for (int f = 1; f < 40; ++f) {
            if (f == 10) before = runtime::allocationCount();
            frame.time = f / 60.0;
            ASSERT_TRUE(hair.step(frame));
            ASSERT_TRUE(what == HL_HAIRS ? hair.readHairs(points) : hair.readGuides(points));
        }
        EXPECT_EQ(runtime::allocationCount(), before);
        EXPECT_LE(hair.describe().bytes, stated);
        EXPECT_GE(1.1 * static_cast<double>(hair.describe().bytes), static_cast<double>(stated));
    }
}

TEST_F(RuntimeLibrary, HairsAreAsDenseAndThickAsTheirLayerSays) {
    Groom groom = hairOfADome();
    groom.interpolation.followPerGuide = 8;
    HairMaterial thick = groom.material;
    thick.rootRadius = 3 * groom.material.rootRadius;
    thick.tipScale = 0.5f;
    groom.layers = {{"Base", true, false, 1, {}}, {"Brows", true, false, 0.5f, thick}};
    std::vector<std::uint32_t> layers(groom.strandCount(), 0);
    layers[2] = 1;
    groom.strandAttributes.set(attribute::kLayer, layers);
    const std::size_t guides = groom.strandCount();
    for (const std::uint32_t levels : {0, HL_LEVELS + 0}) {
        Instance hair;
        ASSERT_TRUE(hair.make(opened(groom), HL_HAIRS | levels));
        Frame frame;
        ASSERT_TRUE(hair.step(frame));
        for (const float share : {1.0f, 0.25f}) {
            if (levels == 0 && share < 1) continue;
            if (levels != 0) {
                ASSERT_TRUE(hair.setLevel(HL_LEVEL_FINEST, share));
            }
            const hl_instance_info info = hair.describe();
            const std::size_t base = share < 1 ? 2 : 8, brows = share < 1 ? 1 : 4;
            ASSERT_EQ(info.hairs, (guides - 1) * base + brows);
            std::vector<float> positions, radii(std::size_t{info.hairs} * info.points_per_hair);
            ASSERT_TRUE(hair.readHairs(positions));
            const hl_out out{radii.data(), radii.size() * sizeof(float), sizeof(float)};
            ASSERT_EQ(hl_instance_read_hairs(hair.get(), {}, {}, out, nullptr), HL_OK);
            const auto all = static_cast<float>((guides - 1) * 8 + 4);
            const float wider = all / static_cast<float>(info.hairs);
            const std::size_t first = 2 * base * info.points_per_hair;
            const std::size_t next = first + brows * info.points_per_hair;
            EXPECT_FLOAT_EQ(radii[first], wider * thick.rootRadius);
            EXPECT_FLOAT_EQ(radii[next - 1], wider * thick.rootRadius * 0.5f);
            EXPECT_FLOAT_EQ(radii[first - info.points_per_hair], wider * groom.material.rootRadius);
            EXPECT_FLOAT_EQ(radii[next], wider * groom.material.rootRadius);
        }
    }
}

TEST_F(RuntimeLibrary, CopiesRunOnWithTheSameBits) {
    const Asset asset = opened(hairOfADome());
    auto first = std::make_unique<Instance>();
    ASSERT_TRUE(first->make(asset, HL_HAIRS));
    Frame frame;
    const auto run = [&](Instance& hair) {
        for (int f = 0; f < 10; ++f) {
            frame.time += 1 / 60.0;
            ASSERT_TRUE(hair.step(frame));
        }
    };
    run(*first);
    Instance copy, again;
    ASSERT_TRUE(copy.copy(*first));
    const double time = frame.time;
    run(*first);
    const std::uint64_t later = first->hash();
    std::vector<float> a, b;
    ASSERT_TRUE(first->readHairs(a));
    EXPECT_NE(copy.hash(), later);
    first.reset();
    ASSERT_TRUE(again.copy(copy));
    frame.time = time;
    run(copy);
    EXPECT_EQ(copy.hash(), later);
    ASSERT_TRUE(copy.readHairs(b));
    EXPECT_EQ(a, b);
    frame.time = time;
    run(again);
    EXPECT_EQ(again.hash(), later);
    EXPECT_EQ(hl_instance_copy(nullptr, nullptr, nullptr), HL_BAD_VALUE);
}

TEST_F(RuntimeLibrary, ValuesGoWhereTheCallerWants) {
    const Asset asset = opened(hairOfADome());
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_HAIRS));
    const hl_instance_info info = hair.describe();
    struct Vertex {
        float position[3], radius, tangent[3], other;
    };
    std::vector<Vertex> vertices(std::size_t{info.hairs} * info.points_per_hair, Vertex{{}, -1, {}, 7});
    const auto out = [&](float& first, std::size_t skipped) {
        return hl_out{&first, vertices.size() * sizeof(Vertex) - skipped, sizeof(Vertex)};
    };
    ASSERT_EQ(hl_instance_read_hairs(hair.get(), out(vertices[0].position[0], 0),
                                     out(vertices[0].tangent[0], 16), out(vertices[0].radius, 12), nullptr),
              HL_OK);
    std::vector<float> positions;
    ASSERT_TRUE(hair.readHairs(positions));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const Vertex& vertex = vertices[v];
        EXPECT_EQ(vertex.position[1], positions[3 * v + 1]);
        EXPECT_NEAR(Vec3f(vertex.tangent[0], vertex.tangent[1], vertex.tangent[2]).norm(), 1, 1e-5);
        EXPECT_EQ(vertex.other, 7);
        if (v % info.points_per_hair == 0) {
            EXPECT_FLOAT_EQ(vertex.radius, HairMaterial().rootRadius);
        }
    }
    std::vector<std::uint32_t> offsets(info.guides + 1);
    ASSERT_EQ(hl_instance_offsets(hair.get(), offsets.data(), offsets.size(), nullptr), HL_OK);
    EXPECT_EQ(offsets.back(), info.guide_points);
    hl_error error{};
    hl_out small{vertices.data(), vertices.size() * sizeof(Vertex) - 21, sizeof(Vertex)};
    EXPECT_EQ(hl_instance_read_hairs(hair.get(), small, kNothing, kNothing, &error), HL_WRONG_SIZE);
    EXPECT_THAT(error.words, HasSubstr("positions"));
    small = {vertices.data(), vertices.size() * sizeof(Vertex), 8};
    EXPECT_EQ(hl_instance_read_guides(hair.get(), small, kNothing, kNothing, &error), HL_WRONG_SIZE);
    EXPECT_EQ(hl_instance_read_hairs(hair.get(), kNothing, kNothing, kNothing, &error), HL_OK)
        << "nothing is a buffer, too";
}

TEST_F(RuntimeLibrary, WrongWordsAreRefusedAndChangeNothing) {
    const Asset asset = opened(hairOfADome());
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES));
    Frame frame;
    ASSERT_TRUE(hair.step(frame));
    const std::uint64_t before = hair.hash();
    Error error;
    const auto refused = [&](const Frame& wrong, hl_code code, const char* words) {
        EXPECT_EQ(hl_instance_step(hair.get(), &wrong, &error), code) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        EXPECT_EQ(error.byte, HL_NO_PLACE);
        EXPECT_EQ(hair.hash(), before) << words;
    };
    float values[24] = {};
    for (const float dt : {-1.0f, 1e-12f, 1e-38f, kNaN, std::numeric_limits<float>::infinity()}) {
        Frame wrong(dt);
        refused(wrong, HL_BAD_VALUE, "dt is");
    }
    Frame wrong = frame;
    wrong.size = 8;
    refused(wrong, HL_WRONG_SIZE, "hl_frame");
    wrong = frame;
    wrong.roots = values;
    wrong.root_count = 2;
    refused(wrong, HL_WRONG_SIZE, "roots");
    wrong = frame;
    wrong.bones = values;
    wrong.bone_count = 2;
    refused(wrong, HL_WRONG_SIZE, "bones");
    wrong = frame;
    wrong.scalp = values;
    wrong.scalp_count = 8;
    refused(wrong, HL_WRONG_SIZE, "scalp vertices");
    wrong = frame;
    wrong.spheres = values;
    wrong.sphere_count = 1u << 30u;
    refused(wrong, HL_WRONG_SIZE, "spheres");
    wrong.sphere_count = 2;
    std::vector<std::uint32_t> ends{0, 1, 1, 2};
    wrong.capsules = ends.data();
    wrong.capsule_count = 2;
    refused(wrong, HL_BAD_VALUE, "capsule 1 ends at sphere 2 of 2");
    ends = {1, 1};
    wrong.capsule_count = 1;
    refused(wrong, HL_BAD_VALUE, "joins sphere 1 with itself");
    wrong.capsule_count = 1u << 20u;
    refused(wrong, HL_WRONG_SIZE, "capsules");
    EXPECT_FALSE(hair.set("windSped", 1, &error));
    EXPECT_FALSE(hair.set("windSpeed", kNaN, &error));
    EXPECT_FALSE(hair.set("angularCurve", 1, &error));
    EXPECT_FALSE(hair.set("gravity", 1, &error));
    EXPECT_THAT(error.words, HasSubstr("expected 3"));
    EXPECT_TRUE(hair.set("windSpeed", 5));
    std::vector<float> points;
    EXPECT_FALSE(hair.readHairs(points, &error)) << "it was made without";
    EXPECT_EQ(hl_instance_step(nullptr, &frame, nullptr), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_step(hair.get(), nullptr, nullptr), HL_BAD_VALUE);
    EXPECT_EQ(hl_asset_open(nullptr, values, sizeof values, nullptr), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make(asset.get(), 9, nullptr, nullptr, &error), HL_BAD_VALUE);
    double number = 0;
    std::size_t count = 0;
    EXPECT_EQ(hl_asset_numbers(asset.get(), "material.rootColour", &number, 1, &count, &error),
              HL_WRONG_SIZE);
    EXPECT_EQ(count, 3u);
    EXPECT_EQ(asset.number("simulation.windSpeed", 0), 2);
    EXPECT_EQ(asset.number("simulation.noSuchThing", -1), -1);
    hl_instance_free(nullptr);
}

TEST_F(RuntimeLibrary, NumbersThatAreNoneAndAnyStepAreSurvived) {
    for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
        Groom groom = hairOfADome();
        groom.simulation.strandModel = model;
        const Asset asset = opened(groom);
        Instance hair;
        ASSERT_TRUE(hair.make(asset, HL_HAIRS));
        const hl_instance_info info = hair.describe();
        std::vector<float> none(std::max<std::size_t>(7 * info.guides, 3 * asset.describe().scalp_vertices),
                                kNaN);
        std::vector<float> points;
        const auto sound = [&](const char* what) {
            ASSERT_TRUE(hair.readHairs(points));
            for (const float value : points)
                ASSERT_TRUE(std::isfinite(value)) << what << " of model " << static_cast<int>(model);
        };
        Frame frame;
        frame.head = none.data();
        ASSERT_TRUE(hair.step(frame));
        EXPECT_EQ(hair.describe().left_roots, info.guides);
        sound("head");
        ASSERT_TRUE(hair.reset(frame));
        sound("reset");
        ASSERT_TRUE(hair.step(Frame()));
        sound("step after reset");
        frame = Frame();
        frame.scalp = none.data();
        frame.scalp_count = asset.describe().scalp_vertices;
        ASSERT_TRUE(hair.step(frame));
        sound("scalp");
        frame = Frame();
        frame.roots = none.data();
        frame.root_count = info.guides;
        ASSERT_TRUE(hair.step(frame));
        sound("roots");
        frame = Frame();
        frame.spheres = none.data();
        frame.sphere_count = 3;
        frame.wind = none.data();
        frame.time = static_cast<double>(kNaN);
        frame.origin[1] = static_cast<double>(kNaN);
        ASSERT_TRUE(hair.step(frame));
        EXPECT_EQ(hair.describe().left_spheres, 3u);
        sound("spheres, wind, time, origin");
        for (const float dt : {1e-6f, 0.1f, 3.0f, 1e6f, 1e30f, kFrame}) {
            ASSERT_TRUE(hair.step(Frame(dt)));
            sound(std::to_string(dt).c_str());
        }
    }
}

TEST_F(RuntimeLibrary, AnAssetsCapsuleAndTheSameOneOfAFrameMoveHairAlike) {
    Groom groom = helices(std::vector<std::uint32_t>(40, 16));
    const Vec3f tip = groom.strand(7).back();
    groom.spheres = {{"from", tip + Vec3f(0, 0, 0.2f), 0.05f, "", 1},
                     {"to", tip - Vec3f(0, 0, 0.2f), 0.04f, ""}};
    Instance own, given, apart;
    ASSERT_TRUE(own.make(opened(groom), HL_GUIDES));
    groom.spheres[0].joined = -1;
    const Asset without = opened(groom);
    ASSERT_TRUE(given.make(without, HL_GUIDES));
    ASSERT_TRUE(apart.make(without, HL_GUIDES));
    std::vector<float> spheres;
    for (const CollisionSphere& sphere : groom.spheres) {
        for (const float value : {sphere.centre.x(), sphere.centre.y(), sphere.centre.z(), sphere.radius})
            spheres.push_back(value);
    }
    const std::uint32_t ends[] = {0, 1};
    for (int f = 1; f < 30; ++f) {
        Frame frame;
        frame.time = f / 60.0;
        ASSERT_TRUE(own.step(frame));
        ASSERT_TRUE(apart.step(frame));
        frame.spheres = spheres.data();
        frame.sphere_count = 2;
        frame.capsules = ends;
        frame.capsule_count = 1;
        ASSERT_TRUE(given.step(frame));
        ASSERT_EQ(own.hash(), given.hash()) << f;
    }
    EXPECT_NE(own.hash(), apart.hash()) << "spheres alone miss the hair between them";
}

TEST_F(RuntimeLibrary, ShortAndLonelyStrandsPlay) {
    for (const auto& counts : {std::vector<std::uint32_t>{2}, {3}, {2, 5}, {512}}) {
        Groom groom = helices(counts);
        groom.interpolation.followPerGuide = 2;
        Instance hair;
        Error error;
        ASSERT_TRUE(hair.make(opened(groom), HL_HAIRS, nullptr, &error)) << error.what();
        std::vector<float> points;
        for (int f = 0; f < 5; ++f) ASSERT_TRUE(hair.step(Frame()));
        ASSERT_TRUE(hair.readHairs(points));
        EXPECT_EQ(points.size(), 3u * 2 * counts.size() * *std::ranges::max_element(counts));
        for (const float value : points) EXPECT_TRUE(std::isfinite(value));
    }
}

TEST_F(RuntimeLibrary, DamagedAndNewerFilesSayWhereAndWhy) {
    opened(hairOfADome());
    Asset asset;
    Error error;
    EXPECT_FALSE(asset.open(bytes_.data(), 40, &error));
    EXPECT_EQ(error.code, HL_DAMAGED);
    EXPECT_EQ(error.byte, 40u);
    EXPECT_FALSE(asset.open(bytes_.data() + 1, 60, &error));
    EXPECT_EQ(error.code, HL_BAD_VALUE);
    bytes_[8] = std::byte{2};
    EXPECT_FALSE(asset.open(bytes_.data(), bytes_.size(), &error));
    EXPECT_EQ(error.code, HL_NEWER);
    EXPECT_THAT(error.words, HasSubstr("version 2"));
    bytes_[8] = std::byte{1};
    bytes_[bytes_.size() - 5] ^= std::byte{4};
    ASSERT_TRUE(asset.open(bytes_.data(), bytes_.size(), &error)) << "opening looks at header and table";
    EXPECT_FALSE(asset.check(&error));
    EXPECT_EQ(error.code, HL_DAMAGED);
    EXPECT_GT(error.byte, 64u);
}

}  // namespace
}  // namespace hairloom::test
