// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom/gpu.h: what a game's GPU is given, refused with words where it cannot be. samples/vulkan runs it.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/groom/groom.h"
#include "hairloom/gpu.h"
#include "runtime/shaders/simulation_types.h"
#include "tests/exporters/decorated_sample.h"
#include "tests/exporters/levels_sample.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Instance;
using testing::HasSubstr;

/// Which hair is where on a GPU.
std::vector<std::uint32_t> numbersOfGpu(const game::Asset& asset) {
    std::vector<std::uint32_t> numbers(asset.describe().hairs);
    EXPECT_EQ(hl_gpu_fill(asset.get(), HL_GPU_BUFFER_NUMBERS, numbers.data(), 4 * numbers.size(), nullptr),
              HL_OK);
    return numbers;
}

class RuntimeGpu : public RuntimeLevels {
  protected:
    hl_gpu_buffer_info about(std::uint32_t buffer) const {
        hl_gpu_buffer_info info{};
        info.size = sizeof info;
        Error error;
        EXPECT_EQ(hl_gpu_buffer(asset_.get(), buffer, &info, &error), HL_OK) << error.what();
        return info;
    }
    std::vector<float> filled(Instance& hair, std::uint32_t buffer) const {
        std::vector<float> values(about(buffer).bytes / sizeof(float));
        Error error;
        EXPECT_EQ(hl_gpu_fill_frame(hair.get(), buffer, values.data(), 4 * values.size(), &error), HL_OK)
            << error.what();
        return values;
    }
};

TEST_F(RuntimeGpu, BuffersHaveTheSizesOfWhatTheyHold) {
    const hl_asset_info asset = asset_.describe();
    const std::size_t hairs = asset.hairs, points = asset.points_per_hair, guides = asset.guides;
    EXPECT_EQ(about(HL_GPU_BUFFER_POSITIONS).bytes, 16 * asset.guide_points);
    EXPECT_EQ(about(HL_GPU_BUFFER_TURNS).bytes, 32 * guides);
    EXPECT_EQ(about(HL_GPU_BUFFER_BINDINGS).bytes, 80 * hairs);
    EXPECT_EQ(about(HL_GPU_BUFFER_ROWS).bytes, 64 * guides * points);
    EXPECT_EQ(about(HL_GPU_BUFFER_POINTS).bytes, 16 * hairs * points);
    EXPECT_EQ(about(HL_GPU_BUFFER_VIEW).bytes, sizeof(hl_gpu_view));
    EXPECT_STREQ(about(HL_GPU_BUFFER_LOOKS).name, "LOOKS");
    hl_gpu_pass_info pass{};
    pass.size = sizeof pass;
    ASSERT_EQ(hl_gpu_pass(asset_.get(), HL_GPU_PASS_HAIRS, &pass, nullptr), HL_OK);
    EXPECT_EQ(pass.groups[0], (hairs * points + 63) / 64);
    ASSERT_EQ(hl_gpu_pass(asset_.get(), HL_GPU_PASS_RIBBONS, &pass, nullptr), HL_OK);
    EXPECT_EQ(pass.vertices, 2 * points);
    EXPECT_EQ(pass.instances, hairs);
}

TEST_F(RuntimeGpu, LooksAreThoseOfTheHairs) {
    std::vector<hl_hair> hairs(asset_.describe().hairs);
    ASSERT_EQ(hl_asset_hairs(asset_.get(), hairs.data(), sizeof(hl_hair), hairs.size(), nullptr), HL_OK);
    std::vector<float> looks(8 * hairs.size());
    ASSERT_EQ(hl_gpu_fill(asset_.get(), HL_GPU_BUFFER_LOOKS, looks.data(), 4 * looks.size(), nullptr), HL_OK);
    const std::vector<std::uint32_t> numbers = numbersOfGpu(asset_);
    for (std::size_t h = 0; h < hairs.size(); ++h) {
        const hl_hair& hair = hairs[numbers[h]];
        EXPECT_EQ(std::memcmp(&looks[8 * h], hair.colour, 12), 0);
        EXPECT_EQ(looks[8 * h + 3], hair.random);
        EXPECT_EQ(looks[8 * h + 4], hair.root_radius);
        EXPECT_EQ(looks[8 * h + 5], hair.tip_radius);
    }
}

