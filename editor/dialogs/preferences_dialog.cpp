// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/preferences_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QPainter>
#include <QPainterPath>
#include <QSpinBox>
#include <QVBoxLayout>
#include <cmath>

#include "editor/fields/number_box.h"

namespace hairloom::editor {
namespace {

/// Pressure of the pen to pressure of the brush.
class CurveView : public QWidget {
  public:
    explicit CurveView(const Preferences& preferences) : preferences_(preferences) {
        setFixedSize(120, 90);
        setToolTip("Right: more pen pressure. Up: more brush strength.");
        connect(&preferences, &Preferences::changed, this, [this] { update(); });
    }

  protected:
    void paintEvent(QPaintEvent*) override {
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        const QRectF box = QRectF(rect()).adjusted(1, 1, -1, -1);
        painter.setPen(palette().color(QPalette::Mid));
        painter.drawRoundedRect(box, 4, 4);
        // Clear of the frame and its round corners.
        const QRectF plot = box.adjusted(4, 4, -4, -4);
        QPainterPath path;
        for (int i = 0; i <= 40; ++i) {
            const double pressure = i / 40.0;
            const QPointF at(plot.left() + pressure * plot.width(),
                             plot.bottom() - std::pow(pressure, preferences_.tabletCurve()) * plot.height());
            i == 0 ? path.moveTo(at) : path.lineTo(at);
        }
        painter.setPen(QPen(palette().color(QPalette::Highlight), 2));
        painter.drawPath(path);
    }

  private:
    const Preferences& preferences_;
};

template <class Enum>
QComboBox* choice(const QStringList& names, Enum now, const QString& tip, std::function<void(Enum)> take) {
    auto* box = new QComboBox;
    box->addItems(names);
    box->setCurrentIndex(static_cast<int>(now));
    box->setToolTip(tip);
    QObject::connect(box, &QComboBox::activated, box,
                     [take = std::move(take)](int index) { take(static_cast<Enum>(index)); });
    return box;
}

}  // namespace

PreferencesDialog::PreferencesDialog(Preferences& preferences, QWidget* parent) : QDialog(parent) {
    setWindowTitle("Preferences");
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(20, 20, 20, 16);
    layout->setSpacing(16);
    auto* form = new QFormLayout;
    form->setHorizontalSpacing(16);
    form->setVerticalSpacing(10);
    form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    layout->addLayout(form);

    auto* theme =
        choice<Theme>({QString("Dark"), QString("Light")}, preferences.theme(), "Colour theme of the window",
                      [&preferences](Theme value) { preferences.setTheme(value); });
    theme->setObjectName("theme");
    form->addRow("Theme", theme);
    auto* unit = choice<DisplayUnit>(
        {QString("Metres"), QString("Centimetres"), QString("Millimetres"), QString("Inches")},
        preferences.unit(), "Display unit for lengths. Documents are always in metres",
        [&preferences](DisplayUnit value) { preferences.setUnit(value); });
    unit->setObjectName("unit");
    form->addRow("Lengths in", unit);
    auto* orbit = choice<OrbitStyle>(
        {QString("Maya: Alt and a mouse button"), QString("Blender: middle mouse button")},
        preferences.orbitStyle(),
        "Maya: Alt + left orbits, Alt + middle pans, Alt + right zooms.\nBlender: middle orbits, Shift + "
        "middle pans, Ctrl + middle zooms.\nThe wheel zooms in both.",
        [&preferences](OrbitStyle value) { preferences.setOrbitStyle(value); });
    orbit->setObjectName("orbitStyle");
    form->addRow("Viewport navigation", orbit);

    auto* curve = new NumberBox(0.25, 4, false);
    curve->setObjectName("tabletCurve");
    curve->setToolTip("Exponent from pen pressure to brush strength. Above 1 needs more pressure");
    curve->setValue(preferences.tabletCurve());
    connect(curve, &NumberBox::edited, &preferences, &Preferences::setTabletCurve);
    form->addRow("Pen pressure", curve);
    form->addRow(QString(), new CurveView(preferences));

    auto* simulateOn = choice<SimulateOn>(
        {QString("Automatic"), QString("GPU"), QString("CPU")}, preferences.simulateOn(),
        "Device that simulates hair during playback. Automatic uses the one that was faster with a "
        "similar hairstyle. After a change the hair continues from its current state.",
        [&preferences](SimulateOn value) { preferences.setSimulateOn(value); });
    simulateOn->setObjectName("simulateOn");
    form->addRow("Simulate hair on", simulateOn);

    auto* autosave = new QSpinBox;
    autosave->setObjectName("autosave");
    autosave->setRange(0, 60);
    autosave->setSuffix(" min");
    autosave->setSpecialValueText("never");
    autosave->setValue(preferences.autosaveMinutes());
    autosave->setToolTip("Minutes between recovery copies of unsaved work");
    connect(autosave, &QSpinBox::valueChanged, &preferences, &Preferences::setAutosaveMinutes);
    form->addRow("Autosave every", autosave);

    auto* undo = new QSpinBox;
    undo->setObjectName("undoMemory");
    undo->setRange(kLeastUndoMegabytes, kMostUndoMegabytes);
    undo->setSingleStep(64);
    undo->setSuffix(" MB");
    undo->setKeyboardTracking(false);
    undo->setValue(preferences.undoMegabytes());
    undo->setToolTip("Memory for undo steps. The oldest steps are dropped when it is full");
    connect(undo, &QSpinBox::valueChanged, &preferences, &Preferences::setUndoMegabytes);
    form->addRow("Undo memory", undo);

    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    layout->addWidget(buttons);
}

}  // namespace hairloom::editor
