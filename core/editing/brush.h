// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a brush is: a description, and what it does to one strand under one dab. docs/editing.md shows how to
// add one.

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/random.h"
#include "core/editing/brush_volume.h"
#include "core/editing/delta_command.h"
#include "core/editing/model.h"
#include "core/editing/strand_bounds.h"
#include "core/editing/stroke.h"
#include "core/geometry/scalp_mesh.h"
#include "core/operations/skin.h"

namespace hairloom::editing {

/// A number of one brush, Float or Bool, that BrushSettings::parameters has by its name.
struct BrushParameter : FieldInfo {
    float defaultValue;
};
constexpr BrushParameter parameter(const char* name, const char* unit, double min, double max,
                                   float defaultValue, const char* meaning) {
    return {{name, unit, min, max, meaning, FieldKind::Float}, defaultValue};
}
constexpr BrushParameter boolParameter(const char* name, bool defaultValue, const char* meaning) {
    return {{name, "", 0, 1, meaning, FieldKind::Bool}, defaultValue ? 1.0f : 0.0f};
}

/// The parameter that is the number of a painted mask, from 1.
inline constexpr const char* kMaskParameter = "mask";

struct BrushInfo {
    std::string_view name;          ///< in records: "comb"
    std::string_view label;         ///< for people: "Comb"
    std::string_view meaning;       ///< one sentence
    std::string_view tip;           ///< what dragging does: "Drag to comb hair along"
    std::string_view key = {};      ///< that takes it in hand at first, as "Shift+X"
    std::string_view inverse = {};  ///< what inverting makes of it, or empty where it makes nothing
    std::span<const BrushParameter> parameters = {};
    /// Segments get the lengths back that they had before each dab.
    bool keepsLengths = true;
    bool needsHead = false;
    /// Dabs take hair where the brush comes from, to carry it to where it is.
    bool drags = false;
    /// The brush itself leaves segments at their lengths.
    bool turnsSegments = false;
    /// Sharp turns are what it is for, as of curls.
    bool makesTurns = false;
    /// It goes down on the head as a ball; others reach along the view, to hair.
    bool worksOnSkin = false;
    /// What it moves must be kept out of the head.
    bool movesHair = true;
    int order = 300;  ///< in the tool bar, from 0: on the head, other tools from 30, on hair from 100
};

/// One dab as brushes see it.
struct DabContext {
    Dab dab;
    BrushVolume volume;
    Vec3f motion_ss = Vec3f::Zero();  ///< from the previous dab to this one; zero for the first
    Vec3f travel_ss = Vec3f::Zero();  ///< from the first dab to this one
    Dab previous;                     ///< this one for the first
    bool isFirst = true;
    std::uint64_t index = 0;  ///< of the dab in the stroke
    bool isMirror = false;    ///< the mirror image of a dab; previous and motions are mirrored too
    float sign = 1;           ///< −1 when inverted
};

/// One strand under one dab. Points from the root on.
struct StrandUnderBrush {
    std::span<Vec3f> points;         ///< to be moved; points[0] stays
    std::span<const Vec3f> atStart;  ///< as they were when the stroke began
    std::span<const float> weights;  ///< per point: falloff × profile × strength × pressure
    std::span<const float> lengths;  ///< of the segments before this dab, metres
    std::size_t first;               ///< first point with a weight, ≥ 1
    float strongest;                 ///< greatest weight
    std::uint32_t index;
    std::uint32_t id;            ///< its id attribute, else its index
    std::uint32_t rootTriangle;  ///< of `head`
    Vec3f rootBarycentric;
    const ScalpMesh* head;  ///< null for unbound hair

    const SkinQuery* skin;  ///< null without a head, or where collisions are off

    /// Out of the skin at its root; +Y for unbound hair.
    Vec3f rootNormal_ss() const {
        return head ? head->normalAt(rootTriangle, rootBarycentric) : Vec3f(Vec3f::UnitY());
    }