TEST_F(RuntimeGpu, ALampHasAGridAroundTheHair) {
    const float centre[3] = {1, 2, 3};
    for (const Vec3f& to : {Vec3f(0, 1, 0), Vec3f(0.5f, 0.7f, -0.5f), Vec3f(0, -1e-3f, 2e-3f)}) {
        hl_gpu_lamp lamp;
        Error error;
        ASSERT_EQ(hl_gpu_lamp_init(to.data(), centre, 0.25f, &lamp, &error), HL_OK) << error.what();
        const Vec3f towards = to.normalized();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(lamp.to_light[c], towards[c], 1e-6f);
        const auto place = [&](const Vec3f& at) {
            Vec3f in;
            int row = 0;
            for (const float* one : {lamp.across, lamp.up, lamp.away})
                in[row++] = one[0] * at.x() + one[1] * at.y() + one[2] * at.z() + one[3];
            return in;
        };
        const Vec3f middle(1, 2, 3), across = towards.unitOrthogonal();
        EXPECT_LT((place(middle) - Vec3f::Constant(0.5f)).norm(), 1e-5f);
        EXPECT_NEAR(place(middle + 0.25f * towards).z(), 0, 1e-5f) << "where the light comes in";
        EXPECT_NEAR(place(middle - 0.25f * towards).z(), 1, 1e-5f);
        const Vec3f beside = place(middle + 0.25f * across);
        EXPECT_NEAR(std::hypot(beside.x() - 0.5f, beside.y() - 0.5f), 0.5f, 1e-5f);
        EXPECT_NEAR(beside.z(), 0.5f, 1e-5f);
        EXPECT_NEAR(lamp.ground[3], 0.5 / 128 * (0.5 / 128), 1e-9) << "square metres of a column";
        EXPECT_EQ(lamp.light[3], 0) << "the first of a frame";
    }
}

TEST_F(RuntimeGpu, ALampThatIsNoneIsRefused) {
    const float to[3] = {0, 1, 0}, at[3] = {0, 1.6f, 0}, zero[3] = {0, 0, 0},
                none[3] = {0, std::numeric_limits<float>::quiet_NaN(), 0};
    hl_gpu_lamp lamp, before;
    std::memset(&lamp, 0x5a, sizeof lamp);
    before = lamp;
    Error error;
    const auto refused = [&](const float* direction, const float* place, float radius, const char* words) {
        EXPECT_EQ(hl_gpu_lamp_init(direction, place, radius, &lamp, &error), HL_BAD_VALUE) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        EXPECT_EQ(std::memcmp(&lamp, &before, sizeof lamp), 0);
    };
    refused(nullptr, at, 1, "no direction, place or lamp");
    refused(zero, at, 1, "to_light is no direction");
    refused(none, at, 1, "to_light is no direction");
    refused(to, none, 1, "centre or radius");
    refused(to, at, 0, "centre or radius");
    refused(to, at, std::numeric_limits<float>::infinity(), "centre or radius");
    EXPECT_EQ(hl_gpu_lamp_init(to, at, 1, nullptr, &error), HL_BAD_VALUE);
}

