// SPDX-License-Identifier: MIT
#pragma once
// What the kernels of strands are told of a frame.

#include <array>
#include <cstdint>
#include <span>

#include "engine/frame_setup.h"
#include "engine/slots.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

struct GpuFrame {
    const SimulationSettings& settings;
    const Wind& wind;
    std::span<const MovingSphere> spheres;
    std::size_t waking = 0;  ///< FrameSpheres::waking
    float before = 0;        ///< seconds of the last frame's substep; 0 before the first
    bool wakeAll = false;
    std::array<double, 3> origin_ws{};
    Float3 originShift{};  ///< metres that positions of the last frame have moved by, seen from the origin
};
/// Of slots in work groups of `groupStrands`.
shaders::SimulationConstants frameConstants(const GpuFrame& frame, const SubstepContext& context,
                                            const FrameInput& input, const Slots& slots,
                                            std::uint32_t groupStrands);

/// How many of them a frame has at most.
std::size_t sphereConstantsOf(const FrameSpheres& spheres, StrandModel model);
/// Spheres, and behind them the ends of each capsule. Keeps the memory of `constants`.
void putSphereConstants(std::span<const MovingSphere> spheres, std::span<const MovingCapsule> capsules,
                        Vector<shaders::SphereConstants>& constants);
/// Centre and reach of each. Keeps the memory of `reaches`.
void putWaking(const FrameSpheres& spheres, Vector<shaders::float4>& reaches);

/// What is known of roots from frame to frame.
struct FrameRoots {
    Vector<RootFrame> roots;  ///< one per strand, sound, at the end of the last frame
    Vector<bool> moved;       ///< of the last frame
    Float3 min_ws, max_ws;    ///< box of them
    float motion = 0;         ///< metres, the longest way
    std::uint32_t rejected = 0;
};
/// Takes the roots that the frame ends on. What is no root stays where it was. `known`: those of before are
/// where they were said to be.
void takeFrameRoots(std::span<const RootFrame> given, float teleportDistance, bool known, FrameRoots& roots);

}  // namespace hairloom::runtime
