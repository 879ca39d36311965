// SPDX-License-Identifier: GPL-3.0-or-later
// hl_set_allocator: every piece that a host sees it gets back, C++ has no other memory, and each piece that
// there is not leaves hair as it was. The first file of its program: others keep skins in memory for good.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string_view>

#include "core/simulation/bake_body.h"
#include "hairloom/gpu.h"
#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_samples.h"
#include "tests/geometry/test_meshes.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Instance;
using testing::HasSubstr;

constexpr std::uint32_t kSound = 0x600d600d;

/// Counts pieces, and refuses the one of a number.
struct Host {
    struct Before {
        void* block;
        std::size_t bytes, alignment;
        std::uint32_t mark;
    };
    std::size_t taken = 0, out = 0, bytesOut = 0, largestAlignment = 0, wrong = 0;
    std::size_t refuseFrom = SIZE_MAX, refuseUntil = SIZE_MAX;  ///< numbers of pieces from 0

    static void* allocate(void* user, std::size_t bytes, std::size_t alignment) {
        Host& host = *static_cast<Host*>(user);
        const std::size_t number = host.taken++;
        if (number >= host.refuseFrom && number < host.refuseUntil) return nullptr;
        if (alignment == 0 || (alignment & (alignment - 1)) != 0) ++host.wrong;
        void* const block = std::malloc(bytes + alignment + sizeof(Before));
        if (!block) return nullptr;
        const auto first = reinterpret_cast<std::uintptr_t>(block) + sizeof(Before);
        const std::uintptr_t at = (first + alignment - 1) / alignment * alignment;
        const Before before{block, bytes, alignment, kSound};
        std::memcpy(reinterpret_cast<void*>(at - sizeof before), &before, sizeof before);
        // What is not given a value has an unlikely one.
        std::memset(reinterpret_cast<void*>(at), 0xa5, bytes);
        ++host.out;
        host.bytesOut += bytes;
        host.largestAlignment = std::max(host.largestAlignment, alignment);
        return reinterpret_cast<void*>(at);
    }
    static void release(void* user, void* data, std::size_t bytes, std::size_t alignment) {
        Host& host = *static_cast<Host*>(user);
        Before before{};
        std::memcpy(&before, static_cast<char*>(data) - sizeof before, sizeof before);
        if (before.mark != kSound || before.bytes != bytes || before.alignment != alignment) {
            ++host.wrong;
            return;
        }
        std::memset(static_cast<char*>(data) - sizeof before, 0, sizeof before);
        --host.out;
        host.bytesOut -= bytes;
        std::free(before.block);
    }
    hl_code lend(hl_error* error = nullptr) {
        hl_allocator allocator;
        hl_allocator_init(&allocator);
        allocator.user = this;
        allocator.allocate = allocate;
        allocator.release = release;
        return hl_set_allocator(&allocator, error);
    }
    /// The `number`-th piece from now on, and those behind it, too, where `all`.
    void refuse(std::size_t number, bool all) {
        refuseFrom = taken + number;
        refuseUntil = all ? SIZE_MAX : refuseFrom + 1;
    }
    /// Whether a piece was refused since.
    bool refused() const { return taken > refuseFrom; }
    void refuseNone() { refuseFrom = refuseUntil = SIZE_MAX; }
};

/// Spheres and capsules that walk through the hair, a head that nods.
struct Motion {
    std::array<float, 12> head{};
    std::array<float, 12> spheres{};
    std::array<std::uint32_t, 2> capsule{0, 1};
    std::array<float, 3> wind{2, 0, 1};
    game::Frame frame;

    explicit Motion(int f, bool crowded = true) {
        const float angle = 0.3f * std::sin(0.1f * static_cast<float>(f)), c = std::cos(angle),
                    s = std::sin(angle);
        head = {c, 0, s, 0.01f * static_cast<float>(f % 20), 0, 1, 0, 0, -s, 0, c, 0};
        spheres = {0.05f, 1.65f, 0,    0.03f, -0.05f, 1.65f, 0.01f * static_cast<float>(f % 5),
                   0.02f, 0,     1.6f, 0,     0.09f};
        frame.time = f / 60.0;
        frame.head = head.data();
        frame.wind = wind.data();
        if (!crowded) return;
        frame.spheres = spheres.data();
        frame.sphere_count = 3;
        frame.capsules = capsule.data();
        frame.capsule_count = 1;
    }
    Motion(const Motion&) = delete;
    Motion& operator=(const Motion&) = delete;
};

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

class Allocator : public AssetTest {
  protected:
    void SetUp() override {
        AssetTest::SetUp();
        // Nothing of the engine is left but bytes: what it holds would be memory of the former allocator.
        bytes_ = written(ballOfHair());
        few_ = written(fewHairs());
        floats_.resize(1u << 20);
        ASSERT_EQ(host_.lend(&error_), HL_OK) << error_.what();
        open(bytes_);
    }
    void open(const std::vector<std::byte>& bytes) {
        ASSERT_EQ(hl_asset_open(&asset_, bytes.data(), bytes.size(), &error_), HL_OK) << error_.what();
    }
    void TearDown() override {
        host_.refuseNone();
        EXPECT_EQ(host_.out, 0u) << "pieces that nobody gave back";
        EXPECT_EQ(host_.bytesOut, 0u);
        EXPECT_EQ(host_.wrong, 0u) << "pieces with other numbers than they were asked with";
        EXPECT_EQ(hl_set_allocator(nullptr, &error_), HL_OK) << error_.what();
    }
    hl_instance* made(std::uint32_t what = HL_HAIRS | HL_LEVELS) {
        hl_instance* hair = nullptr;
        EXPECT_EQ(hl_instance_make(&asset_, what, nullptr, &hair, &error_), HL_OK) << error_.what();
        return hair;
    }
    hl_code read(hl_instance* hair, bool hairs, hl_error* error) {
        hl_read read;
        hl_read_init(&read);
        read.hairs = hairs ? 1 : 0;
        const std::size_t half = floats_.size() / 2;
        read.positions = {floats_.data(), 4 * half, 12};
        read.previous = {floats_.data() + half, 4 * half, 12};
        return hl_instance_read(hair, &read, error);
    }
    hl_code fill(hl_instance* hair, std::uint32_t kind, hl_error* error) {
        for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
            hl_gpu_buffer_info info{};
            info.size = sizeof info;
            if (const hl_code code = hl_gpu_buffer(&asset_, b, &info, error)) return code;
            if (info.fill != kind) continue;
            const hl_code code = kind == HL_GPU_ONCE
                                     ? hl_gpu_fill(&asset_, b, floats_.data(), info.bytes, error)
                                     : hl_gpu_fill_frame(hair, b, floats_.data(), info.bytes, error);
            if (code) return code;
        }
        return HL_OK;
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
    hl_asset asset_{};
    Host host_;
    Error error_;
    std::vector<float> floats_;
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
