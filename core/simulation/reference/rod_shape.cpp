// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/rod_shape.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hairloom::reference {
namespace {

/// Stiffer hair counts as this stiff: it does not bend visibly.
constexpr double kStiffest = 1e3 * runtime::kHairBendingStiffness;
/// Radians that the carried weight turns a strand at most.
constexpr double kMostTurning = std::numbers::pi;
/// |vec p| that the carried weight makes at most; beyond about 0.7 more turning carries less.
constexpr double kMostBent = 0.6;

/// B/l̄ over the mass of a point.
double stiffnessOf(const StrandShape& body, const runtime::SimulationSettings& settings, std::size_t j) {
    const std::size_t n = body.segments();
    const double total = std::accumulate(body.lengths.begin(), body.lengths.end(), 0.0);
    const double along = static_cast<double>(j) / static_cast<double>(n);
    const double authored = authoredStiffness(settings, along);
    const double stiff = authored < 1.0 ? std::min(bendingStiffness(authored), kStiffest) : kStiffest;
    double span = 0.5 * body.lengths[j];
    // The vertex at the clamp stands for the whole clamped segment.
    if (j > 0) span += (j + 1 == body.firstFree ? 1.0 : 0.5) * body.lengths[j - 1];
    const double shortest = 1e-3 * total / static_cast<double>(n);
    return stiff / std::max({span, shortest, 1e-9}) / (total / static_cast<double>(body.points()));
}

Quaterniond rotationOf(const Vec3d& v) {
    return Quaterniond(std::sqrt(std::max(0.0, 1.0 - v.squaredNorm())), v.x(), v.y(), v.z());
}

/// A vertex of the unloaded shape, as it is in the authored one.
struct Vertex {
    Quaterniond inner;            // of the segment before it
    Vec3d innerTangent, tangent;  // of the segment before it, unloaded, and of its own, authored
    double stiffness, torsionRatio;

    Vec3d unloadedTangent(const Vec3d& v) const { return (inner * rotationOf(v)).conjugate() * tangent; }
    Vec3d axis(const Vec3d& v) const { return (innerTangent + unloadedTangent(v)).normalized(); }
    /// On its own segment, with p = (√(1 − v²), v), in the frame of the root.
    Vec3d moment(const Vec3d& v) const {
        const Vec3d a = axis(v), strain = 2.0 * v;
        const Vec3d m = stiffness * (strain + (torsionRatio - 1.0) * a.dot(strain) * a);
        return inner * Vec3d(rotationOf(v).w() * m + v.cross(m));
    }
    /// v of a moment, by Newton's method with differences.
    Vec3d bent(const Vec3d& wanted) const {
        Vec3d v = Vec3d::Zero();
        for (int step = 0; step < 60; ++step) {
            constexpr double kDifference = 1e-6;
            Eigen::Matrix3d slope;
            for (int c = 0; c < 3; ++c) {
                const Vec3d d = kDifference * Vec3d::Unit(c);
                slope.col(c) = (moment(v + d) - moment(v - d)) / (2.0 * kDifference);
            }
            const Vec3d last = v;
            v += slope.partialPivLu().solve(wanted - moment(v));
            if (!v.allFinite()) return last;
            if (v.norm() > kMostBent) v *= kMostBent / v.norm();
            if ((v - last).norm() < 1e-14) break;
        }
        return v;
    }
};

/// Fills what the unloaded shape decides; radians by which this gravity turns the vertices in all.
double unload(const StrandShape& body, const Vec3d& gravity, RodShape& rod) {
    const std::size_t n = body.segments(), first = body.firstFree - 1;
    std::vector<Vec3d> moment(n, Vec3d::Zero());  // that the vertex carries
    double beyond = 0.0;
    for (std::size_t j = n; j-- > first;) {
        beyond += body.masses[j + 1];
        if (j + 1 < n) moment[j] = moment[j + 1];
        moment[j] += body.edges[j].cross(beyond * gravity);
    }
    double turning = 0.0;
    rod.atRest.assign(n, Quaterniond::Identity());
    for (std::size_t j = 0; j < n; ++j) {
        const Vec3d tangent = body.edges[j].normalized();
        rod.tangent[j] = rod.axis[j] = tangent;
        if (j < first) continue;
        const Quaterniond inner = j > 0 ? rod.atRest[j - 1] : Quaterniond::Identity();
        const Vertex vertex{inner, j > 0 ? rod.tangent[j - 1] : tangent, tangent, rod.stiffness[j],
                            rod.torsionRatio};
        Vec3d v = Vec3d::Zero();
        if (rod.stiffness[j] > 0.0) v = vertex.bent(moment[j]);
        turning += 2.0 * std::asin(v.norm());
        rod.atRest[j] = (inner * rotationOf(v)).normalized();
        rod.tangent[j] = vertex.unloadedTangent(v);
        rod.axis[j] = vertex.axis(v);
    }
    return turning;
}

}  // namespace

Quaterniond turnBy(const Vec3d& u) {
    const double angle = u.norm();
    const double share = angle > 1e-8 ? std::sin(0.5 * angle) / angle : 0.5;
    return Quaterniond(std::cos(0.5 * angle), share * u.x(), share * u.y(), share * u.z());
}

Vec3d turnOf(const Quaterniond& q) {
    const double size = q.vec().norm();
    if (size < 1e-12) return (q.w() < 0.0 ? -2.0 : 2.0) * q.vec();
    return q.vec() * ((q.w() < 0.0 ? -2.0 : 2.0) * std::atan2(size, std::abs(q.w())) / size);
}

RodShape makeRodShape(const StrandShape& body, const runtime::SimulationSettings& settings,
                      const Vec3d& gravityAtRest) {
    RodShape rod;
    const std::size_t n = body.segments();
    rod.torsionRatio = static_cast<double>(settings.torsionRatio);
    rod.dampingTime = static_cast<double>(settings.bendDampingTime);
    rod.tangent.assign(n, Vec3d::Zero());
    rod.axis.assign(n, Vec3d::Zero());
    rod.stiffness.assign(n, 0.0);
    for (std::size_t j = body.firstFree - 1; j < n; ++j) rod.stiffness[j] = stiffnessOf(body, settings, j);
    const Vec3d carried = gravityAtRest * static_cast<double>(settings.restGravity);
    const double turning = unload(body, carried, rod);
    if (turning > kMostTurning) unload(body, carried * (kMostTurning / turning), rod);
    return rod;
}

}  // namespace hairloom::reference
