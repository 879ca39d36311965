// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/rod_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "core/simulation/reference/collocation.h"
#include "core/simulation/reference/lengths.h"
#include "core/simulation/reference/rod_forces.h"

namespace hairloom::reference {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kBlock =
    9;  // unknowns of a free segment: λ, its turn, then the position of its outer point
constexpr std::size_t kBand = 11;
constexpr int kMaxIterations = 60;
constexpr int kStalled = 15;          // iterations without a smaller correction: it goes round in circles
constexpr double kConverged = 1e-12;  // radians and mean segments
constexpr double kRounding = 1e-10;   // smaller corrections that no longer shrink are rounding errors
/// Of the twist of segments that nothing holds, in the Jacobian alone.
constexpr double kLoose = 1e-6;
constexpr double kLargestTurn = 0.7;  // radians, of a correction

/// A stage, and the equations' remainders there.
struct Stage {
    Quaterniond root;
    Vec3d rootVelocity;
    double time;
    std::vector<ColliderNow> colliders;
    std::vector<Vec3d> x, v;            // of points
    std::vector<Quaterniond> rotation;  // of segments
    std::vector<Vec3d> tension;
    std::vector<Quaterniond> relative;  // of vertices
    std::vector<Vec3d> strain;
    std::vector<VertexMoment> moments;  // of free vertices
    std::vector<PointForce> forces;     // of free points
    Eigen::VectorXd left;
};

/// Newton's iteration on all stages together, with one Jacobian for all, so that it falls apart into one
/// matrix for each eigenvalue of the collocation.
class RodStep {
  public:
    RodStep(const Physics& physics, const StrandShape& body, const RodShape& rod, std::size_t stages,
            const RootPath& path, double from, double to, const StrandState& state, const RodMotion& motion,
            RodWorkspace& work)
        : physics_(physics),
          body_(body),
          rod_(rod),
          scheme_(Collocation::radau(stages)),
          state_(state),
          motion_(motion),
          work_(work),
          h_((to - from) * path.dt),
          first_(body.firstFree - 1),
          segments_(body.segments()),
          length_(std::accumulate(body.lengths.begin(), body.lengths.end(), 0.0) /
                  static_cast<double>(body.segments())),
          force_(length_ / (h_ * h_)),
          loose_(std::ranges::any_of(std::span(rod.stiffness).subspan(first_),
                                     [](double stiffness) { return !(stiffness > 0.0); })) {
        work_.matrices.resize(stages);
        for (ComplexBandedMatrix& matrix : work_.matrices) matrix.resize(kBlock * free(), kBand);
        const Quaterniond root = path.rotation(from);
        for (std::size_t j = 0; j < segments_; ++j) {
            start_.push_back(relativeRotation(j > 0 ? motion.rotation[j - 1] : root, motion.rotation[j],
                                              Quaterniond::Identity()));
        }
        for (const double place : scheme_.places) guess(path, from + place * (to - from), place * h_);
    }

    bool run() {
        double before = std::numeric_limits<double>::infinity(), smallest = before;
        int sinceSmallest = 0;
        bool slow = true;
        for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
            fillRemainders();
            if (iteration < 1 || slow) {
                for (std::size_t k = 0; k < stages_.size(); ++k)
                    if (needed(k) && !fillMatrix(k)) return false;
            }
            const double moved = correct();
            if (!std::isfinite(moved)) return false;
            if (moved < kConverged || (moved < kRounding && moved > 0.5 * before)) return true;
            sinceSmallest = moved < smallest ? 0 : sinceSmallest + 1;
            if (sinceSmallest == kStalled) return false;
            smallest = std::min(smallest, moved);
            slow = moved > 0.1 * before || moved > 0.3;
            before = moved;
        }
        return false;
    }

    /// The end of the step is the last stage.
    RodStepResult take(StrandState& state, RodMotion& motion) const {
        const Stage& end = stages_.back();
        RodStepResult result{true};
        for (const PointForce& force : end.forces) {
            result.contacts += force.touches ? 1 : 0;
            result.penetration = std::max(result.penetration, force.penetration);
        }
        for (std::size_t j = 0; j < segments_; ++j) {
            motion.spin[j] = turnOf(end.rotation[j] * motion.rotation[j].conjugate()) / h_;
            motion.rotation[j] = end.rotation[j].normalized();
        }
        motion.tension = end.tension;
        state.x = end.x;
        for (std::size_t p = body_.firstFree; p < body_.points(); ++p)
            state.x[p] =
                state.x[p - 1] + body_.lengths[p - 1] * (motion.rotation[p - 1] * rod_.tangent[p - 1]);
        state.v = end.v;
        return result;
    }

