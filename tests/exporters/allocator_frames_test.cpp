// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of hair that a GPU steps, and of clips that play: none in frames of a game that runs, and each piece
// that there is not is a code, and leaves hair as it was.

#include <gmock/gmock.h>

#include <array>

#include "tests/exporters/lent_memory.h"
#include "tests/runtime/allocations.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

constexpr std::uint32_t kGivenSpheres = 3;

hl_code reserveOf(hl_instance* hair, hl_error* error) {
    hl_reserve reserve;
    hl_reserve_init(&reserve);
    reserve.spheres = kGivenSpheres;
    reserve.previous_guides = reserve.previous_hairs = 1;
    return hl_instance_reserve(hair, &reserve, error);
}

class AllocatorOfGpu : public LentMemory {
  protected:
    void prepare() override {
        // Without hair-hair collision, which a GPU's kernel does not have.
        Groom groom = dome(4, 1, 9, 0.15f);
        groom.interpolation.followPerGuide = 4;
        groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}, {"ear", Vec3f(0.1f, 1.6f, 0), 0.02f, ""}};
        groom.spheres[1].joined = 0;
        bytes_ = written(groom);
    }
    void SetUp() override {
        LentMemory::SetUp();
        open(bytes_);
        for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
            infos_[b].size = sizeof infos_[b];
            ASSERT_EQ(hl_gpu_buffer(&asset_, b, &infos_[b], &error_), HL_OK) << error_.what();
        }
    }
    /// Of a kind, one after the other behind `at`.
    hl_code fillAll(hl_instance* hair, std::uint32_t kind, std::size_t& at, hl_error* error) {
        for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
            if (infos_[b].fill != kind) continue;
            if (const hl_code code = hl_gpu_fill_frame(hair, b, &floats_[at], infos_[b].bytes, error))
                return code;
            at += infos_[b].bytes / sizeof(float);
        }
        return HL_OK;
    }
    hl_code begin(hl_instance* hair, std::size_t& at, hl_error* error) {
        if (const hl_code code = hl_gpu_begin(hair, error)) return code;
        for (const std::uint32_t kind : {HL_GPU_BEGIN, HL_GPU_GUIDES}) {
            if (const hl_code code = fillAll(hair, kind, at, error)) return code;
        }
        return HL_OK;
    }
    hl_code frame(hl_instance* hair, const hl_frame& given, std::size_t& at, hl_error* error) {
        if (const hl_code code = hl_gpu_step(hair, &given, error)) return code;
        for (const std::uint32_t kind : {HL_GPU_FRAME, HL_GPU_STEP}) {
            if (const hl_code code = fillAll(hair, kind, at, error)) return code;
        }
        return HL_OK;
    }
    /// All of both, as the GPU sees it.
    hl_code beginAndFrame(hl_instance* hair, std::vector<float>& seen) {
        std::size_t at = 0;
        hl_code code = begin(hair, at, &error_);
        if (code == HL_OK) code = frame(hair, moved_.frame, at, &error_);
        seen.assign(floats_.begin(), floats_.begin() + static_cast<std::ptrdiff_t>(at));
        return code;
    }

    std::vector<std::byte> bytes_;
    std::array<hl_gpu_buffer_info, HL_GPU_BUFFER_COUNT> infos_{};
    const Motion moved_{1};
};

TEST_F(AllocatorOfGpu, IsNotAskedInFramesOfGuidesOnTheGpu) {
    hl_instance* const hair = made(HL_GUIDES | HL_LEVELS);
    ASSERT_EQ(reserveOf(hair, &error_), HL_OK) << error_.what();
    // With the head, the asset's own spheres and capsule, and with the game's.
    for (const bool inMotion : {false, true}) {
        if (inMotion) {
            ASSERT_EQ(hl_instance_step(hair, &moved_.frame, &error_), HL_OK);
        }
        std::size_t at = 0;
        ASSERT_EQ(begin(hair, at, &error_), HL_OK) << error_.what();
        const std::size_t taken = host_.taken, ofCpp = runtime::allocationCount();
        for (int f = 1; f <= 60; ++f) {
            const Motion motion(f, f % 3 != 0);
            std::size_t end = 0;
            ASSERT_EQ(frame(hair, motion.frame, end, &error_), HL_OK) << error_.what();
            if (f % 10 == 0) {
                hl_gpu_view view{};
                hl_gpu_pass_info pass{};
                pass.size = sizeof pass;
                const float share = f % 20 == 0 ? 1.0f : 0.5f;
                ASSERT_EQ(hl_instance_set_level(hair, HL_LEVEL_FINEST, share, &error_), HL_OK);
                ASSERT_EQ(hl_gpu_frame_pass(hair, HL_GPU_PASS_HAIRS, &pass, &error_), HL_OK);
                ASSERT_EQ(hl_gpu_frame_view(hair, &view, &error_), HL_OK);
            }
        }
        EXPECT_EQ(host_.taken, taken) << "in motion: " << inMotion;
        EXPECT_EQ(runtime::allocationCount(), ofCpp);
    }
    hl_instance_free(hair);
}

