// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/autosave.h"

#include <QCoreApplication>
#include <algorithm>
#include <utility>

#include "core/base/write_rules.h"
#include "core/editing/document.h"
#include "core/groom/file/project_file.h"
#include "editor/document/words.h"

namespace hairloom::editor {
namespace {

/// Between the first change and the copy, as a share of what may be lost: writing takes time, too.
constexpr double kShareOfInterval = 0.75;
constexpr int kMinute_ms = 60'000, kRetry_ms = 10'000;

}  // namespace

Autosave::Autosave(QtDocument& document, const Preferences& preferences, QObject* parent)
    : QObject(parent), document_(document), preferences_(preferences) {
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, &Autosave::saveNow);
    connect(&document_, &QtDocument::changed, this, &Autosave::changed);
    connect(&document_, &QtDocument::titleChanged, this, [this] {
        // A recovered document is unsaved without having been changed.
        if (hasUnsaved() && !dirty_) changed();
        noteUnsaved();
    });
    connect(&document_, &QtDocument::strokeBegins, this, [this] {
        const std::lock_guard lock(unsavedMutex_);
        unsaved_.reset();
    });
    const auto begin = [this] {
        // What was copied or is being copied is of a document that is gone, or that the project's file has.
        ++generation_;
        dirty_ = false;
        timer_.stop();
        if (place_ && !isWriting_) place_->removeCopy();
        describe();
        if (std::exchange(hasFailed_, false)) Q_EMIT upToDate();
    };
    connect(&document_, &QtDocument::replaced, this, begin);
    connect(&document_, &QtDocument::saved, this, begin);
    connect(&preferences_, &Preferences::changed, this, [this] {
        timer_.stop();
        if (preferences_.autosaveMinutes() == 0 && std::exchange(hasFailed_, false)) Q_EMIT upToDate();
        schedule();
    });
    takePlace();
}

Autosave::~Autosave() {
    finish();
    if (place_ && keepsCopy_) place_->keepCopy();
}

QString Autosave::file() const {
    return place_ ? QString::fromStdString(place_->copy().string()) : QString();
}

std::vector<OpenDocument> Autosave::otherWindows() const {
    return otherWindowsWith(document_.path());
}

std::vector<OpenDocument> Autosave::otherWindowsWith(const QString& project) const {
    if (!place_ || project.isEmpty()) return {};
    return place_->othersWith(project.toStdString());
}

void Autosave::takePlace() {
    // Somebody may have cleared the folder.
    if (place_ && !place_->isThere()) place_.reset();
    if (place_) return;
    if (auto taken = RecoveryPlace::take()) place_ = std::move(*taken);
    describe();
}

OpenDocument Autosave::description() const {
    const std::filesystem::path project = document_.path().toStdString();
    return {project, document_.title().toStdString(), knownVersion(project), 0};
}

void Autosave::describe() {
    // A folder that takes nothing fails with the copy, and then it is said.
    if (place_) static_cast<void>(place_->describe(description()));
}

void Autosave::pause(bool paused) {
    isPaused_ = paused;
    schedule();
}

bool Autosave::hasUnsaved() const {
    return document_.isModified() || document_.editing().stroke() != nullptr;
}

void Autosave::changed() {
    dirty_ = true;
    schedule();
}

void Autosave::noteUnsaved() {
    if (document_.editing().stroke()) return;
    const std::lock_guard lock(unsavedMutex_);
    unsaved_.reset();
    if (place_ && hasUnsaved()) unsaved_.emplace(document_.groom(), place_->copy());
}

void Autosave::schedule() {
    const int interval = preferences_.autosaveMinutes() * kMinute_ms;
    if (interval == 0 || !dirty_ || timer_.isActive() || isWriting_ || isPaused_) return;
    timer_.start(hasFailed_ ? std::min(kRetry_ms, interval) : static_cast<int>(kShareOfInterval * interval));
}

void Autosave::saveNow() {
    if (!dirty_ || isWriting_ || isPaused_) return;
    if (!hasUnsaved()) {
        // Everything was taken back.
        dirty_ = false;
        return;
    }
    takePlace();
    dirty_ = false;
    isWriting_ = true;
    timer_.stop();
    if (writer_.joinable()) writer_.join();
    writer_ = std::thread([this, generation = generation_, groom = document_.groom(), of = description()] {
        Status status;
        {
            const std::lock_guard lock(writing_);
            if (place_) {
                status = place_->describe(of);
                // A copy that somebody has changed is nobody's work.
                forgetInput(place_->copy());
                if (status) status = saveProject(groom, place_->copy());
            } else if (const auto place = RecoveryPlace::take(); !place) {
                status = tl::unexpected(place.error());
            } else {
                status = failIn(recoveryFolder().string(), {}, "could not be written");
            }
        }
        QMetaObject::invokeMethod(this, [this, generation, status] { written(generation, status); });
    });
}

void Autosave::written(quint64 generation, const Status& status) {
    isWriting_ = false;
    if (generation != generation_) {
        if (place_) place_->removeCopy();
        schedule();
        return;
    }
    hasFailed_ = !status;
    if (status) {
        Q_EMIT upToDate();
    } else {
        dirty_ = true;
        Q_EMIT failed(
            QString("Unsaved work could not be copied: %1. Free some space, change the folder's rights, "
                    "or save the project. The next attempt is in %2 seconds")
                .arg(errorText(status.error()))
                .arg(kRetry_ms / 1000));
    }
    schedule();
}

void Autosave::finish() {
    if (writer_.joinable()) writer_.join();
    // The writer's last word waits in the queue.
    QCoreApplication::sendPostedEvents(this, QEvent::MetaCall);
}

void Autosave::keep() {
    isPaused_ = false;
    finish();
    if (hasUnsaved()) {
        dirty_ = true;
        saveNow();
        finish();
    }
    keepsCopy_ = hasUnsaved();
}

void Autosave::keepFromElsewhere() {
    std::optional<std::pair<Groom, std::filesystem::path>> last;
    {
        const std::lock_guard lock(unsavedMutex_);
        last = unsaved_;
    }
    if (!last) return;
    forgetInput(last->second);
    // Nobody is left to be told.
    static_cast<void>(saveProject(last->first, last->second));
}

void Autosave::leave() {
    if (place_ && keepsCopy_) place_->keepCopy();
    place_.reset();
}

}  // namespace hairloom::editor
