// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/alternatives/lattice.h"

#include <limits>

#include "tests/runtime/allocations.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

Lattice makeLattice(const Strands& strands, const LatticeSettings& settings = {}, Host host = {}) {
    Lattice::Result made = Lattice::make(strands.view(), settings, std::move(host));
    EXPECT_EQ(made.error, "");
    return std::move(*made.lattice);
}

std::vector<Float3> hairOf(const Lattice& lattice) {
    std::vector<Float3> positions(lattice.pointCount());
    lattice.evaluate(positions);
    return positions;
}

/// Strands that hang from a small cap; `copies` of each, so that the lattice is the same for any number.
Strands cap(std::uint32_t copies = 1) {
    Strands strands;
    for (std::uint32_t s = 0; s < 24; ++s) {
        const float angle = 0.2618f * static_cast<float>(s);
        for (std::uint32_t c = 0; c < copies; ++c) {
            strands.add({0.08f * std::cos(angle), 0.1f, 0.08f * std::sin(angle)},
                        {0.3f * std::cos(angle), -0.9f, 0.3f * std::sin(angle)}, 0.02f, 12);
        }
    }
    return strands;
}

const Quat kTurn = turnAbout({0.36f, 0.48f, 0.8f}, 0.9f);

float farthestFromRigid(const Lattice& lattice, const Strands& strands, const RootFrame& head) {
    float maximum = 0.0f;
    const std::vector<Float3> now = hairOf(lattice);
    for (std::size_t i = 0; i < now.size(); ++i) {
        const float away = length(now[i] - head.position - rotate(head.rotation, strands.points[i]));
        if (!(away <= maximum)) maximum = away;
    }
    return maximum;
}

TEST(Lattice, RigidPosesAreRigidToRounding) {
    const Strands strands = cap();
    Lattice lattice = makeLattice(strands);
    const RootFrame head{{0.3f, 1.6f, -0.4f}, kTurn};
    lattice.reset(head);
    EXPECT_LT(farthestFromRigid(lattice, strands, head), 2e-7f);
    // A cut carries it along, deformed or not.
    const RootFrame far{{40.0f, 1.6f, -0.4f}, kTurn};
    LatticeSettings still;
    still.gravity = {};
    still.airDrag = 0.0f;
    Lattice carried = makeLattice(strands, still);
    carried.step(far, 1.0f / 60.0f);
    EXPECT_LT(farthestFromRigid(carried, strands, far), 8e-6f);
}

TEST(Lattice, SteadyHeadMotionExertsNoForce) {
    const Strands strands = cap();
    LatticeSettings s;
    s.airDrag = 0.0f;
    Lattice lattice = makeLattice(strands, s);
    RootFrame head;
    float maximum = 0.0f;
    for (int f = 1; f <= 240; ++f) {
        head.position.x = 0.02f * static_cast<float>(f);
        lattice.step(head, 1.0f / 60.0f);
        if (f < 30) maximum = std::max(maximum, farthestFromRigid(lattice, strands, head));
    }
    EXPECT_GT(maximum, 0.005f) << "setting off is felt";
    EXPECT_LT(farthestFromRigid(lattice, strands, head), 1e-5f);
}

TEST(Lattice, AffineDeformationsComeThrough) {
    const Strands strands = cap();
    for (const std::uint32_t nodes : {3u, 4u, 7u}) {
        LatticeSettings s;
        s.nodes = nodes;
        Lattice lattice = makeLattice(strands, s);
        const auto affine = [](Float3 p) {
            return Float3{1.3f * p.x + 0.4f * p.y + 0.2f, 0.1f * p.x + 0.7f * p.y - 0.3f * p.z - 1.0f,
                          -0.2f * p.y + 1.1f * p.z + 0.05f};
        };
        std::vector<Float3> points(lattice.controlPointCount());
        lattice.readControlPoints(points);
        for (Float3& p : points) p = affine(p);
        lattice.setControlPoints(points);
        const std::vector<Float3> now = hairOf(lattice);
        for (std::size_t i = 0; i < now.size(); ++i) {
            EXPECT_LT(length(now[i] - affine(strands.points[i])), 1e-6f) << nodes << " " << i;
        }
    }
}

