// SPDX-License-Identifier: MIT
#pragma once
// A frame with poses inside as frames without: substeps take what moves straight on.

#include <cstdint>
#include <span>

#include "hairloom/memory.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Where everything is when a piece begins.
struct PieceStart {
    std::span<const RootFrame> roots_ws;  ///< one per strand; looked at only where startsWithin()
    std::span<const Sphere> spheres;
    std::span<const BonePose> body_ws;
};

/// Cuts a frame into runs of substeps in each of which everything goes straight. A substep that a pose falls
/// into is a run of its own, and goes straight to where the motion is at its end.
class FramePieces {
  public:
    /// Of a frame that takes so many substeps. Keeps its memory for the next one; `input` outlives the use of
    /// the pieces.
    void take(const FrameInput& input, std::uint32_t substeps);
    std::size_t count() const { return ends_.size(); }
    std::uint32_t substepsOf(std::size_t piece) const { return ends_[piece] - beginOf(piece); }
    /// Where the piece ends depends on where roots are as it begins.
    bool startsWithin(std::size_t piece) const;
    /// The frame of a piece. Its views live until the next call.
    FrameInput at(std::size_t piece, const PieceStart& start);
    /// What a piece goes towards: numbered poses, 0 the start of the frame and the last its end, and the
    /// share of the way there from `from`, or from the start of the piece where there is none.
    struct Aim {
        std::size_t from = 0, to = 0;
        float share = 1.0f;
    };
    /// For what follows the poses beside the frame's own views.
    Aim aimOf(std::size_t piece) const;
    /// Memory for pieces that begin between poses.
    void reserve(std::size_t roots, std::size_t bones);
    std::size_t bytes() const;

  private:
    std::uint32_t beginOf(std::size_t piece) const { return piece > 0 ? ends_[piece - 1] : 0; }
    std::size_t spans() const { return input_->inner.size() + 1; }
    /// The same for what the poses inside do not have.
    Aim straightAimOf(std::size_t piece) const;

    const FrameInput* input_ = nullptr;
    std::uint32_t substeps_ = 1;
    bool posesSpheres_ = false, posesBody_ = false;  ///< every pose inside does
    Vector<std::uint32_t> ends_;                     ///< substeps of the frame
    Vector<RootFrame> roots_;
    Vector<Sphere> spheres_;
    Vector<BonePose> body_;
};

}  // namespace hairloom::runtime
