// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/solver.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "core/simulation/reference/contact.h"
#include "core/simulation/reference/forces.h"
#include "core/simulation/reference/lengths.h"

namespace hairloom::reference {
namespace {

Vec3d toDouble(runtime::Float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

Quaterniond toDouble(runtime::Quat q) {
    return Quaterniond(static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
                       static_cast<double>(q.z))
        .normalized();
}

bool usable(const Sphere& sphere) {
    return sphere.center_ws.allFinite() && std::isfinite(sphere.radius) && sphere.radius > 0.0;
}

/// Whether a point moves by more than half the strand's length beside its root: the equations of a strand in
/// a tangle have other solutions far away.
bool leaps(const StrandShape& shape, const std::vector<Vec3d>& from, const std::vector<Vec3d>& to) {
    const double maximum = 0.5 * std::accumulate(shape.lengths.begin(), shape.lengths.end(), 0.0);
    for (std::size_t p = 0; p < from.size(); ++p) {
        if (!((to[p] - from[p] - (to[0] - from[0])).norm() <= maximum)) return true;
    }
    return false;
}

Status check(const Strands& strands, const runtime::SimulationSettings& settings) {
    for (const std::string& problem : runtime::validate(settings))
        return tl::unexpected(errorOfWords(problem));
    const bool springs = settings.strandModel == runtime::StrandModel::springs;
    if (springs && !(greatestStiffness(settings) < 1.0f))
        return fail("angularStiffness 1 has no finite stiffness", "less than 1");
    if (settings.windShelter > 0.0f && settings.windSpeed > 0.0f)
        return fail("the reference has no lee of spheres",
                    "windShelter 0, or the converged engine as truth (--truth engine)");
    if (springs && settings.collisionSegments)
        return fail("the reference meets spheres at points",
                    "collisionSegments 0, or the converged engine as truth (--truth engine)");
    const std::size_t points = strands.restPositions_ss.size();
    if (strands.offsets.empty() || strands.offsets.front() != 0 || strands.offsets.back() != points)
        return fail("offsets do not match the points", "strand count + 1 of them, from 0 to the point count");
    if (!strands.pointMasses.empty() && strands.pointMasses.size() != points)
        return fail("masses do not match the points", "none or one per point");
    if (!strands.rootRotations_ss.empty() && strands.rootRotations_ss.size() + 1 != strands.offsets.size())
        return fail("root rotations do not match the strands", "none or one per strand");
    for (const double mass : strands.pointMasses)
        if (!(mass > 0.0) || !std::isfinite(mass)) return fail("a mass is not above 0");
    if (!strands.stiffness.empty() && strands.stiffness.size() + 1 != strands.offsets.size())
        return fail("stiffness does not match the strands", "none or one per strand");
    for (const double stiffness : strands.stiffness)
        if (!(stiffness >= 0.0) || !std::isfinite(stiffness))
            return fail("a stiffness is below 0", "0 or more");
    for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s) {
        const std::uint32_t first = strands.offsets[s], end = strands.offsets[s + 1];
        if (end < first + 2 || end > points)
            return fail("strand " + std::to_string(s) + " has too few points", "2 or more");
        for (std::uint32_t p = first; p + 1 < end; ++p) {
            const double length = (strands.restPositions_ss[p + 1] - strands.restPositions_ss[p]).norm();
            if (!std::isfinite(length) || !(length > 0.0))
                return fail("the segment after point " + std::to_string(p) + " has no length");
        }
    }
    return {};
}

}  // namespace

Strands strandsOf(const runtime::StrandsView& view) {
    Strands strands;
    strands.offsets.assign(view.offsets.begin(), view.offsets.end());
    for (const runtime::Float3 p : view.restPositions_ss) strands.restPositions_ss.push_back(toDouble(p));
    for (const runtime::Quat q : view.rootRotations_ss) strands.rootRotations_ss.push_back(toDouble(q));
    strands.stiffness.assign(view.stiffness.begin(), view.stiffness.end());
    return strands;
}

Frame frameOf(const runtime::FrameInput& input) {
    Frame frame{static_cast<double>(input.dt), input.time, {}, {}, {input.wind_ws, input.actorVelocity_ws}};
    for (const runtime::RootFrame& root : input.roots_ws)
        frame.roots_ws.push_back({toDouble(root.position), toDouble(root.rotation)});
    for (const runtime::Sphere& sphere : input.spheres)
        frame.spheres.push_back({toDouble(sphere.center_ws), static_cast<double>(sphere.radius)});
    for (const runtime::Capsule& capsule : input.capsules)
        frame.capsules.push_back({capsule.first, capsule.second});
    return frame;
}

Result<Solver> Solver::make(const Strands& strands, const runtime::SimulationSettings& settings,
                            BendingForce bendingForce) {
    if (Status status = check(strands, settings); !status) return tl::unexpected(status.error());
    Solver solver(settings, bendingForce);
    for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s) {
        const std::uint32_t first = strands.offsets[s], end = strands.offsets[s + 1];
        Root root{strands.restPositions_ss[first], Quaterniond::Identity()};
        if (!strands.rootRotations_ss.empty()) root.rotation = strands.rootRotations_ss[s].normalized();
        std::vector<Vec3d> edges;
        for (std::uint32_t p = first; p + 1 < end; ++p) {
            edges.push_back(root.rotation.conjugate() *
                            (strands.restPositions_ss[p + 1] - strands.restPositions_ss[p]));
        }
        std::span<const double> masses(strands.pointMasses);
        if (!masses.empty()) masses = masses.subspan(first, end - first);
        const double stiffer = strands.stiffness.empty() ? 1.0 : strands.stiffness[s];
        Strand strand;
        strand.root = root;
        if (solver.physics_.rods) {
            strand.shape = makeBody(std::move(edges), masses, settings, stiffer);
            strand.rod.emplace();
            strand.rod->shape =
                makeRodShape(strand.shape, settings, root.rotation.conjugate() * solver.physics_.gravity);
        } else {
            strand.shape = makeShape(std::move(edges), masses, settings, stiffer);
        }
        solver.strands_.push_back(std::move(strand));
        solver.restRoots_.push_back(root);
    }
    solver.reset(solver.restRoots_);
    return solver;
}

