// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bones and where they rest. Metres, Y up, right-handed.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom {

inline constexpr std::uint32_t kNoBone = 0xffffffffu;

struct Bone {
    std::string name;                ///< may repeat; find() gives the first
    std::uint32_t parent = kNoBone;  ///< index of the bone it hangs on; kNoBone: on the world
    Eigen::Affine3f rest = Eigen::Affine3f::Identity();         ///< to the parent's space, without animation
    Eigen::Affine3f inverseBind = Eigen::Affine3f::Identity();  ///< from the mesh's rest space to the bone's
};

/// A forest of bones in any order.
class Skeleton {
  public:
    Skeleton() = default;
    /// Errors: a parent that does not exist, a bone that is its own ancestor, a matrix that is not finite.
    static Result<Skeleton> make(std::vector<Bone> bones);

    const std::vector<Bone>& bones() const { return bones_; }
    bool empty() const { return bones_.empty(); }
    std::optional<std::uint32_t> find(std::string_view name) const;
    /// Bone indices with every parent before its children.
    std::span<const std::uint32_t> order() const { return order_; }

    /// From each bone's space to the world's, given from each bone's space to its parent's. One matrix per
    /// bone.
    std::vector<Eigen::Affine3f> worldMatrices(std::span<const Eigen::Affine3f> local) const;

  private:
    std::vector<Bone> bones_;
    std::vector<std::uint32_t> order_;
};

}  // namespace hairloom
