// SPDX-License-Identifier: GPL-3.0-or-later
// Light between hairs (Scattering::volume) against photons that a test of its own follows from fibre to
// fibre, against closed forms, and where there is hardly any hair.
#include <array>
#include <numbers>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/render/clumping.h"
#include "core/render/renderer.h"
#include "core/shading/marschner.h"
#include "core/software/device.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr float kRadius = 0.0002f, kWide = 0.05f, kDeep = 0.03f;  // metres
constexpr std::size_t kFibres = 4000;
constexpr std::uint32_t kRows = 30;  // of the picture, as many millimetres

shading::MarschnerParameters greyFibre(double absorption) {
    shading::MarschnerParameters fibre;
    fibre.azimuthal.absorption = Vec3d::Constant(absorption);
    fibre.azimuthal.width = 0.3;
    fibre.tilt = {0, 0, 0};
    fibre.width = {0.15, 0.1, 0.25};
    return fibre;
}

/// Fibres along z at random, x from 0 to kWide, y from -kDeep to 0, under a light from above; seen from
/// large x.
struct Block {
    std::vector<Vec2d> places;
    TestStrands strands;
    RenderScene scene;

    Block(const shading::MarschnerParameters& fibre, std::uint32_t seed) {
        Random random(seed);
        for (std::size_t i = 0; i < kFibres; ++i) {
            const Vec2f place(random.uniform() * kWide, -random.uniform() * kDeep);
            places.push_back(place.cast<double>());
            // Light is worked out for points, and ends are lit from beyond.
            const auto at = [&](float z) { return Vec3f(place.x(), place.y(), z); };
            strands.add({at(0), at(0.025f), at(0.04f), at(0.05f), at(0.06f), at(0.075f), at(0.1f)}, kRadius);
        }
        scene.strands = {strands.view()};
        StrandShading& material = scene.strands[0].material;
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
        material.fibre.model = ShadingModel::marschner;
        material.fibre.marschner = fibre;
        Light light;
        light.toLight_ws = Vec3f::UnitY();
        light.irradiance = Vec3f::Ones();
        scene.lights = {light};
        scene.environment = {};
        scene.background = Vec3f::Zero();
        scene.clumping = measureClumping(scene.strands);
        scene.camera.eye_ws = Vec3f(1, -0.5f * kDeep, 0.05f);
        scene.camera.target_ws = Vec3f(0, -0.5f * kDeep, 0.05f);
        scene.camera.orthographicHeight = kDeep;
    }
};

/// Photons among the circles that the fibres are across their axis; along it their inclination is known.
class Traced {
  public:
    Traced(const std::vector<Vec2d>& places, const shading::MarschnerParameters& fibre)
        : places_(places), widths_{fibre.width[0], fibre.width[1], fibre.width[2]} {
        const shading::Marschner model(fibre);
        const auto grid = model.azimuthal(0).grid();
        lobes_[0].assign(grid.r.begin(), grid.r.end());
        lobes_[1].assign(grid.tt[0].begin(), grid.tt[0].end());
        lobes_[2].assign(grid.trt[0].begin(), grid.trt[0].end());
        step_ = std::numbers::pi / static_cast<double>(grid.r.size() - 1);
        for (std::size_t l = 0; l < 3; ++l) {
            double sum = 0;
            for (std::size_t i = 0; i < lobes_[l].size(); ++i) {
                lobes_[l][i] *= model.scale(static_cast<shading::Lobe>(l));
                const bool end = i == 0 || i + 1 == lobes_[l].size();
                sum += (end ? 0.5 : 1) * step_ * lobes_[l][i];
                below_[l].push_back(sum);
            }
            energy_[l] = 2 * sum;  // of both sides
        }
        cells_.resize(kAcross * kDown);
        for (std::size_t i = 0; i < places.size(); ++i) cells_[cellOf(places[i])].push_back(i);
    }

