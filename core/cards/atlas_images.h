// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an atlas holds, as pictures of 8 bits a channel.

#include <string>

#include "core/cards/texture.h"
#include "core/render/image.h"

namespace hairloom::cards {

struct AtlasImage {
    std::string name;  ///< "colour", "colour.1", "shape", "normal", "strand"
    render::Image image;
};

/// - colour: albedo in sRGB, coverage as alpha; colour.N are its mip maps, their alpha scaled so that as
/// large a
///   share of texels lies above Atlas::threshold at all levels
/// - shape: flow across and along (0.5 + 0.5 x), depth (0.5 + depth / 0.04 m), ambient occlusion as alpha
/// - normal: across, along, outwards (0.5 + 0.5 x)
/// - strand: root to tip, number of the strand, coverage
std::vector<AtlasImage> imagesOf(const Atlas& atlas);

/// Albedo and coverage of a level; alpha times `scale`.
render::Image colourImage(const Picture& picture, float scale);
render::Image normalImage(const Picture& picture);
/// Ambient occlusion in all channels.
render::Image occlusionImage(const Picture& picture);

}  // namespace hairloom::cards
