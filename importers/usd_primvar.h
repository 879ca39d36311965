// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Values that a mesh of USD has at its corners, points or faces.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/usd_values.h"

namespace hairloom {

/// How many of each a mesh has, as the file counts them.
struct UsdMeshSize {
    std::size_t points = 0, corners = 0, faces = 0;
};

/// Values of a few numbers each, wherever the file has them.
class UsdPrimvar {
  public:
    /// Nothing where the mesh has no such attribute, with `components` numbers a value. `otherwise` is where
    /// the values stand when the file does not say. `problem` says why what is there cannot be used.
    static std::optional<UsdPrimvar> read(const UsdPrim& mesh, std::string_view name,
                                          std::uint32_t components, std::string_view otherwise, double time,
                                          const UsdMeshSize& size, std::string& problem);

    /// The numbers of a corner, by the places in the file of itself, its point and its face; null where the
    /// file names a value that it does not have.
    const float* at(std::size_t corner, std::size_t point, std::size_t face) const;

  private:
    enum class Scope : std::uint8_t { Constant, Face, Point, Corner };
    Scope scope_ = Scope::Point;
    std::uint32_t components_ = 1;
    std::vector<float> numbers_;
    std::vector<std::int64_t> places_;  ///< of values among the numbers; empty: one after the other
};

/// The name of the mesh's texture coordinates: "primvars:st", else the first that is meant as such; empty
/// where there are none.
std::string uvNameOf(const UsdPrim& mesh);

}  // namespace hairloom