void Solver::reset(std::span<const Root> roots_ws) {
    assert(roots_ws.size() == strands_.size());
    for (std::size_t s = 0; s < strands_.size(); ++s) {
        Strand& strand = strands_[s];
        strand.root = {roots_ws[s].position, roots_ws[s].rotation.normalized()};
        strand.state.x.assign(1, strand.root.position);
        for (const Vec3d& edge : strand.shape.edges)
            strand.state.x.push_back(strand.state.x.back() + strand.root.rotation * edge);
        strand.state.v.assign(strand.state.x.size(), Vec3d::Zero());
        strand.work = {};
        if (strand.rod) strand.rod->motion = rodAtRest(strand.rod->shape, strand.root.rotation);
    }
    spheres_.clear();
}

void Solver::setMotion(std::span<const Vec3d> positions_ws, std::span<const Vec3d> velocities_ws) {
    std::size_t first = 0;
    for (Strand& strand : strands_) {
        assert(positions_ws.size() >= first + strand.shape.points());
        for (std::size_t p = strand.shape.firstFree; p < strand.shape.points(); ++p) {
            strand.state.x[p] = positions_ws[first + p];
            strand.state.v[p] = velocities_ws[first + p];
        }
        first += strand.shape.points();
        if (strand.rod) turnToPoints(strand.shape, strand.rod->shape, strand.state.x, strand.rod->motion);
        if (physics_.lengthHeld && strand.shape.firstFree < strand.shape.points())
            projectVelocities(strand.shape, strand.state.x, strand.state.v);
    }
}

/// Spheres, and capsules in place of those that are their ends.
std::vector<ColliderNow> Solver::collidersOf(const Frame& frame) const {
    std::vector<std::optional<SphereNow>> spheres;
    for (std::size_t i = 0; i < frame.spheres.size(); ++i) {
        spheres.emplace_back();
        if (!usable(frame.spheres[i])) continue;
        SphereNow now{frame.spheres[i].center_ws, Vec3d::Zero(), frame.spheres[i].radius};
        if (i < spheres_.size() && usable(spheres_[i])) {
            const Vec3d motion = now.center - spheres_[i].center_ws;
            if (motion.norm() <= physics_.teleportDistance) now.velocity = motion / frame.dt;
        }
        spheres.back() = now;
    }
    std::vector<ColliderNow> colliders;
    std::vector<bool> isEnd(spheres.size());
    for (const auto& [first, second] : frame.capsules) {
        const bool both = first < spheres.size() && second < spheres.size() && first != second &&
                          spheres[first] && spheres[second];
        if (!both) continue;
        colliders.push_back({*spheres[first], spheres[second]});
        isEnd[first] = isEnd[second] = true;
    }
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        if (spheres[i] && !isEnd[i]) colliders.push_back({*spheres[i]});
    }
    return colliders;
}