TEST(Lattice, IsTheUniformQuadraticBSpline) {
    // One strand along x of a lattice of 4: cells run from 0.5 to 2.5 over its length of 0.2 m.
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.025f, 9);
    LatticeSettings s;
    s.nodes = 4;
    Lattice lattice = makeLattice(strands, s);
    std::vector<Float3> points(lattice.controlPointCount());
    lattice.readControlPoints(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % 4 == 1) points[i].y += 1.0f;
    }
    lattice.setControlPoints(points);
    const std::vector<Float3> now = hairOf(lattice);
    // Weight of control point 1 at cells 0.5, 0.75 … 2.5.
    const float weights[] = {0.5f, 0.6875f, 0.75f, 0.6875f, 0.5f, 0.28125f, 0.125f, 0.03125f, 0.0f};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(now[i].y, weights[i], 1e-6f) << i;
}

TEST(Lattice, ComesBackToRest) {
    const Strands strands = cap();
    Lattice lattice = makeLattice(strands);
    std::vector<Float3> points(lattice.controlPointCount());
    lattice.readControlPoints(points);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = points[i] + Float3{0.05f * std::sin(static_cast<float>(i)), 0.03f, 0.0f};
    lattice.setControlPoints(points);
    EXPECT_GT(farthestFromRigid(lattice, strands, {}), 0.01f);
    for (int f = 0; f < 600; ++f) lattice.step({}, 1.0f / 60.0f);
    EXPECT_LT(farthestFromRigid(lattice, strands, {}), 1e-6f);
}

TEST(Lattice, AUniformPullDisplacesByForceOverStiffness) {
    // All attachments alike: every point moves by c·w/ω², and coupling has nothing to do.
    const Strands strands = cap();
    LatticeSettings s;
    s.rootFrequency = s.tipFrequency = 2.0f;
    s.wind = {3.0f, 0.0f, 1.0f};
    s.airDrag = 2.0f;
    Lattice lattice = makeLattice(strands, s);
    for (int f = 0; f < 600; ++f) lattice.step({}, 1.0f / 60.0f);
    const float rate = 2.0f * std::numbers::pi_v<float> * 2.0f;
    const std::vector<Float3> now = hairOf(lattice);
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Float3 expected = strands.points[i] + s.wind * (2.0f / (rate * rate));
        EXPECT_LT(length(now[i] - expected), 1e-5f) << i;
    }
}

/// Solves a dense system by elimination; rows of `a` hold the right-hand side last.
std::vector<double> solved(std::vector<std::vector<double>> a) {
    const std::size_t n = a.size();
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k) continue;
            const double factor = a[i][k] / a[k][k];
            for (std::size_t j = k; j <= n; ++j) a[i][j] -= factor * a[k][j];
        }
    }
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = a[i][n] / a[i][i];
    return x;
}

TEST(Lattice, AStepIsTheImplicitEulerStep) {
    const Strands strands = cap();
    LatticeSettings s;
    s.nodes = 4;
    s.substeps = 1;
    s.rootFrequency = s.tipFrequency = 1.0f;
    s.couplingFrequency = 6.0f;
    s.dampingTime = 0.25f;
    s.airDrag = 3.0f;
    s.wind = {0.0f, 2.0f, 0.0f};
    Lattice lattice = makeLattice(strands, s);
    const std::size_t n = 4, count = 64;
    std::vector<Float3> rest(count), now(count);
    lattice.readControlPoints(rest);
    for (std::size_t i = 0; i < count; ++i)
        now[i] = rest[i] + Float3{0.0f, 0.05f * std::sin(static_cast<float>(i * i)), 0.0f};
    lattice.setControlPoints(now);
    std::vector<double> d(count), u(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) d[i] = static_cast<double>(now[i].y - rest[i].y);

    // (1 + h/τ + h c + h² K) e = h u + h² (c w − K d), as in docs/engine.md, along y.
    const double h = 0.05, turn = 2.0 * std::numbers::pi, attached = turn * turn, coupled = attached * 36.0;
    std::vector<std::vector<double>> k(count, std::vector<double>(count, 0.0));
    const auto couple = [&](std::size_t i, std::size_t j) {
        k[i][i] += coupled, k[j][j] += coupled;
        k[i][j] -= coupled, k[j][i] -= coupled;
    };
    for (std::size_t i = 0; i < count; ++i) {
        k[i][i] += attached;
        if (i % n + 1 < n) couple(i, i + 1);
        if (i / n % n + 1 < n) couple(i, i + n);
        if (i / n / n + 1 < n) couple(i, i + n * n);
    }
    for (int step = 0; step < 3; ++step) {
        std::vector<std::vector<double>> system(count, std::vector<double>(count + 1, 0.0));
        for (std::size_t i = 0; i < count; ++i) {
            double pull = 3.0 * 2.0;
            for (std::size_t j = 0; j < count; ++j) {
                system[i][j] = h * h * k[i][j] + (i == j ? 1.0 + h * (4.0 + 3.0) : 0.0);
                pull -= k[i][j] * d[j];
            }
            system[i][count] = h * u[i] + h * h * pull;
        }
        const std::vector<double> change = solved(system);
        for (std::size_t i = 0; i < count; ++i) {
            d[i] += change[i];
            u[i] = change[i] / h;
        }
        lattice.step({}, 0.05f);
        lattice.readControlPoints(now);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_NEAR(static_cast<double>(now[i].y - rest[i].y), d[i], 2e-6) << step << " " << i;
        }
    }
}

