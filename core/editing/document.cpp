// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <string_view>
#include <utility>

#include "core/editing/stack_commands.h"
#include "core/groom/file/project_file.h"
#include "core/operations/script.h"
#include "core/operations/stack.h"

namespace hairloom::editing {

struct Document::Observers {
    std::uint64_t last = 0;
    std::map<std::uint64_t, Observer> list;
};

Document::Document(Groom groom) : observers_(std::make_shared<Observers>()) {
    model_.groom = std::move(groom);
    model_.stackCache = std::make_shared<StackCache>();
}

Document::~Document() = default;

Result<std::unique_ptr<Document>> Document::open(const std::filesystem::path& path) {
    auto groom = openProject(path);
    if (!groom) return tl::unexpected(groom.error());
    return std::make_unique<Document>(std::move(*groom));
}

Status Document::save(const std::filesystem::path& path) {
    if (auto saved = saveProject(model_.groom, path); !saved) return saved;
    savedState_ = history_.state();
    return {};
}

Subscription Document::observe(Observer observer) {
    const std::uint64_t key = ++observers_->last;
    observers_->list.emplace(key, std::move(observer));
    const std::weak_ptr<Observers> observers = observers_;
    return Subscription(std::shared_ptr<void>(nullptr, [observers, key](void*) {
        if (const auto there = observers.lock()) there->list.erase(key);
    }));
}

void Document::changed(const Change& change) {
    const bool anyStrand = contains(change.parts, Part::Points) && change.strands.empty();
    if (contains(change.parts, Part::Strands) || anyStrand) {
        boundsFit_ = false;
    } else if (boundsFit_ && contains(change.parts, Part::Points)) {
        bounds_.update(model_.groom, change.strands);
    }
    notify(change);
}

std::unique_ptr<Command> Document::asOneStep(std::unique_ptr<Command> done, std::unique_ptr<Command> also) {
    std::string name = done->name();
    std::vector<std::unique_ptr<Command>> steps;
    steps.push_back(std::move(done));
    steps.push_back(std::move(also));
    return std::make_unique<CommandGroup>(std::move(name), std::move(steps), true);
}

void Document::notify(const Change& change) {
    for (const auto& [key, observer] : observers_->list) observer(change);
}

void Document::perform(std::unique_ptr<Command> command, std::string record) {
    assert(!stroke_);
    if (!command) return;
    const Change change = carryOut(std::move(command), std::move(record));
    changed({change.parts | Part::History, change.strands});
}

Change Document::carryOut(std::unique_ptr<Command> command, std::string record) {
    if (record.empty()) record = command->record();
    Change change = command->exchange(model_);
    const bool comesOrGoes =
        contains(change.parts, Part::Strands) && !contains(change.parts, Part::Operators);
    if ((comesOrGoes && !model_.groom.operators.empty()) || maskChanged(change.parts)) {
        if (auto stack = stackAfterStrands(model_)) {
            change.parts = change.parts | stack->exchange(model_).parts;
            command = asOneStep(std::move(command), std::move(stack));
        }
    }
    history_.add(std::move(command), std::move(record));
    return change;
}

void Document::performMerged(std::uint64_t key,
                             const std::function<std::unique_ptr<Command>(const Model&)>& make) {
    assert(!stroke_ && key != 0);
    // Nothing may be left to redo: the step would be one that was taken up again, not the newest.
    const bool joins = key == mergeKey_ && history_.state() == mergeState_ && !history_.canRedo();
    Change change;
    if (joins) {
        change.parts = history_.undo(model_).parts;
        history_.dropUndone();
    }
    if (auto command = make(model_)) {
        const Change made = carryOut(std::move(command), {});
        change = {change.parts | made.parts, joins ? std::span<const std::uint32_t>() : made.strands};
        mergeKey_ = key;
        mergeState_ = history_.state();
    } else if (joins) {
        mergeKey_ = 0;  // the step before is another's
    } else {
        return;
    }
    changed({change.parts | Part::History, change.strands});
}

bool Document::undo() {
    if (!canUndo()) return false;
    const Change change = history_.undo(model_);
    changed({change.parts | Part::History, change.strands});
    return true;
}

bool Document::redo() {
    if (!canRedo()) return false;
    const Change change = history_.redo(model_);
    changed({change.parts | Part::History, change.strands});
    return true;
}

Status Document::beginStroke(Stroke header) {
    assert(!stroke_);
    const SkinQuery* field = skinField();
    bounds();
    auto session = StrokeSession::begin(model_, bounds_, skin(), field, std::move(header));
    if (!session) return tl::unexpected(session.error());
    stroke_ = std::move(*session);
    strokeStrands_ = model_.groom.strandCount();
    strokeTouched_.assign(strokeStrands_, 0);
    strokeParts_ = Part::None;
    return {};
}

Status Document::dab(const Dab& dab) {
    assert(stroke_);
    const auto change = stroke_->dab(dab);
    if (!change) return tl::unexpected(change.error());
    strokeTouched_.resize(std::max(strokeTouched_.size(), model_.groom.strandCount()), 0);
    for (const std::uint32_t s : change->strands) strokeTouched_[s] = 1;
    strokeParts_ = strokeParts_ | change->parts;
    if (change->parts == Part::None) return {};
    notify(*change);  // the session keeps the bounds
    return {};
}

Stroke Document::endStroke() {
    assert(stroke_);
    Change change;
    auto command = stroke_->finish(change);
    Stroke drawn = stroke_->stroke();
    const bool movesHair = stroke_->info().movesHair;
    const bool comesOrGoes = model_.groom.strandCount() != strokeStrands_;
    stroke_.reset();
    if (!command) return drawn;
    const bool rootsMoved = contains(strokeParts_, Part::Triangulation);
    const bool runsAgain = comesOrGoes || rootsMoved || maskChanged(strokeParts_);
    if (!model_.groom.operators.empty() && (movesHair || runsAgain)) {
        if (auto stack = runsAgain ? stackAfterStrands(model_) : stackAfterStroke(model_, strokeTouched())) {
            change.parts = change.parts | stack->exchange(model_).parts;
            change.strands = {};
            command = asOneStep(std::move(command), std::move(stack));
        }
    }
    history_.add(std::move(command), toJson(drawn).dump());
    changed({change.parts | Part::History, change.strands});
    return drawn;
}

bool Document::maskChanged(Part parts) const {
    return contains(parts, Part::Density | Part::Dye | Part::Masks) && readsMaps(model_.groom.operators);
}

std::vector<std::uint32_t> Document::strokeTouched() const {
    std::vector<std::uint32_t> strands;
    for (std::uint32_t s = 0; s < strokeTouched_.size(); ++s) {
        if (strokeTouched_[s]) strands.push_back(s);
    }
    return strands;
}

void Document::cancelStroke() {
    assert(stroke_);
    const Change change = stroke_->cancel();
    boundsFit_ = false;
    if (change.parts != Part::None) changed(change);
    stroke_.reset();
}

Result<std::size_t> Document::replay(const Stroke& stroke) {
    if (auto begun = beginStroke(stroke); !begun) return tl::unexpected(begun.error());
    for (const Dab& place : stroke.dabs) {
        if (auto done = dab(place); !done) {
            cancelStroke();
            return tl::unexpected(done.error());
        }
    }
    endStroke();
    return static_cast<std::size_t>(std::count(strokeTouched_.begin(), strokeTouched_.end(), 1));
}

Result<std::string> Document::script() const {
    if (history_.forgotten() > 0)
        return fail(fmt::format("the first {} steps are no longer in the undo history", history_.forgotten()),
                    "a larger undo limit");
    std::string operations;
    for (std::size_t i = 0; i < history_.doneCount(); ++i) {
        std::string_view record = history_.record(i);
        if (record.empty())
            return fail(fmt::format("step {}, '{}', has no record for a script", i + 1, history_.name(i)));
        // What takes several operations is an array of them.
        if (record.front() == '[') record = record.substr(1, record.size() - 2);
        operations += fmt::format("{}\n  {}", operations.empty() ? "" : ",", record);
    }
    return fmt::format("{{\n \"hairloom_script\": {},\n \"operations\": [{}\n ]\n}}\n", kScriptVersion,
                       operations);
}

const Skin* Document::skin() const {
    const SkinField* const field = skinField();
    return field ? &field->skin() : nullptr;
}

const SkinField* Document::skinField() const {
    const ScalpMesh* const known = skin_ ? &skin_->skin().mesh() : nullptr;
    if (known != model_.groom.scalp.get()) skin_ = sharedSkin(model_.groom.scalp);
    return skin_.get();
}

const StrandBounds& Document::bounds() const {
    if (!boundsFit_) bounds_.rebuild(model_.groom);
    boundsFit_ = true;
    return bounds_;
}

Groom Document::takeGroom() && {
    stroke_.reset();
    history_.clear();
    return std::move(model_.groom);
}

}  // namespace hairloom::editing
