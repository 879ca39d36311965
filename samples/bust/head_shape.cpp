// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/bust/head_shape.h"

#include <algorithm>
#include <cmath>

namespace hairloom::bust {
namespace {

// Millimetres from the middle between the eyes, level with the ears' front: x to the head's left, y up, z
// forward.

/// Cubic smooth minimum (Quilez 2013): twice differentiable, blends within k millimetres.
double join(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * h * k / 6.0;
}
double carve(double a, double b, double k) {
    return -join(-a, b, k);
}

double ellipsoid(const Vec3d& p, const Vec3d& centre, const Vec3d& radii) {
    const Vec3d q = (p - centre).cwiseQuotient(radii);
    const double slope = q.cwiseQuotient(radii).norm();
    const double length = q.norm();
    return length < 1e-9 ? -radii.minCoeff() : length * (length - 1.0) / slope;
}

/// A capsule whose radius goes linearly from ra at a to rb at b.
double limb(const Vec3d& p, const Vec3d& a, const Vec3d& b, double ra, double rb) {
    const Vec3d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - a - t * along).norm() - (ra + t * (rb - ra));
}

double bell(double x, double width) {
    return std::exp(-(x / width) * (x / width));
}
double ramp(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// The ear's own axes: u backwards along the ear from where it is attached, v up, w out of its plane.
Vec3d earFrame(const Vec3d& p) {
    static const Vec3d origin(66.0, -15.0, 6.0);
    static const Eigen::Matrix3d axes = [] {
        const double flare = 0.40;
        const double lean = 0.16;
        const Vec3d back(std::sin(flare), 0.0, -std::cos(flare));
        const Vec3d out(std::cos(flare), 0.0, std::sin(flare));
        const Vec3d up = (std::cos(lean) * Vec3d::UnitY() + std::sin(lean) * back).normalized();
        Eigen::Matrix3d m;
        m.row(0) = up.cross(out).dot(back) > 0 ? up.cross(out) : out.cross(up);
        m.row(1) = up;
        m.row(2) = out;
        return m;
    }();
    return axes * (p - origin);
}

/// Signed distance (about) to the outline of the ear in its plane, an egg with the wide end on top.
double earOutline(const Vec3d& ear) {
    const double v = ear.y() / 31.0;
    const double halfWidth = 15.5 + 4.0 * std::clamp(v, -1.3, 1.3);
    const double u = (ear.x() - 14.0) / halfWidth;
    return (std::sqrt(u * u + v * v + 1e-6) - 1.0) * 17.0;
}

double earDistance(const Vec3d& p) {
    const Vec3d e = earFrame(p);
    const double outline = earOutline(e);
    if (std::abs(e.z()) > 40.0 || outline > 40.0) return std::max(std::abs(e.z()) - 10.0, outline);
    const double inside = ramp(-15.0, -1.0, outline);
    const double dish = -9.0 + 11.0 * inside;
    double d = carve(std::abs(e.z() - dish) - 2.6, -(outline + 1.0), 4.0);
    // The rolled rim runs round the top and the back and ends above the lobe.
    const double rimHere = ramp(-24.0, -10.0, e.y() + 0.25 * e.x()) * ramp(-4.0, 4.0, e.x() + 0.35 * e.y());
    d = join(d, std::hypot(outline + 1.5, e.z() - 3.2) - 3.2 + 3.0 * (1.0 - rimHere), 2.5);
    const double foldHere = ramp(-20.0, -8.0, e.y()) * ramp(8.0, 15.0, e.x());
    d = join(d, std::hypot(outline + 8.5, e.z() - 0.5) - 2.6 + 3.0 * (1.0 - foldHere), 3.0);
    d = join(d, ellipsoid(e, {9.5, -25.5, 0.8}, {7.0, 7.5, 3.6}), 5.0);
    d = join(d, ellipsoid(e, {1.0, -6.0, 0.0}, {4.5, 6.5, 4.5}), 5.0);
    d = join(d, ellipsoid(e, {9.0, 0.0, -10.0}, {13.0, 22.0, 9.0}), 7.0);
    return d;
}

double skull(const Vec3d& p, const Vec3d& s) {
    double d = ellipsoid(p, {0, 30, -8}, {76, 84, 95});
    d = join(d, ellipsoid(p, {0, 32, 22}, {66, 66, 69}), 30.0);
    d = join(d, ellipsoid(p, {0, -12, -12}, {67, 62, 70}), 30.0);
    d = join(d, ellipsoid(p, {0, -36, 30}, {57, 74, 58}), 25.0);
    d = join(d, limb(s, {48, -58, 8}, {14, -97, 70}, 14, 14), 26.0);
    d = join(d, ellipsoid(s, {43, -24, 50}, {21, 17, 26}), 34.0);
    d = join(d, ellipsoid(s, {27, -44, 56}, {24, 30, 26}), 30.0);
    return d;
}

double eyes(double d, const Vec3d& s) {
    d = join(d, limb(s, {12, 17, 82}, {46, 17, 66}, 9, 8), 16.0);
    d = carve(d, ellipsoid(s, {31, 0, 92}, {20, 11, 15}), 16.0);
    d = join(d, ellipsoid(s, {31.5, -1.5, 68.5}, {15.5, 13.5, 14.5}), 5.0);
    const double across = (s.x() - 31.5) / 15.0;
    const double onLid = ramp(1.25, 0.8, std::abs(across)) * ramp(60.0, 70.0, s.z());
    const double lashes = -7.0 + 3.0 * across * across;
    const double crease = 6.5 - 5.0 * across * across;
    d += onLid * (1.1 * bell(s.y() - lashes, 2.2) - 0.4 * bell(s.y() - lashes - 4.0, 2.6));
    d += onLid * 0.8 * bell(s.y() - crease, 2.8);
    return d;
}

double nose(double d, const Vec3d& p, const Vec3d& s) {
    d = join(d, limb(p, {0, 12, 82}, {0, -38, 100}, 7.0, 9.0), 18.0);
    d = join(d, ellipsoid(p, {0, -39, 102}, {10.5, 9.0, 11.0}), 11.0);
    d = join(d, ellipsoid(s, {11.5, -43, 94}, {6.0, 6.5, 10.0}), 9.0);
    return carve(d, ellipsoid(s, {6.0, -51.5, 100}, {3.4, 4.5, 5.5}), 4.0);
}

double mouthAndChin(double d, const Vec3d& p, const Vec3d& s) {
    d = join(d, ellipsoid(p, {0, -70, 68}, {34, 27, 25}), 22.0);
    d = join(d, limb(s, {4, -65.5, 91.5}, {22, -70.5, 81}, 5.8, 2.4), 6.0);
    d = join(d, limb(s, {0, -77, 90.5}, {20, -72.5, 81.5}, 6.8, 2.4), 6.0);
    d = carve(d, limb(s, {0, -53, 104}, {0, -61, 101}, 3.0, 3.4), 5.0);
    const double line =
        -71.0 + 1.2 * bell(s.x() - 8.0, 7.0) - 1.0 * bell(s.x(), 5.0) - 0.6 * ramp(10.0, 24.0, s.x());
    d += 1.9 * ramp(28.0, 18.0, s.x()) * ramp(68.0, 78.0, s.z()) * bell(s.y() - line, 2.3);
    d = join(d, ellipsoid(p, {0, -100, 76}, {21, 14, 15}), 16.0);
    return d;
}

double torso(const Vec3d& p, const Vec3d& s) {
    double d = limb(p, {0, -40, -22}, {0, -190, -42}, 48, 50);
    d = join(d, limb(s, {54, -48, -22}, {12, -186, 6}, 9, 8), 22.0);
    d = carve(d, limb(p, {0, -186, 30}, {0, -192, 26}, 8, 8), 18.0);
    double body = ellipsoid(p, {0, -280, -42}, {152, 92, 74});
    body = join(body, limb(s, {20, -190, -52}, {150, -226, -48}, 30, 34), 40.0);
    body = join(body, ellipsoid(s, {150, -250, -42}, {44, 52, 48}), 30.0);
    d = join(d, limb(s, {16, -132, -52}, {84, -206, -50}, 24, 26), 45.0);
    d = join(d, body, 45.0);
    d = join(d, limb(s, {14, -193, 8}, {140, -208, -22}, 7, 8), 24.0);
    // The cut: a bowl that leaves the shoulders rounded and closes the bust below.
    return carve(d, -ellipsoid(p, {0, -165, -34}, {154, 150, 110}), 16.0);
}

}  // namespace

double surface(const Vec3d& point) {
    const Vec3d p = 1000.0 * (point - Vec3d(0, kEyeHeight, 0));
    // Mirrored parts see a softened |x|, so that they meet the middle without a crease.
    const Vec3d s(std::sqrt(p.x() * p.x() + 9.0), p.y(), p.z());
    double d = skull(p, s);
    d = mouthAndChin(d, p, s);
    d = eyes(d, s);
    d = nose(d, p, s);
    d = join(d, torso(p, s), 20.0);
    d = join(d, earDistance(s), 6.0);
    return 0.001 * d;
}

Vec3d gradient(const Vec3d& p) {
    const double h = 1e-5;
    Vec3d g;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d step = Vec3d::Zero();
        step[axis] = h;
        g[axis] = (surface(p + step) - surface(p - step)) / (2.0 * h);
    }
    return g;
}

