// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/strand.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

namespace hairloom::reference {
namespace {

double squaredFrequency(double hertz) {
    const double omega = 2.0 * std::numbers::pi * hertz;
    return omega * omega;
}

Vec3d toDouble(runtime::Float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// h_p: half the length of the segments beside each point.
std::vector<double> shares(const std::vector<double>& lengths) {
    std::vector<double> h(lengths.size() + 1, 0.0);
    for (std::size_t j = 0; j < lengths.size(); ++j) {
        h[j] += 0.5 * lengths[j];
        h[j + 1] += 0.5 * lengths[j];
    }
    return h;
}

void divideByMean(std::vector<double>& values) {
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (double& value : values) value /= mean;
}

/// The curve as a sum of hats, one on each key, that are 0 from the keys beside it on.
double valueAt(const runtime::Ramp& curve, double along) {
    const auto keys = curve.inUse();
    const auto place = [&](std::size_t k) { return static_cast<double>(keys[k].at); };
    double sum = 0.0;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        double hat = 1.0;
        if (k > 0 && along < place(k)) hat = (along - place(k - 1)) / (place(k) - place(k - 1));
        if (k + 1 < keys.size() && along > place(k)) hat = (place(k + 1) - along) / (place(k + 1) - place(k));
        sum += std::max(0.0, hat) * static_cast<double>(keys[k].value);
    }
    return sum;
}

/// κ_j = B μ_j / l̄_j.
void setStiffness(StrandShape& shape, const std::vector<double>& h,
                  const runtime::SimulationSettings& settings) {
    const std::size_t n = shape.segments();
    const std::size_t first = shape.firstFree - 1;
    for (std::size_t j = first; j < n; ++j) {
        const double authored = authoredStiffness(settings, static_cast<double>(j) / static_cast<double>(n));
        const double span =
            j == first ? 0.5 * shape.lengths[j] : 0.5 * (shape.lengths[j - 1] + shape.lengths[j]);
        shape.stiffness[j] = shape.stiffer * bendingStiffness(authored) * shape.masses[j] / h[j] / span;
    }
}

/// c_j.
void setBend(StrandShape& shape) {
    for (std::size_t j = 0; j < shape.segments(); ++j) {
        shape.bend[j] = shape.edges[j] / shape.lengths[j];
        if (j > 0) shape.bend[j] -= shape.edges[j - 1] / shape.lengths[j - 1];
    }
}

}  // namespace

Physics::Physics(const runtime::SimulationSettings& s, BendingForce bendingForce)
    : rods(s.strandModel == runtime::StrandModel::rods),
      gravity(toDouble(s.gravity)),
      airDrag(static_cast<double>(s.airDrag)),
      dampingRate(s.dampingTime > 0.0f ? 1.0 / static_cast<double>(s.dampingTime) : 0.0),
      bendDampingTime(static_cast<double>(s.bendDampingTime)),
      lengthHeld(rods || (s.lengthMethod == runtime::LengthMethod::constraint && s.lengthIterations > 0)),
      coilSprings(s.lengthMethod != runtime::LengthMethod::constraint),
      angularSprings(s.angularStiffness > 0.0f && s.angularMethod != runtime::AngularMethod::flexion),
      framesTurn(bendingForce == BendingForce::gradient),
      exactDirection(s.angularMethod == runtime::AngularMethod::exact),
      flexionSprings(s.angularStiffness > 0.0f && s.angularMethod == runtime::AngularMethod::flexion),
      penalty(s.collisionResponse == runtime::CollisionResponse::penalty),
      penaltyStiffness(squaredFrequency(static_cast<double>(s.penaltyFrequency))),
      collisionRadiusAtRoot(static_cast<double>(s.collisionRadiusRoot)),
      collisionRadiusAtTip(static_cast<double>(s.collisionRadiusTip)),
      friction(static_cast<double>(s.friction)),
      restitution(static_cast<double>(s.restitution)),
      clampedPoints(s.clampedPoints),
      teleportDistance(static_cast<double>(s.teleportDistance)) {
    takeWind(s, {});
}

void Physics::takeWind(const runtime::SimulationSettings& settings, const runtime::WindInput& input) {
    wind = runtime::makeWind(settings, input);
    windy = airDrag > 0.0 && length(wind.mean) > 0.0f;
}

double authoredStiffness(const runtime::SimulationSettings& settings, double along) {
    return static_cast<double>(settings.angularStiffness) * valueAt(settings.angularCurve, along);
}

double bendingStiffness(double authored) {
    return runtime::kHairBendingStiffness * authored / (1.0 - authored);
}

StrandShape makeBody(std::vector<Vec3d> edges, std::span<const double> authoredMasses,
                     const runtime::SimulationSettings& settings, double stiffer) {
    StrandShape shape;
    shape.stiffer = stiffer;
    const std::size_t n = edges.size();
    shape.firstFree = std::min<std::size_t>(settings.clampedPoints, n + 1);
    shape.edges = std::move(edges);
    for (const Vec3d& edge : shape.edges) shape.lengths.push_back(edge.norm());
    shape.masses.assign(authoredMasses.begin(), authoredMasses.end());
    if (shape.masses.empty()) shape.masses = shares(shape.lengths);
    divideByMean(shape.masses);
    shape.stiffness.assign(n, 0.0);
    shape.bend.assign(n, Vec3d::Zero());
    shape.coil.assign(n, 0.0);
    shape.flexion.assign(n, 0.0);
    shape.pairLength.assign(n, 0.0);
    return shape;
}

StrandShape makeShape(std::vector<Vec3d> edges, std::span<const double> authoredMasses,
                      const runtime::SimulationSettings& settings, double stiffer) {
    StrandShape shape = makeBody(std::move(edges), authoredMasses, settings, stiffer);
    const std::size_t n = shape.segments();
    const std::vector<double> h = shares(shape.lengths);
    setStiffness(shape, h, settings);
    setBend(shape);

    const double squared = squaredFrequency(static_cast<double>(settings.springFrequency));
    for (std::size_t j = 0; j < n; ++j) {
        shape.coil[j] = 2.0 * squared / (1.0 / shape.masses[j] + 1.0 / shape.masses[j + 1]);
        if (j == 0) continue;
        // The energy of the angular spring where a straight joint has turned by 90°.
        const double shortening = (2.0 - std::numbers::sqrt2) * h[j];
        shape.flexion[j] = 2.0 * shape.stiffness[j] / (shortening * shortening);
        shape.pairLength[j] = (shape.edges[j - 1] + shape.edges[j]).norm();
    }
    return shape;
}

SphereNow ColliderNow::at(const Vec3d& x) const {
    if (!other) return sphere;
    // f(s) = |x − c(s)| − r(s) is convex; with x at (a, b) along and across the axis, f'(s) = 0 where
    // a − s = b k / √(1 − k²), k the change of r per metre.
    const Vec3d axis = other->center - sphere.center;
    const double size = axis.norm(), change = other->radius - sphere.radius;
    if (size <= std::abs(change)) return change > 0.0 ? *other : sphere;
    const double a = axis.dot(x - sphere.center) / size;
    const double b = axis.cross(x - sphere.center).norm() / size;
    const double k = change / size;
    const double share = std::clamp((a + b * k / std::sqrt((1.0 - k) * (1.0 + k))) / size, 0.0, 1.0);
    return {sphere.center + share * axis, sphere.velocity + share * (other->velocity - sphere.velocity),
            sphere.radius + share * change};
}

double reach(const Physics& physics, const StrandShape& shape, std::size_t p, double radius) {
    const double along = static_cast<double>(p) / static_cast<double>(shape.segments());
    return radius + physics.collisionRadiusAtRoot +
           (physics.collisionRadiusAtTip - physics.collisionRadiusAtRoot) * along;
}

}  // namespace hairloom::reference
