// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A stroke while it is drawn.

#include <memory>

#include "core/editing/brush.h"
#include "core/editing/command.h"

namespace hairloom::editing {

class StrokeSession {
  public:
    /// `bounds` fit the model's strands and are kept so; without a head `skin` and `field` are null. All must
    /// outlive the session. Errors: an unknown tool, settings out of range, a tool that needs a head where
    /// there is none.
    static Result<std::unique_ptr<StrokeSession>> begin(Model& model, StrandBounds& bounds, const Skin* skin,
                                                        const SkinQuery* field, Stroke header);

    /// What changed; its strands are valid until the next call. Errors: values that are not finite or out of
    /// range; then nothing changes.
    Result<Change> dab(const Dab& dab);
    /// The command, already carried out, or null where nothing changed.
    std::unique_ptr<Command> finish(Change& change);
    /// Everything is as it was before the stroke; the change's strands are valid while this lives.
    Change cancel();

    const Stroke& stroke() const { return stroke_; }
    const BrushInfo& info() const { return brush_->info(); }

  private:
    StrokeSession(Model& model, StrandBounds& bounds, const Skin* skin, const SkinQuery* field, Stroke header,
                  std::unique_ptr<Brush> brush);
    Change run(const Dab& dab, bool isMirror);

    Stroke stroke_;
    StrokeTarget target_;
    std::unique_ptr<Brush> brush_;
    std::vector<std::uint32_t> touched_;  ///< by the last dab and its mirror image
    std::unique_ptr<Command> cancelled_;  ///< holds the strands of cancel()'s change
};

/// A dab's values are finite and in range.
Status checkDab(const Dab& dab);
/// 1 for each strand that tools may work on; see StrokeTarget.
std::vector<std::uint8_t> editableStrands(const Groom& groom);

}  // namespace hairloom::editing
