// SPDX-License-Identifier: MIT
#pragma once
// One character's hair as an asset has it: what hl_instance is.

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/asset.h"
#include "hairloom/engine.h"
#include "hairloom/hairloom.h"
#include "play/levels.h"
#include "play/root_poses.h"

namespace hairloom::runtime {

/// What a call of the C interface refuses.
struct Refusal {
    hl_code code;
    std::string words;
};
using Outcome = std::optional<Refusal>;

/// Bytes that an instance holds at most, by the counts of a sound asset: with one thread, what follow hairs
/// add, and what each further thread adds.
struct InstanceMemory {
    std::size_t guides, hairs, levels, thread;
};
InstanceMemory instanceMemory(const Asset& asset);

class Instance {
  public:
    struct Result;
    /// Of an asset whose content is sound.
    static Result make(const Asset& asset, bool wantsHairs, bool wantsLevels, Host host);

    Outcome reset(const hl_frame& frame);
    Outcome step(const hl_frame& frame);
    Outcome set(std::string_view name, std::span<const double> values);
    Outcome readGuides(const hl_out& positions, const hl_out& tangents, const hl_out& radii);
    Outcome readHairs(const hl_out& positions, const hl_out& tangents, const hl_out& radii);
    Outcome readOffsets(std::span<std::uint32_t> offsets) const;
    hl_instance_info describe() const;
    std::uint64_t hash() const;
    void setClock(const std::function<std::uint64_t()>& nanoseconds);
    hl_effect describeEffect(std::uint32_t effect) const;

    // Of an instance with levels of detail.
    bool hasLevels() const { return levels_.has_value(); }
    std::uint32_t level() const { return levels_ ? levels_->level : 0; }
    Outcome setLevel(std::uint32_t level, float hairShare);
    hl_level describeLevel(std::uint32_t level) const;
    /// Metres, of a frame as the last ones were.
    float predictedError(std::uint32_t level) const;
    /// Of the next step and read-out; 0 where it sleeps and stays at its level.
    float predictedMilliseconds(std::uint32_t level, float hairShare) const;
    float rootRadius() const { return radii_.root; }

  private:
    /// How thick a strand is: by its points, or from root to tip.
    struct Radii {
        float root, tip;
        std::vector<float> own;                     // of each point, or none
        std::vector<std::array<float, 2>> ofHairs;  // root and tip of each guide's, or none: as above
    };
    Instance(Engine engine, RootPoses poses, Host host)
        : engine_(std::move(engine)), poses_(std::move(poses)), host_(std::move(host)) {}

    /// Levels of detail (instance_levels.cpp).
    struct Levels {
        std::shared_ptr<const LevelSet> set;
        std::vector<Engine> engines;  ///< of levels 1 …, before the rigid one
        std::uint32_t level = 0;
        std::vector<std::uint32_t> taken;  ///< of the hairs that are read, as FollowHairs::evaluateSome()
        /// Where roots were last, all finite, and what they were measured from; none before the first step.
        std::vector<RootFrame> placed;
        std::optional<std::array<double, 3>> origin;
        Float3 velocity{};           ///< m/s, mean of the roots
        float motion = 0, wind = 0;  ///< m/s, greatest of the last frames; fades
        /// In the frames of the roots: from where guides are at this level to where the last one had them.
        std::vector<Float3> fade;
        bool fading = false;
        std::vector<RootFrame> simulatedRoots;  // of the level's guides
        std::vector<Float3> simulated, moved;   // of their points
    };
    void makeLevels(const Asset& asset, const Asset::Strands& strands);
    void measureLevels(const Asset& asset, LevelSet& set);
    void resetLevel();
    void setSettingsOfLevels(const SimulationSettings& settings);
    void stepLevel(FrameInput& input);
    void placeRootsOfLevels();
    void holdMotion(const FrameInput& input);
    /// The engine of the level; null where it is the rigid one.
    Engine* engineOfLevel();
    const Engine* engineOfLevel() const { return const_cast<Instance*>(this)->engineOfLevel(); }
    std::size_t bytesOfLevels() const;
    std::uint32_t hairsRead() const;
    void takeHairs(float share);
    /// Fill positions_ and velocities_.
    void showPositions();
    void showVelocities();

    Outcome place(const hl_frame& frame, FrameInput& input);
    Outcome placeRoots(const hl_frame& frame);
    Outcome placeSpheres(const hl_frame& frame, FrameInput& input);
    void takeTurns();
    bool asBefore(const hl_frame& frame) const;
    void remember(const hl_frame& frame);

    Engine engine_;
    std::optional<FollowHairs> hairs_;
    std::vector<std::uint32_t> hairGroups_;  // hairs before each guide's, then all
    std::optional<Levels> levels_;
    RootPoses poses_;
    Host host_;
    Radii radii_{};
    std::vector<std::uint32_t> offsets_;
    std::vector<asset::Sphere> restSpheres_;
    std::vector<Sphere> spheres_;
    std::vector<RootFrame> roots_;
    std::vector<Quat> turns_;
    /// What the last step was given, where all of it is a head or bones; hair that sleeps needs no other.
    struct LastFrame {
        bool known = false, hasWind = false;
        float dt = 0;
        std::array<double, 3> origin{};
        Matrix34 head{};
        std::array<float, 3> wind{};
        std::vector<float> bones;
    } last_;
    bool asleep_ = false;
    std::vector<Float3> positions_, velocities_, hairPositions_;
};

struct Instance::Result {
    std::optional<Instance> instance;
    std::string error;
};

}  // namespace hairloom::runtime

struct hl_instance {
    hairloom::runtime::Instance instance;
};
