// SPDX-License-Identifier: GPL-3.0-or-later
// One substep of each kernel beside formulas in double precision that share no code with it: the forces of
// core/simulation/reference, and the length constraint and the response of spheres written out here. Whatever
// a random or nasty state does to single precision, the device is as near to them as the stages of the CPU
// are.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/simulation/reference/forces.h"
#include "core/simulation/reference/solver.h"
#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using Eigen::Vector3d;
using runtime::SimulationSettings;
using test::Hair;
using test::Scene;
using Places = std::vector<Vector3d>;  // of one strand

constexpr double kSubstep = static_cast<double>(test::kStep);
constexpr StrandStorage kStorages[] = {StrandStorage::threads, StrandStorage::lanes};
constexpr std::uint32_t kPoints[] = {12};

/// Places relative to the root, and displacements in the last substep.
struct Strand {
    Places places, moved;
};

std::vector<Strand> strandsOf(const Scene& scene, const runtime::State& state) {
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
                strand.places.push_back(at(0));
                strand.moved.push_back(at(0) - at(3));
            }
        }
    }
    return strands;
}

/// Strands whose roots rest, in a state that is random, or nasty too.
Scene sceneFor(const SimulationSettings& settings, Hair rest, bool nasty, std::size_t spheres) {
    Scene scene = test::makeScene(settings, rest, 23, kPoints);
    test::Dice dice(5);
    if (nasty) test::disturb(scene, Hair::nasty, dice);
    scene.roots = scene.shape->restRoots;
    scene.spheres = {{{0.0f, -0.05f, 0.0f}, 0.06f}};
    scene.spheres.resize(spheres);
    scene.state.spheres = scene.spheres;
    return scene;
}

SimulationSettings nothing() {
    SimulationSettings s;
    s.substeps = 1;
    // Explicit springs bend without damping.
    s.dampingTime = s.bendDampingTime = s.airDrag = s.angularStiffness = s.sleepSpeed = 0.0f;
    s.gravity = {};
    s.lengthIterations = 0;
    return s;
}

double farthest(const Places& a, const Places& b, std::size_t first) {
    double most = 0.0;
    for (std::size_t p = first; p < a.size(); ++p) most = std::max(most, (a[p] - b[p]).norm());
    return most;
}

class Reference : public GpuSimulationTest {
  protected:
    /// What the device and the CPU make of a substep, against `truth` of each strand before it; `of` picks
    /// what is compared.
    void hold(const Scene& scene, const std::function<Places(std::size_t, const Strand&)>& truth,
              const std::function<Places(const Strand&, const Strand&)>& of, double share) {
        const std::vector<Strand> before = strandsOf(scene, scene.state);
        const std::vector<Strand> cpu = strandsOf(scene, test::runOnCpu(scene));
        for (const StrandStorage storage : kStorages) {
            SCOPED_TRACE(static_cast<int>(storage));
            StrandEngine engine = engineOf(scene.view(), scene.settings, options(storage));
            ASSERT_TRUE(engine.writeState(scene.state));
            ASSERT_TRUE(engine.step(scene.input()));
            const std::vector<Strand> gpu = strandsOf(scene, engine.readState().value());
            const std::size_t first = scene.settings.clampedPoints;
            for (std::size_t s = 0; s < before.size(); ++s) {
                const Places exact = truth(s, before[s]);
                const double off = farthest(of(before[s], gpu[s]), exact, first);
                const double offOnCpu = farthest(of(before[s], cpu[s]), exact, first);
                double size = 0.0;
                for (const Vector3d& v : exact) size = std::max(size, v.norm());
                // Places of a strand's size round to 2e-8 m.
                EXPECT_LE(off, 4.0 * offOnCpu + 1e-7) << "strand " << s;
                if (share > 0.0) {
                    EXPECT_LE(off, share * size + 1e-7) << "strand " << s;
                }
            }
        }
    }
};

