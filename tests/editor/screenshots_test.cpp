// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of every panel and dialog in both themes, for people to look at: build/…/screenshots. What can be
// checked without eyes is: nothing is clipped.
#include <QAbstractButton>
#include <QComboBox>
#include <QDir>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>

#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "editor/dialogs/preferences_dialog.h"
#include "editor/dialogs/shortcut_dialog.h"
#include "editor/panels/panel.h"
#include "tests/editor/window_fixture.h"

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
    /// Labels that do not wrap, words on buttons and in boxes, and what scrolls have room.
    static void expectNothingClipped(QWidget& widget, const QString& name) {
        const auto expectRoom = [&](int room, int needed, const QString& what) {
            EXPECT_GE(room, needed) << name.toStdString() << ": " << what.toStdString();
        };
        const auto forAll = [&]<class Widget>(auto look) {
            for (auto* child : widget.findChildren<Widget*>()) {
                if (child->isVisibleTo(&widget)) look(*child);
            }
        };
        forAll.operator()<QLabel>([&](const QLabel& label) {
            if (label.wordWrap() || label.text().isEmpty()) return;
            if (label.objectName() == "message") return;  // elides: the tooltip has it all
            expectRoom(label.width(), label.sizeHint().width(), label.text());
        });
        forAll.operator()<QAbstractButton>([&](const QAbstractButton& button) {
            const auto* tool = qobject_cast<const QToolButton*>(&button);
            if (button.text().isEmpty() || (tool && tool->toolButtonStyle() == Qt::ToolButtonIconOnly))
                return;
            expectRoom(button.width(), button.fontMetrics().horizontalAdvance(button.text()), button.text());
        });
        forAll.operator()<QComboBox>([&](const QComboBox& box) {
            constexpr int kArrow = 20;
            expectRoom(box.width() - kArrow, box.fontMetrics().horizontalAdvance(box.currentText()),
                       box.currentText());
        });
        forAll.operator()<QLineEdit>([&](const QLineEdit& edit) {
            expectRoom(edit.width(), edit.fontMetrics().horizontalAdvance(edit.text()), edit.text());
        });
        forAll.operator()<QScrollArea>([&](const QScrollArea& area) {
            if (area.horizontalScrollBarPolicy() != Qt::ScrollBarAlwaysOff) return;
            expectRoom(area.viewport()->width(), area.widget()->width(), "what scrolls");
        });
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
    ASSERT_TRUE(viewport().waitForPicture(120'000));
    shoot(*window, "window");
    windy.simulation.windDirection = {0, 0, 1};
    change("Wind direction", windy);
    trigger("edit.undo");
    trigger("play.step");
    ASSERT_TRUE(QTest::qWaitFor([this] { return parts().player.frame() != nullptr; }, 20'000));
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
    shoot(*window->panel("levels")->widget(), "panel-levels-made");
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
    for (const auto* button : buttons)
        EXPECT_EQ(button->isDefault(), button->text() == "Close") << button->text().toStdString();
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

INSTANTIATE_TEST_SUITE_P(Both, ScreenshotsTest, testing::Values(Theme::Dark, Theme::Light),
                         [](const auto& theme) { return theme.param == Theme::Dark ? "dark" : "light"; });

}  // namespace
}  // namespace hairloom::editor