  private:
    std::size_t free() const { return segments_ - first_; }
    std::size_t row(std::size_t j) const { return kBlock * (j - first_); }
    /// Of a pair of conjugate eigenvalues one tells all.
    bool needed(std::size_t k) const { return scheme_.values[static_cast<Eigen::Index>(k)].imag() >= 0.0; }
    double rate(std::size_t i, std::size_t k) const {
        return scheme_.rates(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) / h_;
    }
    const Quaterniond& inner(const Stage& stage, std::size_t j) const {
        return j > first_ ? stage.rotation[j - 1] : stage.root;
    }
    Vec3d tangent(const Stage& stage, std::size_t j) const { return stage.rotation[j] * rod_.tangent[j]; }

    /// Segments go on turning as in the last step.
    void guess(const RootPath& path, double share, double after) {
        Stage stage;
        stage.root = path.rotation(share);
        stage.rootVelocity = path.velocity();
        stage.time = path.time(share);
        stage.colliders = path.colliders(share);
        stage.x = path.clamped(body_, share).x;
        stage.tension = motion_.tension;
        stage.relative = start_;
        stage.strain.assign(segments_, Vec3d::Zero());
        for (std::size_t j = 0; j < segments_; ++j) {
            const bool turns = j >= first_;
            stage.rotation.push_back(turns ? turnBy(after * motion_.spin[j]) * motion_.rotation[j]
                                           : stage.root);
            if (turns) stage.x.push_back(stage.x[j] + body_.lengths[j] * tangent(stage, j));
        }
        stage.v.assign(body_.points(), Vec3d::Zero());
        stage.left.resize(static_cast<Eigen::Index>(kBlock * free()));
        stages_.push_back(std::move(stage));
    }

    void fillRates() {
        for (std::size_t i = 0; i < stages_.size(); ++i) {
            Stage& stage = stages_[i];
            for (std::size_t p = body_.firstFree; p < body_.points(); ++p) {
                stage.v[p].setZero();
                for (std::size_t k = 0; k < stages_.size(); ++k)
                    stage.v[p] += rate(i, k) * (stages_[k].x[p] - state_.x[p]);
            }
            for (std::size_t j = first_; j < segments_; ++j) {
                stage.relative[j] = relativeRotation(inner(stage, j), stage.rotation[j], start_[j]);
                stage.strain[j] = 2.0 * stage.relative[j].vec();
            }
        }
    }

    void fillRemainders() {
        fillRates();
        for (std::size_t i = 0; i < stages_.size(); ++i) {
            Stage& stage = stages_[i];
            const Environment around{stage.time, stage.root, stage.rootVelocity, stage.colliders};
            stage.moments.clear();
            stage.forces.clear();
            for (std::size_t j = first_; j < segments_; ++j) {
                Vec3d strainRate = Vec3d::Zero();
                for (std::size_t k = 0; k < stages_.size(); ++k)
                    strainRate += rate(i, k) * (stages_[k].strain[j] - 2.0 * start_[j].vec());
                stage.moments.emplace_back(rod_.elasticity(j), rod_.dampingTime, inner(stage, j),
                                           stage.relative[j], strainRate);
                stage.forces.push_back(pointForce(physics_, body_, j + 1, stage.x[j + 1], stage.v[j + 1],
                                                  tangent(stage, j), around, h_));
            }
            for (std::size_t j = first_; j < segments_; ++j) fillRemainder(stage, i, j);
        }
    }

    void fillRemainder(Stage& stage, std::size_t i, std::size_t j) {
        const Vec3d along = body_.lengths[j] * tangent(stage, j);
        Vec3d torque = stage.moments[j - first_].world - along.cross(stage.tension[j]);
        if (j + 1 < segments_) torque -= stage.moments[j + 1 - first_].world;
        Vec3d acceleration = Vec3d::Zero();
        for (std::size_t k = 0; k < stages_.size(); ++k)
            acceleration += rate(i, k) * (stages_[k].v[j + 1] - state_.v[j + 1]);
        Vec3d force = body_.masses[j + 1] * acceleration - stage.forces[j - first_].force + stage.tension[j];
        if (j + 1 < segments_) force -= stage.tension[j + 1];
        const auto at = static_cast<Eigen::Index>(row(j));
        stage.left.segment<3>(at) = (stage.x[j + 1] - stage.x[j] - along) / length_;
        stage.left.segment<3>(at + 3) = torque / (force_ * length_);
        stage.left.segment<3>(at + 6) = force / force_;
    }

