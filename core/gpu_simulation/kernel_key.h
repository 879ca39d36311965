// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which permutation of the strand kernel runs a plan.

#include <array>
#include <cstdint>
#include <string>

#include "hairloom/plan.h"
#include "runtime/engine/kernels.h"

namespace hairloom::gpu_simulation {

/// Where a strand is between the substeps of a frame (runtime/shaders/storage.hlsli).
/// With `lanes` a thread has one or two points, with `wisps` each strand a work group, whose first thread
/// takes it (Rünz 2012, Section 6.1). Direct3D 11 has `threads` in the place of `lanes`.
enum class StrandStorage : std::uint32_t { threads, groups, buffers, lanes, wisps };

/// A block falls asleep as one: whether its strands are in several work groups.
constexpr bool sharesBlocks(StrandStorage storage) {
    return storage == StrandStorage::lanes || storage == StrandStorage::wisps;
}

/// How the strands of a batch are laid out and looped over.
struct BatchShape {
    std::uint32_t points = 0;  ///< that a strand may have
    bool exact = false;        ///< all have as many
    bool unrolled = false;     ///< loops along the strand
    StrandStorage storage = StrandStorage::threads;
    std::uint32_t strands = runtime::kBlockLanes;  ///< of a work group, a divisor of those of a block
    /// In buffers the points of a strand stand side by side, not those of neighbouring strands.
    bool together = false;
    std::uint32_t perThread = 1;  ///< of lanes: points of a thread, 1 or 2
    /// Of lanes: threads of a wave that read each other's registers; 0: they use the memory of the group.
    std::uint32_t wave = 0;
    /// Of rods: threads that share a strand (runtime/shaders/rod_members.hlsli).
    std::uint32_t members = 1;

    friend bool operator==(const BatchShape&, const BatchShape&) = default;
};

/// Spheres that a kernel looks at.
enum class SphereSource : std::uint32_t { none, constants, buffer };

struct KernelKey {
    BatchShape shape;
    std::uint32_t clampedPoints = 2;
    SphereSource spheres = SphereSource::none;
    bool wind = false;
    bool sleep = false;
    bool velocities = false;  ///< are written as well as positions
    bool body = false;        ///< the skin of a body is met
    std::string stages;       ///< of a substep, as calls
    runtime::StrandModel model = runtime::StrandModel::springs;
    std::array<std::uint32_t, 4> own{};  ///< what else the model's kernel is made for, as it numbers them

    /// The file of runtime/shaders that becomes the kernel.
    const char* source() const;
    /// Lines of #define; equal keys have equal ones.
    std::string defines() const;

    friend bool operator==(const KernelKey&, const KernelKey&) = default;
};

/// The kernel of a plan made from these settings. `spheres` in the frame; `body`: there is one that the model
/// meets.
KernelKey keyFor(const runtime::EffectPlan& plan, const runtime::SimulationSettings& settings,
                 const BatchShape& shape, std::size_t spheres, bool velocities, bool body = false);

/// "stageAngularSmallAngle();"
std::string callOf(runtime::StageId stage);

/// Empty, or in words why these settings have no kernels: the linear systems of backward Euler on springs.
std::string kernelError(const runtime::SimulationSettings& settings);

}  // namespace hairloom::gpu_simulation
