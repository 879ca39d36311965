// SPDX-License-Identifier: GPL-3.0-or-later
// The binary interface of hairloom.h on machines of 64 bits. Games are linked against it, and other languages
// (P/Invoke, say) lay out its structs by hand: a change here breaks them. What is new goes to the end of a
// struct that tells its size, or has a name of its own.

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <type_traits>

#include "hairloom/hairloom.h"

namespace {

static_assert(sizeof(void*) == 8 && sizeof(size_t) == 8);

/// Members in order, each with where it begins; nothing but padding lies between them.
struct Member {
    const char* name;
    std::size_t offset, bytes, expectedOffset, expectedBytes;
};
#define MEMBER(type, name, offset, bytes)                                        \
    Member {                                                                     \
#type "." #name, offsetof(type, name), sizeof(type::name), offset, bytes \
    }

TEST(Abi, StructsLieAsTheyDid) {
    const Member members[] = {
        MEMBER(hl_error, code, 0, 4),
        MEMBER(hl_error, byte, 8, 8),
        MEMBER(hl_error, words, 16, 232),
        MEMBER(hl_asset, inside, 0, 320),
        MEMBER(hl_asset_info, major, 0, 4),
        MEMBER(hl_asset_info, minor, 4, 4),
        MEMBER(hl_asset_info, guides, 8, 4),
        MEMBER(hl_asset_info, guide_points, 12, 4),
        MEMBER(hl_asset_info, hairs, 16, 4),
        MEMBER(hl_asset_info, points_per_hair, 20, 4),
        MEMBER(hl_asset_info, bones, 24, 4),
        MEMBER(hl_asset_info, spheres, 28, 4),
        MEMBER(hl_asset_info, scalp_vertices, 32, 4),
        MEMBER(hl_asset_info, bounds_min, 36, 12),
        MEMBER(hl_asset_info, bounds_max, 48, 12),
        MEMBER(hl_asset_info, greatest_error, 60, 4),
        MEMBER(hl_asset_info, guides_memory, 64, 8),
        MEMBER(hl_asset_info, hairs_memory, 72, 8),
        MEMBER(hl_asset_info, thread_memory, 80, 8),
        MEMBER(hl_asset_info, levels_memory, 88, 8),
        MEMBER(hl_asset_info, layers, 96, 4),
        MEMBER(hl_asset_info, settings, 100, 4),
        MEMBER(hl_asset_info, attributes, 104, 4),
        MEMBER(hl_asset_info, measured_levels, 108, 4),
        MEMBER(hl_asset_info, poses, 112, 4),
        MEMBER(hl_build, size, 0, 8),
        MEMBER(hl_build, version, 8, 4),
        MEMBER(hl_build, lanes, 12, 4),
        MEMBER(hl_build, instruction_set, 16, 8),
        MEMBER(hl_build, compiler, 24, 8),
        MEMBER(hl_build, fused, 32, 4),
        MEMBER(hl_build, single_header, 36, 4),
        MEMBER(hl_setting, size, 0, 8),
        MEMBER(hl_setting, name, 8, 8),
        MEMBER(hl_setting, name_bytes, 16, 8),
        MEMBER(hl_setting, kind, 24, 4),
        MEMBER(hl_setting, count, 28, 4),
        MEMBER(hl_setting, values, 32, 8),
        MEMBER(hl_setting, choice, 40, 8),
        MEMBER(hl_setting, choice_bytes, 48, 8),
        MEMBER(hl_attribute, size, 0, 8),
        MEMBER(hl_attribute, name, 8, 8),
        MEMBER(hl_attribute, name_bytes, 16, 8),
        MEMBER(hl_attribute, type, 24, 4),
        MEMBER(hl_attribute, components, 28, 4),
        MEMBER(hl_attribute, values, 32, 8),
        MEMBER(hl_attribute, bytes, 40, 8),
        MEMBER(hl_hair, guide, 0, 4),
        MEMBER(hl_hair, layer, 4, 4),
        MEMBER(hl_hair, guides, 8, 12),
        MEMBER(hl_hair, shares, 20, 12),
        MEMBER(hl_hair, random, 32, 4),
        MEMBER(hl_hair, root_uv, 36, 8),
        MEMBER(hl_hair, colour, 44, 12),
        MEMBER(hl_hair, root_radius, 56, 4),
        MEMBER(hl_hair, tip_radius, 60, 4),
        MEMBER(hl_host, size, 0, 8),
        MEMBER(hl_host, jobs, 8, 8),
        MEMBER(hl_host, user, 16, 8),
        MEMBER(hl_host, nanoseconds, 24, 8),
        MEMBER(hl_host, log, 32, 8),
        MEMBER(hl_allocator, size, 0, 8),
        MEMBER(hl_allocator, user, 8, 8),
        MEMBER(hl_allocator, allocate, 16, 8),
        MEMBER(hl_allocator, release, 24, 8),
        MEMBER(hl_clip, size, 0, 8),
        MEMBER(hl_clip, name, 8, 8),
        MEMBER(hl_clip, name_bytes, 16, 8),
        MEMBER(hl_clip, frames, 24, 4),
        MEMBER(hl_clip, frames_per_second, 28, 4),
        MEMBER(hl_clip, loops, 32, 4),
        MEMBER(hl_clip, largest_error, 36, 4),
        MEMBER(hl_clip, bytes, 40, 8),
        MEMBER(hl_clip, memory, 48, 8),
        MEMBER(hl_play, size, 0, 8),
        MEMBER(hl_play, time, 8, 8),
        MEMBER(hl_play, speed, 16, 4),
        MEMBER(hl_play, loop, 20, 4),
        MEMBER(hl_reserve, size, 0, 8),
        MEMBER(hl_reserve, spheres, 8, 4),
        MEMBER(hl_reserve, previous_guides, 12, 4),
        MEMBER(hl_reserve, previous_hairs, 16, 4),
        MEMBER(hl_reserve, inner, 20, 4),
        MEMBER(hl_read, size, 0, 8),
        MEMBER(hl_read, hairs, 8, 4),
        MEMBER(hl_read, position_format, 12, 4),
        MEMBER(hl_read, tangent_format, 16, 4),
        MEMBER(hl_read, radius_format, 20, 4),
        MEMBER(hl_read, positions, 24, 24),
        MEMBER(hl_read, tangents, 48, 24),
        MEMBER(hl_read, radii, 72, 24),
        MEMBER(hl_read, previous, 96, 24),
        MEMBER(hl_read, from, 120, 12),
        MEMBER(hl_read, to, 132, 12),
        MEMBER(hl_read, state, 144, 8),
        MEMBER(hl_read, bounds_min, 152, 12),
        MEMBER(hl_read, bounds_max, 164, 12),
        MEMBER(hl_read, changed, 176, 4),
        MEMBER(hl_read, outside, 180, 4),
        MEMBER(hl_bone, name, 0, 8),
        MEMBER(hl_bone, name_bytes, 8, 8),
        MEMBER(hl_bone, index, 16, 4),
        MEMBER(hl_bone, inverse_bind, 20, 48),
        MEMBER(hl_layer, name, 0, 8),
        MEMBER(hl_layer, name_bytes, 8, 8),
        MEMBER(hl_layer, density, 16, 4),
        MEMBER(hl_layer, own_material, 20, 4),
        MEMBER(hl_jobs, user, 0, 8),
        MEMBER(hl_jobs, parallel_for, 8, 8),
        MEMBER(hl_frame, size, 0, 8),
        MEMBER(hl_frame, dt, 8, 4),
        MEMBER(hl_frame, time, 16, 8),
        MEMBER(hl_frame, head, 24, 8),
        MEMBER(hl_frame, bones, 32, 8),
        MEMBER(hl_frame, bone_count, 40, 8),
        MEMBER(hl_frame, scalp, 48, 8),
        MEMBER(hl_frame, scalp_count, 56, 8),
        MEMBER(hl_frame, roots, 64, 8),
        MEMBER(hl_frame, root_count, 72, 8),
        MEMBER(hl_frame, spheres, 80, 8),
        MEMBER(hl_frame, sphere_count, 88, 8),
        MEMBER(hl_frame, wind, 96, 8),
        MEMBER(hl_frame, origin, 104, 24),
        MEMBER(hl_frame, capsules, 128, 8),
        MEMBER(hl_frame, capsule_count, 136, 8),
        MEMBER(hl_frame, inner, 144, 8),
        MEMBER(hl_frame, inner_count, 152, 8),
        MEMBER(hl_frame, cut, 160, 4),
        MEMBER(hl_frame, unused, 164, 4),
        MEMBER(hl_pose, size, 0, 8),
        MEMBER(hl_pose, head, 8, 8),
        MEMBER(hl_pose, bones, 16, 8),
        MEMBER(hl_pose, scalp, 24, 8),
        MEMBER(hl_pose, roots, 32, 8),
        MEMBER(hl_pose, spheres, 40, 8),
        MEMBER(hl_instance_info, guides, 0, 4),
        MEMBER(hl_instance_info, guide_points, 4, 4),
        MEMBER(hl_instance_info, hairs, 8, 4),
        MEMBER(hl_instance_info, points_per_hair, 12, 4),
        MEMBER(hl_instance_info, asleep, 16, 4),
        MEMBER(hl_instance_info, restored, 20, 4),
        MEMBER(hl_instance_info, left_roots, 24, 4),
        MEMBER(hl_instance_info, left_spheres, 28, 4),
        MEMBER(hl_instance_info, bytes, 32, 8),
        MEMBER(hl_effect, name, 0, 8),
        MEMBER(hl_effect, on, 8, 4),
        MEMBER(hl_effect, milliseconds, 12, 4),
        MEMBER(hl_effect, why, 16, 120),
        MEMBER(hl_level, guides, 0, 4),
        MEMBER(hl_level, points, 4, 4),
        MEMBER(hl_level, substeps, 8, 4),
        MEMBER(hl_level, error_still, 12, 4),
        MEMBER(hl_level, error_head, 16, 4),
        MEMBER(hl_level, error_wind, 20, 4),
        MEMBER(hl_level, milliseconds, 24, 4),
        MEMBER(hl_level, seen_still, 28, 4),
        MEMBER(hl_level, seen_head, 32, 4),
        MEMBER(hl_level, seen_wind, 36, 4),
        MEMBER(hl_crowd_limits, size, 0, 8),
        MEMBER(hl_crowd_limits, error_pixels, 8, 4),
        MEMBER(hl_crowd_limits, hair_pixels, 12, 4),
        MEMBER(hl_crowd_limits, milliseconds, 16, 4),
        MEMBER(hl_crowd_limits, speed, 20, 4),
        MEMBER(hl_crowd_limits, strict, 24, 4),
        MEMBER(hl_crowd_limits, unused, 28, 4),
        MEMBER(hl_viewed, hair, 0, 8),
        MEMBER(hl_viewed, pixels_per_metre, 8, 4),
        MEMBER(hl_viewed, level, 12, 4),
        MEMBER(hl_viewed, error_pixels, 16, 4),
        MEMBER(hl_viewed, milliseconds, 20, 4),
        MEMBER(hl_crowd_report, error_pixels, 0, 4),
        MEMBER(hl_crowd_report, milliseconds, 4, 4),
        MEMBER(hl_crowd_report, within, 8, 4),
        MEMBER(hl_out, data, 0, 8),
        MEMBER(hl_out, bytes, 8, 8),
        MEMBER(hl_out, stride, 16, 8),
    };
    for (const Member& member : members) {
        EXPECT_EQ(member.offset, member.expectedOffset) << member.name;
        EXPECT_EQ(member.bytes, member.expectedBytes) << member.name;
    }
    EXPECT_EQ(sizeof(hl_error), 248u);
    EXPECT_EQ(sizeof(hl_asset), 320u);
    EXPECT_EQ(sizeof(hl_asset_info), 120u);
    EXPECT_EQ(sizeof(hl_build), 40u);
    EXPECT_EQ(sizeof(hl_setting), 56u);
    EXPECT_EQ(sizeof(hl_attribute), 48u);
    EXPECT_EQ(sizeof(hl_hair), 64u);
    EXPECT_EQ(sizeof(hl_host), 40u);
    EXPECT_EQ(sizeof(hl_allocator), 32u);
    EXPECT_EQ(sizeof(hl_read), 184u);
    EXPECT_EQ(sizeof(hl_bone), 72u);
    EXPECT_EQ(sizeof(hl_layer), 24u);
    EXPECT_EQ(sizeof(hl_jobs), 16u);
    EXPECT_EQ(sizeof(hl_frame), 168u);
    EXPECT_EQ(sizeof(hl_pose), 48u);
    EXPECT_EQ(sizeof(hl_instance_info), 40u);
    EXPECT_EQ(sizeof(hl_out), 24u);
    EXPECT_EQ(sizeof(hl_effect), 136u);
    EXPECT_EQ(sizeof(hl_level), 40u);
    EXPECT_EQ(sizeof(hl_crowd_limits), 32u);
    EXPECT_EQ(sizeof(hl_viewed), 24u);
    EXPECT_EQ(sizeof(hl_crowd_report), 12u);
}
#undef MEMBER

TEST(Abi, CodesHaveTheirNumbers) {
    const int codes[] = {HL_OK,     HL_DAMAGED, HL_NEWER,  HL_WRONG_SIZE,   HL_BAD_VALUE,   HL_NO_MEMORY,
                         HL_GUIDES, HL_HAIRS,   HL_LEVELS, HL_LEVEL_FINEST, HL_LEVEL_RIGID, HL_LEVEL_COUNT};
    const int expected[] = {0, 1, 2, 3, 4, 5, 0, 1, 2, 0, 4, 5};
    for (std::size_t i = 0; i < std::size(codes); ++i) EXPECT_EQ(codes[i], expected[i]) << i;
    EXPECT_EQ(sizeof(hl_code), 4u);
    EXPECT_EQ(HL_NO_PLACE, ~std::uint64_t{0});
}

/// Names are C's: what a function takes and returns is all that a linker does not look at.
template <class Expected, class Function>
constexpr bool isA(Function*) {
    return std::is_same_v<Expected, Function>;
}

TEST(Abi, FunctionsTakeWhatTheyTook) {
    using Asset = const hl_asset*;
    using Hair = hl_instance*;
    using ConstHair = const hl_instance*;
    EXPECT_TRUE((isA<hl_code(hl_asset*, const void*, size_t, hl_error*)>(&hl_asset_open)));
    EXPECT_TRUE((isA<hl_code(Asset, hl_error*)>(&hl_asset_check)));
    EXPECT_TRUE((isA<hl_code(Asset, hl_asset_info*, hl_error*)>(&hl_asset_describe)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, hl_bone*, hl_error*)>(&hl_asset_bone)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t*, size_t, hl_error*)>(&hl_asset_scalp_sources)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, hl_layer*, hl_error*)>(&hl_asset_layer)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t*, std::uint32_t*, size_t, hl_error*)>(&hl_asset_layers)));
    EXPECT_TRUE((isA<hl_code(Asset, const char*, double*, size_t, size_t*, hl_error*)>(&hl_asset_numbers)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, const hl_jobs*, Hair*, hl_error*)>(&hl_instance_make)));
    EXPECT_TRUE((isA<hl_code(ConstHair, Hair*, hl_error*)>(&hl_instance_copy)));
    EXPECT_TRUE((isA<void(Hair)>(&hl_instance_free)));
    EXPECT_TRUE((isA<void(hl_frame*)>(&hl_frame_init)));
    EXPECT_TRUE((isA<void(hl_pose*)>(&hl_pose_init)));
    EXPECT_TRUE((isA<hl_code(Hair, const hl_frame*, hl_error*)>(&hl_instance_reset)));
    EXPECT_TRUE((isA<hl_code(Hair, const hl_frame*, hl_error*)>(&hl_instance_step)));
    EXPECT_TRUE((isA<hl_code(Hair, const char*, const double*, size_t, hl_error*)>(&hl_instance_set)));
    EXPECT_TRUE((isA<hl_code(ConstHair, hl_instance_info*, hl_error*)>(&hl_instance_describe)));
    EXPECT_TRUE((isA<hl_code(ConstHair, std::uint32_t*, size_t, hl_error*)>(&hl_instance_offsets)));
    EXPECT_TRUE((isA<std::uint64_t(ConstHair)>(&hl_instance_hash)));
    EXPECT_TRUE((isA<hl_code(Hair, hl_out, hl_out, hl_out, hl_error*)>(&hl_instance_read_guides)));
    EXPECT_TRUE((isA<hl_code(Hair, hl_out, hl_out, hl_out, hl_error*)>(&hl_instance_read_hairs)));
    EXPECT_TRUE((isA<hl_code(Hair, std::uint64_t(*)(void*), void*, hl_error*)>(&hl_instance_time)));
    EXPECT_TRUE((isA<hl_code(ConstHair, std::uint32_t, hl_effect*, hl_error*)>(&hl_instance_effect)));
    EXPECT_TRUE((isA<hl_code(Asset, size_t*, hl_error*)>(&hl_asset_levels_memory)));
    EXPECT_TRUE((isA<hl_code(ConstHair, std::uint32_t, hl_level*, hl_error*)>(&hl_instance_level)));
    EXPECT_TRUE((isA<hl_code(Hair, std::uint32_t, float, hl_error*)>(&hl_instance_set_level)));
    EXPECT_TRUE((isA<void(hl_crowd_limits*)>(&hl_crowd_limits_init)));
    EXPECT_TRUE((isA<hl_code(const hl_crowd_limits*, hl_viewed*, size_t, hl_crowd_report*, hl_error*)>(
        &hl_crowd_plan)));
    EXPECT_TRUE((isA<std::uint32_t()>(&hl_version)));
    EXPECT_TRUE((isA<hl_code(hl_build*, hl_error*)>(&hl_build_info)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, hl_setting*, hl_error*)>(&hl_asset_setting)));
    EXPECT_TRUE((isA<hl_code(Asset, const char*, std::uint32_t*, hl_error*)>(&hl_asset_find_setting)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, hl_attribute*, hl_error*)>(&hl_asset_attribute)));
    EXPECT_TRUE((isA<hl_code(Asset, const char*, std::uint32_t*, hl_error*)>(&hl_asset_find_attribute)));
    EXPECT_TRUE((isA<hl_code(Asset, hl_hair*, size_t, size_t, hl_error*)>(&hl_asset_hairs)));
    EXPECT_TRUE((isA<void(hl_host*)>(&hl_host_init)));
    EXPECT_TRUE((isA<void(hl_allocator*)>(&hl_allocator_init)));
    EXPECT_TRUE((isA<hl_code(const hl_allocator*, hl_error*)>(&hl_set_allocator)));
    EXPECT_TRUE(
        (isA<hl_code(Asset, std::uint32_t, const hl_host*, Hair*, hl_error*)>(&hl_instance_make_hosted)));
    EXPECT_TRUE((isA<hl_code(ConstHair, void*, size_t, size_t*, hl_error*)>(&hl_instance_save)));
    EXPECT_TRUE((isA<hl_code(Hair, const void*, size_t, hl_error*)>(&hl_instance_load)));
    EXPECT_TRUE((isA<hl_code(ConstHair, std::uint32_t*, size_t, hl_error*)>(&hl_instance_hair_numbers)));
    EXPECT_TRUE((isA<void(hl_read*)>(&hl_read_init)));
    EXPECT_TRUE((isA<hl_code(Hair, hl_read*, hl_error*)>(&hl_instance_read)));
    EXPECT_TRUE((isA<hl_code(ConstHair, std::uint64_t(*)(void*), void*, float*, hl_error*)>(&hl_rate)));
    EXPECT_TRUE((isA<hl_code(Asset, hl_asset_info*, size_t, hl_error*)>(&hl_asset_describe_sized)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, hl_bone*, size_t, hl_error*)>(&hl_asset_bone_sized)));
    EXPECT_TRUE((isA<hl_code(Asset, std::uint32_t, hl_layer*, size_t, hl_error*)>(&hl_asset_layer_sized)));
    EXPECT_TRUE((isA<hl_code(ConstHair, hl_instance_info*, size_t, hl_error*)>(&hl_instance_describe_sized)));
    EXPECT_TRUE(
        (isA<hl_code(ConstHair, std::uint32_t, hl_effect*, size_t, hl_error*)>(&hl_instance_effect_sized)));
    EXPECT_TRUE(
        (isA<hl_code(ConstHair, std::uint32_t, hl_level*, size_t, hl_error*)>(&hl_instance_level_sized)));
    EXPECT_TRUE((
        isA<hl_code(const hl_crowd_limits*, hl_viewed*, size_t, size_t, hl_crowd_report*, size_t, hl_error*)>(
            &hl_crowd_plan_sized)));
}

}  // namespace