struct Force {
    const char* name;
    std::function<void(SimulationSettings&)> change;
    std::size_t spheres = 0;
};
const Force kForces[] = {
    {"gravity",
     [](SimulationSettings& s) {
         s.gravity = {1.0f, -9.81f, 0.5f};
     }},
    {"drag", [](SimulationSettings& s) { s.airDrag = 20.0f; }},
    {"wind",
     [](SimulationSettings& s) {
         s.airDrag = 5.0f;
         s.windSpeed = 8.0f;
         s.windKind = runtime::WindKind::uniform;
     }},
    {"springs",
     [](SimulationSettings& s) {
         s.lengthMethod = runtime::LengthMethod::springs;
         s.springFrequency = 20.0f;
     }},
    {"cheap",
     [](SimulationSettings& s) {
         s.angularStiffness = 0.3f;
         s.angularMethod = runtime::AngularMethod::cheap;
     }},
    {"exact",
     [](SimulationSettings& s) {
         s.angularStiffness = 0.3f;
         s.angularMethod = runtime::AngularMethod::exact;
     }},
    {"flexion",
     [](SimulationSettings& s) {
         s.angularStiffness = 0.3f;
         s.angularMethod = runtime::AngularMethod::flexion;
     }},
    {"penalty", [](SimulationSettings& s) { s.collisionResponse = runtime::CollisionResponse::penalty; }, 1},
};

class ReferenceForces : public Reference, public testing::WithParamInterface<Force> {};

