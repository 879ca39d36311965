// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/brush_hand.h"

#include <QCoreApplication>
#include <QSettings>

namespace hairloom::editor {
namespace {

constexpr const char* kSame = "brushes/same";
constexpr const char* kInPixels = "brushes/inPixels";
constexpr const char* kThroughHair = "brushes/throughHair";

}  // namespace

BrushHand::BrushHand()
    : same(QSettings().value(kSame, false).toBool()),
      inPixels(QSettings().value(kInPixels, false).toBool()),
      throughHair(QSettings().value(kThroughHair, true).toBool()) {}

void BrushHand::addOptions(OptionForm& form, bool worksOnSkin, const std::function<void()>& changed) {
    const auto add = [&](const char* name, const QString& label, const QString& tip, bool BrushHand::*member,
                         const char* key) {
        form.addBool(
            name, label, tip, [this, member] { return this->*member; },
            [this, member, key, changed](bool on) {
                this->*member = on;
                QSettings().setValue(key, on);
                changed();
            });
    };
    if (!worksOnSkin)
        add("brushThroughHair", "Through hair",
            "Affects all hair in front of the head. When off, the brush reaches as deep as Depth",
            &BrushHand::throughHair, kThroughHair);
    add("brushInPixels", "View size",
        "Keeps the brush size constant on screen: the brush is finer on near hair than on far hair",
        &BrushHand::inPixels, kInPixels);
    add("brushSame", "Unified size",
        "Shares radius and strength between all brushes. When off, each brush has its own", &BrushHand::same,
        kSame);
}

}  // namespace hairloom::editor