TEST_F(RuntimeGpu, AnAssetWithoutMaterialsIsDrawnByTheColoursOfItsSettings) {
    Groom groom = decorated();
    groom.material.rootColour = Vec3f(0.5f, 0.25f, 0.125f);
    HairMaterial own;
    own.tipColour = Vec3f(0.1f, 0.2f, 0.3f);
    groom.layers[1].material = own;
    const std::vector<std::byte> bytes = written(groom);
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    std::vector<float> materials(2 * 72);
    ASSERT_EQ(hl_gpu_fill(asset.get(), HL_GPU_BUFFER_MATERIALS, materials.data(), 576, nullptr), HL_OK);
    EXPECT_EQ(materials[0], 0.5f);
    EXPECT_EQ(materials[2], 0.125f);
    EXPECT_EQ(materials[72 + 5], 0.2f) << "at the tip of the second layer";
    std::vector<float> shades(8 * asset.describe().hairs);
    ASSERT_EQ(hl_gpu_fill(asset.get(), HL_GPU_BUFFER_SHADES, shades.data(), 4 * shades.size(), nullptr),
              HL_OK);
    std::vector<hl_hair> hairs(asset.describe().hairs);
    ASSERT_EQ(hl_asset_hairs(asset.get(), hairs.data(), sizeof(hl_hair), hairs.size(), nullptr), HL_OK);
    for (std::size_t h = 0; h < hairs.size(); ++h) {
        std::uint32_t material = 0, number = 0;
        std::memcpy(&material, &shades[8 * h], 4);
        std::memcpy(&number, &shades[8 * h + 1], 4);
        EXPECT_EQ(material, hairs[number].layer);
        EXPECT_EQ(shades[8 * h + 4], 1) << "pigment";
        EXPECT_EQ(shades[8 * h + 6], 1) << "strands have colours";
    }
    hl_gpu_pass_info pass{};
    pass.size = sizeof pass;
    ASSERT_EQ(hl_gpu_pass(asset.get(), HL_GPU_PASS_LAMP_SUM, &pass, nullptr), HL_OK);
    EXPECT_EQ(pass.groups[0], 128u * 128 / 64);
}

TEST_F(RuntimeGpu, AShareOfTheHairsIsTheFirstOfThem) {
    // Guides of two layers have other numbers of hairs.
    const std::vector<std::byte> bytes = written(decorated());
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    const std::vector<std::uint32_t> numbers = numbersOfGpu(asset);
    std::vector<std::uint32_t> all = numbers;
    std::sort(all.begin(), all.end());
    for (std::size_t h = 0; h < all.size(); ++h) ASSERT_EQ(all[h], h) << "each hair once";
    Instance onGpu, onCpu;
    ASSERT_TRUE(onGpu.make(asset, HL_GUIDES | HL_LEVELS));
    ASSERT_TRUE(onCpu.make(asset, HL_HAIRS | HL_LEVELS));
    Error error;
    std::size_t fewest = all.size();
    std::vector<float> shares{1e-6f, 1};
    for (const float ofGuide : {3.0f, 6.0f}) {
        for (float rank = 1; rank < ofGuide; ++rank) {
            for (const float past : {0.0f, 2.0f}) {
                const float share = rank / ofGuide;
                shares.insert(shares.end(), {share, std::nextafter(share, past),
                                             std::nextafter(std::nextafter(share, past), past)});
            }
        }
    }
    for (const float share : shares) {
        ASSERT_TRUE(onGpu.setLevel(HL_LEVEL_FINEST, share));
        ASSERT_TRUE(onCpu.setLevel(HL_LEVEL_FINEST, share));
        const hl_instance_info info = onCpu.describe();
        std::vector<std::uint32_t> read(info.hairs);
        ASSERT_EQ(hl_instance_hair_numbers(onCpu.get(), read.data(), read.size(), nullptr), HL_OK);
        ASSERT_LE(read.size(), numbers.size());
        std::vector<std::uint32_t> drawn(numbers.begin(),
                                         numbers.begin() + static_cast<std::ptrdiff_t>(read.size()));
        std::sort(drawn.begin(), drawn.end());
        EXPECT_EQ(drawn, read) << "share " << static_cast<double>(share);
        hl_gpu_pass_info pass{};
        pass.size = sizeof pass;
        ASSERT_EQ(hl_gpu_frame_pass(onGpu.get(), HL_GPU_PASS_RIBBONS, &pass, &error), HL_OK) << error.what();
        EXPECT_EQ(pass.instances, info.hairs);
        ASSERT_EQ(hl_gpu_frame_pass(onGpu.get(), HL_GPU_PASS_HAIRS, &pass, &error), HL_OK);
        EXPECT_EQ(pass.groups[0], (info.hairs * info.points_per_hair + 63) / 64);
        hl_gpu_view view;
        ASSERT_EQ(hl_gpu_view_init(asset.get(), &view, nullptr), HL_OK);
        ASSERT_EQ(hl_gpu_frame_view(onGpu.get(), &view, nullptr), HL_OK);
        EXPECT_EQ(view.hairs, info.hairs);
        EXPECT_FLOAT_EQ(view.specular[3], static_cast<float>(all.size()) / static_cast<float>(info.hairs));
        std::array<std::uint32_t, 8> constants{};
        ASSERT_EQ(hl_gpu_fill_frame(onGpu.get(), HL_GPU_BUFFER_CONSTANTS, constants.data(), sizeof constants,
                                    &error),
                  HL_OK);
        EXPECT_EQ(constants[1], info.hairs);
        fewest = std::min(fewest, read.size());
    }
    EXPECT_EQ(fewest, asset.describe().guides) << "one of each guide";
    // Passes of guides are those of all hairs.
    for (const std::uint32_t pass : {HL_GPU_PASS_GUIDES, HL_GPU_PASS_WISPS}) {
        hl_gpu_pass_info whole{}, some{};
        whole.size = some.size = sizeof whole;
        ASSERT_EQ(hl_gpu_pass(asset.get(), pass, &whole, nullptr), HL_OK);
        ASSERT_EQ(hl_gpu_frame_pass(onGpu.get(), pass, &some, nullptr), HL_OK);
        EXPECT_EQ(some.groups[0], whole.groups[0]);
    }
}

