// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The passes of a frame, in their order. Each records into an open command list and reads what RendererState
// has.

#include <array>
#include <initializer_list>
#include <optional>

#include "core/render/close_maps.h"
#include "core/render/device_scene.h"
#include "core/render/options.h"
#include "core/render/overlay.h"
#include "core/render/pipelines.h"
#include "core/render/targets.h"

namespace hairloom::render {

/// Marks on the device: one buffer for all batches.
struct OverlayOnDevice {
    Overlay overlay;
    Box3f bounds_ws;
    gpu::BufferPtr vertices;
    bool waits = false;  ///< for its upload

    bool empty() const { return overlay.batches.empty(); }
    bool needsDepth() const;
};

/// The view of a colour config on the device, where the options have one.
struct DisplayOnDevice {
    std::shared_ptr<const ColourTransform> of;
    gpu::BufferPtr codes;  ///< of its table
};

/// Cells that light between hairs is followed in, and what follows it.
struct LightGridPlace {
    Vec3f origin_ws = Vec3f::Zero();  ///< lower corner
    float side = 0;                   ///< metres, of a cell; 0: there is no grid
    std::array<std::uint32_t, 3> size{};
    std::uint32_t photons = 0;
    float power = 0;                         ///< irradiance times m², of each
    std::array<std::uint32_t, 20> before{};  ///< photons before those of each light, then of the sky
};

/// All that the passes of a frame read.
struct RendererState {
    explicit RendererState(gpu::Device& device)
        : pipelines(device), onCpu(device.info().type == gpu::DeviceType::Cpu) {}

    Pipelines pipelines;
    DeviceScene scene;
    Camera camera;
    std::optional<Camera> pastCamera;  ///< a frame ago, where places of then are known
    std::vector<Light> lights;         ///< that are drawn, directional ones and points
    Environment environment;           ///< the rest
    Vec3f background = Vec3f::Zero();
    OverlayOnDevice overlay;
    DisplayOnDevice display;
    RenderOptions options;
    std::uint32_t samples = 1;
    HairDetail detail;
    HairDetail mapDetail;  ///< of the hair that shadow maps hold
    /// Ends of three deep opacity layers in place of those of the options, as parts of the depth that hair
    /// takes up; for measurements.
    std::optional<std::array<float, 3>> deepLayers;
    RenderPlan plan;
    struct {
        std::uint32_t frames = 0;  ///< that have joined; 0: nothing is known of one before
        bool turn = false;         ///< BufferId::history is that before
    } temporal;
    /// What is recorded is without shadows, for Pass::shadowBlur.
    bool lit = false;
    bool onCpu;  ///< the device is a software rasteriser
    Targets targets;
    gpu::TexturePtr placeholderTexture;  ///< one pixel, bound where a texture is not there
    gpu::BufferPtr placeholderBuffer;    ///< bound where a buffer of words is not there
    gpu::BufferPtr noSky;                ///< bound where no point has seen the sky
    gpu::BufferPtr noColour;             ///< bound where there is no grid of light
    gpu::SamplerPtr linearFilter;        ///< once a filter was asked for
    std::vector<LightView> lightViews;
    CloseHair closeHair;
    std::vector<LightView> closeViews;  ///< parts of those of the first lights that cast shadows
    std::vector<LightView> skyViews;    ///< where the plan has maps of the sky
    shaders::ShadeConstants shade{};    ///< all but the material
    shaders::SkyConstants sky{};
    LightGridPlace lightGrid;

