// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/shell.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace hairloom::cards {
namespace {

constexpr int kMostCells = 72;
constexpr float kFinest = 0.003f;    // metres
constexpr float kThickness = 0.02f;  // metres of hair whose share is told
constexpr int kSmoothings = 2;

}  // namespace

ShellField ShellField::make(const Hair& hair, const HairLight& light) {
    ShellField field;
    Box3f box;
    for (const Vec3f& point : hair.positions_ws) box.extend(point);
    constexpr int kMargin = 4;
    field.cell_ = std::max(kFinest, box.sizes().maxCoeff() / static_cast<float>(kMostCells - 2 * kMargin));
    field.low_ = box.min() - Vec3f::Constant(static_cast<float>(kMargin) * field.cell_);
    for (int i = 0; i < 3; ++i) {
        field.size_[static_cast<std::size_t>(i)] =
            std::min(kMostCells + 1, 2 * kMargin + 1 + static_cast<int>(box.sizes()[i] / field.cell_));
    }
    field.cells_.resize(static_cast<std::size_t>(field.size_[0]) * static_cast<std::size_t>(field.size_[1]) *
                        static_cast<std::size_t>(field.size_[2]));
    const float volume = field.cell_ * field.cell_ * field.cell_;
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        for (std::size_t p = hair.offsets[s]; p + 1 < hair.offsets[s + 1]; ++p) {
            const Vec3f &a = hair.positions_ws[p], &b = hair.positions_ws[p + 1];
            const float length = (b - a).norm();
            if (!(length > 0)) continue;
            const int pieces = 1 + static_cast<int>(std::min(2 * length / field.cell_, 1000.0f));
            const float area = length * (hair.radii[p] + hair.radii[p + 1]) / static_cast<float>(pieces);
            for (int i = 0; i < pieces; ++i) {
                const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(pieces);
                const Vec3f place = a + t * (b - a);
                const Vec3f at = (place - field.low_) / field.cell_;
                Cell& cell = field.cells_[field.index(static_cast<int>(at.x()), static_cast<int>(at.y()),
                                                      static_cast<int>(at.z()))];
                cell.density += area / volume, cell.weight += area;
                cell.along += area / length * (b - a), cell.albedo += area * hair.albedo[p];
                cell.open += area * light.open(place);
            }
        }
    }
    for (int step = 0; step < kSmoothings; ++step) field.smooth();
    return field;
}

void ShellField::smooth() {
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Cell> next(cells_.size());
        for (int z = 0; z < size_[2]; ++z) {
            for (int y = 0; y < size_[1]; ++y) {
                for (int x = 0; x < size_[0]; ++x) {
                    Cell& sum = next[index(x, y, z)];
                    for (int d = -1; d <= 1; ++d) {
                        std::array<int, 3> at{x, y, z};
                        int& moved = at[static_cast<std::size_t>(axis)];
                        moved = std::clamp(moved + d, 0, size_[static_cast<std::size_t>(axis)] - 1);
                        const Cell& cell = cells_[index(at[0], at[1], at[2])];
                        const float w = d == 0 ? 0.5f : 0.25f;
                        sum.density += w * cell.density, sum.weight += w * cell.weight;
                        sum.along += w * cell.along, sum.albedo += w * cell.albedo, sum.open += w * cell.open;
                    }
                }
            }
        }
        cells_ = std::move(next);
    }
}

ShellVertex ShellField::vertexAt(const Vec3f& place) const {
    // Weighted by the hair around, so that the border takes the colours of what lies behind it.
    ShellVertex v;
    v.position_ws = low_ + cell_ * (place + Vec3f::Constant(0.5f));
    Vec3f along = Vec3f::Zero(), albedo = Vec3f::Zero(), slope = Vec3f::Zero();
    float open = 0, weight = 0;
    const std::array<int, 3> c{static_cast<int>(place.x()), static_cast<int>(place.y()),
                               static_cast<int>(place.z())};
    for (int z = -1; z <= 2; ++z) {
        for (int y = -1; y <= 2; ++y) {
            for (int x = -1; x <= 2; ++x) {
                const Cell& cell =
                    cells_[index(std::clamp(c[0] + x, 0, size_[0] - 1), std::clamp(c[1] + y, 0, size_[1] - 1),
                                 std::clamp(c[2] + z, 0, size_[2] - 1))];
                along += cell.along, albedo += cell.albedo, open += cell.open, weight += cell.weight;
                const Vec3f to = Vec3f(static_cast<float>(c[0] + x), static_cast<float>(c[1] + y),
                                       static_cast<float>(c[2] + z)) -
                                 place;
                slope -= cell.density * to;
            }
        }
    }
    v.along_ws = along.norm() > 0 ? Vec3f(along.normalized()) : Vec3f(0, -1, 0);
    v.albedo = weight > 0 ? Vec3f(albedo / weight) : Vec3f::Zero();
    v.open = weight > 0 ? open / weight : 1.0f;
    v.normal_ws = slope.norm() > 0 ? Vec3f(slope.normalized()) : Vec3f::UnitY();
    return v;
}

