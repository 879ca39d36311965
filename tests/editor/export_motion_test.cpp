// SPDX-License-Identifier: GPL-3.0-or-later
// What the export dialog asks of hair that moves, and of hair at rest.

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QFileInfo>
#include <QSpinBox>

#include "editor/dialogs/export_dialog.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class ExportMotionTest : public WindowTest {};

TEST_F(ExportMotionTest, MotionIsAskedForWhereItIsWritten) {
    openSampleHair("short");
    openFirstStrands(20);
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.show();
    dialog.findChild<QComboBox*>("target")->setCurrentText("Houdini");
    auto* frames = dialog.findChild<QSpinBox*>("frames");
    auto* shutter = dialog.findChild<QComboBox*>("shutter");
    auto* physics = dialog.findChild<QCheckBox*>("physics");
    EXPECT_FALSE(shutter->isVisible()) << "at rest";
    EXPECT_TRUE(physics->isVisible());
    auto* what = dialog.findChild<QComboBox*>("what");
    EXPECT_EQ(what->count(), 3) << "USD keeps guides apart";
    physics->setChecked(true);
    dialog.exportTo(inFolder("still.usdc"));
    finishWork();
    EXPECT_EQ(dialog.report().strands, 20u);
    frames->setValue(3);
    EXPECT_TRUE(shutter->isVisible());
    EXPECT_FALSE(physics->isVisible()) << "of hair at rest";
    EXPECT_FALSE(dialog.findChild<QSpinBox*>("shutterSamples")->isEnabled());
    dialog.findChild<QSpinBox*>("preRoll")->setValue(2);
    dialog.findChild<QSpinBox*>("startFrame")->setValue(1001);
    shutter->setCurrentIndex(1);
    dialog.exportTo(inFolder("moving.usdc"));
    finishWork();
    EXPECT_EQ(dialog.report().frames, 3u) << window->statusLine().message().toStdString();
    EXPECT_EQ(dialog.report().samples, 9u);
    EXPECT_TRUE(QFileInfo::exists(inFolder("moving.usdc")));
    dialog.findChild<QComboBox*>("target")->setCurrentText("PLY strands");
    EXPECT_EQ(what->count(), 2);
    EXPECT_FALSE(shutter->isVisible());
}

}  // namespace
}  // namespace hairloom::editor
