// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/profiler.h"
#include "core/render/display_table.h"
#include "core/render/light_grid.h"
#include "core/render/opacity_layers.h"
#include "core/render/passes.h"
#include "core/render/shadow_maps.h"

namespace hairloom::render {
namespace {

/// What the next frame has to do again.
struct Changes {
    bool curves = true;
    bool sky = true;  ///< what of it is seen; shadows then change as well
    bool shadows = true;
    bool grid = true;  ///< light between hairs
    bool shading = true;
    bool picture = true;

    static Changes geometry() { return {}; }
    static Changes head() { return {false, true, true, true, true, true}; }
    static Changes lights() { return {false, false, true, true, true, true}; }
    static Changes looks() { return {false, false, false, true, true, true}; }
    static Changes camera() { return {false, false, false, false, true, true}; }
    static Changes placeholderTexture() { return {false, false, false, false, false, false}; }
    void add(const Changes& other) {
        curves |= other.curves;
        sky |= other.sky;
        shadows |= other.shadows;
        grid |= other.grid;
        shading |= other.shading;
        picture |= other.picture;
    }
};

/// Which work another set of options calls for. Size and samples show in the targets.
Changes compare(const RenderOptions& before, const RenderOptions& now) {
    Changes changes = Changes::placeholderTexture();
    if (now.shadowResolution != before.shadowResolution || now.shadows != before.shadows ||
        layerCount(now) != layerCount(before) || growthOf(now) != growthOf(before) ||
        now.shadowFragments != before.shadowFragments) {
        changes.add(Changes::lights());
    }
    if (now.skyStrands != before.skyStrands) changes.add(Changes::head());
    changes.grid |= now.lightCells != before.lightCells || now.lightPhotons != before.lightPhotons ||
                    now.temporal != before.temporal;
    if ((now.shadowBlur > 0) != (before.shadowBlur > 0) || now.headAbsorption != before.headAbsorption ||
        now.shadowFilter != before.shadowFilter) {
        changes.add(Changes::looks());
    }
    changes.picture |= now.frames != before.frames ||
                       now.transparentBackground != before.transparentBackground ||
                       now.ribbons != before.ribbons || now.transparency != before.transparency ||
                       now.temporal != before.temporal;
    return changes;
}

}  // namespace

struct Renderer::Parts {
    gpu::Device& device;
    RendererState state;
    Changes changes;
    std::vector<Light> lights;  ///< as they were given
    Environment environment;
    bool newLights = true;
    bool newGrid = false;  ///< of light, whose buffers hold nothing yet
    std::uint32_t accumulated = 0;
    std::uint32_t askedLayers = 0;  ///< of opacity, by the options, which the device may have no room for
    bool holdsMaps = false, holdsAverage = false;
    Changes heldBack = Changes::placeholderTexture();  ///< what waits for maps to be drawn anew
    std::vector<bool> mapped;  ///< which lights the maps are of; empty: there are none
    struct {
        Changes changes = Changes::placeholderTexture();
        std::uint32_t accumulated = 0;
        std::vector<bool> mapped;
        std::vector<LightView> closeViews;
        bool drawsMaps = false;
    } before;             ///< the last record()
    float blurredBy = 0;  ///< what Pass::shadowBlur was last recorded for; 0: other frames

    // What the plan was made for.
    bool planned = false;
    SceneFacts plannedFor;
    RenderOptions plannedOptions;
    std::uint32_t plannedSamples = 0;

    explicit Parts(gpu::Device& used) : device(used), state(used) {}

