// SPDX-License-Identifier: GPL-3.0-or-later
// Rods on spheres against closed equations: a chain in its angles that falls on a circle, a pendulum that
// lies on a plane, and what restitution may do.
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

constexpr double kGravity = 9.81;
constexpr float kStep = 1.0f / 60.0f;

/// A straight, level, clamped rod in a plane, in the angles of its segments: M θ'' = f with the whole mass
/// matrix, by short steps. Circles stop its points by impulses, without bounce or friction.
class Chain {
  public:
    static constexpr int kFree = 22;
    static constexpr double kSegment = 0.0125;

    void run(double seconds, int steps) {
        for (int i = 0; i < steps; ++i) step(seconds / steps);
        place();
    }
    double x(int p) const { return x_[p]; }  ///< of free point p, from 1 on
    double y(int p) const { return y_[p]; }

  private:
    static constexpr double kX = 0.12, kY = -0.07, kRadius = 0.05;
    using Row = std::array<double, kFree>;

    static double mass(int p) { return p == kFree ? 0.5 * kSegment : kSegment; }
    void place() {
        x_[0] = kSegment;
        y_[0] = 0.0;
        for (int j = 0; j < kFree; ++j) {
            x_[j + 1] = x_[j] + kSegment * std::cos(angle_[j]);
            y_[j + 1] = y_[j] + kSegment * std::sin(angle_[j]);
        }
    }
    Row solve(Row b) const {
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
    void factor() {
        for (int c = 0; c < kFree; ++c) {
            for (int r = c; r < kFree; ++r) {
                double value = 0.0;
                for (int p = r + 1; p <= kFree; ++p) value += mass(p);
                value *= kSegment * kSegment * std::cos(angle_[r] - angle_[c]);
                for (int k = 0; k < c; ++k) value -= lower_[r][k] * lower_[c][k];
                lower_[r][c] = r == c ? std::sqrt(value) : value / lower_[c][c];
            }
        }
    }
    Row forces() const {
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
                for (int p = std::max(j, k) + 1; p <= kFree; ++p) beyond += mass(p);
                f[j] -= kSegment * kSegment * std::sin(angle_[j] - angle_[k]) * rate_[k] * rate_[k] * beyond;
            }
            for (int p = j + 1; p <= kFree; ++p)
                f[j] -= mass(p) * (tx * vx[p] / kDamping + ty * (kGravity + vy[p] / kDamping));
            const double before = j > 0 ? angle_[j - 1] : 0.0, rateBefore = j > 0 ? rate_[j - 1] : 0.0;
            const double turn = angle_[j] - before, half = std::cos(0.5 * turn);
            const double share = 0.5 * (1.0 - 0.5 * (j + 1) / 23.0);
            const double stiffness =
                kHairBendingStiffness * share / (1.0 - share) / (j > 0 ? kSegment : 1.5 * kSegment);
            const double moment =
                stiffness * (std::sin(turn) + kBendDamping * half * half * (rate_[j] - rateBefore));
            f[j] -= moment;
            if (j > 0) f[j - 1] += moment;
        }
        return f;
    }
    void step(double h) {
        place();
        factor();
        const Row change = solve(forces());
        for (int j = 0; j < kFree; ++j) rate_[j] += h * change[j];
        struct Contact {
            Row way, answer;
            double weight = 0.0, gap = 0.0, pressed = 0.0;
        };
        std::vector<Contact> contacts;
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
            contacts.push_back(c);
        }
        for (int sweep = 0; sweep < 200; ++sweep) {
            double most = 0.0;
            for (Contact& c : contacts) {
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
        for (int j = 0; j < kFree; ++j) angle_[j] += h * rate_[j];
    }

    Row angle_{}, rate_{};
    std::array<Row, kFree> lower_{};
    std::array<double, kFree + 1> x_{}, y_{};
};

Strands levelStrand(std::uint32_t points, float segment) {
    Strands strands;
    for (std::uint32_t p = 0; p < points; ++p)
        strands.points.push_back({segment * static_cast<float>(p), 0.0f, 0.0f});
    strands.offsets = {0, points};
    return strands;
}

SimulationSettings falling() {
    SimulationSettings s;
    s.restGravity = s.airDrag = s.friction = s.collisionRadiusTip = s.sleepSpeed = 0.0f;
    return s;
}

const std::vector<Sphere> kBall{{{0.12f, -0.07f, 0.0f}, 0.05f}};

