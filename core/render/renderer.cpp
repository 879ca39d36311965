// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/renderer.h"

#include <fmt/format.h>

#include "core/base/profiler.h"
#include "core/render/passes.h"

namespace hairloom::render {
namespace {

/// What the next frame has to do again.
struct Changes {
    bool curves = true;
    bool shadows = true;
    bool shading = true;
    bool picture = true;

    static Changes geometry() { return {}; }
    static Changes lights() { return {false, true, true, true}; }
    static Changes looks() { return {false, false, true, true}; }
    static Changes nothing() { return {false, false, false, false}; }
    void add(const Changes& other) {
        curves |= other.curves;
        shadows |= other.shadows;
        shading |= other.shading;
        picture |= other.picture;
    }
};

/// Which work another set of options calls for. Size and samples show in the targets.
Changes compare(const RenderOptions& before, const RenderOptions& now) {
    Changes changes = Changes::nothing();
    if (now.subdivisions != before.subdivisions) changes.add(Changes::geometry());
    if (now.shadowResolution != before.shadowResolution || now.shadows != before.shadows) {
        changes.add(Changes::lights());
    }
    changes.picture |=
        now.frames != before.frames || now.transparentBackground != before.transparentBackground;
    return changes;
}

}  // namespace

struct Renderer::Parts {
    gpu::Device& device;
    RendererState state;
    Changes changes;
    std::uint32_t accumulated = 0;

    explicit Parts(gpu::Device& used)
        : device(used),
          state{.pipelines = Pipelines(used),
                .scene = {},
                .camera = {},
                .lights = {},
                .ambientSky = Vec3f::Zero(),
                .ambientGround = Vec3f::Zero(),
                .background = Vec3f::Zero(),
                .overlay = {},
                .options = {},
                .samples = 1,
                .targets = {},
                .lightViews = {},
                .shade = {}} {}