    SceneFacts facts(bool presents) const;
    Status prepareTargets(bool presents);
    Status prepareHelpers();
    Status prepare(const RenderOptions& options, bool presents);
    /// Whether anything is not as it was.
    bool recordChanges(gpu::CommandList& list);
    std::vector<bool> castingLights() const;
    template <class Record>
    void withoutShadows(Record record) {
        state.lit = true;
        record();
        state.lit = false;
    }
};

Renderer::Renderer(gpu::Device& device) : parts_(std::make_unique<Parts>(device)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;

Status Renderer::setScene(const RenderScene& scene) {
    RendererState& state = parts_->state;
    parts_->changes = Changes::geometry();
    parts_->mapped.clear();
    state.scene = {};
    state.pastCamera.reset();
    state.temporal = {};
    if (auto status = check(scene); !status) return status;
    auto uploaded = DeviceScene::upload(parts_->device, scene);
    if (!uploaded) return tl::unexpected(uploaded.error());
    state.scene = std::move(*uploaded);
    state.camera = scene.camera;
    parts_->lights = scene.lights;
    parts_->environment = scene.environment;
    parts_->newLights = true;
    state.background = scene.background;
    return {};
}

Status Renderer::setMeshPositions(std::size_t mesh, std::span<const Vec3f> positions_ws,
                                  std::span<const Vec3f> normals_ws) {
    if (auto status = parts_->state.scene.replaceMesh(mesh, positions_ws, normals_ws); !status) return status;
    parts_->changes.add(Changes::head());
    return {};
}

Status Renderer::setMeshAlbedo(std::size_t mesh, std::span<const Vec3f> albedo) {
    auto status = parts_->state.scene.replaceMeshAlbedo(parts_->device, mesh, albedo);
    if (!status) return status;
    parts_->changes.add(Changes::looks());
    return {};
}

Status Renderer::setStrandPositions(std::size_t group, std::span<const Vec3f> positions_ws) {
    if (auto status = parts_->state.scene.replaceStrands(group, positions_ws); !status) return status;
    parts_->changes.add(Changes::geometry());
    return {};
}

Status Renderer::setMeshPositions(std::size_t mesh, gpu::BufferPtr positions_ws, gpu::BufferPtr normals_ws,
                                  const Box3f& bounds_ws) {
    auto status =
        parts_->state.scene.replaceMesh(mesh, std::move(positions_ws), std::move(normals_ws), bounds_ws);
    if (!status) return status;
    parts_->changes.add(Changes::head());
    return {};
}

Status Renderer::setStrandPositions(std::size_t group, gpu::BufferPtr positions_ws,
                                    std::uint32_t floatsPerPoint, const Box3f& bounds_ws,
                                    std::span<const Vec3f> sample_ws) {
    auto status = parts_->state.scene.replaceStrands(parts_->device, group, std::move(positions_ws),
                                                     floatsPerPoint, bounds_ws, sample_ws);
    if (!status) return status;
    parts_->changes.add(Changes::geometry());
    return {};
}

Status Renderer::setRadii(std::size_t group, std::span<const float> radii) {
    if (auto status = parts_->state.scene.replaceRadii(group, radii); !status) return status;
    parts_->changes.add(Changes::geometry());
    return {};
}

Status Renderer::setPointDyes(std::size_t group, std::span<const float> dyes) {
    if (auto status = parts_->state.scene.replacePointDyes(group, dyes); !status) return status;
    parts_->changes.add(Changes::looks());
    return {};
}

Status Renderer::setMaterial(std::size_t group, const StrandShading& material,
                             std::span<const StrandShading> others) {
    auto& groups = parts_->state.scene.groups;
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    std::vector<MaterialOnDevice>& materials = groups[group].materials;
    if (others.size() + 1 != materials.size())
        return fail(fmt::format("{} materials for strands", others.size() + 1),
                    fmt::format("{}, as they have", materials.size()));
    bool sameShape = true;
    const auto set = [&](StrandShading& before, const StrandShading& now) {
        sameShape = sameShape && before.radius == now.radius && before.tipScale == now.tipScale &&
                    before.radiusVariation == now.radiusVariation && before.rootOpacity == now.rootOpacity &&
                    before.tipOpacity == now.tipOpacity;
        before = now;
    };
    set(materials[0].shading, material);
    for (std::size_t i = 0; i < others.size(); ++i) set(materials[i + 1].shading, others[i]);
    parts_->changes.add(sameShape ? Changes::looks() : Changes::geometry());
    return {};
}

Status Renderer::setCamera(const Camera& camera, bool cut) {
    if (auto status = check(camera); !status) return status;
    parts_->state.camera = camera;
    if (cut) parts_->state.pastCamera.reset();
    parts_->changes.add(Changes::camera());
    return {};
}

Status Renderer::setLights(std::span<const Light> lights) {
    if (auto status = check(lights); !status) return status;
    parts_->lights.assign(lights.begin(), lights.end());
    parts_->newLights = true;
    return {};
}

void Renderer::setEnvironment(const Environment& environment) {
    // Without bright parts, before and now, no shadow of a light changes.
    if (parts_->environment.brightRoots.empty() && environment.brightRoots.empty() && !parts_->newLights &&
        parts_->lights.size() <= parts_->state.lights.size()) {
        parts_->state.environment = parts_->environment = environment;
        parts_->changes.add(Changes::looks());
        return;
    }
    parts_->environment = environment;
    parts_->newLights = true;
}

void Renderer::setBackground(const Vec3f& linear) {
    parts_->state.background = linear;
    parts_->state.temporal = {};
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

SceneFacts Renderer::Parts::facts(bool presents) const {
    SceneFacts facts;
    facts.meshes = state.scene.triangles() > 0;
    facts.hair = !state.scene.batches.empty();
    facts.lights = static_cast<std::uint32_t>(state.lights.size());
    facts.shadowLights =
        static_cast<std::uint32_t>(std::ranges::count(state.lights, true, &Light::castsShadow));
    facts.environment = !state.environment.dark();
    facts.overlay = state.overlay.needsDepth();
    facts.overlayOnTop = std::ranges::any_of(state.overlay.overlay.batches, &OverlayBatch::onTop);
    facts.presents = presents;
    facts.askedLayers = askedLayers;
    if (state.closeHair.maps > 0)
        facts.closeMaps = closeMapsThatFit(state.options, device.info(), facts.shadowLights);
    facts.across = state.closeHair.across > 0 && facts.lights > 0 && state.scene.knowsSections();
    for (const StrandGroup& group : state.scene.groups) {
        for (const MaterialOnDevice& material : group.materials) {
            facts.look = facts.look || material.shading.look.has_value();
            facts.volume = facts.volume || (standsInLightGrid(material.shading) &&
                                            material.shading.fibre.scattering == Scattering::volume);
            facts.tableBytes += material.fibre.bytes();
        }
    }
    facts.fragments = fragmentsThatFit(state.options, device.info(), state.scene.hair());
    return facts;
}

Status Renderer::Parts::prepareTargets(bool presents) {
    const SceneFacts now = facts(presents);
    if (!planned || now != plannedFor || state.options != plannedOptions || state.samples != plannedSamples) {
        state.plan = planRender(now, state.options, state.samples);
        planned = true;
        plannedFor = now;
        plannedOptions = state.options;
        plannedSamples = state.samples;
    }
    const auto isNew = state.targets.fit(device, state.plan);
    if (!isNew) return tl::unexpected(isNew.error());
    if (isNew->has(TargetId::headDepth) || isNew->has(BufferId::firstHair) || isNew->has(BufferId::opacity)) {
        changes.add(Changes::lights());
        mapped.clear();
    }
    if (isNew->has(TargetId::skyHead) || isNew->has(BufferId::skyLayers)) {
        changes.add(Changes::head());
        mapped.clear();
    }
    if (isNew->has(BufferId::lightGrid)) {
        changes.add(Changes::looks());
        newGrid = true;
    }
    changes.picture |= isNew->has(TargetId::colour) || isNew->has(BufferId::nearest) ||
                       isNew->has(BufferId::sum) || isNew->has(BufferId::surface);
    if (isNew->has(BufferId::history)) state.temporal = {};
    return {};
}

/// What is needed once and not by every scene.
Status Renderer::Parts::prepareHelpers() {
    if (auto status = preparePlaceholders(device, state); !status) return status;
    if (state.plan.runs(Pass::filter) && state.linearFilter == nullptr) {
        auto made = device.createSampler({});
        if (!made) return tl::unexpected(made.error());
        state.linearFilter = std::move(*made);
    }
    return {};
}

Status Renderer::Parts::prepare(const RenderOptions& options, bool presents) {
    if (auto status = check(options, device.info()); !status) return status;
    const auto samples = chooseSamples(options, device.info());
    if (!samples) return tl::unexpected(samples.error());
    // Round strands are shaded a pixel at a time, which kernels do not do.
    const RenderOptions resolved = chooseWays(options, *samples, !state.scene.hasTubes(), device.info());
    changes.add(compare(state.options, resolved));
    if (newLights || resolved.shadowLights != state.options.shadowLights ||
        resolved.shadowResolution != state.options.shadowResolution ||
        layerCount(resolved) != layerCount(state.options)) {
        takeLights(state, lights, environment, shadowLightsOf(resolved, device.info()));
        newLights = false;
        changes.add(Changes::lights());
    }
    state.options = resolved;
    askedLayers = layerCount(options);
    state.samples = *samples;
    const HairDetail detail = detailOf(state);
    if (detail != state.detail) changes.add(Changes::geometry());
    state.detail = detail;
    const CloseHair closeHair = closeHairOf(state);
    if (closeHair != state.closeHair) changes.add(Changes::camera());
    state.closeHair = closeHair;
    const auto newTables = state.scene.prepareFibres(device, options.bakeBehind);
    if (!newTables) return tl::unexpected(newTables.error());
    if (*newTables) changes.add(Changes::looks());
    if (auto status = prepareTargets(presents); !status) return status;
    if (auto status = prepareHelpers(); !status) return status;
    if (resolved.ribbons == Ribbons::tessellated) {
        if (auto status = state.scene.preparePatches(device); !status) return status;
    }
    auto status = state.scene.prepareCurves(device, detail.subdivisions, state.plan.runs(Pass::shadowBlur),
                                            state.plan.runs(Pass::skySeen));
    if (status) {
        const auto isNew = state.scene.prepareAcross(device, state.plan.runs(Pass::across));
        if (!isNew) return tl::unexpected(isNew.error());
        if (*isNew) changes.add(Changes::camera());
    }
    return status && state.plan.runs(Pass::surface) ? state.scene.prepareSurface(device) : status;
}

std::vector<bool> Renderer::Parts::castingLights() const {
    std::vector<bool> casting(1, true);  // so that it is never empty
    for (const Light& light : state.lights) casting.push_back(light.castsShadow);
    return casting;
}

bool Renderer::Parts::recordChanges(gpu::CommandList& list) {
    state.scene.recordUploads(list);
    const bool holds = holdsMaps && mapped == castingLights();
    bool shadows = changes.shadows && !holds;
    const bool sky = changes.sky && !holds;
    if (shadows) {
        state.mapDetail = state.detail;
        fitViews(state, sky);
    }
    if (!holds && placeCloseMaps(state)) shadows = changes.shading = changes.picture = true;
    before.drawsMaps = shadows || sky;
    const bool grid = changes.grid && state.plan.runs(Pass::lightGrid) && (!holds || newGrid);
    if (grid) {
        placeLightGrid(state);
        changes.shading = changes.picture = true;
    }
    if (changes.shading) setUpLights(state);
    if (changes.curves && state.plan.runs(Pass::curves)) recordCurves(list, state);
    if (shadows) recordMaps(list, state, lightAtlas(state));
    if (sky) recordMaps(list, state, skyAtlas(state));
    if (changes.sky && state.plan.runs(Pass::skySeen)) recordSkySeen(list, state);
    if (shadows) mapped = castingLights();
    if (grid) recordLightGrid(list, state);
    newGrid = false;
    if (changes.shading && state.plan.runs(Pass::shade)) {
        recordShading(list, state);
        if (state.plan.runs(Pass::across)) recordAcross(list, state);
        if (state.plan.runs(Pass::shadowBlur)) withoutShadows([&] { recordShading(list, state); });
    }
    if ((changes.picture || state.options.temporal) && state.plan.runs(Pass::surface))
        recordSurface(list, state);
    if (changes.picture) accumulated = 0;
    const bool moves = changes.curves || changes.shadows || changes.grid || changes.shading;
    heldBack.grid |= holds && changes.grid && !grid;
    if (holds && changes.shadows) heldBack.add(changes.sky ? Changes::head() : Changes::lights());
    changes = Changes::placeholderTexture();
    return moves;
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
    if (auto status = p.prepare(options, target != nullptr); !status) return status;
    if (target != nullptr) {
        if (auto status = prepareDisplay(p.device, p.state); !status) return status;
    }
    if (auto status = prepareOverlay(p.device, list, p.state.overlay); !status) return status;
    if (!p.holdsMaps) p.changes.add(std::exchange(p.heldBack, Changes::placeholderTexture()));
    p.before = {p.changes, p.accumulated, p.mapped, p.state.closeViews};
    const bool moves = p.recordChanges(list);
    const bool blurs = p.state.plan.runs(Pass::shadowBlur);
    if (options.temporal) {
        recordFrame(list, p.state, p.state.temporal.frames);
        recordTemporal(list, p.state, moves);
        render::recordPast(list, p.state);
        p.accumulated = 1;
    } else if (p.accumulated < options.frames && !(p.holdsAverage && p.accumulated > 0)) {
        recordFrame(list, p.state, p.accumulated);
        if (blurs) p.withoutShadows([&] { recordFrame(list, p.state, p.accumulated); });
        ++p.accumulated;
        p.blurredBy = 0;
    }
    if (blurs && p.blurredBy != options.shadowBlur) recordShadowBlur(list, p.state);
    p.blurredBy = options.shadowBlur;
    if (target != nullptr) {
        recordPresent(list, p.state, p.accumulated, target);
        recordOverlay(list, p.state, target);
    }
    return p.state.pipelines.takeStatus();
}

void Renderer::takeBack() {
    Parts& p = *parts_;
    // Maps are then begun, and no longer what they were.
    if (p.before.drawsMaps) {
        p.before.mapped.clear();
        p.before.closeViews.clear();
    }
    p.state.closeViews = p.before.closeViews;
    p.changes.add(p.before.changes);
    p.accumulated = p.before.accumulated;
    p.mapped = p.before.mapped;
    p.blurredBy = 0;
    p.newGrid = true;
    p.state.temporal = {};
}

void Renderer::holdMaps(bool on) {
    parts_->holdsMaps = on;
}

void Renderer::holdAverage(bool on) {
    parts_->holdsAverage = on;
}

Status Renderer::recordPast(gpu::CommandList& list, const RenderOptions& options) {
    Parts& p = *parts_;
    RenderOptions with = options;
    with.surface = true;
    if (auto status = p.prepare(with, false); !status) return status;
    p.state.scene.recordUploads(list);
    if (p.changes.curves && p.state.plan.runs(Pass::curves)) recordCurves(list, p.state);
    render::recordPast(list, p.state);
    p.changes.picture = true;
    return p.state.pipelines.takeStatus();
}

int Renderer::displayError() const {
    const auto& view = parts_->state.display.of;
    return view ? view->displayTable().worst : 0;
}

std::uint32_t Renderer::accumulated() const {
    return parts_->changes.picture || parts_->newLights ? 0 : parts_->accumulated;
}

bool Renderer::isSettled() const {
    return !parts_->state.scene.awaitsFibres();
}

const gpu::BufferPtr& Renderer::linearSum() const {
    return parts_->state.result();
}

const gpu::BufferPtr& Renderer::surface() const {
    return parts_->state.targets[BufferId::surface];
}

const gpu::BufferPtr& Renderer::fragmentCounts() const {
    return parts_->state.targets[BufferId::fragmentCounts];
}

Box3f Renderer::bounds() const {
    return parts_->state.bounds();
}

std::uint64_t Renderer::triangles() const {
    return parts_->state.scene.triangles();
}

std::uint64_t Renderer::strands() const {
    std::uint64_t count = 0;
    for (const DrawBatch& batch : parts_->state.scene.batches)
        count += batch.strandCount(parts_->state.detail);
    return count;
}

std::uint64_t Renderer::curvePoints() const {
    const HairDetail& detail = parts_->state.detail;
    std::uint64_t count = 0;
    for (const DrawBatch& batch : parts_->state.scene.batches) {
        count += batch.curvePoints(batch.strandCount(detail), detail.subdivisions);
    }
    return count;
}

const RenderPlan& Renderer::plan() const {
    return parts_->state.plan;
}

}  // namespace hairloom::render
