// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/falling_chain.h"

#include <algorithm>
#include <cmath>

#include "hairloom/settings.h"

namespace hairloom {
namespace {

constexpr double kFallGravity = 9.81;  // m/s²

/// Metres of hair at a point.
double massOfPoint(int p) {
    return p == FallingChain::kFree ? 0.5 * FallingChain::kSegment : FallingChain::kSegment;
}

}  // namespace

void FallingChain::run(double seconds, int steps) {
    for (int i = 0; i < steps; ++i) step(seconds / steps);
    place();
}

void FallingChain::place() {
    x_[0] = kSegment;
    y_[0] = 0.0;
    for (int j = 0; j < kFree; ++j) {
        x_[j + 1] = x_[j] + kSegment * std::cos(angle_[j]);
        y_[j + 1] = y_[j] + kSegment * std::sin(angle_[j]);
    }
}

FallingChain::Row FallingChain::solve(Row b) const {
    for (int r = 0; r < kFree; ++r) {
        for (int k = 0; k < r; ++k) b[r] -= lower_[r][k] * b[k];
        b[r] /= lower_[r][r];
    }
    for (int r = kFree; r-- > 0;) {
        for (int k = r + 1; k < kFree; ++k) b[r] -= lower_[k][r] * b[k];
        b[r] /= lower_[r][r];
    }
    return b;
}

void FallingChain::factor() {
    for (int c = 0; c < kFree; ++c) {
        for (int r = c; r < kFree; ++r) {
            double value = 0.0;
            for (int p = r + 1; p <= kFree; ++p) value += massOfPoint(p);
            value *= kSegment * kSegment * std::cos(angle_[r] - angle_[c]);
            for (int k = 0; k < c; ++k) value -= lower_[r][k] * lower_[c][k];
            lower_[r][c] = r == c ? std::sqrt(value) : value / lower_[c][c];
        }
    }
}

FallingChain::Row FallingChain::forces() const {
    constexpr double kDamping = 0.5, kBendDamping = 0.03;  // seconds
    std::array<double, kFree + 1> vx{}, vy{};
    for (int j = 0; j < kFree; ++j) {
        vx[j + 1] = vx[j] - kSegment * std::sin(angle_[j]) * rate_[j];
        vy[j + 1] = vy[j] + kSegment * std::cos(angle_[j]) * rate_[j];
    }
    Row f{};
    for (int j = 0; j < kFree; ++j) {
        const double tx = -kSegment * std::sin(angle_[j]), ty = kSegment * std::cos(angle_[j]);
        for (int k = 0; k < kFree; ++k) {
            double beyond = 0.0;
            for (int p = std::max(j, k) + 1; p <= kFree; ++p) beyond += massOfPoint(p);
            f[j] -= kSegment * kSegment * std::sin(angle_[j] - angle_[k]) * rate_[k] * rate_[k] * beyond;
        }
        for (int p = j + 1; p <= kFree; ++p)
            f[j] -= massOfPoint(p) * (tx * vx[p] / kDamping + ty * (kFallGravity + vy[p] / kDamping));
        const double before = j > 0 ? angle_[j - 1] : 0.0, rateBefore = j > 0 ? rate_[j - 1] : 0.0;
        const double turn = angle_[j] - before, half = std::cos(0.5 * turn);
        const double share = 0.5 * (1.0 - 0.5 * (j + 1) / 23.0);
        const double stiffness =
            runtime::kHairBendingStiffness * share / (1.0 - share) / (j > 0 ? kSegment : 1.5 * kSegment);
        const double moment =
            stiffness * (std::sin(turn) + kBendDamping * half * half * (rate_[j] - rateBefore));
        f[j] -= moment;
        if (j > 0) f[j - 1] += moment;
    }
    return f;
}

std::vector<FallingChain::Contact> FallingChain::contacts(double h) const {
    std::vector<Contact> found;
    for (int p = 1; p <= kFree; ++p) {
        const double dx = x_[p] - kX, dy = y_[p] - kY, distance = std::hypot(dx, dy);
        if (distance > kRadius + 1e-3) continue;
        Contact c{};
        for (int j = 0; j < p; ++j)
            c.way[j] = kSegment * (std::cos(angle_[j]) * dy - std::sin(angle_[j]) * dx) / distance;
        c.answer = solve(c.way);
        for (int j = 0; j < kFree; ++j) c.weight += c.way[j] * c.answer[j];
        c.gap = (distance - kRadius) / h;
        if (c.gap < 0.0) c.gap *= 0.1;
        found.push_back(c);
    }
    return found;
}

void FallingChain::press(std::vector<Contact> found) {
    for (int sweep = 0; sweep < 200; ++sweep) {
        double most = 0.0;
        for (Contact& c : found) {
            double speed = c.gap;
            for (int j = 0; j < kFree; ++j) speed += c.way[j] * rate_[j];
            const double pressed = std::max(0.0, c.pressed - speed / c.weight);
            const double more = pressed - c.pressed;
            for (int j = 0; j < kFree; ++j) rate_[j] += more * c.answer[j];
            c.pressed = pressed;
            most = std::max(most, std::abs(more) * std::sqrt(c.weight));
        }
        if (most < 1e-10) break;
    }
}

void FallingChain::step(double h) {
    place();
    factor();
    const Row change = solve(forces());
    for (int j = 0; j < kFree; ++j) rate_[j] += h * change[j];
    press(contacts(h));
    for (int j = 0; j < kFree; ++j) angle_[j] += h * rate_[j];
}

}  // namespace hairloom
