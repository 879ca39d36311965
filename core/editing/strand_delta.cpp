// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/strand_delta.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "core/editing/array_gaps.h"
#include "core/editing/zero.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 512;

/// Calls body(range, place of its first element where all ranges lie one after the other), on several
/// threads.
template <class Body>
void forEachRange(std::span<const Range> ranges, const Body& body) {
    std::vector<std::size_t> places;
    places.reserve(ranges.size());
    std::size_t place = 0;
    for (const Range& range : ranges) {
        places.push_back(place);
        place += range.count;
    }
    parallelFor(ranges.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) body(ranges[k], places[k]);
    });
}

/// Moves the ranges out of the array and closes the gaps, in place.
template <class T>
std::vector<T> takeRanges(std::vector<T>& values, std::span<const Range> ranges) {
    std::vector<T> taken(total(ranges));
    forEachRange(ranges, [&](const Range& range, std::size_t place) {
        std::copy_n(values.data() + range.begin, range.count, taken.data() + place);
    });
    closeGaps(std::as_writable_bytes(std::span(values)), sizeof(T), ranges);
    values.resize(values.size() - taken.size());
    return taken;
}

/// The inverse; `ranges` as in the array that results.
template <class T>
void putRanges(std::vector<T>& values, std::span<const Range> ranges, std::span<const T> taken) {
    values.resize(values.size() + total(ranges));
    openGaps(std::as_writable_bytes(std::span(values)), sizeof(T), ranges);
    forEachRange(ranges, [&](const Range& range, std::size_t place) {
        if (taken.empty()) {
            std::fill_n(values.data() + range.begin, range.count, zero<T>());
        } else {
            std::copy_n(taken.data() + place, range.count, values.data() + range.begin);
        }
    });
}

std::vector<std::string> namesOf(const AttributeSet& attributes) {
    std::vector<std::string> names;
    for (const auto& [name, data] : attributes.all()) names.push_back(name);
    return names;
}

/// Calls visit.operator()<T>() for the type of a named array that is there. Nothing is copied, so that the
/// array can be edited in place.
template <class Visit>
void withType(const AttributeSet& attributes, const std::string& name, Visit visit) {
    std::visit([&]<class T>(const CowArray<T>&) { visit.template operator()<T>(); },
               attributes.all().find(name)->second);
}

AttributeSet takeAttributes(AttributeSet& attributes, std::span<const Range> ranges) {
    AttributeSet taken;
    for (const std::string& name : namesOf(attributes)) {
        withType(attributes, name,
                 [&]<class T>() { taken.set(name, takeRanges(attributes.edit<T>(name), ranges)); });
    }
    return taken;
}

/// Empty arrays for what the others have.
void adoptNames(AttributeSet& attributes, const AttributeSet& others) {
    for (const std::string& name : namesOf(others)) {
        if (attributes.has(name)) continue;
        withType(others, name, [&]<class T>() { attributes.set(name, std::vector<T>()); });
    }
}

void putAttributes(AttributeSet& attributes, std::span<const Range> ranges, const AttributeSet& taken) {
    for (const std::string& name : namesOf(attributes)) {
        withType(attributes, name,
                 [&]<class T>() { putRanges(attributes.edit<T>(name), ranges, taken.view<T>(name)); });
    }
}

std::size_t bytesOf(const AttributeSet& attributes) {
    std::size_t sum = 0;
    for (const auto& [name, data] : attributes.all()) {
        std::visit([&]<class T>(const CowArray<T>& array) { sum += array.size() * sizeof(T); }, data);
    }
    return sum;
}

std::vector<Range> strandRanges(std::span<const std::uint32_t> strands) {
    std::vector<Range> ranges;
    for (const std::uint32_t s : strands) {
        if (!ranges.empty() && ranges.back().begin + ranges.back().count == s) {
            ++ranges.back().count;
        } else {
            ranges.push_back({s, 1});
        }
    }
    return ranges;
}

std::vector<Range> pointRanges(std::span<const Range> strands, std::span<const std::uint32_t> offsets) {
    std::vector<Range> ranges;
    for (const Range& range : strands) {
        ranges.push_back({offsets[range.begin], offsets[range.begin + range.count] - offsets[range.begin]});
    }
    return ranges;
}

}  // namespace