TEST_F(RuntimeGpu, FramesHaveTheGuidesAtEveryLevelAndAskForMemoryOnce) {
    Instance alone;
    ASSERT_TRUE(alone.make(asset_, HL_GUIDES));
    for (int f = 1; f <= 10; ++f) ASSERT_TRUE(alone.step(Walk(f).frame));
    const std::vector<Vec3f> seen = guides(alone);
    const std::vector<float> positions = filled(alone, HL_GPU_BUFFER_POSITIONS);
    float fastest = 0;
    const std::vector<float> velocities = filled(alone, HL_GPU_BUFFER_VELOCITIES);
    for (std::size_t p = 0; p < seen.size(); ++p) {
        EXPECT_EQ(std::memcmp(&positions[4 * p], &seen[p], 12), 0) << p;
        EXPECT_EQ(positions[4 * p + 3], 1);
        fastest = std::max(fastest, std::abs(velocities[4 * p]));
    }
    EXPECT_GT(fastest, 0.1f) << "m/s of a head that nods";
    const std::vector<float> turns = filled(alone, HL_GPU_BUFFER_TURNS);
    const float angle = 2 * std::asin(std::abs(turns[5]));
    EXPECT_NEAR(angle, 0.3 * std::sin(1.0), 1e-3) << "Walk(10) about the axis of y";
    std::vector<float> again(positions.size());
    const std::size_t before = runtime::allocationCount();
    for (const std::uint32_t buffer : {HL_GPU_BUFFER_POSITIONS, HL_GPU_BUFFER_VELOCITIES})
        hl_gpu_fill_frame(alone.get(), buffer, again.data(), 4 * again.size(), nullptr);
    EXPECT_EQ(runtime::allocationCount(), before);
    Instance coarse = another();
    for (std::uint32_t level = 0; level < HL_LEVEL_COUNT; ++level) {
        ASSERT_TRUE(coarse.setLevel(level));
        ASSERT_TRUE(coarse.step(Walk(11).frame));
        const std::vector<Vec3f> shown = guides(coarse);
        const std::vector<float> given = filled(coarse, HL_GPU_BUFFER_POSITIONS);
        for (std::size_t p = 0; p < shown.size(); ++p)
            ASSERT_EQ(std::memcmp(&given[4 * p], &shown[p], 12), 0);
    }
}