StepReport Solver::step(const Frame& frame, const StepOptions& options) {
    assert(frame.roots_ws.size() == strands_.size() && options.substeps > 0);
    StepReport report;
    if (!(frame.dt > 0.0)) return report;
    physics_.takeWind(settings_, frame.wind);
    const std::vector<ColliderNow> colliders = collidersOf(frame);
    spheres_ = frame.spheres;

    for (std::size_t s = 0; s < strands_.size(); ++s) {
        Strand& strand = strands_[s];
        const Root to{frame.roots_ws[s].position, frame.roots_ws[s].rotation.normalized()};
        if ((to.position - strand.root.position).norm() > physics_.teleportDistance) {
            const Quaterniond turn = to.rotation * strand.root.rotation.conjugate();
            for (Vec3d& x : strand.state.x) x = to.position + turn * (x - strand.root.position);
            for (Vec3d& v : strand.state.v) v = turn * v;
            if (strand.rod) strand.rod->turn(turn);
            strand.root = to;
        }
        RootPath path{strand.root.position, to.position, strand.root.rotation, to.rotation, frame.dt,
                      frame.time,           colliders};
        if (path.turnFrom.dot(path.turnTo) < 0.0) path.turnTo.coeffs() *= -1.0;
        stepStrand(strand, path, options, report);
        strand.root = to;
    }
    return report;
}

void Solver::stepStrand(Strand& strand, const RootPath& path, const StepOptions& options,
                        StepReport& report) const {
    const StrandShape& shape = strand.shape;
    // A root that changes its speed between frames does so at once: a blow on the strand.
    const ClampedEnd start = path.clamped(shape, 0.0);
    std::copy(start.v.begin(), start.v.end(), strand.state.v.begin());
    if (physics_.lengthHeld && shape.firstFree < shape.points())
        projectVelocities(shape, strand.state.x, strand.state.v);

    const bool impulses = !physics_.penalty && !path.collidersAtEnd.empty();
    const double share = 1.0 / static_cast<double>(options.substeps);
    for (std::uint32_t i = 0; i < options.substeps; ++i) {
        const double from = static_cast<double>(i) * share, to = static_cast<double>(i + 1) * share;
        if (strand.rod) {
            advanceRod(strand, path, from, to, options.order, report, options.halvings);
            continue;
        }
        if (options.order < 4 || impulses) {
            advance(strand, path, from, to, options.order == 1 ? 1.0 : 0.5, report, options.halvings);
            continue;
        }
        // Suzuki 1990: S(a h)² S((1 − 4a) h) S(a h)².
        const double a = 1.0 / (4.0 - std::cbrt(4.0));
        const double parts[] = {0.0, a, 2.0 * a, 1.0 - 2.0 * a, 1.0 - a, 1.0};
        for (std::size_t k = 0; k + 1 < std::size(parts); ++k)
            advance(strand, path, from + share * parts[k], from + share * parts[k + 1], 0.5, report,
                    options.halvings);
    }
    if (physics_.lengthHeld && shape.firstFree < shape.points())
        report.largestStretch = std::max(report.largestStretch, largestStretch(shape, strand.state.x));
}

bool Solver::trySubstep(Strand& strand, const RootPath& path, double from, double to, double weight) const {
    const double within = from + weight * (to - from), h = (to - from) * path.dt;
    const std::vector<ColliderNow> colliders = path.colliders(within);
    const Environment around{path.endTime - (1.0 - within) * path.dt, path.rotation(within), path.velocity(),
                             colliders};
    StrandState next = strand.state;
    const bool converged =
        substep(physics_, strand.shape, h, weight, around, path.clamped(strand.shape, to), next, strand.work);
    const bool solved = converged && !(physics_.lengthHeld && leaps(strand.shape, strand.state.x, next.x));
    if (solved) {
        strand.state = std::move(next);
    } else {
        strand.work = {};
    }
    return solved;
}

