// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/springs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"

namespace hairloom::cards {
namespace {

/// How much joints at rest count at 60 updates per second, each as if it were off for so many updates.
constexpr double kRestUpdates = 1000;

/// The bones of a chain, from joint to joint, as VRMC_springBone 1.0 moves them.
class SwingingChain {
  public:
    SwingingChain(const Rig& rig, std::size_t chain, const Spring& spring,
                  std::span<const Collider> colliders, float hz)
        : step_(1 / hz), spring_(spring), colliders_(colliders) {
        for (std::uint32_t j = 0; j < rig.perChain; ++j)
            rest_.push_back(rig.joints[1 + chain * rig.perChain + j].position_ws);
        tails_.assign(rest_.begin() + 1, rest_.end());
        before_ = tails_;
    }
    void step(const Eigen::Isometry3f& head_ws) {
        Quatf parent(head_ws.linear());
        Vec3f at = head_ws * rest_[0];
        const auto joints = static_cast<std::uint32_t>(rest_.size());
        for (std::uint32_t j = 0; j + 1 < joints; ++j) {
            const Vec3f bone = rest_[j + 1] - rest_[j];
            const float length = bone.norm();
            if (!(length > 0)) continue;
            const Vec3f axis = parent * (bone / length);
            Vec3f next = tails_[j] + (1 - spring_.drag) * (tails_[j] - before_[j]);
            next += step_ * spring_.stiffnessAt(j, joints) * axis - step_ * spring_.gravity * Vec3f::UnitY();
            next = at + length * directionTo(next, at, axis);
            for (const Collider& collider : colliders_) {
                const Vec3f centre = head_ws * collider.centre_ws;
                const float apart = collider.radius + spring_.hitRadius;
                const Vec3f away = next - centre;
                const float distance = away.norm();
                if (distance >= apart || !(distance > 0)) continue;
                next = at + length * directionTo(centre + away * (apart / distance), at, axis);
            }
            before_[j] = tails_[j], tails_[j] = next;
            parent = shortestArc(axis, (next - at).normalized()) * parent;
            at = next;
        }
    }
    /// All joints but the first.
    std::span<const Vec3f> tails() const { return tails_; }
    std::vector<Vec3f> joints(const Eigen::Isometry3f& head_ws) const {
        std::vector<Vec3f> all{head_ws * rest_[0]};
        all.insert(all.end(), tails_.begin(), tails_.end());
        return all;
    }

