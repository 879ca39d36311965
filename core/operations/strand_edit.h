// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The loop that every operation runs: over the strands it may touch, in parallel, with a random sequence of
// its own for each strand.

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/groom/file/fields.h"
#include "core/operations/skin_field.h"

namespace hairloom {

inline constexpr double kAnywhere = 1000;  ///< metres; largest coordinate that a setting may name

/// Which strands an operation reaches: those of a layer and a group whose root lies on the side of a plane
/// that `normal` points to. A normal of zero reaches all.
struct Region {
    Vec3f point = Vec3f::Zero();
    Vec3f normal = Vec3f::Zero();
    float fade = 0;
    std::uint64_t seed = 1;
    std::uint32_t layer = 0;  ///< of Groom::layers, counted from 1; 0 reaches all
    std::uint32_t group = 0;  ///< of Groom::groupNames, likewise
};
std::span<const Field<Region>> fieldsOf(const Region&);

/// One strand while it is edited.
struct StrandEdit {
    std::span<Vec3f> points;         ///< ≥ 2, root first
    std::span<const float> lengths;  ///< of the segments before the edit, metres
    /// Cosines of its turns before the edit (measureTurns()); less where the edit asks for more, unless it
    /// has Turns::asMade.
    std::span<float> turns;
    std::size_t index;
    std::uint32_t id;          ///< the strand's id attribute, else its index
    const Skin* skin;          ///< null without a scalp
    const SkinQuery* outside;  ///< the same for what keeps hair outside

    /// Its own random sequence; strands draw alike whatever their order.
    Random random(std::uint64_t seed) const { return Random(seed, id); }
    float totalLength() const;
    /// Out of the skin at its root; +Y without a skin.
    Vec3f outward() const { return skin ? skin->distanceAt(points[0]).outward : Vec3f(Vec3f::UnitY()); }
};

/// Which sharp turns an edit may leave: those that were there, or whatever it makes itself (curls, plaits,
/// waves at random, lengths that are cut), so that the push out of the skin alone may add none.
enum class Turns { asBefore, asMade };

struct EditOptions {
    /// Metres; strands nearer to the skin are pushed out after the edit, lengths kept. Negative: no such
    /// push.
    float clearance = -1.0f;
    Turns turns = Turns::asBefore;
    bool needsSkin = false;  ///< edits use StrandEdit::skin; it is there also without a clearance
    const std::atomic<bool>* cancelled = nullptr;  ///< once it is set, strands that are left stay as they are
};

/// Of the region, those that are neither frozen nor on a locked layer; ascending.
std::vector<std::uint32_t> strandsToEdit(const Groom& groom, const Region& region);

/// Runs the edit over every strand of the region that is neither frozen nor on a locked layer, then keeps it
/// out of the head and from folding (settle()). Returns the number of strands that changed; the positions
/// keep their version when none did.
std::size_t editStrands(Groom& groom, const Region& region, const EditOptions& options,
                        const std::function<void(StrandEdit&)>& edit);

/// A setting that operations have in common.
template <auto M>
constexpr auto clearanceField() {
    return field<M>("clearance", "m", 0, 0.1, "minimum distance from the skin");
}

/// Fails with the first setting that lies outside its range.
template <class S>
Status checkFields(std::string_view operation, const S& settings) {
    const auto problems = fieldsOutOfRange(settings);
    if (problems.empty()) return {};
    return tl::unexpected(errorOfWords(std::string(operation) + ": " + problems.front()));
}

}  // namespace hairloom
