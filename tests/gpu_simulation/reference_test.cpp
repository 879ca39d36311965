// SPDX-License-Identifier: GPL-3.0-or-later
// One substep of each kernel beside formulas in double precision that share no code with it: the forces of
// core/simulation/reference, and the length constraint and the response of spheres written out here. Whatever
// a random or nasty state does to single precision, the device is as near to them as the stages of the CPU
// are.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/gpu_simulation/reference_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): the fixture is made for these cases

struct Force {
    const char* name;
    std::function<void(SimulationSettings&)> change;
    std::size_t spheres = 0;
};

void PrintTo(const Force& printed, std::ostream* out) {
    *out << printed.name;
}

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
    {"smallAngle",
     [](SimulationSettings& s) {
         s.angularStiffness = 0.3f;
         s.angularMethod = runtime::AngularMethod::smallAngle;
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
            const Bodies bodies(scene, settings);
            reference::Physics physics(settings);
            // Position Verlet lets the air's share decay exactly.
            physics.airDrag = -std::expm1(-static_cast<double>(settings.airDrag) * kSubstep) / kSubstep;
            const auto groundTruth = [&](std::size_t s, const Strand& before) {
                return bodies.added(s, before.positions, before.moved, physics);
            };
            const auto added = [](const Strand& before, const Strand& after) {
                Positions result;
                for (std::size_t p = 0; p < after.moved.size(); ++p)
                    result.emplace_back(after.moved[p] - before.moved[p]);
                return result;
            };
            hold(scene, groundTruth, added, nasty ? 0.0 : 1e-3);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Forces, ReferenceForces, testing::ValuesIn(kForces),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// One Newton step on all lengths of a strand (docs/engine.md, "After the integration"), densely, by
/// pivoting.
Positions heldInDouble(const Scene& scene, std::size_t s, const Positions& start, Positions x) {
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
    Positions wanted(n), acting(n);
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

TEST_F(Reference, LengthsInDoublePrecision) {
    SimulationSettings settings = nothing();
    settings.lengthIterations = 1;
    // Nothing is beyond it.
    settings.maximalExtension = 0.48f;
    for (const std::uint32_t clamped : {1u, 2u}) {
        for (const Hair hair : {Hair::straight, Hair::curled}) {
            SCOPED_TRACE(clamped);
            settings.clampedPoints = clamped;
            const Scene scene = sceneFor(settings, hair, false, 0, 0.0005f);
            const auto groundTruth = [&](std::size_t s, const Strand& before) {
                Positions x = before.positions;
                for (std::size_t p = clamped; p < x.size(); ++p) x[p] += before.moved[p];
                return heldInDouble(scene, s, before.positions, x);
            };
            hold(scene, groundTruth, positionsOf, 0.0);
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
    const auto groundTruth = [&](std::size_t s, const Strand& before) {
        const runtime::Float3 root = scene.roots[s].position;
        const Vector3d centre = centre_ws - Vector3d(root.x, root.y, root.z);
        Positions x = before.positions;
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
    hold(scene, groundTruth, positionsOf, 0.0);
    EXPECT_GT(touched, 10u);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
