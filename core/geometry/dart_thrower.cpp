// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/dart_thrower.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/placement_area.h"

namespace hairloom {
namespace {

constexpr float kRounding = 4e-6f;  // of a float distance, relative
constexpr float kSmallest = 5e-4f;  // of the radius: size of fragments that are let go
// Parts below this many radii are filled at once: the roots around them are few and are gathered once.
constexpr float kPart = 1.6f;
constexpr double kFirstDarts = 1.5;  // random darts for each root of a saturated set
// Parts are filled in so many rounds over the surface, so that a stop at a count leaves its gaps scattered.
constexpr std::size_t kRounds = 8;
constexpr float kLeastDensity = 1.0f / 64;

const std::array<Vec2f, 3> kWhole = {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)};

template <class Visit>
void forEachQuarter(const std::array<Vec2f, 3>& corners, Visit visit) {
    const auto& [a, b, c] = corners;
    const Vec2f ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    for (const auto& quarter : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}})
        visit(quarter);
}

}  // namespace

std::uint32_t RootGrid::blockIndex(const Cell& cell) const {
    const std::uint64_t key = keyOf({cell.x() >> kBits, cell.y() >> kBits, cell.z() >> kBits});
    if (key != lastKey_) {
        const auto found = blockOf_.find(key);
        lastKey_ = key;
        lastBlock_ = found == blockOf_.end() ? kNone : found->second;
    }
    return lastBlock_;
}

void RootGrid::add(const Entry& entry) {
    const Cell cell = cellOf(entry.position);
    if (blockIndex(cell) == kNone) {
        lastBlock_ = blockOf_[lastKey_] = static_cast<std::uint32_t>(blocks_.size());
        blocks_.emplace_back().fill(kNone);
    }
    std::uint32_t& first = blocks_[lastBlock_][slotOf(cell)];
    if (first == kNone || chunks_[first].count == kChunk) {
        chunks_.emplace_back().next = first;
        first = static_cast<std::uint32_t>(chunks_.size() - 1);
    }
    Chunk& chunk = chunks_[first];
    chunk.entries[chunk.count++] = entry;
}

template <class Visit>
bool RootGrid::search(const Vec3f& center, float range, Visit visit) const {
    const Cell low = cellOf(center - Vec3f::Constant(range)), high = cellOf(center + Vec3f::Constant(range));
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) {
                const std::uint32_t block = blockIndex({x, y, z});
                if (block == kNone) continue;
                for (std::uint32_t c = blocks_[block][slotOf({x, y, z})]; c != kNone; c = chunks_[c].next)
                    for (std::uint32_t i = 0; i < chunks_[c].count; ++i)
                        if (visit(chunks_[c].entries[i])) return true;
            }
    return false;
}

DartThrower::DartThrower(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask,
                         float radius, std::uint64_t seed)
    : mesh_(mesh),
      mask_(mask),
      radius_(radius),
      apart_(radius * (1 + kRounding)),
      random_(seed),
      grid_(mesh.bounds().min(), 2 * apart_),
      faces_(faces) {}

float DartThrower::densityAt(std::uint32_t triangle, const Vec3f& weights) const {
    return mask_.empty() ? 1.0f : weights.dot(cornerDensities(mesh_, mask_, triangle));
}

float DartThrower::localRadius(float density) const {
    return mask_.empty() ? apart_ : apart_ / std::sqrt(std::clamp(density, kLeastDensity, 1.0f));
}

DartThrower::Places DartThrower::placesOf(const Fragment& fragment) const {
    const Triangle& t = mesh_.triangles()[fragment.triangle];
    const Vec3f origin = mesh_.positions()[t[0]];
    const Vec3f alongB = mesh_.positions()[t[1]] - origin, alongC = mesh_.positions()[t[2]] - origin;
    Places places;
    for (std::size_t i = 0; i < 3; ++i)
        places.corners[i] = origin + fragment.corners[i].x() * alongB + fragment.corners[i].y() * alongC;
    places.radius = places.widest = apart_;
    places.bare = false;
    if (!mask_.empty()) {
        Vec3f densities;
        for (int i = 0; i < 3; ++i)
            densities[i] =
                densityAt(fragment.triangle, barycentric(fragment.corners[static_cast<std::size_t>(i)]));
        places.radius = localRadius(densities.maxCoeff());
        places.widest = localRadius(densities.minCoeff());
        places.bare = densities.maxCoeff() < kLeastDensity;
    }
    return places;
}

/// No dart in the fragment can stand: two roots keep the smaller of their local radii apart.
bool DartThrower::covers(const RootGrid::Entry& root, const Places& places, float factor) {
    const float reach = factor * std::min(root.radius, places.radius);
    for (const Vec3f& corner : places.corners)
        if ((corner - root.position).squaredNorm() >= reach * reach) return false;
    return true;
}

void DartThrower::gatherNear(const Vec3f& center, float range) {
    near_.clear();
    grid_.search(center, range, [&](const RootGrid::Entry& entry) {
        if ((entry.position - center).squaredNorm() < range * range) near_.push_back(entry);
        return false;
    });
}

bool DartThrower::coveredByNear(const Places& places) const {
    return std::any_of(near_.begin(), near_.end(), [&](const auto& root) { return covers(root, places, 1); });
}