    /// Radiance of light that has met two fibres at least, in bands of a millimetre from above.
    std::vector<double> seen(std::size_t photons) {
        std::vector<double> sums(kRows, 0);
        Random random(77);
        for (std::size_t i = 0; i < photons; ++i) {
            Vec2d at((static_cast<double>(i) + 0.5) / static_cast<double>(photons) * kWide, 1e-6);
            double angle = -std::numbers::pi / 2, theta = 0, weight = 1;
            auto own = places_.size();
            for (int meetings = 1; weight > 1e-3; ++meetings) {
                const std::size_t hit = next(at, angle, own);
                if (hit == places_.size()) break;
                at = places_[hit];
                own = hit;
                if (meetings > 1 && next(at, 0, own) == places_.size()) {
                    const auto row = static_cast<std::size_t>(-at.y() / kDeep * kRows);
                    sums[std::min<std::size_t>(row, kRows - 1)] += weight * towardsView(angle, theta);
                }
                const double albedo = energy_[0] + energy_[1] + energy_[2];
                double pick = static_cast<double>(random.uniform()) * albedo;
                std::size_t lobe = 0;
                while (lobe < 2 && pick >= energy_[lobe]) pick -= energy_[lobe++];
                weight *= albedo;
                angle += std::numbers::pi + turn(lobe, random);
                theta += 2 * widths_[lobe] * gauss(random);
            }
        }
        const double each = kWide / static_cast<double>(photons);
        for (double& sum : sums) sum *= each / (static_cast<double>(kDeep) / kRows);
        return sums;
    }

  private:
    static constexpr std::size_t kAcross = 100, kDown = 60;

    static std::size_t cellOf(const Vec2d& p) {
        const auto x = static_cast<std::size_t>(p.x() / kWide * kAcross),
                   y = static_cast<std::size_t>(-p.y() / kDeep * kDown);
        return std::min(x, kAcross - 1) + kAcross * std::min(y, kDown - 1);
    }
    /// The first fibre on the way, or as many as there are. In steps of half a millimetre, the reach of a
    /// cell's own and its neighbours' fibres.
    std::size_t next(const Vec2d& from, double angle, std::size_t but) const {
        const Vec2d way(std::cos(angle), std::sin(angle));
        constexpr double kStep = 0.0005;
        for (double t = 0; t < 0.07; t += kStep) {
            const Vec2d middle = from + (t + kStep / 2) * way;
            const auto cx = static_cast<int>(std::floor(middle.x() / kWide * kAcross));
            const auto cy = static_cast<int>(std::floor(-middle.y() / kDeep * kDown));
            std::size_t best = places_.size();
            double least = t + kStep;
            for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, static_cast<int>(kDown) - 1); ++y) {
                for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, static_cast<int>(kAcross) - 1); ++x) {
                    for (const std::size_t i :
                         cells_[static_cast<std::size_t>(x) + kAcross * static_cast<std::size_t>(y)]) {
                        if (i == but) continue;
                        const Vec2d to = places_[i] - from;
                        const double along = to.dot(way);
                        if (along < t || along >= least ||
                            std::abs(to.x() * way.y() - to.y() * way.x()) > kRadius)
                            continue;
                        least = along;
                        best = i;
                    }
                }
            }
            if (best != places_.size()) return best;
        }
        return places_.size();
    }
    /// φ between where light comes from and where it goes, of a lobe.
    double turn(std::size_t lobe, Random& random) const {
        const double u = 2 * static_cast<double>(random.uniform()) - 1;
        const double wanted = std::abs(u) * below_[lobe].back();
        const auto after = std::ranges::upper_bound(below_[lobe], wanted);
        const auto i = std::min<std::ptrdiff_t>(after - below_[lobe].begin(),
                                                static_cast<std::ptrdiff_t>(below_[lobe].size()) - 1);
        return (u < 0 ? -1 : 1) * static_cast<double>(i) * step_;
    }
    static double gauss(Random& random) {
        const double r = std::sqrt(-2 * std::log(1 - static_cast<double>(random.uniform())));
        return r * std::cos(2 * std::numbers::pi * static_cast<double>(random.uniform()));
    }
    /// S of the fibre by the azimuth of the view, at θ_o = 0: a Gaussian whose integral with cos² is 1.
    double towardsView(double angle, double theta) const {
        const double cosPhi = -std::cos(angle);  // light comes from the other side of its way
        const auto i =
            static_cast<std::size_t>(std::lround(std::acos(std::clamp(cosPhi, -1.0, 1.0)) / step_));
        double sum = 0;
        for (std::size_t l = 0; l < 3; ++l) {
            const double v = 4 * widths_[l] * widths_[l];
            const double whole =
                std::sqrt(2 * std::numbers::pi * v) / 2 * (1 + std::cos(2 * theta) * std::exp(-2 * v));
            sum += lobes_[l][i] * std::exp(-theta * theta / (2 * v)) / whole;
        }
        return sum;
    }

    const std::vector<Vec2d>& places_;
    std::array<double, 3> widths_;
    std::array<std::vector<double>, 3> lobes_, below_;
    std::array<double, 3> energy_{};
    double step_ = 0;
    std::vector<std::vector<std::size_t>> cells_;
};

class LightGridTest : public testing::Test {
  protected:
    static RenderOptions options() {
        RenderOptions result;
        result.width = result.height = kRows;
        result.samples = 4;
        result.frames = 8;
        result.subdivisions = 1;
        result.transparency = Transparency::sorted;
        return result;
    }
    LinearImage draw(RenderScene scene, Scattering scattering, const RenderOptions& how = options()) {
        for (RenderStrands& strands : scene.strands) strands.material.fibre.scattering = scattering;
        auto picture = renderPicture(*device_, scene, how);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        if (!picture) return {};
        for (const float value : picture->linear.rgba) EXPECT_TRUE(std::isfinite(value));
        return std::move(picture->linear);
    }
    /// Red of each row.
    static std::vector<double> rows(const LinearImage& image) {
        std::vector<double> result(image.height, 0);
        for (std::uint32_t y = 0; y < image.height; ++y) {
            for (std::uint32_t x = 0; x < image.width; ++x)
                result[y] +=
                    static_cast<double>(image.rgba[4 * (std::size_t{y} * image.width + x)]) / image.width;
        }
        return result;
    }

    std::unique_ptr<gpu::Device> device_ = software::makeDevice();
};

// Dual scattering takes it for a slab without sides, from which no light leaves but above and below.
TEST_F(LightGridTest, ABlockIsAsBrightAtItsSideAsTracedPhotonsMakeIt) {
    const shading::MarschnerParameters fibre = greyFibre(0.2);
    std::vector<double> truth(kRows, 0), volume(kRows, 0), dual(kRows, 0);
    const auto add = [](std::vector<double>& sum, const std::vector<double>& more, double factor) {
        for (std::size_t i = 0; i < kRows; ++i) sum[i] += factor * more[i];
    };
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const Block block(fibre, seed);
        add(truth, Traced(block.places, fibre).seen(100'000), 1);
        const std::vector<double> single = rows(draw(block.scene, Scattering::single));
        add(volume, rows(draw(block.scene, Scattering::volume)), 1);
        add(volume, single, -1);
        add(dual, rows(draw(block.scene, Scattering::dual)), 1);
        add(dual, single, -1);
    }
    const auto ratio = [&](const std::vector<double>& ours, std::size_t from, std::size_t to) {
        double sum = 0, all = 0;
        for (std::size_t i = from; i < to; ++i) {
            sum += ours[i];
            all += truth[i];
        }
        return sum / all;
    };
    EXPECT_NEAR(ratio(volume, 0, 4), 1, 0.25);
    // Deeper there is little light, of which some is too much.
    for (const auto& [from, to] : {std::pair(4, 7), std::pair(7, 10)}) {
        const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
        EXPECT_LT(ratio(volume, a, b), 0.62 * ratio(dual, a, b)) << from << " mm";
        EXPECT_GT(ratio(volume, a, b), 0.8) << from << " mm";
    }
}

// Whatever it is that light meets, nothing is lost and nothing comes from nowhere.
TEST_F(LightGridTest, WhiteHairUnderAnEvenSkyIsAsBrightAsTheSky) {
    Block block(greyFibre(0), 4);
    block.scene.lights.clear();
    block.scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    const std::vector<double> seen = rows(draw(block.scene, Scattering::volume));
    for (std::size_t i = 2; i < kRows - 2; ++i) EXPECT_NEAR(seen[i], 1, 0.2) << i << " mm";
}

// A floor of two triangles of 10 m hides the sky below as one of many small ones does.
TEST_F(LightGridTest, FarTrianglesFillTheirCells) {
    Block block(greyFibre(0.05), 6);
    block.scene.lights.clear();
    block.scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    const auto bottom = [&](const RenderScene& scene) {
        const std::vector<double> seen = rows(draw(scene, Scattering::volume));
        return seen[kRows - 2] + seen[kRows - 3] + seen[kRows - 4];
    };
    const double open = bottom(block.scene);
    const auto floorOf = [&](int sides, float width) {
        RenderMesh mesh;
        mesh.albedo = Vec3f::Zero();
        mesh.matte = true;
        std::vector<Vec3f> points;
        std::vector<std::uint32_t> indices;
        for (int y = 0; y <= sides; ++y) {
            for (int x = 0; x <= sides; ++x) {
                const Vec2f at =
                    width * (Vec2f(static_cast<float>(x), static_cast<float>(y)) / static_cast<float>(sides) -
                             Vec2f::Constant(0.5f));
                points.emplace_back(at.x() + 0.5f * kWide, -kDeep - 0.002f, at.y() + 0.05f);
            }
        }
        const auto row = static_cast<std::uint32_t>(sides + 1);
        for (std::uint32_t y = 0; y + 1 < row; ++y) {
            for (std::uint32_t x = 0; x + 1 < row; ++x) {
                const std::uint32_t a = y * row + x;
                for (const std::uint32_t i : {a, a + row, a + 1, a + 1, a + row, a + row + 1})
                    indices.push_back(i);
            }
        }
        RenderScene scene = block.scene;
        mesh.positions_ws = points;
        mesh.indices = indices;
        scene.meshes = {mesh};
        return bottom(scene);
    };
    const double fine = floorOf(64, 1), far = floorOf(1, 10);
    EXPECT_LT(fine, 0.9 * open);
    EXPECT_NEAR(far / fine, 1, 0.04);
}

TEST_F(LightGridTest, FollowsWhatChangesWhileMapsAreHeldAndAfter) {
    const TestHead head(400);
    RenderScene scene = head.scene();
    StrandShading& material = scene.strands[0].material;
    material.fibre.model = ShadingModel::marschner;
    material.fibre.scattering = Scattering::volume;
    RenderOptions how = options();
    how.frames = 1;
    const auto shown = [&](Renderer& renderer) {
        return renderPicture(*device_, renderer, how).value().linear.rgba;
    };
    Renderer renderer(*device_);
    ASSERT_TRUE(renderer.setScene(scene));
    const auto first = shown(renderer);
    EXPECT_NE(first, draw(scene, Scattering::dual, how).rgba);
    renderer.holdMaps(true);
    StrandShading dull = material;
    dull.fibre.model = ShadingModel::kajiya;
    for (const StrandShading& one : {dull, material}) {
        ASSERT_TRUE(renderer.setMaterial(0, one));
        for (const float value : shown(renderer)) ASSERT_TRUE(std::isfinite(value));
    }
    EXPECT_EQ(shown(renderer), first);
    material.fibre.marschner.azimuthal.absorption *= 0.3;
    ASSERT_TRUE(renderer.setMaterial(0, material));
    shown(renderer);
    renderer.holdMaps(false);
    Renderer fresh(*device_);
    ASSERT_TRUE(fresh.setScene(scene));
    EXPECT_EQ(shown(renderer), shown(fresh));
    scene.lights[0].irradiance *= 2;
    scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Zero());
    ASSERT_TRUE(renderer.setLights(scene.lights));
    renderer.setEnvironment(scene.environment);
    ASSERT_TRUE(fresh.setScene(scene));
    EXPECT_EQ(shown(renderer), shown(fresh));
}

