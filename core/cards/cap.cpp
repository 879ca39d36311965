// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/cap.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/cards/raster.h"
#include "core/geometry/curve.h"

namespace hairloom::cards {
namespace {

constexpr float kClear = 0.0003f;                           // metres above the skin, beside the tolerance
constexpr float kHeadRadius = 0.09f;                        // metres: how much a square of the grid bulges
constexpr float kFinestSquare = 0.004f, kCoarsest = 0.03f;  // metres, squares of the grid
constexpr float kThinned = 0.5f;      // of the tolerance, that fewer triangles may be off those of the grid
constexpr float kOverlap = 0.15f;     // of a square, that charts go beyond the hairs that they hold
constexpr float kShownSlope = 0.35f;  // cosine: skin that turns away further is another chart's

/// The axis that a normal is nearest to: +x, -x, +y and so on.
std::size_t axisOf(const Vec3f& normal) {
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    return 2 * static_cast<std::size_t>(axis) + (normal[axis] < 0 ? 1 : 0);
}

/// Across, along and outwards, right-handed as those of a strip are.
struct Frame {
    Vec3f across, along, outwards;

    explicit Frame(std::size_t axis) {
        outwards = (axis % 2 == 0 ? 1.0f : -1.0f) * Vec3f::Unit(static_cast<Eigen::Index>(axis / 2));
        // Hair hangs down or, on the crown, backwards.
        along = axis / 2 == 1 ? Vec3f(0, 0, -1) : Vec3f(0, -1, 0);
        across = outwards.cross(along);
    }
    Vec3f of(const Vec3f& v) const { return {v.dot(across), v.dot(along), v.dot(outwards)}; }
    Vec3f back(const Vec3f& v) const { return v.x() * across + v.y() * along + v.z() * outwards; }
};

/// A root as a chart sees it.
struct Root {
    Vec3f at, normal;
};

class Grid {
  public:
    Grid(const std::vector<Vec3f>& held, float square) : square_(square) {
        Vec2f low = held[0].head<2>(), high = low;
        for (const Vec3f& p : held) low = low.cwiseMin(p.head<2>()), high = high.cwiseMax(p.head<2>());
        // Charts overlap, so that no seam of skin shows where the next one begins.
        const float margin = kOverlap * square;
        low_ = low = low - Vec2f::Constant(margin);
        high += Vec2f::Constant(margin);
        columns_ = static_cast<std::uint32_t>((high - low).x() / square) + 1;
        rows_ = static_cast<std::uint32_t>((high - low).y() / square) + 1;
        full_.assign(std::size_t{columns_} * rows_, false);
        for (const Vec3f& p : held) {
            for (const float x : {-margin, margin})
                for (const float y : {-margin, margin}) fill(p.head<2>() + Vec2f(x, y));
        }
    }
    std::uint32_t columns() const { return columns_; }
    std::uint32_t rows() const { return rows_; }
    bool isFull(std::uint32_t x, std::uint32_t y) const { return full_[std::size_t{y} * columns_ + x]; }
    Vec2f corner(std::uint32_t x, std::uint32_t y) const {
        return low_ + square_ * Vec2f(static_cast<float>(x), static_cast<float>(y));
    }
    Vec2f size() const { return corner(columns_, rows_) - low_; }

  private:
    void fill(const Vec2f& place) {
        const Vec2f at = ((place - low_) / square_).cwiseMax(0.0f);
        const auto x = std::min(static_cast<std::uint32_t>(at.x()), columns_ - 1);
        const auto y = std::min(static_cast<std::uint32_t>(at.y()), rows_ - 1);
        full_[std::size_t{y} * columns_ + x] = true;
    }

    float square_;
    Vec2f low_;
    std::uint32_t columns_, rows_;
    std::vector<bool> full_;
};

/// Where skin lies behind skin, as a chest behind a beard, what is farther back than so many squares is
/// another sheet. Without that a chart would hang between the two.
constexpr float kSheet = 4;

/// Roots as a chart sees them, by squares of a grid, so that none far away are looked at.
class Roots {
  public:
    Roots(std::vector<Root> roots, float square) : roots_(std::move(roots)), square_(square) {
        Vec2f high = low_ = roots_[0].at.head<2>();
        for (const Root& root : roots_)
            low_ = low_.cwiseMin(root.at.head<2>()), high = high.cwiseMax(root.at.head<2>());
        columns_ = columnOf(high.x()) + 1, rows_ = rowOf(high.y()) + 1;
        starts_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
        const auto cellOf = [&](const Root& root) { return cell(columnOf(root.at.x()), rowOf(root.at.y())); };
        std::ranges::stable_sort(roots_, {}, cellOf);
        for (const Root& root : roots_) ++starts_[cellOf(root) + 1];
        for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    }