    /// In units of the mean length, its force and radians; derivatives as in the middle stage, those of the
    /// forces from outside as in the mean of all.
    bool fillMatrix(std::size_t k) {
        const Stage& stage = stages_[stages_.size() / 2];
        const Complex pace = scheme_.values[static_cast<Eigen::Index>(k)] / h_;
        ComplexBandedMatrix& matrix = work_.matrices[k];
        matrix.setZero();
        const auto add = [&](std::size_t r, std::size_t c, const Eigen::Matrix3cd& block) {
            for (int a = 0; a < 3; ++a) {
                for (int b = 0; b < 3; ++b) {
                    if (block(a, b) != Complex{})
                        matrix.at(r + static_cast<std::size_t>(a), c + static_cast<std::size_t>(b)) +=
                            block(a, b);
                }
            }
        };
        const Eigen::Matrix3cd one = Eigen::Matrix3cd::Identity();
        const double torqueUnit = 1.0 / (force_ * length_);
        for (std::size_t j = first_; j < segments_; ++j) {
            const std::size_t r = row(j);
            const bool clamped = j == first_, last = j + 1 == segments_;
            const Eigen::Matrix3d along = crossMatrix(body_.lengths[j] * tangent(stage, j));
            add(r, r + 3, (along / length_).cast<Complex>());
            add(r, r + 6, one);
            if (!clamped) add(r, r + 6 - kBlock, -one);

            add(r + 3, r, (-along / length_).cast<Complex>());
            add(r + 3, r + 3, (-torqueUnit * crossMatrix(stage.tension[j]) * along).cast<Complex>());
            const VertexMoment& moment = stage.moments[j - first_];
            const Eigen::Matrix3cd bend =
                torqueUnit * (moment.elastic.cast<Complex>() + pace * moment.viscous.cast<Complex>());
            add(r + 3, r + 3, bend);
            if (loose_) add(r + 3, r + 3, kLoose * one);
            if (!clamped) {
                const std::size_t i = r - kBlock;
                const Eigen::Matrix3cd carried =
                    bend + (torqueUnit * crossMatrix(moment.world)).cast<Complex>();
                add(r + 3, i + 3, -carried);
                add(i + 3, r + 3, -bend);
                add(i + 3, i + 3, carried);
            }

            add(r + 6, r, one);
            if (!last) add(r + 6, r + kBlock, -one);
            Eigen::Matrix3d position = Eigen::Matrix3d::Zero(), speed = Eigen::Matrix3d::Zero();
            for (const Stage& each : stages_) {
                position += each.forces[j - first_].place;
                speed += each.forces[j - first_].speed;
            }
            const double share = h_ * h_ / static_cast<double>(stages_.size());
            add(r + 6, r + 6,
                body_.masses[j + 1] * h_ * h_ * pace * pace * one +
                    share * (position.cast<Complex>() + pace * speed.cast<Complex>()));
        }
        return matrix.factor();
    }

