// SPDX-License-Identifier: GPL-3.0-or-later
// Marschner with dual scattering against a path tracer's pictures of the Sintel strands
// (../shared/reference/truth.md): how much brighter hair becomes by light that other hairs have scattered.
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/render/renderer.h"
#include "core/shading/melanin.h"
#include "importers/scene.h"
#include "importers/strands.h"
#include "tests/render/render_fixture.h"
#include "tests/support/source_dir.h"

namespace hairloom::render {
namespace {

namespace fs = std::filesystem;

const fs::path kData = outsideData();

/// The view of truth.md: the strands on a matte head.
class SintelHair {
  public:
    SintelHair(ImportedStrands strands, ImportedScene head)
        : strands_(std::move(strands)), head_(std::move(head)) {
        for (const Triangle& t : head_.mesh.triangles()) indices_.insert(indices_.end(), t.begin(), t.end());
    }

    RenderScene scene(double eumelanin, Scattering scattering, const Vec3f& skin) const {
        RenderScene scene;
        RenderMesh mesh;
        mesh.positions_ws = head_.mesh.positions();
        mesh.indices = indices_;
        mesh.albedo = skin;
        mesh.matte = true;
        scene.meshes = {mesh};
        RenderStrands hair;
        hair.offsets = strands_.groom.offsets.view();
        hair.positions_ws = strands_.groom.positions();
        hair.material.radius = 0.0002f;
        hair.material.tipScale = 0.3f;
        hair.material.rootBrightness = hair.material.tipBrightness = 1;
        hair.material.variation = 0;
        FibreMaterial& fibre = hair.material.fibre;
        fibre.model = ShadingModel::marschner;
        fibre.scattering = scattering;
        shading::MarschnerParameters& m = fibre.marschner;
        m.azimuthal.absorption = shading::absorption({eumelanin, 0});
        m.azimuthal.width = shading::azimuthalWidth(0.3);
        m.azimuthal.causticWidth = 0;
        m.width = {8.3 * shading::kDegree, 4.2 * shading::kDegree, 16.7 * shading::kDegree};
        scene.strands = {hair};
        scene.camera.eye_ws = Vec3f(0.35f, 1.62f, 0.75f);
        scene.camera.target_ws = Vec3f(0, 1.555f, 0);
        scene.camera.verticalFov = 22;
        scene.lights = {Light{}};
        scene.environment = Environment();
        scene.background = Vec3f::Zero();
        return scene;
    }

  private:
    ImportedStrands strands_;
    ImportedScene head_;
    std::vector<std::uint32_t> indices_;
};

RenderOptions groundTruthOptions() {
    RenderOptions options;
    options.width = options.height = 80;
    options.frames = 2;
    options.subdivisions = 1;
    return options;
}

/// Draws one scene again and again; its shadow maps stay.
class Sitting {
  public:
    Sitting(gpu::Device& device, const RenderScene& scene) : device_(device), renderer_(device) {
        const auto status = renderer_.setScene(scene);
        EXPECT_TRUE(status) << (status ? "" : status.error().message());
    }
    /// Linear light, RGBA.
    std::vector<float> draw() {
        const RenderOptions options = groundTruthOptions();
        for (std::uint32_t i = 0; i < options.frames; ++i) {
            auto list = device_.createCommandList().value();
            const auto status = renderer_.record(*list, options, nullptr);
            EXPECT_TRUE(status) << (status ? "" : status.error().message());
            EXPECT_TRUE(device_.submit(std::move(list)).value()->wait());
        }
        std::vector<float> sum(std::size_t{4} * options.width * options.height);
        EXPECT_TRUE(device_.readBuffer(renderer_.linearSum(), 0, std::as_writable_bytes(std::span(sum))));
        for (float& value : sum) value /= static_cast<float>(options.frames);
        return sum;
    }

    /// Sum over the pixels that hair covers by half or more, RGB.
    Vec3d light(const StrandShading& material, const std::vector<float>& covered) {
        EXPECT_TRUE(renderer_.setMaterial(0, material));
        const std::vector<float> all = draw();
        Vec3d sum = Vec3d::Zero();
        for (std::size_t i = 0; i < all.size(); i += 4) {
            if (covered[i] >= 0.5f) sum += Eigen::Map<const Vec3f>(&all[i]).cast<double>();
        }
        return sum;
    }

  private:
    gpu::Device& device_;
    Renderer renderer_;
};

/// The hair's share of each pixel: white hair on a black head under white light from everywhere.
std::vector<float> coverage(gpu::Device& device, RenderScene scene) {
    scene.strands[0].material.albedo = Vec3f::Ones();
    scene.strands[0].material.fibre.model = ShadingModel::kajiya;
    scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    scene.lights.clear();
    return Sitting(device, scene).draw();
}

TEST_F(RenderTest, DualScatteringBrightensHairAsAPathTracerDoes) {
    const fs::path strandsFile = kData / "strands/sintel_16pt.tfx";
    if (!fs::exists(strandsFile)) GTEST_SKIP() << strandsFile << " is not there";
    auto strands = importStrands(strandsFile);
    auto head = importScene(kData / "heads/sintel.obj");
    ASSERT_TRUE(strands && head);
    const SintelHair hair(std::move(*strands), std::move(*head));
    const Vec3d luminance(0.2126, 0.7152, 0.0722);
    const Vec3f black = Vec3f::Zero(), skin(0.5f, 0.35f, 0.27f);
    const auto covered = coverage(*device, hair.scene(1, Scattering::single, black));
    Sitting onBlack(*device, hair.scene(1, Scattering::single, black));
    Sitting onSkin(*device, hair.scene(1, Scattering::single, skin));
    struct GroundTruth {
        Vec3f skin;
        double eumelanin, ratio;
    };
    for (const GroundTruth& groundTruth :
         {GroundTruth{black, 0.3, 2.679}, GroundTruth{black, 1.3, 1.287}, GroundTruth{black, 8, 1.054},
          GroundTruth{skin, 0.3, 3.496}, GroundTruth{skin, 1.3, 1.449}, GroundTruth{skin, 8, 1.094}}) {
        Sitting& sitting = groundTruth.skin.x() > 0 ? onSkin : onBlack;
        const auto light = [&](Scattering scattering) {
            return sitting.light(
                hair.scene(groundTruth.eumelanin, scattering, groundTruth.skin).strands[0].material, covered);
        };
        const Vec3d single = light(Scattering::single), all = light(Scattering::dual);
        const double ratio = all.dot(luminance) / single.dot(luminance);
        EXPECT_NEAR(ratio, groundTruth.ratio, 0.15 * groundTruth.ratio)
            << groundTruth.eumelanin << " on " << groundTruth.skin.transpose();
        std::ostringstream measured;
        measured << ratio << ", red, green, blue " << all.cwiseQuotient(single).transpose();
        RecordProperty(
            "eumelanin_" + std::to_string(groundTruth.eumelanin) + (groundTruth.skin.x() > 0 ? "_skin" : ""),
            measured.str());
    }
}

}  // namespace
}  // namespace hairloom::render
