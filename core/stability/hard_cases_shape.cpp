// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: degenerate and extreme shapes.
#include <cmath>
#include <numbers>

#include "core/stability/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::Float3;

constexpr float kSegment = 0.012f;  // metres
constexpr const char* kCurved =
    "the forces of curved springs do not derive from an energy, and drive the hair";
constexpr const char* kUneven =
    "springs fix lengths after bending, and with masses this uneven the two undo each other's work";

/// Points down and a little aside, with steps of these lengths in metres.
std::vector<Float3> strandOf(const std::vector<float>& segments, float x) {
    const Float3 direction = hangingAt(0.7f);
    std::vector<Float3> strand{{x, 0.1f, 0.0f}};
    for (const float segment : segments) strand.push_back(strand.back() + direction * segment);
    return strand;
}

void shakeAndSettle(HardCaseRun& caseRun, double maximum = 5.0) {
    caseRun.shakeRoots();
    caseRun.settle(maximum);
}

StrandSet scaled(StrandSet strands, float scale) {
    for (Float3& point : strands.points) point = point * scale;
    return strands;
}

}  // namespace

void segmentWithoutLength(HardCaseRun& caseRun) {
    StrandSet strands;
    for (const std::size_t where : {std::size_t{0}, std::size_t{6}, std::size_t{14}}) {
        std::vector<float> segments(15, kSegment);
        segments[where] = 0.0f;
        strands.add(strandOf(segments, 0.01f * static_cast<float>(where)));
    }
    caseRun.start(std::move(strands));
    shakeAndSettle(caseRun);
}

void coincidentNeighbours(HardCaseRun& caseRun) {
    StrandSet strands;
    std::vector<float> segments(15, kSegment);
    for (const std::size_t s : {5, 6, 7}) segments[s] = 0.0f;
    strands.add(strandOf(segments, 0.0f));
    strands.add(strandOf(segments, 0.0f));  // and the same strand twice
    // As near as single precision can place them to 1 % of their distance.
    for (const std::size_t s : {5, 6, 7}) segments[s] = 1e-5f;
    strands.add(strandOf(segments, 0.01f));
    strands.add(strandOf(std::vector<float>(15, 0.0f), 0.02f));
    caseRun.start(std::move(strands));
    // Springs rest after 3 to 10 s, as the last bit of the shake has it.
    shakeAndSettle(caseRun, caseRun.method().rods() ? 5.0 : 15.0);
}

void foldedBack(HardCaseRun& caseRun) {
    if (!caseRun.method().rods()) caseRun.disclaim(kCurved);
    StrandSet strands;
    std::vector<float> segments(15, kSegment);
    for (std::size_t s = 8; s < segments.size(); ++s) segments[s] = -kSegment;
    strands.add(strandOf(segments, 0.0f));
    for (std::size_t s = 0; s < segments.size(); ++s) segments[s] = s % 2 == 0 ? kSegment : -kSegment;
    strands.add(strandOf(segments, 0.02f));
    caseRun.start(std::move(strands));
    shakeAndSettle(caseRun);
}

void tinySegments(HardCaseRun& caseRun) {
    caseRun.start(tuft(32, 0.0001f));
    shakeAndSettle(caseRun);
}

void longStrand(HardCaseRun& caseRun) {
    caseRun.start(tuft(32, 1.5f / 31.0f));
    // A pendulum of 1.5 m swings in 2.5 s.
    shakeAndSettle(caseRun, 15.0);
}

void smallCurls(HardCaseRun& caseRun) {
    if (!caseRun.method().rods()) caseRun.disclaim(kCurved);
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
    caseRun.start(std::move(strands));
    shakeAndSettle(caseRun);
}

void oneSegment(HardCaseRun& caseRun) {
    for (const std::uint32_t clamped : {1u, 2u}) {
        runtime::SimulationSettings settings;
        settings.clampedPoints = clamped;
        caseRun.start(tuft(2, 0.05f), settings);
        caseRun.shakeRoots();
    }
    StrandSet strands = tuft(2, 0.05f);
    runtime::SimulationSettings settings;
    settings.clampedPoints = 1;
    caseRun.restart(std::move(strands), settings);
    shakeAndSettle(caseRun);
}

void smallAndLarge(HardCaseRun& caseRun) {
    for (const float scale : {0.001f, 1000.0f}) {
        caseRun.start(scaled(tuft(), scale));
        caseRun.shakeRoots();
        caseRun.frames(200);
    }
    caseRun.start(scaled(tuft(), 0.001f));
    shakeAndSettle(caseRun);
}

void massRatio(HardCaseRun& caseRun) {
    if (!caseRun.method().rods()) caseRun.disclaim(kUneven);
    StrandSet strands = tuft();
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = 0; p < 16; ++p) {
            const float share = static_cast<float>(s % 2 == 0 ? p : 15 - p) / 15.0f;
            strands.masses.push_back(std::pow(10.0f, 4.0f * share));
        }
    }
    caseRun.start(std::move(strands));
    shakeAndSettle(caseRun);
}

}  // namespace hairloom::hardcases