    Random random(std::uint64_t seed) const { return Random(seed, id); }
    /// Turns each segment by its weight towards its direction in `shape`, which has as many points.
    void turnTowards(std::span<const Vec3f> shape);
    /// Moves points by `offset` times their weight; what hangs on them towards the tip is carried along, so
    /// that hair bends on the brush's root side only.
    void carry(std::span<const Vec3f> from, const Vec3f& offset) {
        float weight = 0;
        for (std::size_t i = first; i < points.size(); ++i) {
            weight = std::max(weight, weights[i]);
            points[i] = from[i] + weight * offset;
        }
    }
};

/// What a stroke works on, and what it has changed so far.
struct StrokeTarget {
    Model& model;
    StrandBounds& bounds;
    const SkinQuery* skin;       ///< null without a head
    const SurfaceTree* surface;  ///< null without a head
    const BrushSettings& settings;
    /// Per strand that was there at the beginning, 1 where brushes may work: not frozen, hidden or on a layer
    /// that is locked or invisible, and selected where any is.
    std::vector<std::uint8_t> editable;

    Deltas changes;
    std::vector<std::uint32_t> touched;  ///< by the last dab, ascending

    Groom& groom() const { return model.groom; }
    float parameter(const BrushInfo& info, std::string_view name) const;
};

/// The instance lives for one stroke and may remember.
class Brush {
  public:
    Brush() = default;
    Brush(const Brush&) = delete;
    Brush& operator=(const Brush&) = delete;
    virtual ~Brush() = default;

    virtual const BrushInfo& info() const = 0;
    /// Before the first dab.
    virtual void begin(StrokeTarget&) {}
    /// Does the work of one dab and says what changed, with the target's `touched`.
    virtual Change dab(StrokeTarget& target, const DabContext& dab) = 0;
    /// Does what waits for the end of the stroke.
    virtual Change finish(StrokeTarget&) { return {}; }
};

/// What a file of brushes/ makes known of its brush.
struct BrushEntry {
    const BrushInfo* info;
    std::unique_ptr<Brush> (*make)();
};
template <class B>
BrushEntry brushEntry(const BrushInfo& info) {
    return {&info, []() -> std::unique_ptr<Brush> { return std::make_unique<B>(); }};
}

/// The strands that a dab reaches, with the weight of each of their points.
struct Reached {
    std::vector<std::uint32_t> strands;  ///< ascending
    std::vector<std::uint32_t> begins;   ///< strand k has the weights from begins[k] on
    std::vector<float> weights;
};

/// A brush that moves points of strands: the loop over them, lengths, the skin and what undo needs are here.
class StrandBrush : public Brush {
  public:
    Change dab(StrokeTarget& target, const DabContext& dab) override;

  protected:
    Reached reach(const StrokeTarget& target, const DabContext& dab) const;
    /// Before the strands of a dab; not parallel.
    virtual void beginDab(const StrokeTarget&, const DabContext&) {}
    /// After that, what the dab reaches; not parallel.
    virtual void beginStrands(const StrokeTarget&, const Reached&) {}
    /// Moves points. Strands run in parallel, so nothing else may be written. False: left as it was.
    virtual bool edit(const DabContext& dab, StrandUnderBrush& strand) const = 0;

    /// Whether the strands of the first dab, with their weights there, serve the whole stroke.
    virtual bool holdsOn() const { return false; }
    /// Strands that might be reached by what their boxes tell; ascending.
    virtual std::vector<std::uint32_t> mayReach(const DabContext& dab, const StrandBounds& bounds) const;
    /// Fills in the weights (as many as points, that of the root 0) and returns the greatest; 0 leaves the
    /// strand alone. Unless overridden, a point weighs by the distance of the nearest of itself and the
    /// middles of its segments, so that thin brushes find long segments.
    virtual float weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                        std::span<float> weights) const;

  private:
    void editReached(StrokeTarget& target, const DabContext& dab, const Reached& reached);

    Reached held_[2];  ///< of the first dab, and of its mirror image
};

}  // namespace hairloom::editing
