// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair on its way to the shape of other hair on the same head, as a person does it and as a script repeats
// it.

#include <string>
#include <vector>

#include "core/editing/command.h"
#include "core/editing/model.h"
#include "core/groom/groom.h"
#include "core/operations/mask.h"
#include "core/operations/script.h"

namespace hairloom {

struct BlendSettings {
    float weight = 0.5f;  ///< 0 … 1, share of the way to the other shape
    float reach = 0.02f;  ///< metres from a root within which hair of the other hairstyle counts
    Mask mask;            ///< where it acts
};
/// All but the mask.
std::span<const Field<BlendSettings>> fieldsOf(const BlendSettings&);

/// The shape that strands have where they grow as the other hair does.
struct OtherShape {
    std::vector<Vec3f> points;  ///< of all strands, in the groom's order
    std::size_t matched = 0;    ///< strands that other hair grows within reach of; the rest stays
    float farthest = 0;         ///< metres, of these, from the root to the nearest of the other hair
};

/// A strand takes the shape of the other strand whose root is in the same place (0.1 mm), or else the mean of
/// the three nearest, each turned as the skin is at its root and counting by one over its distance, with
/// their length. Kept out of the head. The same bits for any number of threads. Errors: no strands on either
/// side, none within reach.
Result<OtherShape> shapeOfOther(const Groom& groom, const Groom& other, float reach);

struct HairBlend {
    OtherShape shape;
    std::unique_ptr<editing::Command> command;  ///< null where that changes nothing
};
/// Puts a sculpt on top of the operators that makes that shape, with the settings' weight and mask. `other`
/// is a project or a file of strands. Errors: the file's, those of shapeOfOther(), a full stack, a mask that
/// cannot be.
Result<HairBlend> blendWithFile(const editing::Model& model, const std::string& path,
                                const BlendSettings& settings);

/// The operation "blend" of a script. Its record holds the file's absolute path, not the file.
ScriptExtension blendExtension();

}  // namespace hairloom