TEST_F(RuntimeGpu, GuidesOfTheGpuAreToldWhereTheyAreAndWhereRootsGo) {
    Instance hair;
    Error error;
    ASSERT_TRUE(hair.make(asset_, HL_GUIDES));
    for (int f = 1; f <= 5; ++f) ASSERT_TRUE(hair.step(Walk(f).frame));
    ASSERT_EQ(hl_gpu_begin(hair.get(), &error), HL_OK) << error.what();
    const std::vector<Vec3f> seen = guides(hair);
    const std::vector<float> state = filled(hair, HL_GPU_BUFFER_STATE),
                             roots = filled(hair, HL_GPU_BUFFER_ROOTS);
    const std::vector<float> lengths = filled(hair, HL_GPU_BUFFER_SEGMENTS);
    const std::vector<float> first = filled(hair, HL_GPU_BUFFER_FIRST_POINTS);
    const std::size_t slots = first.size(), points = lengths.size() / 2 / slots, plane = slots * points;
    ASSERT_EQ(state.size(), 7 * plane);
    std::size_t found = 0;
    for (std::size_t slot = 0; slot < slots; ++slot) {
        std::uint32_t at = 0;
        std::memcpy(&at, &first[slot], sizeof at);
        // Slots behind the guides of a block repeat its last, those behind the blocks are empty.
        if (at == ~0u || lengths[2 * slot] == 0) continue;
        ++found;
        for (std::size_t p = 0; p < points; ++p) {
            const std::size_t i = p * slots + slot;
            const Vec3f root(roots[slot], roots[slots + slot], roots[2 * slots + slot]);
            const Vec3f point = root + Vec3f(state[i], state[plane + i], state[2 * plane + i]);
            EXPECT_EQ(point, seen[at + p]) << slot << ", " << p;
        }
    }
    EXPECT_EQ(found, asset_.describe().guides);
    const Walk next(6);
    ASSERT_EQ(hl_gpu_step(hair.get(), &next.frame, &error), HL_OK) << error.what();
    ASSERT_TRUE(first_.step(next.frame));
    const std::vector<float> to = filled(hair, HL_GPU_BUFFER_ROOTS_TO);
    const std::vector<Vec3f> walked = guides(first_);
    for (std::size_t slot = 0; slot < found; ++slot) {
        std::uint32_t at = 0;
        std::memcpy(&at, &first[slot], sizeof at);
        if (at == ~0u) continue;
        EXPECT_EQ(Vec3f(to[8 * slot], to[8 * slot + 1], to[8 * slot + 2]), walked[at]) << slot;
        EXPECT_EQ(to[8 * slot + 3], 1) << "it moves";
    }
    const std::vector<float> turns = filled(hair, HL_GPU_BUFFER_TURNS);
    EXPECT_EQ(Vec3f(turns[0], turns[1], turns[2]), walked[0]);
    EXPECT_EQ(filled(hair, HL_GPU_BUFFER_SPHERES)[3], 0.095f);
    EXPECT_EQ(guides(hair), seen) << "the CPU knows nothing of it";
}

