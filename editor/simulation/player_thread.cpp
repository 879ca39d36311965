// SPDX-License-Identifier: GPL-3.0-or-later
// The thread of the player: it steps the hair, on the engine that was chosen.

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "core/documents/motions.h"
#include "editor/document/words.h"
#include "editor/simulation/player_requests.h"
#include "editor/simulation/transport.h"

namespace hairloom::editor {
namespace {

constexpr double kOnTime = 1e-4;  ///< seconds by which a frame may be early

/// The settings without the effects that are left out.
runtime::SimulationSettings without(runtime::SimulationSettings settings, const QStringList& leftOut) {
    for (const QString& effect : leftOut) turnEffectOff(settings, effect.toStdString());
    return settings;
}

std::vector<CollisionSphere> without(std::vector<CollisionSphere> spheres, const QStringList& leftOut) {
    if (leftOut.contains(QLatin1String(kCollisionEffect.data(), kCollisionEffect.size()))) spheres.clear();
    return spheres;
}

/// Linear in position, spherical in rotation.
Eigen::Isometry3f between(const Eigen::Isometry3f& from, const Eigen::Isometry3f& to, float share) {
    Eigen::Isometry3f mixed = Eigen::Isometry3f::Identity();
    mixed.linear() = Quatf(from.linear()).slerp(share, Quatf(to.linear())).normalized().toRotationMatrix();
    mixed.translation() = from.translation() + share * (to.translation() - from.translation());
    return mixed;
}

/// The groom with these settings, without the effects that are left out.
Groom without(Groom groom, const runtime::SimulationSettings& settings, const QStringList& leftOut) {
    groom.simulation = without(settings, leftOut);
    groom.spheres = without(std::move(groom.spheres), leftOut);
    if (leavesBodyOut(leftOut)) groom.body.reset();
    if (leavesPosesOut(leftOut)) {
        for (GroomPose& pose : groom.poses) pose.amount = 0;
    }
    return groom;
}

}  // namespace

/// What the thread has of its own.
struct Player::Playing {
    Transport transport;
    EngineChoice choice;
    bool deviceFailed = false;  ///< until another wish
    std::shared_ptr<const Groom> groom;
    std::shared_ptr<HeadMotion> motion;
    std::shared_ptr<const HairPose> before;
    FramePace pace;
    double from = 0;                    ///< seconds of the motion, where frames are counted from
    std::uint64_t frame = 0;            ///< since there
    runtime::SimulationSettings given;  ///< that hair has, but for what is left out
    HeadPose last;                      ///< of the motion, where the last step ended
    Eigen::Isometry3f offset = Eigen::Isometry3f::Identity();  ///< by which it was dragged there

    double time(std::uint32_t step) const {
        return from + static_cast<double>(pace.timeOf(static_cast<float>(frame), step));
    }
    double time() const { return time(pace.steps()); }
    /// Counts from now on by another frame rate.
    void takePace(const FramePace& taken) {
        if (taken.framesPerSecond != pace.framesPerSecond) {
            from = time();
            frame = 0;
        }
        pace = taken;
    }
    /// The groom's settings with what is keyed at `time`.
    runtime::SimulationSettings settingsAt(double time) const {
        return motion->settingsAt(static_cast<float>(time), groom->simulation).value_or(groom->simulation);
    }
    HeadPose startAt(double time, const WorkerRequests& taken) {
        last = motion->poseAt(static_cast<float>(time));
        offset = taken.offset;
        return placed(last, taken, offset);
    }
    /// To the end of that step of the frame. A head that is dragged goes along within it.
    HeadStep stepTo(std::uint32_t step, const WorkerRequests& taken) {
        const double end = time(step), begin = end - static_cast<double>(pace.dt());
        HeadStep head = stepOf(*motion, last, static_cast<float>(begin), static_cast<float>(end));
        last = head.end;
        const float parts = static_cast<float>(head.within.size() + 1);
        for (std::size_t i = 0; i < head.within.size(); ++i) {
            const float share = static_cast<float>(i + 1) / parts;
            head.within[i] = placed(std::move(head.within[i]), taken, between(offset, taken.offset, share));
        }
        offset = taken.offset;
        head.end = placed(std::move(head.end), taken, offset);
        return head;
    }
    static HeadPose placed(HeadPose pose, const WorkerRequests& taken, const Eigen::Isometry3f& dragged) {
        moveBy(dragged, pose);
        if (taken.leftOut.contains("wind")) pose.wind_ws.reset();
        if (leavesPosesOut(taken.leftOut)) pose.poseAmounts.clear();
        return pose;
    }

