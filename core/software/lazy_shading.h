// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light of curve points, and what they see of the sky, worked out for those that are asked for: most hair is
// behind other hair.

#include <memory>

#include "core/gpu/device.h"
#include "core/software/kernel.h"
#include "core/software/stop.h"
#include "shaders/shared/render_types.h"

namespace hairloom::software {

/// What a dispatch would do, with all that it uses.
struct DeferredDispatch {
    const KernelEntry* kernel = nullptr;
    Registers registers;
    std::vector<gpu::Binding> kept;
    Stop stop;  ///< what is left out then is done when it is asked for again
};

/// A dispatch of sky_seen.comp: a thread for each point that a strand was given with.
class LazySky {
  public:
    LazySky(DeferredDispatch work, std::uint32_t strands);
    /// Those that the curve points lie between. `points`: numbers of curve points.
    void ensure(std::span<const std::uint32_t> points, std::span<const shaders::CurvePoint> curve,
                std::span<const shaders::StrandHeader> strands, std::uint32_t subdivisions);
    void ensureAll();

  private:
    void run(std::span<const std::uint32_t> threads);

    DeferredDispatch work_;
    std::vector<std::uint8_t> done_;  ///< HAIRLOOM_SKY_THREADS_OF_STRAND a strand
};

/// A dispatch of one of the shaders that shade curve points, a thread each.
class LazyShading {
  public:
    /// `sky`: what its points see, or nothing. `before`: of the same points, what it goes on from, or
    /// nothing.
    LazyShading(DeferredDispatch work, std::shared_ptr<LazySky> sky,
                std::shared_ptr<LazyShading> before = {});
    std::uint32_t count() const { return static_cast<std::uint32_t>(done_.size()); }
    /// `wanted`: 1 for each point whose light is needed.
    void ensure(std::span<const std::uint8_t> wanted);
    void ensureAll();

  private:
    const shaders::ShadeConstants& constants() const {
        return *reinterpret_cast<const shaders::ShadeConstants*>(work_.registers.constants[0]);
    }
    void run(std::span<const std::uint32_t> points);

    DeferredDispatch work_;
    std::shared_ptr<LazySky> sky_;
    std::shared_ptr<LazyShading> before_;
    std::vector<std::uint8_t> done_;
};

}  // namespace hairloom::software
