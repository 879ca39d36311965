// SPDX-License-Identifier: GPL-3.0-or-later
// Marschner with dual scattering against a path tracer's pictures of the Sintel strands
// (../shared/reference/truth.md): how much brighter hair becomes by light that other hairs have scattered.
#include <cstdlib>
#include <filesystem>

#include "core/shading/melanin.h"
#include "importers/scene.h"
#include "importers/strands.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(HAIRLOOM_SOURCE_DIR) / "../shared/data";

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

RenderOptions truthOptions() {
    RenderOptions options;
    options.width = options.height = 80;
    options.frames = 2;
    options.subdivisions = 1;
    return options;
}

LinearImage draw(gpu::Device& device, const RenderScene& scene, const RenderOptions& options) {
    const auto picture = renderPicture(device, scene, options);
    EXPECT_TRUE(picture) << picture.error().message();
    return picture ? picture->linear : LinearImage();
}

/// The hair's share of each pixel: white hair on a black head under white light from everywhere.
LinearImage coverage(gpu::Device& device, RenderScene scene) {
    scene.meshes[0].albedo = Vec3f::Zero();
    scene.strands[0].material.albedo = Vec3f::Ones();
    scene.strands[0].material.fibre.model = ShadingModel::kajiya;
    scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    scene.lights.clear();
    return draw(device, scene, truthOptions());
}

/// Linear light of the pixels that hair covers by half or more, RGB.
Vec3d light(gpu::Device& device, const RenderScene& scene, const LinearImage& covered) {
    const LinearImage all = draw(device, scene, truthOptions());
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < all.rgba.size(); i += 4) {
        if (covered.rgba[i] >= 0.5f) sum += Eigen::Map<const Vec3f>(&all.rgba[i]).cast<double>();
    }
    return sum;
}

TEST_F(RenderTest, DualScatteringBrightensHairAsAPathTracerDoes) {
    const fs::path strandsFile = kData / "strands/sintel_16pt.tfx";
    if (!fs::exists(strandsFile)) GTEST_SKIP() << strandsFile << " is not there";
    auto strands = importStrands(strandsFile);
    auto head = importScene(kData / "heads/sintel.obj");
    ASSERT_TRUE(strands && head);
    const SintelHair hair(std::move(*strands), std::move(*head));
    const Vec3d luminance(0.2126, 0.7152, 0.0722);
    const LinearImage covered = coverage(*device, hair.scene(1, Scattering::single, Vec3f::Zero()));
    const Vec3f black = Vec3f::Zero(), skin(0.5f, 0.35f, 0.27f);
    struct Truth {
        Vec3f skin;
        double eumelanin, ratio;
    };
    for (const Truth& truth : {Truth{black, 0.3, 2.679}, Truth{black, 1.3, 1.287}, Truth{black, 8, 1.054},
                               Truth{skin, 0.3, 3.496}, Truth{skin, 1.3, 1.449}, Truth{skin, 8, 1.094}}) {
        const Vec3d single =
            light(*device, hair.scene(truth.eumelanin, Scattering::single, truth.skin), covered);
        const Vec3d all = light(*device, hair.scene(truth.eumelanin, Scattering::dual, truth.skin), covered);
        const double ratio = all.dot(luminance) / single.dot(luminance);
        const Vec3d channels = all.cwiseQuotient(single);
        EXPECT_NEAR(ratio, truth.ratio, 0.15 * truth.ratio)
            << truth.eumelanin << " on " << truth.skin.transpose();
        RecordProperty("eumelanin_" + std::to_string(truth.eumelanin) + (truth.skin.x() > 0 ? "_skin" : ""),
                       std::to_string(ratio));
        std::printf("eumelanin %.1f, skin %.2f: %.3f, truth %.3f; red, green, blue %.2f %.2f %.2f\n",
                    truth.eumelanin, static_cast<double>(truth.skin.x()), ratio, truth.ratio, channels.x(),
                    channels.y(), channels.z());
    }
}

}  // namespace
}  // namespace hairloom::render