    void reset() {
        transport.stop();
        groom.reset();
        motion.reset();
        before.reset();
        deviceFailed = false;
        from = 0;
        frame = 0;
    }
};

void Player::refuse(const Error& error) {
    QMetaObject::invokeMethod(this, [this, words = QString::fromStdString(error.message())] {
        pause();
        Q_EMIT failed(words);
    });
}

void Player::setEngineShown(const EngineChoice& choice) {
    QMetaObject::invokeMethod(this, [this, choice] {
        if (engine_ == choice) return;
        engine_ = choice;
        Q_EMIT engineChanged();
    });
}

bool Player::prepare(Playing& playing, WorkerRequests& taken) {
    if (taken.wishChanged) playing.deviceFailed = false;
    const bool begins = taken.restart || !playing.transport.isMoving();
    if (taken.restyled && !begins && !taken.regroomed && !taken.wishChanged && playing.groom)
        taken.regroomed = !playing.transport.restyle(*playing.groom);
    if (!begins && !taken.regroomed && !taken.wishChanged) return true;
    MovingStart start;
    if (begins) {
        playing.transport.stop();
        playing.before.reset();
        playing.pace = taken.pace;
        // The frame that is shown first is the one that was sought.
        playing.from = std::max(0.0, taken.from - 1 / static_cast<double>(taken.pace.framesPerSecond));
        playing.frame = 0;
    } else {
        start.state = playing.transport.state();
    }
    if (!playing.groom || !playing.motion) return false;
    playing.given = playing.settingsAt(playing.time());
    const auto tried = std::make_shared<const Groom>(without(*playing.groom, playing.given, taken.leftOut));
    start.pose = playing.startAt(playing.time(), taken);
    start.time = playing.time();
    taken.changed = false;  // it begins with what has changed

    EngineChoice choice{EngineKind::cpu, "selected in the preferences"};
    if (playing.deviceFailed) {
        choice = playing.choice;
    } else if (const std::string why = taken.method.whyCpu(); !why.empty()) {
        choice.why = why;
    } else if (taken.wish != EngineWish::cpu) {
        choice = taken.jobs
                     ->post([&](PlayedHair* played) {
                         return played ? played->choose(taken.wish, *tried)
                                       : EngineChoice{EngineKind::cpu, "there is no graphics device"};
                     })
                     .get();
    }
    // The other engine goes first: the device has room for one hairstyle more.
    playing.transport.stop();
    if (choice.kind == EngineKind::gpu) {
        const auto made = playing.transport.startThere(taken.jobs, tried, playing.motion, start);
        if (!made) choice = {EngineKind::cpu, made.error().message()};
    }
    if (!playing.transport.isMoving()) {
        if (auto made = playing.transport.startHere(*tried, start, taken.method); !made) {
            refuse(made.error());
            return false;
        }
    }
    playing.choice = choice;
    setEngineShown(choice);
    if (begins) settle(playing, start.pose);
    return true;
}

void Player::settle(Playing& playing, const HeadPose& first) {
    HairPose pose;
    pose.head = first;
    Status refused;
    for (std::uint64_t step = 0; step < playing.pace.preRoll * playing.pace.steps(); ++step) {
        {
            const std::lock_guard lock(mutex_);
            if (requests_->stop || requests_->restart) return;
        }
        // What fails here fails in the next frame as well, which says so.
        if (!playing.transport.step(playing.pace.dt(), nullptr, {}, pose, refused)) return;
    }
}

Status Player::stepFrame(Playing& playing, WorkerRequests& taken, HairPose& pose, Status& refused) {
    const std::uint32_t steps = playing.pace.steps();
    ++playing.frame;
    for (std::uint32_t step = 1; step <= steps; ++step) {
        const double time = playing.time(step);
        const runtime::SimulationSettings settings = playing.settingsAt(time);
        std::shared_ptr<const Groom> changed;
        if (std::exchange(taken.changed, false) || settings != playing.given)
            changed = std::make_shared<const Groom>(without(*playing.groom, settings, taken.leftOut));
        playing.given = settings;
        HeadStep head = playing.stepTo(step, taken);
        pose.head = std::move(head.end);
        auto stepped = playing.transport.step(playing.pace.dt(), std::move(changed), std::move(head.within),
                                              pose, refused);
        if (!stepped) return stepped;
    }
    return {};
}

void Player::advance(Playing& playing, WorkerRequests& taken) {
    const auto begin = std::chrono::steady_clock::now();
    playing.takePace(taken.pace);
    const double before = playing.time();
    auto pose = std::make_shared<HairPose>();
    Status refused;
    auto stepped = stepFrame(playing, taken, *pose, refused);
    if (!stepped && playing.choice.kind == EngineKind::gpu) {
        // A device that was lost takes the motion of the hair along, and nothing else.
        playing.deviceFailed = true;
        playing.choice = {EngineKind::cpu, "the device failed: " + stepped.error().message()};
        WorkerRequests again = taken;
        again.regroomed = true;
        Q_EMIT failed(
            QString("The GPU stopped simulating (%1). The CPU continues").arg(errorText(stepped.error())));
        if (!prepare(playing, again)) return;
        stepped = playing.transport.step(playing.pace.dt(), nullptr, {}, *pose, refused);
    }
    if (!stepped) refused = stepped;
    if (!refused) refuse(refused.error());
    // Frames of the time line alone are kept.
    if (taken.cache && taken.line) pose->lineTime = taken.line->timeAt(static_cast<float>(playing.time()));
    auto frame = std::make_shared<PlayedFrame>();
    // An engine that has just begun may have no positions yet, and the hair other points than before.
    if (const auto last = std::exchange(playing.before, pose);
        last && last->positions_ws.size() == pose->positions_ws.size()) {
        frame->before = last;
    }
    if (taken.recorder && stepped && !pose->onDevice) taken.recorder->add(pose->positions_ws, pose->head);
    if (taken.cache && stepped && !pose->onDevice && taken.offset.isApprox(Eigen::Isometry3f::Identity()))
        taken.cache->add(playing.time(), pose);
    frame->pose = std::move(pose);
    frame->time = playing.time();
    const double clock =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    frame->stats = playing.transport.stats();
    const bool onDevice = frame->pose->onDevice && frame->stats.millisecondsPerFrame > 0;
    frame->milliseconds = onDevice ? frame->stats.millisecondsPerFrame : clock;
    deliver(std::move(frame), taken.epoch);
    if (!taken.playing || before >= taken.stopAt - kOnTime || playing.time() < taken.stopAt - kOnTime) return;
    // At once: a window that is busy would let frames beyond the end play.
    request([&](WorkerRequests& requests) {
        if (requests.epoch == taken.epoch) requests.playing = false;
    });
    QMetaObject::invokeMethod(this, [this, epoch = taken.epoch] {
        if (epoch == epoch_) pause();
    });
}

void Player::run() {
    Playing playing;
    auto due = std::chrono::steady_clock::now();
    while (true) {
        WorkerRequests taken;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] {
                const bool letGo = requests_->restart && playing.transport.isMoving();
                return requests_->stop || requests_->playing || requests_->steps > 0 || letGo ||
                       requests_->planPreview;
            });
            if (requests_->steps == 0 && requests_->playing) {
                wake_.wait_until(lock, due, [this] { return requests_->stop; });
            }
            if (requests_->stop) return;
            if (requests_->planPreview) {
                const auto planPreview = std::exchange(requests_->planPreview, nullptr);
                const QStringList leftOut = requests_->leftOut;
                lock.unlock();
                computePlanPreview(*planPreview, leftOut);
                continue;
            }
            if (!requests_->playing && requests_->steps == 0) {
                if (requests_->restart) playing.reset();
                continue;
            }
            if (requests_->steps > 0) --requests_->steps;
            taken = *requests_;
            requests_->restart = requests_->regroomed = requests_->restyled = requests_->wishChanged =
                requests_->changed = false;
        }
        due = std::chrono::steady_clock::now() +
              std::chrono::microseconds(std::llround(1e6f / taken.pace.framesPerSecond));
        playing.groom = taken.groom;
        playing.motion = taken.motion;
        if (prepare(playing, taken)) {
            advance(playing, taken);
        } else if (playing.groom && playing.motion) {
            request([](WorkerRequests& requests) { requests.playing = false; });
        }
    }
}

void Player::deliver(std::shared_ptr<const PlayedFrame> frame, quint64 epoch) {
    bool isFirst = false;
    {
        const std::lock_guard lock(mutex_);
        if (epoch != requests_->epoch) return;
        isFirst = !requests_->delivered;
        requests_->delivered = std::move(frame);
    }
    // One message under way is enough: it takes the newest frame.
    if (!isFirst) return;
    QMetaObject::invokeMethod(this, [this] {
        std::shared_ptr<const PlayedFrame> newest;
        {
            const std::lock_guard lock(mutex_);
            newest = std::exchange(requests_->delivered, nullptr);
        }
        if (!newest) return;
        frame_ = std::move(newest);
        Q_EMIT frameReady();
    });
}

void Player::computePlanPreview(const Groom& groom, const QStringList& leftOut) {
    const Groom tried = without(groom, groom.simulation, leftOut);
    const auto motion = makeRigidMotion("none", tried);
    if (!motion) return;
    const auto made = Simulation::make(tried, (*motion)->poseAt(0), {});
    if (!made) return;
    QMetaObject::invokeMethod(this, [this, effects = made->stats().effects] {
        planPreview_ = effects;
        Q_EMIT planPreviewChanged();
    });
}

}  // namespace hairloom::editor