Vec3d project(Vec3d p) {
    for (int step = 0; step < 12; ++step) {
        const double d = surface(p);
        if (std::abs(d) < 1e-9) break;
        const Vec3d g = gradient(p);
        p -= g * (std::clamp(d, -0.002, 0.002) / std::max(g.squaredNorm(), 0.1));
    }
    return p;
}

double border(Border which, const Vec3d& point) {
    const Vec3d p = 1000.0 * (point - Vec3d(0, kEyeHeight, 0));
    const Vec3d s(std::sqrt(p.x() * p.x() + 9.0), p.y(), p.z());
    switch (which) {
        case Border::Ear: {
            const Vec3d e = earFrame(s);
            return 0.001 * std::max(earOutline(e) - 5.0, std::abs(e.z()) - 30.0);
        }
        case Border::Hairline: {
            // Height of the hairline over the angle about the vertical, 0 in front, 1 at the back.
            const double turn = std::atan2(s.x(), s.z() + 5.0) / 3.14159265358979;
            double line = 71.0 + 5.0 * bell(turn - 0.16, 0.10);
            line += (18.0 - line) * ramp(0.15, 0.37, turn);
            line += (-26.0 - line) * ramp(0.35, 0.46, turn);
            line += (-68.0 - line) * ramp(0.54, 0.84, turn);
            return 0.001 * (line - p.y());
        }
        case Border::Jaw: {
            // Under the jaw: a sheet that rises from below the chin to the ear lobes.
            const double back = std::max(0.0, 14.0 - p.z());
            return 0.001 * (-106.0 - p.y() + (75.0 - p.z()) * 0.62 + 0.05 * back * back);
        }
        case Border::Collar: {
            const double fall = p.z() * -0.12;
            return 0.001 * (p.y() + 172.0 - fall);
        }
        case Border::Seam:
            return 0.001 * (p.z() + 36.0);
    }
    return 0.0;
}

