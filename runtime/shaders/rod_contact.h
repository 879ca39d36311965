// SPDX-License-Identifier: MIT
// How shapes hold a node of a rod, written once for C++ and HLSL as rod.h is (docs/engine.md, "Contacts").
// Who includes it has, beside what rod.h asks for, RodMask (what a comparison of numbers gives), both,
// either, choose (of numbers and of vectors) and minimum.
//
// The seam lies between what a shape is and how it holds: a shape, whatever it is, makes a RodTouch of a
// RodNode, and rodPress() makes a contact of that.
#if !defined(HAIRLOOM_ROD_CONTACT_FUNCTIONS) && defined(ROD_FUNCTION)
#define HAIRLOOM_ROD_CONTACT_FUNCTIONS

/// A node in a substep, at some guess of the substep's end.
struct RodNode {
    Real3 position;      ///< relative to the root at the end
    Real3 displacement;  ///< in the substep, world
    Real3 tangent;       ///< of the segment before it, world, unit length
    Real3 velocity;      ///< at the start, world
    Real3 faster;        ///< what the last substep added to that
    Real weight;         ///< m/(h_e² D)
    Real stiffness;      ///< of a contact
    Real load;           ///< force of its contacts in the last substep; negative where it slid
    Real step;           ///< h_e, seconds
    Real radius;         ///< metres that it keeps from shapes
    Real fresh;  ///< 1: a new contact slides by what friction leaves of its way; 0, beside skin and what
                 ///< bounces: by its way
};

/// A shape, as a node meets it: the plane that takes its place, in this substep, for this node.
struct RodTouch {
    Real3 normal;  ///< outwards, unit length, world
    Real depth;    ///< metres that the node, with its radius, is inside of the plane at the guess; negative:
                   ///< outside
    Real before;   ///< metres that it was inside of the shape at the start; negative: outside
    Real3 way;     ///< of the shape's surface there, in this substep, world
};

/// The contacts of a node: ½ c + g·x + ½ xᵀH x in its displacement x beyond the guess.
struct RodContact {
    Real hessian[6];  ///< xx, xy, xz, yy, yz, zz
    Real3 gradient;
    Real twiceEnergy;
    Real touching;  ///< 1 where there is any, 2 where friction gives way at one, 3 where it bounces off
    Real3 normal;   ///< sum of their normals
};

ROD_FUNCTION Real3 rodContactTimes(RodContact c, Real3 x) {
    return real3(mad(c.hessian[0], x.x, mad(c.hessian[1], x.y, c.hessian[2] * x.z)),
                 mad(c.hessian[1], x.x, mad(c.hessian[3], x.y, c.hessian[4] * x.z)),
                 mad(c.hessian[2], x.x, mad(c.hessian[4], x.y, c.hessian[5] * x.z)));
}
ROD_FUNCTION Real rodContactTwiceEnergy(RodContact c, Real3 x) {
    return c.twiceEnergy + dot(c.gradient + c.gradient + rodContactTimes(c, x), x);
}
/// On the node.
ROD_FUNCTION Real3 rodContactForce(RodContact c, Real3 x) {
    return c.gradient * ROD_NUMBER(-1.0) - rodContactTimes(c, x);
}

/// How many contacts act as one: as many as their normals agree, if they press equally. Friction by the force
/// of all would count as many times. 1 for a single one.
ROD_FUNCTION Real rodPressAlike(RodContact c) {
    const Real one = ROD_NUMBER(1.0), squared = dot(c.normal, c.normal);
    return choose(squared > ROD_NUMBER(1.01), root(squared), one);
}

/// Whether a shape holds the node, which may be outside by `slack` metres. What starts well inside it holds
/// at the surface, where it comes out.
ROD_FUNCTION RodMask rodHolds(RodTouch touch, Real slack) {
    return either(touch.depth > ROD_NUMBER(0.0) - slack,
                  touch.before > ROD_NUMBER(HAIRLOOM_ROD_CONTACT_DEEP));
}
/// What was pressed in the last substep is held while a prediction lifts it off by a little.
ROD_FUNCTION Real rodSlackAfter(Real load) {
    return choose(absolute(load) > ROD_NUMBER(0.0), ROD_NUMBER(HAIRLOOM_ROD_CONTACT_REACH), ROD_NUMBER(0.0));
}
/// What a step presses it has led along a plane, off a surface that curves away. `x`: beyond the guess.
ROD_FUNCTION Real rodSlackOf(RodContact c, Real3 x) {
    const RodMask pressed = dot(rodContactForce(c, x), c.normal) > ROD_NUMBER(0.0);
    const Real along = root(dot(x, x)) * ROD_NUMBER(HAIRLOOM_ROD_CONTACT_CURVED);
    return choose(pressed, maximum(along, ROD_NUMBER(HAIRLOOM_ROD_CONTACT_REACH)), ROD_NUMBER(0.0));
}

