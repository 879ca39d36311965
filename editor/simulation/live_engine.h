// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What moves the hair of the player: the engine on the CPU, or the one on the device that draws it.

#include <memory>

#include "editor/simulation/played_method.h"
#include "editor/viewport/live_link.h"
#include "editor/viewport/picture_request.h"

namespace hairloom::editor {

/// What changes with a frame.
struct LiveChanges {
    std::optional<runtime::SimulationSettings> settings;
    std::optional<std::vector<CollisionSphere>> spheres;
};

class LiveEngine {
  public:
    virtual ~LiveEngine() = default;
    /// Advances by `dt` seconds to the head of `pose`, and writes there where strands are. `time`: seconds at
    /// the end. An error is the end of this engine; `refused` is what of the changes it does not take, and
    /// leaves all as it was.
    virtual Status step(float dt, double time, LiveChanges changes, HairPose& pose, Status& refused) = 0;
    /// Since the start, as far as it is known by now.
    virtual SimulationStats stats() const = 0;
    /// Of a frame where it runs; 0 where the caller's clock tells.
    virtual double milliseconds() const { return 0; }
    /// For another engine to go on from. Null where it cannot be had any more.
    virtual std::shared_ptr<const runtime::State> state() = 0;
};

/// At rest on `start.pose`, or from its state, `time` seconds after the beginning; the settings are the
/// groom's. Errors: as for simulations, and what the device says.
Result<std::unique_ptr<LiveEngine>> makeCpuEngine(const LiveStart& start, double time,
                                                  const PlayedMethod& played);
/// `link` outlives it as far as it has a device.
Result<std::unique_ptr<LiveEngine>> makeDeviceEngine(std::shared_ptr<LiveLink> link, const LiveStart& start);

}  // namespace hairloom::editor
