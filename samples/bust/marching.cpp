// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <unordered_map>

#include "core/base/parallel.h"
#include "samples/bust/mesher.h"

namespace hairloom::bust {
namespace {

const Vec3d kLow(0.0, 1.325, -0.185);
const Vec3d kHigh(0.175, 1.79, 0.130);

/// Values of `surface` at the corners of a grid that starts in the plane x = 0.
struct Grid {
    Eigen::Vector3i count;
    double cell;
    std::vector<double> values;

    explicit Grid(double cellSize)
        : count(((kHigh - kLow) / cellSize).array().ceil().cast<int>().matrix() + Eigen::Vector3i::Ones()),
          cell(cellSize) {
        values.resize(static_cast<std::size_t>(count.x()) * count.y() * count.z());
        parallelFor(values.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) values[i] = surface(point(static_cast<int>(i)));
        });
    }
    int index(const Eigen::Vector3i& c) const { return (c.z() * count.y() + c.y()) * count.x() + c.x(); }
    Vec3d point(int i) const {
        const Eigen::Vector3i c(i % count.x(), i / count.x() % count.y(), i / count.x() / count.y());
        return kLow + cell * c.cast<double>();
    }
};

/// The six tetrahedra round the diagonal from corner 0 to corner 7 of a cube (bit 0 x, bit 1 y, bit 2 z).
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                   {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

class Marcher {
  public:
    Marcher(const Grid& grid, PatchMesh& mesh) : grid_(grid), mesh_(mesh) {}

    void tetrahedron(const std::array<int, 4>& corners) {
        std::array<int, 4> in{};
        std::array<int, 4> out{};
        int inside = 0;
        int outside = 0;
        for (const int c : corners) {
            if (grid_.values[static_cast<std::size_t>(c)] < 0) {
                in[inside++] = c;
            } else {
                out[outside++] = c;
            }
        }
        if (inside == 1)
            triangle(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]), in[0]);
        if (inside == 3)
            triangle(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]), in[0]);
        if (inside == 2) {
            const int a = crossing(in[0], out[0]);
            const int b = crossing(in[0], out[1]);
            const int c = crossing(in[1], out[1]);
            const int d = crossing(in[1], out[0]);
            triangle(a, b, c, in[0]);
            triangle(a, c, d, in[1]);
        }
    }

  private:
    int crossing(int inside, int outside) {
        const auto key = static_cast<std::uint64_t>(inside) << 32u | static_cast<std::uint32_t>(outside);
        const auto [entry, fresh] = vertices_.try_emplace(key, static_cast<int>(mesh_.positions.size()));
        if (fresh) {
            const double a = grid_.values[static_cast<std::size_t>(inside)];
            const double b = grid_.values[static_cast<std::size_t>(outside)];
            const double t = std::clamp(a / (a - b), 0.01, 0.99);
            mesh_.positions.push_back(grid_.point(inside) * (1.0 - t) + grid_.point(outside) * t);
        }
        return entry->second;
    }
    void triangle(int a, int b, int c, int insideCorner) {
        const auto& p = mesh_.positions;
        const Vec3d normal = (p[b] - p[a]).cross(p[c] - p[a]);
        if (normal.dot(p[a] - grid_.point(insideCorner)) < 0) std::swap(b, c);
        mesh_.triangles.push_back({a, b, c});
        mesh_.patches.push_back(Patch::NeckFront);
    }

    const Grid& grid_;
    PatchMesh& mesh_;
    std::unordered_map<std::uint64_t, int> vertices_;
};

using Edge = std::pair<int, int>;
Edge edgeOf(int a, int b) {
    return {std::min(a, b), std::max(a, b)};
}

