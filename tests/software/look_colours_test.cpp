// SPDX-License-Identifier: GPL-3.0-or-later
// The looks that come along, drawn by Kajiya-Kay and by Marschner: hair of one look has one colour.
#include <gtest/gtest.h>

#include <cmath>

#include "core/documents/look_presets.h"
#include "core/live/hair_look.h"
#include "core/render/renderer.h"
#include "core/software/device.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// Lightness and chroma by CIE L*a*b* under D65, of linear RGB.
struct Lightness {
    double lightness = 0, chroma = 0;
};

Lightness lightnessOf(const Vec3d& rgb) {
    Eigen::Matrix3d toXyz;
    toXyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
    const Vec3d xyz = (toXyz * rgb).cwiseQuotient(Vec3d(0.9505, 1, 1.089));
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    const double y = f(xyz.y());
    return {116 * y - 16, std::hypot(500 * (f(xyz.x()) - y), 200 * (y - f(xyz.z())))};
}

class LookColoursTest : public testing::Test {
  protected:
    /// Of all that is hair in the picture.
    Lightness drawn(const HairMaterial& material, render::ShadingModel model) {
        ViewFile view;
        view.fibre.model = model;
        RenderScene scene = head_.scene();
        scene.strands[0].material = strandShading(material, view);
        // It hides what lies behind it and sends out nothing.
        scene.meshes[0].albedo = Vec3f::Zero();
        RenderOptions how;
        how.width = how.height = 64;
        how.samples = how.frames = 1;
        how.shadowResolution = 256;
        how.skyStrands = 512;
        how.transparency = Transparency::sorted;
        how.transparentBackground = true;
        const auto picture = renderPicture(*device_, scene, how);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        if (!picture) return {};
        Vec3d sum = Vec3d::Zero();
        double count = 0;
        const LinearImage& image = picture->linear;
        for (std::size_t y = 0; y < 32; ++y) {
            for (std::size_t x = 16; x < 48; ++x) {
                const float* pixel = &image.rgba[4 * (y * 64 + x)];
                sum += static_cast<double>(pixel[3]) * Vec3f(pixel[0], pixel[1], pixel[2]).cast<double>();
                count += static_cast<double>(pixel[3]);
            }
        }
        EXPECT_GT(count, 100);
        return lightnessOf(sum / count);
    }

    TestHead head_{6000};
    std::unique_ptr<gpu::Device> device_ = software::makeDevice();
};

constexpr double kLightness = 7, kChroma = 9;  // of L* and C*

TEST_F(LookColoursTest, OneLookHasOneColourInBothModels) {
    std::size_t looks = 0;
    for (const LookPreset& preset : lookPresets()) {
        // Highlights that only Sadeghi's model has.
        if (preset.controls) continue;
        HairMaterial material;
        applyLook(preset, material);
        const Lightness kajiya = drawn(material, ShadingModel::kajiya);
        const Lightness marschner = drawn(material, ShadingModel::marschner);
        EXPECT_NEAR(kajiya.lightness, marschner.lightness, kLightness) << preset.name;
        EXPECT_NEAR(kajiya.chroma, marschner.chroma, kChroma) << preset.name;
        ++looks;
    }
    EXPECT_GE(looks, 12u);
}

TEST_F(LookColoursTest, TheColourOfAVolumeIsTooDarkForAFibre) {
    HairMaterial material;
    applyLook(*findLook("copper"), material);
    const Lightness marschner = drawn(material, ShadingModel::marschner);
    material.rootColour = material.tipColour = material.tipColour.cwiseAbs2();
    const Lightness kajiya = drawn(material, ShadingModel::kajiya);
    EXPECT_LT(kajiya.lightness, marschner.lightness - kLightness);
    EXPECT_LT(kajiya.chroma, marschner.chroma - kChroma);
}

}  // namespace
}  // namespace hairloom::render
