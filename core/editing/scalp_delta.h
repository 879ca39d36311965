// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Faces of the scalp selection and values of the density map that differ, to be exchanged.

#include <span>
#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom::editing {

/// Faces that are in one selection and not in the other.
class FaceDelta {
  public:
    /// Makes `faces` (ascending, without repeats) the selection; may be called again.
    void set(Groom& groom, FaceSet faces, std::string expression = {});
    void exchange(Groom& groom);
    bool empty() const { return toggled_.empty(); }
    std::size_t bytes() const;

  private:
    FaceSet toggled_;
    std::string expression_;  ///< how the other selection was made
};

/// Values of the density map at some vertices.
class DensityDelta {
  public:
    /// Gives vertices (ascending) these values in [0, 1]; may be called again. The groom has a head.
    void set(Groom& groom, std::span<const std::uint32_t> vertices, std::span<const float> values);
    void exchange(Groom& groom);
    bool empty() const { return vertices_.empty(); }
    std::size_t bytes() const;

  private:
    std::vector<std::uint32_t> vertices_;  ///< ascending
    std::vector<float> values_;
    bool absent_ = false;  ///< the other map has no values, which means 1 everywhere
};

/// The faces of a and b that are not in both, ascending.
FaceSet differentFaces(const FaceSet& a, const FaceSet& b);

}  // namespace hairloom::editing
