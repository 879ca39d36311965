// SPDX-License-Identifier: GPL-3.0-or-later
// Strands of several materials in one group, against the same strands in groups of their own.

#include <gmock/gmock.h>

#include "core/render/renderer.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

class MaterialsTest : public RenderTest {
  protected:
    MaterialsTest() {
        materials_[0].albedo = Vec3f(0.7f, 0.1f, 0.1f);
        materials_[1].fibre.model = ShadingModel::marschner;
        materials_[1].fibre.marschner.azimuthal.absorption = Vec3d(0.05, 0.2, 0.5);
        materials_[1].radius = 0.004f;
        materials_[2].look.emplace();
        materials_[2].look->root = Vec3d(0.1, 0.2, 0.8);
        materials_[2].look->tip = Vec3d(0.1, 0.7, 0.2);
        materials_[2].tipOpacity = 0.4f;
        for (StrandShading& material : materials_) material.variation = 0;
        for (std::size_t i = 0; i < materials_.size(); ++i) {
            const auto shift = 0.02f * static_cast<float>(i) - 0.02f;
            all_.add({Vec3f(shift, -0.1f, shift), Vec3f(0, 0, 0.02f - shift), Vec3f(-shift, 0.1f, shift)},
                     0.002f);
            single_[i].add({all_.positions[3 * i], all_.positions[3 * i + 1], all_.positions[3 * i + 2]},
                           0.002f);
        }
    }
    RenderScene scene(std::vector<RenderStrands> strands) const {
        RenderScene made;
        made.strands = std::move(strands);
        made.camera = frame(View::Front, boundsOf(made), 1);
        made.lights = studioLights(made.camera);
        return made;
    }
    RenderScene together() const {
        RenderStrands strands = all_.view();
        strands.radii = {};
        strands.material = materials_[0];
        strands.others = {materials_[1], materials_[2]};
        strands.materials = which_;
        return scene({strands});
    }
    RenderScene apart() const {
        std::vector<RenderStrands> groups;
        for (std::size_t i = 0; i < materials_.size(); ++i) {
            groups.push_back(single_[i].view());
            groups.back().radii = {};
            groups.back().material = materials_[i];
        }
        return scene(std::move(groups));
    }
    static RenderOptions options(Transparency kind) {
        RenderOptions how;
        how.width = how.height = 64;
        how.frames = kind == Transparency::stochastic ? 4 : 1;
        how.shadowResolution = 128;
        how.transparency = kind;
        return how;
    }
    Image image(const RenderScene& scene, Transparency kind) {
        auto picture = renderPicture(*device, scene, options(kind));
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? std::move(picture->image) : Image();
    }
    std::vector<std::uint8_t> draw(const RenderScene& scene, Transparency kind) {
        return image(scene, kind).rgba;
    }

    std::array<StrandShading, 3> materials_;
    std::array<TestStrands, 3> single_;
    TestStrands all_;
    std::vector<std::uint32_t> which_{0, 1, 2};
};

TEST_F(MaterialsTest, InOneGroupLookAsInGroupsOfTheirOwn) {
    for (const Transparency kind : {Transparency::sorted, Transparency::stochastic, Transparency::weighted})
        EXPECT_EQ(draw(together(), kind), draw(apart(), kind)) << static_cast<int>(kind);
}

TEST_F(MaterialsTest, TubesAmongHairLookAsInGroupsOfTheirOwn) {
    for (const std::size_t tubes : {0u, 1u}) materials_[tubes].tubes = true;
    EXPECT_EQ(draw(together(), Transparency::stochastic), draw(apart(), Transparency::stochastic));
}

TEST_F(MaterialsTest, ThoseThatAreNotDrawnAreNotThere) {
    which_ = {kNotDrawn, 1, kNotDrawn};
    RenderScene one = together();
    RenderScene other = apart();
    other.strands = {other.strands[1]};
    one.camera = other.camera;
    one.lights = other.lights;
    // Maps are fitted to where all of them are.
    EXPECT_GT(decibels(image(one, Transparency::sorted), image(other, Transparency::sorted)), 45);
    which_ = {kNotDrawn, kNotDrawn, kNotDrawn};
    other.strands.clear();
    EXPECT_EQ(draw(together(), Transparency::sorted), draw(other, Transparency::sorted)) << "only background";
}

TEST_F(MaterialsTest, ChangeOfOneShowsInTheRenderer) {
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(together()));
    gpu::TextureDesc desc;
    desc.name = "test target";
    desc.width = desc.height = 64;
    desc.format = gpu::Format::Rgba8Unorm;
    desc.usage = gpu::Usage::RenderTarget;
    const auto target = device->createTexture(desc).value();
    const auto pixels = [&] {
        auto list = device->createCommandList().value();
        EXPECT_TRUE(renderer.record(*list, options(Transparency::sorted), target));
        EXPECT_TRUE(device->submit(std::move(list)));
        std::vector<std::uint8_t> read(64 * 64 * 4);
        EXPECT_TRUE(device->readTexture(target, std::as_writable_bytes(std::span(read))));
        return read;
    };
    const auto before = pixels();
    materials_[2].look->tip = Vec3d(0.9, 0.9, 0.1);
    materials_[1].radius = 0.002f;
    ASSERT_TRUE(renderer.setMaterial(0, materials_[0], std::span(materials_).subspan(1)));
    const auto changed = pixels();
    EXPECT_NE(changed, before);
    EXPECT_EQ(changed, draw(together(), Transparency::sorted));
    EXPECT_FALSE(renderer.setMaterial(0, materials_[0])) << "there are three";
}

TEST_F(MaterialsTest, OnesThatAreNotThereAreRefused) {
    which_[1] = 3;
    const auto picture = renderPicture(*device, together(), options(Transparency::sorted));
    ASSERT_FALSE(picture);
    EXPECT_THAT(picture.error().message(), testing::HasSubstr("strand 1 has the material 3 of 3"));
    which_.pop_back();
    EXPECT_FALSE(renderPicture(*device, together(), options(Transparency::sorted)));
}

}  // namespace
}  // namespace hairloom::render
