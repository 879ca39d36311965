// SPDX-License-Identifier: GPL-3.0-or-later
// A walk over every function of hairloom.h and gpu.h: each pointer null, numbers that nobody gives, structs
// of any size. All of it ends with a code and words, and nothing is read, written or changed.

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <tuple>

#include "core/groom/poses.h"
#include "hairloom/gpu.h"
#include "tests/exporters/decorated_sample.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

using game::Frame;

constexpr std::byte kUntouched{0x5a};
constexpr std::size_t kPlace = 8192;  ///< bytes for each thing that a call may write to

class RuntimeCalls : public RuntimeReads {
  protected:
    void SetUp() override {
        RuntimeReads::SetUp();
        Groom groom = decorated();
        const std::vector<Vec3f> shape(groom.positions().begin(), groom.positions().end());
        ASSERT_TRUE(putPose(groom, "Wet", shape));
        open(groom);
        make(HL_HAIRS | HL_LEVELS);
        step(hair_, 1);
        frame_.head = head_.data();
        clear();
    }
    void clear() { arena_.assign(24 * kPlace, kUntouched); }
    /// The n-th place for what a call writes.
    template <class T>
    T* place(std::size_t n) {
        return reinterpret_cast<T*>(arena_.data() + n * kPlace);
    }
    /// A struct that tells its size, as its caller fills it.
    template <class T>
    T* sized(std::size_t n, T value = {}) {
        value.size = sizeof(T);
        std::memcpy(place<T>(n), &value, sizeof value);
        return place<T>(n);
    }

    /// Calls `function` once as it is, then with each pointer null and each index out of what there is.
    /// `optional`: pointers that may be null, as bits. The last argument is the error.
    template <class... Taken, class... Given>
    void walk(const char* name, hl_code (*function)(Taken...), unsigned optional, hl_code plain,
              Given... given) {
        seen_.insert(name);
        std::tuple<Taken...> arguments{static_cast<Taken>(given)...};
        const std::vector<std::byte> before = arena_;
        EXPECT_EQ(std::apply(function, arguments), plain) << name << ": " << error_.what();
        arena_ = before;
        std::size_t at = 0;
        const auto each = [&](auto& argument) {
            vary(name, function, arguments, argument, at, optional);
            ++at;
        };
        std::apply([&](auto&... all) { (each(all), ...); }, arguments);
    }
    template <class Function, class Arguments, class Argument>
    void vary(const char* name, Function function, Arguments& arguments, Argument& argument, std::size_t at,
              unsigned optional) {
        const std::vector<std::byte> before = arena_;
        const Argument was = argument;
        if constexpr (std::is_same_v<Argument, hl_error*>) {
            argument = nullptr;
            std::apply(function, arguments);  // nobody is told
            arena_ = before;
        } else if constexpr (std::is_pointer_v<Argument>) {
            argument = nullptr;
            const std::uint64_t hash = hair_.hash();
            const hl_code code = std::apply(function, arguments);
            if ((optional >> at & 1u) == 0) {
                EXPECT_EQ(code, HL_BAD_VALUE) << name << ", null in place " << at;
                EXPECT_GT(std::strlen(error_.words), 5u) << name;
                EXPECT_EQ(arena_, before) << name << " writes, null in place " << at;
                EXPECT_EQ(hair_.hash(), hash) << name;
            }
            arena_ = before;
        } else if constexpr (std::is_same_v<Argument, std::uint32_t>) {
            for (const std::uint32_t garbage : {1u, 5u, 77u, 0x7fffffffu, 0x80000000u, ~0u}) {
                argument = garbage;
                const hl_code code = std::apply(function, arguments);
                EXPECT_TRUE(code == HL_OK || code == HL_BAD_VALUE || code == HL_WRONG_SIZE)
                    << name << " of " << garbage;
                if (code != HL_OK) {
                    EXPECT_EQ(arena_, before) << name << " of " << garbage;
                }
                if (garbage > 1000) {
                    EXPECT_NE(code, HL_OK) << name << " of " << garbage;
                }
                arena_ = before;
            }
        } else if constexpr (std::is_same_v<Argument, float>) {
            for (const float garbage : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(),
                                        std::numeric_limits<float>::infinity()}) {
                // Of those whose bit is set, 0 is a number like others.
                if (garbage == 0 && (optional >> at & 1u) != 0) continue;
                argument = garbage;
                EXPECT_EQ(std::apply(function, arguments), HL_BAD_VALUE) << name;
            }
        }
        argument = was;
    }
    /// Sizes of a struct that the caller tells: `call` is given each. `least`: the smallest that there was.
    void sizes(const char* name, std::size_t least, std::size_t now,
               const std::function<hl_code(std::size_t)>& call) {
        const std::vector<std::byte> before = arena_;
        const std::uint64_t hash = hair_.hash();
        for (const std::size_t garbage : {std::size_t{0}, std::size_t{1}, std::size_t{3}, least - 4,
                                          least - 1, now + 1, now + 2, std::size_t{4098}, std::size_t{4100},
                                          std::size_t{1} << 31u, ~std::size_t{0}, ~std::size_t{0} - 3}) {
            EXPECT_EQ(call(garbage), HL_WRONG_SIZE) << name << " of " << garbage << " bytes";
            EXPECT_THAT(error_.words, testing::HasSubstr(" bytes of hl_")) << name;
            EXPECT_EQ(hair_.hash(), hash) << name;
            arena_ = before;
        }
        for (std::size_t good = least; good <= now; good += 4)
            EXPECT_EQ(call(good), HL_OK) << name << " of " << good << " bytes: " << error_.what();
        arena_ = before;
    }
    /// A struct that is given back, of a size that the call tells: as many bytes are written, and no more.
    void written(const char* name, std::size_t least, std::size_t now,
                 const std::function<hl_code(std::size_t, std::byte*)>& call) {
        std::byte* const at = place<std::byte>(8);
        sizes(name, least, now, [&](std::size_t size) {
            const hl_code code = call(size, at);
            const std::size_t from = code == HL_OK ? size : 0;
            for (std::size_t b = from; b < kPlace; ++b) {
                if (at[b] != kUntouched) {
                    ADD_FAILURE() << name << " of " << size << " writes byte " << b;
                    break;
                }
            }
            return code;
        });
        // One of tomorrow.
        EXPECT_EQ(call(now + 64, at), HL_OK) << name;
        for (std::size_t b = now; b < now + 64; ++b) EXPECT_EQ(at[b], std::byte{0}) << name;
        EXPECT_EQ(at[now + 64], kUntouched) << name;
        clear();
    }

    std::vector<std::byte> arena_;
    std::set<std::string> seen_;
    const std::array<float, 12> head_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    Frame frame_;
};

