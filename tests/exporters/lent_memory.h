// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair whose memory a host lends (hl_set_allocator), and how a host counts and refuses pieces of it. Tests of
// it stand in the first files of their program: others keep skins in memory for good.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "hairloom/gpu.h"
#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_samples.h"

namespace hairloom::test {

inline constexpr std::uint32_t kSound = 0x600d600d;

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

class LentMemory : public AssetTest {
  protected:
    /// Writes what tests play. Nothing of the engine is left of it but bytes: what it holds would be memory
    /// of the former allocator.
    virtual void prepare() = 0;

    void SetUp() override {
        AssetTest::SetUp();
        prepare();
        floats_.resize(1u << 20);
        ASSERT_EQ(host_.lend(&error_), HL_OK) << error_.what();
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

    hl_asset asset_{};
    Host host_;
    game::Error error_;
    std::vector<float> floats_;
};

}  // namespace hairloom::test
