// SPDX-License-Identifier: MIT
#pragma once
// hairloom.h for C++17: objects that clean up after themselves, and std::vector where a caller has no buffer
// of its own. Nothing is thrown but what the standard library throws.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "hairloom/hairloom.h"

namespace hairloom::game {

/// Why the last call failed.
struct Error : hl_error {
    Error() : hl_error{} {}
    std::string_view what() const { return words; }
};

/// A frame that begins empty; `head`, `bones` and the like point at what the caller keeps.
struct Frame : hl_frame {
    explicit Frame(float seconds = 1.0f / 60.0f) {
        hl_frame_init(this);
        dt = seconds;
    }
};

/// A pose within a frame, likewise.
struct Pose : hl_pose {
    Pose() { hl_pose_init(this); }
};

/// Values of `components` floats each, one after another.
inline hl_out tight(std::vector<float>& values, std::size_t components) {
    return {values.data(), values.size() * sizeof(float), components * sizeof(float)};
}
inline constexpr hl_out kNothing{nullptr, 0, 0};

class Asset {
  public:
    /// False where the bytes are refused. They outlive the asset and begin at a multiple of 16.
    bool open(const void* bytes, std::size_t size, hl_error* error = nullptr) {
        return hl_asset_open(&asset_, bytes, size, error) == HL_OK;
    }
    bool check(hl_error* error = nullptr) const { return hl_asset_check(&asset_, error) == HL_OK; }
    /// Of 0 frames where it has none.
    hl_clip clip(hl_error* error = nullptr) const {
        hl_clip found{};
        found.size = sizeof found;
        hl_asset_clip(&asset_, &found, error);
        return found;
    }
    /// All 0 where the content is damaged.
    hl_asset_info describe(hl_error* error = nullptr) const {
        hl_asset_info info{};
        hl_asset_describe(&asset_, &info, error);
        return info;
    }
    /// The first number of a setting, or `missing`.
    double number(const char* name, double missing) const {
        double values[32];
        std::size_t count = 0;
        return hl_asset_numbers(&asset_, name, values, 32, &count, nullptr) == HL_OK && count > 0 ? values[0]
                                                                                                  : missing;
    }
    /// The number of the pose of that name, for Instance::setPose().
    bool findPose(const char* name, std::uint32_t& pose, hl_error* error = nullptr) const {
        return hl_asset_find_pose(&asset_, name, &pose, error) == HL_OK;
    }
    const hl_asset* get() const { return &asset_; }

  private:
    hl_asset asset_{};
};

class Instance {
  public:
    Instance() = default;
    /// `what` is HL_GUIDES or a sum of HL_HAIRS and HL_LEVELS. False where the asset is refused.
    bool make(const Asset& asset, std::uint32_t what, const hl_jobs* jobs = nullptr,
              hl_error* error = nullptr) {
        hl_instance* made = nullptr;
        const bool good = hl_instance_make(asset.get(), what, jobs, &made, error) == HL_OK;
        if (good) instance_.reset(made);
        return good;
    }
    /// Another character of the same hair, in the same state.
    bool copy(const Instance& other, hl_error* error = nullptr) {
        hl_instance* made = nullptr;
        const bool good = hl_instance_copy(other.get(), &made, error) == HL_OK;
        if (good) instance_.reset(made);
        return good;
    }
    bool reset(const hl_frame& frame, hl_error* error = nullptr) {
        return hl_instance_reset(instance_.get(), &frame, error) == HL_OK;
    }
    bool step(const hl_frame& frame, hl_error* error = nullptr) {
        return hl_instance_step(instance_.get(), &frame, error) == HL_OK;
    }
    /// The asset's clip at that many seconds, in place of a step; the asset's bytes stay.
    bool play(const Asset& asset, const hl_frame& frame, double seconds, hl_error* error = nullptr) {
        hl_play how;
        hl_play_init(&how);
        how.time = seconds;
        return play(asset, frame, how, error);
    }
    bool play(const Asset& asset, const hl_frame& frame, const hl_play& how, hl_error* error = nullptr) {
        return hl_instance_play(instance_.get(), asset.get(), &frame, &how, error) == HL_OK;
    }
    bool set(const char* name, double value, hl_error* error = nullptr) {
        return hl_instance_set(instance_.get(), name, &value, 1, error) == HL_OK;
    }
    bool choose(const char* name, const char* choice, hl_error* error = nullptr) {
        return hl_instance_choose(instance_.get(), name, choice, error) == HL_OK;
    }
    /// How far hair follows a pose of the asset, 0 to 1.
    bool setPose(std::uint32_t pose, float amount, hl_error* error = nullptr) {
        return hl_instance_set_pose(instance_.get(), pose, amount, error) == HL_OK;
    }
    /// All memory that frames of up to so many spheres may come to ask for.
    bool reserve(std::uint32_t spheres, hl_error* error = nullptr) {
        hl_reserve wanted;
        hl_reserve_init(&wanted);
        wanted.spheres = spheres;
        return hl_instance_reserve(instance_.get(), &wanted, error) == HL_OK;
    }
    hl_instance_info describe() const {
        hl_instance_info info{};
        hl_instance_describe(instance_.get(), &info, nullptr);
        return info;
    }
    bool setLevel(std::uint32_t level, float hairShare = 1, hl_error* error = nullptr) {
        return hl_instance_set_level(instance_.get(), level, hairShare, error) == HL_OK;
    }
    /// All 0 without HL_LEVELS.
    hl_level describeLevel(std::uint32_t level) const {
        hl_level described{};
        hl_instance_level(instance_.get(), level, &described, nullptr);
        return described;
    }
    /// Of the last step, with milliseconds where hl_instance_time() has lent a clock.
    hl_effect describeEffect(std::uint32_t effect) const {
        hl_effect described{};
        hl_instance_effect(instance_.get(), effect, &described, nullptr);
        return described;
    }
    std::uint64_t hash() const { return hl_instance_hash(instance_.get()); }
    /// Three floats of each point; resizes.
    bool readGuides(std::vector<float>& positions, hl_error* error = nullptr) {
        positions.resize(std::size_t{3} * describe().guide_points);
        return hl_instance_read_guides(instance_.get(), tight(positions, 3), kNothing, kNothing, error) ==
               HL_OK;
    }
    bool readHairs(std::vector<float>& positions, hl_error* error = nullptr) {
        const hl_instance_info info = describe();
        positions.resize(std::size_t{3} * info.hairs * info.points_per_hair);
        return hl_instance_read_hairs(instance_.get(), tight(positions, 3), kNothing, kNothing, error) ==
               HL_OK;
    }
    hl_instance* get() const { return instance_.get(); }

  private:
    struct Free {
        void operator()(hl_instance* instance) const { hl_instance_free(instance); }
    };
    std::unique_ptr<hl_instance, Free> instance_;
};

/// The characters of a scene, with one budget: hl_crowd_plan().
class Crowd {
  public:
    Crowd() { hl_crowd_limits_init(&limits); }
    /// The instance, which was made with HL_LEVELS, outlives the crowd and does not move. Its number.
    std::size_t add(Instance& instance) {
        characters.push_back({instance.get(), 0, 0, 0, 0});
        return characters.size() - 1;
    }
    /// Once a frame, before the steps, when every pixels_per_metre is set.
    bool plan(hl_error* error = nullptr) {
        return hl_crowd_plan(&limits, characters.data(), characters.size(), &report, error) == HL_OK;
    }
    hl_crowd_limits limits;
    std::vector<hl_viewed> characters;
    hl_crowd_report report{};
};

}  // namespace hairloom::game