TEST_F(LightGridTest, IsTheSameOnAnyNumberOfThreads) {
    TestHead head(300);
    RenderScene scene = head.scene();
    scene.strands[0].material.fibre.model = ShadingModel::marschner;
    std::vector<float> first;
    for (const std::size_t threads : {1u, 3u}) {
        setThreadCount(threads);
        const LinearImage image = draw(scene, Scattering::volume);
        if (first.empty()) first = image.rgba;
        EXPECT_EQ(image.rgba, first) << threads << " threads";
    }
    setThreadCount(0);
}

// Else hair that moves would flicker, for its cells change their places now and then.
TEST_F(LightGridTest, OtherPhotonsMakeTheSamePicture) {
    TestHead head(2000);
    RenderScene scene = head.scene();
    scene.strands[0].material.fibre.model = ShadingModel::marschner;
    scene.strands[0].material.fibre.marschner = greyFibre(0.1);
    RenderOptions how = options();
    how.width = how.height = 96;
    how.lightPhotons = 1u << 17u;
    const LinearImage one = draw(scene, Scattering::volume, how);
    how.lightPhotons += 5000;
    const LinearImage other = draw(scene, Scattering::volume, how);
    // Of patches of 6 x 6 pixels.
    double worst = 0, squares = 0, count = 0, most = 0;
    std::vector<std::pair<double, double>> patches;
    for (std::uint32_t y = 0; y < 96; y += 6) {
        for (std::uint32_t x = 0; x < 96; x += 6) {
            double a = 0, b = 0;
            for (std::uint32_t i = 0; i < 36; ++i) {
                const std::size_t at = 4 * (std::size_t{y + i / 6} * 96 + x + i % 6);
                a += static_cast<double>(one.rgba[at]) / 36;
                b += static_cast<double>(other.rgba[at]) / 36;
            }
            patches.emplace_back(a, b);
            most = std::max(most, a);
        }
    }
    for (const auto& [a, b] : patches) {
        if (a < 0.05 * most) continue;
        worst = std::max(worst, std::abs(b / a - 1));
        squares += (b / a - 1) * (b / a - 1);
        ++count;
    }
    EXPECT_GT(squares, 0) << "it is of other photons";
    EXPECT_LT(std::sqrt(squares / count), 0.025);
    EXPECT_LT(worst, 0.13) << "in the dimmest";
}

TEST_F(LightGridTest, OneStrandAndLampsAmidstTheHairAreDrawn) {
    TestStrands one;
    one.add({Vec3f::Zero(), Vec3f(0, 0.1f, 0), Vec3f(0, 0.2f, 0)}, 0.0001f);
    RenderScene scene;
    scene.strands = {one.view()};
    scene.strands[0].material.fibre.model = ShadingModel::marschner;
    scene.camera.eye_ws = Vec3f(0, 0.1f, 1);
    scene.camera.target_ws = Vec3f(0, 0.1f, 0);
    scene.lights = {Light{}};
    draw(scene, Scattering::volume);
    Block block(greyFibre(0.2), 5);
    Light& lamp = block.scene.lights[0];
    lamp.kind = LightKind::point;
    lamp.position_ws = Vec3f(0.5f * kWide, -0.5f * kDeep, 0.05f);
    lamp.intensity = Vec3f::Constant(1e-3f);
    const std::vector<double> dark = rows(draw(block.scene, Scattering::single));
    const std::vector<double> lit = rows(draw(block.scene, Scattering::volume));
    EXPECT_GT(lit[kRows / 2], dark[kRows / 2]);
}

}  // namespace
}  // namespace hairloom::render
