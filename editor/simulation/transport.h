// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Takes what the player asks for to where its hair moves: a MovingHair on the player's own thread, or one on
// the render thread, which has the device.

#include <deque>
#include <future>

#include "editor/simulation/played_method.h"
#include "editor/viewport/picture_request.h"
#include "editor/viewport/render_jobs.h"

namespace hairloom::editor {

class Transport {
  public:
    Transport() = default;
    Transport(const Transport&) = delete;
    Transport& operator=(const Transport&) = delete;
    ~Transport() { stop(); }

    /// Errors, also below: as for MovingHair. Nothing moves then.
    Status startHere(const Groom& groom, const MovingStart& start, const PlayedMethod& method);
    Status startThere(std::shared_ptr<RenderJobs> jobs, std::shared_ptr<const Groom> groom,
                      std::shared_ptr<const HeadMotion> motion, const MovingStart& start);
    void stop();
    /// The shape that strands turn to from the next step on. False, and nothing is changed, where the method
    /// has to be made anew for it.
    bool restyle(const Groom& groom) { return here_ && here_->setStyle(groom.positions()); }
    bool isMoving() const { return here_ || there_; }

    /// Advances by `dt` seconds to the head of `pose`, and writes there where strands are. `changed`: the
    /// groom whose settings and spheres count from now on; null: nothing changed. An error ends it; `refused`
    /// is why settings were not taken, which leaves all as it was.
    /// `within`: poses on the way there, at equal shares of dt.
    Status step(float dt, std::shared_ptr<const Groom> changed, std::vector<HeadPose> within, HairPose& pose,
                Status& refused);
    /// Since the start, as far as it is known by now.
    SimulationStats stats() const { return here_ ? here_->stats() : reported_.stats; }
    /// For another engine to go on from. Null where it cannot be had any more.
    std::shared_ptr<const runtime::State> state();

  private:
    /// What has come back of a frame on the render thread.
    struct Reported {
        Status status;
        SimulationStats stats;
        std::vector<Vec3f> positions_ws;
    };

    std::optional<MovingHair> here_;
    std::shared_ptr<RenderJobs> there_;
    std::deque<std::future<Reported>> underWay_;
    Reported reported_;
};

}  // namespace hairloom::editor