/// Adds what a shape that holds the node does to it: ½ k (depth − n·x)², which keeps it out, and
/// ½ g |T (slip + x)|², which holds it back along the surface. `pace`: one over the seconds of a substep.
ROD_FUNCTION void rodPress(RodTouch touch, RodMask held, RodNode node, Real pace, Real friction,
                           Real restitution, ROD_INOUT(RodContact) c) {
    const Real none = ROD_NUMBER(0.0);
    const Real3 n = touch.normal, moved = node.displacement - touch.way;
    const Real approach = dot(n, touch.way * pace - node.velocity);
    // What bounces leaves at a share of the speed that it came at, from where the substep found it.
    const RodMask bounces =
        both(approach * restitution > ROD_NUMBER(HAIRLOOM_ROD_CONTACT_SPEED), node.load == none);
    const Real back = (approach / pace - minimum(touch.before, none)) * restitution;
    const Real depth = touch.depth + choose(bounces, back, none);
    const Real k = choose(held, node.stiffness, none);
    // Coulomb, with the force of the last substep, of a new contact with what stops the node alone, and at
    // most what holds it. What slides goes on with the last change of its speed, and what has just come less
    // what friction takes of its own mass. What was stuck has hardly moved: where it gives way it slides by
    // what the force beyond friction does to that.
    const Real3 slip = negMad3(n, dot(n, moved), moved);
    const Real3 next = slip + negMad3(n, dot(n, node.faster), node.faster) * (ROD_NUMBER(1.0) / pace);
    const Real size = root(dot(slip, slip)), fresh = node.weight * maximum(depth, none);
    const Real most = choose(node.load == none, fresh, absolute(node.load)) * friction;
    const Real excess = maximum(mad(k, size, none - most), none) / node.weight;
    const Real goes = root(dot(next, next));
    const Real taken = choose(node.load == none, node.fresh * most / node.weight, none);
    const Real slid = choose(node.load > none, maximum(size, excess), maximum(goes - taken, none));
    const Real grip = minimum(most / maximum(slid, ROD_NUMBER(1e-12)), k);
    const Real g = choose(held, grip, none), push = k * depth;
    const Real3 nn = n * (k - g);
    c.hessian[0] = c.hessian[0] + mad(nn.x, n.x, g);
    c.hessian[1] = mad(nn.x, n.y, c.hessian[1]);
    c.hessian[2] = mad(nn.x, n.z, c.hessian[2]);
    c.hessian[3] = c.hessian[3] + mad(nn.y, n.y, g);
    c.hessian[4] = mad(nn.y, n.z, c.hessian[4]);
    c.hessian[5] = c.hessian[5] + mad(nn.z, n.z, g);
    c.gradient = c.gradient + negMad3(n, push, slip * g);
    c.twiceEnergy = c.twiceEnergy + mad(push, depth, g * dot(slip, slip));
    c.normal = c.normal + n * choose(held, ROD_NUMBER(1.0), none);
    const Real how = choose(bounces, ROD_NUMBER(3.0), choose(grip < k, ROD_NUMBER(2.0), ROD_NUMBER(1.0)));
    c.touching = choose(held, maximum(c.touching, how), c.touching);
}

/// A sphere, whose centre is given relative to the root at the end of the substep. With `sweeps` what would
/// come in in this substep meets it there, however fast it is.
ROD_FUNCTION RodTouch rodTouchSphere(RodNode node, Real3 centre, Real3 way, Real radius, bool sweeps) {
    const Real none = ROD_NUMBER(0.0), one = ROD_NUMBER(1.0), tiny = ROD_NUMBER(1e-9);
    const Real reach = radius + node.radius;
    const Real3 to = node.position - centre, moved = node.displacement - way, from = to - moved;
    const Real away = root(dot(centre, centre));
    const Real distance = maximum(root(dot(to, to)), tiny), distanceBefore = root(dot(from, from));
    // Differences of distances, which may be a million times as long, as quotients.
    const Real further = dot(node.position, to - centre) / maximum(distance + away, tiny);
    RodTouch touch;
    touch.normal = to * (one / distance);
    touch.depth = reach - away - further;
    touch.before = touch.depth + dot(moved, from + to) / maximum(distance + distanceBefore, tiny);
    touch.way = way;
    if (sweeps) {
        const Real a = dot(moved, moved), b = dot(from, moved),
                   c = (none - touch.before) * (reach + distanceBefore);
        const Real discriminant = negMad(a, c, b * b);
        const Real first = (none - b - root(maximum(discriminant, none))) / maximum(a, ROD_NUMBER(1e-30));
        const RodMask enters = both(both(c >= none, discriminant > none), both(first >= none, first < one));
        const Real3 entry = mad3(moved, first, from) * (one / reach);
        // It passes the plane there by the rest of its way.
        touch.normal = choose(enters, entry, touch.normal);
        touch.depth = choose(enters, dot(entry, moved) * (first - one), touch.depth);
    }
    return touch;
}

#endif
