// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Simulating from a frame that was recorded.

#include <memory>
#include <span>

#include "core/simulation/frame_record.h"
#include "core/simulation/simulation.h"

namespace hairloom {

/// States of the strand engine (Simulation::state()) from recorded frames of a groom. A record has neither
/// twist nor what joints remember, so a simulation that is to continue from a frame leads in: it starts some
/// frames earlier and is pulled to each frame up to that one.
class RecordedStates {
  public:
    /// Errors: those of SceneInput::make() and of the engine.
    static Result<RecordedStates> make(const Groom& groom);
    RecordedStates(RecordedStates&&) noexcept;
    RecordedStates& operator=(RecordedStates&&) noexcept;
    ~RecordedStates();

    /// Hair as it is in a frame, as fast as from `before` to `after`, which are `seconds` > 0 apart and of
    /// which one may be the frame itself; with twist as at rest. Errors: frames of other points.
    Result<std::shared_ptr<const runtime::State>> at(const RecordedFrame& frame, const RecordedFrame& before,
                                                     const RecordedFrame& after, float seconds);
    /// The state of that simulation with points sped up so that they would reach within `seconds` where they
    /// should be now. Positions are metres, world. Null where it knows no state.
    std::shared_ptr<const runtime::State> pulled(const Simulation& simulation,
                                                 std::span<const Vec3f> wanted_ws, float seconds);

  private:
    struct Impl;
    explicit RecordedStates(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom
