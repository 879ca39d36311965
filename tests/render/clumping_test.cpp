// SPDX-License-Identifier: GPL-3.0-or-later
// What hair lets through, against coverage of a slab that is counted exactly.
#include "core/render/clumping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/render/light_probe.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr float kLong = 0.1f, kDeep = 0.02f, kRadius = 0.0001f;  // metres

/// Fibres along z at random under a light from above: 0 at the top of the slab, `kDeep` at its bottom.
struct Slab {
    float wide;                 // metres
    std::vector<Vec2f> places;  // x and depth
    TestStrands strands;
    RenderScene scene;

    explicit Slab(std::size_t count, float width, std::size_t each = 1, float wisp = 0) : wide(width) {
        Random random(5);
        Vec2f centre = Vec2f::Zero();
        for (std::size_t i = 0; i < count; ++i) {
            if (i % each == 0) centre = {random.uniform() * wide, random.uniform() * kDeep};
            const Vec2f place = centre + wisp * Vec2f(random.uniform() - 0.5f, random.uniform() - 0.5f);
            places.push_back(place);
            strands.add({Vec3f(place.x(), -place.y(), 0), Vec3f(place.x(), -place.y(), kLong)}, kRadius);
        }
        scene.strands = {strands.view()};
        StrandShading& material = scene.strands[0].material;
        material.fibre.model = ShadingModel::marschner;
        Light light;
        light.toLight_ws = Vec3f::UnitY();
        scene.lights = {light};
        scene.environment = {};
        scene.clumping = measureClumping(scene.strands);
    }
    /// The share of the middle that no fibre above the depth covers.
    double open(float depth) const {
        std::vector<std::pair<float, float>> covered;
        for (const Vec2f& p : places) {
            if (p.y() < depth) covered.emplace_back(p.x() - kRadius, p.x() + kRadius);
        }
        std::ranges::sort(covered);
        const float begin = 0.2f * wide, end = 0.8f * wide;
        double free = 0;
        float at = begin;
        for (const auto& [from, to] : covered) {
            if (from > at) free += static_cast<double>(std::min(from, end) - std::min(at, end));
            at = std::max(at, to);
        }
        free += static_cast<double>(std::max(end - at, 0.0f));
        return free / static_cast<double>(end - begin);
    }
};

class ClumpingTest : public RenderTest {
  protected:
    /// Mean of what the shaders let through to places at a depth.
    std::vector<double> through(const Slab& slab, const std::vector<float>& depths,
                                std::uint32_t resolution) {
        constexpr std::size_t kPlaces = 2000;
        std::vector<shaders::LightCase> cases;
        for (const float depth : depths) {
            for (std::size_t i = 0; i < kPlaces; ++i) {
                const float x = slab.wide * (0.2f + 0.6f * (static_cast<float>(i) + 0.5f) / kPlaces);
                cases.push_back({{x, -depth, 0.5f * kLong, 0}, {0, 0, 1, 0}});
            }
        }
        RenderOptions options;
        options.shadowResolution = resolution;
        options.subdivisions = 1;
        const auto found = probeLight(*device, slab.scene, options, cases);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        std::vector<double> result(depths.size(), 0);
        if (!found) return result;
        for (std::size_t i = 0; i < found->size(); ++i)
            result[i / kPlaces] += static_cast<double>((*found)[i].sky.z) / kPlaces;
        return result;
    }
};

// Fibres of 0.2 mm at random, 4,000 in 10 cm, at every depth. Ten times as wide, for fewer leave their gaps
// to chance.
TEST_F(ClumpingTest, LightInASlabIsThatOfCountedFibres) {
    const Slab slab(40000, 1);
    const std::vector<float> depths{0.0005f, 0.001f, 0.002f, 0.004f, 0.006f, 0.008f};
    const std::vector<double> found = through(slab, depths, 1024);
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double exact = slab.open(depths[i]);
        EXPECT_NEAR(found[i], exact, 0.1 * exact) << depths[i] << " m";
    }
}

// However it leans towards the light, which it crosses in all directions.
TEST_F(ClumpingTest, AFibreDoesNotShadeItself) {
    for (const float degrees : {0.0f, 20.0f, 45.0f, 60.0f, 75.0f}) {
        for (const float around : {0.0f, 0.4f, 0.8f}) {
            const float lean = radians(degrees);
            const Vec3f along(std::cos(lean) * std::cos(around), std::sin(lean),
                              std::cos(lean) * std::sin(around));
            TestStrands strands;
            strands.add({Vec3f::Zero(), kLong * along}, kRadius);
            strands.add({Vec3f(0.3f, -0.2f, 0), Vec3f(0.3f, -0.2f, kLong)}, kRadius);  // widens the map
            RenderScene scene;
            scene.strands = {strands.view()};
            Light light;
            light.toLight_ws = Vec3f::UnitY();
            scene.lights = {light};
            std::vector<shaders::LightCase> cases;
            for (int i = 1; i < 40; ++i) {
                const Vec3f p = static_cast<float>(i) / 40 * kLong * along;
                cases.push_back({{p.x(), p.y(), p.z(), kRadius}, {along.x(), along.y(), along.z(), 0}});
            }
            for (const std::uint32_t resolution : {128u, 1024u}) {
                RenderOptions options;
                options.shadowResolution = resolution;
                options.subdivisions = 1;
                const auto found = probeLight(*device, scene, options, cases);
                ASSERT_TRUE(found) << found.error().message();
                double fibres = 0;
                for (const shaders::LightAnswer& answer : *found)
                    fibres += static_cast<double>(answer.onHair.w) / 39;
                EXPECT_LT(fibres, 0.02) << degrees << " degrees, " << around << " around, " << resolution;
            }
        }
    }
}

TEST(Clumping, IsOneOfFibresAtRandomAndLessOfWisps) {
    const Slab even(4000, 0.1f);
    const Clumping random = measureClumping(even.scene.strands);
    EXPECT_NEAR(random.widest(), 1, 0.1);
    const Slab wisps(4000, 0.1f, 40, 0.002f);
    const Clumping clumped = measureClumping(wisps.scene.strands);
    EXPECT_LT(clumped.widest(), 0.75 * random.widest());
    for (std::size_t i = 1; i < clumped.values.size(); ++i)
        EXPECT_GT(clumped.values[i], clumped.values[i - 1]) << i;  // narrow beams see single wisps
    EXPECT_EQ(measureClumping(wisps.scene.strands).values, clumped.values);
}

TEST(Clumping, BetweenAndBeyondItsWidths) {
    Clumping c;
    c.values = {0.8f, 0.9f, 1.1f, 1.5f};
    EXPECT_FLOAT_EQ(c.of(0.02f), 0.8f);
    EXPECT_FLOAT_EQ(c.of(0.005f / std::numbers::sqrt2_v<float>), 0.85f);
    EXPECT_FLOAT_EQ(c.of(0.00125f), 1.1f);
    EXPECT_FLOAT_EQ(c.of(1e-6f), 1.5f);
}

TEST(Clumping, HairThatShadesNothingIsLeftAtOne) {
    EXPECT_EQ(measureClumping({}).values, Clumping().values);
    TestStrands one;
    one.add({Vec3f::Zero(), Vec3f(0, 0.1f, 0)}, 0.0001f);
    const std::vector<RenderStrands> strands{one.view()};
    EXPECT_EQ(measureClumping(strands).values, Clumping().values);
    TestStrands point;
    point.add({Vec3f::Zero()}, 0.0001f);
    const std::vector<RenderStrands> points{point.view()};
    EXPECT_EQ(measureClumping(points).values, Clumping().values);
}

}  // namespace
}  // namespace hairloom::render
