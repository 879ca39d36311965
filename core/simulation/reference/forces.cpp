// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hairloom::reference {
namespace {

using Eigen::Matrix3d;

Vec3d toDouble(runtime::Float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Unit vector along a segment and how it changes.
struct Tangent {
    Vec3d along;  ///< t_j
    Vec3d rate;   ///< its derivative by time
    double size;  ///< what e_j was divided by
};

Tangent tangentOf(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                  const std::vector<Vec3d>& v, std::size_t j) {
    const Vec3d e = x[j + 1] - x[j], rate = v[j + 1] - v[j];
    if (!physics.exactDirection) return {e / shape.lengths[j], rate / shape.lengths[j], shape.lengths[j]};
    const double size = e.norm();
    const Vec3d t = e / size;
    return {t, (rate - t * t.dot(rate)) / size, size};
}

/// Eq. 4 as docs/engine.md has it: energy ½ κ_j |r_j|² with r_j = t_j − (t_{j−1} + F_{j−1} c_j), its gradient
/// with F held. Kelvin-Voigt damping takes r_j where it will be after bendDampingTime at this speed.
void addAngular(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                const std::vector<Vec3d>& v, const Environment& around, std::vector<Vec3d>& force) {
    const std::vector<Quaterniond> frames = carriedFrames(shape, x, around.rotation);
    const std::size_t first = shape.firstFree - 1;
    Tangent before{Vec3d::Zero(), Vec3d::Zero(), 1.0};
    if (first > 0) before = tangentOf(physics, shape, x, v, first - 1);
    // A pull on segment j acts on its outer point and, reversed, on its inner one.
    const auto pull = [&](std::size_t j, const Tangent& t, const Vec3d& gradient) {
        Vec3d g = gradient / t.size;
        if (physics.exactDirection) g -= t.along * t.along.dot(g);
        force[j + 1] -= g;
        force[j] += g;
    };
    for (std::size_t j = first; j < shape.segments(); ++j) {
        const Tangent now = tangentOf(physics, shape, x, v, j);
        const Quaterniond& frame = j == 0 ? around.rotation : frames[j - 1];
        const Vec3d bent = now.along - before.along - frame * shape.bend[j];
        const Vec3d moment = shape.stiffness[j] * (bent + physics.bendDampingTime * (now.rate - before.rate));
        pull(j, now, moment);
        if (j > 0) pull(j - 1, before, -moment);
        before = now;
    }
}

/// What framesHeld leaves out: the energies change also because a segment turns the frames. Joint j's vector
/// C_j turns with segment j−1 across itself, and by the twist that the arcs before give its frame: the arc
/// from a to b with δa and δb twists by −k · (δa + δb), k = (a × b)/(1 + a·b) (Bergou et al. 2008). A twist ψ
/// costs joint j the energy m_j ψ, m_j = −s_j · (t_{j−1} × C_j).
void addFrameForces(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                    const Environment& around, std::vector<Vec3d>& force) {
    const std::vector<Quaterniond> frames = carriedFrames(shape, x, around.rotation);
    const std::size_t first = shape.firstFree - 1, n = shape.segments();
    const auto edge = [&](std::size_t j) -> Vec3d { return x[j + 1] - x[j]; };
    const auto scaled = [&](std::size_t j) -> Vec3d {
        return edge(j) / (physics.exactDirection ? edge(j).norm() : shape.lengths[j]);
    };
    const auto pull = [&](std::size_t j, const Vec3d& gradient) {
        const Vec3d t = edge(j).normalized();
        const Vec3d g = across(t, gradient) / edge(j).norm();
        force[j + 1] -= g;
        force[j] += g;
    };
    double twistBeyond = 0.0;
    for (std::size_t j = n; j-- > std::max<std::size_t>(first, 1);) {
        const Vec3d before = edge(j - 1).normalized(), now = edge(j).normalized();
        const Vec3d arc = twistBeyond * before.cross(now) / (1.0 + before.dot(now));
        pull(j, -arc);
        pull(j - 1, -arc);
        const Vec3d bend = frames[j - 1] * shape.bend[j];
        const Vec3d moment = shape.stiffness[j] * (scaled(j) - scaled(j - 1) - bend);
        pull(j - 1, -bend.cross(moment).cross(before));
        twistBeyond -= moment.dot(before.cross(bend));
    }
    const Vec3d root = (around.rotation * shape.edges[0]).normalized(), now = edge(0).normalized();
    if (first == 0) pull(0, -twistBeyond * root.cross(now) / (1.0 + root.dot(now)));
}

/// Eq. 3 between two points.
void addSpring(const std::vector<Vec3d>& x, std::size_t p, std::size_t q, double stiffness, double rest,
               std::vector<Vec3d>& force) {
    const Vec3d e = x[q] - x[p];
    const double size = e.norm();
    const Vec3d f = e * (stiffness * (size - rest) / size);
    force[p] += f;
    force[q] -= f;
}

template <class Visit>  // visit(p, q, stiffness, rest length)
void forEachSpring(const Physics& physics, const StrandShape& shape, Visit&& visit) {
    const std::size_t first = shape.firstFree - 1;
    if (physics.coilSprings) {
        for (std::size_t j = first; j < shape.segments(); ++j)
            visit(j, j + 1, shape.coil[j], shape.lengths[j]);
    }
    if (physics.flexionSprings) {
        for (std::size_t j = std::max<std::size_t>(first, 1); j < shape.segments(); ++j)
            visit(j - 1, j + 1, shape.flexion[j], shape.pairLength[j]);
    }
}

/// Share 1/s at which a point takes on the speed of the air, and the speed that it lacks.
struct Air {
    double rate;
    Vec3d lacking;
};

Air airAt(const Physics& physics, const std::vector<Vec3d>& x, const std::vector<Vec3d>& v,
          const Environment& around, std::size_t p) {
    const Vec3d lacking = airVelocity(physics, x[p], around.time) - v[p];
    const Vec3d e = x[p] - x[p - 1];
    const double both = lacking.norm() * e.norm();
    const double sine = both > 0.0 ? std::min(1.0, lacking.cross(e).norm() / both) : 0.0;
    return {physics.airDrag * sine, lacking};
}

/// Where the point is relative to a sphere that it is inside of.
struct Inside {
    Vec3d normal;
    double distance, reach;
};

template <class Visit>  // visit(Inside)
void forEachSphereAround(const Physics& physics, const StrandShape& shape, const Vec3d& x, std::size_t p,
                         const Environment& around, Visit&& visit) {
    for (const ColliderNow& collider : around.colliders) {
        const SphereNow sphere = collider.at(x);
        const Vec3d offset = x - sphere.center;
        const double distance = offset.norm(), r = reach(physics, shape, p, sphere.radius);
        if (distance >= r) continue;
        visit(Inside{distance > 0.0 ? Vec3d(offset / distance) : Vec3d(Vec3d::UnitY()), distance, r});
    }
}

void addSpringBlocks(const StrandShape& shape, const std::vector<Vec3d>& x, std::size_t p, std::size_t q,
                     double stiffness, double rest, BlockSink& sink) {
    const Vec3d e = x[q] - x[p];
    const double size = e.norm();
    const Vec3d t = e / size;
    const Matrix3d block =
        stiffness * ((1.0 - rest / size) * Matrix3d::Identity() + rest / size * t * t.transpose());
    const std::array<std::size_t, 2> ends{p, q};
    for (const std::size_t a : ends) {
        for (const std::size_t b : ends) {
            if (a < shape.firstFree || b < shape.firstFree) continue;
            sink.add(a, b, a == b ? block : Matrix3d(-block));
        }
    }
}

void addAngularBlocks(const StrandShape& shape, double share, BlockSink& sink) {
    for (std::size_t j = shape.firstFree - 1; j < shape.segments(); ++j) {
        const double outer = 1.0 / shape.lengths[j];
        const double inner = j > 0 ? 1.0 / shape.lengths[j - 1] : 0.0;
        const std::array<double, 3> weights{inner, -inner - outer, outer};  // of points j−1, j, j+1
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
                if (j + a < shape.firstFree + 1 || j + b < shape.firstFree + 1) continue;
                sink.add(j + a - 1, j + b - 1,
                         Matrix3d::Identity() * (share * shape.stiffness[j] * weights[a] * weights[b]));
            }
        }
    }
}

}  // namespace

