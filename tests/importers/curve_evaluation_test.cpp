// SPDX-License-Identifier: GPL-3.0-or-later
// Points on curves against de Casteljau's and Cox and de Boor's recursions, which share no code with them.

#include "importers/curve_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hairloom {
namespace {

using testing::HasSubstr;

std::vector<double> randomControls(std::uint32_t count) {
    std::mt19937 random(count);
    std::uniform_real_distribution<double> values(-1, 1);
    std::vector<double> controls(count);
    for (double& control : controls) control = values(random);
    return controls;
}

double valueOf(const CurvePoint& point, const std::vector<double>& controls) {
    double value = 0;
    for (std::uint32_t k = 0; k < point.count; ++k) value += point.weight[k] * controls[point.index[k]];
    return value;
}

double casteljau(std::vector<double> points, double t) {
    for (std::size_t n = points.size(); n > 1; --n) {
        for (std::size_t i = 0; i + 1 < n; ++i) points[i] = (1 - t) * points[i] + t * points[i + 1];
    }
    return points[0];
}

/// B-spline basis function i of an order by its definition.
double cox(const std::vector<double>& knots, std::size_t i, std::uint32_t order, double u) {
    if (order == 1) return u >= knots[i] && u < knots[i + 1] ? 1 : 0;
    const auto ratio = [](double a, double b) { return b != 0 ? a / b : 0; };
    return ratio(u - knots[i], knots[i + order - 1] - knots[i]) * cox(knots, i, order - 1, u) +
           ratio(knots[i + order] - u, knots[i + order] - knots[i + 1]) * cox(knots, i + 1, order - 1, u);
}

TEST(CurveEvaluation, BezierIsDeCasteljausAlsoWhereItIsClosed) {
    const CurveForm open{CurveBasis::Bezier, CurveWrap::Open, 4, {}};
    const auto controls = randomControls(10);
    const auto points = evaluateCurve(open, 10).value();
    ASSERT_EQ(points.size(), 10u);
    for (const CurvePoint& point : points) {
        const auto span = std::min(2.0, std::floor(point.knot));
        const auto first = controls.begin() + static_cast<std::ptrdiff_t>(3 * span);
        EXPECT_NEAR(valueOf(point, controls), casteljau({first, first + 4}, point.knot - span), 1e-12);
    }
    EXPECT_EQ(valueOf(points[3], controls), controls[3]) << "a knot is met exactly";
    EXPECT_EQ(valueOf(points.back(), controls), controls.back());
    const CurveForm closed{CurveBasis::Bezier, CurveWrap::Periodic, 4, {}};
    const auto around = evaluateCurve(closed, 6).value();
    EXPECT_EQ(valueOf(around.front(), controls), valueOf(around.back(), controls));
}

TEST(CurveEvaluation, BSplinesAndNurbsAreCoxAndDeBoors) {
    for (const std::uint32_t count : {4u, 5u, 9u}) {
        const auto controls = randomControls(count);
        std::vector<double> uniform(count + 4);
        for (std::size_t i = 0; i < uniform.size(); ++i) uniform[i] = static_cast<double>(i);
        const auto spline = evaluateCurve({CurveBasis::BSpline, CurveWrap::Open, 4, {}}, count).value();
        const auto nurbs = evaluateCurve({CurveBasis::Nurbs, CurveWrap::Open, 4, uniform}, count).value();
        const auto bare = evaluateCurve({CurveBasis::Nurbs, CurveWrap::Open, 4, {}}, count).value();
        ASSERT_EQ(spline.size(), count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const double u = 3 + (count - 3.0) * i / (count - 1.0);
            double wanted = 0;
            // The last point is the limit from the left.
            for (std::uint32_t k = 0; k < count; ++k)
                wanted += controls[k] * cox(uniform, k, 4, i + 1 == count ? u - 1e-12 : u);
            EXPECT_NEAR(valueOf(spline[i], controls), wanted, 1e-9);
            EXPECT_NEAR(valueOf(nurbs[i], controls), wanted, 1e-9);
            EXPECT_NEAR(valueOf(bare[i], controls), wanted, 1e-9);
        }
    }
}

TEST(CurveEvaluation, UnevenAndRepeatedKnots) {
    const std::vector<double> knots{0, 0, 0, 0, 0.5, 0.5, 2, 2, 2, 2};
    const auto controls = randomControls(6);
    const auto points = evaluateCurve({CurveBasis::Nurbs, CurveWrap::Open, 4, knots}, 6).value();
    EXPECT_NEAR(valueOf(points.front(), controls), controls.front(), 1e-12);
    EXPECT_NEAR(valueOf(points.back(), controls), controls.back(), 1e-12);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        double wanted = 0;
        for (std::uint32_t k = 0; k < 6; ++k)
            wanted += controls[k] * cox(knots, k, 4, 2.0 * static_cast<double>(i) / 5);
        EXPECT_NEAR(valueOf(points[i], controls), wanted, 1e-9) << i;
    }
}

