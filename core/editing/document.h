// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The document that an editor shows and commands change: a model, its history, who watches it, and what is
// derived from it for tools. One thread at a time; copies of groom() may be read on any.

#include <filesystem>
#include <functional>
#include <memory>

#include "core/editing/history.h"
#include "core/editing/strand_bounds.h"
#include "core/editing/stroke_session.h"
#include "core/operations/skin_field.h"

namespace hairloom::editing {

/// Ends an observation when it is destroyed; may outlive the document.
class Subscription {
  public:
    Subscription() = default;
    explicit Subscription(std::shared_ptr<void> token) : token_(std::move(token)) {}

  private:
    std::shared_ptr<void> token_;
};

class Document {
  public:
    explicit Document(Groom groom = {});
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;
    ~Document();

    /// Errors: as openProject() and saveProject().
    static Result<std::unique_ptr<Document>> open(const std::filesystem::path& path);
    Status save(const std::filesystem::path& path);
    /// What was groom() at this state() has been saved by somebody else's hand.
    std::uint64_t state() const { return history_.state(); }
    void noteSaved(std::uint64_t state) { savedState_ = state; }
    /// There is something that the last save() or open() does not have.
    bool isModified() const { return history_.state() != savedState_; }

    const Model& model() const { return model_; }
    /// Copying it is cheap, but the next stroke pays for parting from a copy that is still held (19 MB for
    /// 100,000 strands of 16 points): watch changes rather than hold copies.
    const Groom& groom() const { return model_.groom; }
    const History& history() const { return history_; }
    void setHistoryLimit(std::size_t bytes) { history_.setLimit(bytes); }

    /// Called after every change, in the order of subscription. Observers must not change the document.
    using Observer = std::function<void(const Change&)>;
    [[nodiscard]] Subscription observe(Observer observer);

    /// Carries a command out and remembers it; null does nothing. `record`: the operation of a script that
    /// does the same, where the command knows none. Not during a stroke.
    void perform(std::unique_ptr<Command> command, std::string record = {});
    /// Carries out what `make` gives for the model. Steps that follow each other with the same key become one
    /// that leads from before the first to after the last, or none where that is where it began: a slider
    /// that is dragged. Not during a stroke; a key is not 0.
    void performMerged(std::uint64_t key, const std::function<std::unique_ptr<Command>(const Model&)>& make);
    bool canUndo() const { return !stroke_ && history_.canUndo(); }
    bool canRedo() const { return !stroke_ && history_.canRedo(); }
    /// False where nothing was done.
    bool undo();
    bool redo();

    /// One stroke at a time. Errors: as StrokeSession.
    Status beginStroke(Stroke header);
    Status dab(const Dab& dab);
    /// The stroke with its dabs. It is one step of the history, or none where nothing changed.
    Stroke endStroke();
    void cancelStroke();
    const StrokeSession* stroke() const { return stroke_.get(); }
    /// A whole stroke, as recorded. On error nothing has changed. Returns the number of strands touched.
    Result<std::size_t> replay(const Stroke& stroke);

    /// The records of all steps that are done, as a script that makes the same of the document as it was
    /// opened. Error: steps without a record, or forgotten ones.
    Result<std::string> script() const;

    /// Derived, made when first asked for. Null without a head; valid until the head changes.
    const SurfaceTree* surface() const { return skin() ? &skin()->tree() : nullptr; }
    const Skin* skin() const;
    const SkinField* skinField() const;
    /// Always fits groom().
    const StrandBounds& bounds() const;

    /// The head's skin where it has been made: another document of the same head shares it while it is held.
    std::shared_ptr<const SkinField> heldSkin() const { return skin_; }
    /// Ends the document and gives its groom.
    Groom takeGroom() &&;

  private:
    void changed(const Change& change);  ///< renews what is derived, then notifies
    void notify(const Change& change);
    Change carryOut(std::unique_ptr<Command> command, std::string record);
    /// Two that have been carried out.
    static std::unique_ptr<Command> asOneStep(std::unique_ptr<Command> done, std::unique_ptr<Command> also);
    /// These parts hold what a mask of the operators shows.
    bool maskChanged(Part parts) const;
    std::vector<std::uint32_t> strokeTouched() const;

    Model model_;
    History history_;
    std::uint64_t savedState_ = 0;
    std::uint64_t mergeKey_ = 0;    ///< of the step below
    std::uint64_t mergeState_ = 0;  ///< state of the history that a step of that key led to
    std::unique_ptr<StrokeSession> stroke_;
    std::size_t strokeStrands_ = 0;            ///< strands when the stroke began
    Part strokeParts_ = Part::None;            ///< that its dabs changed
    std::vector<std::uint8_t> strokeTouched_;  ///< per strand, 1 for those that this stroke touched
    struct Observers;
    std::shared_ptr<Observers> observers_;
    mutable std::shared_ptr<const SkinField> skin_;
    mutable StrandBounds bounds_;
    mutable bool boundsFit_ = false;
};

}  // namespace hairloom::editing
