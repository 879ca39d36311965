// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recorded motion as the clip of a runtime asset (docs/formats/runtime.md).

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "exporters/asset_builder.h"
#include "exporters/prepared_strands.h"
#include "hairloom/asset.h"

namespace hairloom {

struct AssetClip {
    asset::Clip record{};  ///< its name is the caller's to put into the text
    std::vector<std::uint32_t> places;
    std::vector<std::byte> frames;
};

/// The frames of `clip`, of the strands that are written. `plain` is the asset without a clip,
/// `scalpVertices` the groom's of its own. Errors: frames that cannot be had, of other strands or too far
/// away; more than 4 GiB.
Result<AssetClip> encodeClip(const ClipToWrite& clip, const PreparedStrands& strands, const Groom& groom,
                             const runtime::Asset& plain, std::span<const std::uint32_t> scalpVertices,
                             const WorkWatch& watch);

/// Plays the asset's clip by the library as a game does, frame after frame, and measures how far points
/// behind their roots are from the frames; metres. Errors: those of frames, and what the library refuses.
Result<double> playedClipError(const ClipToWrite& clip, const PreparedStrands& strands, const Groom& groom,
                               std::span<const std::byte> file, std::span<const std::uint32_t> scalpVertices,
                               const WorkWatch& watch);

}  // namespace hairloom
