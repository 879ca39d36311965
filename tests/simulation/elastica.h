// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The heavy elastica: an inextensible rod, straight when unloaded, held horizontally at one end and bent by
// its own weight. Solved as a boundary-value problem, by shooting; shares nothing with the strand engine.

#include <cmath>
#include <type_traits>

namespace hairloom::test {

/// Rod along +x at rest, gravity along −y, held at the origin.
struct ElasticaShape {
    double reach;           ///< x of the tip, m
    double drop;            ///< −y of the tip, m
    double curvatureAtEnd;  ///< φ'(L), 1/m: 0 but for the error of the shooting
};

/// B at s metres from the held end, in m⁴/s²: a number or a function of s.
template <class Stiffness>
double stiffnessAt(const Stiffness& B, double s) {
    if constexpr (std::is_arithmetic_v<Stiffness>) {
        return B;
    } else {
        return B(s);
    }
}

/// With the inner force n and moment m = B φ' per mass and length, and φ the angle of the tangent
/// (cos φ, −sin φ) below the horizon: n' = −g and n(L) = 0 give a weight of g (L − s) beyond s, and m' = −t ×
/// n
///   (B φ')' = −g (L − s) cos φ,   φ(0) = 0,   φ'(L) = 0
/// (Bickley 1934). Integrates it from s = 0 with the moment m(0), by RK4. g in m/s², L in m.
template <class Stiffness>
ElasticaShape shootElastica(const Stiffness& B, double g, double L, double moment) {
    struct State {
        double angle, moment, x, y;
    };
    const auto rate = [&](const State& a, double s) {
        return State{a.moment / stiffnessAt(B, s), -g * (L - s) * std::cos(a.angle), std::cos(a.angle),
                     std::sin(a.angle)};
    };
    const auto moved = [](const State& a, const State& r, double h) {
        return State{a.angle + h * r.angle, a.moment + h * r.moment, a.x + h * r.x, a.y + h * r.y};
    };
    constexpr int kSteps = 500;
    const double h = L / kSteps;
    State a{0.0, moment, 0.0, 0.0};
    for (int i = 0; i < kSteps; ++i) {
        const double s = i * h;
        const State k1 = rate(a, s), k2 = rate(moved(a, k1, 0.5 * h), s + 0.5 * h);
        const State k3 = rate(moved(a, k2, 0.5 * h), s + 0.5 * h), k4 = rate(moved(a, k3, h), s + h);
        a = moved(moved(moved(moved(a, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
    }
    return {a.x, a.y, a.moment / stiffnessAt(B, L)};
}

/// Bisects m(0) between 0, where φ'(L) < 0, and g L²/2, where φ'(L) ≥ 0 because cos φ ≤ 1.
template <class Stiffness>
ElasticaShape solveElastica(const Stiffness& B, double g, double L) {
    double low = 0.0, high = 0.5 * g * L * L;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (shootElastica(B, g, L, middle).curvatureAtEnd < 0.0 ? low : high) = middle;
    }
    return shootElastica(B, g, L, 0.5 * (low + high));
}

/// B at which the tip drops by that share of the length, 0 < share < 0.9; softer rods drop more.
inline double elasticaStiffness(double share, double g, double L) {
    double soft = g * L * L * L / 200.0, stiff = g * L * L * L * 10.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(soft * stiff);
        (solveElastica(middle, g, L).drop > share * L ? soft : stiff) = middle;
    }
    return std::sqrt(soft * stiff);
}

}  // namespace hairloom::test
