// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Transforms that change in time, as keys of a bone.

#include <functional>
#include <set>

#include "core/animation/clip.h"

namespace hairloom {

/// A transform in the parts that keys have; what it shears is lost.
struct TransformParts {
    Eigen::Vector3d place, factors;
    Eigen::Quaterniond turn;

    static TransformParts of(const Eigen::Affine3d& transform);
    TransformParts towards(const TransformParts& other, double share) const;
    Eigen::Affine3d whole() const;
};

/// Fills the channel with a transform at its times, and between these where keys would lead elsewhere than
/// it goes. `seconds` gives those of a time. Whether something of it shears. Errors: those of `at`.
Result<bool> addTransformKeys(const std::set<double>& times,
                              const std::function<Result<Eigen::Affine3d>(double)>& at,
                              const std::function<float(double)>& seconds, Channel& channel);

}  // namespace hairloom
