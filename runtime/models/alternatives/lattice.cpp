// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/checks.h"
#include "engine/in_parallel.h"
#include "models/alternatives/surroundings.h"

namespace hairloom::runtime {
namespace {

constexpr float kThinnest = 1e-3f;  // metres, of a cell: flat hair spans a volume too
constexpr int kMaxIterations = 24;
constexpr double kSolved = 1e-10;  // share of the squared residual at which iterations end
constexpr std::size_t kPointsPerJob = 4096;
constexpr int kRounds = 8;  // of pushes out of spheres that overlap

/// Control points and weights of one axis at `cells`: uniform quadratic B-spline.
struct Spline {
    std::size_t first;
    std::array<float, 3> weights;
};
Spline splineAt(float cells, std::uint32_t nodes) {
    const float middle = std::clamp(std::round(cells), 1.0f, static_cast<float>(nodes - 2));
    const float t = cells - middle;
    return {static_cast<std::size_t>(middle) - 1,
            {0.5f * (0.5f - t) * (0.5f - t), 0.75f - t * t, 0.5f * (0.5f + t) * (0.5f + t)}};
}

/// body(node, weight) for the 27 control points around a position.
template <class Body>
void forControlPoints(Float3 cells, std::uint32_t nodes, const Body& body) {
    const Spline x = splineAt(cells.x, nodes), y = splineAt(cells.y, nodes), z = splineAt(cells.z, nodes);
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t row = ((z.first + k) * nodes + y.first + j) * nodes + x.first;
            const float weight = z.weights[k] * y.weights[j];
            for (std::size_t i = 0; i < 3; ++i) body(row + i, weight * x.weights[i]);
        }
    }
}

float squaredRate(float frequency) {
    const float rate = 2.0f * std::numbers::pi_v<float> * frequency;
    return rate * rate;
}

std::string validationError(const LatticeSettings& s) {
    std::string text;
    const auto check = [&](const char* name, float value, double low, double high) {
        refuseOutside(text, name, static_cast<double>(value), low, high);
    };
    refuseOutside(text, "nodes", s.nodes, 3.0, 16.0);
    check("rootFrequency", s.rootFrequency, static_cast<double>(0.1f), 1000.0);
    check("tipFrequency", s.tipFrequency, static_cast<double>(0.1f), 1000.0);
    check("couplingFrequency", s.couplingFrequency, 0.0, 1000.0);
    check("dampingTime", s.dampingTime, 0.0, 100.0);
    check("airDrag", s.airDrag, 0.0, 1000.0);
    for (const float v : {s.wind.x, s.wind.y, s.wind.z}) check("wind", v, -200.0, 200.0);
    for (const float v : {s.gravity.x, s.gravity.y, s.gravity.z}) check("gravity", v, -1000.0, 1000.0);
    check("teleportDistance", s.teleportDistance, static_cast<double>(0.01f), 10000.0);
    refuseOutside(text, "substeps", s.substeps, 1.0, 64.0);
    refuseOutside(text, "clampedPoints", s.clampedPoints, 1.0, 2.0);
    check("collisionRadiusRoot", s.collisionRadiusRoot, 0.0, static_cast<double>(0.1f));
    check("collisionRadiusTip", s.collisionRadiusTip, 0.0, static_cast<double>(0.1f));
    return text;
}

}  // namespace

Lattice::Result Lattice::make(const StrandsView& strands, const LatticeSettings& settings, Host host) {
    std::string error = validationError(settings);
    if (error.empty()) error = validationError(strands);
    if (error.empty() && strands.restPositions_ss.empty()) error = "no strands; expected one at least";
    if (!error.empty()) return {std::nullopt, std::move(error)};
    Lattice lattice;
    lattice.settings_ = settings;
    lattice.host_ = std::move(host);
    lattice.layOut(strands);
    lattice.attach(strands);
    lattice.reset({});
    return {std::move(lattice), {}};
}

