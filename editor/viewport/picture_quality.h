// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How finely the viewport draws. Not part of the document, which has the shadows (ShadowSettings).

#include "core/groom/shadow_settings.h"
#include "core/render/fibre_material.h"
#include "core/render/options.h"

namespace hairloom::editor {

struct PictureQuality {
    /// A pixel and frame, as render::RenderOptions; more than the device has: its most.
    std::uint32_t samples = 4;
    std::uint32_t frames = 8;  ///< averaged when the picture is still, 1…256
    bool joinsFrames = true;   ///< while something moves: render::RenderOptions::temporal
    render::PostFilter filter = render::PostFilter::none;
    render::Transparency transparency = render::Transparency::automatic;
    /// Strips where the device cannot tessellate.
    render::Ribbons ribbons = render::Ribbons::automatic;
    std::uint32_t subdivisions = 2;  ///< curve segments per segment of a strand
    render::Scattering scattering = render::Scattering::volume;  ///< not of Kajiya-Kay

    bool operator==(const PictureQuality&) const = default;
};

/// Of a picture while nothing moves, with what the device can; size and exposure are the caller's.
render::RenderOptions stillOptions(const PictureQuality& quality, const ShadowSettings& shadows,
                                   const gpu::DeviceInfo& device);

}  // namespace hairloom::editor