void Solver::Rod::turn(const Quaterniond& by) {
    for (Quaterniond& rotation : motion.rotation) rotation = (by * rotation).normalized();
    for (Vec3d& spin : motion.spin) spin = by * spin;
    for (Vec3d& tension : motion.tension) tension = by * tension;
}

void Solver::advanceRod(Strand& strand, const RootPath& path, double from, double to, int order,
                        StepReport& report, int halvings) const {
    Rod& rod = *strand.rod;
    StrandState next = strand.state;
    RodMotion motion = rod.motion;
    const std::size_t stages = order == 1 ? 1 : order == 2 ? 2 : 3;
    const RodStepResult result =
        stepRod(physics_, strand.shape, rod.shape, stages, path, from, to, next, motion, rod.work);
    const bool solved = result.converged && !leaps(strand.shape, strand.state.x, next.x);
    if (!solved && halvings > 0) {
        ++report.halved;
        const double middle = 0.5 * (from + to);
        advanceRod(strand, path, from, middle, order, report, halvings - 1);
        advanceRod(strand, path, middle, to, order, report, halvings - 1);
        return;
    }
    ++report.steps;
    if (!solved) {
        ++report.failed;
        rod.turn(path.rotation(to) * path.rotation(from).conjugate());
        carryAlong(strand, path, from, to);
        return;
    }
    strand.state = std::move(next);
    rod.motion = std::move(motion);
    report.contacts += result.contacts;
    report.deepestPenetration = std::max(report.deepestPenetration, result.penetration);
}

/// Takes the strand along with its root, without speed: what has no solution is not let run away.
void Solver::carryAlong(Strand& strand, const RootPath& path, double from, double to) {
    const Quaterniond turn = path.rotation(to) * path.rotation(from).conjugate();
    for (Vec3d& x : strand.state.x) x = path.position(to) + turn * (x - path.position(from));
    std::fill(strand.state.v.begin(), strand.state.v.end(), path.velocity());
    const ClampedEnd end = path.clamped(strand.shape, to);
    std::copy(end.x.begin(), end.x.end(), strand.state.x.begin());
    std::copy(end.v.begin(), end.v.end(), strand.state.v.begin());
}

void Solver::advance(Strand& strand, const RootPath& path, double from, double to, double weight,
                     StepReport& report, int halvings) const {
    const bool solved = trySubstep(strand, path, from, to, weight);
    if (!solved && halvings > 0) {
        ++report.halved;
        const double middle = 0.5 * (from + to);
        advance(strand, path, from, middle, weight, report, halvings - 1);
        advance(strand, path, middle, to, weight, report, halvings - 1);
        return;
    }
    ++report.steps;
    report.failed += solved ? 0 : 1;
    if (!solved) carryAlong(strand, path, from, to);
    const std::vector<ColliderNow> colliders = path.colliders(to);
    if (physics_.penalty || colliders.empty()) return;
    const ContactReport contact =
        resolveContacts(physics_, strand.shape, (to - from) * path.dt, colliders, strand.state);
    report.contacts += contact.points;
    report.deepestPenetration = std::max(report.deepestPenetration, contact.penetration);
    report.fastestApproach = std::max(report.fastestApproach, contact.approach);
}

std::vector<Vec3d> Solver::positions_ws() const {
    std::vector<Vec3d> all;
    for (const Strand& strand : strands_) all.insert(all.end(), strand.state.x.begin(), strand.state.x.end());
    return all;
}

std::vector<Vec3d> Solver::velocities_ws() const {
    std::vector<Vec3d> all;
    for (const Strand& strand : strands_) all.insert(all.end(), strand.state.v.begin(), strand.state.v.end());
    return all;
}

Energy Solver::energy() const {
    Energy sum;
    for (const Strand& strand : strands_) {
        const Potentials potential = potentials(physics_, strand.shape, strand.state.x, strand.root.rotation);
        sum.gravity += potential.gravity;
        sum.springs += strand.rod ? 0.0 : potential.springs;
        sum.angular += strand.rod ? elasticEnergy(strand.shape, strand.rod->shape, strand.root.rotation,
                                                  strand.rod->motion)
                                  : potential.angular;
        for (std::size_t p = strand.shape.firstFree; p < strand.shape.points(); ++p)
            sum.kinetic += 0.5 * strand.shape.masses[p] * strand.state.v[p].squaredNorm();
    }
    return sum;
}

}  // namespace hairloom::reference
