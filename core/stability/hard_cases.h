// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hard cases by family; stability.cpp lists them all.

#include "core/stability/hard_case_run.h"

namespace hairloom::hardcases {

// Degenerate and extreme shapes.
void segmentWithoutLength(HardCaseRun& caseRun);
void coincidentNeighbours(HardCaseRun& caseRun);
void foldedBack(HardCaseRun& caseRun);
void tinySegments(HardCaseRun& caseRun);
void longStrand(HardCaseRun& caseRun);
void smallCurls(HardCaseRun& caseRun);
void oneSegment(HardCaseRun& caseRun);
void smallAndLarge(HardCaseRun& caseRun);
void massRatio(HardCaseRun& caseRun);

// Motion of the head, time and input.
void turningHead(HardCaseRun& caseRun);
void teleport(HardCaseRun& caseRun);
void frameTimes(HardCaseRun& caseRun);
void changesInMidRun(HardCaseRun& caseRun);
void everythingAtOnce(HardCaseRun& caseRun);
void randomStorms(HardCaseRun& caseRun);

/// Runs storm `seed` and five seconds of rest; the speed that is left, m/s.
double runStorm(HardCaseRun& caseRun, std::uint32_t seed);

// Spheres.
void pointAtCentre(HardCaseRun& caseRun);
void overlappingSpheres(HardCaseRun& caseRun);
void rootThroughSphere(HardCaseRun& caseRun);
void shrinkingSphere(HardCaseRun& caseRun);
void negativeRadius(HardCaseRun& caseRun);

// Contact of rods.
void noStiffness(HardCaseRun& caseRun);
void viceOfSpheres(HardCaseRun& caseRun);
void bouncingStrand(HardCaseRun& caseRun);
void sphereOfAKilometre(HardCaseRun& caseRun);

// Stiffness, wind and energy.
void stiffnessTimesMillion(HardCaseRun& caseRun);
void reversingStorm(HardCaseRun& caseRun);
void freeSwing(HardCaseRun& caseRun);
void longRest(HardCaseRun& caseRun);
void windThatIsNoNumber(HardCaseRun& caseRun);
void denormalSpeeds(HardCaseRun& caseRun);

/// The setting whose bending stiffness is that of `setting` times `factor`.
float stiffer(float setting, double factor);

}  // namespace hairloom::hardcases
