// SPDX-License-Identifier: GPL-3.0-or-later
// How rods are laid at rest: each strand by itself, whatever is laid beside it and on what machine.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "models/rods/rods.h"
#include "tests/runtime/instruction_sets.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

constexpr std::uint32_t kWandering = 71, kWanderingPoints = 24;

/// Strands that start in all directions and wander, some of them so far that they cannot carry themselves.
Strands wanderingHair() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> part(-1.0f, 1.0f);
    const auto direction = [&] { return Float3{part(random), part(random), part(random)}; };
    Strands strands;
    for (std::uint32_t s = 0; s < kWandering; ++s) {
        Float3 at = direction(), along = direction();
        const float wander = 0.3f * static_cast<float>(s) / kWandering,
                    step = 0.004f + 0.02f * static_cast<float>(s % 3);
        for (std::uint32_t p = 0; p < kWanderingPoints; ++p) {
            strands.points.push_back(at);
            along = along + direction() * wander;
            at = at + along * (step / (length(along) + 1e-6f));
        }
        strands.offsets.push_back(static_cast<std::uint32_t>(strands.points.size()));
    }
    return strands;
}

SimulationSettings settingsOf(float sectionRatio) {
    SimulationSettings settings;
    settings.strandModel = StrandModel::rods;
    settings.angularStiffness = 0.3f;
    settings.sectionRatio = sectionRatio;
    return settings;
}

/// Of one lane of a block, plane after plane.
std::vector<float> laneOf(const RestShape& shape, const RodRest& rest, std::size_t block,
                          std::uint32_t lane) {
    const std::size_t size = planeSize(shape.blocks[block]);
    std::vector<float> values;
    for (std::size_t plane = 0; plane < rest.planeCount(); ++plane) {
        for (std::uint32_t p = 0; p < shape.blocks[block].points; ++p)
            values.push_back(rest.planes[shape.blocks[block].firstPlane * rest.planeCount() + plane * size +
                                         std::size_t{p} * kBlockLanes + lane]);
    }
    return values;
}

TEST(RodRest, IsTheSameOnAnyMachineAndAnyThreads) {
    const Strands hair = wanderingHair();
    for (const float ratio : {1.0f, 0.6f}) {
        const SimulationSettings settings = settingsOf(ratio);
        const auto shape = makeRestShape(hair.view());
        const RodRest once = makeRodRest(*shape, settings);
        forEveryInstructionSet(
            [&] { EXPECT_EQ(makeRodRest(*shape, settings).planes, once.planes) << ratio; });
        const Host host = hostWithThreads(5, true);
        const auto elsewhere = makeRestShape(hair.view(), host);
        EXPECT_EQ(elsewhere->planes, shape->planes);
        EXPECT_EQ(elsewhere->longestStrand, shape->longestStrand);
        EXPECT_EQ(makeRodRest(*elsewhere, settings, host).planes, once.planes) << ratio;
    }
}

TEST(RodRest, AStrandIsLaidAsIfItWereAlone) {
    const Strands hair = wanderingHair();
    const SimulationSettings settings = settingsOf(1.0f);
    const auto shape = makeRestShape(hair.view());
    const RodRest together = makeRodRest(*shape, settings);
    for (std::size_t b = 0; b < shape->blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < shape->blocks[b].strands; lane += 5) {
            const std::uint32_t strand = shape->blocks[b].strandOfLane[lane];
            Strands alone;
            alone.points.assign(hair.points.begin() + hair.offsets[strand],
                                hair.points.begin() + hair.offsets[strand + 1]);
            alone.offsets.push_back(kWanderingPoints);
            const auto own = makeRestShape(alone.view());
            EXPECT_EQ(laneOf(*own, makeRodRest(*own, settings), 0, 0), laneOf(*shape, together, b, lane))
                << strand;
        }
    }
}

}  // namespace
}  // namespace hairloom::runtime
