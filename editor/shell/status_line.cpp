// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/shell/status_line.h"

#include <QRegularExpression>
#include <algorithm>

#include "core/editing/selection_commands.h"
#include "editor/document/words.h"
#include "editor/fields/length_text.h"
#include "editor/style/icons.h"
#include "editor/style/theme.h"
#include "importers/length_unit.h"

namespace hairloom::editor {
namespace {

/// Three or four digits: "12.3 ms", "840 ms", "4.90 s".
QString drawTimeText(double milliseconds) {
    constexpr double kTenths_ms = 100, kSecond_ms = 1000;
    if (milliseconds >= kSecond_ms) return QString("%1 s").arg(milliseconds / kSecond_ms, 0, 'f', 2);
    return QString("%1 ms").arg(milliseconds, 0, 'f', milliseconds < kTenths_ms ? 1 : 0);
}

}  // namespace

StatusLine::StatusLine(QtDocument& document, const Preferences& preferences, Tasks& tasks, Messages& messages,
                       Player& player, Viewport& viewport, QWidget* parent)
    : QStatusBar(parent),
      document_(document),
      preferences_(preferences),
      tasks_(tasks),
      messages_(messages),
      player_(player),
      viewport_(viewport),
      standing_(new QLabel),
      message_(new QLabel),
      counts_(new QLabel),
      head_(new QLabel),
      frameTime_(new QLabel),
      engine_(new QLabel),
      device_(new QLabel),
      progress_(new QProgressBar),
      cancel_(new QToolButton) {
    setSizeGripEnabled(false);
    message_->setObjectName("message");
    message_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    message_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    progress_->setObjectName("progress");
    progress_->setRange(0, 100);
    progress_->setFixedWidth(140);
    progress_->setTextVisible(false);
    cancel_->setObjectName("cancelTask");
    cancel_->setIcon(icon("close"));
    cancel_->setIconSize({12, 12});
    cancel_->setToolTip("Cancel this task and discard its result");
    counts_->setObjectName("counts");
    counts_->setToolTip("Strands and points in the document, and the number of selected strands");
    frameTime_->setToolTip("Milliseconds of the last rendered image and of the last simulation frame");
    device_->setToolTip("Graphics device for rendering");
    standing_->setObjectName("standing");
    standing_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    standing_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    standing_->hide();
    addWidget(standing_, 1);
    addWidget(message_, 1);
    addWidget(progress_);
    addWidget(cancel_);
    head_->setObjectName("head");
    addPermanentWidget(head_);
    addPermanentWidget(counts_);
    addPermanentWidget(frameTime_);
    engine_->setObjectName("engine");
    addPermanentWidget(engine_);
    addPermanentWidget(device_);
    progress_->hide();
    cancel_->hide();

    poll_.setInterval(100);
    connect(&poll_, &QTimer::timeout, this, &StatusLine::showWork);
    fade_.setSingleShot(true);
    fade_.setInterval(8000);
    connect(&fade_, &QTimer::timeout, this, [this] { setHint(hint_); });
    connect(&messages_, &Messages::said, this, &StatusLine::say);
    connect(&tasks_, &Tasks::started, this, [this](const QString& name) {
        say(name + QChar(0x2026), false);
        fade_.stop();
        showWork();
        cancel_->show();
        poll_.start();
    });
    connect(&tasks_, &Tasks::stopped, this, [this] {
        poll_.stop();
        progress_->hide();
        cancel_->hide();
        fade_.start(0);
    });
    connect(&tasks_, &Tasks::disturbed, this, [this](const QString& text) { say(text, true); });
    connect(&tasks_, &Tasks::failed, this, [this](const QString& text) { say(text, true); });
    connect(&tasks_, &Tasks::cancelled, this,
            [this](const QString& name) { say(QString("%1 was cancelled").arg(name), false); });
    connect(&player_, &Player::failed, this, [this](const QString& text) { say(text, true); });
    connect(cancel_, &QToolButton::clicked, this, [this] {
        say(QString("Cancelling") + QChar(0x2026), false);
        fade_.stop();
        tasks_.cancel();
    });
    connect(&player_, &Player::engineChanged, this, &StatusLine::showEngine);
    connect(&document_, &QtDocument::changed, this, &StatusLine::showCounts);
    connect(&viewport_, &Viewport::failed, this, [this](const QString& text) { say(text, true); });
    connect(&viewport_, &Viewport::drawn, this, [this](const PictureReport& report) {
        const auto& frame = player_.frame();
        const QString picture = drawTimeText(report.milliseconds);
        frameTime_->setText(frame ? QString("%1 + %2").arg(picture, drawTimeText(frame->milliseconds))
                                  : picture);
    });
    connect(&viewport_, &Viewport::deviceReady, this, [this](const QString& name, const QString& note) {
        device_->setText(name.section(" (", 0, 0));
        device_->setToolTip(note.isEmpty() ? QString("Graphics device for rendering") : note);
        // A warning stays for its time; the tooltip has the note for longer.
        const bool warns = warning_ && fade_.isActive();
        if (!note.isEmpty() && !warns) say(note, false);
    });
    device_->setText("looking for a device");
    connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
        if (contains(changed, editing::Part::Head)) showHead();
    });
    connect(&preferences_, &Preferences::changed, this, &StatusLine::showHead);
    showHead();
    showCounts(editing::Part::Everything);
}

