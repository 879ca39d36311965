// SPDX-License-Identifier: GPL-3.0-or-later
// Hair against hair on the device beside the volume of the runtime.
#include <algorithm>

#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;

class Volume : public GpuSimulationTest {
  protected:
    /// Nothing acts but the volume.
    static runtime::SimulationSettings calm() {
        runtime::SimulationSettings s = runtime::springSettings();
        s.gravity = {};
        s.dampingTime = s.airDrag = s.angularStiffness = s.sleepSpeed = 0.0f;
        s.lengthIterations = 0;
        s.substeps = 1;
        return s;
    }
    static test::Scene scene() {
        constexpr std::array<std::uint32_t, 2> kPoints{6, 4};
        return test::makeScene(calm(), test::Hair::curled, 5, kPoints);
    }
    static runtime::State after(const test::Scene& scene,
                                const std::optional<runtime::HairVolumeSettings>& volume,
                                StrandStorage storage = StrandStorage::threads) {
        EngineOptions with = options({storage, false});
        with.hairVolume = volume;
        StrandEngine engine = engineOf(scene.view(), scene.settings, with);
        EXPECT_TRUE(engine.writeState(scene.state));
        const auto stepped = engine.step(scene.input());
        EXPECT_TRUE(stepped) << stepped.error().message();
        return engine.readState().value();
    }
};

TEST_F(Volume, ChangesVelocitiesAsTheRuntimesDoes) {
    const test::Scene hair = scene();
    runtime::HairVolumeSettings settings;
    settings.cellSize = 0.03f;
    settings.targetDensity = 1e4f;
    settings.repulsion = 2.0f;
    settings.friction = 40.0f;
    // The second doubles the cells; with lanes the points of a strand stand together.
    for (const auto& [nodes, storage] :
         {std::pair(1u << 18u, StrandStorage::threads), std::pair(600u, StrandStorage::lanes)}) {
        settings.maxNodes = nodes;
        const runtime::State without = after(hair, {}, storage), with = after(hair, settings, storage);
        std::vector<Float3> positions(hair.positions.size()), before(positions), wanted(positions),
            found(positions);
        runtime::readPositions(*hair.shape, without, positions);
        runtime::readVelocities(*hair.shape, without, before);
        runtime::readVelocities(*hair.shape, with, found);
        wanted = before;
        auto volume = runtime::HairVolume::make(settings);
        ASSERT_TRUE(volume.volume);
        volume.volume->apply(positions, wanted, hair.input().dt);
        double changed = 0.0;
        for (std::size_t s = 0; s + 1 < hair.offsets.size(); ++s) {
            for (std::uint32_t p = hair.offsets[s] + 2; p < hair.offsets[s + 1]; ++p) {
                changed = std::max(changed, static_cast<double>(length(wanted[p] - before[p])));
                // Displacements of 1e-3 m in single precision, over a substep of 2 ms.
                EXPECT_LE(length(found[p] - wanted[p]), 2e-3f) << p;
            }
        }
        EXPECT_GT(changed, 0.1);
    }
}

TEST_F(Volume, SumsDoNotDependOnTheOrder) {
    const test::Scene hair = scene();
    runtime::HairVolumeSettings settings;
    settings.targetDensity = 1e4f;
    EXPECT_EQ(after(hair, settings).hash(), after(hair, settings).hash());
}

TEST_F(Volume, IsRefusedInWordsOutsideItsRange) {
    EngineOptions with = options();
    with.hairVolume.emplace();
    with.hairVolume->cellSize = 0.0f;
    const test::Scene hair = scene();
    const auto made = StrandEngine::make(*device(), library(), hair.view(), hair.settings, with);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message().find("cellSize"), std::string::npos);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