TEST_F(AllocatorOfGpu, IsNotAskedInFramesOfGuidesOnTheCpuAtAnyLevel) {
    hl_instance* const hair = made(HL_GUIDES | HL_LEVELS);
    ASSERT_EQ(reserveOf(hair, &error_), HL_OK) << error_.what();
    std::size_t taken = 0;
    for (int f = 0; f <= 60; ++f) {
        // The first takes memory for speeds.
        if (f == 1) taken = host_.taken;
        const Motion motion(f, f % 3 != 0);
        if (f % 10 == 5) {
            ASSERT_EQ(hl_instance_set_level(hair, static_cast<std::uint32_t>(f / 10) % HL_LEVEL_COUNT,
                                            f % 20 == 5 ? 1.0f : 0.4f, &error_),
                      HL_OK);
        }
        ASSERT_EQ(hl_instance_step(hair, &motion.frame, &error_), HL_OK) << error_.what();
        std::size_t at = 0;
        for (const std::uint32_t kind : {HL_GPU_FRAME, HL_GPU_GUIDES})
            ASSERT_EQ(fillAll(hair, kind, at, &error_), HL_OK) << error_.what();
    }
    EXPECT_EQ(host_.taken, taken);
    hl_instance_free(hair);
}

TEST_F(AllocatorOfGpu, PiecesOfAFrameMayBeMissing) {
    hl_instance* const first = made(HL_GUIDES | HL_LEVELS);
    for (int f = 1; f <= 3; ++f) {
        const Motion motion(f, false);
        ASSERT_EQ(hl_instance_step(first, &motion.frame, &error_), HL_OK);
    }
    std::vector<float> wanted, seen;
    std::size_t number = 0;
    for (;; ++number) {
        // By copies: memory that an instance has is not asked for again.
        hl_instance *hair = nullptr, *other = nullptr;
        for (hl_instance** one : {&hair, &other})
            ASSERT_EQ(hl_instance_copy(first, one, &error_), HL_OK) << error_.what();
        const std::uint64_t hash = hl_instance_hash(hair);
        host_.refuse(number, number % 2 == 1);
        const hl_code code = beginAndFrame(hair, seen);
        const bool refused = host_.refused();
        host_.refuseNone();
        ASSERT_EQ(code, refused ? HL_NO_MEMORY : HL_OK) << number << ": " << error_.what();
        EXPECT_EQ(hl_instance_hash(hair), hash) << number;
        ASSERT_EQ(beginAndFrame(other, wanted), HL_OK) << error_.what();
        // It runs on as one that was never asked.
        if (refused) {
            ASSERT_EQ(beginAndFrame(hair, seen), HL_OK) << number << ": " << error_.what();
        }
        ASSERT_EQ(seen.size(), wanted.size());
        EXPECT_EQ(std::memcmp(seen.data(), wanted.data(), 4 * seen.size()), 0) << number;
        hl_instance_free(hair);
        hl_instance_free(other);
        if (!refused) break;
    }
    EXPECT_GT(number, 20u) << "else this test looks at nothing";
    hl_instance_free(first);
}

TEST_F(AllocatorOfGpu, AFailedBeginLeavesTheGpuWhereItWas) {
    hl_instance* const hair = made(HL_GUIDES | HL_LEVELS);
    std::size_t at = 0, end = 0;
    ASSERT_EQ(begin(hair, at, &error_), HL_OK) << error_.what();
    ASSERT_EQ(frame(hair, moved_.frame, end, &error_), HL_OK);
    host_.refuse(0, true);
    EXPECT_EQ(hl_gpu_begin(hair, &error_), HL_NO_MEMORY);
    host_.refuseNone();
    const Motion next(2);
    end = 0;
    EXPECT_EQ(frame(hair, next.frame, end, &error_), HL_OK) << error_.what();
    hl_instance_free(hair);
}

