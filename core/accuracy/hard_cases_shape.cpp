// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: degenerate and extreme shapes.
#include <cmath>
#include <numbers>

#include "core/accuracy/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::Float3;

constexpr float kSegment = 0.012f;  // metres

/// Points down and a little aside, with steps of these lengths in metres.
std::vector<Float3> strandOf(const std::vector<float>& segments, float x) {
    const Float3 direction = hangingAt(0.7f);
    std::vector<Float3> strand{{x, 0.1f, 0.0f}};
    for (const float segment : segments) strand.push_back(strand.back() + direction * segment);
    return strand;
}

void shakeAndSettle(Trial& trial, double most = 5.0) {
    trial.shakeRoots();
    trial.settle(most);
}

StrandSet scaled(StrandSet strands, float scale) {
    for (Float3& point : strands.points) point = point * scale;
    return strands;
}

}  // namespace

void segmentWithoutLength(Trial& trial) {
    StrandSet strands;
    for (const std::size_t where : {std::size_t{0}, std::size_t{6}, std::size_t{14}}) {
        std::vector<float> segments(15, kSegment);
        segments[where] = 0.0f;
        strands.add(strandOf(segments, 0.01f * static_cast<float>(where)));
    }
    trial.start(std::move(strands));
    shakeAndSettle(trial);
}

void coincidentNeighbours(Trial& trial) {
    StrandSet strands;
    std::vector<float> segments(15, kSegment);
    for (const std::size_t s : {5, 6, 7}) segments[s] = 0.0f;
    strands.add(strandOf(segments, 0.0f));
    strands.add(strandOf(segments, 0.0f));  // and the same strand twice
    // As near as single precision can place them to 1 % of their distance.
    for (const std::size_t s : {5, 6, 7}) segments[s] = 1e-5f;
    strands.add(strandOf(segments, 0.01f));
    strands.add(strandOf(std::vector<float>(15, 0.0f), 0.02f));
    trial.start(std::move(strands));
    shakeAndSettle(trial);
}

void foldedBack(Trial& trial) {
    StrandSet strands;
    std::vector<float> segments(15, kSegment);
    for (std::size_t s = 8; s < segments.size(); ++s) segments[s] = -kSegment;
    strands.add(strandOf(segments, 0.0f));
    for (std::size_t s = 0; s < segments.size(); ++s) segments[s] = s % 2 == 0 ? kSegment : -kSegment;
    strands.add(strandOf(segments, 0.02f));
    trial.start(std::move(strands));
    shakeAndSettle(trial);
}

void tinySegments(Trial& trial) {
    trial.start(tuft(32, 0.0001f));
    shakeAndSettle(trial);
}

void longStrand(Trial& trial) {
    trial.start(tuft(32, 1.5f / 31.0f));
    // A pendulum of 1.5 m swings in 2.5 s.
    shakeAndSettle(trial, 15.0);
}

void smallCurls(Trial& trial) {
    constexpr float kRadius = 0.002f, kPitch = 0.006f;
    constexpr int kPointsPerTurn = 12, kTurns = 5;
    StrandSet strands;
    for (int s = 0; s < 4; ++s) {
        std::vector<Float3> strand;
        const float x = 0.01f * static_cast<float>(s);
        for (int p = 0; p <= kPointsPerTurn * kTurns; ++p) {
            const float turns = static_cast<float>(p) / kPointsPerTurn;
            const float angle = 2.0f * std::numbers::pi_v<float> * turns + static_cast<float>(s);
            strand.push_back(
                {x + kRadius * std::cos(angle), 0.1f - kPitch * turns, kRadius * std::sin(angle)});
        }
        strands.add(strand);
    }
    trial.start(std::move(strands));
    shakeAndSettle(trial);
}

void oneSegment(Trial& trial) {
    for (const std::uint32_t clamped : {1u, 2u}) {
        runtime::SimulationSettings settings;
        settings.clampedPoints = clamped;
        trial.start(tuft(2, 0.05f), settings);
        trial.shakeRoots();
    }
    StrandSet strands = tuft(2, 0.05f);
    runtime::SimulationSettings settings;
    settings.clampedPoints = 1;
    trial.restart(std::move(strands), settings);
    shakeAndSettle(trial);
}

void smallAndLarge(Trial& trial) {
    for (const float scale : {0.001f, 1000.0f}) {
        trial.start(scaled(tuft(), scale));
        trial.shakeRoots();
        trial.frames(200);
    }
    trial.start(scaled(tuft(), 0.001f));
    shakeAndSettle(trial);
}

void massRatio(Trial& trial) {
    StrandSet strands = tuft();
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = 0; p < 16; ++p) {
            const float share = static_cast<float>(s % 2 == 0 ? p : 15 - p) / 15.0f;
            strands.masses.push_back(std::pow(10.0f, 4.0f * share));
        }
    }
    trial.start(std::move(strands));
    shakeAndSettle(trial);
}

}  // namespace hairloom::hardcases