TEST_F(RuntimeGpu, GuidesOfTheGpuAreAskedForInOrder) {
    Instance hair;
    Error error;
    ASSERT_TRUE(hair.make(asset_, HL_GUIDES | HL_LEVELS));
    std::vector<std::byte> room(about(HL_GPU_BUFFER_SCRATCH).bytes, std::byte{0x5a});
    const std::vector<std::byte> untouched = room;
    const auto refused = [&](hl_code code, const char* words) {
        EXPECT_EQ(code, HL_BAD_VALUE) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        EXPECT_EQ(room, untouched) << words;
    };
    const auto fill = [&](std::uint32_t buffer) {
        return hl_gpu_fill_frame(hair.get(), buffer, room.data(), about(buffer).bytes, &error);
    };
    const Walk walk(1);
    refused(hl_gpu_step(hair.get(), &walk.frame, &error), "hl_gpu_begin() comes before");
    refused(fill(HL_GPU_BUFFER_STATE), "STATE is filled between");
    refused(fill(HL_GPU_BUFFER_STEP), "STEP is filled after hl_gpu_step()");
    refused(fill(HL_GPU_BUFFER_SCRATCH), "SCRATCH is none");
    ASSERT_EQ(hl_gpu_begin(hair.get(), &error), HL_OK);
    refused(fill(HL_GPU_BUFFER_ROOTS_TO), "ROOTS_TO is filled after hl_gpu_step()");
    ASSERT_EQ(hl_gpu_step(hair.get(), &walk.frame, &error), HL_OK);
    refused(fill(HL_GPU_BUFFER_STATE), "STATE is filled between");
    refused(fill(HL_GPU_BUFFER_POSITIONS), "POSITIONS is what the pass GUIDES makes");
    game::Frame frame = walk.frame;
    const std::vector<float> spheres(4 * 33, 0.1f);
    frame.spheres = spheres.data();
    frame.sphere_count = 33;
    EXPECT_EQ(hl_gpu_step(hair.get(), &frame, &error), HL_WRONG_SIZE);
    EXPECT_THAT(error.words, HasSubstr("33 spheres; expected at most 32"));
    frame.sphere_count = 32;
    EXPECT_EQ(hl_gpu_step(hair.get(), &frame, &error), HL_OK) << error.what();
    // Two that share an end.
    const std::uint32_t ends[] = {0, 1, 1, 2};
    frame.capsules = ends;
    frame.capsule_count = 2;
    EXPECT_EQ(hl_gpu_step(hair.get(), &frame, &error), HL_WRONG_SIZE);
    EXPECT_THAT(error.words, HasSubstr("33 spheres with the ends of each capsule; expected at most 32"));
    frame.capsule_count = 1;
    EXPECT_EQ(hl_gpu_step(hair.get(), &frame, &error), HL_OK) << error.what();
    Instance copied;
    ASSERT_TRUE(copied.copy(hair));
    refused(hl_gpu_step(copied.get(), &frame, &error), "hl_gpu_begin() comes before");
    frame.dt = -1;
    refused(hl_gpu_step(hair.get(), &frame, &error), "dt is -1");
    // What moves the hair on the CPU ends it.
    ASSERT_TRUE(hair.step(walk.frame));
    refused(hl_gpu_step(hair.get(), &walk.frame, &error), "hl_gpu_begin() comes before");
    ASSERT_TRUE(hair.setLevel(HL_LEVEL_RIGID));
    refused(hl_gpu_begin(hair.get(), &error), "level 4; the GPU steps the finest alone");
    refused(hl_gpu_begin(nullptr, &error), "no instance");
    // Of other models and roots there is no kernel.
    Groom springs = this->hair();
    springs.simulation.strandModel = runtime::StrandModel::springs;
    const std::vector<std::byte> bytes = written(springs);
    game::Asset other;
    ASSERT_TRUE(other.open(bytes.data(), bytes.size()));
    ASSERT_TRUE(hair.make(other, HL_GUIDES));
    refused(hl_gpu_begin(hair.get(), &error), "strandModel is springs");
}

/// Each of the most spheres has been and is somewhere, and so has each capsule of two.
TEST_F(RuntimeGpu, AllThatWakesHairFitsItsBuffer) {
    Instance hair;
    Error error;
    ASSERT_TRUE(hair.make(asset_, HL_GUIDES));
    ASSERT_EQ(hl_gpu_begin(hair.get(), &error), HL_OK);
    std::vector<float> spheres;
    std::vector<std::uint32_t> ends;
    for (std::uint32_t i = 0; i < HL_GPU_SPHERES; ++i) {
        const float x = 0.05f * static_cast<float>(i);
        spheres.insert(spheres.end(), {x, 0.1f, 0, 0.05f});
        ends.push_back(i);
    }
    const auto step = [&](int number) {
        Walk walk(number);
        walk.frame.spheres = spheres.data();
        walk.frame.sphere_count = HL_GPU_SPHERES;
        walk.frame.capsules = ends.data();
        walk.frame.capsule_count = HL_GPU_SPHERES / 2;
        ASSERT_EQ(hl_gpu_step(hair.get(), &walk.frame, &error), HL_OK) << error.what();
    };
    step(1);
    for (std::size_t i = 1; i < spheres.size(); i += 4) spheres[i] += 0.02f;
    step(2);
    const std::vector<float> constants = filled(hair, HL_GPU_BUFFER_STEP);
    std::uint32_t waking = 0;
    std::memcpy(&waking, &constants[offsetof(shaders::SimulationConstants, wakingCount) / sizeof(float)],
                sizeof waking);
    EXPECT_GT(waking, 2u * HL_GPU_SPHERES);
    EXPECT_LE(waking * 16u, about(HL_GPU_BUFFER_WAKING).bytes);
}

