// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coil springs, angular springs of straight hair, gravity and drag of docs/engine.md in double precision, by
// RK4: what the engine converges to where nothing is constrained. Shares no code with it.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "hairloom/settings.h"

namespace hairloom::test {

/// A straight strand of equal segments whose first two points are clamped, at rest at the origin.
class SmoothStrand {
  public:
    struct State {
        Eigen::Matrix3Xd positions, velocities;
    };

    /// `settings`: clampedPoints 2, angularCurve 1 everywhere, restGravity 0, no damping, wind or collision.
    SmoothStrand(const runtime::SimulationSettings& settings, const Eigen::Vector3d& direction,
                 double segment, int points)
        : exact_(settings.angularMethod == runtime::AngularMethod::exact),
          length_(segment),
          direction_(direction) {
        masses_.setOnes(points);
        masses_(0) = masses_(points - 1) = 0.5;
        masses_ /= masses_.mean();
        const double s = static_cast<double>(settings.angularStiffness);
        // κ = B μ / l̄, μ the mass per length; only half a segment's curvature at the clamp.
        const double B = runtime::kHairBendingStiffness * s / (1.0 - s);
        kappa_.setZero(points);
        for (int j = 1; j + 1 < points; ++j)
            kappa_(j) = B * masses_(j) / (segment * (j == 1 ? 0.5 * segment : segment));
        omega_ = 2.0 * 3.14159265358979323846 * static_cast<double>(settings.springFrequency);
        gravity_ = {static_cast<double>(settings.gravity.x), static_cast<double>(settings.gravity.y),
                    static_cast<double>(settings.gravity.z)};
        drag_ = static_cast<double>(settings.airDrag);
    }

    State afterRest(double time, int steps) const {
        const auto points = masses_.size();
        State a{Eigen::Matrix3Xd(3, points), Eigen::Matrix3Xd::Zero(3, points)};
        for (int p = 0; p < points; ++p) a.positions.col(p) = direction_ * (length_ * p);
        const double h = time / steps;
        const auto moved = [](const State& from, const State& rate, double by) {
            return State{from.positions + by * rate.positions, from.velocities + by * rate.velocities};
        };
        for (int i = 0; i < steps; ++i) {
            const State k1 = rate(a), k2 = rate(moved(a, k1, 0.5 * h)), k3 = rate(moved(a, k2, 0.5 * h)),
                        k4 = rate(moved(a, k3, h));
            a = moved(moved(moved(moved(a, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
        }
        return a;
    }

  private:
    State rate(const State& a) const {
        const int points = static_cast<int>(masses_.size());
        Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, points);
        const auto edge = [&](int s) -> Eigen::Vector3d {
            return a.positions.col(s + 1) - a.positions.col(s);
        };
        const auto tangent = [&](int s) -> Eigen::Vector3d {
            return exact_ ? edge(s).normalized() : Eigen::Vector3d(edge(s) / length_);
        };
        /// Adds the force that belongs to the gradient of the energy by segment s's tangent.
        const auto pull = [&](int s, Eigen::Vector3d gradient) {
            if (exact_) {
                gradient -= tangent(s) * tangent(s).dot(gradient);
                gradient /= edge(s).norm();
            } else {
                gradient /= length_;
            }
            force.col(s + 1) -= gradient;
            force.col(s) += gradient;
        };
        for (int s = 0; s + 1 < points; ++s) {
            const double k = 2.0 * omega_ * omega_ / (1.0 / masses_(s) + 1.0 / masses_(s + 1));
            const Eigen::Vector3d along = edge(s).normalized() * (k * (edge(s).norm() - length_));
            force.col(s + 1) -= along;
            force.col(s) += along;
            if (s == 0) continue;
            const Eigen::Vector3d bent = kappa_(s) * (tangent(s) - tangent(s - 1));
            pull(s, bent);
            pull(s - 1, -bent);
        }
        State result{a.velocities, Eigen::Matrix3Xd::Zero(3, points)};
        for (int p = 2; p < points; ++p) {
            const Eigen::Vector3d v = a.velocities.col(p);
            const double size = v.norm() * edge(p - 1).norm();
            const double sine = size > 0.0 ? v.cross(edge(p - 1)).norm() / size : 0.0;
            result.velocities.col(p) = force.col(p) / masses_(p) + gravity_ - drag_ * sine * v;
        }
        return result;
    }

    bool exact_;
    double length_, omega_ = 0.0, drag_ = 0.0;
    Eigen::Vector3d direction_, gravity_;
    Eigen::VectorXd masses_, kappa_;
};

}  // namespace hairloom::test
