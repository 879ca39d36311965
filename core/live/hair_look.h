// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a groom's material means to the renderer.

#include "core/live/groom_scene.h"

namespace hairloom {

/// The one way from the authored HairMaterial to what the renderer draws by; members of the view come first.
///
/// | authored | StrandShading |
/// |---|---|
/// | rootRadius, tipScale, radiusVariation, rootOpacity, tipOpacity, tubes | the same |
/// | specular, shininess, scaleTiltDegrees | `primary…`, `secondary…`: Kajiya-Kay's two highlights |
/// | energy | `bounded`, also of Sadeghi's lobes |
/// | tipColour, colourVariation | `albedo`, `variation` |
/// | indexOfRefraction, roughnesses, scaleTiltDegrees, eccentricity, r…, tt…, trt… | `fibre.marschner` |
/// | caustic…, azimuthalSolver | `fibre.marschner` of Marschner |
/// | those, tints, ttAzimuthalWidth, glints | `fibre.sadeghi`, from the Marschner fibre of the same hair |
/// | colours, melanin, gradient, streaks, grey, dye, emission | `look`; even hair has none, but a fibre's
/// absorption |
///
/// Hair is uneven where it has other colours or pigment at the tip, streaks, white strands, dye, strands of
/// their own colour or melanin, random pigment or light of its own.
///
/// `ofStrands` is left empty.
StrandMaterials strandMaterials(const Groom& groom, const ViewFile& view);
/// Which of them each strand has; those that are hidden or on a layer that is are not drawn.
std::vector<std::uint32_t> materialsOfStrands(const Groom& groom);
/// Of follow hairs: that of their own guide.
std::vector<std::uint32_t> materialsOfFollowHairs(const Groom& groom, const FollowBindings& bindings);

/// What light in its fibres does, at the root; members of the view come first.
render::FibreMaterial fibreMaterial(const HairMaterial& authored, const FibreView& view);

/// Which attributes strands have in place of, or on top of, what their material says.
struct OwnOfStrands {
    bool colours = false;
    bool melanin = false;
};
/// What it is drawn by.
render::StrandShading strandShading(const HairMaterial& authored, const ViewFile& view,
                                    const OwnOfStrands& own = {});

/// The view's, or else the groom's.
render::ShadingModel shadingModel(const HairMaterial& authored, const FibreView& view);

/// Of the groom's own strands, by their materials, their roots at rest and the attributes `dye` and
/// `melanin`.
LookWeights weightsOfStrands(const Groom& groom);
/// Of follow hairs: by the material of their own guide, their own roots at rest, and dye and melanin of
/// the guides around them. Errors: hairs that cannot be evaluated.
Result<LookWeights> weightsOfFollowHairs(const Groom& groom, const FollowBindings& bindings);
/// The painted dye of the guides around each point of a follow hair; empty where none was painted.
std::vector<float> pointDyesOfFollowHairs(const Groom& groom, const FollowBindings& bindings);

/// Radii of all that is drawn, for RenderStrands::radii: what `strands` has, changed by what was painted, one
/// change a point (core/groom/point_width.h). Empty where nothing was.
std::vector<float> paintedRadii(const render::RenderStrands& strands, std::span<const float> changes);

}  // namespace hairloom