    /// Solves for the corrections and adds them; the largest of them.
    double correct() {
        const std::size_t count = stages_.size(), size = kBlock * free();
        std::vector<Eigen::VectorXd> changes(count, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size)));
        for (std::size_t k = 0; k < count; ++k) {
            if (!needed(k)) continue;
            const auto column = static_cast<Eigen::Index>(k);
            std::vector<Complex>& solution = work_.solution;
            solution.assign(size, Complex{});
            for (std::size_t i = 0; i < count; ++i) {
                const Complex share = scheme_.inverseVectors(column, static_cast<Eigen::Index>(i));
                for (std::size_t r = 0; r < size; ++r)
                    solution[r] -= share * stages_[i].left[static_cast<Eigen::Index>(r)];
            }
            work_.matrices[k].solve(solution);
            const double twice = scheme_.values[column].imag() > 0.0 ? 2.0 : 1.0;
            for (std::size_t i = 0; i < count; ++i) {
                const Complex share = twice * scheme_.vectors(static_cast<Eigen::Index>(i), column);
                for (std::size_t r = 0; r < size; ++r)
                    changes[i][static_cast<Eigen::Index>(r)] +=
                        share.real() * solution[r].real() - share.imag() * solution[r].imag();
            }
        }
        return apply(changes);
    }

    double apply(const std::vector<Eigen::VectorXd>& changes) {
        double turned = 0.0, moved = 0.0;
        for (const Eigen::VectorXd& change : changes) {
            if (!change.allFinite()) return std::numeric_limits<double>::infinity();
            for (std::size_t j = first_; j < segments_; ++j) {
                const auto at = static_cast<Eigen::Index>(row(j));
                turned = std::max(turned, change.segment<3>(at + 3).cwiseAbs().maxCoeff());
                moved = std::max(moved, change.segment<3>(at + 6).cwiseAbs().maxCoeff());
            }
        }
        const double share = turned > kLargestTurn ? kLargestTurn / turned : 1.0;
        for (std::size_t i = 0; i < changes.size(); ++i) {
            Stage& stage = stages_[i];
            for (std::size_t j = first_; j < segments_; ++j) {
                const auto at = static_cast<Eigen::Index>(row(j));
                stage.tension[j] += share * force_ * changes[i].segment<3>(at);
                stage.rotation[j] =
                    (turnBy(share * changes[i].segment<3>(at + 3)) * stage.rotation[j]).normalized();
                stage.x[j + 1] += share * length_ * changes[i].segment<3>(at + 6);
            }
        }
        return std::max(turned, moved);
    }

    const Physics& physics_;
    const StrandShape& body_;
    const RodShape& rod_;
    const Collocation& scheme_;
    const StrandState& state_;
    const RodMotion& motion_;
    RodWorkspace& work_;
    double h_;
    std::size_t first_, segments_;
    double length_, force_;           // units
    bool loose_;                      // a vertex has no stiffness
    std::vector<Quaterniond> start_;  // p of vertices at the start
    std::vector<Stage> stages_;
};

}  // namespace

RodMotion rodAtRest(const RodShape& rod, const Quaterniond& root) {
    RodMotion motion;
    for (const Quaterniond& rest : rod.atRest) motion.rotation.push_back(root * rest);
    motion.spin.assign(rod.atRest.size(), Vec3d::Zero());
    motion.tension.assign(rod.atRest.size(), Vec3d::Zero());
    return motion;
}

void turnToPoints(const StrandShape& body, const RodShape& rod, const std::vector<Vec3d>& x,
                  RodMotion& motion) {
    for (std::size_t j = body.firstFree - 1; j < body.segments(); ++j) {
        const Vec3d now = motion.rotation[j] * rod.tangent[j];
        const Quaterniond turn = Quaterniond::FromTwoVectors(now, x[j + 1] - x[j]);
        for (std::size_t k = j; k < body.segments(); ++k)
            motion.rotation[k] = (turn * motion.rotation[k]).normalized();
    }
}

double elasticEnergy(const StrandShape& body, const RodShape& rod, const Quaterniond& root,
                     const RodMotion& motion) {
    double sum = 0.0;
    const std::size_t first = body.firstFree - 1;
    for (std::size_t j = first; j < body.segments(); ++j) {
        const Quaterniond& inner = j > first ? motion.rotation[j - 1] : root;
        const Vec3d strain = 2.0 * (inner.conjugate() * motion.rotation[j]).vec();
        sum += 0.5 * strain.dot(rod.elasticity(j) * strain);
    }
    return sum;
}

RodStepResult stepRod(const Physics& physics, const StrandShape& body, const RodShape& rod,
                      std::size_t stages, const RootPath& path, double from, double to, StrandState& state,
                      RodMotion& motion, RodWorkspace& work) {
    const ClampedEnd end = path.clamped(body, to);
    if (body.firstFree >= body.points()) {
        state.x = end.x;
        state.v = end.v;
        return {true};
    }
    RodStep step(physics, body, rod, stages, path, from, to, state, motion, work);
    if (!step.run()) return {false};
    const RodStepResult result = step.take(state, motion);
    std::copy(end.v.begin(), end.v.end(), state.v.begin());
    projectVelocities(body, state.x, state.v);
    return result;
}

}  // namespace hairloom::reference