  private:
    static Vec3f directionTo(const Vec3f& to, const Vec3f& from, const Vec3f& otherwise) {
        const Vec3f way = to - from;
        const float length = way.norm();
        return length > 0 ? Vec3f(way / length) : otherwise;
    }
    float step_;  ///< seconds
    Spring spring_;
    std::span<const Collider> colliders_;
    std::vector<Vec3f> rest_, tails_, before_;
};

/// The joints of a chain but its first, where they stay under a still head: each bone points where stiffness
/// and gravity together pull it.
std::vector<Vec3f> settled(const Rig& rig, std::size_t chain, const Spring& spring) {
    std::vector<Vec3f> tails;
    const Joint* const joints = &rig.joints[1 + chain * rig.perChain];
    Quatf parent = Quatf::Identity();
    Vec3f at = joints[0].position_ws;
    for (std::uint32_t j = 0; j + 1 < rig.perChain; ++j) {
        const Vec3f bone = joints[j + 1].position_ws - joints[j].position_ws;
        const float length = bone.norm();
        if (length > 0) {
            const Vec3f axis = parent * (bone / length);
            const Vec3f pull = spring.stiffnessAt(j, rig.perChain) * axis - spring.gravity * Vec3f::UnitY();
            const Vec3f way = pull.norm() > 0 ? pull.normalized() : axis;
            parent = shortestArc(axis, way) * parent;
            at += length * way;
        }
        tails.push_back(at);
    }
    return tails;
}

/// Of joints that touch none of these at rest.
float hitRadiusOf(const Rig& rig, std::size_t chain, std::span<const Collider> colliders) {
    float radius = Spring().hitRadius;
    for (const Collider& collider : colliders) {
        for (std::uint32_t j = 1; j < rig.perChain; ++j) {
            const Vec3f away = rig.joints[1 + chain * rig.perChain + j].position_ws - collider.centre_ws;
            radius = std::min(radius, away.norm() - collider.radius);
        }
    }
    return std::max(radius, 0.0f);
}

/// Sum of squares, m².
double squaresOff(const Rig& rig, std::size_t chain, const Spring& spring, const ChainMotion& wanted,
                  std::span<const Collider> colliders) {
    SwingingChain swinging(rig, chain, spring, colliders, wanted.hz);
    double sum = 0;
    for (std::size_t f = 1; f < wanted.heads_ws.size(); ++f) {
        swinging.step(wanted.heads_ws[f]);
        const std::span tails = swinging.tails();
        for (std::size_t j = 0; j < tails.size(); ++j) {
            const Vec3f& at = wanted.joints_ws[f][chain * rig.perChain + j + 1];
            sum += static_cast<double>((tails[j] - at).squaredNorm());
        }
    }
    const std::vector<Vec3f> resting = settled(rig, chain, spring);
    for (std::size_t j = 0; j < resting.size(); ++j) {
        const Vec3f& at = rig.joints[2 + chain * rig.perChain + j].position_ws;
        sum += kRestUpdates * (static_cast<double>(wanted.hz) / 60) *
               static_cast<double>((resting[j] - at).squaredNorm());
    }
    return sum;
}

// What is searched: stiffness at the first and at the last bone and gravity by their square roots, which
// makes small ones as easy to find as large ones, and drag.
using Point = std::array<float, 4>;
constexpr Point kLow{0.02f, 0.02f, 0.0f, 0.0f}, kHigh{2.5f, 2.5f, 1.0f, 1.5f};

Spring springOf(const Point& p) {
    Spring spring;
    spring.stiffness = p[0] * p[0], spring.tipStiffness = p[1] * p[1];
    spring.drag = p[2], spring.gravity = p[3] * p[3];
    return spring;
}

/// Steps along each axis and on in the direction that those led in, halved where none leads down (Hooke and
/// Jeeves 1961).
Spring fitted(const Rig& rig, std::size_t chain, const ChainMotion& wanted,
              std::span<const Collider> colliders) {
    const float hitRadius = hitRadiusOf(rig, chain, colliders);
    const auto springAt = [&](const Point& p) {
        Spring spring = springOf(p);
        spring.hitRadius = hitRadius;
        return spring;
    };
    const auto errorOf = [&](const Point& p) {
        return squaresOff(rig, chain, springAt(p), wanted, colliders);
    };
    constexpr std::array<Point, 3> kStarts{
        {{0.77f, 0.77f, 0.4f, 0.45f}, {0.3f, 0.2f, 0.1f, 0.3f}, {1.5f, 1.2f, 0.7f, 0.1f}}};
    Point best = kStarts[0];
    double least = errorOf(best);
    for (const Point& start : kStarts) {
        Point at = start;
        double error = errorOf(at);
        const auto moveTo = [&](Point tried) {
            for (std::size_t axis = 0; axis < tried.size(); ++axis)
                tried[axis] = std::clamp(tried[axis], kLow[axis], kHigh[axis]);
            const double found = errorOf(tried);
            if (found < error) at = tried, error = found;
        };
        constexpr float kFirstStep = 0.3f, kLastStep = 0.002f;
        for (float step = kFirstStep; step > kLastStep;) {
            const Point before = at;
            for (std::size_t axis = 0; axis < at.size(); ++axis) {
                for (const float way : {step, -step}) {
                    Point tried = at;
                    tried[axis] += way;
                    moveTo(tried);
                }
            }
            Point onward = at;
            for (std::size_t axis = 0; axis < at.size(); ++axis) onward[axis] += at[axis] - before[axis];
            if (at == before) {
                step /= 2;
            } else {
                moveTo(onward);
            }
        }
        if (error < least) best = at, least = error;
    }
    return springAt(best);
}

}  // namespace

std::vector<std::uint32_t> collidersOfChain(const Rig& rig, std::size_t chain,
                                            std::span<const Collider> colliders) {
    std::vector<std::uint32_t> some;
    for (std::uint32_t c = 0; c < colliders.size(); ++c) {
        bool outside = true;
        for (std::uint32_t j = 1; j < rig.perChain; ++j) {
            const Vec3f away = rig.joints[1 + chain * rig.perChain + j].position_ws - colliders[c].centre_ws;
            outside = outside && away.norm() >= colliders[c].radius;
        }
        if (outside) some.push_back(c);
    }
    return some;
}

std::vector<Collider> collidersMetBy(const Rig& rig, std::size_t chain, std::span<const Collider> colliders) {
    std::vector<Collider> some;
    for (const std::uint32_t c : collidersOfChain(rig, chain, colliders)) some.push_back(colliders[c]);
    return some;
}

float settling(const Rig& rig, std::size_t chain, const Spring& spring) {
    float farthest = 0;
    const std::vector<Vec3f> resting = settled(rig, chain, spring);
    for (std::size_t j = 0; j < resting.size(); ++j)
        farthest =
            std::max(farthest, (resting[j] - rig.joints[2 + chain * rig.perChain + j].position_ws).norm());
    return farthest;
}

ChainMotion atRate(const ChainMotion& motion, float hz, std::span<const Eigen::Isometry3f> heads_ws) {
    ChainMotion result{hz, {heads_ws.begin(), heads_ws.end()}, {}};
    const std::size_t last = motion.heads_ws.size() - 1;
    std::vector<Eigen::Isometry3f> toHeads;
    for (const Eigen::Isometry3f& head : motion.heads_ws) toHeads.push_back(head.inverse());
    for (std::size_t f = 0; f < heads_ws.size(); ++f) {
        const double at = static_cast<double>(f) * static_cast<double>(motion.hz) / static_cast<double>(hz);
        const std::size_t k = std::min(static_cast<std::size_t>(at + 1e-6), last);
        const auto t = static_cast<float>(std::clamp(at - static_cast<double>(k), 0.0, 1.0));
        const std::array<std::size_t, 4> frames{k > 0 ? k - 1 : 0, k, std::min(k + 1, last),
                                                std::min(k + 2, last)};
        const float u = t * t, v = u * t;
        const std::array<float, 4> weights{0.5f * (2 * u - t - v), 0.5f * (2 - 5 * u + 3 * v),
                                           0.5f * (t + 4 * u - 3 * v), 0.5f * (v - u)};
        std::vector<Vec3f> joints;
        for (std::size_t j = 0; j < motion.joints_ws[k].size(); ++j) {
            Vec3f seen = Vec3f::Zero();
            for (std::size_t i = 0; i < 4; ++i)
                seen += weights[i] * (toHeads[frames[i]] * motion.joints_ws[frames[i]][j]);
            joints.push_back(heads_ws[f] * seen);
        }
        result.joints_ws.push_back(std::move(joints));
    }
    return result;
}

std::vector<std::vector<Vec3f>> swing(const Rig& rig, std::size_t chain, const Spring& spring,
                                      std::span<const Eigen::Isometry3f> heads_ws,
                                      std::span<const Collider> colliders, float hz) {
    SwingingChain swinging(rig, chain, spring, colliders, hz);
    std::vector<std::vector<Vec3f>> frames;
    for (std::size_t f = 0; f < heads_ws.size(); ++f) {
        if (f > 0) swinging.step(heads_ws[f]);
        frames.push_back(swinging.joints(heads_ws[f]));
    }
    return frames;
}

std::vector<Eigen::Affine3f> jointMotions(const Rig& rig, const Eigen::Isometry3f& head_ws,
                                          std::span<const std::vector<Vec3f>> joints_ws) {
    std::vector<Eigen::Affine3f> motions{Eigen::Affine3f(head_ws)};
    for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
        Quatf turned(head_ws.linear());
        const std::vector<Vec3f>& at = joints_ws[chain];
        for (std::uint32_t j = 0; j < rig.perChain; ++j) {
            const Vec3f& rest = rig.joints[1 + chain * rig.perChain + j].position_ws;
            if (j + 1 < rig.perChain) {
                const Vec3f bone = rig.joints[2 + chain * rig.perChain + j].position_ws - rest;
                const Vec3f way = at[j + 1] - at[j];
                if (bone.norm() > 0 && way.norm() > 0)
                    turned = shortestArc(turned * bone.normalized(), way.normalized()) * turned;
            }
            motions.push_back(Eigen::Translation3f(at[j]) * turned * Eigen::Translation3f(-rest));
        }
    }
    return motions;
}

