// SPDX-License-Identifier: GPL-3.0-or-later
// The alternatives of Rünz 2012, Section 3.1, measured from their points alone.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/hash.h"
#include "core/simulation/body_push.h"
#include "core/simulation/strand_method.h"
#include "hairloom/alternatives/projective_equations.h"
#include "hairloom/alternatives/rigid_chains.h"
#include "hairloom/capsules.h"
#include "hairloom/wind.h"

namespace hairloom {
namespace {

Vec3d toDouble(const runtime::Float3& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Points after a step, and what measure() tells of them.
class MeasuredPoints {
  public:
    explicit MeasuredPoints(const SceneInput& scene)
        : groom_(scene.groom()), now_(groom_.pointCount()), before_(groom_.pointCount()) {}

    std::vector<runtime::Float3>& startStep(const runtime::FrameInput& input) {
        before_.swap(now_);
        spheres_.assign(input.spheres.begin(), input.spheres.end());
        runtime::appendCapsules(input.capsules, spheres_);
        dt_ = static_cast<double>(input.dt);
        return now_;
    }
    std::vector<runtime::Float3>& rest() { return now_; }

    /// As Engine::measure; speeds are those over the whole frame.
    runtime::Measurements measure() const {
        runtime::Measurements result;
        for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
            for (std::uint32_t p = groom_.offsets[s]; p < groom_.offsets[s + 1]; ++p) addPoint(s, p, result);
        }
        return result;
    }
    std::uint64_t hash() const { return hashOf(std::span<const runtime::Float3>(now_)); }

  private:
    void addPoint(std::size_t s, std::uint32_t p, runtime::Measurements& result) const {
        const runtime::SimulationSettings& settings = groom_.simulation;
        const std::uint32_t first = groom_.offsets[s], along = p - first;
        const Vec3d at = toDouble(now_[p]);
        if (!at.allFinite()) {
            ++result.nanCount;
            return;
        }
        if (along > 0) {
            const auto rest = groom_.strand(s);
            const double length = static_cast<double>((rest[along] - rest[along - 1]).norm());
            if (length > 1e-9) {
                result.maxStretch =
                    std::max(result.maxStretch, std::abs((at - toDouble(now_[p - 1])).norm() / length - 1));
            }
        }
        if (along < settings.clampedPoints) return;
        result.potentialEnergy -= toDouble(settings.gravity).dot(at);
        if (dt_ > 0) result.kineticEnergy += 0.5 * (at - toDouble(before_[p])).squaredNorm() / (dt_ * dt_);
        const double share =
            static_cast<double>(along) / static_cast<double>(groom_.offsets[s + 1] - first - 1);
        const double collisionRadius = (1 - share) * static_cast<double>(settings.collisionRadiusRoot) +
                                       share * static_cast<double>(settings.collisionRadiusTip);
        for (const runtime::Sphere& sphere : spheres_) {
            const double depth = static_cast<double>(sphere.radius) + collisionRadius -
                                 (at - toDouble(sphere.center_ws)).norm();
            if (sphere.radius > 0) result.maxPenetration = std::max(result.maxPenetration, depth);
        }
    }

    Groom groom_;
    std::vector<runtime::Float3> now_, before_;
    std::vector<runtime::Sphere> spheres_;
    double dt_ = 0;
};

/// What the alternatives share: a solver that is timed as a whole.
class AlternativeMethod : public StrandMethod {
  public:
    AlternativeMethod(const SceneInput& scene, EffectReport effect)
        : points_(scene), effect_(std::move(effect)), host_(applicationHost()) {}

    void reset(const SceneInput& scene, const HeadPose& pose) override {
        place(scene, pose);
        readPositions(points_.rest());
    }
    void step(const SceneInput& scene, const HeadPose& pose, const runtime::FrameInput& input) override {
        std::vector<runtime::Float3>& positions_ws = points_.startStep(input);
        const std::uint64_t begin = host_.nanoseconds();
        advance(scene, pose, input);
        readPositions(positions_ws);
        milliseconds_ = 1e-6 * static_cast<double>(host_.nanoseconds() - begin);
        ++frames_;
        const double mean = effect_.milliseconds.value_or(0);
        effect_.milliseconds = mean + (milliseconds_ - mean) / static_cast<double>(frames_);
    }
    double stepMilliseconds() const override { return milliseconds_; }
    runtime::Measurements measure() const override { return points_.measure(); }
    std::uint64_t stateHash() const override { return points_.hash(); }
    std::vector<EffectReport> effects() const override { return {effect_}; }

  protected:
    virtual void place(const SceneInput& scene, const HeadPose& pose) = 0;
    virtual void advance(const SceneInput& scene, const HeadPose& pose, const runtime::FrameInput& input) = 0;

