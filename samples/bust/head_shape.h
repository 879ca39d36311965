// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The bust as one smooth implicit surface, and the curves that divide it into groups.
// Points are in metres, Y up, facing +Z, standing on y = 0. Everything is even in x.

#include <array>

#include "core/base/math.h"

namespace hairloom::bust {

/// Height of the line between the pupils; lengths inside head_shape.cpp are millimetres from there.
inline constexpr double kEyeHeight = 1.661;

/// Below zero inside; close to the distance in metres near the surface. Continuously differentiable.
double surface(const Vec3d& p);

/// Gradient of `surface` by central differences; points outwards.
Vec3d gradient(const Vec3d& p);

/// The closest point of the surface in the direction of its gradient, by Newton steps; for points within a
/// few millimetres.
Vec3d project(Vec3d p);

enum class Group { Scalp, Face, Ears, Neck, Shoulders };
inline constexpr int kGroupCount = 5;
inline constexpr std::array<const char*, kGroupCount> kGroupNames = {"scalp", "face", "ears", "neck",
                                                                     "shoulders"};

/// A group in the pieces that are unwrapped by themselves.
enum class Patch { Scalp, Face, Ear, NeckFront, NeckBack, ShouldersFront, ShouldersBack };
inline constexpr int kPatchCount = 7;
Group groupOf(Patch patch);

/// The curves between patches, each the zero set of a smooth function of the point.
enum class Border { Ear, Hairline, Collar, Jaw, Seam };

/// Metres near the curve. Ear: below zero on the ear. Hairline: below zero where hair grows. Collar: below
/// zero on the shoulders. Jaw: below zero on the face's side. Seam: below zero behind the coronal seam of
/// neck and shoulders.
double border(Border which, const Vec3d& p);

/// The curve on which two different patches meet.
Border borderBetween(Patch a, Patch b);

/// Length that a mesh edge should have at a point of the surface, in metres.
double edgeLength(const Vec3d& p);

}  // namespace hairloom::bust
