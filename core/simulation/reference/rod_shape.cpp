// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/rod_shape.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/simulation/reference/rod_forces.h"

namespace hairloom::reference {
namespace {

/// Stiffer hair counts as this stiff: it does not bend visibly.
constexpr double kStiffest = 1e3 * runtime::kHairBendingStiffness;
/// Radians that the carried weight bends a strand by at most.
constexpr double kMaxHeld = 2.5;
/// What is searched for ends there, in powers of two of radians, after so many halvings.
constexpr double kMinHeldPower = -9.0;
constexpr int kHalvings = 8;
/// Share of a vertex' stiffness without which a held shape still has to be stable.
constexpr double kSpareShare = 0.05;
/// |vec p| that the carried weight makes at most; beyond about 0.7 more turning carries less.
constexpr double kMaxBend = 0.6;

/// B/l̄ over the mass of a point.
double stiffnessOf(const StrandShape& body, const runtime::SimulationSettings& settings, std::size_t j) {
    const std::size_t n = body.segments();
    const double total = std::accumulate(body.lengths.begin(), body.lengths.end(), 0.0);
    const double along = static_cast<double>(j) / static_cast<double>(n);
    const double authored = authoredStiffness(settings, along);
    const double even = authored < 1.0 ? bendingStiffness(authored) : std::numeric_limits<double>::max();
    const double stiff =
        std::min(body.stiffer * (even / static_cast<double>(settings.sectionRatio)), kStiffest);
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
    Vec3d longDiameter;           // of its own segment, authored
    double stiffness, torsionRatio, flatRatio;

    Vec3d unloadedTangent(const Vec3d& v) const { return (inner * rotationOf(v)).conjugate() * tangent; }
    Vec3d axis(const Vec3d& v) const { return (innerTangent + unloadedTangent(v)).normalized(); }
    Vec3d normal(const Vec3d& v) const {
        const Vec3d n = (inner * rotationOf(v)).conjugate() * longDiameter, a = axis(v);
        return (n - a.dot(n) * a).normalized();
    }
    /// On its own segment, with p = (√(1 − v²), v), in the frame of the root.
    Vec3d moment(const Vec3d& v) const {
        const Vec3d a = axis(v), n = normal(v), strain = 2.0 * v;
        const Vec3d m = stiffness * (strain + (torsionRatio - 1.0) * a.dot(strain) * a +
                                     (flatRatio - 1.0) * n.dot(strain) * n);
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
            if (v.norm() > kMaxBend) v *= kMaxBend / v.norm();
            if ((v - last).norm() < 1e-14) break;
        }
        return v;
    }
};

/// The long diameter of each segment in the authored shape: about the axis that the strand turns about, where
/// it turns by much more than 1/50, else carried on from the root's x without turning about the strand.
std::vector<Vec3d> longDiameters(const StrandShape& body) {
    std::vector<Vec3d> found;
    Vec3d before = Vec3d::UnitZ(), along = Vec3d::UnitX();
    for (const Vec3d& edge : body.edges) {
        const Vec3d tangent = edge.normalized(), turn = before.cross(tangent);
        along = Quaterniond::FromTwoVectors(before, tangent) * along;
        if (!found.empty()) along += (turn.dot(along) < 0.0 ? -50.0 : 50.0) * turn;
        along = (along - tangent.dot(along) * tangent).normalized();
        found.push_back(along);
        before = tangent;
    }
    return found;
}

/// What a held shape carries: beyond each segment a weight, about each vertex a moment.
struct Load {
    std::vector<Vec3d> weight, moment;
};

Load loadOf(const StrandShape& body, const Vec3d& gravity) {
    const std::size_t n = body.segments();
    Load load{std::vector<Vec3d>(n, Vec3d::Zero()), std::vector<Vec3d>(n, Vec3d::Zero())};
    Vec3d weight = Vec3d::Zero(), moment = Vec3d::Zero();
    for (std::size_t j = n; j-- > body.firstFree - 1;) {
        load.weight[j] = weight += body.masses[j + 1] * gravity;
        load.moment[j] = moment += body.edges[j].cross(weight);
    }
    return load;
}

/// Fills what the unloaded shape decides.
void unload(const StrandShape& body, const Load& load, RodShape& rod) {
    const std::size_t n = body.segments(), first = body.firstFree - 1;
    const std::vector<Vec3d> flat = longDiameters(body);
    rod.atRest.assign(n, Quaterniond::Identity());
    for (std::size_t j = 0; j < n; ++j) {
        const Vec3d tangent = body.edges[j].normalized();
        rod.tangent[j] = rod.axis[j] = tangent;
        rod.normal[j] = flat[j];
        if (j < first) continue;
        const Quaterniond inner = j > 0 ? rod.atRest[j - 1] : Quaterniond::Identity();
        const Vertex vertex{inner,
                            j > 0 ? rod.tangent[j - 1] : tangent,
                            tangent,
                            flat[j],
                            rod.stiffness[j],
                            rod.torsionRatio,
                            rod.flatRatio};
        const Vec3d v = rod.stiffness[j] > 0.0 ? vertex.bent(load.moment[j]) : Vec3d(Vec3d::Zero());
        rod.atRest[j] = (inner * rotationOf(v)).normalized();
        rod.tangent[j] = vertex.unloadedTangent(v);
        rod.axis[j] = vertex.axis(v);
        rod.normal[j] = vertex.normal(v);
    }
}

/// Whether the energy of shape and weight grows in all directions from the authored shape: its second
/// derivatives in the turns of the segments, less the spare share, have a Cholesky factorisation.
bool stable(const StrandShape& body, const Load& load, const RodShape& rod) {
    const std::size_t first = body.firstFree - 1;
    const auto at = [&](std::size_t j) { return static_cast<Eigen::Index>(3 * (j - first)); };
    const Eigen::Index size = at(body.segments());
    Eigen::MatrixXd second = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t j = first; j < body.segments(); ++j) {
        const Quaterniond inner = j > 0 ? rod.atRest[j - 1] : Quaterniond::Identity();
        const Quaterniond p = relativeRotation(inner, rod.atRest[j], Quaterniond::Identity());
        const VertexMoment moment(rod.elasticity(j), 0.0, inner, p, Vec3d::Zero());
        const Eigen::Matrix3d bend =
            moment.elastic - kSpareShare * rod.stiffness[j] * Eigen::Matrix3d::Identity();
        second.block<3, 3>(at(j), at(j)) += bend - crossMatrix(load.weight[j]) * crossMatrix(body.edges[j]);
        if (j == first) continue;
        const Eigen::Matrix3d carried = bend + crossMatrix(moment.world);
        second.block<3, 3>(at(j), at(j - 1)) -= carried;
        second.block<3, 3>(at(j - 1), at(j)) -= bend;
        second.block<3, 3>(at(j - 1), at(j - 1)) += carried;
    }
    // In balance the rest of it is none: turns that follow each other do not commute, moments do.
    const Eigen::MatrixXd even = 0.5 * (second + second.transpose());
    return Eigen::LLT<Eigen::MatrixXd>(even).info() == Eigen::Success;
}

