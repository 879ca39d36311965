// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A groom as the renderer takes it.

#include <optional>
#include <string>
#include <vector>

#include "core/groom/groom.h"
#include "core/interpolation/strand_follow.h"
#include "core/live/view_file.h"
#include "core/render/picture.h"
#include "core/simulation/motion.h"
#include "hairloom/body_push.h"

namespace hairloom {

/// The hairstyle's material, and those of layers that have one of their own.
struct StrandMaterials {
    render::StrandShading material;
    std::vector<render::StrandShading> others;
    std::vector<std::uint32_t> ofStrands;  ///< that are drawn, as RenderStrands::materials; empty: `material`

    bool hasLook() const;
};

/// What of streaks, dye and pigment each strand that is drawn has; empty: none of the first two, 1 of the
/// last.
struct LookWeights {
    std::vector<float> streaks;
    std::vector<float> dyes;
    std::vector<float> pointDyes;  ///< one a point, shares of that; empty: nothing was painted
    std::vector<float> pigments;   ///< as RenderStrands has them, and lengths
    std::vector<float> lengths;
};

/// Whether scenes of the two draw the same hairs, one for one, on the same head: points, widths and materials
/// may differ.
bool drawSameHairs(const Groom& a, const Groom& b);

/// Owns the arrays that a RenderScene looks at.
class GroomScene {
  public:
    /// The groom at rest. Follow hairs are made where the groom asks for some. Groups of the head are hidden
    /// as facesOfGroups names them.
    static Result<GroomScene> make(const Groom& groom, const ViewFile& view,
                                   const std::vector<std::string>& hiddenGroups);

    /// Moves it to where a frame of a simulation of the same groom has it; points in the groom's order, with
    /// their velocities in m/s, by which wisps widen, or none.
    void pose(std::span<const Vec3f> positions_ws, std::span<const Vec3f> velocities_ws,
              const HeadPose& pose);
    /// Puts the points of some strands elsewhere, one strand after the other. The rest stays. Follow hairs
    /// follow with the guides and weights that they have (isBindingOld()). False, and nothing changed, where
    /// a root of a guide moves: its hairs take make() again.
    bool moveStrands(std::span<const std::uint32_t> strands, std::span<const Vec3f> points_ws);
    /// Guides have moved since follow hairs were bound to them. make() would bind some of them otherwise: at
    /// partings, which depend on where guides point, and guides of another length.
    bool isBindingOld() const { return bindingOld_; }

    /// The materials of another version of the same strands on the same layers, and the skin below, which has
    /// some of the hair's colour. False, and nothing changed, where it takes make() anew: the share of
    /// streaks and dye that each strand has, a layer that gets or loses a material of its own.
    bool setMaterials(const Groom& groom, const ViewFile& view);

    /// The painted dye of another version of the same strands. False where it takes make() anew: nothing was
    /// painted before or is now.
    bool setDye(const Groom& groom);

    /// The painted widths of another version of the same strands. False where it takes make() anew: nothing
    /// was painted before or is now.
    bool setWidths(const Groom& groom);
    /// Radii follow from what was painted, and change with the material.
    bool hasPaintedWidths() const { return !widthChanges_.empty(); }

    /// Meshes and strands; camera and lights are the caller's. Valid while this object lives and is not
    /// moved.
    render::RenderScene scene() const;
    const Groom& rest() const { return rest_; }
    /// Of the follow hairs that are drawn; null where the strands themselves are.
    const StrandFollow* follow() const { return follow_ ? &*follow_ : nullptr; }
    /// Leads what is drawn out of the groom's body; null without one.
    const runtime::BodyPush* bodyPush() const { return push_ ? &*push_ : nullptr; }

    /// What a picture should show: the hair, and below it enough of the head; all of the mesh that is drawn
    /// where there is no hair.
    Box3f subject() const;

  private:
    /// What was painted of the groom at rest, and the radii that come of it.
    void takeWidths();
    void makeRadii();
    void makeFollowHairs(std::span<const Vec3f> velocities_ws, const HeadPose& pose);

    Groom rest_;
    Groom posed_;
    // Where the groom asks for follow hairs.
    std::optional<FollowBindings> bindings_;
    std::optional<StrandFollow> follow_;
    std::optional<runtime::FollowHairs> followHairs_;
    std::optional<runtime::BodyPush> push_;  ///< of what is drawn, where the groom has a body
    std::vector<std::uint32_t> indices_;     ///< of the head's triangles that are drawn
    std::vector<Vec3f> vertexAlbedo_;        ///< of the head: skin, tinted by hair where that grows
    std::vector<float> tint_;                ///< how much, where no view says what the head is
    std::vector<std::uint32_t>
        hairOffsets_;  ///< of follow hairs; empty where the strands themselves are drawn
    std::vector<Vec3f> hairPositions_ws_;
    StrandMaterials materials_;
    LookWeights weights_;              ///< of what is drawn, where the material has a look
    std::vector<float> widthChanges_;  ///< one a point of what is drawn; empty: none was painted
    std::vector<float> radii_;         ///< of all that is drawn, where there are changes
    render::Clumping clumping_;
    bool bindingOld_ = false;
    bool matte_ = false;  ///< the head, where a view says what it is
};

}  // namespace hairloom
