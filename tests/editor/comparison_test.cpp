// SPDX-License-Identifier: GPL-3.0-or-later
// File > Compare with…: what changed since another version.

#include <gmock/gmock.h>

#include <QClipboard>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>

#include "core/groom/file/project_file.h"
#include "editor/dialogs/comparison_dialog.h"
#include "editor/style/actions.h"
#include "tests/editor/nothing_clipped.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class ComparisonTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        openFirstStrands(40);
        ASSERT_TRUE(saveProject(groom(), inFolder("old.hairloom").toStdString()));
    }
    /// Through the menu, as a person does.
    ComparisonDialog* compareWith(const char* file) {
        onceAskedForAFile(inFolder(file));
        trigger("file.compare");
        finishWork();
        const auto dialogs = window->findChildren<ComparisonDialog*>();
        return dialogs.isEmpty() ? nullptr : dialogs.last();
    }
};

TEST_F(ComparisonTest, ListsWhatChangedSinceTheSavedVersion) {
    Groom changed = groom();
    changed.simulation.airDrag = 0.5f;
    change("Air drag", changed);
    ComparisonDialog* const dialog = compareWith("old.hairloom");
    ASSERT_NE(dialog, nullptr);
    EXPECT_FALSE(dialog->isModal());
    const auto* list = dialog->findChild<QTreeWidget*>("differences");
    ASSERT_EQ(list->topLevelItemCount(), 1);
    EXPECT_EQ(list->topLevelItem(0)->text(0), "simulation.airDrag");
    EXPECT_THAT(list->topLevelItem(0)->text(1).toStdString(), testing::HasSubstr("→ 0.5"));
    EXPECT_THAT(dialog->findChild<QLabel*>("summary")->text().toStdString(),
                testing::HasSubstr("old.hairloom and this hair differ in 1 place:"));
    expectNothingClipped(*dialog, "comparison");
    for (auto* button : dialog->findChildren<QPushButton*>())
        if (button->text() == "Copy") button->click();
    EXPECT_THAT(QGuiApplication::clipboard()->text().toStdString(),
                testing::StartsWith("simulation.airDrag: "));
}

TEST_F(ComparisonTest, SaysThatNothingChangedAndShowsErrors) {
    ComparisonDialog* const same = compareWith("old.hairloom");
    ASSERT_NE(same, nullptr);
    EXPECT_THAT(same->findChild<QLabel*>("summary")->text().toStdString(),
                testing::HasSubstr("are the same in old.hairloom"));
    EXPECT_FALSE(same->findChild<QTreeWidget*>("differences")->isVisible());
    delete same;
    QFile torn(inFolder("torn.hairloom"));
    ASSERT_TRUE(torn.open(QIODevice::WriteOnly));
    torn.write("HAIRLOOM");
    torn.close();
    EXPECT_EQ(compareWith("torn.hairloom"), nullptr);
    EXPECT_THAT(window->statusLine().message().toStdString(), testing::HasSubstr("torn.hairloom"));
}

}  // namespace
}  // namespace hairloom::editor