/// The hair's box takes the cells from ½ to nodes − 1½, where the spline has all its control points.
void Lattice::layOut(const StrandsView& strands) {
    Float3 low = strands.restPositions_ss[0], high = low;
    for (const Float3& p : strands.restPositions_ss) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const std::uint32_t n = settings_.nodes;
    const float across = static_cast<float>(n - 2);
    const Float3 cell{std::max((high.x - low.x) / across, kThinnest),
                      std::max((high.y - low.y) / across, kThinnest),
                      std::max((high.z - low.z) / across, kThinnest)};
    for (std::uint32_t i = 0; i < n * n * n; ++i) {
        Node node{};
        node.rest_ss = low + Float3{cell.x * (static_cast<float>(i % n) - 0.5f),
                                    cell.y * (static_cast<float>(i / n % n) - 0.5f),
                                    cell.z * (static_cast<float>(i / n / n) - 0.5f)};
        nodes_.push_back(node);
    }
    points_.reserve(strands.restPositions_ss.size());
    for (const Float3& p : strands.restPositions_ss) {
        points_.push_back(
            {p,
             {(p.x - low.x) / cell.x + 0.5f, (p.y - low.y) / cell.y + 0.5f, (p.z - low.z) / cell.z + 0.5f},
             0.0f});
    }
    const float root = settings_.collisionRadiusRoot, tip = settings_.collisionRadiusTip;
    for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s) {
        const std::uint32_t first = strands.offsets[s], last = strands.offsets[s + 1] - 1;
        const std::uint32_t free = std::min(first + settings_.clampedPoints, last + 1);
        for (std::uint32_t p = first; p < free; ++p) points_[p].radius = -1.0f;
        for (std::uint32_t p = free; p <= last; ++p)
            points_[p].radius =
                root + (tip - root) * static_cast<float>(p - first) / static_cast<float>(last - first);
    }
}

void Lattice::attach(const StrandsView& strands) {
    struct Sum {
        double along = 0.0, weight = 0.0;
    };
    std::vector<Sum> sums(nodes_.size());
    for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s) {
        const std::uint32_t root = strands.offsets[s], end = strands.offsets[s + 1];
        for (std::uint32_t p = root; p < end; ++p) {
            const double along = static_cast<double>(p - root) / static_cast<double>(end - root - 1);
            forControlPoints(points_[p].cells, settings_.nodes, [&](std::size_t node, float weight) {
                sums[node].along += along * static_cast<double>(weight);
                sums[node].weight += static_cast<double>(weight);
            });
        }
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double tip = sums[i].weight > 1e-6 ? sums[i].along / sums[i].weight : 0.0;
        nodes_[i].attachment =
            squaredRate(settings_.rootFrequency +
                        (settings_.tipFrequency - settings_.rootFrequency) * static_cast<float>(tip));
    }
}

void Lattice::reset(const RootFrame& head_ws) {
    head_ = head_ws;
    if (!usableWithin(head_, kFarthest)) head_ = {};
    report_ = {};
    spheres_.clear();
    for (Node& node : nodes_) node.displacement = node.velocity = node.headVelocity = {};
}

void Lattice::step(const RootFrame& head_ws, float dt, std::span<const Sphere> spheres_ws) {
    if (!(dt > 0.0f) || !std::isfinite(dt)) return;
    report_ = {};
    RootFrame to = head_ws;
    if (!usableWithin(to, kFarthest)) to = head_;
    const bool teleported = length(to.position - head_.position) > settings_.teleportDistance;
    if (teleported) {
        const Quat turn = to.rotation * conjugate(head_.rotation);
        for (Node& node : nodes_) {
            node.displacement = rotate(turn, node.displacement);
            node.velocity = rotate(turn, node.velocity);
            node.headVelocity = rotate(turn, node.headVelocity);
        }
        head_ = to;
    }
    const RootFrame from = head_;
    const float count = static_cast<float>(settings_.substeps);
    const float h = std::clamp(dt, 1e-6f, 1000.0f) / count;
    RootFrame before = from;
    for (std::uint32_t i = 0; i < settings_.substeps; ++i) {
        const RootFrame now = between(from, to, static_cast<float>(i + 1) / count);
        advance(before, now, teleported, h);
        before = now;
    }
    head_ = to;
    spheres_.clear();
    for (const Sphere& sphere : spheres_ws) {
        if (isFinite(sphere.center_ws) && sphere.radius > 0.0f && std::isfinite(sphere.radius))
            spheres_.push_back(sphere);
    }
    if (!spheres_.empty()) collide();
}