/// Splits triangles of `divided` along a border; those below zero become `below`.
void cut(PatchMesh& mesh, Patch divided, Border which, Patch below) {
    std::vector<double> side(mesh.positions.size());
    for (std::size_t v = 0; v < side.size(); ++v) side[v] = border(which, mesh.positions[v]);

    std::map<Edge, int> middles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.patches[t] != divided) continue;
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = edgeOf(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
            if (side[a] * side[b] >= 0 || middles.contains({a, b})) continue;
            const double s = std::clamp(side[a] / (side[a] - side[b]), 0.02, 0.98);
            middles[{a, b}] = static_cast<int>(mesh.positions.size());
            mesh.positions.push_back(mesh.positions[a] * (1 - s) + mesh.positions[b] * s);
            side.push_back(0.0);
        }
    }
    PatchMesh result{mesh.positions, {}, {}};
    const auto emit = [&](Patch patch, int a, int b, int c) {
        const double sum = side[a] + side[b] + side[c];
        result.triangles.push_back({a, b, c});
        result.patches.push_back(patch == divided && sum < 0 ? below : patch);
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<int, 3> v = mesh.triangles[t];
        std::array<int, 3> m{};
        int cuts = 0;
        for (int k = 0; k < 3; ++k) {
            const auto found = middles.find(edgeOf(v[k], v[(k + 1) % 3]));
            m[k] = found == middles.end() ? -1 : found->second;
            cuts += m[k] >= 0;
        }
        // Turned so that the first edge is cut, and with two cuts the last one too.
        const auto turned = [&] { return cuts == 0 || (m[0] >= 0 && (cuts == 1 || m[2] >= 0)); };
        while (!turned()) {
            v = {v[1], v[2], v[0]};
            m = {m[1], m[2], m[0]};
        }
        const Patch patch = mesh.patches[t];
        if (cuts == 0) emit(patch, v[0], v[1], v[2]);
        if (cuts == 1) {
            emit(patch, v[0], m[0], v[2]);
            emit(patch, m[0], v[1], v[2]);
        }
        if (cuts == 2) {
            emit(patch, v[0], m[0], m[2]);
            emit(patch, m[0], v[1], v[2]);
            emit(patch, m[0], v[2], m[2]);
        }
    }
    mesh = std::move(result);
}

}  // namespace

PatchMesh marchHalf(double cell) {
    const Grid grid(cell);
    PatchMesh mesh;
    Marcher marcher(grid, mesh);
    Eigen::Vector3i c;
    for (c.z() = 0; c.z() + 1 < grid.count.z(); ++c.z()) {
        for (c.y() = 0; c.y() + 1 < grid.count.y(); ++c.y()) {
            for (c.x() = 0; c.x() + 1 < grid.count.x(); ++c.x()) {
                for (const auto& tetrahedron : kTetrahedra) {
                    std::array<int, 4> corners{};
                    for (int k = 0; k < 4; ++k) {
                        const int bits = tetrahedron[k];
                        corners[k] = grid.index(c + Eigen::Vector3i(bits & 1, bits >> 1 & 1, bits >> 2 & 1));
                    }
                    marcher.tetrahedron(corners);
                }
            }
        }
    }
    return mesh;
}

void cutIntoPatches(PatchMesh& half) {
    cut(half, Patch::NeckFront, Border::Ear, Patch::Ear);
    cut(half, Patch::NeckFront, Border::Hairline, Patch::Scalp);
    cut(half, Patch::NeckFront, Border::Collar, Patch::ShouldersFront);
    cut(half, Patch::NeckFront, Border::Jaw, Patch::Face);
    cut(half, Patch::NeckFront, Border::Seam, Patch::NeckBack);
    cut(half, Patch::ShouldersFront, Border::Seam, Patch::ShouldersBack);
}

PatchMesh mirror(const PatchMesh& half) {
    PatchMesh whole = half;
    std::vector<int> other(half.positions.size());
    for (std::size_t v = 0; v < other.size(); ++v) {
        const Vec3d& p = half.positions[v];
        other[v] = static_cast<int>(v);
        if (p.x() == 0.0) continue;
        other[v] = static_cast<int>(whole.positions.size());
        whole.positions.emplace_back(-p.x(), p.y(), p.z());
    }
    for (std::size_t t = 0; t < half.triangles.size(); ++t) {
        const auto& v = half.triangles[t];
        whole.triangles.push_back({other[v[0]], other[v[2]], other[v[1]]});
        whole.patches.push_back(half.patches[t]);
    }
    return whole;
}

}  // namespace hairloom::bust
