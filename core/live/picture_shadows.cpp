// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/picture_shadows.h"

namespace hairloom {
namespace {

render::Shadows kindOf(ShadowKind kind) {
    switch (kind) {
        case ShadowKind::deepOpacity:
            return render::Shadows::deepOpacity;
        case ShadowKind::absorption:
            return render::Shadows::absorption;
        case ShadowKind::opacityMaps:
            return render::Shadows::opacityMaps;
        case ShadowKind::adaptive:
            return render::Shadows::adaptive;
        case ShadowKind::none:
            break;
    }
    return render::Shadows::none;
}

static_assert(static_cast<int>(ShadowFiltering::off) == static_cast<int>(render::ShadowFilter::off) &&
              static_cast<int>(ShadowFiltering::three) == static_cast<int>(render::ShadowFilter::three) &&
              static_cast<int>(ShadowFiltering::five) == static_cast<int>(render::ShadowFilter::five));
static_assert(static_cast<int>(ShadowLayerEnds::early) == static_cast<int>(render::LayerEnds::early) &&
              static_cast<int>(ShadowLayerEnds::linear) == static_cast<int>(render::LayerEnds::linear) &&
              static_cast<int>(ShadowLayerEnds::growing) == static_cast<int>(render::LayerEnds::growing));

}  // namespace

void takeShadows(const ShadowSettings& project, render::RenderOptions& options) {
    options.shadows = kindOf(project.kind);
    options.shadowFilter = static_cast<render::ShadowFilter>(project.filter);
    options.shadowResolution = project.resolution;
    options.shadowLayers = project.layers;
    options.layerEnds = static_cast<render::LayerEnds>(project.layerEnds);
    options.layerGrowth = project.layerGrowth;
    options.shadowSlices = project.slices;
    options.shadowNodes = project.nodes;
    options.headAbsorption = project.headAbsorption;
    options.shadowBlur = project.blur;
}

void takeShadows(const ShadowSettings& project, const ViewFile& view, render::RenderOptions& options) {
    takeShadows(project, options);
    options.shadows = view.shadows.value_or(options.shadows);
    options.shadowFilter = view.shadowFilter.value_or(options.shadowFilter);
    options.shadowResolution = view.shadowResolution.value_or(options.shadowResolution);
    options.shadowLayers = view.shadowLayers.value_or(options.shadowLayers);
    options.layerEnds = view.layerEnds.value_or(options.layerEnds);
    options.layerGrowth = view.layerGrowth.value_or(options.layerGrowth);
    options.shadowSlices = view.shadowSlices.value_or(options.shadowSlices);
    options.shadowNodes = view.shadowNodes.value_or(options.shadowNodes);
    options.headAbsorption = view.headAbsorption.value_or(options.headAbsorption);
    options.shadowBlur = view.shadowBlur.value_or(options.shadowBlur);
}

}  // namespace hairloom
