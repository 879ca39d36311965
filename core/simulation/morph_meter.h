// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far morph targets move the skin under hair, beside what moves its collider.

#include <memory>
#include <vector>

#include "core/simulation/motion.h"

namespace hairloom {

class MorphMeter {
  public:
    explicit MorphMeter(const Groom& groom);

    void add(const HeadPose& pose);

    /// Metres between a root on the skin as it is morphed and as it is at rest, before bones move both; the
    /// farthest of all roots and poses. The skin collider follows bones alone: it is off by as much there,
    /// out of the skin at rest and into it.
    struct Found {
        float farthest = 0, out = 0, in = 0;
    };
    /// All 0 where no morph target moved a root.
    const Found& found() const { return found_; }

  private:
    std::shared_ptr<const ScalpMesh> scalp_;
    std::vector<SurfacePoint> roots_;
    Found found_;
};

}  // namespace hairloom
