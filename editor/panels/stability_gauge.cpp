// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/stability_gauge.h"

#include <QPushButton>
#include <algorithm>
#include <cmath>

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/simulation/scene_input.h"
#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

constexpr float kFrameTime = 1.0f / 60.0f;
constexpr int kMinShown = 3;  // of 100, so that the colour of a margin that is used up is seen

runtime::StableAdvice adviceFor(const Groom& groom) {
    return runtime::adviseStability(strandsAtRest(groom), groom.simulation, kFrameTime);
}

}  // namespace

StabilityGauge::StabilityGauge(QtDocument& document, const Preferences& preferences, QWidget* parent)
    : QWidget(parent),
      document_(document),
      preferences_(preferences),
      bar_(new QProgressBar),
      map_(new StepMap(preferences)),
      words_(new QLabel),
      offers_(new QVBoxLayout) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    bar_->setObjectName("stability");
    bar_->setRange(0, 100);
    bar_->setTextVisible(false);
    bar_->setFixedHeight(10);
    bar_->setToolTip(
        "Margin to the longest stable time step. When empty, the simulation is about to explode");
    words_->setWordWrap(true);
    words_->setProperty("role", "dim");
    layout->addWidget(bar_);
    layout->addWidget(words_);
    layout->addWidget(map_);
    layout->addLayout(offers_);
    soon_.setSingleShot(true);
    soon_.setInterval(80);
    connect(&soon_, &QTimer::timeout, this, [this] {
        // It looks at every strand: not while a hand rests amid a stroke.
        document_.editing().stroke() ? soon_.start() : update();
    });
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::Physics | editing::kHairParts)) outdate();
    });
    connect(&preferences_, &Preferences::changed, this, &StabilityGauge::outdate);
    outdate();
}

void StabilityGauge::outdate() {
    isOutdated_ = true;
    setVisible(document_.groom().strandCount() > 0);
    if (isVisible()) soon_.start();
}

void StabilityGauge::showEvent(QShowEvent*) {
    if (isOutdated_) soon_.start();
}

void StabilityGauge::hideEvent(QHideEvent*) {
    soon_.stop();
}

void StabilityGauge::update() {
    while (QLayoutItem* item = offers_->takeAt(0)) {
        delete item->widget();
        delete item;
    }
    isOutdated_ = false;
    const Groom& groom = document_.groom();
    advice_ = adviceFor(groom);
    map_->setGroom(groom);
    const double factor = advice_.region.factor;
    const double margin = std::isfinite(factor) ? std::clamp(1 - factor, 0.0, 1.0) : 0;
    bar_->setValue(std::max(kMinShown, static_cast<int>(100 * margin)));
    const ThemeColours colours = themeColours(preferences_.theme());
    const QColor colour = factor > 1                                ? colours.bad
                          : factor > 0.8 || advice_.rest.trembles() ? colours.caution
                                                                    : colours.good;
    bar_->setStyleSheet(QStringLiteral("QProgressBar::chunk { background: %1; }").arg(colour.name()));
    words_->setText(!advice_.words.empty() ? QString::fromStdString(advice_.words)
                    : factor > 0
                        ? QString("Stable: at %1 % of the longest stable step").arg(100 * factor, 0, 'f', 0)
                        : QString("Stable at any step: all stiff forces are implicit"));
    for (const runtime::StableOffer& offer : advice_.offers) {
        auto* button = new QPushButton(QString::fromStdString(offer.words));
        button->setToolTip("Applies these settings. You can undo this");
        offers_->addWidget(button);
        connect(button, &QPushButton::clicked, this, [this, settings = offer.settings] {
            document_.perform(editing::setPhysics(document_.editing().model(), settings, "Stable settings"));
        });
    }
}

}  // namespace hairloom::editor
