// SPDX-License-Identifier: GPL-3.0-or-later
// Buffers of hairloom.h and gpu.h that are too short are left alone, and so is an asset that ends early.
// Settings and materials are listed and read.

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <memory>
#include <set>

#include "hairloom/gpu.h"
#include "tests/exporters/decorated_sample.h"

namespace hairloom::test {
namespace {

using game::Frame;

class RuntimeBuffers : public RuntimeReads {
  protected:
    void SetUp() override {
        RuntimeReads::SetUp();
        open(decorated());
        make(HL_HAIRS | HL_LEVELS);
        step(hair_, 1);
        frame_.head = head_.data();
    }

    const std::array<float, 12> head_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    Frame frame_;
};

/// A buffer of its own on the heap, so that a sanitizer sees the first byte beyond.
template <class T>
struct Exactly {
    explicit Exactly(std::size_t count) : data(count > 0 ? new T[count]{} : nullptr) {}
    std::unique_ptr<T[]> data;
};

TEST_F(RuntimeBuffers, BuffersThatAreTooShortAreLeftAlone) {
    const hl_asset* const asset = asset_.get();
    hl_instance* const hair = hair_.get();
    // `call` has `count` elements; fewer than `wanted` are refused and stay 0.
    const auto shorter = [&](const char* name, std::size_t wanted, std::size_t step, const auto& call) {
        for (std::size_t count = 0; count < wanted; count += step) {
            Exactly<std::uint32_t> place(count);
            const hl_code code = call(place.data.get(), count);
            EXPECT_TRUE(code == HL_WRONG_SIZE || (count == 0 && code == HL_BAD_VALUE))
                << name << ", " << count << " of " << wanted << " words: code " << code;
            for (std::size_t w = 0; w < count; ++w) ASSERT_EQ(place.data[w], 0u) << name;
        }
        Exactly<std::uint32_t> whole(wanted);
        EXPECT_EQ(call(whole.data.get(), wanted), HL_OK) << name << ": " << error_.what();
    };
    const std::size_t hairs = info_.hairs, guides = info_.guides;
    shorter("hl_asset_scalp_sources", info_.scalp_vertices, 1, [&](std::uint32_t* at, std::size_t count) {
        return hl_asset_scalp_sources(asset, at, count, &error_);
    });
    shorter("hl_asset_hairs", 16 * hairs, 16 * 7, [&](std::uint32_t* at, std::size_t count) {
        return hl_asset_hairs(asset, reinterpret_cast<hl_hair*>(at), sizeof(hl_hair), count / 16, &error_);
    });
    shorter("hl_instance_offsets", guides + 1, 1, [&](std::uint32_t* at, std::size_t count) {
        return hl_instance_offsets(hair, at, count, &error_);
    });
    shorter("hl_instance_hair_numbers", hairs, 3, [&](std::uint32_t* at, std::size_t count) {
        return hl_instance_hair_numbers(hair, at, count, &error_);
    });
    std::size_t size = 0;
    ASSERT_EQ(hl_instance_save(hair, nullptr, 0, &size, &error_), HL_OK);
    // Without a place it says how many there are.
    shorter("hl_instance_save", (size + 3) / 4, size / 40, [&](std::uint32_t* at, std::size_t count) {
        std::size_t written = 0;
        return at ? hl_instance_save(hair, at, 4 * count, &written, &error_) : HL_WRONG_SIZE;
    });
    for (const bool ofHairs : {false, true}) {
        const std::size_t words = 3 * points(ofHairs);
        shorter("hl_instance_read", words, words / 50, [&](std::uint32_t* at, std::size_t count) {
            if (!at) return HL_WRONG_SIZE;
            hl_read read;
            hl_read_init(&read);
            read.hairs = ofHairs ? 1 : 0;
            read.positions = {at, 4 * count, 12};
            return hl_instance_read(hair, &read, &error_);
        });
        shorter("hl_instance_read_…", words, words / 50, [&](std::uint32_t* at, std::size_t count) {
            if (!at) return HL_WRONG_SIZE;
            const hl_out out{at, 4 * count, 12};
            return ofHairs ? hl_instance_read_hairs(hair, game::kNothing, out, game::kNothing, &error_)
                           : hl_instance_read_guides(hair, game::kNothing, out, game::kNothing, &error_);
        });
    }
    for (std::uint32_t buffer = 0; buffer < HL_GPU_BUFFER_COUNT; ++buffer) {
        hl_gpu_buffer_info info{};
        info.size = sizeof info;
        ASSERT_EQ(hl_gpu_buffer(asset, buffer, &info, &error_), HL_OK);
        if (info.fill == HL_GPU_DEVICE || info.fill == HL_GPU_HOST) continue;
        ASSERT_EQ(hl_gpu_begin(hair, &error_), HL_OK);
        if (info.fill == HL_GPU_STEP) {
            ASSERT_EQ(hl_gpu_step(hair, &frame_, &error_), HL_OK);
        }
        const std::size_t words = info.bytes / 4;
        shorter(info.name, words, words / 20 + 1, [&](std::uint32_t* at, std::size_t count) {
            if (!at) return HL_WRONG_SIZE;
            return info.fill == HL_GPU_ONCE ? hl_gpu_fill(asset, buffer, at, 4 * count, &error_)
                                            : hl_gpu_fill_frame(hair, buffer, at, 4 * count, &error_);
        });
    }
    // An asset that ends early, at any byte of its head and table, and then at some.
    for (std::size_t end = 0; end < bytes_.size(); end += end < 512 ? 1 : 997) {
        const std::size_t units = end / 16 + 1;
        const std::unique_ptr<std::max_align_t[]> copy(new std::max_align_t[units]);
        std::memcpy(copy.get(), bytes_.data(), end);
        hl_asset cut;
        EXPECT_EQ(hl_asset_open(&cut, copy.get(), end, &error_), HL_DAMAGED) << end;
    }
}

TEST_F(RuntimeBuffers, SettingsAndMaterialsAreListedAndRead) {
    std::set<std::string> names;
    std::size_t choices = 0, curves = 0, seeds = 0;
    for (std::uint32_t s = 0; s < info_.settings; ++s) {
        hl_setting setting{};
        setting.size = sizeof setting;
        ASSERT_EQ(hl_asset_setting(asset_.get(), s, &setting, &error_), HL_OK) << error_.what();
        const std::string name(setting.name, setting.name_bytes);
        EXPECT_TRUE(names.insert(name).second) << name << " comes twice";
        std::uint32_t found = ~0u;
        ASSERT_EQ(hl_asset_find_setting(asset_.get(), name.c_str(), &found, &error_), HL_OK) << name;
        EXPECT_EQ(found, s);
        double values[64];
        std::size_t written = 0;
        const hl_code code = hl_asset_numbers(asset_.get(), name.c_str(), values, 64, &written, &error_);
        if (setting.kind == HL_CHOICE) {
            ++choices;
            EXPECT_EQ(setting.values, nullptr) << name;
            EXPECT_GT(setting.choice_bytes, 0u) << name;
            EXPECT_EQ(code, HL_BAD_VALUE) << name;
            continue;
        }
        curves += setting.kind == HL_CURVE ? 1 : 0;
        seeds += setting.kind == HL_SEED ? 1 : 0;
        ASSERT_EQ(code, HL_OK) << name;
        ASSERT_EQ(written, setting.count) << name;
        EXPECT_EQ(std::memcmp(values, setting.values, 8 * written), 0) << name;
        EXPECT_EQ(setting.choice, nullptr) << name;
        if (written > 1) {
            EXPECT_EQ(hl_asset_numbers(asset_.get(), name.c_str(), values, written - 1, &written, &error_),
                      HL_WRONG_SIZE);
        }
    }
    for (const char* name : {"simulation.windSpeed", "simulation.strandModel", "material.rootColour",
                             "material.shadingModel", "interpolation.seed"})
        EXPECT_EQ(names.count(name), 1u) << name;
    EXPECT_GT(choices, 2u);
    EXPECT_GT(curves, 0u);
    EXPECT_GT(seeds, 0u);
    // A choice by its name.
    std::uint32_t number = 0;
    ASSERT_EQ(hl_asset_find_setting(asset_.get(), "simulation.strandModel", &number, &error_), HL_OK);
    hl_setting model{};
    model.size = sizeof model;
    ASSERT_EQ(hl_asset_setting(asset_.get(), number, &model, &error_), HL_OK);
    EXPECT_EQ(std::string(model.choice, model.choice_bytes), "rods");
}

}  // namespace
}  // namespace hairloom::test