void DartThrower::throwDart(const Fragment& fragment, bool gather) {
    float a = random_.uniform(), b = random_.uniform();
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    const Vec2f part = fragment.corners[0] + a * (fragment.corners[1] - fragment.corners[0]) +
                       b * (fragment.corners[2] - fragment.corners[0]);
    const Vec3f weights = barycentric(part);
    const Vec3f place = mesh_.pointAt(fragment.triangle, weights);
    const float density = densityAt(fragment.triangle, weights);
    const float radius = localRadius(density);
    if (density < kLeastDensity && !mask_.empty()) return;
    if (gather) gatherNear(place, radius);
    for (const RootGrid::Entry& root : near_) {
        const float apart = std::min(root.radius, radius);
        if ((root.position - place).squaredNorm() < apart * apart) return;
    }
    roots_.push_back({fragment.triangle, weights});
    near_.push_back({place, radius});
    grid_.add(near_.back());
}

/// Splits what no single root covers into four, which wait in small_.
void DartThrower::splitAndKeep(const Fragment& fragment) {
    forEachQuarter(fragment.corners, [&](const std::array<Vec2f, 3>& corners) {
        const Fragment child{corners, fragment.triangle};
        const Places places = placesOf(child);
        const float smallest = kSmallest * places.radius;
        const bool negligible = places.bare || places.squaredSize() <= smallest * smallest;
        if (!negligible && !coveredByNear(places)) small_.push_back(child);
    });
}

/// Fills what is left of a small fragment; all roots that matter to it are gathered once.
void DartThrower::fill(const Fragment& fragment, std::size_t most) {
    const Places places = placesOf(fragment);
    const Vec3f center = (places.corners[0] + places.corners[1] + places.corners[2]) / 3;
    float reach = 0;
    for (const Vec3f& corner : places.corners) reach = std::max(reach, (corner - center).norm());
    gatherNear(center, reach + places.widest);
    if (coveredByNear(places)) return;
    small_.push_back(fragment);
    while (!small_.empty() && roots_.size() < most) {
        const Fragment part = small_.back();
        small_.pop_back();
        throwDart(part, false);
        if (!coveredByNear(placesOf(part))) splitAndKeep(part);
    }
    left_.insert(left_.end(), small_.begin(), small_.end());
    small_.clear();
}

void DartThrower::throwAnywhere(std::size_t most) {
    std::vector<double> areas;
    areas.reserve(faces_.size());
    double sum = 0;
    for (const std::uint32_t face : faces_) {
        areas.push_back(static_cast<double>(mesh_.triangleArea(face)) *
                        cornerDensities(mesh_, mask_, face).cast<double>().mean());
        sum += areas.back();
    }
    const FacePicker picker(areas);
    const auto darts = static_cast<std::size_t>(kFirstDarts * sum / (static_cast<double>(radius_) * radius_));
    for (std::size_t i = 0; i < darts && roots_.size() < most; ++i) {
        const Fragment face{kWhole, faces_[picker.pick(random_.uniformDouble())]};
        throwDart(face, true);
    }
}

void DartThrower::listParts(const Fragment& fragment) {
    const Places places = placesOf(fragment);
    if (places.bare) return;
    if (places.squaredSize() <= kPart * kPart * apart_ * apart_) {
        left_.push_back(fragment);
        return;
    }
    forEachQuarter(fragment.corners, [&](const std::array<Vec2f, 3>& corners) {
        listParts({corners, fragment.triangle});
    });
}

bool DartThrower::run(std::size_t most) {
    throwAnywhere(most);
    for (const std::uint32_t face : faces_) listParts({kWhole, face});
    const std::vector<Fragment> parts = std::move(left_);
    left_.clear();
    for (std::size_t round = 0; round < kRounds; ++round)
        for (std::size_t i = round; i < parts.size(); i += kRounds) {
            if (roots_.size() < most)
                fill(parts[i], most);
            else
                left_.push_back(parts[i]);
        }
    return left_.empty();
}

bool DartThrower::gapWithin(const Fragment& fragment, float factor, int depth) const {
    const Places places = placesOf(fragment);
    if (places.bare) return true;
    const Vec3f middle = (places.corners[0] + places.corners[1] + places.corners[2]) / 3;
    const auto reached = [&](const RootGrid::Entry& root) {
        const float reach = factor * places.radius;
        return std::all_of(places.corners.begin(), places.corners.end(), [&](const Vec3f& corner) {
            return (corner - root.position).squaredNorm() <= reach * reach;
        });
    };
    if (grid_.search(middle, factor * places.radius, reached)) return true;
    constexpr int kDeepest = 12;
    if (depth == kDeepest) return false;
    bool within = true;
    forEachQuarter(fragment.corners, [&](const std::array<Vec2f, 3>& corners) {
        within = within && gapWithin({corners, fragment.triangle}, factor, depth + 1);
    });
    return within;
}

bool DartThrower::gapsWithin(float factor) const {
    return std::all_of(left_.begin(), left_.end(),
                       [&](const Fragment& fragment) { return gapWithin(fragment, factor, 0); });
}

}  // namespace hairloom