    /// Height and normal of the outermost skin at a place, from the planes that touch it at the roots around.
    Root skinAt(const Vec2f& place) const {
        const float reach = 0.5f * square_;
        // Near roots count so much more that one far away matters only where there is no other.
        constexpr float kNothing = 12;
        const float nearest = nearestSquare(place);
        const float farthest = nearest + kNothing * reach * reach;
        float outermost = -std::numeric_limits<float>::infinity();
        forRootsWithin(place, farthest,
                       [&](const Root& root, float) { outermost = std::max(outermost, root.at.z()); });
        float weights = 0, height = 0;
        Vec3f normal = Vec3f::Zero();
        forRootsWithin(place, farthest, [&](const Root& root, float square) {
            if (root.at.z() < outermost - kSheet * square_) return;
            const float weight = std::exp((nearest - square) / (reach * reach));
            const Vec2f away = place - root.at.head<2>();
            const float fall = root.normal.head<2>().dot(away) / std::max(root.normal.z(), kShownSlope);
            weights += weight, height += weight * (root.at.z() - fall), normal += weight * root.normal;
        });
        return {Vec3f(place.x(), place.y(), height / weights), normal.normalized()};
    }

  private:
    int columnOf(float x) const { return static_cast<int>(std::floor((x - low_.x()) / square_)); }
    int rowOf(float y) const { return static_cast<int>(std::floor((y - low_.y()) / square_)); }
    std::size_t cell(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    template <class F>
    void forCells(int left, int right, int top, int bottom, const F& f) const {
        left = std::max(left, 0), right = std::min(right, columns_ - 1);
        for (int row = std::max(top, 0); row <= std::min(bottom, rows_ - 1); ++row) {
            if (left > right) continue;
            for (std::size_t r = starts_[cell(left, row)]; r < starts_[cell(right, row) + 1]; ++r)
                f(roots_[r]);
        }
    }
    template <class F>
    void forRootsWithin(const Vec2f& place, float farthestSquare, const F& f) const {
        const float far = std::sqrt(farthestSquare);
        forCells(columnOf(place.x() - far), columnOf(place.x() + far), rowOf(place.y() - far),
                 rowOf(place.y() + far), [&](const Root& root) {
                     const float square = (root.at.head<2>() - place).squaredNorm();
                     if (square <= farthestSquare) f(root, square);
                 });
    }
    /// Square of the distance to the nearest root: larger squares of cells until one must hold it.
    float nearestSquare(const Vec2f& place) const {
        const int column = columnOf(place.x()), row = rowOf(place.y());
        float nearest = std::numeric_limits<float>::infinity();
        for (int ring = 1;; ring *= 2) {
            forCells(column - ring, column + ring, row - ring, row + ring, [&](const Root& root) {
                nearest = std::min(nearest, (root.at.head<2>() - place).squaredNorm());
            });
            const float seen = static_cast<float>(ring) * square_;
            if (nearest <= seen * seen) return nearest;
        }
    }

    std::vector<Root> roots_;  ///< by cells
    float square_;
    Vec2f low_ = Vec2f::Zero();
    int columns_ = 1, rows_ = 1;
    std::vector<std::size_t> starts_;  ///< of each cell, and where the last one ends
};

/// Fewer triangles where the skin is flatter than the squares of the grid are made for.
void thin(CapChart& chart, const Frame& frame, float square, float tolerance) {
    if (chart.indices.empty()) return;
    const float* const first = chart.vertices[0].position_ws.data();
    const float size = meshopt_simplifyScale(first, chart.vertices.size(), sizeof(CapChart::Vertex));
    std::vector<std::uint32_t> fewer(chart.indices.size());
    fewer.resize(meshopt_simplify(fewer.data(), chart.indices.data(), chart.indices.size(), first,
                                  chart.vertices.size(), sizeof(CapChart::Vertex), 0, tolerance / size, 0,
                                  nullptr));
    // Along a straight border three corners get to lie on a line: such a triangle stands upright on the skin.
    constexpr float kLeast = 1e-3f;  // of a square, as the chart looks at it
    chart.indices.clear();
    for (std::size_t i = 0; i + 2 < fewer.size(); i += 3) {
        const auto at = [&](std::size_t k) { return chart.vertices[fewer[i + k]].position_ws; };
        const float area = 0.5f * (at(1) - at(0)).cross(at(2) - at(0)).dot(frame.outwards);
        if (area > kLeast * square * square)
            chart.indices.insert(chart.indices.end(), {fewer[i], fewer[i + 1], fewer[i + 2]});
    }
    std::vector<CapChart::Vertex> used(chart.vertices.size());
    used.resize(meshopt_optimizeVertexFetch(used.data(), chart.indices.data(), chart.indices.size(),
                                            chart.vertices.data(), chart.vertices.size(),
                                            sizeof(CapChart::Vertex)));
    chart.vertices = std::move(used);
}

Strip planeOf(const Frame& frame, const Vec2f& low, const Vec2f& size, float height) {
    Strip plane;
    for (const float end : {0.0f, 1.0f}) {
        plane.centre.push_back(
            frame.back(Vec3f(low.x() + 0.5f * size.x(), low.y() + end * size.y(), height)));
        plane.along.push_back(frame.along), plane.cross.push_back(frame.across);
        plane.normal.push_back(frame.outwards);
        plane.halfWidth.push_back(0.5f * size.x());
        plane.bend.push_back(0), plane.spread.push_back(0);
    }
    return plane;
}

CapChart chartOf(const Hair& laid, std::size_t axis, float tolerance, Cancel cancel) {
    const Frame frame(axis);
    CapChart chart;
    std::vector<Root> roots;
    std::vector<Vec3f> held;
    for (std::uint32_t s = 0; s < laid.strandCount(); ++s) {
        const Vec3f normal = frame.of(laid.rootNormals_ws[s]);
        if (normal.z() < kShownSlope) continue;
        chart.strands.push_back(s);
        roots.push_back({frame.of(laid.strand(s)[0]), normal});
        if (axisOf(laid.rootNormals_ws[s]) != axis) continue;
        for (const Vec3f& point : laid.strand(s)) held.push_back(frame.of(point));
    }
    if (held.empty()) return chart;
    // A chord of length c leaves a ball of radius r by c² / 8r. Diagonals where three charts meet are longer.
    constexpr float kSteep = 0.5f;
    const float square =
        std::clamp(kSteep * std::sqrt(8 * kHeadRadius * tolerance), kFinestSquare, kCoarsest);
    const Grid grid(held, square);
    const Vec2f low = grid.corner(0, 0), size = grid.size();
    chart.plane = planeOf(frame, low, size, held[0].z());
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const std::uint32_t across = grid.columns() + 1;
    std::vector<std::uint32_t> numbers(std::size_t{across} * (grid.rows() + 1), kNone);
    std::vector<Vec2f> places;
    const auto number = [&](std::uint32_t x, std::uint32_t y) {
        std::uint32_t& n = numbers[std::size_t{y} * across + x];
        if (n == kNone) n = static_cast<std::uint32_t>(places.size()), places.push_back(grid.corner(x, y));
        return n;
    };
    std::vector<std::array<std::uint32_t, 4>> cells;
    for (std::uint32_t y = 0; y < grid.rows(); ++y) {
        for (std::uint32_t x = 0; x < grid.columns(); ++x) {
            if (grid.isFull(x, y))
                cells.push_back({number(x, y), number(x + 1, y), number(x, y + 1), number(x + 1, y + 1)});
        }
    }
    const Roots skinRoots(std::move(roots), square);
    chart.vertices.resize(places.size());
    std::vector<float> heights(places.size());
    parallelFor(places.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end && !cancelled(cancel); ++v) {
            const Root skin = skinRoots.skinAt(places[v]);
            heights[v] = skin.at.z();
            chart.vertices[v] = {frame.back(skin.at + (kClear + tolerance) * skin.normal),
                                 frame.back(skin.normal), (places[v] - low).cwiseQuotient(size)};
        }
    });
    for (const auto& [a, b, c, d] : cells) {
        const auto [lowest, highest] = std::minmax({heights[a], heights[b], heights[c], heights[d]});
        if (highest - lowest > kSheet * square) continue;  // from one sheet to another
        for (const std::uint32_t v : {a, c, b, b, c, d}) chart.indices.push_back(v);
    }
    thin(chart, frame, square, kThinned * tolerance);
    return chart;
}

/// Straight down, hair that stands straight up covers nothing, but eyes look at skin aslant: laid, it reaches
/// kAslant of its length aside, any way. Hair that leans covers what it covers.
constexpr float kAslant = 0.5f;
void layAside(std::size_t strand, const Vec3f& normal, float length, std::span<Vec3f> laid) {
    constexpr float kNoWay = 0.05f;  // of its length
    if ((laid.back() - laid.front()).norm() > kNoWay * length) return;
    const Vec3f x = normal.unitOrthogonal();
    const float turn = 2 * kPi * hashUnit(static_cast<std::uint32_t>(strand), 17, 0);
    const Vec3f way = kAslant * length * (std::cos(turn) * x + std::sin(turn) * normal.cross(x));
    for (std::size_t p = 1; p < laid.size(); ++p)
        laid[p] = laid[0] + static_cast<float>(p) / static_cast<float>(laid.size() - 1) * way;
}

}  // namespace

