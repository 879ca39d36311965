// SPDX-License-Identifier: GPL-3.0-or-later
// Light on skin under hair.
#include "core/shading/melanin.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// A plate under a layer of strands, about four deep, lit from above and seen from between the two.
class SkinUnderHair : public RenderTest {
  protected:
    SkinUnderHair() {
        Random random(5);
        for (int i = 0; i < 400; ++i) {
            const float y = random.uniform(0.04f, 0.05f), z = random.uniform(-0.1f, 0.1f);
            strands.add({{-0.15f, y, z}, {-0.05f, y, z}, {0.05f, y, z}, {0.15f, y, z}}, 0.001f);
            streaks.push_back(i % 2 == 0 ? 1.0f : 0.0f);
        }
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
    }

    Vec3d plate() {
        const TestPlate ground;
        RenderScene scene;
        RenderMesh mesh = ground.mesh();
        mesh.albedo = Vec3f::Constant(0.5f);
        mesh.matte = true;
        scene.meshes = {mesh};
        scene.strands = {strands.view()};
        scene.strands[0].material = material;
        scene.strands[0].streaks = streaks;
        scene.environment = {};
        scene.camera.eye_ws = {0, 0.03f, 0.25f};
        scene.camera.target_ws = Vec3f::Zero();
        scene.camera.verticalFov = 1;
        Light light;
        light.toLight_ws = Vec3f::UnitY();
        scene.lights = {light};
        RenderOptions options;
        options.width = options.height = 8;
        options.frames = 1;
        options.shadowResolution = 128;
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? meanColour(picture->linear) : Vec3d(Vec3d::Zero());
    }

    void wear(ShadingModel model, const Vec3d& absorption) {
        FibreMaterial& fibre = material.fibre;
        fibre.model = model;
        fibre.marschner.azimuthal.absorption = absorption;
        fibre.marschner.azimuthal.width = shading::azimuthalWidth(0.3);
        fibre.marschner.azimuthal.causticWidth = 0;
        shading::setScales(fibre.marschner, 2 * shading::kDegree, shading::longitudinalWidth(0.3));
        if (model == ShadingModel::sadeghi) fibre.sadeghi = sadeghiLike(shading::Marschner(fibre.marschner));
    }

    Vec3d plainPlate(ShadingModel model, const Vec3d& absorption) {
        wear(model, absorption);
        material.look.reset();
        return plate();
    }

    /// As strandMaterials() has it: the fibre itself takes nothing.
    Vec3d lookPlate(ShadingModel model, const Vec3d& absorption, const Vec3d& streak) {
        wear(model, model == ShadingModel::marschner ? Vec3d::Zero() : absorption);
        shading::StrandLook look;
        look.quantity = shading::LookQuantity::absorption;
        look.root = look.tip = absorption;
        look.streakRoot = look.streakTip = streak;
        material.look = look;
        return plate();
    }

    TestStrands strands;
    std::vector<float> streaks;
    StrandShading material;
};

TEST_F(SkinUnderHair, IsLitThroughTheLookAsThroughPlainHairOfItsColour) {
    for (const ShadingModel model : {ShadingModel::marschner, ShadingModel::sadeghi}) {
        for (const double eumelanin : {0.3, 8.0}) {
            const Vec3d absorption = shading::absorption({eumelanin, 0});
            const Vec3d plain = plainPlate(model, absorption);
            const Vec3d look = lookPlate(model, absorption, absorption);
            EXPECT_TRUE(look.isApprox(plain, 0.03))
                << "eumelanin " << eumelanin << ": " << look.transpose() << ", plain " << plain.transpose();
        }
    }
}

TEST_F(SkinUnderHair, IsLitThroughStreaksAsThroughTheirMixture) {
    const Vec3d blond = shading::absorption({0.2, 0}), dark = shading::absorption({6, 0});
    for (const ShadingModel model : {ShadingModel::marschner, ShadingModel::sadeghi}) {
        const Vec3d light = lookPlate(model, blond, blond), shade = lookPlate(model, dark, dark);
        const Vec3d mixed = lookPlate(model, blond, dark), exchanged = lookPlate(model, dark, blond);
        EXPECT_TRUE(mixed.isApprox(exchanged, 0.1)) << mixed.transpose() << ", " << exchanged.transpose();
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(mixed[c], 0.75 * light[c] + 0.25 * shade[c]);
            EXPECT_GT(mixed[c], 0.05 * light[c] + 0.95 * shade[c]);
        }
        EXPECT_GT(light.x(), 1.3 * shade.x()) << "the colour of the hair matters";
    }
}

}  // namespace
}  // namespace hairloom::render
