// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hairloom {
namespace {

using Corners = TriangleTree::Corners;

constexpr std::uint32_t kLeaf = 2;
constexpr std::size_t kDepth = 64;  ///< halving 2³² triangles leads less deep
/// Distances to boxes are in single precision; this much less than one of them is surely less than the exact.
constexpr float kRounded = 1 - 1e-5f;

Eigen::Array4f wide(const Vec3f& v) {
    return {v.x(), v.y(), v.z(), 0};
}

float squaredDistance(const Eigen::Array4f& low, const Eigen::Array4f& high, const Eigen::Array4f& point) {
    return kRounded * (low - point).max(point - high).max(0.0f).matrix().squaredNorm();
}

/// Of the triangle's point nearest to p (Ericson 2005, Real-Time Collision Detection, 5.1.5).
Vec3d nearestBarycentric(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3d bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double t = d1 / (d1 - d3);
        return {1 - t, t, 0};
    }
    const Vec3d cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double t = d2 / (d2 - d6);
        return {1 - t, 0, t};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - t, t};
    }
    const double sum = va + vb + vc;
    return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

/// A ray in the terms of its boxes.
struct Ray {
    Eigen::Array4f origin, inverse;

    Ray(const Vec3f& from, const Vec3f& direction) : origin(wide(from)), inverse(wide(direction).inverse()) {}
    /// Where it enters the box, in lengths of its direction; infinity where it does not. A side that it runs
    /// along, 0 · ∞, bounds nothing.
    float enters(const Eigen::Array4f& low, const Eigen::Array4f& high) const {
        float enter = 0, leave = std::numeric_limits<float>::infinity();
        for (Eigen::Index i = 0; i < 3; ++i) {
            const float a = (low[i] - origin[i]) * inverse[i], b = (high[i] - origin[i]) * inverse[i];
            if (std::isnan(a) || std::isnan(b)) continue;
            enter = std::max(enter, std::min(a, b) * kRounded);
            leave = std::min(leave, std::max(a, b) * (2 - kRounded));
        }
        return enter <= leave ? enter : std::numeric_limits<float>::infinity();
    }
};

/// Möller and Trumbore (1997), both sides.
std::optional<TriangleTree::Hit> meet(const Vec3d& origin, const Vec3d& direction, const Corners& corners) {
    const Vec3d a = corners.a.cast<double>();
    const Vec3d ab = corners.b.cast<double>() - a, ac = corners.c.cast<double>() - a;
    const Vec3d across = direction.cross(ac);
    const double volume = ab.dot(across);
    const double scale = ab.norm() * ac.norm() * direction.norm();
    constexpr double kParallel = 1e-12, kOnEdge = 1e-9;
    if (!(std::abs(volume) > kParallel * scale)) return std::nullopt;
    const Vec3d from = origin - a;
    const double v = from.dot(across) / volume;
    const Vec3d turned = from.cross(ab);
    const double w = direction.dot(turned) / volume;
    // Rays between two triangles meet one of them.
    if (v < -kOnEdge || w < -kOnEdge || v + w > 1 + kOnEdge) return std::nullopt;
    const double along = ac.dot(turned) / volume;
    if (along < 0) return std::nullopt;
    Vec3d barycentric = Vec3d(1 - v - w, v, w).cwiseMax(0.0);
    barycentric /= barycentric.sum();
    return TriangleTree::Hit{0, barycentric, origin + along * direction, along};
}

/// Under which a point sees a triangle, positive from behind (Van Oosterom and Strackee 1983).
double solidAngle(const Vec3d& p, const Corners& corners) {
    const Vec3d a = corners.a.cast<double>() - p, b = corners.b.cast<double>() - p,
                c = corners.c.cast<double>() - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    return 2 * std::atan2(a.dot(b.cross(c)), below);
}

/// Nodes that are still to be looked at, and how near they are at least.
struct Pending {
    struct Entry {
        std::uint32_t node;
        float near;
    };
    std::array<Entry, kDepth> entries;
    std::size_t count = 0;

    void push(std::uint32_t node, float near) { entries[count++] = {node, near}; }
    /// The nearer one on top.
    void pushBoth(Entry a, Entry b) {
        if (a.near < b.near) std::swap(a, b);
        entries[count++] = a;
        entries[count++] = b;
    }
    Entry pop() { return entries[--count]; }
};

}  // namespace

TriangleTree::TriangleTree(std::span<const Corners> triangles, Winding winding) : order_(triangles.size()) {
    if (triangles.empty()) return;
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<Vec3f> centres(triangles.size());
    std::ranges::transform(triangles, centres.begin(),
                           [](const Corners& t) -> Vec3f { return (t.a + t.b + t.c) / 3; });
    corners_.assign(triangles.begin(), triangles.end());
    nodes_.reserve(2 * triangles.size() / kLeaf + 2);
    build(centres, 0, static_cast<std::uint32_t>(triangles.size()));
    for (std::size_t i = 0; i < order_.size(); ++i) corners_[i] = triangles[order_[i]];
    if (winding == Winding::yes) sumDipoles();
}

void TriangleTree::build(std::span<const Vec3f> centres, std::uint32_t first, std::uint32_t count) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    Box3f box, middles;
    const auto begin = order_.begin() + first, end = begin + count;
    for (auto i = begin; i != end; ++i) {
        for (const Vec3f& corner : {corners_[*i].a, corners_[*i].b, corners_[*i].c}) box.extend(corner);
        middles.extend(centres[*i]);
    }
    nodes_[index] = {wide(box.min()), wide(box.max()), first, count};
    if (count <= kLeaf) return;
    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::uint32_t half = count / 2;
    std::nth_element(begin, begin + half, end, [&](std::uint32_t a, std::uint32_t b) {
        return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
    });
    build(centres, first, half);
    nodes_[index].next = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].count = 0;
    build(centres, first + half, count - half);
}

