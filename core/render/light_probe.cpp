// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/light_probe.h"

#include "core/render/opacity_layers.h"
#include "core/render/passes.h"
#include "core/render/shadow_maps.h"

namespace hairloom::render {
namespace {

Result<gpu::BufferPtr> makeBuffer(gpu::Device& device, const char* name, std::span<const std::byte> content,
                                  std::uint32_t element) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = content.size();
    desc.elementBytes = element;
    desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
    return device.createBuffer(desc, content);
}

/// Scene, plan and targets of a frame that is only lit.
Status prepare(gpu::Device& device, const RenderScene& scene, const RenderOptions& options,
               RendererState& state) {
    auto uploaded = DeviceScene::upload(device, scene);
    if (!uploaded) return tl::unexpected(uploaded.error());
    state.scene = std::move(*uploaded);
    takeLights(state, scene.lights, scene.environment, shadowLightsOf(options, device.info()));
    state.camera = scene.camera;
    state.options = options;
    state.detail.subdivisions = options.subdivisions;
    SceneFacts facts;
    facts.meshes = state.scene.triangles() > 0;
    facts.hair = !state.scene.batches.empty();
    facts.environment = !state.environment.dark();
    facts.lights = facts.shadowLights = static_cast<std::uint32_t>(state.lights.size());
    facts.fragments = fragmentsThatFit(options, device.info(), state.scene.hair());
    state.plan = planRender(facts, options, 1);
    if (const auto fitted = state.targets.fit(device, state.plan); !fitted)
        return tl::unexpected(fitted.error());
    if (auto status = state.scene.prepareCurves(device, options.subdivisions); !status) return status;
    return preparePlaceholders(device, state);
}

}  // namespace

Result<std::vector<shaders::LightAnswer>> probeLight(gpu::Device& device, const RenderScene& scene,
                                                     const RenderOptions& options,
                                                     std::span<const shaders::LightCase> cases,
                                                     const std::optional<DeepLayers>& layers) {
    const auto failed = [](const Error& error) { return tl::unexpected(error); };
    RendererState state(device);
    state.deepLayers = layers;
    if (auto status = prepare(device, scene, options, state); !status) return failed(status.error());
    std::vector<shaders::LightAnswer> results(cases.size());
    const auto in = makeBuffer(device, "cases", std::as_bytes(cases), sizeof(shaders::LightCase));
    if (!in) return failed(in.error());
    const auto out =
        makeBuffer(device, "results", std::as_bytes(std::span(results)), sizeof(shaders::LightAnswer));
    if (!out) return failed(out.error());
    auto list = device.createCommandList();
    if (!list) return failed(list.error());
    gpu::CommandList& commands = **list;
    fitViews(state, true);
    setUpLights(state);
    if (!state.scene.batches.empty()) recordCurves(commands, state);
    recordMaps(commands, state, lightAtlas(state));
    recordMaps(commands, state, skyAtlas(state));
    commands.beginPass({"light", {}, {}});
    commands.setPipeline(state.pipelines.compute("light_probe.comp"));
    commands.setConstants(0, gpu::bytesOf(state.shade));
    bindShadows(commands, state);
    bind(commands, {gpu::Binding::read(0, *in), gpu::Binding::write(0, *out)});
    commands.dispatch(groupsFor(static_cast<std::uint32_t>(cases.size()), HAIRLOOM_LIST_GROUP));
    commands.endPass();
    if (auto status = state.pipelines.takeStatus(); !status) return failed(status.error());
    const auto submission = device.submit(std::move(*list));
    if (!submission) return failed(submission.error());
    if (auto read = device.readBuffer(*out, 0, std::as_writable_bytes(std::span(results))); !read)
        return failed(read.error());
    return results;
}

namespace {

/// The words of a map of hair: `state` is what they were made with, `width` words' texels in a row.
struct MapWords {
    std::vector<std::uint32_t> all;
    std::size_t ofTexel = 0, width = 0;
};

Result<MapWords> readMap(gpu::Device& device, const RenderScene& scene, const RenderOptions& options,
                         RendererState& state) {
    const auto failed = [](const Error& error) { return tl::unexpected(error); };
    if (auto status = prepare(device, scene, options, state); !status) return failed(status.error());
    fitViews(state, false);
    const ShadowAtlas atlas = lightAtlas(state);
    if (state.scene.batches.empty() || atlas.views.empty())
        return fail("there is no hair in the light, and so no map of it", "hair, and a light with shadows");
    auto list = device.createCommandList();
    if (!list) return failed(list.error());
    setUpLights(state);
    recordCurves(**list, state);
    recordMaps(**list, state, atlas);
    if (auto status = state.pipelines.takeStatus(); !status) return failed(status.error());
    const auto submission = device.submit(std::move(*list));
    if (!submission) return failed(submission.error());
    MapWords words{{}, opacityWords(options.shadows, layerCount(options)), atlas.width()};
    words.all.resize(words.ofTexel * words.width * atlas.side);
    if (auto read = device.readBuffer(state.targets[BufferId::opacity], 0,
                                      std::as_writable_bytes(std::span(words.all)));
        !read)
        return failed(read.error());
    return words;
}

}  // namespace

Result<NodeTexels> readNodes(gpu::Device& device, const RenderScene& scene, const RenderOptions& options) {
    if (options.shadows != Shadows::adaptive)
        return fail("these shadows have no nodes", "adaptive shadow maps");
    RendererState state(device);
    const auto words = readMap(device, scene, options, state);
    if (!words) return tl::unexpected(words.error());
    NodeTexels texels{options.shadowResolution, layerCount(options), {}, 0, 0};
    for (std::size_t i = 0; i < std::size_t{texels.side} * texels.side; ++i) {
        const std::size_t texel = words->ofTexel * (i / texels.side * words->width + i % texels.side);
        for (std::size_t node = 0; node < texels.nodes; ++node)
            texels.words.push_back(words->all[texel + node]);
    }
    std::array<std::uint32_t, 2> counts{};
    if (auto read = device.readBuffer(state.targets[BufferId::fragmentCounts], 0,
                                      std::as_writable_bytes(std::span(counts)));
        !read)
        return tl::unexpected(read.error());
    texels.found = counts[0];
    texels.listed = counts[1];
    return texels;
}

Result<OpacityTexels> readOpacity(gpu::Device& device, const RenderScene& scene,
                                  const RenderOptions& options) {
    OpacityTexels texels{options.shadowResolution, layerCount(options), {}, {}};
    if (texels.layers == 0 || options.shadows == Shadows::adaptive)
        return fail("these shadows have no opacity map", "deep opacity or opacity maps");
    RendererState state(device);
    const auto words = readMap(device, scene, options, state);
    if (!words) return tl::unexpected(words.error());
    for (std::size_t i = 0; i < std::size_t{texels.side} * texels.side; ++i) {
        const std::size_t texel = words->ofTexel * (i / texels.side * words->width + i % texels.side);
        float sum = 0;
        for (std::size_t layer = 0; layer < texels.layers; ++layer) {
            // As packShares() in opacity.hlsli.
            const std::uint32_t share = words->all[texel + layer / 2] >> (16 * (layer % 2)) & 0xffffu;
            texels.fibres.push_back(64 * static_cast<float>(share) / 65535);
            sum += texels.fibres.back();
        }
        texels.hair.push_back(sum > 0);
    }
    return texels;
}

}  // namespace hairloom::render