LaidRoots laidRoots(const Hair& hair) {
    LaidRoots roots;
    Hair& laid = roots.hair;
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        const Vec3f root = hair.strand(s)[0], normal = hair.rootNormals_ws[s];
        const auto add = [&](const Vec3f& point, std::size_t p, float t) {
            roots.grown_ws.push_back(point);
            laid.positions_ws.push_back(point - (point - root).dot(normal) * normal);
            laid.radii.push_back(t < 1 ? (1 - t) * hair.radii[p] + t * hair.radii[p + 1] : hair.radii[p + 1]);
            laid.albedo.push_back(t < 1 ? Vec3f((1 - t) * hair.albedo[p] + t * hair.albedo[p + 1])
                                        : hair.albedo[p + 1]);
        };
        add(root, hair.offsets[s], 0);
        float left = kOnCap;
        for (std::size_t p = hair.offsets[s]; p + 1 < hair.offsets[s + 1] && left > 0; ++p) {
            const Vec3f &a = hair.positions_ws[p], &b = hair.positions_ws[p + 1];
            const float length = (b - a).norm();
            const float t = length > left ? left / length : 1.0f;
            add((1 - t) * a + t * b, p, t);
            left -= length;
        }
        layAside(s, normal, kOnCap - std::max(left, 0.0f),
                 std::span(laid.positions_ws).subspan(laid.offsets.back()));
        laid.offsets.push_back(static_cast<std::uint32_t>(laid.positions_ws.size()));
        laid.rootNormals_ws.push_back(normal);
    }
    return roots;
}

