// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/point_delta.h"

#include <algorithm>
#include <bit>

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 512;

/// Unlike ==, tells 0 from −0, as content hashes do.
bool sameBits(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Vec3f& p, const Vec3f& q) {
        for (Eigen::Index i = 0; i < 3; ++i) {
            if (std::bit_cast<std::uint32_t>(p[i]) != std::bit_cast<std::uint32_t>(q[i])) return false;
        }
        return true;
    });
}

}  // namespace

void PointDelta::keep(const Groom& groom, std::span<const std::uint32_t> strands) {
    slots_.resize(groom.strandCount(), 0);
    const std::size_t firstNew = strands_.size();
    for (const std::uint32_t s : strands) {
        if (slots_[s] != 0) continue;
        strands_.push_back(s);
        slots_[s] = static_cast<std::uint32_t>(strands_.size());
        begins_.push_back(begins_.back() + (groom.offsets[s + 1] - groom.offsets[s]));
    }
    points_.resize(begins_.back());
    const auto positions = groom.positions();
    parallelFor(strands_.size() - firstNew, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = firstNew + begin; k < firstNew + end; ++k) {
            std::copy_n(positions.begin() + groom.offsets[strands_[k]], begins_[k + 1] - begins_[k],
                        points_.begin() + static_cast<std::ptrdiff_t>(begins_[k]));
        }
    });
}

std::span<const Vec3f> PointDelta::kept(std::uint32_t strand) const {
    if (strand >= slots_.size() || slots_[strand] == 0) return {};
    const std::size_t k = slots_[strand] - 1;
    return std::span(points_).subspan(begins_[k], begins_[k + 1] - begins_[k]);
}

void PointDelta::finish(const Groom& groom) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t k = 0; k < strands_.size(); ++k) {
        const auto before = std::span(points_).subspan(begins_[k], begins_[k + 1] - begins_[k]);
        if (!sameBits(groom.strand(strands_[k]), before)) order.push_back(k);
    }
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return strands_[a] < strands_[b]; });
    PointDelta sorted;
    sorted.strands_.reserve(order.size());
    sorted.begins_.reserve(order.size() + 1);
    for (const std::uint32_t k : order) {
        sorted.strands_.push_back(strands_[k]);
        sorted.begins_.push_back(sorted.begins_.back() + begins_[k + 1] - begins_[k]);
    }
    sorted.points_.reserve(sorted.begins_.back());
    for (const std::uint32_t k : order) {
        const auto points = std::span(points_).subspan(begins_[k], begins_[k + 1] - begins_[k]);
        sorted.points_.insert(sorted.points_.end(), points.begin(), points.end());
    }
    *this = std::move(sorted);
}

void PointDelta::exchange(Groom& groom) {
    if (strands_.empty()) return;
    std::vector<Vec3f>& positions = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    parallelFor(strands_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            std::swap_ranges(points_.begin() + static_cast<std::ptrdiff_t>(begins_[k]),
                             points_.begin() + static_cast<std::ptrdiff_t>(begins_[k + 1]),
                             positions.begin() + static_cast<std::ptrdiff_t>(groom.offsets[strands_[k]]));
        }
    });
}

std::size_t PointDelta::bytes() const {
    return sizeof(*this) + points_.capacity() * sizeof(Vec3f) +
           (strands_.capacity() + begins_.capacity() + slots_.capacity()) * sizeof(std::uint32_t);
}

void FlagDelta::set(Groom& groom, std::span<const std::uint32_t> strands, bool value) {
    const auto now = groom.strandAttributes.view<std::uint8_t>(attribute_);
    const std::uint8_t wanted = value ? 1 : 0;
    std::vector<std::uint32_t> changed;
    for (const std::uint32_t s : strands) {
        if ((s < now.size() ? now[s] : 0) != wanted) changed.push_back(s);
    }
    if (changed.empty()) return;
    if (strands_.empty()) absent_ = !groom.strandAttributes.has(attribute_);
    std::vector<std::uint8_t>& flags = groom.strandAttributes.edit<std::uint8_t>(attribute_);
    flags.resize(groom.strandCount(), 0);
    std::vector<std::uint32_t> strandsNow;
    std::vector<std::uint8_t> valuesNow;
    std::size_t old = 0;
    const auto copyOld = [&] {
        strandsNow.push_back(strands_[old]);
        valuesNow.push_back(values_[old++]);
    };
    for (const std::uint32_t s : changed) {
        while (old < strands_.size() && strands_[old] < s) copyOld();
        if (old < strands_.size() && strands_[old] == s) {
            copyOld();
        } else {
            strandsNow.push_back(s);
            valuesNow.push_back(flags[s]);
        }
        flags[s] = wanted;
    }
    while (old < strands_.size()) copyOld();
    strands_ = std::move(strandsNow);
    values_ = std::move(valuesNow);
}

void FlagDelta::exchange(Groom& groom) {
    if (strands_.empty()) return;
    const bool absentNow = !groom.strandAttributes.has(attribute_);
    std::vector<std::uint8_t>& flags = groom.strandAttributes.edit<std::uint8_t>(attribute_);
    flags.resize(groom.strandCount(), 0);
    for (std::size_t k = 0; k < strands_.size(); ++k) std::swap(flags[strands_[k]], values_[k]);
    if (absent_) groom.strandAttributes.erase(attribute_);
    absent_ = absentNow;
}

}  // namespace hairloom::editing
