// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hard cases by family; stability.cpp lists them all.

#include "core/accuracy/trial.h"

namespace hairloom::hardcases {

// Degenerate and extreme shapes.
void segmentWithoutLength(Trial& trial);
void coincidentNeighbours(Trial& trial);
void foldedBack(Trial& trial);
void tinySegments(Trial& trial);
void longStrand(Trial& trial);
void smallCurls(Trial& trial);
void oneSegment(Trial& trial);
void smallAndLarge(Trial& trial);
void massRatio(Trial& trial);

// Motion of the head, time and input.
void turningHead(Trial& trial);
void teleport(Trial& trial);
void frameTimes(Trial& trial);
void changesInMidRun(Trial& trial);
void everythingAtOnce(Trial& trial);

// Spheres.
void pointAtCentre(Trial& trial);
void overlappingSpheres(Trial& trial);
void rootThroughSphere(Trial& trial);
void shrinkingSphere(Trial& trial);
void negativeRadius(Trial& trial);

// Stiffness, wind and energy.
void stiffnessTimesMillion(Trial& trial);
void reversingStorm(Trial& trial);
void freeSwing(Trial& trial);
void longRest(Trial& trial);
void windThatIsNoNumber(Trial& trial);
void denormalSpeeds(Trial& trial);

/// The setting whose bending stiffness is that of `setting` times `factor`.
float stiffer(float setting, double factor);

}  // namespace hairloom::hardcases