TEST_F(RuntimeGpu, WrongWordsAreRefusedAndNothingIsWritten) {
    std::vector<std::byte> room(1u << 20, std::byte{0x5a});
    const std::vector<std::byte> untouched = room;
    Error error;
    const auto refused = [&](hl_code code, hl_code wanted, const char* words) {
        EXPECT_EQ(code, wanted) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        EXPECT_EQ(room, untouched) << words;
    };
    const hl_asset* const asset = asset_.get();
    hl_instance* const instance = first_.get();
    const std::size_t bytes = about(HL_GPU_BUFFER_LOOKS).bytes, frame = about(HL_GPU_BUFFER_TURNS).bytes;
    refused(hl_gpu_fill(asset, HL_GPU_BUFFER_LOOKS, room.data(), bytes - 1, &error), HL_WRONG_SIZE, "LOOKS");
    refused(hl_gpu_fill(asset, HL_GPU_BUFFER_LOOKS, nullptr, bytes, &error), HL_BAD_VALUE, "no place");
    refused(hl_gpu_fill(asset, HL_GPU_BUFFER_TURNS, room.data(), frame, &error), HL_BAD_VALUE, "TURNS");
    refused(hl_gpu_fill(asset, 99, room.data(), bytes, &error), HL_BAD_VALUE, "99");
    refused(hl_gpu_fill_frame(instance, HL_GPU_BUFFER_TURNS, room.data(), frame + 16, &error), HL_WRONG_SIZE,
            "TURNS");
    refused(hl_gpu_fill_frame(instance, HL_GPU_BUFFER_POINTS, room.data(), 16, &error), HL_BAD_VALUE,
            "POINTS");
    refused(hl_gpu_fill_frame(nullptr, HL_GPU_BUFFER_TURNS, room.data(), frame, &error), HL_BAD_VALUE,
            "no instance");
    hl_gpu_pass_info pass{};
    refused(hl_gpu_pass(asset, 0, &pass, &error), HL_WRONG_SIZE, "hl_gpu_pass_info");
    pass.size = sizeof pass;
    refused(hl_gpu_pass(asset, HL_GPU_PASS_COUNT, &pass, &error), HL_BAD_VALUE, "pass 9 of 9");
    hl_gpu_buffer_info info{};
    info.size = 7;
    refused(hl_gpu_buffer(asset, 0, &info, &error), HL_WRONG_SIZE, "hl_gpu_buffer_info");
    refused(hl_gpu_view_init(asset, nullptr, &error), HL_BAD_VALUE, "no view");
    refused(hl_gpu_frame_view(instance, nullptr, &error), HL_BAD_VALUE, "no view");
    refused(hl_gpu_frame_pass(nullptr, 0, &pass, &error), HL_BAD_VALUE, "no instance");
    refused(hl_gpu_frame_pass(instance, HL_GPU_PASS_COUNT, &pass, &error), HL_BAD_VALUE, "pass 9 of 9");
    pass.size = 5;
    refused(hl_gpu_frame_pass(instance, 0, &pass, &error), HL_WRONG_SIZE, "hl_gpu_pass_info");
    // Hair of guides alone.
    Groom bald = hair();
    bald.interpolation.followPerGuide = 0;
    const std::vector<std::byte> plain = written(bald);
    game::Asset guidesAlone;
    ASSERT_TRUE(guidesAlone.open(plain.data(), plain.size()));
    Instance few;
    ASSERT_TRUE(few.make(guidesAlone, HL_GUIDES));
    info.size = sizeof info;
    refused(hl_gpu_buffer(guidesAlone.get(), 0, &info, &error), HL_BAD_VALUE, "without follow hairs");
    refused(hl_gpu_fill_frame(few.get(), HL_GPU_BUFFER_TURNS, room.data(), frame, &error), HL_BAD_VALUE,
            "without follow hairs");
}

}  // namespace
}  // namespace hairloom::test
