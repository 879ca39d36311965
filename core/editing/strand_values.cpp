// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/strand_values.h"

#include <algorithm>
#include <cstring>

#include "core/base/math.h"
#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 512;

/// Unlike ==, tells 0 from −0, as content hashes do.
template <class T>
bool sameBits(std::span<const T> a, std::span<const T> b) {
    return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

}  // namespace

template <class T>
void StrandValues<T>::keep(Offsets offsets, std::span<const T> values,
                           std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    slots_.resize(offsets.size() - 1, 0);
    const std::size_t firstNew = strands_.size();
    for (const std::uint32_t s : strands) {
        if (slots_[s] != 0) continue;
        strands_.push_back(s);
        slots_[s] = static_cast<std::uint32_t>(strands_.size());
        begins_.push_back(begins_.back() + (offsets[s + 1] - offsets[s]));
    }
    values_.resize(begins_.back());
    parallelFor(strands_.size() - firstNew, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = firstNew + begin; k < firstNew + end; ++k) {
            std::copy_n(values.begin() + offsets[strands_[k]], begins_[k + 1] - begins_[k],
                        values_.begin() + static_cast<std::ptrdiff_t>(begins_[k]));
        }
    });
}

template <class T>
std::span<const T> StrandValues<T>::kept(std::uint32_t strand) const {
    if (strand >= slots_.size() || slots_[strand] == 0) return {};
    return ofPlace(slots_[strand] - 1);
}

template <class T>
void StrandValues<T>::finish(Offsets offsets, std::span<const T> values) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t k = 0; k < strands_.size(); ++k) {
        const auto before = ofPlace(k);
        if (!sameBits(values.subspan(offsets[strands_[k]], before.size()), before)) order.push_back(k);
    }
    std::ranges::sort(order, {}, [&](std::uint32_t k) { return strands_[k]; });
    StrandValues sorted;
    sorted.strands_.reserve(order.size());
    sorted.begins_.reserve(order.size() + 1);
    for (const std::uint32_t k : order) {
        sorted.strands_.push_back(strands_[k]);
        sorted.begins_.push_back(sorted.begins_.back() + begins_[k + 1] - begins_[k]);
    }
    sorted.values_.reserve(sorted.begins_.back());
    for (const std::uint32_t k : order) {
        const auto before = ofPlace(k);
        sorted.values_.insert(sorted.values_.end(), before.begin(), before.end());
    }
    *this = std::move(sorted);
}

template <class T>
void StrandValues<T>::exchange(Offsets offsets, std::span<T> values) {
    parallelFor(strands_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            std::swap_ranges(values_.begin() + static_cast<std::ptrdiff_t>(begins_[k]),
                             values_.begin() + static_cast<std::ptrdiff_t>(begins_[k + 1]),
                             values.begin() + static_cast<std::ptrdiff_t>(offsets[strands_[k]]));
        }
    });
}

template <class T>
std::size_t StrandValues<T>::heapBytes() const {
    return values_.capacity() * sizeof(T) +
           (strands_.capacity() + begins_.capacity() + slots_.capacity()) * sizeof(std::uint32_t);
}

template class StrandValues<float>;
template class StrandValues<Vec3f>;

}  // namespace hairloom::editing
