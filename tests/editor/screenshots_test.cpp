// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of every panel and dialog in both themes, for people to look at: build/…/screenshots. What can be
// checked without eyes is: nothing is clipped.
#include <QDir>
#include <QPushButton>
#include <QSpinBox>
#include <QToolButton>
#include <QTreeWidget>

#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/head_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "editor/dialogs/preferences_dialog.h"
#include "editor/dialogs/shortcut_dialog.h"
#include "editor/panels/panel.h"
#include "tests/editor/nothing_clipped.h"
#include "tests/editor/window_fixture.h"
#include "tests/support/source_dir.h"

namespace hairloom::editor {
namespace {

class ScreenshotsTest : public WindowTest, public testing::WithParamInterface<Theme> {
  protected:
    ScreenshotsTest() : WindowTest(true) {}
    void SetUp() override {
        WindowTest::SetUp();
        parts().preferences.setTheme(GetParam());
        QDir().mkpath(HAIRLOOM_SCREENSHOTS);
    }
    void TearDown() override {
        parts().preferences.setTheme(Theme::Dark);
        WindowTest::TearDown();
    }
    void shoot(QWidget& widget, const QString& name) {
        QCoreApplication::processEvents();
        const QString theme = GetParam() == Theme::Dark ? "dark" : "light";
        const QString file = QStringLiteral("%1/%2-%3.png").arg(HAIRLOOM_SCREENSHOTS, name, theme);
        EXPECT_TRUE(widget.grab().save(file)) << file.toStdString();
        expectNothingClipped(widget, name);
    }
};

TEST_P(ScreenshotsTest, StartPage) {
    shoot(*window, "start");
}

TEST_P(ScreenshotsTest, WindowAndPanels) {
    drawQuickly();
    openSampleHair("shoulder");
    Groom fewer = groom();
    // As many as a software device draws in a few seconds.
    fewer.interpolation.followPerGuide = 3;
    document().open(fewer, {}, "shoulder");
    Groom windy = groom();
    windy.simulation.windSpeed = 4;
    change("Wind speed", windy);
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    shoot(*window, "window");
    windy.simulation.windDirection = {0, 0, 1};
    change("Wind direction", windy);
    trigger("edit.undo");
    trigger("play.step");
    ASSERT_TRUE(QTest::qWaitFor([this] { return parts().player.frame() != nullptr; }, kPatience));
    window->panel("motion")->raise();
    shoot(*window->panel("motion")->widget(), "panel-motion-under-way");
    trigger("tool.comb");
    for (const PanelInfo& info : panels()) {
        QDockWidget* const dock = window->panel(info.id);
        dock->raise();
        dock->setFloating(false);
        QCoreApplication::processEvents();
        shoot(*dock->widget(), "panel-" + info.id);
    }
}

TEST_P(ScreenshotsTest, LevelsThatAreMade) {
    openSampleHair("short");
    openFirstStrands(300);
    window->panel("levels")->raise();
    find<QPushButton>("levelsMake")->click();
    finishWork();
    // As narrow as a window of 1280 pixels makes it.
    trigger("view.resetLayout");
    window->panel("levels")->raise();
    shoot(*window->panel("levels"), "panel-levels-made");
}

TEST_P(ScreenshotsTest, Dialogs) {
    openSampleHair("short");
    PreferencesDialog preferences(parts().preferences, window.get());
    preferences.show();
    shoot(preferences, "preferences");
    preferences.hide();
    ShortcutDialog shortcuts(window->actions(), window.get());
    shortcuts.show();
    shoot(shortcuts, "shortcuts");
    const auto buttons = shortcuts.findChildren<QPushButton*>();
    EXPECT_GE(buttons.size(), 2);
    // Return is the list's.
    for (const auto* button : buttons) EXPECT_FALSE(button->isDefault()) << button->text().toStdString();
    shortcuts.hide();
    ExportDialog exporting(document(), parts().preferences, parts().tasks, parts().messages, parts().player,
                           window.get());
    exporting.show();
    exporting.exportTo(inFolder("hair.tfx"));
    finishWork();
    shoot(exporting, "export");
    exporting.hide();
    openBust();
    ImportDialog importing(document(), parts().tasks, inFolder("hair.tfx"), window.get());
    importing.show();
    finishWork();
    shoot(importing, "import");
}

TEST_P(ScreenshotsTest, HeadsWithClothes) {
    const auto shootHead = [&](const std::filesystem::path& file, const char* clothes, const QString& name) {
        window->showHeadDialog(QString::fromStdString(file.string()));
        finishWork();
        auto* dialog = window->findChild<HeadDialog*>();
        ASSERT_TRUE(dialog);
        auto* groups = dialog->findChild<QTreeWidget*>("headGroups");
        const auto found = groups->findItems(clothes, Qt::MatchExactly);
        ASSERT_EQ(found.size(), 1);
        groups->scrollToItem(found[0]);
        found[0]->setSelected(true);
        dialog->findChild<QPushButton*>("groupCollide")->click();
        dialog->findChild<QSpinBox*>("colliderSpheres")->setValue(24);
        while (parts().tasks.isBusy()) finishWork();
        shoot(*dialog, name);
        dialog->reject();
        QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    };
    shootHead(samplesFolder() / "bust/bust.glb", "bust_shoulders", "head");
    const auto body = outsideData() / "heads/makehuman_base.obj";
    if (!std::filesystem::exists(body)) GTEST_SKIP() << body << " is not there";
    shootHead(body, "helper-tights", "head-body");
}

INSTANTIATE_TEST_SUITE_P(Both, ScreenshotsTest, testing::Values(Theme::Dark, Theme::Light),
                         [](const auto& theme) { return theme.param == Theme::Dark ? "dark" : "light"; });

}  // namespace
}  // namespace hairloom::editor
