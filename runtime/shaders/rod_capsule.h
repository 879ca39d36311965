// SPDX-License-Identifier: MIT
// The sphere of a tapered capsule that a point meets, written once for C++ and HLSL as rod.h is
// (docs/engine.md, "Contacts"). Who includes it has what rod_contact.h asks for.
#if !defined(HAIRLOOM_ROD_CAPSULE_FUNCTIONS) && defined(ROD_FUNCTION)
#define HAIRLOOM_ROD_CAPSULE_FUNCTIONS

/// The hull of two spheres that move, in a substep.
struct RodCapsule {
    Real3 from, axis;  ///< centre of the first one at the end, in any space; from it to that of the second
    Real3 step, turn;  ///< way of the first one in the substep; what the second goes more than that
    Real radius;       ///< metres, of the first one
    Real narrows;      ///< metres that the second one is smaller
    Real thinnest;     ///< the lesser radius
};
/// A sphere of it.
struct RodCapsuleSphere {
    Real3 centre, step;
    Real radius;
};

/// At a share of the axis, 0…1 or beyond, which is an end.
ROD_FUNCTION RodCapsuleSphere rodCapsuleSphereAt(RodCapsule c, Real share) {
    const Real s = minimum(maximum(share, ROD_NUMBER(0.0)), ROD_NUMBER(1.0));
    RodCapsuleSphere sphere;
    sphere.centre = mad3(c.axis, s, c.from);
    sphere.step = mad3(c.turn, s, c.step);
    sphere.radius = negMad(c.narrows, s, c.radius);
    return sphere;
}

/// Whether one end holds the other.
ROD_FUNCTION RodMask rodCapsuleIsSphere(RodCapsule c, Real size) {
    return size <= absolute(c.narrows);
}

/// The sphere whose surface is nearest to a point, by signed distance.
ROD_FUNCTION RodCapsuleSphere rodCapsuleNearest(RodCapsule c, Real3 position) {
    const Real one = ROD_NUMBER(1.0), none = ROD_NUMBER(0.0), size = root(dot(c.axis, c.axis));
    const Real inverse = one / size;
    const Real3 to = position - c.from;
    const Real place = dot(to, c.axis * inverse);
    // The surface's normal leans by the cone's angle, of sine `lean`, off the perpendicular.
    const Real lean = c.narrows / size;
    const Real off = root(maximum(dot(to, to) - place * place, none));
    const Real share = negMad(off, lean / root(one - lean * lean), place) * inverse;
    const Real wider = choose(c.narrows > none, none, one);
    return rodCapsuleSphereAt(c, choose(rodCapsuleIsSphere(c, size), wider, share));
}

/// `nearest`, but for a point that has come through the capsule in this substep and is out again: the sphere
/// where its way, less that of the capsule, is nearest to the axis. `reach`: radius of the point.
ROD_FUNCTION RodCapsuleSphere rodCapsuleMet(RodCapsule c, Real3 position, Real3 displacement, Real reach,
                                            RodCapsuleSphere nearest) {
    const Real one = ROD_NUMBER(1.0), none = ROD_NUMBER(0.0), size = root(dot(c.axis, c.axis));
    const Real3 way = displacement - nearest.step, end = position - nearest.centre;
    const Real slow = ROD_NUMBER(HAIRLOOM_UNSWEPT_SHARE) * c.thinnest, outside = nearest.radius + reach;
    const RodMask passes = both(dot(way, way) > slow * slow, dot(end, end) > outside * outside);
    const Real3 to = position - c.from, along = c.axis * (one / size);
    const Real3 across = negMad3(along, dot(way, along), way);
    const Real3 away = negMad3(along, dot(to, along), to);
    const Real back = dot(away, across) / maximum(dot(across, across), ROD_NUMBER(1e-20));
    const Real3 closest = negMad3(way, back, to);
    const RodCapsuleSphere between = rodCapsuleSphereAt(c, dot(closest, along) * (one / size));
    const Real3 apart = closest + c.from - between.centre;
    const Real inside = between.radius + reach;
    const RodMask within = both(both(back > none, back < one), dot(apart, apart) < inside * inside);
    const RodMask which = both(both(passes, within), absolute(c.narrows) < size);
    RodCapsuleSphere met;
    met.centre = choose(which, between.centre, nearest.centre);
    met.step = choose(which, between.step, nearest.step);
    met.radius = choose(which, between.radius, nearest.radius);
    return met;
}

#endif
