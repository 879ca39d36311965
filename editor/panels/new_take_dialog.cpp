// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/new_take_dialog.h"

#include <QDialogButtonBox>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {
namespace {

constexpr int kMostNewFrames = 100'000;

int frameNumber(std::uint64_t number) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    return static_cast<int>(std::min(number, kMost));
}

QString secondsOf(std::uint64_t frames, float framesPerSecond) {
    return numberLocale().toString(static_cast<double>(frames) / static_cast<double>(framesPerSecond), 'f',
                                   2);
}

}  // namespace

NewTakeDialog::NewTakeDialog(const QString& title, const QString& name, QWidget* parent)
    : QDialog(parent), form_(new QFormLayout), name_(new QLineEdit(name)), words_(new QLabel) {
    setWindowTitle(title);
    resize(420, 0);
    exportLayout(*this, *form_)->addLayout(form_);
    name_->setObjectName("newTakeName");
    name_->setToolTip("Name of the take to make");
    form_->addRow("Name", name_);
}

QSpinBox* NewTakeDialog::addFrames(const char* objectName, const QString& label, const QString& tip,
                                   int least, int most, int value) {
    auto* box = new QSpinBox;
    box->setObjectName(objectName);
    box->setRange(least, std::max(least, most));
    box->setValue(value);
    box->setToolTip(tip);
    box->setAccessibleName(tip);
    form_->addRow(label, box);
    connect(box, &QSpinBox::valueChanged, this, &NewTakeDialog::showWords);
    return box;
}

void NewTakeDialog::finishRows(const QString& button, const QString& tip,
                               std::function<Result<QString>()> words) {
    words_->setObjectName("newTakeWords");
    words_->setWordWrap(true);
    words_->setMinimumHeight(2 * words_->fontMetrics().lineSpacing());
    words_->setAlignment(Qt::AlignTop);
    layout()->addWidget(words_);
    make_ = acceptOrCancel(*this, *layout(), button, tip);
    make_->setObjectName("newTakeMake");
    connect(name_, &QLineEdit::textChanged, this, &NewTakeDialog::showWords);
    wordsOf_ = std::move(words);
    showWords();
}

void NewTakeDialog::showWords() {
    if (!wordsOf_) return;
    const auto words = wordsOf_();
    words_->setText(words ? *words : errorText(words.error()));
    make_->setEnabled(words.has_value() && !name_->text().isEmpty());
}

LoopDialog::LoopDialog(const QString& name, const TakeInfo& info, const Groom& groom, QWidget* parent)
    : NewTakeDialog("Make loop", name, parent) {
    const int last = frameNumber(info.frames) - 1;
    // Of another motion nobody but its author knows how often it repeats.
    const auto repeat = lastRepeat(info, groom, kLoopBlend);
    first_ = addFrames("loopFirst", "First frame", "First frame of the repeat", 0, last,
                       repeat ? frameNumber(repeat->first) : (last + 1) / 2);
    last_ = addFrames("loopLast", "Last frame", "Last frame of the repeat. The first one follows it", 0, last,
                      repeat ? frameNumber(repeat->second) : last);
    blend_ = addFrames("loopBlend", "Blend",
                       "Frames at the end that are blended into those before the first one. More make it "
                       "gentler, 0 blends nothing",
                       0, 10'000, static_cast<int>(kLoopBlend));
    finishRows("Make loop", "Write the loop as a new take, and show it", [this, info]() -> Result<QString> {
        const LoopToMake loop = wanted();
        if (auto status = checkLoop(info, loop); !status) return tl::unexpected(status.error());
        const std::uint64_t frames = loop.last - loop.first + 1;
        return QString("%L1 frames last %2 s at %3 frames per second.")
            .arg(frames)
            .arg(secondsOf(frames, info.framesPerSecond))
            .arg(static_cast<double>(info.framesPerSecond));
    });
}

LoopToMake LoopDialog::wanted() const {
    LoopToMake loop;
    loop.first = static_cast<std::uint64_t>(first_->value());
    loop.last = static_cast<std::uint64_t>(last_->value());
    loop.blend = static_cast<std::uint64_t>(blend_->value());
    return loop;
}

ResimulateDialog::ResimulateDialog(const QString& name, const TakeInfo& info, std::uint64_t shown,
                                   QWidget* parent)
    : NewTakeDialog("Re-simulate", name, parent) {
    const int last = frameNumber(info.frames) - 1;
    at_ = addFrames("resimulateAt", "From frame", "The frame of the take that is kept last", 0, last,
                    frameNumber(shown));
    frames_ = addFrames("resimulateFrames", "Frames", "Number of frames to simulate", 1, kMostNewFrames,
                        std::max(1, last - frameNumber(shown)));
    finishRows("Re-simulate", "Simulate from this frame into a new take, and show it",
               [this, info]() -> Result<QString> {
                   const TakeToResume take = wanted();
                   const std::uint64_t frames = take.at + 1 + take.frames;
                   return QString(
                              "Keeps %L1 frames and simulates %L2 with the settings and the motion as they "
                              "are now: %3 s.")
                       .arg(take.at + 1)
                       .arg(take.frames)
                       .arg(secondsOf(frames, info.framesPerSecond));
               });
}

TakeToResume ResimulateDialog::wanted() const {
    return {static_cast<std::uint64_t>(at_->value()), static_cast<std::uint64_t>(frames_->value()), {}};
}

}  // namespace hairloom::editor
