// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/transport.h"

#include <chrono>

#include "core/groom/poses.h"

namespace hairloom::editor {
namespace {

template <class Value>
bool isDone(const std::future<Value>& value) {
    return value.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// `next`: where the step that follows ends. Amounts that it has come with it.
Status take(MovingHair& hair, const Groom& changed, const HeadPose& next) {
    hair.setColliders(changed.spheres);
    if (auto set = hair.setSettings(changed.simulation); !set) return set;
    return next.poseAmounts.empty() ? hair.setPoseAmounts(poseAmounts(changed)) : Status();
}

}  // namespace

Status Transport::startHere(const Groom& groom, const MovingStart& start, const PlayedMethod& method) {
    stop();
    SimulationOptions options;
    options.method = method.method;
    MovingStart from = start;
    if (method.method != SimulationMethod::strands) from.state.reset();
    auto made = MovingHair::onCpu(groom, from, options);
    if (!made) return tl::unexpected(made.error());
    here_.emplace(std::move(*made));
    return {};
}

Status Transport::startThere(std::shared_ptr<RenderJobs> jobs, std::shared_ptr<const Groom> groom,
                             std::shared_ptr<const HeadMotion> motion, const MovingStart& start) {
    stop();
    auto made = jobs->post([groom = std::move(groom), motion = std::move(motion), start](PlayedHair* played) {
        return played ? played->start(groom, motion->skin(), start)
                      : Status(fail("there is no graphics device"));
    });
    if (auto status = made.get(); !status) return status;
    there_ = std::move(jobs);
    reported_ = {};
    return {};
}

void Transport::stop() {
    here_.reset();
    underWay_.clear();
    if (!there_) return;
    there_->post([](PlayedHair* played) {
        if (played) played->stop();
    });
    there_.reset();
}

Status Transport::step(float dt, std::shared_ptr<const Groom> changed, std::vector<HeadPose> within,
                       HairPose& pose, Status& refused) {
    const HeadStep head{pose.head, std::move(within)};
    if (here_) {
        if (changed) refused = take(*here_, *changed, head.end);
        const Status stepped = here_->step(dt, head);
        const auto points = here_->positions_ws();
        pose.positions_ws.assign(points.begin(), points.end());
        pose.velocities_ws = here_->velocities_ws();
        return stepped;
    }
    underWay_.push_back(there_->post([dt, changed = std::move(changed), head,
                                      wanted = there_->wantsPositions()](PlayedHair* played) -> Reported {
        MovingHair* const hair = played ? played->hair() : nullptr;
        if (!hair) return {fail("the device was lost"), {}, {}};
        if (changed) {
            if (auto taken = take(*hair, *changed, head.end); !taken) return {std::move(taken), {}, {}};
        }
        hair->setReadsPositions(wanted);
        if (auto stepped = hair->step(dt, head); !stepped) return {std::move(stepped), {}, {}};
        const auto points = hair->positions_ws();
        return {{}, hair->stats(), {points.begin(), points.end()}};
    }));
    // The render thread draws one frame while the next one comes.
    while (underWay_.size() > 1 || isDone(underWay_.front())) {
        reported_ = underWay_.front().get();
        underWay_.pop_front();
        if (!reported_.status) return reported_.status;
        if (underWay_.empty()) break;
    }
    pose.onDevice = true;
    pose.positions_ws = reported_.positions_ws;
    return {};
}

std::shared_ptr<const runtime::State> Transport::state() {
    using State = Result<std::shared_ptr<const runtime::State>>;
    State state;
    if (here_) state = here_->state();
    if (there_) {
        state = there_
                    ->post([](PlayedHair* played) -> State {
                        if (!played || !played->hair()) return fail("the device was lost");
                        return played->hair()->state();
                    })
                    .get();
    }
    return state ? *state : nullptr;
}

}  // namespace hairloom::editor