Result<std::vector<CapChart>> makeCap(const Hair& hair, float tolerance, Cancel cancel) {
    const Hair laid = laidRoots(hair).hair;
    std::vector<CapChart> charts;
    constexpr std::size_t kAxes = 6;
    for (std::size_t axis = 0; axis < kAxes && !cancelled(cancel); ++axis) {
        CapChart chart = chartOf(laid, axis, tolerance, cancel);
        if (!chart.indices.empty()) charts.push_back(std::move(chart));
    }
    parallelFor(charts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end && !cancelled(cancel); ++c) setHidden(hair, charts[c]);
    });
    if (cancelled(cancel)) return stopped();
    return charts;
}

Picture bakeCap(const Hair& hair, const LaidRoots& laid, const HairLight& light, const CapChart& chart,
                float thickness, std::uint32_t width, std::uint32_t height) {
    Picture picture = bake(laid.hair, light, chart.plane, chart.strands,
                           {.thickness = thickness, .grown_ws = laid.grown_ws}, width, height);
    double shown = 0, whole = 0;
    for (const std::uint32_t s : chart.strands) {
        const double length = static_cast<double>(polylineLength(hair.strand(s)));
        shown += std::min(length, static_cast<double>(kOnCap)), whole += length;
    }
    const auto share = static_cast<float>(whole > 0 ? shown / whole : 1);
    for (Texel& texel : picture.texels) texel.along *= share;  // of a whole hair
    return picture;
}

}  // namespace hairloom::cards