/// The clip is that of a file: to write one would leave memory of an engine in this program.
class AllocatorOfClips : public LentMemory {
  protected:
    void prepare() override {
        bytes_ = readFile(sourceDir() / "tests/exporters/files/version_1_3.hairrt").value();
    }
    void SetUp() override {
        LentMemory::SetUp();
        open(bytes_);
        clip_.size = sizeof clip_;
        ASSERT_EQ(hl_asset_clip(&asset_, &clip_, &error_), HL_OK) << error_.what();
        ASSERT_EQ(clip_.frames, 20u);
    }
    hl_code play(hl_instance* hair, const Motion& motion, double seconds, hl_error* error) {
        hl_play play;
        hl_play_init(&play);
        play.time = seconds;
        return hl_instance_play(hair, &asset_, &motion.frame, &play, error);
    }

    std::vector<std::byte> bytes_;
    hl_clip clip_{};
};

TEST_F(AllocatorOfClips, IsAskedAtTheFirstCallAndNotInSteadyFrames) {
    hl_instance* const hair = made(HL_GUIDES | HL_LEVELS);
    ASSERT_EQ(reserveOf(hair, &error_), HL_OK) << error_.what();
    const std::size_t held = host_.bytesOut, asked = host_.taken;
    const Motion start(0);
    ASSERT_EQ(play(hair, start, 0, &error_), HL_OK) << error_.what();
    EXPECT_GT(host_.taken, asked);
    EXPECT_LE(host_.bytesOut - held, clip_.memory) << "hl_clip.memory says so";
    const std::size_t taken = host_.taken, ofCpp = runtime::allocationCount();
    // Forwards through its end to its begin, backwards, in jumps, at each level, and between steps.
    for (int f = 1; f <= 120; ++f) {
        const Motion motion(f, f % 3 != 0);
        const double seconds = f < 60 ? f / 40.0 : f < 80 ? (80 - f) / 60.0 : std::fmod(f * 0.37, 2.0);
        if (f % 10 == 0) {
            ASSERT_EQ(
                hl_instance_set_level(hair, static_cast<std::uint32_t>(f / 10) % HL_LEVEL_COUNT, 1, &error_),
                HL_OK);
        }
        if (f % 17 == 0) {
            ASSERT_EQ(hl_instance_step(hair, &motion.frame, &error_), HL_OK) << error_.what();
        }
        ASSERT_EQ(play(hair, motion, seconds, &error_), HL_OK) << error_.what();
        ASSERT_EQ(read(hair, false, &error_), HL_OK) << error_.what();
    }
    EXPECT_EQ(host_.taken, taken);
    EXPECT_EQ(runtime::allocationCount(), ofCpp);
    hl_instance_free(hair);
}

TEST_F(AllocatorOfClips, PiecesOfPlayingMayBeMissing) {
    hl_instance* const first = made(HL_GUIDES | HL_LEVELS);
    const Motion before(3, false), now(4, false), next(5, false);
    ASSERT_EQ(hl_instance_step(first, &before.frame, &error_), HL_OK);
    std::size_t number = 0;
    for (;; ++number) {
        hl_instance *hair = nullptr, *other = nullptr;
        for (hl_instance** one : {&hair, &other})
            ASSERT_EQ(hl_instance_copy(first, one, &error_), HL_OK) << error_.what();
        const std::uint64_t hash = hl_instance_hash(hair);
        host_.refuse(number, number % 2 == 1);
        // And a step, which goes on from the pose that was played.
        hl_code code = play(hair, now, 0.4, &error_);
        const bool played = code == HL_OK;
        if (played) code = hl_instance_step(hair, &next.frame, &error_);
        const bool refused = host_.refused();
        host_.refuseNone();
        ASSERT_EQ(code, refused ? HL_NO_MEMORY : HL_OK) << number << ": " << error_.what();
        if (!played) {
            EXPECT_EQ(hl_instance_hash(hair), hash) << number;
            ASSERT_EQ(play(hair, now, 0.4, &error_), HL_OK) << number << ": " << error_.what();
        }
        if (refused) {
            ASSERT_EQ(hl_instance_step(hair, &next.frame, &error_), HL_OK) << number << error_.what();
        }
        ASSERT_EQ(play(other, now, 0.4, &error_), HL_OK);
        ASSERT_EQ(hl_instance_step(other, &next.frame, &error_), HL_OK);
        EXPECT_EQ(hl_instance_hash(hair), hl_instance_hash(other)) << number;
        hl_instance_free(hair);
        hl_instance_free(other);
        if (!refused) break;
    }
    EXPECT_GT(number, 5u) << "else this test looks at nothing";
    hl_instance_free(first);
}

}  // namespace
}  // namespace hairloom::test
