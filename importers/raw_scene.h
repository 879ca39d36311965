// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A scene as a file has it, before repair: what every mesh reader makes.

#include <string>
#include <vector>

#include "core/animation/clip.h"
#include "core/animation/skinning.h"
#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// Lengths are in the file's unit until scaleLengths(); Y is up.
struct RawScene {
    PolygonSoup soup;
    std::vector<Bone> bones;
    std::vector<Clip> clips;
    SkinWeights skin;                 ///< per position of the soup, or empty
    std::vector<MorphTarget> morphs;  ///< of the soup's positions; those that clips move
    std::vector<std::string> warnings;
    float metresPerUnit = 0;  ///< as the file states it; 0 where it states none
    /// What the format takes for the unit where the file states none; 0 where it takes nothing.
    float assumedMetresPerUnit = 0;
    bool statesUp = false;  ///< the file says which axis is up
};

/// Multiplies every length: positions, translations of bones and of clips.
void scaleLengths(RawScene& scene, float factor);

/// Errors: an index or count that does not fit, a value that is not finite, no face. What passes is safe to
/// use.
Status validate(const RawScene& scene);

}  // namespace hairloom