void StatusLine::say(const QString& text, bool isWarning) {
    warning_ = isWarning;
    // Names of files stay as they are written.
    const bool isWord = text.left(text.indexOf(' ')).indexOf(QRegularExpression("[^a-z]")) < 0;
    const QString shown = isWord ? asSentence(text) : text;
    message_->setText(shown);
    message_->setToolTip(shown);
    const ThemeColours colours = themeColours(preferences_.theme());
    message_->setStyleSheet(isWarning ? QStringLiteral("QLabel { color: %1; }").arg(colours.bad.name())
                                      : QString());
    fade_.start(isWarning ? 20'000 : 8000);
}

void StatusLine::setStanding(const QString& warning) {
    standing_->setText(warning);
    standing_->setToolTip(warning);
    standing_->setStyleSheet(
        QStringLiteral("QLabel { color: %1; }").arg(themeColours(preferences_.theme()).bad.name()));
    standing_->setVisible(!warning.isEmpty());
}

void StatusLine::setHint(const QString& hint) {
    hint_ = hint;
    // Asked for at each move of the pointer.
    if (fade_.isActive() || message_->text() == hint) return;
    message_->setStyleSheet({});
    message_->setText(hint);
    message_->setToolTip(hint);
}

void StatusLine::showCounts(editing::Part changed) {
    // Not after each dab: the selection of a hundred thousand strands is counted.
    if (!contains(changed, editing::Part::Strands | editing::Part::StrandFlags)) return;
    const Groom& groom = document_.groom();
    const std::size_t selected = editing::strandsWithFlag(groom, attribute::kSelected).size();
    const QString strands =
        selected == 0 ? QString("%L1 strands").arg(groom.strandCount())
                      : QString("%L1 of %L2 strands selected").arg(selected).arg(groom.strandCount());
    counts_->setText(QString("%1   %L2 points").arg(strands).arg(groom.pointCount()));
}

void StatusLine::showHead() {
    const Groom& groom = document_.groom();
    head_->setVisible(groom.scalp != nullptr);
    if (!groom.scalp) return;
    head_->setText(QString("head %1").arg(lengthText(groom.scalp->bounds().sizes().y(), preferences_)));
    const auto units = lengthUnits();
    const auto unit = std::ranges::find_if(units, [&](const LengthUnit& known) {
        return static_cast<float>(known.metres) == groom.characterMetresPerUnit;
    });
    head_->setToolTip(unit == units.end()
                          ? QString("Height of the head, in the unit of its file or in metres")
                          : QString("Height of the head. Its file is in %1").arg(unit->name));
}

void StatusLine::showEngine() {
    const auto& engine = player_.engine();
    engine_->setText(!engine                           ? QString()
                     : engine->kind == EngineKind::gpu ? QString("hair on the GPU")
                                                       : QString("hair on the CPU"));
    engine_->setToolTip(!engine ? QString()
                                : QString("Simulated by: %1. To change this, choose Edit ▸ Preferences")
                                      .arg(QString::fromStdString(engine->why)));
}

void StatusLine::showWork() {
    // Work that does not say how far it is has its name and no bar.
    const float progress = tasks_.progress();
    progress_->setVisible(progress >= 0);
    progress_->setValue(static_cast<int>(100 * progress));
}

}  // namespace hairloom::editor
