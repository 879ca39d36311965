// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A straight rod that falls on a circle, in closed equations: what rods of the engine are held against where
// they touch. It shares no code with them.

#include <array>
#include <vector>

namespace hairloom {

/// A straight, level, clamped rod in a plane, in the angles of its segments: M θ'' = f with the whole mass
/// matrix, by short steps. A circle stops its points by impulses, without bounce or friction. Its density,
/// stiffness and damping are those of a hair of the default settings with an angular stiffness of 0.5.
class FallingChain {
  public:
    static constexpr int kFree = 22;            ///< points that move
    static constexpr double kSegment = 0.0125;  ///< metres
    /// Of the circle, metres: the root lies in the origin, the rod along x.
    static constexpr double kX = 0.12, kY = -0.07, kRadius = 0.05;

    void run(double seconds, int steps);
    double x(int p) const { return x_[p]; }  ///< of free point p, from 1 on; metres
    double y(int p) const { return y_[p]; }

  private:
    using Row = std::array<double, kFree>;
    struct Contact {
        Row way{}, answer{};
        double weight = 0.0, gap = 0.0, pressed = 0.0;
    };

    void place();
    Row solve(Row b) const;
    void factor();
    Row forces() const;
    std::vector<Contact> contacts(double h) const;
    void press(std::vector<Contact> contacts);
    void step(double h);

    Row angle_{}, rate_{};
    std::array<Row, kFree> lower_{};
    std::array<double, kFree + 1> x_{}, y_{};
};

}  // namespace hairloom
