// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Curves of exchange formats as points on them: which control points a point of the curve is made of, and how
// much.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

enum class CurveBasis : std::uint8_t { Linear, Bezier, BSpline, CatmullRom, Nurbs };
enum class CurveWrap : std::uint8_t {
    Open,
    Periodic,
    Pinned  ///< open, and the ends are the first and the last control point
};

/// One curve without its points.
struct CurveForm {
    CurveBasis basis = CurveBasis::Linear;
    CurveWrap wrap = CurveWrap::Open;
    std::uint32_t order = 4;        ///< of NURBS, degree + 1
    std::span<const double> knots;  ///< of NURBS: control points + order, ascending; empty: uniform
};

inline constexpr std::uint32_t kMaxOrder = 8;

/// A point on the curve: Σ weight · control point. `knot` is its parameter in spans from the start, for what
/// is given per knot.
struct CurvePoint {
    std::uint32_t count = 1;
    std::array<std::uint32_t, kMaxOrder> index{};
    std::array<double, kMaxOrder> weight{1.0};
    double knot = 0;
};

/// The points of a curve of `controls` control points: curves that pass through their control points
/// (polylines, Catmull-Rom) are taken at these, others at as many even steps of the parameter as they have
/// control points. A closed curve ends where it begins. Errors, without a file: too few control points for
/// the basis, a number that the basis does not allow, an order or knots that are none.
Result<std::vector<CurvePoint>> evaluateCurve(const CurveForm& form, std::uint32_t controls);

/// Values that a curve of so many control points has one of at each knot (what USD calls varying).
std::uint32_t knotCount(const CurveForm& form, std::uint32_t controls);

}  // namespace hairloom
