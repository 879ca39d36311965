// SPDX-License-Identifier: MIT
#pragma once
// One character's hair as an asset has it: what hl_instance is.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/asset.h"
#include "hairloom/engine.h"
#include "hairloom/hairloom.h"
#include "src/root_poses.h"

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
    std::size_t guides, hairs, thread;
};
InstanceMemory instanceMemory(const Asset& asset);

class Instance {
  public:
    struct Result;
    /// Of an asset whose content is sound.
    static Result make(const Asset& asset, bool wantsHairs, Host host);

    Outcome reset(const hl_frame& frame);
    Outcome step(const hl_frame& frame);
    Outcome set(std::string_view name, std::span<const double> values);
    Outcome readGuides(const hl_out& positions, const hl_out& tangents, const hl_out& radii);
    Outcome readHairs(const hl_out& positions, const hl_out& tangents, const hl_out& radii);
    Outcome readOffsets(std::span<std::uint32_t> offsets) const;
    hl_instance_info describe() const;
    std::uint64_t hash() const { return engine_.stateHash(); }

  private:
    /// How thick a strand is: by its points, or from root to tip.
    struct Radii {
        float root, tip;
        std::vector<float> own;  // of each point, or none
    };
    Instance(Engine engine, RootPoses poses, Host host)
        : engine_(std::move(engine)), poses_(std::move(poses)), host_(std::move(host)) {}

    Outcome place(const hl_frame& frame, FrameInput& input);
    Outcome placeRoots(const hl_frame& frame);
    Outcome placeSpheres(const hl_frame& frame, FrameInput& input);
    void takeTurns();
    bool asBefore(const hl_frame& frame) const;
    void remember(const hl_frame& frame);

    Engine engine_;
    std::optional<FollowHairs> hairs_;
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
