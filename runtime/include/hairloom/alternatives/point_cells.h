// SPDX-License-Identifier: MIT
#pragma once
// A grid over points, for methods that look at what is near.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hairloom/math.h"

namespace hairloom::runtime {

/// Points by cell, side by side and in their order; those that do not count are in none.
class PointCells {
  public:
    /// Cells of `size` metres at least, larger where there would be more than 2²¹. `counts(i)`: whether point
    /// i takes part; one that does is finite.
    template <class Counts>
    void sort(std::span<const Float3> positions, float size, const Counts& counts) {
        std::array<float, 3> high{};
        bool any = false;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (!counts(i)) continue;
            const auto at = components(positions[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low_[axis] = any ? std::min(low_[axis], at[axis]) : at[axis];
                high[axis] = any ? std::max(high[axis], at[axis]) : at[axis];
            }
            any = true;
        }
        choose(high, size, any);
        starts_.assign(std::size_t{size_[0]} * size_[1] * size_[2] + 1, 0);
        cells_.assign(positions.size(), kNowhere);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (!counts(i)) continue;
            cells_[i] = cellAt(positions[i]);
            ++starts_[cells_[i] + 1];
        }
        for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
        order_.resize(positions.size());
        next_.assign(starts_.begin(), starts_.end() - 1);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (cells_[i] != kNowhere) order_[next_[cells_[i]]++] = static_cast<std::uint32_t>(i);
        }
    }

    bool has(std::size_t i) const { return cells_[i] != kNowhere; }

    /// visit(j) for the points of the 27 cells around point i, which is in one.
    template <class Visit>
    void around(std::size_t i, const Visit& visit) const {
        visitAround(cells_[i], visit);
    }
    /// Likewise around a place, which is finite. All that is within a cell's size of it is among them.
    template <class Visit>
    void around(Float3 place, const Visit& visit) const {
        if (!starts_.empty()) visitAround(cellAt(place), visit);
    }

    std::size_t bytes() const {
        return sizeof(std::uint32_t) * (starts_.size() + order_.size() + cells_.size() + next_.size());
    }

  private:
    static constexpr std::size_t kMaxCells = std::size_t{1} << 21;
    static constexpr std::uint32_t kNowhere = 0xffffffffu;

    static std::array<float, 3> components(Float3 v) { return {v.x, v.y, v.z}; }

    void choose(const std::array<float, 3>& high, float size, bool any) {
        for (double cell = static_cast<double>(size);; cell *= 2.0) {
            double count = 1.0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double width =
                    any ? static_cast<double>(high[axis]) - static_cast<double>(low_[axis]) : 0.0;
                const double along = std::floor(width / cell) + 1.0;
                count *= along;
                size_[axis] = static_cast<std::uint32_t>(std::min(along, 1e9));
            }
            cell_ = static_cast<float>(cell);
            if (count <= static_cast<double>(kMaxCells)) break;
        }
    }

    std::uint32_t cellAt(Float3 place) const {
        const auto at = components(place);
        std::uint32_t cell = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
            const float along =
                std::clamp((at[axis] - low_[axis]) / cell_, 0.0f, static_cast<float>(size_[axis]));
            cell = cell * size_[axis] + std::min(static_cast<std::uint32_t>(along), size_[axis] - 1);
        }
        return cell;
    }

    template <class Visit>
    void visitAround(std::uint32_t cell, const Visit& visit) const {
        const std::uint32_t x = cell % size_[0], y = cell / size_[0] % size_[1],
                            z = cell / size_[0] / size_[1];
        for (std::uint32_t k = z > 0 ? z - 1 : 0; k <= std::min(z + 1, size_[2] - 1); ++k) {
            for (std::uint32_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, size_[1] - 1); ++j) {
                const std::uint32_t row = (k * size_[1] + j) * size_[0];
                const std::uint32_t first = row + (x > 0 ? x - 1 : 0),
                                    last = row + std::min(x + 1, size_[0] - 1);
                for (std::uint32_t at = starts_[first]; at < starts_[last + 1]; ++at) visit(order_[at]);
            }
        }
    }

    std::array<float, 3> low_{};
    std::array<std::uint32_t, 3> size_{1, 1, 1};
    float cell_ = 1.0f;
    std::vector<std::uint32_t> starts_, order_, cells_, next_;
};

}  // namespace hairloom::runtime
