// SPDX-License-Identifier: GPL-3.0-or-later
// hl_set_allocator: every piece that a host sees it gets back, C++ has no other memory, and each piece that
// there is not leaves hair as it was.

#include <gmock/gmock.h>

#include <functional>
#include <memory>
#include <string_view>

#include "core/simulation/bake_body.h"
#include "tests/exporters/lent_memory.h"
#include "tests/geometry/test_meshes.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

/// Few hairs on a ball with a skin, on two layers, that collide with each other.
Groom ballOfHair() {
    auto mesh = std::make_shared<const ScalpMesh>(meshOf(icosphereSoup(3, 0.1f)));
    FaceSet top;
    std::vector<SurfacePoint> roots;
    for (std::uint32_t t = 0; t < mesh->triangleCount(); ++t) {
        if (mesh->pointAt(t, Vec3f(1, 1, 1) / 3).y() < 0.05f) continue;
        top.push_back(t);
        if (t % 11 == 0) roots.push_back({t, Vec3f(0.3f, 0.3f, 0.4f)});
    }
    Groom groom = growStraight(mesh, top, roots, 0.12f, 10).value();
    groom.interpolation.followPerGuide = 5;
    groom.simulation.hairHair = true;
    groom.body = bakeBodyOf(groom, nullptr).value().field;
    std::vector<std::uint32_t> layers;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) layers.push_back(s % 2);
    HairMaterial own;
    own.rootColour = Vec3f(0.3f, 0.1f, 0);
    groom.layers = {{"Base", true, false, 1, {}}, {"Brows", true, false, 0.5f, own}};
    groom.strandAttributes.set(attribute::kLayer, layers);
    return groom;
}

/// As few as may be, for calls that are made as often as they ask for memory.
Groom fewHairs() {
    Groom groom = dome(2, 2, 5, 0.1f);
    groom.interpolation.followPerGuide = 3;
    groom.simulation.hairHair = true;
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}};
    return groom;
}

class Allocator : public LentMemory {
  protected:
    void prepare() override {
        bytes_ = written(ballOfHair());
        few_ = written(fewHairs());
    }
    void SetUp() override {
        LentMemory::SetUp();
        open(bytes_);
    }
    /// All that a game may ask of the hair, one call after the other.
    std::vector<std::pair<const char*, std::function<hl_code(hl_instance*, hl_error*)>>> calls() {
        return {
            {"step", [this](hl_instance* h, hl_error* e) { return hl_instance_step(h, &moved_.frame, e); }},
            {"alone", [this](hl_instance* h, hl_error* e) { return hl_instance_step(h, &alone_.frame, e); }},
            {"guides", [this](hl_instance* h, hl_error* e) { return read(h, false, e); }},
            {"hairs", [this](hl_instance* h, hl_error* e) { return read(h, true, e); }},
            {"coarser", [](hl_instance* h, hl_error* e) { return hl_instance_set_level(h, 2, 0.5f, e); }},
            {"step coarser",
             [this](hl_instance* h, hl_error* e) { return hl_instance_step(h, &moved_.frame, e); }},
            {"hairs coarser", [this](hl_instance* h, hl_error* e) { return read(h, true, e); }},
            {"finest", [](hl_instance* h, hl_error* e) { return hl_instance_set_level(h, 0, 1, e); }},
            {"set",
             [](hl_instance* h, hl_error* e) {
                 const double wind = 4;
                 return hl_instance_set(h, "windSpeed", &wind, 1, e);
             }},
            {"save and load",
             [this](hl_instance* h, hl_error* e) {
                 std::size_t bytes = 0;
                 void* const at = floats_.data();
                 if (const hl_code code = hl_instance_save(h, at, 4 * floats_.size(), &bytes, e)) return code;
                 return hl_instance_load(h, at, bytes, e);
             }},
            {"reserve",
             [](hl_instance* h, hl_error* e) {
                 hl_reserve reserve;
                 hl_reserve_init(&reserve);
                 reserve.spheres = 30;
                 reserve.previous_guides = reserve.previous_hairs = 1;
                 return hl_instance_reserve(h, &reserve, e);
             }},
            {"copy",
             [](hl_instance* h, hl_error* e) {
                 hl_instance* copy = nullptr;
                 const hl_code code = hl_instance_copy(h, &copy, e);
                 EXPECT_EQ(copy != nullptr, code == HL_OK);
                 hl_instance_free(copy);
                 return code;
             }},
            {"plan",
             [](hl_instance* h, hl_error* e) {
                 hl_crowd_limits limits;
                 hl_crowd_limits_init(&limits);
                 hl_viewed viewed{h, 500, 0, 0, 0};
                 if (const hl_code code = hl_crowd_plan(&limits, &viewed, 1, nullptr, e)) return code;
                 return hl_instance_set_level(h, 0, 1, e);
             }},
            {"rate",
             [](hl_instance* h, hl_error* e) {
                 std::uint64_t time = 0;
                 float speed = 0;
                 const auto tick = [](void* user) { return *static_cast<std::uint64_t*>(user) += 1000; };
                 return hl_rate(h, tick, &time, &speed, e);
             }},
            {"buffers", [this](hl_instance* h, hl_error* e) { return fill(h, HL_GPU_ONCE, e); }},
            {"buffers of a frame",
             [this](hl_instance* h, hl_error* e) {
                 if (const hl_code code = fill(h, HL_GPU_FRAME, e)) return code;
                 return fill(h, HL_GPU_GUIDES, e);
             }},
            {"table of hairs",
             [this](hl_instance*, hl_error* e) {
                 hl_asset_info info;
                 if (const hl_code code = hl_asset_describe(&asset_, &info, e)) return code;
                 auto* const hairs = reinterpret_cast<hl_hair*>(floats_.data());
                 return hl_asset_hairs(&asset_, hairs, sizeof(hl_hair), info.hairs, e);
             }},
            {"check", [this](hl_instance*, hl_error* e) { return hl_asset_check(&asset_, e); }},
            {"reset", [this](hl_instance* h, hl_error* e) { return hl_instance_reset(h, &moved_.frame, e); }},
        };
    }

