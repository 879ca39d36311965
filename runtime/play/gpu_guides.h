// SPDX-License-Identifier: MIT
#pragma once
// What a game's GPU is given to step guides itself (hl_gpu_begin, hl_gpu_step).

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "engine/gpu_frame.h"
#include "hairloom/memory.h"
#include "models/rods/rods.h"
#include "shaders/rod_types.h"

namespace hairloom::runtime {

/// Blocks of 32 that strands fill at most, by their numbers of points.
std::size_t gpuBlocksOf(const Map<std::uint32_t, std::size_t>& strandsOf);
/// What wakes hair, by the spheres that there is room for: where each was and is, and capsules, each of which
/// has two of the spheres to itself.
inline constexpr std::size_t kWakingOfSphere = 3;
/// Spheres that the kernel has room for, of so many in the asset; a capsule has both ends to itself.
std::size_t gpuSpheresOf(std::size_t spheresOfAsset, std::size_t capsulesOfAsset);

/// Empty, or why the kernel does not know such hair.
std::string gpuGuidesRefused(const SimulationSettings& settings);

class GpuGuides {
  public:
    /// Goes on from a state of rods.
    GpuGuides(std::shared_ptr<const RestShape> shape, const SimulationSettings& settings,
              std::shared_ptr<const State> state, std::size_t mostSpheres);

    std::size_t mostSpheres() const { return mostSpheres_; }
    /// A frame of dt above 0 and, with both ends of each capsule, at most mostSpheres(). Asks for no memory.
    void take(const FrameInput& input);
    /// False once a frame was taken: what HL_GPU_BEGIN fills with is of the time before.
    bool atBegin() const { return state_ != nullptr; }
    bool hasFrame() const { return hasFrame_; }
    std::span<const RootFrame> roots() const { return roots_.roots; }
    /// HL_GPU_BUFFER_… of HL_GPU_BEGIN or HL_GPU_STEP; what it does not need of `out` becomes 0.
    void fill(std::uint32_t buffer, std::span<std::byte> out) const;

  private:
    /// What HL_GPU_STEP fills with.
    struct Frame {
        shaders::SimulationConstants constants{};
        shaders::RodConstants rods{};
        Vector<shaders::float4> roots, waking;
        Vector<shaders::SphereConstants> spheres;
    };
    void reserve();
    Slots slots() const;
    Float3 moveOrigin(std::array<double, 3> next);

    std::shared_ptr<const RestShape> shape_;
    SimulationSettings settings_;
    std::shared_ptr<const State> state_;
    std::size_t mostSpheres_;
    Vector<std::uint32_t> blocks_;
    std::uint32_t slotCount_ = 0;
    FrameWind wind_;
    FrameRoots roots_;
    FrameSpheres spheres_;
    Vector<Sphere> spheresBefore_;
    Vector<Capsule> capsulesBefore_;
    // Of a substep:
    Vector<MovingSphere> moving_;
    Vector<MovingCapsule> movingCapsules_;
    float substep_;
    std::optional<std::array<double, 3>> origin_;
    Frame frame_;
    bool hasFrame_ = false;
};

}  // namespace hairloom::runtime
