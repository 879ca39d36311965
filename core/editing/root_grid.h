// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Roots by place.

#include <span>
#include <unordered_map>
#include <vector>

#include "core/base/math.h"

namespace hairloom::editing {

class RootGrid {
  public:
    /// `cell` in metres, > 0; searches of about that radius are the fastest.
    explicit RootGrid(float cell) : cell_(cell) {}
    void add(std::uint32_t strand, const Vec3f& root_ss);

    struct Neighbour {
        std::uint32_t strand;
        float distance;  ///< metres
    };
    /// Nearest first, then by strand; at most `count`, none farther than `radius`.
    std::vector<Neighbour> nearest(const Vec3f& point_ss, std::size_t count, float radius) const;
    bool anyWithin(const Vec3f& point_ss, float radius) const;
    std::size_t countWithin(const Vec3f& point_ss, float radius) const;

  private:
    struct Entry {
        std::uint32_t strand;
        Vec3f root;
    };
    /// Until visit(strand, distance) says false, which is then what this says.
    template <class Visit>
    bool visit(const Vec3f& point, float radius, Visit visit) const;

    float cell_;
    std::unordered_map<std::uint64_t, std::vector<Entry>> cells_;
};

}  // namespace hairloom::editing
