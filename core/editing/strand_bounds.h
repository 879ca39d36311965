// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where strands are, for brushes and for picking: a box around each, renewed for those that moved.

#include <functional>
#include <span>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom::editing {

class StrandBounds {
  public:
    struct Box {
        Vec3f low;
        Vec3f high;
    };
    /// After strands came or went, or when it is not known which moved.
    void rebuild(const Groom& groom);
    /// Strands were added behind those that there were.
    void append(const Groom& groom);
    /// Strands keep their indices. Safe for distinct strands on several threads at once.
    void update(const Groom& groom, std::span<const std::uint32_t> strands);
    void update(std::uint32_t strand, std::span<const Vec3f> points) { boxes_[strand] = boxOf(points); }

    std::size_t size() const { return boxes_.size(); }
    const Box& operator[](std::size_t strand) const { return boxes_[strand]; }
    /// Ascending; those whose box `test`(low, high) accepts, which runs on several threads.
    template <class Test>
    std::vector<std::uint32_t> find(Test test) const {
        return gather([&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
            for (std::size_t s = begin; s < end; ++s) {
                if (test(boxes_[s].low, boxes_[s].high)) found.push_back(static_cast<std::uint32_t>(s));
            }
        });
    }

  private:
    static Box boxOf(std::span<const Vec3f> points);
    std::vector<std::uint32_t> gather(
        const std::function<void(std::size_t, std::size_t, std::vector<std::uint32_t>&)>& piece) const;

    std::vector<Box> boxes_;
};

}  // namespace hairloom::editing