std::vector<Quaterniond> carriedFrames(const StrandShape& shape, const std::vector<Vec3d>& x,
                                       const Quaterniond& rotation) {
    std::vector<Quaterniond> frames(shape.segments());
    // Walked along the strand of now and along that at rest, from the root's direction in both.
    Quaterniond now = rotation, rest = Quaterniond::Identity();
    Vec3d before = rotation * shape.edges[0], restBefore = shape.edges[0];
    for (std::size_t j = 0; j < shape.segments(); ++j) {
        const Vec3d edge = x[j + 1] - x[j];
        now = (Quaterniond::FromTwoVectors(before, edge) * now).normalized();
        rest = (Quaterniond::FromTwoVectors(restBefore, shape.edges[j]) * rest).normalized();
        frames[j] = now * rest.conjugate();
        before = edge;
        restBefore = shape.edges[j];
    }
    return frames;
}

Vec3d airVelocity(const Physics& physics, const Vec3d& position, double time) {
    const runtime::Wind& wind = physics.wind;
    const Vec3d mean = toDouble(wind.mean);
    if (!physics.windy || wind.kind == runtime::WindKind::uniform)
        return physics.windy ? mean : Vec3d(Vec3d::Zero());
    double waves = 0.0;
    Vec3d eddies = Vec3d::Zero();
    for (const runtime::WindMode& mode : wind.modes) {
        const double turns = toDouble(mode.waveVector).dot(position) + static_cast<double>(mode.turns) -
                             static_cast<double>(mode.turnsPerSecond) * time;
        const double wave = std::sin(2.0 * std::numbers::pi * turns);
        waves += wave;
        eddies += toDouble(mode.amplitude) * wave;
    }
    if (wind.kind != runtime::WindKind::gusting) return mean + eddies;
    // A quarter turn of the sine for each standard deviation of the waves' sum, which is √(modes/2).
    const double deviation = std::sqrt(0.5 * static_cast<double>(wind.modes.size()));
    const double gust = std::sin(0.5 * std::numbers::pi * waves / deviation);
    return mean * (1.0 + static_cast<double>(wind.strength) * gust);
}