void TriangleTree::sumDipoles() {
    dipoles_.resize(nodes_.size());
    // Children come after their parents.
    for (std::size_t index = nodes_.size(); index-- > 0;) {
        const Node& node = nodes_[index];
        Dipole& sum = dipoles_[index];
        sum = {Vec3d::Zero(), Vec3d::Zero(), 0, 0};
        const auto add = [&](const Vec3d& centre, const Vec3d& normal, double area) {
            sum.centre += area * centre;
            sum.normal += normal;
            sum.area += area;
        };
        if (node.count == 0) {
            for (const std::size_t child : {index + 1, std::size_t{node.next}})
                add(dipoles_[child].centre, dipoles_[child].normal, dipoles_[child].area);
        }
        for (std::uint32_t i = node.next; i < node.next + node.count; ++i) {
            const Vec3d a = corners_[i].a.cast<double>(), b = corners_[i].b.cast<double>(),
                        c = corners_[i].c.cast<double>();
            const Vec3d normal = 0.5 * (b - a).cross(c - a);
            add((a + b + c) / 3, normal, normal.norm());
        }
        const Vec3d low = node.low.head<3>().cast<double>(), high = node.high.head<3>().cast<double>();
        sum.centre = sum.area > 0 ? Vec3d(sum.centre / sum.area) : Vec3d((low + high) / 2);
        sum.radius = (sum.centre - low).cwiseAbs().cwiseMax((high - sum.centre).cwiseAbs()).norm();
    }
}

double TriangleTree::windingNumber(const Vec3f& point) const {
    assert(dipoles_.size() == nodes_.size());
    if (nodes_.empty() || !point.allFinite()) return 0;
    // Farther away than so many radii a node is one dipole (Barill et al. 2018, Eq. 18).
    constexpr double kFar = 3;
    const Vec3d p = point.cast<double>();
    double fourPi = 0;
    Pending pending;
    pending.push(0, 0);
    while (pending.count > 0) {
        const std::uint32_t index = pending.pop().node;
        const Node& node = nodes_[index];
        const Dipole& dipole = dipoles_[index];
        const Vec3d to = dipole.centre - p;
        const double squared = to.squaredNorm();
        if (squared > kFar * kFar * dipole.radius * dipole.radius) {
            fourPi += to.dot(dipole.normal) / (squared * std::sqrt(squared));
            continue;
        }
        if (node.count == 0) {
            pending.pushBoth({index + 1, 0}, {node.next, 0});
            continue;
        }
        for (std::uint32_t i = node.next; i < node.next + node.count; ++i)
            fourPi += solidAngle(p, corners_[i]);
    }
    return fourPi / (4 * std::numbers::pi);
}

std::optional<TriangleTree::Hit> TriangleTree::closest(const Vec3f& point) const {
    if (nodes_.empty() || !point.allFinite()) return std::nullopt;
    const Eigen::Array4f p = wide(point);
    const Vec3d exact = point.cast<double>();
    Hit best{0, Vec3d::Zero(), Vec3d::Zero(), std::numeric_limits<double>::infinity()};
    const auto distanceTo = [&](std::uint32_t node) {
        return squaredDistance(nodes_[node].low, nodes_[node].high, p);
    };
    Pending pending;
    pending.push(0, distanceTo(0));
    while (pending.count > 0) {
        const auto [index, near] = pending.pop();
        // `best.distance` is squared until the end.
        if (near > best.distance) continue;
        const Node& node = nodes_[index];
        if (node.count == 0) {
            pending.pushBoth({index + 1, distanceTo(index + 1)}, {node.next, distanceTo(node.next)});
            continue;
        }
        for (std::uint32_t i = node.next; i < node.next + node.count; ++i) {
            const Vec3d a = corners_[i].a.cast<double>(), b = corners_[i].b.cast<double>(),
                        c = corners_[i].c.cast<double>();
            const Vec3d weights = nearestBarycentric(exact, a, b, c);
            const Vec3d position = weights.x() * a + weights.y() * b + weights.z() * c;
            const double distance = (exact - position).squaredNorm();
            if (distance < best.distance || (distance == best.distance && order_[i] < best.triangle))
                best = {order_[i], weights, position, distance};
        }
    }
    if (!std::isfinite(best.distance)) return std::nullopt;
    best.distance = std::sqrt(best.distance);
    return best;
}

std::optional<TriangleTree::Hit> TriangleTree::firstHit(const Vec3f& origin, const Vec3f& direction) const {
    if (nodes_.empty()) return std::nullopt;
    const Ray ray(origin, direction);
    const Vec3d from = origin.cast<double>(), along = direction.cast<double>();
    std::optional<Hit> best;
    const auto enters = [&](std::uint32_t node) { return ray.enters(nodes_[node].low, nodes_[node].high); };
    const auto isBehind = [&](float near) { return !std::isfinite(near) || (best && near > best->distance); };
    Pending pending;
    pending.push(0, enters(0));
    while (pending.count > 0) {
        const auto [index, near] = pending.pop();
        if (isBehind(near)) continue;
        const Node& node = nodes_[index];
        if (node.count == 0) {
            pending.pushBoth({index + 1, enters(index + 1)}, {node.next, enters(node.next)});
            continue;
        }
        for (std::uint32_t i = node.next; i < node.next + node.count; ++i) {
            auto hit = meet(from, along, corners_[i]);
            if (!hit || (best && (hit->distance > best->distance ||
                                  (hit->distance == best->distance && order_[i] > best->triangle))))
                continue;
            best = *hit;
            best->triangle = order_[i];
        }
    }
    return best;
}

}  // namespace hairloom