TEST(Lattice, TipsLagBehindRootsAndSagWhenTheHeadTilts) {
    const Strands strands = cap();
    Lattice lattice = makeLattice(strands);
    const RootFrame tilted{{}, turnAbout({0.0f, 0.0f, 1.0f}, 0.8f)};
    for (int f = 0; f < 600; ++f) lattice.step(tilted, 1.0f / 60.0f);
    const std::vector<Float3> now = hairOf(lattice);
    float roots = 0.0f, tips = 0.0f;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        const std::uint32_t root = strands.offsets[s], tip = strands.offsets[s + 1] - 1;
        roots += length(now[root] - rotate(tilted.rotation, strands.points[root]));
        tips += length(now[tip] - rotate(tilted.rotation, strands.points[tip]));
    }
    EXPECT_GT(tips, 0.02f * 24.0f);
    EXPECT_LT(roots, 0.3f * tips);
}

/// Energy of the springs, in double precision, of a lattice whose control points are all attached alike.
double springEnergy(const std::vector<Float3>& rest, const std::vector<Float3>& now, std::size_t n,
                    double attachment, double coupling) {
    const auto apart = [&](std::size_t i, std::size_t k) {
        const Float3 d = (now[i] - rest[i]) - (now[k] - rest[k]);
        return static_cast<double>(dot(d, d));
    };
    double sum = 0.0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const Float3 d = now[i] - rest[i];
        sum += 0.5 * attachment * static_cast<double>(dot(d, d));
        if (i % n + 1 < n) sum += 0.5 * coupling * apart(i, i + 1);
        if (i / n % n + 1 < n) sum += 0.5 * coupling * apart(i, i + n);
        if (i / n / n + 1 < n) sum += 0.5 * coupling * apart(i, i + n * n);
    }
    return sum;
}

TEST(Lattice, NoFrameTimeOrStiffnessMakesEnergy) {
    const Strands strands = cap();
    for (const float frequency : {0.1f, 3.0f, 1000.0f}) {
        LatticeSettings s;
        s.rootFrequency = s.tipFrequency = frequency;
        s.couplingFrequency = 1000.0f;
        s.dampingTime = 0.0f;
        s.airDrag = 0.0f;
        Lattice lattice = makeLattice(strands, s);
        std::vector<Float3> rest(lattice.controlPointCount()), now = rest;
        lattice.readControlPoints(rest);
        for (std::size_t i = 0; i < now.size(); ++i)
            now[i] = rest[i] + Float3{0.0f, 0.1f * std::sin(static_cast<float>(i * i)), 0.02f};
        lattice.setControlPoints(now);
        const auto energy = [&] {
            const double turn = 2.0 * std::numbers::pi, f = static_cast<double>(frequency);
            return springEnergy(rest, now, s.nodes, turn * turn * f * f, turn * turn * 1e6);
        };
        const double start = energy();
        const float times[] = {1.0f, 0.001f, 1.0f, 1.0f, 1e-7f, 100.0f, 1.0f / 60.0f};
        for (int f = 0; f < 70; ++f) {
            lattice.step({}, times[f % 7]);
            lattice.readControlPoints(now);
            ASSERT_LE(energy(), start * 1.0001) << frequency << " " << f;
        }
        EXPECT_LT(energy(), 1e-3 * start) << frequency;
    }
}