void addForces(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
               const std::vector<Vec3d>& v, const Environment& around, std::vector<Vec3d>& force) {
    for (std::size_t p = shape.firstFree; p < shape.points(); ++p) {
        const double mass = shape.masses[p];
        force[p] += mass * (physics.gravity - physics.dampingRate * (v[p] - around.rootVelocity));
        if (physics.airDrag > 0.0) {
            const Air air = airAt(physics, x, v, around, p);
            force[p] += mass * air.rate * air.lacking;
        }
        if (!physics.penalty) continue;
        forEachSphereAround(physics, shape, x[p], p, around, [&](const Inside& in) {
            force[p] += in.normal * (mass * physics.penaltyStiffness * (in.reach - in.distance));
        });
    }
    if (physics.angularSprings) addAngular(physics, shape, x, v, around, force);
    if (physics.angularSprings && physics.framesTurn) addFrameForces(physics, shape, x, around, force);
    forEachSpring(physics, shape, [&](std::size_t p, std::size_t q, double stiffness, double rest) {
        addSpring(x, p, q, stiffness, rest, force);
    });
}

Potentials potentials(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                      const Quaterniond& rotation) {
    Potentials sum;
    for (std::size_t p = shape.firstFree; p < shape.points(); ++p)
        sum.gravity -= shape.masses[p] * physics.gravity.dot(x[p]);
    forEachSpring(physics, shape, [&](std::size_t p, std::size_t q, double stiffness, double rest) {
        const double stretch = (x[q] - x[p]).norm() - rest;
        sum.springs += 0.5 * stiffness * stretch * stretch;
    });
    if (!physics.angularSprings) return sum;
    const std::vector<Quaterniond> frames = carriedFrames(shape, x, rotation);
    const std::vector<Vec3d> still(x.size(), Vec3d::Zero());
    for (std::size_t j = shape.firstFree - 1; j < shape.segments(); ++j) {
        const Vec3d now = tangentOf(physics, shape, x, still, j).along;
        Vec3d target = (j == 0 ? rotation : frames[j - 1]) * shape.bend[j];
        if (j > 0) target += tangentOf(physics, shape, x, still, j - 1).along;
        sum.angular += 0.5 * shape.stiffness[j] * (now - target).squaredNorm();
    }
    return sum;
}

void addDerivatives(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                    const std::vector<Vec3d>& v, const Environment& around, double position, double speed,
                    BlockSink& sink) {
    for (std::size_t p = shape.firstFree; p < shape.points(); ++p) {
        double rate = physics.dampingRate;
        if (physics.airDrag > 0.0) rate += airAt(physics, x, v, around, p).rate;
        Matrix3d block = Matrix3d::Identity() * (speed * rate);
        if (physics.penalty) {
            forEachSphereAround(physics, shape, x[p], p, around, [&](const Inside& in) {
                const double bulge = in.distance > 0.0 ? in.reach / in.distance : 1.0;
                block += position * physics.penaltyStiffness *
                         (Matrix3d::Identity() -
                          bulge * (Matrix3d::Identity() - in.normal * in.normal.transpose()));
            });
        }
        sink.add(p, p, shape.masses[p] * block);
    }
    if (physics.angularSprings) addAngularBlocks(shape, position + speed * physics.bendDampingTime, sink);
    forEachSpring(physics, shape, [&](std::size_t p, std::size_t q, double stiffness, double rest) {
        addSpringBlocks(shape, x, p, q, position * stiffness, rest, sink);
    });
}

}  // namespace hairloom::reference