std::size_t TakenStrands::bytes() const {
    return (indices.capacity() + counts.capacity()) * sizeof(std::uint32_t) + bytesOf(strandData) +
           bytesOf(pointData);
}

TakenStrands takeOut(Groom& groom, std::span<const std::uint32_t> strands) {
    TakenStrands taken;
    if (strands.empty()) return taken;
    taken.indices.assign(strands.begin(), strands.end());
    for (const std::uint32_t s : strands) taken.counts.push_back(groom.offsets[s + 1] - groom.offsets[s]);
    const std::vector<Range> ranges = strandRanges(strands);
    taken.pointData = takeAttributes(groom.pointAttributes, pointRanges(ranges, groom.offsets.view()));
    taken.strandData = takeAttributes(groom.strandAttributes, ranges);

    std::vector<std::uint32_t>& offsets = groom.offsets.edit();
    std::size_t next = 0;
    std::size_t write = strands.front();
    std::uint32_t removed = 0;
    for (std::size_t s = strands.front(); s + 1 < offsets.size(); ++s) {
        const std::uint32_t begin = offsets[s] - removed;
        if (next < strands.size() && strands[next] == s) {
            removed += taken.counts[next++];
        } else {
            offsets[write++] = begin;
        }
    }
    offsets[write] = offsets.back() - removed;
    offsets.resize(write + 1);
    return taken;
}

namespace {

/// From the last strand on, so that each number is read before it is written over.
void putOffsets(std::vector<std::uint32_t>& offsets, const TakenStrands& strands) {
    std::size_t old = offsets.size() - 1;
    offsets.resize(offsets.size() + strands.indices.size());
    std::uint32_t added = std::accumulate(strands.counts.begin(), strands.counts.end(), 0u);
    std::size_t next = strands.indices.size();
    for (std::size_t s = offsets.size() - 1; next > 0; --s) {
        offsets[s] = offsets[old] + added;
        if (strands.indices[next - 1] + 1 == s) {
            added -= strands.counts[--next];
        } else {
            --old;
        }
    }
}

}  // namespace

void putBack(Groom& groom, const TakenStrands& strands) {
    if (strands.indices.empty()) return;
    if (groom.strandCount() == 0) {
        adoptNames(groom.strandAttributes, strands.strandData);
        adoptNames(groom.pointAttributes, strands.pointData);
    }
    putOffsets(groom.offsets.edit(), strands);
    const std::vector<Range> ranges = strandRanges(strands.indices);
    putAttributes(groom.strandAttributes, ranges, strands.strandData);
    putAttributes(groom.pointAttributes, pointRanges(ranges, groom.offsets.view()), strands.pointData);
}

void StrandDelta::remove(Groom& groom, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    assert(indices_.empty());
    indices_.assign(strands.begin(), strands.end());
    away_ = takeOut(groom, strands);
    present_ = false;
    triangulation_ = std::exchange(groom.triangulation, {});
}

void StrandDelta::insert(Groom& groom, const TakenStrands& strands) {
    if (strands.indices.empty()) return;
    assert(present_ && (indices_.empty() || indices_.back() < strands.indices.front()));
    if (indices_.empty()) {
        triangulation_ = std::exchange(groom.triangulation, {});
        fromNothing_ = groom.strandCount() == 0;
        if (fromNothing_) {
            noStrands_ = groom.strandAttributes;
            noPoints_ = groom.pointAttributes;
        }
    }
    indices_.insert(indices_.end(), strands.indices.begin(), strands.indices.end());
    putBack(groom, strands);
}

void StrandDelta::exchange(Groom& groom) {
    if (indices_.empty()) return;
    if (present_) {
        away_ = takeOut(groom, indices_);
        if (fromNothing_) {
            groom.strandAttributes = noStrands_;
            groom.pointAttributes = noPoints_;
        }
    } else {
        putBack(groom, away_);
        away_ = {};
    }
    present_ = !present_;
    std::swap(groom.triangulation, triangulation_);
}

std::size_t StrandDelta::bytes() const {
    return indices_.capacity() * sizeof(std::uint32_t) + away_.bytes() +
           triangulation_.triangles.capacity() * sizeof(Triangle) +
           triangulation_.coincident.capacity() * sizeof(RootTriangulation::Coincident) +
           triangulation_.alone.capacity() * sizeof(std::uint32_t);
}

}  // namespace hairloom::editing
