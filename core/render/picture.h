// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A picture of heads and strands without a window.

#include <string>
#include <vector>

#include "core/gpu/device.h"
#include "core/render/image.h"
#include "core/render/options.h"
#include "core/render/plan.h"
#include "core/render/scene.h"

namespace hairloom::render {

struct Picture {
    Image image;
    LinearImage linear;
    std::vector<SurfacePixel> surface;  ///< one a pixel, rows from the top, where the options have `surface`
    std::vector<gpu::PassTime> passes;  ///< those of one name added up over frames, in order of first use
    RenderPlan plan;
    std::string device;
    std::uint64_t triangles = 0;    ///< of the meshes
    std::uint64_t strands = 0;      ///< drawn
    std::uint64_t curvePoints = 0;  ///< after subdivision
};

/// Same scene, options and device: same bytes. An empty scene gives the background. Errors: sizes and options
/// out of range, indices or offsets outside the arrays, numbers that are not finite (the strand or vertex is
/// named), and whatever the device reports.
Result<Picture> renderPicture(gpu::Device& device, const RenderScene& scene, const RenderOptions& options);

/// The same with velocities since `past`: meshes and strands as they were a frame ago, and its camera.
Result<Picture> renderPicture(gpu::Device& device, const RenderScene& past, const RenderScene& scene,
                              const RenderOptions& options);

/// What a renderer of that device shows now, its average begun anew.
class Renderer;
Result<Picture> renderPicture(gpu::Device& device, Renderer& renderer, const RenderOptions& options);

}  // namespace hairloom::render