Float3 Lattice::positionOf(const Point& point) const {
    return head_.position + (rotate(head_.rotation, point.rest_ss) + displacementAt(point));
}

/// Where spheres leave a point: one after the other, in a few rounds where they overlap.
Float3 Lattice::outside(const Point& point, Float3 position_ws) const {
    if (point.radius < 0.0f) return position_ws;
    for (int round = 0; round < kRounds; ++round) {
        bool moved = false;
        for (const Sphere& sphere : spheres_) {
            const Float3 from = position_ws - sphere.center_ws;
            const float reach = sphere.radius + point.radius, away = length(from);
            if (!(away < reach)) continue;
            const Float3 normal = away > 1e-9f ? from * (1.0f / away) : Float3{0.0f, 1.0f, 0.0f};
            position_ws = sphere.center_ws + normal * reach;
            moved = true;
        }
        if (!moved) break;
    }
    return position_ws;
}

/// Control points go where their points are pushed to: point p asks of node n for w d / Σ w², and a node
/// takes the mean of what is asked, weighted by w² (Lee, Wolberg, Shin 1997, Eq. 5).
void Lattice::collide() {
    pushes_.resize(points_.size());
    inParallel(host_, points_.size(), kPointsPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const Float3 at = positionOf(points_[p]);
            pushes_[p] = outside(points_[p], at) - at;
        }
    });
    for (Node& node : nodes_) {
        node.push = {};
        node.pushWeight = 0.0f;
    }
    // In the order of points, so that sums do not depend on threads.
    for (std::size_t p = 0; p < points_.size(); ++p) {
        if (pushes_[p] == Float3{}) continue;
        float squares = 0.0f;
        forControlPoints(points_[p].cells, settings_.nodes,
                         [&](std::size_t, float weight) { squares += weight * weight; });
        forControlPoints(points_[p].cells, settings_.nodes, [&](std::size_t n, float weight) {
            nodes_[n].push = nodes_[n].push + pushes_[p] * (weight * weight * weight / squares);
            nodes_[n].pushWeight += weight * weight;
        });
    }
    for (Node& node : nodes_) {
        if (!(node.pushWeight > 0.0f)) continue;
        const Float3 push = node.push * (1.0f / node.pushWeight);
        node.displacement = node.displacement + push;
        const float size = length(push);
        if (!(size > 0.0f)) continue;
        const Float3 normal = push * (1.0f / size);
        const float inwards = std::min(dot(node.velocity, normal), 0.0f);
        node.velocity = node.velocity - normal * inwards;
    }
}

/// One implicit Euler step for the displacements from the head's rigid motion, whose own change of velocity
/// acts against them.
void Lattice::advance(const RootFrame& from, const RootFrame& to, bool teleported, float h) {
    const float damping = settings_.dampingTime > 0.0f ? 1.0f / settings_.dampingTime : 0.0f;
    const float damped = 1.0f + h * (damping + settings_.airDrag);
    const Float3 travel = to.position - from.position;
    const Float3 sag = settings_.gravity - rotate(to.rotation, settings_.gravity);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        const Float3 before = node.headVelocity;
        if (!teleported) {
            const Float3 displacement =
                travel + rotate(to.rotation, node.rest_ss) - rotate(from.rotation, node.rest_ss);
            const float speed = length(displacement) / h;
            node.headVelocity = displacement * (kFastest / std::max(speed, kFastest) / h);
        }
        node.velocity = node.velocity + before - node.headVelocity;
        const Float3 air = (settings_.wind - node.headVelocity) * settings_.airDrag;
        node.residual = node.velocity * h + (sag + air - springs(i, &Node::displacement)) * (h * h);
    }
    solve(damped, h);
    for (Node& node : nodes_) {
        node.displacement = node.displacement + node.change;
        node.velocity = node.change * (1.0f / h);
    }
}