TEST(Lattice, AHeadThatShakesInLongFramesKeepsItsHairNear) {
    const Strands strands = cap();
    Lattice lattice = makeLattice(strands);
    for (int f = 1; f <= 60; ++f) {
        const RootFrame head{{0.5f * std::sin(static_cast<float>(f)), 0.0f, 0.0f},
                             turnAbout({0.0f, 1.0f, 0.0f}, 2.0f * static_cast<float>(f))};
        lattice.step(head, 1.0f);
        ASSERT_LT(farthestFromRigid(lattice, strands, head), 0.5f) << f;
    }
}

TEST(Lattice, AStepCostsTheSameForAnyNumberOfStrands) {
    const Strands few = cap(1), many = cap(200);
    Lattice small = makeLattice(few), large = makeLattice(many);
    const RootFrame head{{0.05f, 0.0f, 0.0f}, kTurn};
    for (int f = 0; f < 5; ++f) {
        small.step(head, 1.0f / 60.0f);
        large.step(head, 1.0f / 60.0f);
        EXPECT_GT(small.lastStep().nodeUpdates, 0u);
        EXPECT_EQ(small.lastStep().nodeUpdates, large.lastStep().nodeUpdates);
    }
    EXPECT_EQ(small.stepBytes(), large.stepBytes());
    EXPECT_EQ(large.pointCount(), 200 * small.pointCount());
    // And it is bounded, whatever the hair: substeps · control points · iterations.
    LatticeSettings s;
    s.nodes = 5;
    Lattice other = makeLattice(tuft(300, true), s);
    other.step(head, 1.0f);
    EXPECT_LE(other.lastStep().nodeUpdates, 2u * 125u * 24u);
}

TEST(Lattice, SameBitsForAnyNumberOfThreads) {
    const Strands strands = cap(60);
    std::vector<std::vector<Float3>> results;
    for (const Host& host : {Host{}, hostWithThreads(1), hostWithThreads(5), hostWithThreads(3, true)}) {
        Lattice lattice = makeLattice(strands, {}, host);
        for (int f = 1; f <= 10; ++f)
            lattice.step({{0.01f * static_cast<float>(f), 0.0f, 0.0f}, kTurn}, 1.0f / 60.0f);
        results.push_back(hairOf(lattice));
    }
    for (const auto& result : results) EXPECT_TRUE(result == results[0]);
}

TEST(Lattice, NothingIsAllocatedByStepAndEvaluate) {
    const Strands strands = cap();
    Lattice lattice = makeLattice(strands);
    std::vector<Float3> positions(lattice.pointCount());
    const std::size_t before = allocationCount();
    for (int f = 0; f < 5; ++f) {
        lattice.step({{0.01f * static_cast<float>(f), 0.0f, 0.0f}, kTurn}, 1.0f / 60.0f);
        lattice.evaluate(positions);
    }
    EXPECT_EQ(allocationCount(), before);
}

TEST(Lattice, NonFiniteInputIsRejected) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = 3e38f;
    const Strands strands = cap();
    Lattice lattice = makeLattice(strands);
    const RootFrame heads[] = {
        {{nan, 0, 0}, {}}, {{huge, 0, 0}, {}}, {{}, {0, 0, 0, 0}}, {{}, {nan, 0, 0, 1}}};
    for (const RootFrame& head : heads) {
        lattice.step(head, 1.0f / 60.0f);
        EXPECT_LT(farthestFromRigid(lattice, strands, {}), 1e-6f);
        lattice.reset(head);
        EXPECT_LT(farthestFromRigid(lattice, strands, {}), 1e-6f);
    }
    std::vector<Float3> points(lattice.controlPointCount(), Float3{nan, huge, 0.0f});
    lattice.setControlPoints(points);
    EXPECT_LT(farthestFromRigid(lattice, strands, {}), 1e-6f);
    const RootFrame away{{1.0f, 0.0f, 0.0f}, {}};
    for (const float dt : {0.0f, -1.0f, nan, std::numeric_limits<float>::infinity()}) {
        lattice.step(away, dt);
        EXPECT_LT(farthestFromRigid(lattice, strands, {}), 1e-6f);
    }
    for (const float dt : {1e-40f, huge, 1e-40f, 1.0f / 60.0f}) {
        lattice.step(away, dt);
        EXPECT_LT(farthestFromRigid(lattice, strands, away), 10.0f) << dt;
    }
}

