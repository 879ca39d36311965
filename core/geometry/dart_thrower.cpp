// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/dart_thrower.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/placement_area.h"

namespace hairloom {
namespace {

constexpr float kRounding = 4e-6f;  // of a float distance, relative
constexpr float kSmallest = 5e-4f;  // of the radius: size of fragments that are let go
// Parts below this many radii are filled at once: the roots around them are few and are gathered once.
constexpr float kPart = 1.6f;
constexpr double kFirstDarts = 1.5;  // random darts for each root of a saturated set
// They fall in so many rounds over the surface, so that none of it is full before others have any.
constexpr std::size_t kRounds = 8;
constexpr std::size_t kMaxBits = 64;
constexpr float kMinDensity = 1.0f / 64;
// Of the radius: gaps that are never filled, size of the parts that all gaps are looked for in, and how
// exactly the widest is found.
constexpr float kNarrowest = 0.93f;
constexpr float kFine = 0.1f;
constexpr float kGapTolerance = 5e-4f;

template <class Point>
std::array<std::array<Point, 3>, 4> quarters(const std::array<Point, 3>& corners) {
    const auto& [a, b, c] = corners;
    const Point ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}}};
}

/// Calls visit with the four similar parts of a fragment.
template <class Fragment, class Visit>
void forEachQuarter(const Fragment& fragment, Visit visit) {
    const auto corners = quarters(fragment.corners);
    const auto positions = quarters(fragment.positions);
    for (std::size_t i = 0; i < 4; ++i) visit(Fragment{corners[i], positions[i], fragment.triangle});
}

template <class Point>
Point centreOf(const std::array<Point, 3>& corners) {
    return (corners[0] + corners[1] + corners[2]) / 3;
}

float reachFrom(const Vec3f& point, const std::array<Vec3f, 3>& positions) {
    return std::max(
        {(positions[0] - point).norm(), (positions[1] - point).norm(), (positions[2] - point).norm()});
}

float squaredSize(const std::array<Vec3f, 3>& positions) {
    return std::max({(positions[0] - positions[1]).squaredNorm(), (positions[1] - positions[2]).squaredNorm(),
                     (positions[2] - positions[0]).squaredNorm()});
}

bool allWithin(const std::array<Vec3f, 3>& positions, const Vec3f& center, float reach) {
    const float squared = reach * reach;
    return (positions[0] - center).squaredNorm() < squared &&
           (positions[1] - center).squaredNorm() < squared && (positions[2] - center).squaredNorm() < squared;
}

}  // namespace

std::uint32_t DartGrid::blockIndex(const Cell& cell) const {
    const std::uint64_t key = keyOf({cell.x() >> kBits, cell.y() >> kBits, cell.z() >> kBits});
    if (key != lastKey_) {
        const auto found = blockOf_.find(key);
        lastKey_ = key;
        lastBlock_ = found == blockOf_.end() ? kNone : found->second;
    }
    return lastBlock_;
}

void DartGrid::add(const Entry& entry) {
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
bool DartGrid::visitCell(std::uint32_t firstChunk, Visit visit) const {
    for (std::uint32_t c = firstChunk; c != kNone; c = chunks_[c].next)
        for (std::uint32_t i = 0; i < chunks_[c].count; ++i)
            if (visit(chunks_[c].entries[i])) return true;
    return false;
}

template <class Visit>
bool DartGrid::search(const Vec3f& center, float range, Visit visit) const {
    const Cell low = cellOf(center - Vec3f::Constant(range)), high = cellOf(center + Vec3f::Constant(range));
    const auto sameBlock = [&](int axis) { return low[axis] >> kBits == high[axis] >> kBits; };
    const bool oneBlock = sameBlock(0) && sameBlock(1) && sameBlock(2);
    const std::uint32_t common = oneBlock ? blockIndex(low) : kNone;
    if (oneBlock && common == kNone) return false;
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) {
                const std::uint32_t block = oneBlock ? common : blockIndex({x, y, z});
                if (block != kNone && visitCell(blocks_[block][slotOf({x, y, z})], visit)) return true;
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
    return mask_.empty() ? apart_ : apart_ / std::sqrt(std::clamp(density, kMinDensity, 1.0f));
}

DartThrower::Spacing DartThrower::spacingOf(const Fragment& fragment) const {
    if (mask_.empty()) return {apart_, apart_, false};
    Vec3f densities;
    for (int i = 0; i < 3; ++i)
        densities[i] =
            densityAt(fragment.triangle, barycentric(fragment.corners[static_cast<std::size_t>(i)]));
    return {localRadius(densities.maxCoeff()), localRadius(densities.minCoeff()),
            densities.maxCoeff() < kMinDensity};
}

DartThrower::Fragment DartThrower::wholeFace(std::uint32_t face) const {
    const Triangle& t = mesh_.triangles()[face];
    const auto position = [&](std::size_t i) { return mesh_.positions()[t[i]]; };
    return {{Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)}, {position(0), position(1), position(2)}, face};
}