/// What position Verlet adds to the displacement is the force of the reference.
TEST_P(ReferenceForces, AreThoseOfTheModel) {
    SimulationSettings settings = nothing();
    GetParam().change(settings);
    for (const bool nasty : {false, true}) {
        for (const Hair hair : {Hair::straight, Hair::curled}) {
            SCOPED_TRACE(static_cast<int>(hair) + 10 * nasty);
            const Scene scene = sceneFor(settings, hair, nasty, GetParam().spheres);
            const auto solver = reference::Solver::make(reference::strandsOf(scene.view()), settings);
            ASSERT_TRUE(solver);
            reference::Physics physics(settings);
            // Position Verlet lets the air's share decay exactly.
            physics.airDrag = -std::expm1(-static_cast<double>(settings.airDrag) * kSubstep) / kSubstep;
            const auto truth = [&](std::size_t s, const Strand& before) {
                const runtime::Float3 place = scene.roots[s].position;
                const Vector3d root(place.x, place.y, place.z);
                Places x, v, force(before.places.size(), Vector3d::Zero());
                for (std::size_t p = 0; p < before.places.size(); ++p) {
                    x.push_back(root + before.places[p]);
                    v.emplace_back(before.moved[p] / kSubstep);
                }
                std::vector<reference::SphereNow> spheres;
                for (const runtime::Sphere& sphere : scene.spheres) {
                    const runtime::Float3 c = sphere.center_ws;
                    spheres.push_back({{c.x, c.y, c.z}, Vector3d::Zero(), sphere.radius});
                }
                const reference::StrandShape& shape = solver->shape(s);
                reference::addForces(physics, shape, x, v,
                                     {0.7, Eigen::Quaterniond::Identity(), Vector3d::Zero(), spheres}, force);
                for (std::size_t p = 0; p < force.size(); ++p)
                    force[p] *= kSubstep * kSubstep / shape.masses[p];
                return force;
            };
            const auto added = [](const Strand& before, const Strand& after) {
                Places result;
                for (std::size_t p = 0; p < after.moved.size(); ++p)
                    result.emplace_back(after.moved[p] - before.moved[p]);
                return result;
            };
            hold(scene, truth, added, nasty ? 0.0 : 1e-3);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Forces, ReferenceForces, testing::ValuesIn(kForces),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// One Newton step on all lengths of a strand (docs/engine.md, "After the integration"), densely, by
/// pivoting.
Places heldInDouble(const Scene& scene, std::size_t s, const Places& start, Places x) {
    const std::size_t n = x.size() - 1, first = scene.settings.clampedPoints - 1, rows = n - first;
    std::vector<double> masses(x.size(), 0.0), lengths(n);
    for (std::size_t j = 0; j < n; ++j) {
        const runtime::Float3 a = scene.positions[scene.offsets[s] + j],
                              b = scene.positions[scene.offsets[s] + j + 1];
        lengths[j] = Vector3d(static_cast<double>(b.x) - a.x, static_cast<double>(b.y) - a.y,
                              static_cast<double>(b.z) - a.z)
                         .norm();
        masses[j] += lengths[j];
        masses[j + 1] += lengths[j];
    }
    double mean = 0.0;
    for (const double m : masses) mean += m / static_cast<double>(masses.size());
    const auto weight = [&](std::size_t p) { return p <= first ? 0.0 : mean / masses[p]; };
    Places wanted(n), acting(n);
    Eigen::VectorXd wrong(rows);
    for (std::size_t j = first; j < n; ++j) {
        const Vector3d edge = x[j + 1] - x[j], before = (start[j + 1] - start[j]) / lengths[j];
        wanted[j] = edge / lengths[j];
        acting[j] = wanted[j].dot(before) > 0.5 * wanted[j].squaredNorm() ? before : wanted[j];
        wrong[static_cast<Eigen::Index>(j - first)] = 0.5 * (edge.dot(wanted[j]) - lengths[j]);
    }
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(wrong.size(), wrong.size());
    for (std::size_t j = first; j < n; ++j) {
        const auto row = static_cast<Eigen::Index>(j - first);
        const double own = std::max(wanted[j].dot(acting[j]), 0.25);
        matrix(row, row) = own * (weight(j) + weight(j + 1));
        if (j > first) matrix(row, row - 1) = -wanted[j].dot(acting[j - 1]) * weight(j);
        if (j + 1 < n) matrix(row, row + 1) = -wanted[j].dot(acting[j + 1]) * weight(j + 1);
    }
    const Eigen::VectorXd lambda = matrix.fullPivLu().solve(wrong);
    for (std::size_t p = first + 1; p < x.size(); ++p) {
        Vector3d pull = -acting[p - 1] * lambda[static_cast<Eigen::Index>(p - 1 - first)];
        if (p < n) pull += acting[p] * lambda[static_cast<Eigen::Index>(p - first)];
        x[p] += pull * weight(p);
    }
    return x;
}

Places placesOf(const Strand&, const Strand& after) {
    return after.places;
}

TEST_F(Reference, LengthsInDoublePrecision) {
    SimulationSettings settings = nothing();
    settings.lengthIterations = 1;
    // Nothing is beyond it.
    settings.maximalExtension = 0.48f;
    for (const std::uint32_t clamped : {1u, 2u}) {
        for (const Hair hair : {Hair::straight, Hair::curled}) {
            SCOPED_TRACE(clamped);
            settings.clampedPoints = clamped;
            const Scene scene = sceneFor(settings, hair, false, 0);
            const auto truth = [&](std::size_t s, const Strand& before) {
                Places x = before.places;
                for (std::size_t p = clamped; p < x.size(); ++p) x[p] += before.moved[p];
                return heldInDouble(scene, s, before.places, x);
            };
            hold(scene, truth, placesOf, 0.0);
        }
    }
}

/// Eqs. 20 and 21 of the thesis, with friction, at one sphere.
TEST_F(Reference, SpheresInDoublePrecision) {
    SimulationSettings settings = nothing();
    settings.restitution = 0.4f;
    settings.friction = 0.3f;
    const Scene scene = sceneFor(settings, Hair::curled, false, 1);
    const runtime::Sphere& sphere = scene.spheres[0];
    const Vector3d centre_ws(sphere.center_ws.x, sphere.center_ws.y, sphere.center_ws.z);
    const double reach = sphere.radius, bounce = 1.0 + static_cast<double>(settings.restitution);
    std::size_t touched = 0;
    const auto truth = [&](std::size_t s, const Strand& before) {
        const runtime::Float3 root = scene.roots[s].position;
        const Vector3d centre = centre_ws - Vector3d(root.x, root.y, root.z);
        Places x = before.places;
        for (std::size_t p = settings.clampedPoints; p < x.size(); ++p) {
            x[p] += before.moved[p];
            const Vector3d offset = x[p] - centre;
            if (offset.norm() >= reach) continue;
            ++touched;
            const Vector3d normal = offset.normalized();
            const double along = before.moved[p].dot(normal), approach = std::max(-along, 0.0);
            const Vector3d sliding = before.moved[p] - normal * along;
            const double rate = static_cast<double>(settings.friction) * bounce / sliding.norm();
            const double slid = std::min(rate * std::min(reach - offset.norm(), approach), 1.0);
            x[p] = centre + normal * reach - sliding * slid;
        }
        return x;
    };
    hold(scene, truth, placesOf, 0.0);
    EXPECT_GT(touched, 10u);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
