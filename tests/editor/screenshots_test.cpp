// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of every panel and dialog in both themes, for people to look at: build/…/screenshots. What can be
// checked without eyes is: nothing is clipped.
#include <QAbstractButton>
#include <QComboBox>
#include <QDir>
#include <QLabel>
#include <QRegularExpression>
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
        session().preferences.setTheme(GetParam());
        QDir().mkpath(HAIRLOOM_SCREENSHOTS);
    }
    void TearDown() override {
        session().preferences.setTheme(Theme::Dark);
        WindowTest::TearDown();
    }
    void shoot(QWidget& widget, const QString& name) {
        QCoreApplication::processEvents();
        const QString theme = GetParam() == Theme::Dark ? "dark" : "light";
        const QString file = QStringLiteral("%1/%2-%3.png").arg(HAIRLOOM_SCREENSHOTS, name, theme);
        EXPECT_TRUE(widget.grab().save(file)) << file.toStdString();
        expectNothingClipped(widget, name);
    }
    /// Words on labels that do not wrap and on buttons have room.
    static void expectNothingClipped(QWidget& widget, const QString& name) {
        for (auto* label : widget.findChildren<QLabel*>()) {
            if (!label->isVisibleTo(&widget) || label->wordWrap() || label->text().isEmpty()) continue;
            if (label->objectName() == "message") continue;  // elides: the tooltip has it all
            EXPECT_GE(label->width(), label->fontMetrics().horizontalAdvance(
                                          label->text().remove(QRegularExpression("<[^>]*>"))) /
                                          2)
                << name.toStdString() << ": " << label->text().toStdString();
        }
        for (auto* button : widget.findChildren<QAbstractButton*>()) {
            if (!button->isVisibleTo(&widget) || button->text().isEmpty()) continue;
            const auto* tool = qobject_cast<QToolButton*>(button);
            if (tool && tool->toolButtonStyle() == Qt::ToolButtonIconOnly) continue;
            EXPECT_GE(button->width(), button->fontMetrics().horizontalAdvance(button->text()))
                << name.toStdString() << ": " << button->text().toStdString();
        }
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
    document().change("Wind speed", Change::Simulation, windy);
    ASSERT_TRUE(viewport().waitForPicture(120'000));
    shoot(*window, "window");
    trigger("play.step");
    ASSERT_TRUE(QTest::qWaitFor([this] { return session().player.frame() != nullptr; }, 20'000));
    trigger("tool.comb");
    for (const PanelInfo& info : panels()) {
        QDockWidget* const dock = window->panel(info.id);
        dock->raise();
        dock->setFloating(false);
        QCoreApplication::processEvents();
        shoot(*dock->widget(), "panel-" + info.id);
    }
}

TEST_P(ScreenshotsTest, Dialogs) {
    openSampleHair("short");
    PreferencesDialog preferences(session().preferences, window.get());
    preferences.show();
    shoot(preferences, "preferences");
    preferences.hide();
    ShortcutDialog shortcuts(window->actions(), window.get());
    shortcuts.show();
    shoot(shortcuts, "shortcuts");
    shortcuts.hide();
    ExportDialog exporting(session(), window.get());
    exporting.show();
    exporting.exportTo(inFolder("hair.tfx"));
    finishWork();
    shoot(exporting, "export");
    exporting.hide();
    openBust();
    ImportDialog importing(session(), inFolder("hair.tfx"), window.get());
    importing.show();
    finishWork();
    shoot(importing, "import");
}

INSTANTIATE_TEST_SUITE_P(Both, ScreenshotsTest, testing::Values(Theme::Dark, Theme::Light),
                         [](const auto& theme) { return theme.param == Theme::Dark ? "dark" : "light"; });

}  // namespace
}  // namespace hairloom::editor
