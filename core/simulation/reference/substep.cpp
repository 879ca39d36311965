// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/substep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/simulation/reference/forces.h"
#include "core/simulation/reference/lengths.h"

namespace hairloom::reference {
namespace {

constexpr std::size_t kBlock = 4;  // unknowns of free point p: λ of the segment before it, then its x, y, z
constexpr std::size_t kBand = 2 * kBlock + 2;
constexpr int kMaxIterations = 100;
constexpr double kConverged = 1e-15;  // m
constexpr double kRounding = 1e-12;   // m; smaller corrections that no longer shrink are rounding errors

/// Newton's iteration on x₁ and λ.
class StepSolve {
  public:
    StepSolve(const Physics& physics, const StrandShape& shape, double h, double weight,
              const Environment& around, const StrandState& state, std::vector<Vec3d>& x1, Workspace& work)
        : physics_(physics),
          shape_(shape),
          h_(h),
          weight_(weight),
          around_(around),
          x0_(state.x),
          v0_(state.v),
          x1_(x1),
          work_(work),
          xm_(x1.size()),
          vm_(x1.size()) {
        const std::size_t unknowns = kBlock * (shape.points() - shape.firstFree);
        if (work_.rightSide.size() != unknowns) {
            work_.rightSide.assign(unknowns, 0.0);
            work_.matrix.resize(unknowns, kBand);
            work_.multipliers.assign(shape.segments(), 0.0);
        }
    }

    /// Leaves the force within the step in the workspace.
    bool run() {
        double before = std::numeric_limits<double>::infinity();
        for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
            fillResidual();
            // Kept factors do while they converge fast.
            if (iteration < 2 || slow_) {
                fillMatrix();
                if (!work_.matrix.factor()) return false;
            }
            work_.matrix.solve(work_.rightSide);
            const double moved = apply();
            if (!std::isfinite(moved)) return false;
            if (moved < kConverged || (moved < kRounding && moved > 0.5 * before)) {
                fillResidual();
                return true;
            }
            slow_ = moved > 0.2 * before;
            before = moved;
        }
        return false;
    }

  private:
    std::size_t row(std::size_t p) const { return kBlock * (p - shape_.firstFree); }
    Vec3d gradient(const std::vector<Vec3d>& x, std::size_t s) const {
        return (x[s + 1] - x[s]) / shape_.lengths[s];
    }

    void fillResidual() {
        for (std::size_t p = 0; p < shape_.points(); ++p) {
            xm_[p] = x0_[p] + weight_ * (x1_[p] - x0_[p]);
            vm_[p] = (x1_[p] - x0_[p]) / h_;
        }
        work_.force.assign(shape_.points(), Vec3d::Zero());
        addForces(physics_, shape_, xm_, vm_, around_, work_.force);
        for (std::size_t p = shape_.firstFree; p < shape_.points(); ++p) {
            const std::size_t i = row(p), s = p - 1;
            Vec3d left =
                shape_.masses[p] * (x1_[p] - x0_[p] - h_ * v0_[p]) - weight_ * h_ * h_ * work_.force[p];
            if (physics_.lengthHeld) {
                left -= gradient(x0_, s) * work_.multipliers[s];
                if (p < shape_.segments()) left += gradient(x0_, p) * work_.multipliers[p];
            }
            const double length = shape_.lengths[s];
            work_.rightSide[i] =
                physics_.lengthHeld ? -0.5 * ((x1_[p] - x1_[s]).squaredNorm() / length - length) : 0.0;
            for (int c = 0; c < 3; ++c) work_.rightSide[i + 1 + static_cast<std::size_t>(c)] = -left[c];
        }
    }

    void addBlock(std::size_t p, std::size_t q, const Eigen::Matrix3d& block) {
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                if (block(a, b) == 0.0) continue;
                work_.matrix.at(row(p) + 1 + static_cast<std::size_t>(a),
                                row(q) + 1 + static_cast<std::size_t>(b)) += block(a, b);
            }
        }
    }

    void fillMatrix() {
        struct Sink final : BlockSink {
            StepSolve* solve;
            explicit Sink(StepSolve* s) : solve(s) {}
            void add(std::size_t p, std::size_t q, const Eigen::Matrix3d& block) override {
                solve->addBlock(p, q, block);
            }
        } sink(this);
        work_.matrix.setZero();
        addDerivatives(physics_, shape_, xm_, vm_, around_, weight_ * weight_ * h_ * h_, weight_ * h_, sink);
        for (std::size_t p = shape_.firstFree; p < shape_.points(); ++p) {
            addBlock(p, p, shape_.masses[p] * Eigen::Matrix3d::Identity());
            fillConstraint(p);
        }
    }

    /// Row of the segment before p, and the columns of its multiplier.
    void fillConstraint(std::size_t p) {
        const std::size_t i = row(p), s = p - 1;
        if (!physics_.lengthHeld) {
            work_.matrix.at(i, i) = 1.0;
            return;
        }
        const Vec3d end = gradient(x1_, s), start = gradient(x0_, s);
        for (int c = 0; c < 3; ++c) {
            const std::size_t k = i + 1 + static_cast<std::size_t>(c);
            work_.matrix.at(i, k) = end[c];
            work_.matrix.at(k, i) = -start[c];
            if (s < shape_.firstFree) continue;
            work_.matrix.at(i, k - kBlock) = -end[c];
            work_.matrix.at(k - kBlock, i) = start[c];
        }
    }

    /// Adds the solved corrections; the largest of them.
    double apply() {
        double largest = 0.0;
        for (std::size_t p = shape_.firstFree; p < shape_.points(); ++p) {
            const std::size_t i = row(p);
            if (physics_.lengthHeld) work_.multipliers[p - 1] += work_.rightSide[i];
            const Vec3d move{work_.rightSide[i + 1], work_.rightSide[i + 2], work_.rightSide[i + 3]};
            x1_[p] += move;
            const double size = move.cwiseAbs().maxCoeff();
            if (!(size <= largest)) largest = size;  // keeps a NaN
        }
        return largest;
    }

    const Physics& physics_;
    const StrandShape& shape_;
    double h_;
    double weight_;
    const Environment& around_;
    const std::vector<Vec3d>&x0_, &v0_;
    std::vector<Vec3d>& x1_;
    Workspace& work_;
    std::vector<Vec3d> xm_, vm_;
    bool slow_ = false;
};

}  // namespace

bool substep(const Physics& physics, const StrandShape& shape, double h, double weight,
             const Environment& around, const ClampedEnd& end, StrandState& state, Workspace& work) {
    std::vector<Vec3d> x1(shape.points());
    for (std::size_t p = 0; p < shape.points(); ++p)
        x1[p] = p < shape.firstFree ? end.x[p] : Vec3d(state.x[p] + h * state.v[p]);
    bool converged = true;
    if (shape.firstFree < shape.points())
        converged = StepSolve(physics, shape, h, weight, around, state, x1, work).run();
    for (std::size_t p = 0; p < shape.points(); ++p) {
        if (p < shape.firstFree) {
            state.v[p] = end.v[p];
        } else {
            state.v[p] = (x1[p] - state.x[p]) / h + ((1.0 - weight) * h / shape.masses[p]) * work.force[p];
        }
    }
    state.x = std::move(x1);
    if (!physics.lengthHeld || shape.firstFree >= shape.points()) return converged;
    projectVelocities(shape, state.x, state.v);
    return converged && largestStretch(shape, state.x) < 1e-12;
}

}  // namespace hairloom::reference
