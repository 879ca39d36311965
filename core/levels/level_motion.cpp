// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/level_motion.h"

#include <algorithm>
#include <limits>

#include "core/geometry/curve.h"
#include "core/groom/strand_subset.h"
#include "core/levels/spring_fit.h"
#include "core/simulation/simulation.h"

namespace hairloom {
namespace {

constexpr int kEvery = 5;  // frames, of which one is looked at
constexpr std::size_t kMostStrands = 400;

/// Points of some strands, at rest and frame by frame.
struct Moved {
    std::vector<Eigen::Isometry3f> heads_ws;           ///< of all frames, from rest
    std::vector<Eigen::Isometry3f> headsOfSprings_ws;  ///< likewise, at the rate of the springs
    std::vector<Vec3f> rest_ws;                        ///< kStations a strand
    std::vector<int> frames;                           ///< that are looked at
    std::vector<std::vector<Vec3f>> points_ws;
};

Result<Moved> nodOf(const Groom& groom, float springHz, cards::Cancel cancel) {
    std::vector<std::uint32_t> strands;
    const std::size_t step =
        std::max<std::size_t>(1, (groom.strandCount() + kMostStrands - 1) / kMostStrands);
    for (std::size_t s = 0; s < groom.strandCount(); s += step)
        if (polylineLength(groom.strand(s)) > 0) strands.push_back(static_cast<std::uint32_t>(s));
    const Groom some = strandsOf(groom, strands);
    const auto moving = makeRigidMotion(kFitMotion, groom);
    if (!moving) return tl::unexpected(moving.error());
    auto simulation = Simulation::make(some, (*moving)->poseAt(0));
    if (!simulation) return tl::unexpected(simulation.error());
    std::vector<std::vector<PolylinePlace>> places;
    for (std::size_t s = 0; s < some.strandCount(); ++s)
        places.push_back(evenPlaces(some.strand(s), cards::kStations));
    const auto pointsOf = [&](std::span<const Vec3f> positions) {
        std::vector<Vec3f> points;
        for (std::size_t s = 0; s < places.size(); ++s) {
            for (const PolylinePlace& place : places[s]) {
                const std::size_t first = some.offsets[s] + place.segment;
                points.push_back((1 - place.t) * positions[first] + place.t * positions[first + 1]);
            }
        }
        return points;
    };
    Moved moved;
    moved.rest_ws = pointsOf(some.positions());
    for (int frame = 0; frame <= kFitFrames; ++frame) {
        if (cards::cancelled(cancel)) return cards::stopped();
        const HeadPose pose = (*moving)->poseAt(kFitFrameSeconds * static_cast<float>(frame));
        moved.heads_ws.push_back(pose.head_ws);
        if (frame == 0) continue;
        simulation->step(kFitFrameSeconds, pose);
        if (frame % kEvery != 0) continue;
        moved.frames.push_back(frame);
        moved.points_ws.push_back(pointsOf(simulation->positions_ws()));
    }
    for (int f = 0; static_cast<float>(f) <= kFitFrames * kFitFrameSeconds * springHz + 1; ++f)
        moved.headsOfSprings_ws.push_back((*moving)->poseAt(static_cast<float>(f) / springHz).head_ws);
    return moved;
}

/// Joints of a chain at a frame, between updates of springs as seen from the head.
std::vector<Vec3f> jointsAt(const Moved& moved, const std::vector<std::vector<Vec3f>>& updates,
                            float springHz, std::size_t frame) {
    const float at = static_cast<float>(frame) * kFitFrameSeconds * springHz;
    const std::size_t k = std::min(static_cast<std::size_t>(at + 1e-3f), updates.size() - 2);
    const float t = std::clamp(at - static_cast<float>(k), 0.0f, 1.0f);
    const Eigen::Isometry3f before = moved.headsOfSprings_ws[k].inverse(),
                            after = moved.headsOfSprings_ws[k + 1].inverse();
    std::vector<Vec3f> joints;
    for (std::size_t j = 0; j < updates[k].size(); ++j)
        joints.push_back(moved.heads_ws[frame] *
                         Vec3f((1 - t) * (before * updates[k][j]) + t * (after * updates[k + 1][j])));
    return joints;
}

/// The points as vertices of the cards that they lie on, so that these move them.
cards::Cards onCards(const cards::Cards& made, std::span<const Vec3f> points_ws) {
    cards::Cards held;
    held.cards = made.cards;
    for (std::size_t first = 0; first < points_ws.size(); first += cards::kStations) {
        const auto strand = points_ws.subspan(first, cards::kStations);
        std::uint32_t own = 0;
        float nearest = std::numeric_limits<float>::infinity();
        for (std::uint32_t c = 0; c < made.cards.size(); ++c) {
            if (made.cards[c].deleted) continue;
            const float off = cards::offStrip(made.cards[c].strip, strand, nearest);
            if (off < nearest) nearest = off, own = c;
        }
        const auto places = cards::placesOn(made.cards[own].strip, strand);
        for (std::size_t p = 0; p < strand.size(); ++p) {
            held.mesh.vertices.push_back({.position_ws = strand[p],
                                          .normal_ws = Vec3f::UnitY(),
                                          .along_ws = Vec3f::UnitX(),
                                          .uv = Vec2f::Zero(),
                                          .place = Vec2f::Zero(),
                                          .hangs = std::clamp(places[p].along, 0.0f, 1.0f),
                                          .card = own});
        }
    }
    return held;
}

/// Mean over directions of how far such a way is seen, times its length: metres.
double seenLength(const Vec3f& way, const std::vector<cards::View>& views) {
    double sum = 0;
    for (const cards::View& view : views) {
        const float towards = way.dot(view.toEye_ws);
        sum += static_cast<double>(std::sqrt(std::max(0.0f, way.squaredNorm() - towards * towards)));
    }
    return sum / static_cast<double>(views.size());
}

}  // namespace

Status measureMotion(const Groom& groom, cards::Chain& chain, cards::Cancel cancel) {
    const auto isMeasured = [](const cards::Level& level) { return level.measures.has_value(); };
    if (std::ranges::none_of(chain.levels, isMeasured)) return {};
    const float springHz = chain.springFit ? chain.springFit->hz : cards::kSpringHz;
    const auto moved = nodOf(groom, springHz, cancel);
    if (!moved) return tl::unexpected(moved.error());
    const std::vector<cards::Collider> colliders = collidersOf(groom);
    std::vector<std::vector<std::vector<Vec3f>>> joints;  // by chains and frames
    for (std::size_t c = 0; c < chain.rig.chains(); ++c)
        joints.push_back(cards::swing(chain.rig, c, chain.springs[c], moved->headsOfSprings_ws,
                                      cards::collidersMetBy(chain.rig, c, colliders), springHz));
    for (cards::Level& level : chain.levels) {
        if (!level.measures) continue;
        if (level.spec.kind == cards::LevelKind::strands) {
            level.measures->motionPx = 0;
            continue;
        }
        if (cards::cancelled(cancel)) return cards::stopped();
        cards::Cards held;
        cards::Binding binding;
        if (const auto* made = std::get_if<cards::Cards>(&level.content)) {
            held = onCards(*made, moved->rest_ws);
            binding = cards::bind(chain.rig, held);
        }
        double sum = 0;
        std::size_t count = 0;
        std::vector<Vec3f> points(moved->rest_ws.size());
        for (std::size_t f = 0; f < moved->frames.size(); ++f) {
            const auto frame = static_cast<std::size_t>(moved->frames[f]);
            const Eigen::Isometry3f& head = moved->heads_ws[frame];
            if (binding.joints.empty()) {
                for (std::size_t p = 0; p < points.size(); ++p) points[p] = head * moved->rest_ws[p];
            } else {
                std::vector<std::vector<Vec3f>> now;
                for (const auto& updates : joints) now.push_back(jointsAt(*moved, updates, springHz, frame));
                cards::skin(binding, held.mesh, cards::jointMotions(chain.rig, head, now), points);
            }
            for (std::size_t p = 0; p < points.size(); ++p, ++count)
                sum += seenLength(moved->points_ws[f][p] - points[p], chain.views);
        }
        if (count > 0)
            level.measures->motionPx =
                1000 * sum / static_cast<double>(count) / cards::pixelMillimetres(level.spec.headPx);
    }
    return {};
}

}  // namespace hairloom