namespace {

/// What is thinner than a cell folds up under simplification: two triangles with the same corners.
void dropRepeats(std::vector<std::uint32_t>& indices) {
    std::set<std::array<std::uint32_t, 3>> seen;
    std::size_t kept = 0;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::array<std::uint32_t, 3> corners{indices[i], indices[i + 1], indices[i + 2]};
        std::ranges::sort(corners);
        if (!seen.insert(corners).second) continue;
        for (std::size_t k = 0; k < 3; ++k) indices[kept + k] = indices[i + k];
        kept += 3;
    }
    indices.resize(kept);
}

}  // namespace

// Naive surface nets (Gibson 1998): a vertex in each cube that the surface crosses, a quad for each edge.
Shell ShellField::cut(float level, std::uint32_t triangles) const {
    const auto value = [&](int x, int y, int z) {
        return 1 - std::exp(-kThickness * cells_[index(x, y, z)].density) - level;
    };
    Shell shell;
    std::map<std::size_t, std::uint32_t> vertexOf;
    const auto vertex = [&](int x, int y, int z) {
        const auto [found, isNew] =
            vertexOf.try_emplace(index(x, y, z), static_cast<std::uint32_t>(shell.vertices.size()));
        if (!isNew) return found->second;
        Vec3f sum = Vec3f::Zero();
        float count = 0;
        for (int corner = 0; corner < 8; ++corner) {
            for (int axis = 0; axis < 3; ++axis) {
                if (corner >> axis & 1) continue;
                std::array<int, 3> a{corner & 1, corner >> 1 & 1, corner >> 2 & 1}, b = a;
                b[static_cast<std::size_t>(axis)] = 1;
                const float va = value(x + a[0], y + a[1], z + a[2]),
                            vb = value(x + b[0], y + b[1], z + b[2]);
                if ((va > 0) == (vb > 0)) continue;
                Vec3f at(static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2]));
                at[axis] += va / (va - vb);
                sum += at, count += 1;
            }
        }
        const Vec3f corner(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        shell.vertices.push_back(vertexAt(corner + sum / count));
        return found->second;
    };
    for (int z = 1; z + 1 < size_[2]; ++z) {
        for (int y = 1; y + 1 < size_[1]; ++y) {
            for (int x = 1; x + 1 < size_[0]; ++x) {
                const bool in = value(x, y, z) > 0;
                for (int axis = 0; axis < 3; ++axis) {
                    std::array<int, 3> d{0, 0, 0};
                    d[static_cast<std::size_t>(axis)] = 1;
                    if (in == (value(x + d[0], y + d[1], z + d[2]) > 0)) continue;
                    const std::array<int, 3> u{d[2], d[0], d[1]}, v{d[1], d[2], d[0]};
                    const std::uint32_t quad[4] = {vertex(x - u[0] - v[0], y - u[1] - v[1], z - u[2] - v[2]),
                                                   vertex(x - v[0], y - v[1], z - v[2]), vertex(x, y, z),
                                                   vertex(x - u[0], y - u[1], z - u[2])};
                    const std::array<int, 6> corners =
                        in ? std::array<int, 6>{0, 1, 2, 0, 2, 3} : std::array<int, 6>{0, 2, 1, 0, 3, 2};
                    for (const int corner : corners) shell.indices.push_back(quad[corner]);
                }
            }
        }
    }
    if (shell.indices.empty()) return shell;
    constexpr float kLargestError = 0.05f;  // of the extent
    std::vector<std::uint32_t> simple(shell.indices.size());
    simple.resize(meshopt_simplify(
        simple.data(), shell.indices.data(), shell.indices.size(), shell.vertices[0].position_ws.data(),
        shell.vertices.size(), sizeof(ShellVertex),
        std::min(std::size_t{3} * triangles, shell.indices.size()), kLargestError, 0, nullptr));
    dropRepeats(simple);
    meshopt_optimizeVertexCache(simple.data(), simple.data(), simple.size(), shell.vertices.size());
    std::vector<ShellVertex> used(shell.vertices.size());
    used.resize(meshopt_optimizeVertexFetch(used.data(), simple.data(), simple.size(), shell.vertices.data(),
                                            shell.vertices.size(), sizeof(ShellVertex)));
    return {std::move(used), std::move(simple)};
}

}  // namespace hairloom::cards