SpringError springError(const Rig& rig, std::span<const Spring> springs, const ChainMotion& wanted,
                        std::span<const Collider> colliders) {
    SpringError error;
    std::size_t count = 0;
    for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
        const auto frames = swing(rig, chain, springs[chain], wanted.heads_ws,
                                  collidersMetBy(rig, chain, colliders), wanted.hz);
        for (std::size_t f = 1; f < frames.size(); ++f) {
            for (std::size_t j = 1; j < frames[f].size(); ++j) {
                const Vec3f& at = wanted.joints_ws[f][chain * rig.perChain + j];
                const double off = 1000 * static_cast<double>((frames[f][j] - at).norm());
                error.meanMm += off, ++count;
                error.largestMm = std::max(error.largestMm, off);
            }
        }
    }
    if (count > 0) error.meanMm /= static_cast<double>(count);
    return error;
}

Result<std::vector<Spring>> fitSprings(const Rig& rig, const ChainMotion& wanted,
                                       std::span<const Collider> colliders, Cancel cancel) {
    std::vector<Spring> springs(rig.chains());
    parallelFor(springs.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t chain = begin; chain < end && !cancelled(cancel); ++chain)
            springs[chain] = fitted(rig, chain, wanted, collidersMetBy(rig, chain, colliders));
    });
    if (cancelled(cancel)) return stopped();
    return springs;
}

}  // namespace hairloom::cards
