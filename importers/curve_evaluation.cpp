// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/curve_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hairloom {
namespace {

using Weights = std::array<double, 4>;

Weights bezierWeights(double t) {
    const double s = 1 - t;
    return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

Weights bSplineWeights(double t) {
    const double s = 1 - t;
    return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
            t * t * t / 6};
}

bool isClosed(const CurveForm& form) {
    return form.wrap == CurveWrap::Periodic;
}

CurvePoint atControl(std::uint32_t control, double knot) {
    CurvePoint point;
    point.index[0] = control;
    point.knot = knot;
    return point;
}

/// The span of an even step over `spans` and the parameter in it; the last step ends the last span.
std::pair<std::uint32_t, double> stepIn(std::uint32_t step, std::uint32_t steps, std::uint32_t spans) {
    // In whole numbers: a step that meets a knot meets it exactly.
    const std::uint64_t at = std::uint64_t{step} * spans;
    const auto span = static_cast<std::uint32_t>(std::min<std::uint64_t>(at / steps, spans - 1));
    return {span, static_cast<double>(at - std::uint64_t{span} * steps) / steps};
}

std::vector<CurvePoint> throughControls(const CurveForm& form, std::uint32_t controls) {
    std::vector<CurvePoint> points;
    // The ends of an open Catmull-Rom curve are its second and last but one control point.
    const bool inner = form.basis == CurveBasis::CatmullRom && form.wrap == CurveWrap::Open;
    const std::uint32_t begin = inner ? 1 : 0, end = inner ? controls - 1 : controls;
    for (std::uint32_t i = begin; i < end; ++i) points.push_back(atControl(i, i - begin));
    if (isClosed(form)) points.push_back(atControl(0, controls));
    return points;
}

std::vector<CurvePoint> alongBezier(const CurveForm& form, std::uint32_t controls) {
    const std::uint32_t spans = isClosed(form) ? controls / 3 : (controls - 1) / 3;
    std::vector<CurvePoint> points;
    for (std::uint32_t step = 0; step <= 3 * spans; ++step) {
        const auto [span, t] = stepIn(step, 3 * spans, spans);
        const Weights weights = bezierWeights(t);
        CurvePoint point;
        point.count = 4;
        for (std::uint32_t k = 0; k < 4; ++k) {
            point.index[k] = (3 * span + k) % controls;
            point.weight[k] = weights[k];
        }
        point.knot = span + t;
        points.push_back(point);
    }
    return points;
}

/// Control points before the first and behind the last of a pinned curve continue it straight: 2 P₀ − P₁.
void addPinned(CurvePoint& point, std::int64_t control, double weight, std::uint32_t controls) {
    const auto add = [&](std::uint32_t index, double share) {
        for (std::uint32_t k = 0; k < point.count; ++k) {
            if (point.index[k] != index) continue;
            point.weight[k] += share;
            return;
        }
        point.index[point.count] = index;
        point.weight[point.count++] = share;
    };
    if (control < 0) {
        add(0, 2 * weight);
        add(1, -weight);
    } else if (control >= controls) {
        add(controls - 1, 2 * weight);
        add(controls - 2, -weight);
    } else {
        add(static_cast<std::uint32_t>(control), weight);
    }
}

std::vector<CurvePoint> alongBSpline(const CurveForm& form, std::uint32_t controls) {
    const bool pinned = form.wrap == CurveWrap::Pinned;
    const std::uint32_t spans = isClosed(form) ? controls : pinned ? controls - 1 : controls - 3;
    const std::uint32_t steps = isClosed(form) ? controls : controls - 1;
    std::vector<CurvePoint> points;
    for (std::uint32_t step = 0; step <= steps; ++step) {
        const auto [span, t] = stepIn(step, steps, spans);
        const Weights weights = bSplineWeights(t);
        CurvePoint point;
        point.count = 0;
        for (std::uint32_t k = 0; k < 4; ++k) {
            if (pinned) {
                addPinned(point, std::int64_t{span} + k - 1, weights[k], controls);
            } else {
                point.index[point.count] = (span + k) % controls;
                point.weight[point.count++] = weights[k];
            }
        }
        point.knot = span + t;
        points.push_back(point);
    }
    return points;
}

/// The order · B-spline weights at u in [knots[span], knots[span + 1]) (Piegl and Tiller 1997, algorithm
/// A2.2).
CurvePoint deBoor(std::span<const double> knots, std::uint32_t span, std::uint32_t order, double u) {
    CurvePoint point;
    point.count = order;
    std::array<double, kMaxOrder> left{}, right{};
    for (std::uint32_t j = 1; j < order; ++j) {
        left[j] = u - knots[span + 1 - j];
        right[j] = knots[span + j] - u;
        double saved = 0;
        for (std::uint32_t r = 0; r < j; ++r) {
            const double width = right[r + 1] + left[j - r];
            const double share = width != 0 ? point.weight[r] / width : 0;
            point.weight[r] = saved + right[r + 1] * share;
            saved = left[j - r] * share;
        }
        point.weight[j] = saved;
    }
    for (std::uint32_t k = 0; k < order; ++k) point.index[k] = span + 1 - order + k;
    return point;
}

Status checkKnots(std::span<const double> knots) {
    if (!std::ranges::all_of(knots, [](double knot) { return std::isfinite(knot); }))
        return fail("knots are not finite", "expected ascending numbers");
    if (!std::ranges::is_sorted(knots))
        return fail("knots are not in ascending order", "expected ascending numbers");
    return {};
}

Result<std::vector<CurvePoint>> alongNurbs(const CurveForm& form, std::uint32_t controls) {
    std::vector<double> uniform;
    std::span<const double> knots = form.knots;
    if (knots.empty()) {
        for (std::uint32_t i = 0; i < controls + form.order; ++i) uniform.push_back(i);
        knots = uniform;
    }
    if (auto status = checkKnots(knots); !status) return tl::unexpected(status.error());
    const double from = knots[form.order - 1], to = knots[controls];
    if (!(to > from)) return fail("the knots leave no range of the curve", "expected ascending knots");
    std::vector<CurvePoint> points;
    const std::uint32_t steps = controls - 1;
    std::uint32_t span = form.order - 1;
    for (std::uint32_t step = 0; step <= steps; ++step) {
        const double u = from + (to - from) * step / steps;
        while (span + 1 < controls && u >= knots[span + 1]) ++span;
        while (span > form.order - 1 && knots[span] == knots[span + 1]) --span;
        points.push_back(deBoor(knots, span, form.order, u));
        points.back().knot = step;
    }
    return points;
}

std::uint32_t fewestControls(const CurveForm& form) {
    switch (form.basis) {
        case CurveBasis::Linear:
            return isClosed(form) ? 3 : 2;
        case CurveBasis::Bezier:
            return isClosed(form) ? 3 : 4;
        case CurveBasis::BSpline:
        case CurveBasis::CatmullRom:
            return form.wrap == CurveWrap::Pinned ? 2 : isClosed(form) ? 3 : 4;
        case CurveBasis::Nurbs:
            return std::max(2u, form.order);
    }
    return 2;
}

Status checkForm(const CurveForm& form, std::uint32_t controls) {
    if (form.basis == CurveBasis::Nurbs && (form.order < 2 || form.order > kMaxOrder))
        return fail(fmt::format("a curve has order {}", form.order),
                    fmt::format("expected 2 to {}", kMaxOrder));
    if (controls < fewestControls(form))
        return fail(fmt::format("a curve has {} control points", controls),
                    fmt::format("expected at least {}", fewestControls(form)));
    if (form.basis == CurveBasis::Bezier && (isClosed(form) ? controls % 3 : (controls - 1) % 3) != 0)
        return fail(fmt::format("a Bézier curve has {} control points", controls),
                    isClosed(form) ? "expected a multiple of 3" : "expected 4, 7, 10 …");
    if (form.basis == CurveBasis::Nurbs && !form.knots.empty() && form.knots.size() != controls + form.order)
        return fail(fmt::format("a curve has {} knots", form.knots.size()),
                    fmt::format("expected {}", controls + form.order));
    return {};
}

}  // namespace

Result<std::vector<CurvePoint>> evaluateCurve(const CurveForm& form, std::uint32_t controls) {
    if (auto status = checkForm(form, controls); !status) return tl::unexpected(status.error());
    switch (form.basis) {
        case CurveBasis::Bezier:
            return alongBezier(form, controls);
        case CurveBasis::BSpline:
            return alongBSpline(form, controls);
        case CurveBasis::Nurbs:
            return alongNurbs(form, controls);
        default:
            return throughControls(form, controls);
    }
}

std::uint32_t knotCount(const CurveForm& form, std::uint32_t controls) {
    const std::uint32_t closes = isClosed(form) ? 0 : 1;
    switch (form.basis) {
        case CurveBasis::Bezier:
            return (isClosed(form) ? controls / 3 : (std::max(controls, 1u) - 1) / 3) + closes;
        case CurveBasis::BSpline:
        case CurveBasis::CatmullRom:
            return form.wrap == CurveWrap::Open ? std::max(controls, 3u) - 3 + closes : controls;
        default:
            return controls;
    }
}

}  // namespace hairloom
