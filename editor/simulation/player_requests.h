// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Between the two sides of the player: the interface (player.cpp) asks, the thread (player_thread.cpp) takes.

#include <limits>
#include <memory>
#include <vector>

#include "core/simulation/effect_switch.h"
#include "core/simulation/time_line_motion.h"
#include "editor/simulation/player.h"

namespace hairloom::editor {

inline bool leavesBodyOut(const QStringList& leftOut) {
    return leftOut.contains(QLatin1String(kBodyEffect.data(), kBodyEffect.size()));
}

inline bool leavesPosesOut(const QStringList& leftOut) {
    return leftOut.contains(QLatin1String(kPoseEffect.data(), kPoseEffect.size()));
}

/// What the interface has asked of the thread and it has not taken up yet.
struct Player::WorkerRequests {
    bool stop = false;
    bool playing = false;
    int steps = 0;
    bool restart = true;     ///< simulation and motion are made anew from `groom`
    bool regroomed = false;  ///< the strands of `groom` stand elsewhere or are others in looks; they go on
    bool restyled = false;   ///< likewise, and the method may turn them there
    std::shared_ptr<RenderJobs> jobs;
    EngineWish wish = EngineWish::cpu;
    bool wishChanged = false;
    PlayedMethod method;
    std::shared_ptr<const Groom> groom;  ///< as the document has it
    bool changed = false;                ///< settings or spheres of `groom`, or what is left out of them
    std::shared_ptr<HeadMotion> motion;
    FramePace pace;
    std::shared_ptr<const TimeLine> line;  ///< of the motion, as the document has it; null: another motion
    double from = 0;                       ///< seconds of the motion, of the next start
    double stopAt = std::numeric_limits<double>::infinity();  ///< seconds of the motion, where playing ends
    Eigen::Isometry3f offset = Eigen::Isometry3f::Identity();
    QStringList leftOut;
    std::shared_ptr<TakeRecorder> recorder;
    std::shared_ptr<FrameCache> cache;
    std::shared_ptr<const Groom> planPreview;  ///< whose plan is asked for
    quint64 epoch = 0;
    std::shared_ptr<const PlayedFrame> delivered;  ///< waits for the interface
};

}  // namespace hairloom::editor
