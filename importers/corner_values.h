// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Values that a mesh of USD or Alembic has at its corners, points or faces.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hairloom {

/// How many of each a mesh has, as the file counts them.
struct MeshCounts {
    std::size_t points = 0, corners = 0, faces = 0;
};

/// Values of a few numbers each, wherever the file has them.
class CornerValues {
  public:
    enum class Scope : std::uint8_t { Constant, Face, Point, Corner };

    /// `places` are those of values among the numbers; empty: one after the other. Without a scope it is that
    /// whose number of values fits. Nothing where there is none, for which `problem` has the reason.
    static std::optional<CornerValues> make(std::vector<float> numbers, std::uint32_t components,
                                            std::vector<std::int64_t> places, std::optional<Scope> scope,
                                            const MeshCounts& mesh, std::string& problem);

    /// The numbers of a corner, by the places in the file of itself, its point and its face; null where the
    /// file names a value that it does not have.
    const float* at(std::size_t corner, std::size_t point, std::size_t face) const;

  private:
    Scope scope_ = Scope::Point;
    std::uint32_t components_ = 1;
    std::vector<float> numbers_;
    std::vector<std::int64_t> places_;
};

}  // namespace hairloom