TEST(CurveEvaluation, CatmullRomKeepsItsControlPointsAndPinnedCurvesTheirEnds) {
    EXPECT_EQ(evaluateCurve({CurveBasis::CatmullRom, CurveWrap::Open, 4, {}}, 5).value().size(), 3u);
    const auto controls = randomControls(5);
    const auto through = evaluateCurve({CurveBasis::CatmullRom, CurveWrap::Pinned, 4, {}}, 5).value();
    ASSERT_EQ(through.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(valueOf(through[i], controls), controls[i]);
    const auto pinned = evaluateCurve({CurveBasis::BSpline, CurveWrap::Pinned, 4, {}}, 5).value();
    EXPECT_NEAR(valueOf(pinned.front(), controls), controls.front(), 1e-12);
    EXPECT_NEAR(valueOf(pinned[2], controls), (controls[1] + 4 * controls[2] + controls[3]) / 6, 1e-12);
    EXPECT_NEAR(valueOf(pinned.back(), controls), controls.back(), 1e-12);
}

TEST(CurveEvaluation, WeightsAddUpToOne) {
    for (const CurveBasis basis : {CurveBasis::Linear, CurveBasis::Bezier, CurveBasis::BSpline,
                                   CurveBasis::CatmullRom, CurveBasis::Nurbs}) {
        for (const CurveWrap wrap : {CurveWrap::Open, CurveWrap::Periodic, CurveWrap::Pinned}) {
            const CurveForm form{basis, wrap, 4, {}};
            const std::uint32_t controls = wrap == CurveWrap::Periodic ? 9 : 10;
            const auto points = evaluateCurve(form, controls).value();
            for (const CurvePoint& point : points) {
                double sum = 0;
                for (std::uint32_t k = 0; k < point.count; ++k) sum += point.weight[k];
                EXPECT_NEAR(sum, 1, 1e-12);
            }
        }
    }
}

TEST(CurveEvaluation, WhatIsNoCurveIsSaid) {
    const auto error = [](const CurveForm& form, std::uint32_t controls) {
        const auto points = evaluateCurve(form, controls);
        return points ? std::string() : points.error().message();
    };
    const std::vector<double> falling{3, 2, 1, 0, 0, 0, 0, 0};
    EXPECT_THAT(error({CurveBasis::Bezier, CurveWrap::Open, 4, {}}, 5), HasSubstr("expected 4, 7, 10"));
    EXPECT_THAT(error({CurveBasis::BSpline, CurveWrap::Open, 4, {}}, 3), HasSubstr("at least 4"));
    EXPECT_THAT(error({CurveBasis::Nurbs, CurveWrap::Open, 40, {}}, 50), HasSubstr("order 40"));
    EXPECT_THAT(error({CurveBasis::Nurbs, CurveWrap::Open, 4, falling}, 4), HasSubstr("ascend"));
    EXPECT_THAT(error({CurveBasis::Nurbs, CurveWrap::Open, 4, falling}, 5), HasSubstr("8 knots"));
}

}  // namespace
}  // namespace hairloom
