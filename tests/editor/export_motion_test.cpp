// SPDX-License-Identifier: GPL-3.0-or-later
// What the export dialog asks of hair that moves, and of hair at rest.

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QFileInfo>
#include <QPushButton>
#include <QSpinBox>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "editor/dialogs/export_dialog.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class ExportMotionTest : public WindowTest {
  protected:
    std::string textOf(const char* name) const {
        std::ifstream file(inFolder(name).toStdString());
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

TEST_F(ExportMotionTest, AVersionInTheNameIsTheNextThatIsFree) {
    openSampleHair("short");
    openFirstStrands(20);
    ASSERT_TRUE(QFile(inFolder("hair_v004.ply.report.txt")).open(QIODevice::WriteOnly));
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.show();
    dialog.findChild<QComboBox*>("target")->setCurrentText("PLY strands");
    for (const char* name : {"hair_v005.ply", "hair_v006.ply"}) {
        onceAskedForAFile(inFolder("hair_v###.ply"));
        dialog.findChild<QPushButton*>("export")->click();
        finishWork();
        EXPECT_TRUE(QFileInfo::exists(inFolder(name))) << name;
    }
}

TEST_F(ExportMotionTest, TheFormatFollowsTheSuffixOfTheFileName) {
    openSampleHair("short");
    openFirstStrands(20);
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.show();
    dialog.findChild<QComboBox*>("target")->setCurrentText("Houdini");
    auto* format = dialog.findChild<QComboBox*>("format");
    const auto exportAs = [&](const char* name) {
        onceAskedForAFile(inFolder(name));
        dialog.findChild<QPushButton*>("export")->click();
        finishWork();
    };
    ASSERT_EQ(format->currentText(), "USD .usdc");
    exportAs("hair.usda");
    EXPECT_EQ(format->currentText(), "USD .usda");
    EXPECT_EQ(textOf("hair.usda").substr(0, 5), "#usda");
    exportAs("hair.abc");
    EXPECT_EQ(format->currentText(), "Alembic .abc");
    EXPECT_EQ(textOf("hair.abc").substr(0, 5), "Ogawa");
    exportAs("other");
    EXPECT_EQ(textOf("other.abc").substr(0, 5), "Ogawa");
}

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
    dialog.findChild<QSpinBox*>("handles")->setValue(4);
    shutter->setCurrentIndex(0);
    dialog.findChild<QCheckBox*>("manifest")->setChecked(true);
    dialog.findChild<QComboBox*>("format")->setCurrentText("USD .usda");
    dialog.exportTo(inFolder("handles.usda"));
    finishWork();
    EXPECT_EQ(dialog.report().frames, 11u) << "three and four at each end";
    const std::string usd = textOf("handles.usda");
    EXPECT_NE(usd.find("startTimeCode = 997"), std::string::npos) << usd.substr(0, 400);
    EXPECT_NE(usd.find("endTimeCode = 1007"), std::string::npos);
    const auto manifest = nlohmann::json::parse(textOf("handles.usda.manifest.json"));
    ASSERT_EQ(manifest["files"].size(), 1u);
    EXPECT_EQ(manifest["files"][0]["name"], "handles.usda");
    EXPECT_EQ(manifest["files"][0]["bytes"], usd.size());
    EXPECT_EQ(manifest["groom"]["strands"], 20);
    EXPECT_EQ(manifest["command"], "Export: Houdini");
    dialog.findChild<QSpinBox*>("handles")->setValue(0);
    frames->setValue(2);
    for (const int rate : {1, 24, 240}) {
        dialog.findChild<QDoubleSpinBox*>("frameRate")->setValue(rate);
        dialog.exportTo(inFolder("rate.usda"));
        finishWork();
        EXPECT_NE(textOf("rate.usda").find("timeCodesPerSecond = " + std::to_string(rate)), std::string::npos)
            << rate << ": " << window->statusLine().message().toStdString();
    }
    dialog.findChild<QComboBox*>("target")->setCurrentText("PLY strands");
    EXPECT_EQ(what->count(), 2);
    EXPECT_FALSE(shutter->isVisible());
}

}  // namespace
}  // namespace hairloom::editor
