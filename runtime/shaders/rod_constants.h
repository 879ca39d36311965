// SPDX-License-Identifier: MIT
// Numbers of the rod's solver, once for C++ and HLSL.
#ifndef HAIRLOOM_ROD_CONSTANTS_H
#define HAIRLOOM_ROD_CONSTANTS_H

/// Least pivot of a segment's rotation: a share of the vertex' stiffness, and of the pivots' sum what
/// rounding takes.
#define HAIRLOOM_ROD_LEAST_PIVOT 0.0375
#define HAIRLOOM_ROD_PIVOT_ROUNDING 9.5367431640625e-7
/// Share of what resists a segment's turns by inertia that a vertex resists it with at least, while it is
/// solved.
#define HAIRLOOM_ROD_FIRMNESS 1e-5
/// Radians by which the predicted rotation of a substep turns a segment at most.
#define HAIRLOOM_ROD_LARGEST_PREDICTION 0.5
/// The scheme of second order fades to backward Euler while a substep turns a segment by 0.25 to 0.5 radians.
#define HAIRLOOM_ROD_BLEND_END 2.0
#define HAIRLOOM_ROD_BLEND_SLOPE 4.0
/// Longest step over the one before it that keeps the scheme of second order.
#define HAIRLOOM_ROD_LONGEST_RATIO 2.0
/// A prediction is dropped where it raises the objective by more than this share.
#define HAIRLOOM_ROD_PREDICTION_SHARE 1.05
/// A step is shortened by this, at most so many times, where it raises the objective by more than rounding
/// does.
#define HAIRLOOM_ROD_SHORTENING 0.4
#define HAIRLOOM_ROD_SHORTENINGS 3
#define HAIRLOOM_ROD_ROUNDING 1.1920929e-7
/// Stiffness of a contact over m/h², h the substep.
#define HAIRLOOM_ROD_CONTACT 1000.0
/// Metres outside a shape within which a node stays in contact that was pressed in the last substep: how deep
/// it is there, weight over stiffness, can be less than rounding.
#define HAIRLOOM_ROD_CONTACT_REACH 5e-6
/// Metres inside a shape from which on a node is held at the surface where it comes out.
#define HAIRLOOM_ROD_CONTACT_DEEP 1e-4
/// Metres by which a step may take a node nearer to a shape than was predicted for the shape to be looked at.
#define HAIRLOOM_ROD_CONTACT_NEAR 1e-3
/// Metres of penetration or lift that a second look at the end of a step mends.
#define HAIRLOOM_ROD_CONTACT_LOOK 1e-5
/// Times that a substep looks again at most, and for what from the second time on: metres that a held node is
/// inside a shape, of strands no node of which passes a shape at more than so many metres per second.
#define HAIRLOOM_ROD_CONTACT_LOOKS 3
#define HAIRLOOM_ROD_CONTACT_SUNK 5e-5
#define HAIRLOOM_ROD_CONTACT_SLOW 0.2
/// Share of the way along a shape that its surface may have turned away by.
#define HAIRLOOM_ROD_CONTACT_CURVED 0.25
/// Metres per second: below, contact is rest. Of a strand's points in the root mean square, below which
/// contacts with shapes that rest are not looked at for energy that they add; of a point's approach.
#define HAIRLOOM_ROD_CONTACT_SPEED 5e-3

/// A body that comes fast is many times as deep in a strand as what one step can turn: it pushes by so many
/// metres a step, in so many steps at most, until no node is deeper than so many metres.
#define HAIRLOOM_BODY_PUSH 8e-3
#define HAIRLOOM_BODY_LOOKS 10
#define HAIRLOOM_BODY_DEEP 1e-3
/// Share of what a contact's force would move a free node by in a substep, by which such a node stays in
/// contact that starts the substep at the surface: the rest of the strand holds it back as well.
#define HAIRLOOM_BODY_BACK 0.05
/// Metres that a node may be off the skin and still be held by a plane that a look before found.
#define HAIRLOOM_BODY_FOLD_REACH 5e-4
/// Cosines of the angle between two planes of folded skin: what is nearer to 1 is one plane, and of two that
/// look away from each other, as those of a thin part, one would hold the node on the wrong side.
#define HAIRLOOM_BODY_FOLDS_BACK -0.2
#define HAIRLOOM_BODY_FOLDS_AHEAD 0.99

/// How fast hair follows a pose (docs/engine.md, "Poses"), 1/s: at most, and at an amount of a half. Metres
/// per second at which a far pose draws it.
#define HAIRLOOM_POSE_RATE 600.0
#define HAIRLOOM_POSE_HALF_RATE 10.0
#define HAIRLOOM_POSE_SPEED 2.5

#endif
