// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the comparisons with double precision share: strands in a state, the forces of
// core/simulation/reference on them, and one substep on the device and by the stages of the CPU beside what
// it should be.

#include <Eigen/Dense>
#include <algorithm>
#include <functional>
#include <vector>

#include "core/simulation/reference/forces.h"
#include "core/simulation/reference/solver.h"
#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::gpu_simulation::test {

using Eigen::Vector3d;
using runtime::SimulationSettings;
using runtime::springSettings;
using Positions = std::vector<Vector3d>;  // of one strand

inline constexpr double kSubstep = static_cast<double>(test::kStep);
inline constexpr std::uint32_t kReferencePoints[] = {12};

/// Places relative to the root, and displacements in the last substep.
struct Strand {
    Positions positions, moved;
};

inline std::vector<Strand> strandsOf(const Scene& scene, const runtime::State& state) {
    std::vector<Strand> strands(scene.offsets.size() - 1);
    for (const runtime::Block& block : scene.shape->blocks) {
        const float* const planes = state.planes.data() + block.firstPlane * runtime::kStatePlanes;
        const std::size_t size = planeSize(block);
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            Strand& strand = strands[block.strandOfLane[lane]];
            for (std::uint32_t p = 0; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * runtime::kBlockLanes + lane;
                const auto at = [&](std::size_t plane) {
                    const float* const v = planes + plane * size + i;
                    return Vector3d(v[0], v[size], v[2 * size]);
                };
                strand.positions.push_back(at(0));
                strand.moved.push_back(at(0) - at(3));
            }
        }
    }
    return strands;
}

/// Strands whose roots rest, in a state that is random, or nasty too.
inline Scene sceneFor(const SimulationSettings& settings, Hair rest, bool nasty, std::size_t spheres,
                      float shift = 0.002f) {
    Scene scene = test::makeScene(settings, rest, 23, kReferencePoints, shift);
    test::Dice dice(5);
    if (nasty) test::disturb(scene, Hair::nasty, dice);
    scene.roots = scene.shape->restRoots;
    scene.spheres = {{{0.0f, -0.05f, 0.0f}, 0.06f}};
    scene.spheres.resize(spheres);
    scene.state.spheres = scene.spheres;
    return scene;
}

inline SimulationSettings nothing() {
    SimulationSettings s = springSettings();
    s.substeps = 1;
    // Explicit springs bend without damping.
    s.dampingTime = s.bendDampingTime = s.airDrag = s.angularStiffness = s.sleepSpeed = 0.0f;
    s.gravity = {};
    s.lengthIterations = 0;
    return s;
}

/// The strands of a scene as the reference has them.
class Bodies {
  public:
    Bodies(const Scene& scene, const SimulationSettings& settings)
        : scene_(scene),
          settings_(settings),
          solver_(reference::Solver::make(reference::strandsOf(scene.view()), settings).value()) {}

    const reference::StrandShape& shape(std::size_t s) const { return solver_.shape(s); }
    /// Forces by the unit of mass at positions relative to the root, for displacements in a substep, m/s².
    Positions forces(std::size_t s, const Positions& positions, const Positions& moved,
                     const reference::Physics& physics) const {
        Positions x, v, force(positions.size(), Vector3d::Zero());
        for (std::size_t p = 0; p < positions.size(); ++p) {
            x.push_back(root(s) + positions[p]);
            v.emplace_back(moved[p] / kSubstep);
        }
        const auto colliders = collidersNow();
        reference::addForces(physics, shape(s), x, v, around(colliders), force);
        return force;
    }
    /// And what they add to the displacement.
    Positions added(std::size_t s, const Positions& positions, const Positions& moved,
                    const reference::Physics& physics) const {
        Positions force = forces(s, positions, moved, physics);
        for (std::size_t p = 0; p < force.size(); ++p) force[p] *= kSubstep * kSubstep / shape(s).masses[p];
        return force;
    }
    /// Minus the derivative of the forces by the positions, rows and columns of x, y and z of all points.
    Eigen::MatrixXd stiffness(std::size_t s, const Positions& positions) const;
    const SimulationSettings& settings() const { return settings_; }

