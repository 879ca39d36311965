// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/key_form.h"

#include <QCheckBox>
#include <QComboBox>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "core/animation/actor.h"
#include "editor/document/words.h"
#include "editor/fields/field.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {
namespace {

double durationOf(const std::string& clip, const Player& player) {
    if (!player.actor()) return 0;
    for (const Clip& one : player.actor()->clips()) {
        if (one.name == clip) return static_cast<double>(one.duration);
    }
    return 0;
}

}  // namespace

double clipLength(const ClipStrip& strip, const Player& player) {
    const double duration = durationOf(strip.name, player);
    const double last = strip.last > 0 ? std::min(static_cast<double>(strip.last), duration) : duration;
    return std::max(0.0, last - static_cast<double>(strip.first));
}

void trimClip(TimeLine& line, std::size_t clip, bool start, double time, const Player& player) {
    ClipStrip& strip = line.clips[clip];
    const double duration = durationOf(strip.name, player),
                 frame = 1 / static_cast<double>(line.framesPerSecond);
    const double speed = static_cast<double>(strip.speed), begin = static_cast<double>(strip.start);
    if (duration <= 0 || speed <= 0) return;
    const double first = static_cast<double>(strip.first);
    const double last = strip.last > 0 ? static_cast<double>(strip.last) : duration;
    if (start) {
        double to = std::max(time, 0.0);
        if (clip > 0) to = std::max(to, static_cast<double>(line.clips[clip - 1].start) + frame);
        if (clip + 1 < line.clips.size())
            to = std::min(to, static_cast<double>(line.clips[clip + 1].start) - frame);
        // Not before what the clip has, and something stays.
        const double trimmed = std::clamp(first + (to - begin) * speed, 0.0, std::max(0.0, last - frame));
        strip.start = static_cast<float>(std::max(0.0, begin + (trimmed - first) / speed));
        strip.first = static_cast<float>(trimmed);
        return;
    }
    const double trimmed = first + std::max(time - begin, frame) * speed;
    strip.last = trimmed >= duration ? 0 : static_cast<float>(trimmed);
    // What ends where it is dragged to does not repeat.
    strip.loop = false;
}

KeyForm::KeyForm(TimeLineView& view, const Preferences& preferences, QWidget* parent)
    : QWidget(parent),
      view_(view),
      preferences_(preferences),
      none_(new QLabel("Select a key or a clip to edit its values.")) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    none_->setObjectName("keyNone");
    none_->setWordWrap(true);
    none_->setProperty("role", "dim");
    layout->addWidget(none_);
    layout->addStretch(1);
    connect(&view_, &TimeLineView::changed, this, &KeyForm::refresh);
    const auto anew = [this] {
        built_.reset();
        refresh();
    };
    connect(&preferences_, &Preferences::changed, this, anew);
    connect(&view_.player(), &Player::motionsChanged, this, anew);
    refresh();
}

void KeyForm::focus() {
    if (!first_) return;
    first_->setFocus(Qt::ShortcutFocusReason);
    if (auto* spin = qobject_cast<QAbstractSpinBox*>(first_)) spin->selectAll();
}

void KeyForm::edit(const std::function<void(TimeLine&)>& write) {
    TimeLine to = view_.keying().line();
    if (view_.isDragging() || view_.selection().empty() || !hasKey(to, key())) return;
    write(to);
    if (!view_.keying().change(std::move(to), "Edit key")) refresh();
}

void KeyForm::addFrame() {
    auto* frame = new NumberSpin;
    frame->setObjectName("keyFrame");
    frame->setDecimals(0);
    frame->setRange(0, 1e9);
    frame->setButtonSymbols(QAbstractSpinBox::NoButtons);
    connect(frame, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        if (!view_.selection().empty()) view_.moveSelected(std::llround(value) - shownFrame());
        refresh();
    });
    refreshers_.push_back([this, frame] {
        const QSignalBlocker quiet(frame);
        frame->follow(static_cast<double>(shownFrame()));
    });
    addRow("Frame", frame, "Frame of the selected key. All selected keys move along with it");
}

std::int64_t KeyForm::shownFrame() const {
    return view_.frameOf(static_cast<double>(keyTime(view_.line(), key())));
}

void KeyForm::refresh() {
    // Its room stays: keys under the pointer would move with it.
    none_->setVisible(view_.selection().empty());
    if (body_) body_->setVisible(!view_.selection().empty());
    if (view_.selection().empty()) {
        built_.reset();
        first_ = nullptr;
        refreshers_.clear();
        return;
    }
    if (built_ != key().track) rebuild();
    for (const auto& refresh : refreshers_) refresh();
}

void KeyForm::rebuild() {
    if (body_) {
        // One of its controls may be what asks.
        body_->hide();
        body_->deleteLater();
    }
    body_ = new QWidget;
    grid_ = new QGridLayout(body_);
    grid_->setContentsMargins(0, 0, 0, 0);
    grid_->setHorizontalSpacing(6);
    grid_->setVerticalSpacing(4);
    grid_->setColumnStretch(1, 1);
    static_cast<QVBoxLayout*>(layout())->insertWidget(1, body_);
    refreshers_.clear();
    first_ = nullptr;
    built_ = key().track;
    built_->of == KeyTrack::Of::clips ? buildClip() : buildKey(*built_);
    grid_->setRowStretch(grid_->rowCount(), 1);
}

void KeyForm::addRow(const QString& label, QWidget* control, const QString& tip) {
    const int row = grid_->rowCount();
    auto* name = new QLabel(label);
    name->setBuddy(control);
    name->setToolTip(tip);
    control->setToolTip(tip);
    control->setAccessibleName(label);
    grid_->addWidget(name, row, 0);
    grid_->addWidget(control, row, 1);
}