    std::vector<std::byte> bytes_, few_;
    const Motion moved_{1}, alone_{2, false};
};

TEST_F(Allocator, GivesAllMemoryAndGetsAllOfItBack) {
    const auto all = calls();
    const std::size_t before = runtime::allocationCount();
    hl_instance* const hair = made();
    const std::size_t holds = host_.out;
    for (int round = 0; round < 2; ++round) {
        for (const auto& [name, call] : all)
            ASSERT_EQ(call(hair, &error_), HL_OK) << name << ": " << error_.what();
    }
    EXPECT_EQ(runtime::allocationCount(), before) << "pieces that C++ gave beside the host";
    EXPECT_GT(holds, 20u);
    EXPECT_LE(host_.largestAlignment, 128u) << "hairloom.h says so";
    hl_instance_info info;
    ASSERT_EQ(hl_instance_describe(hair, &info, &error_), HL_OK);
    EXPECT_GT(host_.bytesOut, info.bytes / 2);
    hl_instance_free(hair);
    EXPECT_EQ(host_.out, 0u);
}

TEST_F(Allocator, IsNotAskedInSteadyFrames) {
    hl_instance* const hair = made();
    hl_reserve reserve;
    hl_reserve_init(&reserve);
    reserve.spheres = 3;
    reserve.previous_hairs = 1;
    ASSERT_EQ(hl_instance_reserve(hair, &reserve, &error_), HL_OK) << error_.what();
    const std::size_t taken = host_.taken;
    for (int f = 1; f <= 60; ++f) {
        const Motion motion(f, f % 3 != 0);
        if (f % 10 == 0) {
            ASSERT_EQ(
                hl_instance_set_level(hair, static_cast<std::uint32_t>(f / 10) % HL_LEVEL_COUNT, 1, nullptr),
                HL_OK);
        }
        ASSERT_EQ(hl_instance_step(hair, &motion.frame, &error_), HL_OK) << error_.what();
        ASSERT_EQ(read(hair, true, &error_), HL_OK) << error_.what();
    }
    EXPECT_EQ(host_.taken, taken);
    hl_instance_free(hair);
}

TEST_F(Allocator, EachPieceOfMakingMayBeMissing) {
    // With a skin each of them takes its time: some are missing of it.
    for (const auto& [bytes, step] : {std::pair(&few_, std::size_t{1}), {&bytes_, std::size_t{41}}}) {
        open(*bytes);
        std::size_t number = 0;
        for (;; number += step) {
            host_.refuse(number, number % 2 == 1);
            hl_instance* hair = nullptr;
            const hl_code code = hl_instance_make(&asset_, HL_HAIRS | HL_LEVELS, nullptr, &hair, &error_);
            const bool refused = host_.refused();
            host_.refuseNone();
            ASSERT_EQ(code, refused ? HL_NO_MEMORY : HL_OK) << number << ": " << error_.what();
            ASSERT_EQ(hair != nullptr, !refused);
            hl_instance_free(hair);
            ASSERT_EQ(host_.out, 0u) << number;
            if (!refused) break;
        }
        EXPECT_GT(number, 100u);
    }
}