Float3 Lattice::springs(std::size_t node, Float3 Node::*field) const {
    const std::size_t n = settings_.nodes;
    const std::size_t at[] = {node % n, node / n % n, node / n / n}, stride[] = {1, n, n * n};
    const Float3 here = nodes_[node].*field;
    Float3 stretch;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (at[axis] > 0) stretch = stretch + (here - nodes_[node - stride[axis]].*field);
        if (at[axis] + 1 < n) stretch = stretch + (here - nodes_[node + stride[axis]].*field);
    }
    return here * nodes_[node].attachment + stretch * squaredRate(settings_.couplingFrequency);
}

/// Conjugate gradients for (damped + h² K) change = residual, with the matrix's diagonal for a
/// preconditioner. From change = 0: each iterate is then the least energy in its subspace.
void Lattice::solve(float damped, float h) {
    const float coupling = squaredRate(settings_.couplingFrequency);
    double product = 0.0;
    for (Node& node : nodes_) {
        node.scale = 1.0f / (damped + h * h * (node.attachment + 6.0f * coupling));
        node.change = {};
        node.direction = node.residual * node.scale;
        product += static_cast<double>(dot(node.residual, node.direction));
    }
    const double enough = product * kSolved;
    for (int i = 0; i < kMaxIterations && product > enough; ++i) {
        double curvature = 0.0;
        for (std::size_t k = 0; k < nodes_.size(); ++k) {
            Node& node = nodes_[k];
            node.image = node.direction * damped + springs(k, &Node::direction) * (h * h);
            curvature += static_cast<double>(dot(node.direction, node.image));
        }
        if (!(curvature > 0.0)) break;
        const float along = static_cast<float>(product / curvature);
        const double last = product;
        product = 0.0;
        for (Node& node : nodes_) {
            node.change = node.change + node.direction * along;
            node.residual = node.residual - node.image * along;
            product += static_cast<double>(dot(node.residual, node.residual) * node.scale);
        }
        const float kept = static_cast<float>(product / last);
        for (Node& node : nodes_) node.direction = node.residual * node.scale + node.direction * kept;
        report_.nodeUpdates += nodes_.size();
    }
}

Float3 Lattice::displacementAt(const Point& point) const {
    Float3 sum;
    forControlPoints(point.cells, settings_.nodes,
                     [&](std::size_t node, float weight) { sum = sum + nodes_[node].displacement * weight; });
    return sum;
}

bool Lattice::evaluate(std::span<Float3> positions_ws) const {
    if (positions_ws.size() != points_.size()) return false;
    const auto move = [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            positions_ws[p] = outside(points_[p], positionOf(points_[p]));
        }
    };
    inParallel(host_, points_.size(), kPointsPerJob, move);
    return true;
}

bool Lattice::readControlPoints(std::span<Float3> controlPoints_ws) const {
    if (controlPoints_ws.size() != nodes_.size()) return false;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        controlPoints_ws[i] =
            head_.position + (rotate(head_.rotation, nodes_[i].rest_ss) + nodes_[i].displacement);
    }
    return true;
}

bool Lattice::setControlPoints(std::span<const Float3> controlPoints_ws) {
    if (controlPoints_ws.size() != nodes_.size()) return false;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Float3 offset =
            controlPoints_ws[i] - head_.position - rotate(head_.rotation, nodes_[i].rest_ss);
        nodes_[i].displacement = length(offset) <= kFarthest ? offset : Float3{};
        nodes_[i].velocity = {};
    }
    return true;
}

}  // namespace hairloom::runtime