    Box3f bounds() const;  ///< of all meshes and strands
    /// Where the light of a batch's curve points is, with shadows or without.
    const gpu::BufferPtr& colourOf(const DrawBatch& batch) const {
        return lit ? batch.litColour : batch.colour;
    }
    /// And what of it changes over their width, where the plan asks for it.
    const gpu::BufferPtr& acrossOf(const DrawBatch& batch) const {
        return plan.runs(Pass::across) ? batch.across : placeholderBuffer;
    }
    /// Where frames add up, with shadows or without.
    const gpu::BufferPtr& frames() const { return targets[lit ? BufferId::litSum : BufferId::sum]; }
    /// What is shown: the sum of frames, or that with blurred shadows.
    const gpu::BufferPtr& result() const {
        if (plan.runs(Pass::temporal))
            return targets[temporal.turn ? BufferId::history : BufferId::otherHistory];
        return targets[plan.runs(Pass::shadowBlur) ? BufferId::blurred : BufferId::sum];
    }
    const gpu::TexturePtr& orPlaceholder(TargetId id) const {
        return targets[id] ? targets[id] : placeholderTexture;
    }
    const gpu::BufferPtr& orPlaceholder(BufferId id) const {
        return targets[id] ? targets[id] : placeholderBuffer;
    }
};

/// What is bound where a scene has nothing of the kind; made once.
Status preparePlaceholders(gpu::Device& device, RendererState& state);
/// Takes what is drawn of a scene's lights.
void takeLights(RendererState& state, std::span<const Light> lights, const Environment& environment,
                std::uint32_t shadowLights);
/// The constants that follow from camera and lights.
void setUpLights(RendererState& state);
shaders::ShadeConstants shadeConstants(const RendererState& state, const StrandShading& material);
/// Those of RendererState::shade, without shadows where it says so.
shaders::ShadeConstants lightsOfFrame(const RendererState& state);
shaders::LookConstants lookConstants(const shading::StrandLook& look);

void recordCurves(gpu::CommandList& list, RendererState& state);
/// What each curve point sees of light from around.
void recordSkySeen(gpu::CommandList& list, RendererState& state);
void recordShading(gpu::CommandList& list, RendererState& state);
/// Light over the width of hair, from that of its mean, which recordShading() finds.
void recordAcross(gpu::CommandList& list, RendererState& state);
/// What is nearest in each pixel.
void recordSurface(gpu::CommandList& list, RendererState& state);
/// The frame joins those before it; `moves`: something is not as it was in them.
void recordTemporal(gpu::CommandList& list, RendererState& state, bool moves);
/// Takes curves and head as they are for those of a frame ago; outside a pass.
void recordPast(gpu::CommandList& list, RendererState& state);
/// Head and hair in the samples of a frame, by kernels; then added to the sum.
void recordRasterised(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
                      std::uint32_t number);
/// One frame, moved by a part of a pixel, added to the sum.
void recordFrame(gpu::CommandList& list, RendererState& state, std::uint32_t number);
/// The sum of frames with shadows that are blurred on the screen.
void recordShadowBlur(gpu::CommandList& list, RendererState& state);
/// Makes the table of the options' view when it has changed.
Status prepareDisplay(gpu::Device& device, RendererState& state);
/// The average of `frames` frames, with exposure and tone curve, or by the options' view.
void recordPresent(gpu::CommandList& list, RendererState& state, std::uint32_t frames,
                   const gpu::TexturePtr& target);
/// Makes room for the marks and uploads them when they have changed.
Status prepareOverlay(gpu::Device& device, gpu::CommandList& list, OverlayOnDevice& overlay);
void recordOverlay(gpu::CommandList& list, RendererState& state, const gpu::TexturePtr& target);

/// All triangles, or only those of matte meshes or the others, with whatever pipeline is set.
void drawMeshes(gpu::CommandList& list, const RendererState& state, std::optional<bool> matte = {});
/// All strands, or a share of them by chance, by the kernel that is set, whose other registers are bound:
/// `raster` says where to.
void dispatchStrands(gpu::CommandList& list, const RendererState& state, shaders::RasterConstants raster,
                     float share = 1);
/// A mesh by the kernel that is set, whose other registers are bound.
void dispatchTriangles(gpu::CommandList& list, const RendererState& state, const MeshOnDevice& mesh,
                       shaders::RasterConstants raster);
/// A thread for each point of a batch's curves, by the kernel that is set and writes `target`.
void dispatchCurvePoints(gpu::CommandList& list, const RendererState& state, const DrawBatch& batch,
                         shaders::ShadeConstants constants, const gpu::BufferPtr& target);
void fill(gpu::CommandList& list, RendererState& state, BufferId buffer, std::uint32_t value);
/// Groups of so many threads that it takes for `threads`.
constexpr std::uint32_t groupsFor(std::uint32_t threads, std::uint32_t group) {
    return (threads + group - 1) / group;
}
/// A thread for each of `count`, in groups of HAIRLOOM_LIST_GROUP: devices take no more than 65,535 groups in
/// a row.
struct Rows {
    explicit Rows(std::uint64_t count);
    std::uint32_t groups = 1;  ///< in a row
    std::uint32_t rows = 1;
    std::uint32_t threads() const;  ///< in a row
};
shaders::ViewConstants viewConstants(const RendererState& state, const Mat4f& clipFromWorld,
                                     std::uint32_t number);
/// How the skin of a mesh looks.
shaders::MeshConstants meshConstants(const Mat4f& clipFromWorld, bool matte);
void bind(gpu::CommandList& list, std::initializer_list<gpu::Binding> bindings);
/// Maps of the lights and of the sky.
void bindShadows(gpu::CommandList& list, const RendererState& state);

/// What the camera's distance and the options ask for.
HairDetail detailOf(const RendererState& state);

/// Clip space of the camera with planes around `bounds_ws`, moved by parts of a pixel.
Mat4f cameraMatrix(const RendererState& state, const Box3f& bounds_ws, float jitterX = 0, float jitterY = 0);
/// The same of the camera a frame ago.
Mat4f pastCameraMatrix(const RendererState& state);
shaders::float4x4 toShader(const Mat4f& m);
shaders::float4 toShader(const Vec3f& v, float w);
/// The eye as ViewConstants and ShadeConstants have it: a place, or a direction without perspective.
shaders::float4 eyeOf(const Camera& camera);

}  // namespace hairloom::render
