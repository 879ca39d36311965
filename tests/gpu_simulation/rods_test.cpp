// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic rods on the device beside the stage of the CPU, from random and nasty states.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;
using runtime::SimulationSettings;
using runtime::WindKind;
using test::Hair;
using test::Scene;

struct Case {
    const char* name;
    std::function<void(SimulationSettings&)> change;
    bool spheres = false;
    /// Metres that a strand may be off after eight substeps. Single precision rounds a strand's positions to
    /// 2e-8 of its 0.2 m; what damps nothing, or is soft, lets that grow. A contact's stiffness is 300 m/h².
    double tolerance = 2e-7;
};
void PrintTo(const Case& printed, std::ostream* out) {
    *out << printed.name;
}

void blow(SimulationSettings& s, WindKind kind) {
    s.airDrag = 5.0f;
    s.windSpeed = 8.0f;
    s.windKind = kind;
}

const Case kCases[] = {
    {"defaults", [](SimulationSettings&) {}},
    {"bare",
     [](SimulationSettings& s) {
         s.gravity = {};
         s.airDrag = s.dampingTime = s.bendDampingTime = s.sleepSpeed = 0.0f;
     },
     false, 5e-6},
    {"soft", [](SimulationSettings& s) { s.angularStiffness = 0.01f; }, false, 1e-5},
    {"stiff", [](SimulationSettings& s) { s.angularStiffness = 0.95f; }},
    {"oneClampedPoint", [](SimulationSettings& s) { s.clampedPoints = 1; }},
    {"twistsHard", [](SimulationSettings& s) { s.torsionRatio = 8.0f; }},
    {"flat", [](SimulationSettings& s) { s.sectionRatio = 0.4f; }},
    // Rounding decides in which substep a point begins to touch or to slide.
    {"flatSpheresInWind",
     [](SimulationSettings& s) {
         s.sectionRatio = 0.7f;
         blow(s, WindKind::turbulent);
     },
     true, 1.2e-4},
    {"withoutWeightAtRest", [](SimulationSettings& s) { s.restGravity = 0.0f; }},
    {"windUniform", [](SimulationSettings& s) { blow(s, WindKind::uniform); }},
    {"windGusting", [](SimulationSettings& s) { blow(s, WindKind::gusting); }},
    {"windTurbulent", [](SimulationSettings& s) { blow(s, WindKind::turbulent); }},
    {"windVehicle", [](SimulationSettings& s) { blow(s, WindKind::vehicle); }},
    {"spheres", [](SimulationSettings&) {}, true, 5e-5},
    {"spheresThatThrowBack",
     [](SimulationSettings& s) {
         s.restitution = 0.4f;
         s.friction = 0.8f;
     },
     true, 1e-4},
    {"spheresInWind", [](SimulationSettings& s) { blow(s, WindKind::turbulent); }, true, 5e-5},
};

/// They share a batch.
constexpr std::array<std::uint32_t, 4> kPoints{16, 13, 10, 9};

/// Hair that may sleep, as by default: nearly all of these kernels are then those of other tests, and a
/// software device, which takes half a minute for each, compiles them once. `bare` has kernels without sleep.
SimulationSettings settingsOf(const Case& what, std::uint32_t substeps) {
    SimulationSettings s;
    s.strandModel = runtime::StrandModel::rods;
    s.substeps = substeps;
    what.change(s);
    return s;
}

/// Greatest differences of a strand of two states: of positions or displacements, metres; of numbers of its
/// rotations; of speeds, m/s.
struct Apart {
    double position = 0.0, rotation = 0.0, speed = 0.0;

    double shareOf(double tolerance) const {
        return std::max({position / tolerance, rotation / (100.0 * tolerance), speed / (200.0 * tolerance)});
    }
};
std::vector<Apart> apart(const Scene& scene, const runtime::State& a, const runtime::State& b) {
    constexpr std::size_t kRotation = 4, kVelocity = 10;  // planes of runtime::RodView
    const std::vector<double> positions = distanceOf(scene, a, b).strands;
    std::vector<Apart> strands(positions.size());
    for (std::size_t s = 0; s < strands.size(); ++s) strands[s].position = positions[s];
    for (const runtime::Block& block : scene.shape->blocks) {
        for (std::size_t plane = 0; plane < runtime::kRodMotionPlanes; ++plane) {
            if (plane >= kRotation && plane < kVelocity) continue;
            const std::size_t first = block.firstPlane * runtime::kRodMotionPlanes + plane * planeSize(block);
            for (std::size_t i = 0; i + 1 < std::size_t{block.points} * runtime::kBlockLanes; ++i) {
                const std::size_t lane = i % runtime::kBlockLanes;
                if (lane >= block.strands) continue;
                Apart& strand = strands[block.strandOfLane[lane]];
                double& greatest = plane < kRotation ? strand.rotation : strand.speed;
                const double off = static_cast<double>(a.own[runtime::kOwnMotion][first + i]) -
                                   static_cast<double>(b.own[runtime::kOwnMotion][first + i]);
                greatest = std::max(greatest, std::abs(off));
            }
        }
    }
    return strands;
}