TEST_F(Allocator, PiecesOfACallMayBeMissing) {
    open(few_);
    hl_instance* const first = made();
    for (int f = 1; f <= 3; ++f) {
        const Motion motion(f, false);
        ASSERT_EQ(hl_instance_step(first, &motion.frame, &error_), HL_OK);
    }
    for (const auto& [name, call] : calls()) {
        if (name == std::string_view("rate")) continue;  // steps of copies, a thousand times
        // By a copy each time: memory that an instance has is not asked for again. Of many pieces not all are
        // tried.
        for (std::size_t number = 0;; number += number < 100 ? 1 : 13) {
            hl_instance *hair = nullptr, *other = nullptr;
            for (hl_instance** one : {&hair, &other})
                ASSERT_EQ(hl_instance_copy(first, one, &error_), HL_OK) << error_.what();
            const std::uint64_t hash = hl_instance_hash(hair);
            host_.refuse(number, false);
            const hl_code code = call(hair, &error_);
            const bool refused = host_.refused();
            host_.refuseNone();
            ASSERT_EQ(code, refused ? HL_NO_MEMORY : HL_OK)
                << name << ", " << number << ": " << error_.what();
            if (refused) {
                EXPECT_EQ(hl_instance_hash(hair), hash) << name << ", " << number;
            }
            // It runs on as one that was never asked.
            if (refused) {
                ASSERT_EQ(call(hair, &error_), HL_OK) << name << ": " << error_.what();
            }
            ASSERT_EQ(call(other, &error_), HL_OK);
            const Motion next(4);
            for (hl_instance* one : {hair, other})
                ASSERT_EQ(hl_instance_step(one, &next.frame, &error_), HL_OK);
            EXPECT_EQ(hl_instance_hash(hair), hl_instance_hash(other)) << name << ", " << number;
            hl_instance_free(hair);
            hl_instance_free(other);
            if (!refused) break;
        }
    }
    hl_instance_free(first);
}

TEST_F(Allocator, ChangesNoBits) {
    const auto run = [&] {
        hl_instance* const hair = made();
        for (int f = 1; f <= 20; ++f) {
            const Motion motion(f, f % 3 != 0);
            EXPECT_EQ(hl_instance_step(hair, &motion.frame, &error_), HL_OK) << error_.what();
        }
        const std::uint64_t hash = hl_instance_hash(hair);
        hl_instance_free(hair);
        return hash;
    };
    const std::uint64_t lent = run();
    ASSERT_EQ(hl_set_allocator(nullptr, &error_), HL_OK);
    EXPECT_EQ(run(), lent);
    EXPECT_EQ(host_.lend(&error_), HL_OK);
}

TEST_F(Allocator, IsRefusedWithWordsWhereItCannotBe) {
    hl_allocator allocator;
    hl_allocator_init(&allocator);
    allocator.user = &host_;
    const auto refused = [&](hl_code code, const char* words) {
        EXPECT_EQ(hl_set_allocator(&allocator, &error_), code) << words;
        EXPECT_THAT(error_.words, HasSubstr(words));
    };
    refused(HL_BAD_VALUE, "lacks allocate or release");
    allocator.allocate = Host::allocate;
    refused(HL_BAD_VALUE, "lacks allocate or release");
    allocator.release = Host::release;
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, sizeof allocator - 8, ~std::size_t{0}}) {
        allocator.size = size;
        refused(HL_WRONG_SIZE, "hl_allocator");
    }
    allocator.size = sizeof allocator;
    hl_instance* const hair = made(HL_GUIDES);
    refused(HL_BAD_VALUE, "while there are instances");
    EXPECT_EQ(hl_set_allocator(nullptr, &error_), HL_BAD_VALUE);
    const std::size_t taken = host_.taken;
    hl_instance* copy = nullptr;
    ASSERT_EQ(hl_instance_copy(hair, &copy, &error_), HL_OK);
    EXPECT_GT(host_.taken, taken) << "the one that was there stays";
    hl_instance_free(copy);
    hl_instance_free(hair);
    EXPECT_EQ(hl_set_allocator(&allocator, &error_), HL_OK);
}

}  // namespace
}  // namespace hairloom::test
