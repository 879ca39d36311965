// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/take_actions.h"

#include <QHBoxLayout>
#include <QPointer>

#include "core/documents/take_edit.h"
#include "core/documents/takes.h"
#include "editor/document/task_watch.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/number_spin.h"
#include "editor/panels/new_take_dialog.h"

namespace hairloom::editor {
namespace {

QString seamText(const LoopSeam& seam) {
    return QString("%1 mm and %2 mm/s")
        .arg(numberLocale().toString(seam.mm, 'f', 2), numberLocale().toString(seam.mmPerSecond, 'f', 1));
}

}  // namespace

TakeActions::TakeActions(const PanelParts& parts, const TakeView& view, Takes takes, QWidget* parent)
    : QWidget(parent),
      document_(parts.document),
      tasks_(parts.tasks),
      messages_(parts.messages),
      player_(parts.player),
      view_(view),
      takes_(std::move(takes)) {
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    loop_ = pushButton("takeLoop", "Make loop…",
                       "Make a take that repeats: the end of a range is blended into what comes before it",
                       [this] { makeLoop(); });
    resimulate_ = pushButton("takeResimulate", "Re-simulate…",
                             "Keep the take up to this frame, and simulate from there with the settings and "
                             "the motion as they are now",
                             [this] { resimulate(); });
    row->addWidget(loop_);
    row->addWidget(resimulate_);
}

void TakeActions::setActive(bool on) {
    loop_->setEnabled(on);
    resimulate_->setEnabled(on);
}

std::filesystem::path TakeActions::placeFor(const QString& name) {
    const auto path = takePath(std::filesystem::path(document_.path().toStdU16String()), name.toStdString());
    std::error_code code;
    if (!path)
        messages_.warn(errorText(path.error()));
    else if (std::filesystem::exists(*path, code))
        messages_.warn(QString("There is a take “%1” already. Choose another name").arg(name));
    else
        return *path;
    return {};
}

void TakeActions::told(const QString& name, const QString& words, bool isWarning) {
    Q_EMIT made(name);
    isWarning ? messages_.warn(words) : messages_.say(words);
}

void TakeActions::makeLoop() {
    const QString source = takes_.selected();
    LoopDialog dialog(takes_.freeName(source + " loop"), view_.info(), document_.groom(), this);
    if (dialog.exec() != QDialog::Accepted) return;
    const QString name = dialog.name();
    const auto to = placeFor(name);
    if (to.empty()) return;
    tasks_.run<LoopReport>(
        QString("Making the loop %1").arg(name),
        [groom = document_.groom(), take = takes_.fileOf(source), wanted = dialog.wanted(),
         to](TaskControl& control) -> Result<LoopReport> {
            auto reader = openTakeFor(take, groom);
            if (!reader) return tl::unexpected(reader.error());
            LoopToMake watched = wanted;
            watched.watch = watchOf(control);
            return hairloom::makeLoop(*reader, groom, watched, to);
        },
        [self = QPointer(this), name](LoopReport loop) {
            if (!self) return;
            if (loop.after.isClosed())
                return self->told(name,
                                  QString("“%1” closes within %2. Before the blend it was %3")
                                      .arg(name, seamText(loop.after), seamText(loop.before)),
                                  false);
            self->told(name,
                       QString("“%1” does not close: its end is %2 from its start. Use a longer blend")
                           .arg(name, seamText(loop.after)),
                       true);
        });
}

void TakeActions::resimulate() {
    const QString source = takes_.selected();
    const TakeInfo info = view_.info();
    ResimulateDialog dialog(takes_.freeName(source + " from " + QString::number(view_.number())), info,
                            view_.number(), this);
    if (dialog.exec() != QDialog::Accepted) return;
    const QString name = dialog.name();
    const std::string motion = motionOfNotes(info.notes);
    auto made = player_.makeMotion(motion.empty() ? QString("none") : QString::fromStdString(motion));
    if (!made) return messages_.warn(errorText(made.error()));
    const auto to = placeFor(name);
    if (to.empty()) return;
    tasks_.run<ResumeReport>(
        QString("Simulating %1").arg(name),
        [groom = document_.groom(), head = std::shared_ptr<const HeadMotion>(std::move(*made)), motion,
         take = takes_.fileOf(source), wanted = dialog.wanted(),
         to](TaskControl& control) -> Result<ResumeReport> {
            auto reader = openTakeFor(take, groom);
            if (!reader) return tl::unexpected(reader.error());
            TakeToResume watched = wanted;
            watched.watch = watchOf(control);
            return resumeTake(*reader, groom, *head, motion, watched, to);
        },
        [self = QPointer(this), name](ResumeReport report) {
            if (!self) return;
            self->told(name,
                       QString("Simulated %L1 frames of “%3” from frame %L2 on")
                           .arg(report.simulated)
                           .arg(report.kept - 1)
                           .arg(name),
                       false);
        });
}

}  // namespace hairloom::editor
