// SPDX-License-Identifier: MIT
// The arrays of angular springs (docs/engine.md, "Stiffness" and "Integrators").
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/double3.h"
#include "hairloom/presets.h"
#include "models/springs/springs.h"

namespace hairloom::runtime {
namespace {

/// Stiffness beyond which the matrix of a strand no longer fits single precision, as a multiple of the
/// masses. There a strand of 32 segments sags by less than a ten-thousandth of what it falls in a substep.
constexpr double kStiffestSpring = 1e7;
/// What keeps the fastest waves of curved hair from ringing on, whose pulls are not quite those of an energy.
constexpr float kMinCurvedRate = 0.25f;
/// The same where lengths are held by a step of their own, which does not leave the trapezoidal rule its
/// energy.
constexpr float kMinRate = 0.02f;
/// 2 − √2: how much nearer the ends of two unit segments come when they turn by 90°.
constexpr double kShortening = 0.585786437626905;

/// A unit vector across a, or along x where a has no length.
Double3 anyNormal(Double3 a) {
    const Double3 axis = std::abs(a.x) > std::abs(a.z) ? Double3{-a.y, a.x, 0.0} : Double3{0.0, -a.z, a.y};
    const double size = std::sqrt(dotOf(axis, axis));
    return size > 0.0 ? axis * (1.0 / size) : Double3{1.0, 0.0, 0.0};
}

/// One strand of a block, in double precision.
class StrandBend {
  public:
    StrandBend(const RestShape& shape, const SimulationSettings& settings, std::size_t index,
               std::uint32_t lane)
        : settings_(settings),
          block_(shape.blocks[index]),
          size_(planeSize(block_)),
          rest_(shape.planes.data() + block_.firstPlane * kRestPlanes),
          lane_(lane),
          stiffer_(static_cast<double>(shape.stiffnessOf(block_.strandOfLane[lane]))) {}

    /// κ of each joint, in square metres per square second and unit mass; the system has the masses plus
    /// `share`·K, which is bounded at `stiffest` times the masses where that is not 0.
    void fillStiffness(double share, double stiffest, bool flexion) {
        const std::uint32_t first = firstJoint();
        const std::uint32_t segments = block_.points - 1;
        for (std::uint32_t j = 0; j < block_.points; ++j) kappa_[j] = 0.0;
        for (std::uint32_t j = first; j < segments; ++j) {
            const double along = static_cast<double>(j) / segments;
            const double s =
                static_cast<double>(settings_.angularStiffness) * settings_.angularCurve.at(along);
            const double stiffness = stiffer_ * bendingStiffnessOf(s);
            const double outer = lengthOf(j);
            const double inner = j > 0 ? lengthOf(j - 1) : 0.0;
            const bool clamped = j + 1 == settings_.clampedPoints || j == 0;
            const double carried = 0.5 * (outer + (clamped ? 0.0 : inner));
            const double own = 0.5 * (outer + inner);
            if (!(outer > kNoLength) || (j > 0 && !(inner > kNoLength))) continue;
            kappa_[j] = stiffness * mass(j) / own / carried;
            if (stiffest > 0.0) {
                const double maximum = outerShare(j) + innerShare(j);
                const double lightest = std::min({mass(j), mass(j + 1), j > 0 ? mass(j - 1) : mass(j)});
                kappa_[j] = std::min(kappa_[j], stiffest * lightest / (share * maximum * maximum));
            }
            // A flexion spring of the same energy where a straight joint has turned by 90°.
            if (flexion) kappa_[j] *= 2.0 / (kShortening * kShortening * own * own);
        }
    }

    double kappa(std::uint32_t joint) const { return kappa_[joint]; }

    /// What joint j adds to the direction of its inner segment, in the frame carried to that segment (x along
    /// it): its rest curve. The slot of the tip has the normal that the root carries, in the root's frame.
    void writeTargets(float* x, float* y, float* z) {
        const auto write = [&](std::uint32_t p, Double3 v) {
            const std::size_t i = at(p);
            x[i] = static_cast<float>(v.x);
            y[i] = static_cast<float>(v.y);
            z[i] = static_cast<float>(v.z);
        };
        Double3 inner = direction(0);
        Double3 normal = anyNormal(inner);
        write(block_.points - 1, normal);
        for (std::uint32_t j = 0; j + 1 < block_.points; ++j) {
            const Double3 outer = direction(j);
            const Double3 curve = outer - inner;
            write(j, {dotOf(curve, inner), dotOf(curve, normal), dotOf(curve, crossOf(inner, normal))});
            const double turn = dotOf(outer, normal) / std::max(1.0 + dotOf(inner, outer), 1e-9);
            normal = normal - (inner + outer) * turn;
            inner = outer;
        }
    }