  private:
    MeasuredPoints points_;
    EffectReport effect_;
    runtime::Host host_;
    std::uint64_t frames_ = 0;
    double milliseconds_ = 0;
};

/// Strands of rigid segments: projective equations and rigid chains.
template <class Solver>
class SegmentMethod : public AlternativeMethod {
  public:
    SegmentMethod(const SceneInput& scene, std::string name, Solver solver)
        : AlternativeMethod(scene, {std::move(name), true,
                                    fmt::format("on, {} substeps", scene.groom().simulation.substeps), 0, 0}),
          solver_(std::move(solver)) {}
    void readPositions(std::span<runtime::Float3> positions_ws) const override {
        solver_.readPositions(positions_ws);
    }
    bool readVelocities(std::span<runtime::Float3> velocities_ws) const override {
        solver_.readVelocities(velocities_ws);
        return true;
    }
    Status setStyle(std::span<const runtime::Float3> restPositions_ss) override {
        if constexpr (requires { solver_.setStyle(restPositions_ss); }) {
            if (const std::string why = solver_.setStyle(restPositions_ss); !why.empty())
                return tl::unexpected(errorOfWords(why));
            return {};
        }
        return StrandMethod::setStyle(restPositions_ss);
    }

  protected:
    void place(const SceneInput& scene, const HeadPose& pose) override { solver_.reset(scene.rootsAt(pose)); }
    void advance(const SceneInput&, const HeadPose&, const runtime::FrameInput& input) override {
        solver_.step(input);
    }

  private:
    Solver solver_;
};

template <class Solver>
Result<std::unique_ptr<StrandMethod>> makeSegmentMethod(const SceneInput& scene, std::string name) {
    auto made = Solver::make(scene.strands(), scene.groom().simulation, applicationHost());
    if (!made.engine) return tl::unexpected(errorOfWords(made.error));
    return std::make_unique<SegmentMethod<Solver>>(scene, std::move(name), std::move(*made.engine));
}

class LatticeMethod : public AlternativeMethod {
  public:
    LatticeMethod(const SceneInput& scene, runtime::Lattice solver)
        : AlternativeMethod(
              scene, {"lattice", true, fmt::format("on, {} control points", solver.controlPointCount()), 0,
                      solver.stepBytes()}),
          solver_(std::move(solver)),
          groom_(scene.groom()),
          push_(makeBodyPush(groom_, groom_.offsets.view(), groom_.positions())) {}
    void readPositions(std::span<runtime::Float3> positions_ws) const override {
        solver_.evaluate(positions_ws);
        static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
        if (push_)
            pushOutOfBody(*push_, groom_, pose_,
                          {reinterpret_cast<Vec3f*>(positions_ws.data()), positions_ws.size()});
    }

  protected:
    void place(const SceneInput& scene, const HeadPose& pose) override {
        solver_.reset(scene.headAt(pose));
        pose_ = pose;
    }
    void advance(const SceneInput& scene, const HeadPose& pose, const runtime::FrameInput& input) override {
        std::vector<runtime::Sphere> spheres(input.spheres.begin(), input.spheres.end());
        runtime::appendCapsules(input.capsules, spheres);
        solver_.step(scene.headAt(pose), input.dt, spheres);
        pose_ = pose;
    }

  private:
    runtime::Lattice solver_;
    Groom groom_;
    std::optional<runtime::BodyPush> push_;  ///< out of the skin, of what is shown
    HeadPose pose_;
};

}  // namespace

runtime::LatticeSettings latticeSettings(const runtime::SimulationSettings& settings) {
    runtime::LatticeSettings lattice;
    lattice.gravity = settings.gravity;
    lattice.airDrag = settings.airDrag;
    lattice.wind = runtime::makeWind(settings).mean;
    lattice.dampingTime = settings.dampingTime;
    lattice.teleportDistance = settings.teleportDistance;
    lattice.substeps = std::min(settings.substeps, 64u);
    lattice.nodes = settings.latticeNodes;
    lattice.rootFrequency = settings.latticeRootFrequency;
    lattice.tipFrequency = settings.latticeTipFrequency;
    lattice.couplingFrequency = settings.latticeCouplingFrequency;
    lattice.clampedPoints = settings.clampedPoints;
    lattice.collisionRadiusRoot = settings.collisionRadiusRoot;
    lattice.collisionRadiusTip = settings.collisionRadiusTip;
    return lattice;
}

Result<std::unique_ptr<StrandMethod>> makeProjectiveMethod(const SceneInput& scene) {
    return makeSegmentMethod<runtime::ProjectiveEquations>(scene, "projective equations");
}

Result<std::unique_ptr<StrandMethod>> makeChainMethod(const SceneInput& scene) {
    return makeSegmentMethod<runtime::RigidChains>(scene, "rigid chains");
}

Result<std::unique_ptr<StrandMethod>> makeLatticeMethod(const SceneInput& scene) {
    const runtime::SimulationSettings& settings = scene.groom().simulation;
    for (const std::string& problem : runtime::validate(settings))
        return tl::unexpected(errorOfWords(problem));
    auto made = runtime::Lattice::make(scene.strands(), latticeSettings(settings), applicationHost());
    if (!made.lattice) return tl::unexpected(errorOfWords(made.error));
    return std::make_unique<LatticeMethod>(scene, std::move(*made.lattice));
}

}  // namespace hairloom