/// Radians of the load's small bends, each `most` at most.
double bentBy(const RodShape& rod, const Load& load, double most) {
    double sum = 0.0;
    for (std::size_t j = 0; j < rod.stiffness.size(); ++j)
        if (rod.stiffness[j] > 0.0) sum += std::min(load.moment[j].norm() / rod.stiffness[j], most);
    return sum;
}

/// As stiff as `own`, but for vertices that the load bends more than all may: so much that the sum is `held`.
void stiffen(const std::vector<double>& own, const Load& load, double held, RodShape& rod) {
    rod.stiffness = own;
    if (bentBy(rod, load, std::numeric_limits<double>::infinity()) <= held) return;
    double low = 0.0, high = held;
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (low + high);
        (bentBy(rod, load, middle) > held ? high : low) = middle;
    }
    for (std::size_t j = 0; j < own.size(); ++j)
        if (own[j] > 0.0) rod.stiffness[j] = std::max(own[j], load.moment[j].norm() / std::max(low, 1e-9));
}

/// Where the shape that hangs in the authored one is not stable, or bent too far, hair is stiffened by the
/// least that makes it so.
void hold(const StrandShape& body, const Load& load, RodShape& rod) {
    const std::vector<double> own = rod.stiffness;
    const auto holds = [&](double held) {
        stiffen(own, load, held, rod);
        unload(body, load, rod);
        return stable(body, load, rod);
    };
    if (holds(kMaxHeld)) return;
    double low = kMinHeldPower, high = std::log2(kMaxHeld);
    for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (low + high);
        (holds(std::exp2(middle)) ? low : high) = middle;
    }
    holds(std::exp2(low));
}

}  // namespace

Eigen::Matrix3d crossMatrix(const Vec3d& v) {
    Eigen::Matrix3d m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

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
    const double flat = static_cast<double>(settings.sectionRatio), squared = flat * flat;
    rod.torsionRatio = static_cast<double>(settings.torsionRatio) * 2.0 * squared / (1.0 + squared);
    rod.flatRatio = squared;
    rod.dampingTime = static_cast<double>(settings.bendDampingTime);
    rod.tangent.assign(n, Vec3d::Zero());
    rod.axis.assign(n, Vec3d::Zero());
    rod.normal.assign(n, Vec3d::Zero());
    rod.stiffness.assign(n, 0.0);
    for (std::size_t j = body.firstFree - 1; j < n; ++j) rod.stiffness[j] = stiffnessOf(body, settings, j);
    hold(body, loadOf(body, gravityAtRest * static_cast<double>(settings.restGravity)), rod);
    return rod;
}

}  // namespace hairloom::reference