  private:
    Vector3d root(std::size_t s) const {
        const runtime::Float3 position = scene_.roots[s].position;
        return {position.x, position.y, position.z};
    }
    std::vector<reference::ColliderNow> collidersNow() const {
        std::vector<reference::ColliderNow> colliders;
        for (const runtime::Sphere& sphere : scene_.spheres) {
            const runtime::Float3 c = sphere.center_ws;
            colliders.push_back({{{c.x, c.y, c.z}, Vector3d::Zero(), sphere.radius}});
        }
        return colliders;
    }
    static reference::Environment around(std::span<const reference::ColliderNow> colliders) {
        return {0.7, Eigen::Quaterniond::Identity(), Vector3d::Zero(), colliders};
    }

    const Scene& scene_;
    SimulationSettings settings_;
    reference::Solver solver_;
};

inline Eigen::MatrixXd Bodies::stiffness(std::size_t s, const Positions& positions) const {
    class Dense final : public reference::BlockSink {
      public:
        explicit Dense(Eigen::Index points) : matrix(Eigen::MatrixXd::Zero(3 * points, 3 * points)) {}
        void add(std::size_t p, std::size_t q, const Eigen::Matrix3d& block) override {
            matrix.block<3, 3>(3 * static_cast<Eigen::Index>(p), 3 * static_cast<Eigen::Index>(q)) += block;
        }
        Eigen::MatrixXd matrix;
    };
    Dense sink(static_cast<Eigen::Index>(positions.size()));
    reference::Physics physics(settings_);
    physics.bendDampingTime = 0.0;
    Positions x;
    for (const Vector3d& position : positions) x.emplace_back(root(s) + position);
    const Positions rest(positions.size(), Vector3d::Zero());
    reference::addDerivatives(physics, shape(s), x, rest, around({}), 1.0, 0.0, sink);
    return sink.matrix;
}

inline double farthest(const Positions& a, const Positions& b, std::size_t first) {
    double maximum = 0.0;
    for (std::size_t p = first; p < a.size(); ++p) maximum = std::max(maximum, (a[p] - b[p]).norm());
    return maximum;
}

/// What hold() may compare.
inline Positions positionsOf(const Strand&, const Strand& after) {
    return after.positions;
}
inline Positions movesOf(const Strand&, const Strand& after) {
    return after.moved;
}

class Reference : public GpuSimulationTest {
  protected:
    /// What the device and the CPU make of a substep, against `truth` of each strand before it; `of` picks
    /// what is compared.
    void hold(const Scene& scene, const std::function<Positions(std::size_t, const Strand&)>& groundTruth,
              const std::function<Positions(const Strand&, const Strand&)>& of, double share) {
        const std::vector<Strand> before = strandsOf(scene, scene.state);
        const std::vector<Strand> cpu = strandsOf(scene, test::runOnCpu(scene));
        for (const LayoutOptions& layout : kHeldLayouts) {
            SCOPED_TRACE(nameOf(layout));
            StrandEngine engine = engineOf(scene.view(), scene.settings, options(layout));
            ASSERT_TRUE(engine.writeState(scene.state));
            ASSERT_TRUE(engine.step(scene.input()));
            const std::vector<Strand> gpu = strandsOf(scene, engine.readState().value());
            const std::size_t first = scene.settings.clampedPoints;
            for (std::size_t s = 0; s < before.size(); ++s) {
                const Positions exact = groundTruth(s, before[s]);
                const double off = farthest(of(before[s], gpu[s]), exact, first);
                const double offOnCpu = farthest(of(before[s], cpu[s]), exact, first);
                double size = 0.0;
                for (const Vector3d& v : exact) size = std::max(size, v.norm());
                // Places of a strand's size round to 2e-8 m, a few times.
                EXPECT_LE(off, 4.0 * offOnCpu + 2e-7) << "strand " << s;
                if (share > 0.0) {
                    EXPECT_LE(off, share * size + 1e-7) << "strand " << s;
                }
            }
        }
    }
};

}  // namespace hairloom::gpu_simulation::test
