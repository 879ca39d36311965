// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/motion_rows.h"

#include <QHBoxLayout>
#include <QPointF>
#include <QVariant>
#include <algorithm>

namespace hairloom::editor {
namespace {

constexpr double kSlowest = 1, kFastest = 240;
constexpr int kMostRunUp = 100'000, kFarthestFrame = 1'000'000, kMostHandles = 1000;

QWidget* sideBySide(QWidget* left, QWidget* right) {
    auto* row = new QWidget;
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(left, 1);
    layout->addWidget(right, 1);
    return row;
}

}  // namespace

MotionRows::MotionRows(const FramePace& pace, QObject* parent)
    : QObject(parent),
      rate_(new NumberSpin),
      preRoll_(new QSpinBox),
      start_(new QSpinBox),
      handles_(new QSpinBox),
      samples_(new QSpinBox),
      shutter_(new QComboBox),
      settling_(sideBySide(rate_, preRoll_)),
      range_(sideBySide(start_, handles_)),
      exposure_(sideBySide(shutter_, samples_)) {
    rate_->setObjectName("frameRate");
    rate_->setDecimals(3);  // of 23.976
    rate_->setRange(kSlowest, kFastest);
    rate_->setValue(static_cast<double>(pace.framesPerSecond));
    rate_->setSuffix(" frames per second");
    rate_->setAccessibleName("Frame rate");
    rate_->setToolTip("Number of frames per second to simulate and to write");
    preRoll_->setObjectName("preRoll");
    preRoll_->setRange(0, kMostRunUp);
    preRoll_->setValue(static_cast<int>(std::min<std::uint64_t>(pace.preRoll, kMostRunUp)));
    preRoll_->setSpecialValueText("no run-up");
    preRoll_->setSuffix(" frames of run-up");
    preRoll_->setAccessibleName("Run-up");
    preRoll_->setToolTip(
        "Number of frames to simulate before the first one, on the motion's first pose, so that the hair "
        "settles");
    start_->setObjectName("startFrame");
    start_->setRange(-kFarthestFrame, kFarthestFrame);
    start_->setAccessibleName("First frame");
    start_->setToolTip("Number of the first frame in the file, without the handles");
    handles_->setObjectName("handles");
    handles_->setRange(0, kMostHandles);
    handles_->setSpecialValueText("no handles");
    handles_->setSuffix(" frames of handles");
    handles_->setAccessibleName("Handles");
    handles_->setToolTip("Number of frames to export before and after the range as well, for editing");
    connect(handles_, &QSpinBox::valueChanged, this, &MotionRows::changed);
    shutter_->setObjectName("shutter");
    shutter_->setAccessibleName("Shutter");
    shutter_->addItem("none: one sample per frame");
    shutter_->addItem("180° around the frame", QVariant::fromValue(QPointF(-0.25, 0.25)));
    shutter_->addItem("180° after the frame", QVariant::fromValue(QPointF(0, 0.5)));
    shutter_->addItem("360° around the frame", QVariant::fromValue(QPointF(-0.5, 0.5)));
    shutter_->setToolTip(
        "When the camera sees a frame. The file has samples within that time, for motion blur");
    samples_->setObjectName("shutterSamples");
    samples_->setRange(2, static_cast<int>(kMaxShutterSamples));
    samples_->setValue(3);
    samples_->setSuffix(" samples");
    samples_->setAccessibleName("Samples");
    samples_->setToolTip("Number of samples while the shutter is open");
    connect(shutter_, &QComboBox::currentIndexChanged, this, [this] {
        samples_->setEnabled(shutter_->currentIndex() > 0);
        Q_EMIT changed();
    });
    samples_->setEnabled(false);
    connect(samples_, &QSpinBox::valueChanged, this, &MotionRows::changed);
}

void MotionRows::addTo(QFormLayout& form) {
    form.addRow("Frame rate", settling_);
    form.addRow("First frame", range_);
    form.addRow("Shutter", exposure_);
}

void MotionRows::show(QFormLayout& form, bool visible) {
    form.setRowVisible(settling_, visible);
    form.setRowVisible(range_, visible);
    form.setRowVisible(exposure_, visible);
}

std::uint32_t MotionRows::samplesOf(int frames) const {
    const int all = frames + 2 * handles_->value();
    const int perFrame = shutter_->currentIndex() > 0 && all > 1 ? samples_->value() : 1;
    return static_cast<std::uint32_t>(all * perFrame);
}

bool MotionRows::apply(HairToExport& wanted) const {
    wanted.firstFrame = start_->value() - handles_->value();
    if (shutter_->currentIndex() == 0) return false;
    const auto open = shutter_->currentData().toPointF();
    wanted.shutter = {open.x(), open.y(), static_cast<std::uint32_t>(samples_->value())};
    wanted.framesAfter = 1;
    return true;
}

}  // namespace hairloom::editor
