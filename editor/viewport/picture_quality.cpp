// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/picture_quality.h"

#include <algorithm>

#include "core/live/picture_shadows.h"

namespace hairloom::editor {

render::RenderOptions stillOptions(const PictureQuality& quality, const ShadowSettings& shadows,
                                   const gpu::DeviceInfo& device) {
    render::RenderOptions options;
    options.samples = 1;
    for (const std::uint32_t count : device.sampleCounts) {
        if (count <= quality.samples) options.samples = std::max(options.samples, count);
    }
    options.frames = quality.frames;
    options.filter = quality.filter;
    options.transparency = quality.transparency;
    // Only kernels blend hair in its order.
    const bool sorted = quality.transparency == render::Transparency::sorted;
    if (!sorted && (device.tessellation || quality.ribbons != render::Ribbons::tessellated))
        options.ribbons = quality.ribbons;
    options.subdivisions = quality.subdivisions;
    takeShadows(shadows, options);
    return options;
}

}  // namespace hairloom::editor