std::uint64_t tick(void* user) {
    static std::uint64_t nobodys = 0;
    return *(user ? static_cast<std::uint64_t*>(user) : &nobodys) += 1000;
}

TEST_F(RuntimeCalls, EveryNullAndEveryNumberIsRefusedWithWords) {
    hl_error* const error = &error_;
    const hl_asset* const asset = asset_.get();
    hl_instance* const hair = hair_.get();
    auto* const bytes = place<char>(0);
    const std::size_t hairs = info_.hairs, guides = info_.guides;
    std::vector<hl_hair> table(hairs);
    std::vector<std::uint32_t> numbers(std::max(hairs, guides + 1));
    std::vector<float> floats(1u << 18);
    std::uint64_t time = 0;

    walk("hl_build_info", &hl_build_info, 0, HL_OK, sized<hl_build>(1), error);
    walk("hl_asset_open", &hl_asset_open, 0, HL_OK, place<hl_asset>(2), bytes_.data(), bytes_.size(), error);
    walk("hl_asset_check", &hl_asset_check, 0, HL_OK, asset, error);
    walk("hl_asset_describe", &(hl_asset_describe), 0, HL_OK, asset, place<hl_asset_info>(1), error);
    walk("hl_asset_describe_sized", &hl_asset_describe_sized, 0, HL_OK, asset, place<hl_asset_info>(1),
         sizeof(hl_asset_info), error);
    // The sample has no bones.
    walk("hl_asset_bone", &(hl_asset_bone), 0, HL_BAD_VALUE, asset, 0u, place<hl_bone>(1), error);
    walk("hl_asset_bone_sized", &hl_asset_bone_sized, 0, HL_BAD_VALUE, asset, 0u, place<hl_bone>(1),
         sizeof(hl_bone), error);
    walk("hl_asset_scalp_sources", &hl_asset_scalp_sources, 0, HL_OK, asset, place<std::uint32_t>(1),
         std::size_t{info_.scalp_vertices}, error);
    walk("hl_asset_layer", &(hl_asset_layer), 0, HL_OK, asset, 0u, place<hl_layer>(1), error);
    walk("hl_asset_layer_sized", &hl_asset_layer_sized, 0, HL_OK, asset, 0u, place<hl_layer>(1),
         sizeof(hl_layer), error);
    walk("hl_asset_layers", &hl_asset_layers, 0, HL_OK, asset, place<std::uint32_t>(1), numbers.data(),
         guides, error);
    walk("hl_asset_setting", &hl_asset_setting, 0, HL_OK, asset, 0u, sized<hl_setting>(1), error);
    walk("hl_asset_find_setting", &hl_asset_find_setting, 0, HL_OK, asset, "simulation.windSpeed",
         place<std::uint32_t>(1), error);
    walk("hl_asset_attribute", &hl_asset_attribute, 0, HL_OK, asset, 0u, sized<hl_attribute>(1), error);
    walk("hl_asset_find_attribute", &hl_asset_find_attribute, 0, HL_OK, asset, "age", place<std::uint32_t>(1),
         error);
    walk("hl_asset_pose", &hl_asset_pose, 0, HL_OK, asset, 0u, sized<hl_hair_pose>(1), error);
    walk("hl_asset_find_pose", &hl_asset_find_pose, 0, HL_OK, asset, "Wet", place<std::uint32_t>(1), error);
    walk("hl_asset_hairs", &hl_asset_hairs, 0, HL_OK, asset, table.data(), sizeof(hl_hair), hairs, error);
    walk("hl_asset_numbers", &hl_asset_numbers, 0, HL_OK, asset, "simulation.windSpeed", place<double>(1),
         std::size_t{1}, place<std::size_t>(2), error);
    walk("hl_asset_levels_memory", &hl_asset_levels_memory, 0, HL_OK, asset, place<std::size_t>(1), error);
    walk("hl_asset_clip", &hl_asset_clip, 0, HL_OK, asset, sized<hl_clip>(1), error);

    walk("hl_instance_reset", &hl_instance_reset, 0, HL_OK, hair, &frame_, error);
    walk("hl_instance_step", &hl_instance_step, 0, HL_OK, hair, &frame_, error);
    hl_play play;
    hl_play_init(&play);
    walk("hl_instance_play", &hl_instance_play, 0, HL_BAD_VALUE, hair, asset, &frame_, &play, error);
    const double wind = 2;
    walk("hl_instance_set", &hl_instance_set, 0, HL_OK, hair, "windSpeed", &wind, std::size_t{1}, error);
    walk("hl_instance_choose", &hl_instance_choose, 0, HL_OK, hair, "windKind", "uniform", error);
    walk("hl_instance_set_pose", &hl_instance_set_pose, 0x4, HL_OK, hair, 0u, 0.5f, error);
    walk("hl_instance_pose", &hl_instance_pose, 0, HL_OK, hair, 0u, place<float>(1), error);
    ASSERT_EQ(hl_instance_set_pose(hair, 0, 0, error), HL_OK);
    hl_reserve reserve;
    hl_reserve_init(&reserve);
    walk("hl_instance_reserve", &hl_instance_reserve, 0, HL_OK, hair, &reserve, error);
    walk("hl_instance_describe", &(hl_instance_describe), 0, HL_OK, hair, place<hl_instance_info>(1), error);
    walk("hl_instance_describe_sized", &hl_instance_describe_sized, 0, HL_OK, hair,
         place<hl_instance_info>(1), sizeof(hl_instance_info), error);
    walk("hl_instance_offsets", &hl_instance_offsets, 0, HL_OK, hair, numbers.data(), guides + 1, error);
    std::size_t size = 0;
    ASSERT_EQ(hl_instance_save(hair, nullptr, 0, &size, error), HL_OK);
    walk("hl_instance_save", &hl_instance_save, 0, HL_OK, hair, floats.data(), 4 * floats.size(),
         place<std::size_t>(1), error);
    walk("hl_instance_load", &hl_instance_load, 0, HL_OK, hair, floats.data(), size, error);
    walk("hl_instance_effect", &(hl_instance_effect), 0, HL_OK, hair, 0u, place<hl_effect>(1), error);
    walk("hl_instance_effect_sized", &hl_instance_effect_sized, 0, HL_OK, hair, 0u, place<hl_effect>(1),
         sizeof(hl_effect), error);
    walk("hl_instance_hair_numbers", &hl_instance_hair_numbers, 0, HL_OK, hair, numbers.data(), hairs, error);
    hl_read read;
    hl_read_init(&read);
    walk("hl_instance_read", &hl_instance_read, 0, HL_OK, hair, &read, error);
    walk("hl_instance_read_guides", &hl_instance_read_guides, 0, HL_OK, hair, game::tight(floats, 3),
         game::kNothing, game::kNothing, error);
    walk("hl_instance_read_hairs", &hl_instance_read_hairs, 0, HL_OK, hair, game::tight(floats, 3),
         game::kNothing, game::kNothing, error);
    walk("hl_instance_level", &(hl_instance_level), 0, HL_OK, hair, 0u, place<hl_level>(1), error);
    walk("hl_instance_level_sized", &hl_instance_level_sized, 0, HL_OK, hair, 0u, place<hl_level>(1),
         sizeof(hl_level), error);
    walk("hl_instance_set_level", &hl_instance_set_level, 0, HL_OK, hair, 0u, 1.0f, error);
    walk("hl_instance_time", &hl_instance_time, 0x6, HL_OK, hair, &tick, &time, error);
    ASSERT_EQ(hl_instance_time(hair, nullptr, nullptr, error), HL_OK);
    walk("hl_rate", &hl_rate, 0x4, HL_OK, hair, &tick, &time, place<float>(1), error);
    hl_crowd_limits limits;
    hl_crowd_limits_init(&limits);
    *place<hl_viewed>(3) = {hair, 100, 0, 0, 0};
    walk("hl_crowd_plan", &(hl_crowd_plan), 0x8, HL_OK, &limits, place<hl_viewed>(3), std::size_t{1},
         place<hl_crowd_report>(1), error);
    walk("hl_crowd_plan_sized", &hl_crowd_plan_sized, 0x10, HL_OK, &limits, place<hl_viewed>(3),
         sizeof(hl_viewed), std::size_t{1}, place<hl_crowd_report>(1), sizeof(hl_crowd_report), error);
    ASSERT_TRUE(hair_.setLevel(0));

    walk("hl_gpu_buffer", &hl_gpu_buffer, 0, HL_OK, asset, 0u, sized<hl_gpu_buffer_info>(1), error);
    const auto bytesOf = [&](std::uint32_t buffer) {
        hl_gpu_buffer_info info{};
        info.size = sizeof info;
        EXPECT_EQ(hl_gpu_buffer(asset, buffer, &info, error), HL_OK);
        return info.bytes;
    };
    const std::uint32_t looks = HL_GPU_BUFFER_LOOKS, turns = HL_GPU_BUFFER_TURNS;
    walk("hl_gpu_fill", &hl_gpu_fill, 0, HL_OK, asset, looks, floats.data(), bytesOf(looks), error);
    walk("hl_gpu_fill_frame", &hl_gpu_fill_frame, 0, HL_OK, hair, turns, floats.data(), bytesOf(turns),
         error);
    walk("hl_gpu_begin", &hl_gpu_begin, 0, HL_OK, hair, error);
    walk("hl_gpu_step", &hl_gpu_step, 0, HL_OK, hair, &frame_, error);
    walk("hl_gpu_pass", &hl_gpu_pass, 0, HL_OK, asset, 0u, sized<hl_gpu_pass_info>(1), error);
    walk("hl_gpu_frame_pass", &hl_gpu_frame_pass, 0, HL_OK, hair, 0u, sized<hl_gpu_pass_info>(1), error);
    walk("hl_gpu_view_init_sized", &hl_gpu_view_init_sized, 0, HL_OK, asset, place<hl_gpu_view>(1),
         sizeof(hl_gpu_view), error);
    const float up[3] = {0, 1, 0};
    walk("hl_gpu_lamp_init_sized", &hl_gpu_lamp_init_sized, 0, HL_OK, &up[0], &up[0], 0.5f,
         place<hl_gpu_lamp>(1), sizeof(hl_gpu_lamp), error);
    walk("hl_gpu_frame_view_sized", &hl_gpu_frame_view_sized, 0, HL_OK, hair, place<hl_gpu_view>(1),
         sizeof(hl_gpu_view), error);

    // Those that make something, or say nothing.
    hl_instance* made = nullptr;
    hl_host host;
    hl_host_init(&host);
    EXPECT_EQ(hl_instance_make(nullptr, 0, nullptr, &made, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make(asset, 0, nullptr, nullptr, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make(asset, 4, nullptr, &made, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make_hosted(nullptr, 0, &host, &made, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make_hosted(asset, 0, nullptr, &made, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make_hosted(asset, 0, &host, nullptr, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_make_hosted(asset, ~0u, &host, &made, nullptr), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_copy(nullptr, &made, error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_copy(hair, nullptr, error), HL_BAD_VALUE);
    EXPECT_EQ(made, nullptr);
    hl_allocator allocator;
    hl_allocator_init(&allocator);
    EXPECT_EQ(hl_set_allocator(&allocator, error), HL_BAD_VALUE);
    hl_allocator_init(nullptr);
    hl_host_init(nullptr);
    hl_frame_init(nullptr);
    hl_play_init(nullptr);
    hl_pose_init(nullptr);
    hl_reserve_init(nullptr);
    hl_read_init(nullptr);
    hl_crowd_limits_init(nullptr);
    hl_instance_free(nullptr);
    EXPECT_EQ(hl_instance_hash(nullptr), 0u);
    EXPECT_EQ(hl_version(), static_cast<std::uint32_t>(HL_VERSION));
    seen_.insert({"hl_instance_make", "hl_instance_make_hosted", "hl_instance_copy", "hl_set_allocator",
                  "hl_allocator_init", "hl_host_init", "hl_frame_init", "hl_play_init", "hl_pose_init",
                  "hl_reserve_init", "hl_read_init", "hl_crowd_limits_init", "hl_instance_free",
                  "hl_instance_hash", "hl_version"});
    (void)bytes;

    std::set<std::string> listed;
    std::ifstream list(sourceDir() / "tests/runtime/abi_symbols.txt");
    for (std::string name; std::getline(list, name);) listed.insert(name);
    EXPECT_EQ(seen_, listed) << "a function that the walk leaves out";
}

TEST_F(RuntimeCalls, StructsOfEverySizeAreServedOrRefused) {
    hl_error* const error = &error_;
    const hl_asset* const asset = asset_.get();
    hl_instance* const hair = hair_.get();
    // Sizes that a call tells. The smallest are those of version 0.1, by the pages of those days.
    written("hl_asset_describe", 88, sizeof(hl_asset_info), [&](std::size_t size, std::byte* at) {
        return hl_asset_describe_sized(asset, reinterpret_cast<hl_asset_info*>(at), size, error);
    });
    written("hl_asset_layer", 24, sizeof(hl_layer), [&](std::size_t size, std::byte* at) {
        return hl_asset_layer_sized(asset, 0, reinterpret_cast<hl_layer*>(at), size, error);
    });
    written("hl_instance_describe", 40, sizeof(hl_instance_info), [&](std::size_t size, std::byte* at) {
        return hl_instance_describe_sized(hair, reinterpret_cast<hl_instance_info*>(at), size, error);
    });
    written("hl_instance_effect", 136, sizeof(hl_effect), [&](std::size_t size, std::byte* at) {
        return hl_instance_effect_sized(hair, 0, reinterpret_cast<hl_effect*>(at), size, error);
    });
    written("hl_instance_level", 28, sizeof(hl_level), [&](std::size_t size, std::byte* at) {
        return hl_instance_level_sized(hair, 0, reinterpret_cast<hl_level*>(at), size, error);
    });
    written("hl_gpu_view_init", 144, sizeof(hl_gpu_view), [&](std::size_t size, std::byte* at) {
        return hl_gpu_view_init_sized(asset, reinterpret_cast<hl_gpu_view*>(at), size, error);
    });
    const float up[3] = {0, 1, 0};
    written("hl_gpu_lamp_init", 96, sizeof(hl_gpu_lamp), [&](std::size_t size, std::byte* at) {
        return hl_gpu_lamp_init_sized(up, up, 0.5f, reinterpret_cast<hl_gpu_lamp*>(at), size, error);
    });
    sizes("hl_gpu_frame_view", 144, sizeof(hl_gpu_view), [&](std::size_t size) {
        return hl_gpu_frame_view_sized(hair, place<hl_gpu_view>(4), size, error);
    });
    // Sizes that the struct's first member tells, of what is given back.
    const auto inside = [&](const char* name, std::size_t now, auto* type, const auto& call) {
        using Struct = std::remove_pointer_t<decltype(type)>;
        auto* const at = place<Struct>(4);
        std::memset(static_cast<void*>(at), 0, kPlace);
        sizes(name, now, now, [&](std::size_t size) {
            at->size = size;
            return call(at);
        });
        at->size = now + 64;
        EXPECT_EQ(call(at), HL_OK) << name << " of tomorrow: " << error_.what();
        EXPECT_EQ(at->size, now + 64) << name;
        clear();
    };
    inside("hl_build", 40, static_cast<hl_build*>(nullptr),
           [&](hl_build* at) { return hl_build_info(at, error); });
    inside("hl_setting", 56, static_cast<hl_setting*>(nullptr),
           [&](hl_setting* at) { return hl_asset_setting(asset, 0, at, error); });
    inside("hl_attribute", 48, static_cast<hl_attribute*>(nullptr),
           [&](hl_attribute* at) { return hl_asset_attribute(asset, 0, at, error); });
    inside("hl_hair_pose", 32, static_cast<hl_hair_pose*>(nullptr),
           [&](hl_hair_pose* at) { return hl_asset_pose(asset, 0, at, error); });
    inside("hl_clip", 56, static_cast<hl_clip*>(nullptr),
           [&](hl_clip* at) { return hl_asset_clip(asset, at, error); });
    inside("hl_gpu_buffer_info", 32, static_cast<hl_gpu_buffer_info*>(nullptr),
           [&](hl_gpu_buffer_info* at) { return hl_gpu_buffer(asset, 0, at, error); });
    inside("hl_gpu_pass_info", 40, static_cast<hl_gpu_pass_info*>(nullptr),
           [&](hl_gpu_pass_info* at) { return hl_gpu_pass(asset, 0, at, error); });
    inside("hl_gpu_pass_info", 40, static_cast<hl_gpu_pass_info*>(nullptr),
           [&](hl_gpu_pass_info* at) { return hl_gpu_frame_pass(hair, 0, at, error); });

    // And of what asks for something: what this library does not know has to be 0.
    const auto asks = [&](const char* name, std::size_t least, const auto& value, const auto& call) {
        using Struct = std::decay_t<decltype(value)>;
        auto* const at = place<Struct>(4);
        std::memset(static_cast<void*>(at), 0, kPlace);
        std::memcpy(static_cast<void*>(at), &value, sizeof value);
        sizes(name, least, sizeof value, [&](std::size_t size) {
            at->size = size;
            return call(at);
        });
        at->size = sizeof value + 64;
        EXPECT_EQ(call(at), HL_OK) << name << " of tomorrow: " << error_.what();
        const std::uint64_t hash = hair_.hash();
        for (const std::size_t byte : {sizeof value, sizeof value + 63}) {
            reinterpret_cast<std::byte*>(at)[byte] = std::byte{1};
            at->size = sizeof value + 64;
            EXPECT_EQ(call(at), HL_NEWER) << name << ", byte " << byte;
            reinterpret_cast<std::byte*>(at)[byte] = std::byte{0};
        }
        EXPECT_EQ(hair_.hash(), hash) << name;
        clear();
    };
    Frame frame(0);
    asks("hl_frame", 128, static_cast<const hl_frame&>(frame),
         [&](const hl_frame* at) { return hl_instance_step(hair, at, error); });
    hl_reserve reserve;
    hl_reserve_init(&reserve);
    asks("hl_reserve", 24, reserve,
         [&](const hl_reserve* at) { return hl_instance_reserve(hair, at, error); });
    hl_read read;
    hl_read_init(&read);
    asks("hl_read", sizeof read, read, [&](hl_read* at) { return hl_instance_read(hair, at, error); });
    hl_host host;
    hl_host_init(&host);
    asks("hl_host", sizeof host, host, [&](const hl_host* at) {
        hl_instance* made = nullptr;
        const hl_code code = hl_instance_make_hosted(asset, HL_GUIDES, at, &made, error);
        EXPECT_EQ(made != nullptr, code == HL_OK);
        hl_instance_free(made);
        return code;
    });
    hl_crowd_limits limits;
    hl_crowd_limits_init(&limits);
    asks("hl_crowd_limits", 24, limits,
         [&](const hl_crowd_limits* at) { return hl_crowd_plan(at, nullptr, 0, nullptr, error); });
}

}  // namespace
}  // namespace hairloom::test
