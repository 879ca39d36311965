// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/picture_quality.h"

#include <algorithm>

namespace hairloom::editor {

render::RenderOptions stillOptions(const PictureQuality& quality, const gpu::DeviceInfo& device) {
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
    options.shadows = quality.shadows;
    options.headAbsorption = quality.headAbsorption;
    options.shadowBlur = quality.shadowBlur;
    options.shadowFilter = quality.shadowFilter;
    options.shadowResolution = quality.shadowResolution;
    return options;
}

}  // namespace hairloom::editor
