// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands and faces within an outline on the screen.

#include <span>
#include <vector>

#include "core/editing/picking.h"

namespace hairloom::editing {

/// A closed outline in pixels; even-odd where it crosses itself.
class ScreenRegion {
  public:
    static ScreenRegion box(const Vec2f& a_px, const Vec2f& b_px);
    /// Fewer than three corners hold nothing.
    static ScreenRegion lasso(std::vector<Vec2f> corners_px);
    bool contains(const Vec2f& px) const;
    const std::vector<Vec2f>& corners_px() const { return corners_; }

  private:
    std::vector<Vec2f> corners_;
    Vec2f low_ = Vec2f::Zero();
    Vec2f high_ = Vec2f::Zero();
};

struct RegionOptions {
    StrandPart part = StrandPart::Any;  ///< which part of a strand must be inside; Any: any of its points
    bool throughHead = false;           ///< what the head covers counts too
};

/// Ascending. Strands that are not shown are not there. `surface` may be null.
std::vector<std::uint32_t> strandsIn(const ScreenRegion& region, const Groom& groom,
                                     const SurfaceTree* surface, const View& view,
                                     const RegionOptions& options = {});

/// Ascending; faces whose middle is inside. Without `throughHead`, those only that face the view and are not
/// covered.
FaceSet facesIn(const ScreenRegion& region, const ScalpMesh& mesh, const SurfaceTree& surface,
                const View& view, bool throughHead = false);

}  // namespace hairloom::editing
