// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/render/passes.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {

/// Runs the passes up to the shadow maps and asks the shader what light does at given places.
class LightTest : public RenderTest {
  protected:
    /// Two results a case, as shaders/light_echo.comp.hlsl says. `layers`: RendererState::deepLayers.
    std::vector<shaders::float4> light(const RenderScene& scene, const RenderOptions& options,
                                       const std::vector<shaders::LightCase>& cases,
                                       std::array<float, 3> layers = {0.04f, 0.14f, 1.0f}) {
        RendererState state(*device);
        state.scene = DeviceScene::upload(*device, scene).value();
        state.lights = scene.lights;
        state.environment = scene.environment;
        state.camera = scene.camera;
        state.options = options;
        state.deepLayers = layers;
        state.detail.subdivisions = options.subdivisions;
        SceneFacts facts;
        facts.meshes = state.scene.triangles() > 0;
        facts.hair = !state.scene.batches.empty();
        facts.lights = facts.shadowLights = static_cast<std::uint32_t>(scene.lights.size());
        state.plan = planRender(facts, options, 1);
        EXPECT_TRUE(state.targets.fit(*device, state.plan));
        EXPECT_TRUE(state.scene.prepareCurves(*device, options.subdivisions));
        gpu::TextureDesc nothing;
        nothing.name = "nothing";
        state.nothing = device->createTexture(nothing, std::array<std::byte, 4>{}).value();
        state.noWords = buffer("no words", std::array<std::byte, 4>{}, 4);

        std::vector<shaders::float4> results(2 * cases.size());
        const auto in = buffer("cases", std::as_bytes(std::span(cases)), sizeof(shaders::LightCase));
        const auto out = buffer("results", std::as_bytes(std::span(results)), sizeof(shaders::float4));
        auto list = device->createCommandList().value();
        setUpLights(state);
        if (facts.hair) recordCurves(*list, state);
        recordShadowMaps(*list, state);
        list->beginPass({"light", {}, {}});
        list->setPipeline(state.pipelines.compute("light_echo.comp"));
        list->setConstants(0, gpu::bytesOf(state.shade));
        bindShadows(*list, state);
        bind(*list, {gpu::Binding::read(0, in), gpu::Binding::write(0, out)});
        list->dispatch(static_cast<std::uint32_t>((cases.size() + 63) / 64));
        list->endPass();
        const auto submission = device->submit(std::move(list));
        EXPECT_TRUE(submission) << (submission ? "" : submission.error().message());
        EXPECT_TRUE(device->readBuffer(out, 0, std::as_writable_bytes(std::span(results))));
        return results;
    }

  private:
    gpu::BufferPtr buffer(const char* name, std::span<const std::byte> content, std::uint32_t element) {
        gpu::BufferDesc desc;
        desc.name = name;
        desc.size = content.size();
        desc.elementBytes = element;
        desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
        return device->createBuffer(desc, content).value();
    }
};

}  // namespace hairloom::render