TEST(RodContact, AStrandThatFallsOnASphereFollowsTheChain) {
    std::vector<Chain> frames(1);
    for (int f = 0; f < 48; ++f) {
        Chain next = frames.back();
        next.run(1.0 / 60.0, 400);
        frames.push_back(next);
    }
    const auto distance = [&](std::uint32_t substeps) {
        const Strands strands = levelStrand(24, 0.0125f);
        SimulationSettings s = falling();
        s.angularStiffness = 0.5f;
        s.substeps = substeps;
        Engine engine = makeEngine(strands, s);
        const auto roots = strands.roots();
        double sum = 0.0;
        for (int f = 1; f <= 48; ++f) {
            engine.step({kStep, f / 60.0, roots, kBall});
            const std::vector<Float3> x = positionsOf(engine);
            for (int p = 1; p <= Chain::kFree; ++p) {
                const double dx = static_cast<double>(x[p + 1].x) - frames[f].x(p);
                const double dy = static_cast<double>(x[p + 1].y) - frames[f].y(p);
                sum += dx * dx + dy * dy;
            }
        }
        return 1000.0 * std::sqrt(sum / (48.0 * 22.0));
    };
    const double two = distance(2), eight = distance(8), thirtyTwo = distance(32);
    EXPECT_LT(two, 3.0);
    EXPECT_LT(eight, 1.0);
    EXPECT_LT(thirtyTwo, eight / 3.0);
}

/// Metres that a point on a rod of one metre slides in a second on a plane that is `over` times as steep as
/// friction holds, and what is due.
struct Slide {
    double slid, due;
};
Slide slide(double over, std::uint32_t substeps) {
    const double angle = std::atan(0.3 * over);
    SimulationSettings s = falling();
    s.dampingTime = s.bendDampingTime = 0.0f;
    s.clampedPoints = 1;
    s.angularStiffness = 1e-6f;
    s.friction = 0.3f;
    s.substeps = substeps;
    s.gravity = {0.0f, static_cast<float>(-kGravity * std::cos(angle)),
                 static_cast<float>(kGravity * std::sin(angle))};
    const Strands strands = levelStrand(2, 1.0f);
    Engine engine = makeEngine(strands, s);
    const auto roots = strands.roots();
    const std::vector<Sphere> plane{{{0.0f, -std::sqrt(1000.0f * 1000.0f - 1.0f), 0.0f}, 1000.0f}};
    double turn = 0.0, rate = 0.0;
    for (int f = 1; f <= 60; ++f) {
        engine.step({kStep, f / 60.0, roots, plane});
        for (int i = 0; i < 1000; ++i) {
            const double pull = kGravity * (std::sin(angle) * std::cos(turn) - 0.3 * std::cos(angle));
            rate = std::max(0.0, rate + pull / 60000.0);
            turn += rate / 60000.0;
        }
    }
    return {static_cast<double>(positionsOf(engine)[1].z), std::sin(turn)};
}

TEST(RodContact, FrictionHoldsBelowItsAngleAndLetsSlideAbove) {
    EXPECT_LT(slide(0.95, 2).slid, 0.003);
    EXPECT_LT(slide(0.95, 32).slid, 0.0002);
    for (const double over : {1.1, 1.5}) {
        const Slide coarse = slide(over, 2), fine = slide(over, 16);
        EXPECT_NEAR(coarse.slid, coarse.due, 0.1 * coarse.due) << over;
        EXPECT_NEAR(fine.slid, fine.due, 0.03 * fine.due) << over;
    }
}

TEST(RodContact, ABounceComesToRestAndAddsNoEnergy) {
    for (const float restitution : {0.2f, 0.5f, 1.0f}) {
        const Strands strands = levelStrand(24, 0.0125f);
        SimulationSettings s = falling();
        s.restitution = restitution;
        Engine damped = makeEngine(strands, s);
        s.dampingTime = s.bendDampingTime = 0.0f;
        Engine free = makeEngine(strands, s);
        const auto roots = strands.roots();
        const Measurements still = free.measure();
        double highest = still.potentialEnergy;
        for (int f = 1; f <= 900; ++f) {
            damped.step({kStep, f / 60.0, roots, kBall});
            free.step({kStep, f / 60.0, roots, kBall});
            const Measurements m = free.measure();
            highest = std::max(highest, m.kineticEnergy + m.potentialEnergy);
        }
        // What bounces back whole loses nothing to the sphere, and takes longer.
        EXPECT_LT(damped.measure().fastest, restitution < 1 ? 0.005 : 0.02) << restitution;
        EXPECT_LT(highest, still.potentialEnergy + 1e-4) << restitution;
    }
}

TEST(RodContact, GravityThatChangesIsNoEnergyFromNothing) {
    const Strands strands = levelStrand(16, 0.012f);
    SimulationSettings s = falling();
    s.dampingTime = 0.0f;
    Engine engine = makeEngine(strands, s);
    const auto roots = strands.roots();
    std::uint32_t guarded = 0;
    for (int f = 1; f <= 240; ++f) {
        s.gravity.y = static_cast<float>(-kGravity * (1.0 + 0.1 * std::sin(0.7 * f)));
        ASSERT_EQ(engine.setSettings(s), "");
        engine.step({kStep, f / 60.0, roots, {}});
        guarded += engine.lastStep().guardedStrands;
    }
    EXPECT_EQ(guarded, 0u);
}

}  // namespace
}  // namespace hairloom::runtime