TEST(Lattice, RefusesInvalidSettings) {
    LatticeSettings s;
    s.nodes = 2;
    s.wind.y = 300.0f;
    EXPECT_EQ(Lattice::make(cap().view(), s).error,
              "nodes is 2; expected 3 to 16\nwind is 300; expected -200 to 200");
    EXPECT_EQ(Lattice::make(Strands{}.view(), {}).error, "no strands; expected one at least");
    Strands torn = cap();
    torn.points.pop_back();
    EXPECT_NE(Lattice::make(torn.view(), {}).error, "");
    // Flat hair has a lattice all the same.
    Strands flat;
    flat.add({}, {0.0f, -1.0f, 0.0f}, 0.02f, 8);
    Lattice lattice = makeLattice(flat);
    EXPECT_LT(farthestFromRigid(lattice, flat, {}), 1e-7f);
}

TEST(LatticeCollision, HairStaysOutOfSpheresAndPushesItsCells) {
    const Strands strands = cap();
    LatticeSettings s;
    s.collisionRadiusTip = 0.002f;
    s.substeps = 4;
    // A sphere comes from the side into the hair, which hangs below a cap of 8 cm.
    const auto deepest = [&](const std::vector<Float3>& hair, const Sphere& sphere) {
        double depth = -1e9;
        for (std::size_t p = 0; p < hair.size(); ++p) {
            const std::size_t along = p % 12;
            if (along == 0) continue;  // roots stay
            const double wanted =
                static_cast<double>(sphere.radius) + 0.002 * static_cast<double>(along) / 11.0;
            const Float3 d = hair[p] - sphere.center_ws;
            depth = std::max(depth, wanted - std::hypot(static_cast<double>(d.x), static_cast<double>(d.y),
                                                        static_cast<double>(d.z)));
        }
        return depth;
    };
    Lattice met = makeLattice(strands, s), unmet = makeLattice(strands, s);
    double worst = -1e9, through = -1e9;
    for (int f = 0; f < 60; ++f) {
        const Sphere sphere{{0.3f - 0.004f * static_cast<float>(f), -0.02f, 0.0f}, 0.06f};
        met.step({}, 1.0f / 60.0f, std::span(&sphere, 1));
        unmet.step({}, 1.0f / 60.0f);
        worst = std::max(worst, deepest(hairOf(met), sphere));
        through = std::max(through, deepest(hairOf(unmet), sphere));
    }
    EXPECT_LT(worst, 1e-5);
    EXPECT_GT(through, 0.02);
    // The control points were moved, not the shown hair alone.
    std::vector<Float3> nodes(met.controlPointCount()), others(nodes.size());
    met.readControlPoints(nodes);
    unmet.readControlPoints(others);
    float farthest = 0.0f;
    for (std::size_t n = 0; n < nodes.size(); ++n)
        farthest = std::max(farthest, length(nodes[n] - others[n]));
    EXPECT_GT(farthest, 0.01f);
}

TEST(LatticeCollision, IsTheSameForAnyNumberOfThreads) {
    const Strands strands = cap(40);
    std::vector<std::vector<Float3>> results;
    for (const bool parallel : {false, true}) {
        Lattice lattice = makeLattice(strands, {}, parallel ? hostWithThreads(3) : Host{});
        for (int f = 0; f < 20; ++f) {
            const Sphere spheres[] = {{{0.12f, 0.0f, 0.0f}, 0.06f},
                                      {{0.05f, -0.05f, 0.08f}, 0.05f},
                                      {{std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}, 0.05f}};
            lattice.step({}, 1.0f / 60.0f, spheres);
        }
        results.push_back(hairOf(lattice));
    }
    EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace hairloom::runtime