/// How far each strand comes from where it is if its points begin some roundings off, in shares of a
/// tolerance: a contact that is about to slide, or to be left, is not the same after that. 0 without
/// contacts.
std::vector<double> unsure(const Scene& scene, const runtime::State& cpu, double tolerance) {
    std::vector<double> shares(scene.offsets.size() - 1);
    if (scene.spheres.empty()) return shares;
    for (std::uint32_t run = 0; run < 16; ++run) {
        Scene nudged = scene;
        test::Dice dice(run + 1);
        for (float& number : nudged.state.planes) number += number * dice.between(-1e-6f, 1e-6f);
        test::fillSpareLanes(*nudged.shape, nudged.state);
        test::makeRods(nudged);
        const auto strands = apart(scene, runOnCpu(nudged), cpu);
        for (std::size_t s = 0; s < shares.size(); ++s)
            shares[s] = std::max(shares[s], strands[s].shareOf(tolerance));
    }
    return shares;
}

/// Greatest error of a segment's length, metres.
double stretchOf(const Scene& scene, const runtime::State& state) {
    std::vector<Float3> positions(scene.positions.size());
    runtime::readPositions(*scene.shape, state, positions);
    double greatest = 0.0;
    for (std::size_t s = 0; s + 1 < scene.offsets.size(); ++s) {
        for (std::uint32_t p = scene.offsets[s]; p + 1 < scene.offsets[s + 1]; ++p) {
            const float now = length(positions[p + 1] - positions[p]);
            const float atRest = length(scene.positions[p + 1] - scene.positions[p]);
            greatest = std::max(greatest, static_cast<double>(std::abs(now - atRest)));
        }
    }
    return greatest;
}

class RodParity : public GpuSimulationTest, public testing::WithParamInterface<Case> {
  protected:
    static runtime::State runOnDevice(const Scene& scene, const LayoutOptions& layout) {
        StrandEngine engine = engineOf(scene.view(), scene.settings, options(layout));
        EXPECT_TRUE(engine.writeState(scene.state));
        const auto stepped = engine.step(scene.input());
        EXPECT_TRUE(stepped) << stepped.error().message();
        return engine.readState().value();
    }
    static Scene sceneOf(const SimulationSettings& settings, Hair hair) {
        Scene scene = test::makeScene(settings, hair, 7, kPoints);
        if (!GetParam().spheres) scene.spheres = scene.state.spheres = {};
        return scene;
    }
};

TEST_P(RodParity, EightSubsteps) {
    for (const Hair hair : {Hair::straight, Hair::curled}) {
        SCOPED_TRACE(static_cast<int>(hair));
        const Scene scene = sceneOf(settingsOf(GetParam(), 8), hair);
        const runtime::State cpu = runOnCpu(scene);
        const std::vector<double> turns = unsure(scene, cpu, GetParam().tolerance);
        EXPECT_LE(std::ranges::count_if(turns, [](double share) { return share > 1.0; }), 3);
        for (const LayoutOptions& layout : kRodLayouts) {
            SCOPED_TRACE(*layout.members);
            const runtime::State gpu = runOnDevice(scene, layout);
            EXPECT_EQ(distanceOf(scene, gpu, cpu).lost, 0u);
            const std::vector<Apart> strands = apart(scene, gpu, cpu);
            for (std::size_t s = 0; s < strands.size(); ++s)
                EXPECT_LE(strands[s].shareOf(GetParam().tolerance), std::max(1.0, 2.0 * turns[s])) << s;
            EXPECT_LE(stretchOf(scene, gpu), 1e-6);
        }
    }
}

/// Segments without length, of 1 µm and of 1 m, folds, and points at 500 m/s: rounding grows by thousands in
/// one substep, and after eight strands are elsewhere, on the CPU as well where its input is a rounding off.
TEST_P(RodParity, NastyStates) {
    const Scene once = sceneOf(settingsOf(GetParam(), 1), Hair::nasty);
    const Scene often = sceneOf(settingsOf(GetParam(), 8), Hair::nasty);
    for (const LayoutOptions& layout : kRodLayouts) {
        SCOPED_TRACE(*layout.members);
        const test::Distance distance = distanceOf(once, runOnDevice(once, layout), runOnCpu(once));
        EXPECT_EQ(distance.lost, 0u);
        EXPECT_LE(*std::ranges::max_element(distance.strands), 2e-3);
        const runtime::State after = runOnDevice(often, layout);
        EXPECT_EQ(distanceOf(often, after, runOnCpu(often)).lost, 0u);
        EXPECT_LE(stretchOf(often, after), 5e-6);
    }
}

INSTANTIATE_TEST_SUITE_P(Effects, RodParity, testing::ValuesIn(kCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// More spheres than a kernel has constants; all of them move.
TEST_F(GpuSimulationTest, RodsMeetManySpheres) {
    SimulationSettings settings = settingsOf(kCases[0], 3);
    Scene scene = test::makeScene(settings, Hair::curled, 13, kPoints);
    test::Dice dice(17);
    scene.spheres.clear();
    for (std::size_t n = 0; n < 70; ++n)
        scene.spheres.push_back({dice.inside(0.2f), dice.between(0.01f, 0.03f)});
    scene.state.spheres = scene.spheres;
    for (runtime::Sphere& sphere : scene.state.spheres)
        sphere.center_ws = sphere.center_ws + dice.inside(0.005f);
    StrandEngine engine = engineOf(scene.view(), scene.settings, options());
    ASSERT_TRUE(engine.writeState(scene.state));
    ASSERT_TRUE(engine.step(scene.input()));
    const test::Distance distance = distanceOf(scene, engine.readState().value(), runOnCpu(scene));
    EXPECT_EQ(distance.lost, 0u);
    EXPECT_LE(*std::ranges::max_element(distance.strands), 5e-5);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
