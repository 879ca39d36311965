// SPDX-License-Identifier: MIT
#include "engine/frame_pieces.h"

#include <algorithm>

#include "engine/checks.h"

namespace hairloom::runtime {
namespace {

Float3 mixed(Float3 from, Float3 to, float share) {
    return from + (to - from) * share;
}

/// One that was none comes in where it is going.
Sphere mixed(const Sphere& from, const Sphere& to, float share) {
    if (!(from.radius > 0.0f)) return to;
    return {mixed(from.center_ws, to.center_ws, share), from.radius + (to.radius - from.radius) * share};
}

BonePose mixed(const BonePose& from, const BonePose& to, float share) {
    return {mixed(from.x, to.x, share), mixed(from.y, to.y, share), mixed(from.z, to.z, share),
            mixed(from.origin, to.origin, share)};
}

}  // namespace

void FramePieces::take(const FrameInput& input, std::uint32_t substeps) {
    input_ = &input;
    substeps_ = substeps;
    const auto all = [&](auto has) { return std::all_of(input.inner.begin(), input.inner.end(), has); };
    posesSpheres_ = all([&](const InnerPose& p) { return p.spheres.size() == input.spheres.size(); });
    posesBody_ = all([&](const InnerPose& p) { return p.body_ws.size() == input.body_ws.size(); });
    ends_.clear();
    ends_.reserve(2 * kMaxInnerPoses + 1);
    spheres_.reserve(input.spheres.size());
    const auto end = [&](std::size_t substep) {
        if (substep > (ends_.empty() ? 0 : ends_.back()))
            ends_.push_back(static_cast<std::uint32_t>(substep));
    };
    for (std::size_t pose = 1; pose <= spans(); ++pose) {
        const std::size_t substepsOfAll = pose * substeps;
        end(substepsOfAll / spans());
        end((substepsOfAll + spans() - 1) / spans());
    }
}

FramePieces::Aim FramePieces::aimOf(std::size_t piece) const {
    // In parts of the frame that both poses and substeps are whole numbers of.
    const std::size_t begin = beginOf(piece) * spans(), end = ends_[piece] * spans();
    const std::size_t to = (end + substeps_ - 1) / substeps_, before = (to - 1) * substeps_;
    const std::size_t from = std::max(begin, before);
    return {begin < before ? to - 1 : 0, to,
            static_cast<float>(end - from) / static_cast<float>(to * substeps_ - from)};
}

FramePieces::Aim FramePieces::straightAimOf(std::size_t piece) const {
    return {0, spans(),
            static_cast<float>(substepsOf(piece)) / static_cast<float>(substeps_ - beginOf(piece))};
}

bool FramePieces::startsWithin(std::size_t piece) const {
    const Aim aim = aimOf(piece);
    return aim.share < 1.0f && aim.from == 0;
}

FrameInput FramePieces::at(std::size_t piece, const PieceStart& start) {
    const FrameInput& whole = *input_;
    FrameInput part = whole;
    part.inner = {};
    part.cut = whole.cut && piece == 0;
    if (count() > 1)
        part.dt = whole.dt * static_cast<float>(substepsOf(piece)) / static_cast<float>(substeps_);
    const double left = static_cast<double>(substeps_ - ends_[piece]) / static_cast<double>(substeps_);
    part.time = whole.time - static_cast<double>(whole.dt) * left;

    // What a cut puts onto the next pose stays there until then.
    const auto held = [&](Aim aim) {
        if (part.cut && aim.from == 0) aim.share = 1.0f;
        return aim;
    };
    const Aim aim = held(aimOf(piece));
    const auto rootsAt = [&](std::size_t pose) {
        return pose < spans() ? whole.inner[pose - 1].roots_ws : whole.roots_ws;
    };
    part.roots_ws = rootsAt(aim.to);
    if (aim.share < 1.0f) {
        const std::span<const RootFrame> from = aim.from > 0 ? rootsAt(aim.from) : start.roots_ws;
        roots_.resize(part.roots_ws.size());
        for (std::size_t s = 0; s < roots_.size(); ++s) {
            RootFrame a = from[s], b = part.roots_ws[s];
            // What is no root stays none.
            roots_[s] = usableWithin(a, kFarthest) && usableWithin(b, kFarthest) ? between(a, b, aim.share)
                                                                                 : part.roots_ws[s];
        }
        part.roots_ws = roots_;
    }
    const auto mix = [&](const auto& from, const auto& to, float share, auto& mixes) {
        mixes.resize(to.size());
        for (std::size_t i = 0; i < to.size(); ++i)
            mixes[i] = i < from.size() ? mixed(from[i], to[i], share) : to[i];
    };
    const auto spheresAt = [&](std::size_t pose) {
        return pose < spans() ? whole.inner[pose - 1].spheres : whole.spheres;
    };
    const Aim ofSpheres = posesSpheres_ ? aim : held(straightAimOf(piece));
    part.spheres = spheresAt(ofSpheres.to);
    if (ofSpheres.share < 1.0f) {
        mix(ofSpheres.from > 0 ? spheresAt(ofSpheres.from) : start.spheres, part.spheres, ofSpheres.share,
            spheres_);
        part.spheres = spheres_;
    }
    const auto bodyAt = [&](std::size_t pose) {
        return pose < spans() ? whole.inner[pose - 1].body_ws : whole.body_ws;
    };
    const Aim ofBody = posesBody_ ? aim : held(straightAimOf(piece));
    part.body_ws = bodyAt(ofBody.to);
    const std::span<const BonePose> bodyFrom = ofBody.from > 0 ? bodyAt(ofBody.from) : start.body_ws;
    if (ofBody.share < 1.0f && bodyFrom.size() == part.body_ws.size()) {
        mix(bodyFrom, part.body_ws, ofBody.share, body_);
        part.body_ws = body_;
    }
    return part;
}

void FramePieces::reserve(std::size_t roots, std::size_t bones) {
    roots_.reserve(roots);
    body_.reserve(bones);
}

std::size_t FramePieces::bytes() const {
    return ends_.size() * sizeof(std::uint32_t) + roots_.size() * sizeof(RootFrame) +
           spheres_.size() * sizeof(Sphere) + body_.size() * sizeof(BonePose);
}

}  // namespace hairloom::runtime
