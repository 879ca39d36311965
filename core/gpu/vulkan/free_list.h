// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which parts of one block of memory are free: first fit, neighbours merged on release.

#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

namespace hairloom::gpu::vulkan {

class FreeList {
  public:
    explicit FreeList(std::uint64_t size) : size_(size) { free_[0] = size; }

    /// Offset of `size` > 0 bytes at a multiple of `alignment` (a power of two), or nothing.
    std::optional<std::uint64_t> allocate(std::uint64_t size, std::uint64_t alignment) {
        for (auto it = free_.begin(); it != free_.end(); ++it) {
            const auto [begin, length] = *it;
            const std::uint64_t start = (begin + alignment - 1) & ~(alignment - 1);
            const std::uint64_t padding = start - begin;
            if (padding > length || length - padding < size) continue;
            free_.erase(it);
            if (padding > 0) free_[begin] = padding;
            if (length - padding > size) free_[start + size] = length - padding - size;
            return start;
        }
        return std::nullopt;
    }

    /// A part that allocate() returned.
    void release(std::uint64_t offset, std::uint64_t size) {
        auto it = free_.emplace(offset, size).first;
        if (const auto next = std::next(it); next != free_.end() && it->first + it->second == next->first) {
            it->second += next->second;
            free_.erase(next);
        }
        if (it != free_.begin()) {
            const auto previous = std::prev(it);
            if (previous->first + previous->second == it->first) {
                previous->second += it->second;
                free_.erase(it);
            }
        }
    }

    bool isEmpty() const { return free_.size() == 1 && free_.begin()->second == size_; }

  private:
    std::uint64_t size_;
    std::map<std::uint64_t, std::uint64_t> free_;  // offset -> length
};

}  // namespace hairloom::gpu::vulkan