void DartThrower::gatherNear(const Vec3f& center, float range) {
    near_.clear();
    grid_.search(center, range, [&](const DartGrid::Entry& entry) {
        if ((entry.position - center).squaredNorm() < range * range) near_.push_back(entry);
        return false;
    });
}

std::uint64_t DartThrower::rootsReached(const Vec3f& position, std::size_t first) const {
    std::uint64_t bits = 0;
    for (std::size_t i = first; i < near_.size(); ++i)
        bits |= std::uint64_t{(near_[i].position - position).squaredNorm() < apart_ * apart_} << i;
    return bits;
}

/// One root reaches all corners, so that no dart in the part can stand: two roots keep the smaller of their
/// local radii apart. With one radius for all, corners remember the roots that reach them.
bool DartThrower::coveredByNear(Part& part) const {
    if (mask_.empty() && near_.size() <= kMaxBits) {
        for (std::size_t i = 0; i < 3; ++i) part.reached[i] |= rootsReached(part.positions[i], part.known);
        part.known = near_.size();
        return (part.reached[0] & part.reached[1] & part.reached[2]) != 0;
    }
    const float radius = spacingOf(part).radius;
    return std::any_of(near_.begin(), near_.end(), [&](const DartGrid::Entry& root) {
        return allWithin(part.positions, root.position, std::min(root.radius, radius));
    });
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
    const Vec3f position = mesh_.pointAt(fragment.triangle, weights);
    const float density = densityAt(fragment.triangle, weights);
    const float radius = localRadius(density);
    if (density < kMinDensity && !mask_.empty()) return;
    if (gather) gatherNear(position, radius);
    for (const DartGrid::Entry& root : near_) {
        const float apart = std::min(root.radius, radius);
        if ((root.position - position).squaredNorm() < apart * apart) return;
    }
    roots_.push_back({fragment.triangle, weights});
    near_.push_back({position, radius});
    grid_.add(near_.back());
}

/// Splits what no single root covers into four, which wait in small_. coveredByNear has seen the part.
void DartThrower::splitAndKeep(const Part& part) {
    std::array<std::array<std::uint64_t, 3>, 4> reached{};
    if (part.known == near_.size()) {
        const auto& [a, b, c] = part.positions;
        const auto& [atA, atB, atC] = part.reached;
        const std::uint64_t ab = rootsReached((a + b) / 2, 0), bc = rootsReached((b + c) / 2, 0),
                            ca = rootsReached((c + a) / 2, 0);
        reached = {{{atA, ab, ca}, {ab, atB, bc}, {ca, bc, atC}, {bc, ca, ab}}};
    }
    std::size_t quarter = 0;
    forEachQuarter(static_cast<const Fragment&>(part), [&](const Fragment& fragment) {
        Part child{fragment, reached[quarter++], part.known};
        const Spacing spacing = spacingOf(child);
        const float smallest = kSmallest * spacing.radius;
        const bool negligible = spacing.bare || squaredSize(child.positions) <= smallest * smallest;
        if (!negligible && !coveredByNear(child)) small_.push_back(child);
    });
}

/// Fills what is left of a part; all roots that matter to it are gathered once.
void DartThrower::fill(const Fragment& fragment, std::size_t maximum) {
    gatherAround(fragment);
    Part whole{fragment, {}, 0};
    if (coveredByNear(whole)) return;
    splitAndKeep(whole);
    while (!small_.empty() && roots_.size() <= maximum) {
        Part part = small_.back();
        small_.pop_back();
        throwDart(part, false);
        if (!coveredByNear(part)) splitAndKeep(part);
    }
    small_.clear();
}

void DartThrower::throwAnywhere(std::size_t maximum) {
    const double perArea =
        kFirstDarts / (static_cast<double>(radius_) * radius_) / static_cast<double>(kRounds);
    for (std::size_t round = 0; round < kRounds; ++round)
        for (const std::uint32_t face : faces_) {
            const double mean = cornerDensities(mesh_, mask_, face).cast<double>().mean();
            const double darts = perArea * static_cast<double>(mesh_.triangleArea(face)) * mean;
            const auto count = static_cast<std::size_t>(darts + random_.uniformDouble());
            if (count == 0) continue;
            const Fragment whole = wholeFace(face);
            for (std::size_t i = 0; i < count && roots_.size() <= maximum; ++i) throwDart(whole, true);
        }
}