    Status prepare(const RenderOptions& options);
    void recordChanges(gpu::CommandList& list);
};

Renderer::Renderer(gpu::Device& device) : parts_(std::make_unique<Parts>(device)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;

Status Renderer::setScene(const RenderScene& scene) {
    RendererState& state = parts_->state;
    parts_->changes = Changes::geometry();
    state.scene = {};
    if (auto status = check(scene); !status) return status;
    auto uploaded = DeviceScene::upload(parts_->device, scene);
    if (!uploaded) return tl::unexpected(uploaded.error());
    state.scene = std::move(*uploaded);
    state.camera = scene.camera;
    state.lights = scene.lights;
    state.ambientSky = scene.ambientSky;
    state.ambientGround = scene.ambientGround;
    state.background = scene.background;
    return {};
}

Status Renderer::setMeshPositions(std::size_t mesh, std::span<const Vec3f> positions_ws,
                                  std::span<const Vec3f> normals_ws) {
    if (auto status = parts_->state.scene.replaceMesh(mesh, positions_ws, normals_ws); !status) return status;
    parts_->changes.add(Changes::lights());
    return {};
}

Status Renderer::setStrandPositions(std::size_t group, std::span<const Vec3f> positions_ws) {
    if (auto status = parts_->state.scene.replaceStrands(group, positions_ws); !status) return status;
    parts_->changes.add(Changes::geometry());
    return {};
}

Status Renderer::setStrandPositions(std::size_t group, gpu::BufferPtr positions_ws,
                                    std::uint32_t floatsPerPoint, const Box3f& bounds_ws) {
    auto status =
        parts_->state.scene.replaceStrands(group, std::move(positions_ws), floatsPerPoint, bounds_ws);
    if (!status) return status;
    parts_->changes.add(Changes::geometry());
    return {};
}

Status Renderer::setMaterial(std::size_t group, const HairMaterial& material) {
    auto& groups = parts_->state.scene.groups;
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    const HairMaterial& before = groups[group].material;
    const bool sameShape = before.radius == material.radius && before.tipScale == material.tipScale;
    groups[group].material = material;
    parts_->changes.add(sameShape ? Changes::looks() : Changes::geometry());
    return {};
}

Status Renderer::setCamera(const Camera& camera) {
    if (auto status = check(camera); !status) return status;
    parts_->state.camera = camera;
    parts_->changes.add(Changes::looks());
    return {};
}

Status Renderer::setLights(std::span<const Light> lights) {
    if (auto status = check(lights); !status) return status;
    parts_->state.lights.assign(lights.begin(), lights.end());
    parts_->changes.add(Changes::lights());
    return {};
}

void Renderer::setAmbient(const Vec3f& sky, const Vec3f& ground) {
    parts_->state.ambientSky = sky;
    parts_->state.ambientGround = ground;
    parts_->changes.add(Changes::looks());
}

void Renderer::setBackground(const Vec3f& linear) {
    parts_->state.background = linear;
    parts_->changes.picture = true;
}

Status Renderer::setOverlay(Overlay overlay) {
    if (auto status = check(overlay); !status) return status;
    OverlayOnDevice& marks = parts_->state.overlay;
    marks.overlay = std::move(overlay);
    marks.waits = true;
    marks.bounds_ws.setEmpty();
    for (const OverlayBatch& batch : marks.overlay.batches) {
        for (const OverlayVertex& vertex : batch.vertices)
            marks.bounds_ws.extend(vertex.position_ws.head<3>());
    }
    return {};
}

void Renderer::restart() {
    parts_->changes.picture = true;
}

Status Renderer::Parts::prepare(const RenderOptions& options) {
    if (auto status = check(options, device.info()); !status) return status;
    const auto samples = chooseSamples(options, device.info());
    if (!samples) return tl::unexpected(samples.error());
    changes.add(compare(state.options, options));
    state.options = options;
    state.samples = *samples;
    const auto fitted = fitTargets(device, options, *samples, state.overlay.needsDepth(), state.targets);
    if (!fitted) return tl::unexpected(fitted.error());
    if (fitted->shadows) changes.add(Changes::lights());
    changes.picture |= fitted->picture;
    return state.scene.prepareCurves(device, options.subdivisions);
}

void Renderer::Parts::recordChanges(gpu::CommandList& list) {
    const bool hair = !state.scene.batches.empty();
    state.scene.recordUploads(list);
    if (changes.shading) setUpLights(state);
    if (changes.curves && hair) recordCurves(list, state);
    if (changes.shadows) recordShadowMaps(list, state);
    if (changes.shading && hair) recordShading(list, state);
    if (changes.picture) accumulated = 0;
    changes = Changes::nothing();
}

Status Renderer::record(gpu::CommandList& list, const RenderOptions& options, const gpu::TexturePtr& target) {
    HAIRLOOM_PROFILE("record frame");
    Parts& p = *parts_;
    if (target != nullptr && (target->desc().width != options.width ||
                              target->desc().height != options.height || target->desc().samples != 1)) {
        return fail(fmt::format("a target of {}x{} pixels and {} samples", target->desc().width,
                                target->desc().height, target->desc().samples),
                    fmt::format("{}x{} and 1, as the options say", options.width, options.height));
    }
    if (auto status = p.prepare(options); !status) return status;
    if (auto status = prepareOverlay(p.device, list, p.state.overlay); !status) return status;
    p.recordChanges(list);
    if (p.accumulated < options.frames) {
        recordFrame(list, p.state, p.accumulated);
        ++p.accumulated;
    }
    if (target != nullptr) {
        recordPresent(list, p.state, p.accumulated, target);
        recordOverlay(list, p.state, target);
    }
    return p.state.pipelines.takeStatus();
}

std::uint32_t Renderer::accumulated() const {
    return parts_->changes.picture ? 0 : parts_->accumulated;
}

const gpu::TexturePtr& Renderer::linearSum() const {
    return parts_->state.targets.sum;
}

Box3f Renderer::bounds() const {
    return parts_->state.bounds();
}

std::uint64_t Renderer::triangles() const {
    return parts_->state.scene.triangles();
}

std::uint64_t Renderer::strands() const {
    return parts_->state.scene.strands();
}

std::uint64_t Renderer::curvePoints() const {
    std::uint64_t count = 0;
    for (const StrandBatch& batch : parts_->state.scene.batches) {
        count += batch.curvePoints(parts_->state.options.subdivisions);
    }
    return count;
}

}  // namespace hairloom::render