Group groupOf(Patch patch) {
    switch (patch) {
        case Patch::Scalp:
            return Group::Scalp;
        case Patch::Face:
            return Group::Face;
        case Patch::Ear:
            return Group::Ears;
        case Patch::NeckFront:
        case Patch::NeckBack:
            return Group::Neck;
        case Patch::ShouldersFront:
        case Patch::ShouldersBack:
            break;
    }
    return Group::Shoulders;
}

Border borderBetween(Patch a, Patch b) {
    const auto either = [&](Group group) { return groupOf(a) == group || groupOf(b) == group; };
    if (groupOf(a) == groupOf(b)) return Border::Seam;
    if (either(Group::Ears)) return Border::Ear;
    if (either(Group::Scalp)) return Border::Hairline;
    return either(Group::Shoulders) ? Border::Collar : Border::Jaw;
}

double edgeLength(const Vec3d& point) {
    const Vec3d p = 1000.0 * (point - Vec3d(0, kEyeHeight, 0));
    const Vec3d s(std::abs(p.x()), p.y(), p.z());
    const auto near = [&](const Vec3d& centre, const Vec3d& radii, double fine, double growth) {
        return fine + growth * std::max(0.0, ellipsoid(s, centre, radii));
    };
    double length = 8.5 + 0.05 * std::max(0.0, -100.0 - p.y());
    length = std::min(length, near({20, -98, 30}, {40, 16, 50}, 5.0, 0.10));
    length = std::min(length, near({31, -1, 80}, {17, 8, 20}, 1.8, 0.16));
    length = std::min(length, near({0, -54, 100}, {20, 28, 22}, 2.1, 0.20));
    length = std::min(length, near({0, -72, 92}, {24, 5, 16}, 1.7, 0.16));
    const double ear = std::max(0.0, earOutline(earFrame(s)));
    length = std::min(length, 2.3 + 0.22 * std::max(ear, std::abs(earFrame(s).z()) - 16.0));
    return 0.001 * std::min(length, 14.0);
}

}  // namespace hairloom::bust
