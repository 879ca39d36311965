// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The passes of a frame, in their order. Each records into an open command list and reads what RendererState
// has.

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

/// All that the passes of a frame read.
struct RendererState {
    Pipelines pipelines;
    DeviceScene scene;
    Camera camera;
    std::vector<Light> lights;
    Vec3f ambientSky, ambientGround, background;
    OverlayOnDevice overlay;
    RenderOptions options;
    std::uint32_t samples = 1;
    Targets targets;
    std::vector<LightView> lightViews;
    shaders::ShadeConstants shade;  ///< all but the material

    Box3f bounds() const;  ///< of all meshes and strands
};

/// Views from the lights, and the constants that follow from camera and lights.
void setUpLights(RendererState& state);
shaders::ShadeConstants shadeConstants(const RendererState& state, const HairMaterial& material);

void recordCurves(gpu::CommandList& list, RendererState& state);
void recordShadowMaps(gpu::CommandList& list, RendererState& state);
void recordShading(gpu::CommandList& list, RendererState& state);
/// One frame, moved by a part of a pixel, added to the sum.
void recordFrame(gpu::CommandList& list, RendererState& state, std::uint32_t number);
/// The average of `frames` frames, with exposure and tone curve.
void recordPresent(gpu::CommandList& list, RendererState& state, std::uint32_t frames,
                   const gpu::TexturePtr& target);
/// Makes room for the marks and uploads them when they have changed.
Status prepareOverlay(gpu::Device& device, gpu::CommandList& list, OverlayOnDevice& overlay);
void recordOverlay(gpu::CommandList& list, RendererState& state, const gpu::TexturePtr& target);

/// All triangles, with whatever pipeline is set.
void drawMeshes(gpu::CommandList& list, const RendererState& state);

/// Clip space of the camera with planes around `bounds_ws`, moved by parts of a pixel.
Mat4f cameraMatrix(const RendererState& state, const Box3f& bounds_ws, float jitterX = 0, float jitterY = 0);
shaders::float4x4 toShader(const Mat4f& m);
shaders::float4 toShader(const Vec3f& v, float w);

}  // namespace hairloom::render
