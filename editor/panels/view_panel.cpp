// SPDX-License-Identifier: GPL-3.0-or-later
// What the viewport shows besides the hair, and in which light.
#include <QCheckBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/render/tone_map.h"
#include "editor/fields/number_box.h"
#include "editor/overlays/overlay_mode.h"
#include "editor/panels/colour_box.h"
#include "editor/panels/panel.h"
#include "editor/style/icons.h"
#include "importers/foreign_reader.h"

namespace hairloom::editor {
namespace {

QCheckBox* check(const QString& name, const QString& title, const QString& tip, bool on) {
    auto* box = new QCheckBox(title);
    box->setObjectName(name);
    box->setToolTip(tip);
    box->setChecked(on);
    return box;
}

/// A button with the overlays as a menu, which says how many are chosen.
QToolButton* overlayButton(const Actions& actions) {
    auto* button = new QToolButton;
    button->setObjectName("overlays");
    button->setIcon(icon("overlay"));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setPopupMode(QToolButton::InstantPopup);
    button->setToolTip(
        "Overlays drawn on the viewport, such as roots, guides and strain. Some appear with "
        "their tool, for example density while you paint it");
    auto* menu = new QMenu(button);
    menu->setToolTipsVisible(true);
    button->setMenu(menu);
    QList<QAction*> all;
    for (const OverlayMode& mode : overlayModes()) all << &actions.get(QString("overlay.") + mode.id);
    menu->addActions(all);
    const auto say = [button, all] {
        const auto chosen = std::ranges::count_if(all, [](const QAction* one) { return one->isChecked(); });
        button->setText(chosen == 0 ? QString("Overlays") : QString("Overlays: %1").arg(chosen));
    };
    for (QAction* action : all) QObject::connect(action, &QAction::toggled, button, say);
    say();
    return button;
}

/// As it was painted, its bright parts cut off.
QImage imageOf(const render::LinearImage& picture) {
    QImage image(static_cast<int>(picture.width), static_cast<int>(picture.height), QImage::Format_RGBA8888);
    const auto byte = [](float value) {
        return static_cast<uchar>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
    };
    for (std::uint32_t y = 0; y < picture.height && !image.isNull(); ++y) {
        uchar* to = image.scanLine(static_cast<int>(y));
        const float* from = &picture.rgba[std::size_t{4} * picture.width * y];
        for (std::uint32_t i = 0; i < 4 * picture.width; ++i)
            to[i] = byte(i % 4 == 3 ? from[i] : render::encodeSrgb(std::max(from[i], 0.0f)));
    }
    return image;
}

QWidget* makeParts(const Actions& actions, Viewport& viewport) {
    auto* widget = new QWidget;
    auto* layout = new QHBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(14);
    auto* hair = check("hair", "Hair", "Show the hair", true);
    auto* head = check("head", "Head", "Show the head", true);
    QObject::connect(hair, &QCheckBox::toggled, &viewport, &Viewport::setHairShown);
    QObject::connect(head, &QCheckBox::toggled, &viewport, &Viewport::setHeadShown);
    layout->addWidget(hair);
    layout->addWidget(head);
    layout->addWidget(overlayButton(actions));
    layout->addStretch(1);
    return widget;
}

QWidget* makeLight(Viewport& viewport) {
    auto* widget = new QWidget;
    auto* layout = new QFormLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setVerticalSpacing(6);
    const auto number = [&](const char* name, const QString& label, const QString& tip,
                            std::pair<double, double> range, double value, auto take) {
        auto* box = new NumberBox(range.first, range.second, false);
        box->setObjectName(name);
        box->setValue(value);
        box->setToolTip(tip);
        QObject::connect(box, &NumberBox::edited, &viewport,
                         [take](double edited) { take(static_cast<float>(edited)); });
        layout->addRow(label, box);
        return box;
    };
    auto* turn = number("lightTurn", "Light angle",
                        "Rotates the three lights around the head, in degrees. The Light tool "
                        "drags them in the viewport (Shift+V)",
                        {-180, 180}, 0, [&viewport](float degrees) { viewport.setLightTurn(degrees); });
    turn->setShown(1, QStringLiteral("°"), 0);
    QObject::connect(&viewport, &Viewport::lightTurned, turn,
                     [turn](float degrees) { turn->setValue(static_cast<double>(degrees)); });
    number("exposure", "Exposure", "Brightness of the image. 1.6 shows skin as it is", {0.2, 6}, 1.6,
           [&viewport](float factor) { viewport.setExposure(factor); });
    number("lightScale", "Lights", "Strength of the key, fill and rim lights. 1 is the default", {0, 3}, 1,
           [&viewport](float factor) { viewport.setLight(factor, viewport.environment()); });
    number("environment", "Environment", "Strength of the environment light. 0 leaves only the lights",
           {0, 3}, 1, [&viewport](float factor) { viewport.setLight(viewport.lightScale(), factor); });
    return widget;
}

QWidget* makeReference(Viewport& viewport, Messages& messages) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    auto* row = new QHBoxLayout;
    auto* choose = new QPushButton("Choose…");
    choose->setObjectName("referenceChoose");
    choose->setToolTip("A reference image behind the head: PNG, JPEG or OpenEXR");
    auto* clear = new QPushButton("Remove");
    clear->setObjectName("referenceClear");
    clear->setToolTip("Remove the reference image");
    clear->setEnabled(false);
    row->addWidget(choose);
    row->addWidget(clear);
    layout->addLayout(row);
    auto* opacity = new NumberBox(0, 1, false);
    opacity->setObjectName("referenceOpacity");
    opacity->setValue(1);
    opacity->setToolTip("Opacity of the reference image");
    opacity->setEnabled(false);
    layout->addWidget(opacity);
    const auto show = [&viewport, opacity, clear](const QImage& image) {
        viewport.setReference(image, opacity->value());
        opacity->setEnabled(!image.isNull());
        clear->setEnabled(!image.isNull());
    };
    QObject::connect(choose, &QPushButton::clicked, widget, [&messages, widget, show] {
        const QString path =
            QFileDialog::getOpenFileName(widget, "Reference image", {}, "Images (*.png *.jpg *.jpeg *.exr)");
        if (path.isEmpty()) return;
        const auto picture =
            readPicture(path.toStdString(), {PictureKind::Png, PictureKind::Jpeg, PictureKind::Exr});
        if (!picture) {
            messages.warn(QString::fromStdString(picture.error().message()));
        } else {
            show(imageOf(*picture));
        }
    });
    QObject::connect(clear, &QPushButton::clicked, widget, [show] { show({}); });
    QObject::connect(opacity, &NumberBox::edited, &viewport,
                     [&viewport](double value) { viewport.setReference(viewport.reference(), value); });
    return widget;
}

}  // namespace

PanelInfo viewPanel() {
    return {"view",
            QString("View"),
            "overlay",
            Qt::LeftDockWidgetArea,
            30,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(
                    column({heading("Show"), makeParts(parts.actions, parts.viewport), heading("Light"),
                            makeLight(parts.viewport), heading("Colour"), makeColours(parts),
                            heading("Reference image"), makeReference(parts.viewport, parts.messages)}));
            }};
}

}  // namespace hairloom::editor