    /// LDLᵀ of M + share·K over the free points.
    void writeFactors(double share, float* inverseDiagonal, float* lower1, float* lower2) const {
        const std::uint32_t first = settings_.clampedPoints;
        double d1 = 1.0, d2 = 1.0;  // diagonals of the last two points
        double l1Before = 0.0;      // lower1 of the last point
        for (std::uint32_t p = first; p < block_.points; ++p) {
            const double next = p > first ? share * coupling1(p) : 0.0;
            const double second = p > first + 1 ? share * coupling2(p) : 0.0;
            const double l2 = second / d2;
            const double l1 = (next - second * l1Before) / d1;
            const double d = mass(p) + share * diagonal(p) - l1 * l1 * d1 - l2 * l2 * d2;
            inverseDiagonal[at(p)] = static_cast<float>(1.0 / d);
            lower1[at(p)] = static_cast<float>(l1);
            lower2[at(p)] = static_cast<float>(l2);
            d2 = d1;
            d1 = d;
            l1Before = l1;
        }
    }

    std::size_t at(std::uint32_t p) const { return std::size_t{p} * kBlockLanes + lane_; }

  private:
    static constexpr double kNoLength = 1e-9;

    std::uint32_t firstJoint() const { return settings_.clampedPoints - 1; }
    double lengthOf(std::uint32_t s) const { return static_cast<double>(rest_[3 * size_ + at(s)]); }
    double mass(std::uint32_t p) const { return 1.0 / static_cast<double>(rest_[5 * size_ + at(p)]); }
    Double3 direction(std::uint32_t s) const {
        const double inverse = static_cast<double>(rest_[4 * size_ + at(s)]);
        const auto part = [&](std::size_t plane) {
            return static_cast<double>(rest_[plane * size_ + at(s)]);
        };
        return Double3{part(0), part(1), part(2)} * inverse;
    }
    // Row of joint j: +outerShare at point j + 1, −(outerShare + innerShare) at j, +innerShare at j − 1.
    double outerShare(std::uint32_t j) const { return static_cast<double>(rest_[4 * size_ + at(j)]); }
    double innerShare(std::uint32_t j) const {
        return j > 0 ? static_cast<double>(rest_[4 * size_ + at(j - 1)]) : 0.0;
    }
    double diagonal(std::uint32_t p) const {
        double sum = 0.0;
        if (p > 0) sum += kappa_[p - 1] * outerShare(p - 1) * outerShare(p - 1);
        const double middle = outerShare(p) + innerShare(p);
        if (p + 1 < block_.points) sum += kappa_[p] * middle * middle;
        if (p + 2 < block_.points) sum += kappa_[p + 1] * innerShare(p + 1) * innerShare(p + 1);
        return sum;
    }
    /// Between p − 1 and p.
    double coupling1(std::uint32_t p) const {
        double sum = -kappa_[p - 1] * outerShare(p - 1) * (outerShare(p - 1) + innerShare(p - 1));
        if (p + 1 < block_.points) sum -= kappa_[p] * innerShare(p) * (outerShare(p) + innerShare(p));
        return sum;
    }
    /// Between p − 2 and p.
    double coupling2(std::uint32_t p) const { return kappa_[p - 1] * outerShare(p - 1) * innerShare(p - 1); }

    const SimulationSettings& settings_;
    const Block& block_;
    std::size_t size_;
    const float* rest_;
    std::uint32_t lane_;
    double stiffer_;  // than settings say
    std::array<double, kMaxPoints> kappa_;
};

}  // namespace

float bendRate(const SimulationSettings& settings, float h, bool curved) {
    const float damping = settings.dampingTime > 0.0f ? 1.0f / settings.dampingTime : 0.0f;
    const float lost = 1.0f - std::exp(-h * (damping + settings.airDrag));
    const float minimum = curved ? kMinCurvedRate : kMinRate;
    return std::max(settings.bendDampingTime / h, minimum) + 0.25f * lost;
}

void fillBend(const RestShape& shape, const SimulationSettings& settings, float h, std::size_t index,
              Bend& bend) {
    const Block& block = shape.blocks[index];
    if (block.points <= settings.clampedPoints) return;
    const std::size_t size = planeSize(block);
    float* const stiffness = bend.planes.data() + block.firstPlane * bend.planeCount();
    const double step = static_cast<double>(h) * static_cast<double>(h);
    const bool flexion = settings.angularMethod == AngularMethod::flexion;
    const bool backward = settings.integrator == Integrator::implicitEuler;
    const double share =
        backward ? step : step * (0.25 + static_cast<double>(bendRate(settings, h, bend.targets)));
    const double stiffest = bend.factored ? kStiffestSpring : 0.0;
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        StrandBend strand(shape, settings, index, lane);
        strand.fillStiffness(share, stiffest, flexion);
        for (std::uint32_t j = 0; j < block.points; ++j)
            stiffness[strand.at(j)] = static_cast<float>(step * strand.kappa(j));
        float* plane = stiffness + size;
        if (bend.factored) {
            strand.writeFactors(share, plane, plane + size, plane + 2 * size);
            plane += 3 * size;
        }
        if (bend.targets) strand.writeTargets(plane, plane + size, plane + 2 * size);
    }
}

}  // namespace hairloom::runtime