QWidget* KeyForm::number(const QString& name, double min, double max, const QString& unit, bool whole,
                         std::function<double(const TimeLine&)> read,
                         std::function<void(TimeLine&, double)> write) {
    const Shown shown = shownAs(unit, min, max, preferences_.unit());
    auto* spin = new NumberSpin;
    spin->setObjectName(name);
    // Of a key's time each frame of 240 a second is another one.
    spin->setDecimals(whole ? 0 : std::max(shown.decimals, unit == "s" ? 3 : 2));
    spin->setRange(min * shown.factor, max * shown.factor);
    if (!shown.unit.isEmpty()) spin->setSuffix(' ' + shown.unit);
    spin->setButtonSymbols(QAbstractSpinBox::NoButtons);
    connect(spin, &QDoubleSpinBox::valueChanged, this, [this, write, shown](double value) {
        edit([&](TimeLine& to) { write(to, value / shown.factor); });
    });
    refreshers_.push_back([this, spin, read, shown] {
        const QSignalBlocker quiet(spin);
        spin->follow(read(view_.line()) * shown.factor);
    });
    return spin;
}

QWidget* KeyForm::choice(const QString& name, const QStringList& labels,
                         std::function<int(const TimeLine&)> read,
                         std::function<void(TimeLine&, int)> write) {
    auto* box = new QComboBox;
    box->setObjectName(name);
    box->addItems(labels);
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(10);
    connect(box, &QComboBox::activated, this,
            [this, write](int index) { edit([&](TimeLine& to) { write(to, index); }); });
    refreshers_.push_back([this, box, read] {
        const QSignalBlocker quiet(box);
        box->setCurrentIndex(read(view_.line()));
    });
    return box;
}

void KeyForm::buildKey(const KeyTrack& track) {
    addFrame();
    const std::vector<KeyNumber> numbers = numbersOf(track);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        const KeyNumber& one = numbers[n];
        const QString name = QString("keyNumber%1").arg(n);
        QWidget* control = nullptr;
        if (!one.choices.empty() || (one.isWhole && one.min == 0 && one.max == 1)) {
            QStringList labels;
            for (const char* value : one.choices) labels.append(labelOf(QString(value)));
            if (labels.isEmpty()) labels = QStringList{"Off", "On"};
            control = choice(
                name, labels,
                [this, n](const TimeLine& line) { return static_cast<int>(numberOf(line, key(), n)); },
                [this, n](TimeLine& line, int value) { setNumber(line, key(), n, value); });
        } else {
            control = number(
                name, one.min, one.max, QString::fromUtf8(one.unit), one.isWhole,
                [this, n](const TimeLine& line) { return numberOf(line, key(), n); },
                [this, n](TimeLine& line, double value) { setNumber(line, key(), n, value); });
        }
        if (n == 0) first_ = control;
        addRow(one.label, control, "Value of the selected key");
    }
    QStringList labels;
    for (const char* name : kKeyInterpolations) labels.append(labelOf(QString(name)));
    addRow("To the next",
           choice(
               "keyInterpolation", labels,
               [this](const TimeLine& line) { return static_cast<int>(interpolationOf(line, key())); },
               [this](TimeLine& line, int value) {
                   setInterpolation(line, view_.selection(), static_cast<KeyInterpolation>(value));
               }),
           "How the value goes from the selected keys to the next ones: evenly, by a step, or slowly at both "
           "ends");
}

void KeyForm::buildClip() {
    const auto strip = [this](auto& line) -> auto& {
        return line.clips[key().index];
    };
    QStringList names;
    if (view_.player().actor()) {
        for (const Clip& clip : view_.player().actor()->clips())
            names.append(QString::fromStdString(clip.name));
    }
    // One that the character no longer has keeps its name until another one is chosen.
    const QString now = QString::fromStdString(strip(view_.line()).name);
    if (!names.contains(now)) names.append(now);
    addRow("Clip",
           choice(
               "clipName", names,
               [strip, names](const TimeLine& line) {
                   return static_cast<int>(names.indexOf(QString::fromStdString(strip(line).name)));
               },
               [strip, names](TimeLine& line, int index) {
                   if (strip(line).name == names[index].toStdString()) return;
                   strip(line).name = names[index].toStdString();
                   strip(line).first = strip(line).last = 0;
               }),
           "Animation clip of the character");
    for (const auto& field : fieldsOf(ClipStrip())) {
        const QString tip = QString::fromUtf8(field.meaning);
        const QString label = labelOf(QString(field.name));
        const QString name = QString("clip") + label;
        if (field.kind == FieldKind::Bool) {
            addRow(label,
                   choice(
                       name, {"Off", "On"},
                       [strip, &field](const TimeLine& line) {
                           return runtime::fieldValue(strip(line), field) != 0 ? 1 : 0;
                       },
                       [strip, &field](TimeLine& line, int on) {
                           runtime::setFieldValue(strip(line), field, on);
                       }),
                   tip);
            continue;
        }
        QWidget* control = number(
            name, field.min, field.max, QString::fromUtf8(field.unit), false,
            [strip, &field](const TimeLine& line) { return runtime::fieldValue(strip(line), field); },
            [strip, &field](TimeLine& line, double value) {
                runtime::setFieldValue(strip(line), field, value);
            });
        if (!first_) first_ = control;
        addRow(label, control, tip);
    }
}

}  // namespace hairloom::editor