void DartThrower::fillParts(const Fragment& fragment, std::size_t maximum) {
    if (roots_.size() > maximum || spacingOf(fragment).bare) return;
    if (squaredSize(fragment.positions) <= kPart * kPart * apart_ * apart_)
        fill(fragment, maximum);
    else
        forEachQuarter(fragment, [&](const Fragment& quarter) { fillParts(quarter, maximum); });
}

bool DartThrower::run(std::size_t maximum) {
    throwAnywhere(maximum);
    for (const std::uint32_t face : faces_) fillParts(wholeFace(face), maximum);
    return roots_.size() <= maximum;
}

DartThrower::Gap DartThrower::gapByNear(const Fragment& fragment) const {
    const Spacing spacing = spacingOf(fragment);
    const Vec3f middle = centreOf(fragment.positions);
    const float reach = reachFrom(middle, fragment.positions);
    // No point of a maximal set is farther.
    Gap gap{fragment, 1, 1, 0};
    if (mask_.empty()) {
        float squared = std::numeric_limits<float>::infinity();
        for (const DartGrid::Entry& root : near_)
            squared = std::min(squared, (root.position - middle).squaredNorm());
        const float distance = std::sqrt(squared);
        gap.widest = std::min(1.0f, (distance + reach) / apart_);
        gap.middle = std::min(1.0f, distance / apart_);
        return gap;
    }
    const float density = densityAt(fragment.triangle, barycentric(centreOf(fragment.corners)));
    const float radius = localRadius(density);
    for (const DartGrid::Entry& root : near_) {
        const float distance = (root.position - middle).norm();
        gap.widest = std::min(gap.widest, (distance + reach) / std::min(root.radius, spacing.radius));
        gap.middle = std::min(gap.middle, distance / std::min(root.radius, radius));
    }
    if (density < kMinDensity) gap.middle = 0;
    return gap;
}

void DartThrower::gatherAround(const Fragment& fragment) {
    const Vec3f middle = centreOf(fragment.positions);
    gatherNear(middle, reachFrom(middle, fragment.positions) + spacingOf(fragment).widest);
}

void DartThrower::pushGap(Gap gap) {
    if (gap.widest < kNarrowest) return;
    gap.order = foundGaps_++;
    gaps_.push_back(gap);
    std::push_heap(gaps_.begin(), gaps_.end());
}

/// All roots that matter to a part of about a radius are gathered once; it is then split until the widest of
/// it is known well enough.
void DartThrower::listGaps(const Fragment& fragment) {
    if (spacingOf(fragment).bare) return;
    if (squaredSize(fragment.positions) > kPart * kPart * apart_ * apart_) {
        forEachQuarter(fragment, [&](const Fragment& quarter) { listGaps(quarter); });
        return;
    }
    gatherAround(fragment);
    refineGaps(fragment);
}

void DartThrower::refineGaps(const Fragment& fragment) {
    const float fine = kFine * apart_;
    if (spacingOf(fragment).bare) return;
    const Gap gap = gapByNear(fragment);
    if (gap.widest < kNarrowest || squaredSize(fragment.positions) <= fine * fine) return pushGap(gap);
    forEachQuarter(fragment, [&](const Fragment& quarter) { refineGaps(quarter); });
}

std::optional<float> DartThrower::fillWidestGaps(std::size_t count) {
    float share = 1;
    if (roots_.size() < count) {
        for (const std::uint32_t face : faces_) listGaps(wholeFace(face));
    }
    while (roots_.size() < count) {
        if (gaps_.empty()) return std::nullopt;
        std::pop_heap(gaps_.begin(), gaps_.end());
        const Gap top = gaps_.back();
        gaps_.pop_back();
        gatherAround(top);
        const Gap now = gapByNear(top);  // roots may have come since
        const float smallest = kSmallest * spacingOf(top).radius;
        const bool known = now.middle >= (1 - kGapTolerance) * top.widest;
        const bool tiny = squaredSize(top.positions) <= smallest * smallest;
        if (known) {
            const Vec3f weights = barycentric(centreOf(top.corners));
            const Vec3f position = mesh_.pointAt(top.triangle, weights);
            roots_.push_back({top.triangle, weights});
            grid_.add({position, localRadius(densityAt(top.triangle, weights))});
            share = std::min(share, now.middle);
        } else if (now.widest < top.widest) {
            pushGap(now);
        } else if (!tiny) {
            forEachQuarter(static_cast<const Fragment&>(top), [&](const Fragment& quarter) {
                if (!spacingOf(quarter).bare) pushGap(gapByNear(quarter));
            });
        }
    }
    return share * radius_ * (1 - kRounding);
}

}  // namespace hairloom
