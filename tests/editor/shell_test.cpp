// SPDX-License-Identifier: GPL-3.0-or-later
// Opening, saving, leaving, recovering, preferences, shortcuts.
#include <QComboBox>
#include <QDir>
#include <QDockWidget>
#include <QDropEvent>
#include <QFile>
#include <QFileInfo>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QMenu>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTabBar>
#include <QToolBar>
#include <QToolButton>

#include "core/base/file.h"
#include "core/documents/hair_import.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "editor/dialogs/preferences_dialog.h"
#include "editor/dialogs/shortcut_dialog.h"
#include "editor/fields/number_box.h"
#include "editor/panels/panel.h"
#include "editor/shell/start_page.h"
#include "importers/strands.h"
#include "tests/editor/nothing_clipped.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class ShellTest : public WindowTest {
  protected:
    bool isShown(const QWidget& widget, const QRect& part) {
        return widget.isVisible() &&
               window->rect().contains(QRect(widget.mapTo(window.get(), part.topLeft()), part.size()));
    }
    void expectToolsShown() {
        for (QToolBar* bar : window->findChildren<QToolBar*>()) {
            for (QAction* action : bar->actions()) {
                const QWidget* button = bar->widgetForAction(action);
                EXPECT_TRUE(isShown(*button, button->rect())) << action->text().toStdString();
            }
        }
        std::size_t tools = 0;
        for (const QToolButton* button : find<QToolBar>("bar:tools")->findChildren<QToolButton*>()) {
            if (!button->defaultAction()) continue;
            ++tools;
            EXPECT_TRUE(isShown(*button, button->rect())) << button->toolTip().toStdString();
        }
        EXPECT_EQ(tools, parts().tools.all().size() + 1) << "and the one that moves the view";
    }
};

TEST_F(ShellTest, TheViewHas700PixelsAt1366By768AndNoControlIsClipped) {
    openBust();
    window->resize(1366, 768);
    trigger("view.resetLayout");
    QCoreApplication::processEvents();
    EXPECT_EQ(window->size(), QSize(1366, 768));
    EXPECT_GE(viewport().width(), 700);
    for (const PanelInfo& info : panels()) {
        QDockWidget* const panel = window->panel(info.id);
        panel->show();
        panel->raise();
        QCoreApplication::processEvents();
        expectNothingClipped(*panel, info.id);
    }
    EXPECT_GE(viewport().width(), 700) << "whichever panel is in front";
}

TEST_F(ShellTest, EveryToolCanBeReachedIn856Pixels) {
    openBust();
    window->resize(856, 640);
    QCoreApplication::processEvents();
    EXPECT_EQ(window->width(), 856);
    EXPECT_GE(viewport().width(), 240);
    expectToolsShown();
}

TEST_F(ShellTest, EveryToolAndPanelCanBeReachedAt1280By800) {
    window->resize(1280, 800);
    QCoreApplication::processEvents();
    EXPECT_EQ(window->size(), QSize(1280, 800)) << "nothing asks for more";
    expectToolsShown();
    for (QTabBar* tabs : window->findChildren<QTabBar*>()) {
        for (int tab = 0; tab < tabs->count() && tabs->isVisible(); ++tab) {
            EXPECT_TRUE(isShown(*tabs, tabs->tabRect(tab))) << tabs->tabText(tab).toStdString();
            const QFontMetrics font = tabs->fontMetrics();
            EXPECT_GE(std::max(tabs->tabRect(tab).width(), tabs->tabRect(tab).height()),
                      font.horizontalAdvance(tabs->tabText(tab)))
                << tabs->tabText(tab).toStdString() << " is cut short";
        }
    }
}

TEST_F(ShellTest, APanelThatIsChosenIsInFront) {
    QDockWidget* const look = window->panel("look");
    QDockWidget* const physics = window->panel("physics");
    const auto choose = [&](QDockWidget* dock) {
        auto* const menu = window->findChild<QMenu*>("panels");
        menu->aboutToShow();
        dock->toggleViewAction()->trigger();
        menu->aboutToHide();
        QApplication::processEvents();
    };
    const auto isInFront = [](const QDockWidget* dock) { return !dock->visibleRegion().isEmpty(); };
    look->raise();
    QApplication::processEvents();
    ASSERT_TRUE(look->isVisible() && physics->isVisible());
    ASSERT_FALSE(isInFront(physics));
    choose(physics);
    EXPECT_TRUE(isInFront(physics)) << "it was open behind another one";
    choose(physics);
    EXPECT_FALSE(physics->isVisible()) << "it was in front";
    look->raise();
    choose(physics);
    EXPECT_TRUE(isInFront(physics));
}

TEST_F(ShellTest, AnEmptyWindowSaysWhatToDoFirstAndOffersTheSamples) {
    auto* first = find<QLabel>("firstStep");
    EXPECT_TRUE(first->isVisible());
    EXPECT_FALSE(first->text().contains('\n'));
    for (const char* name : {"sample:", "sample:afro", "sample:bob", "sample:braid", "sample:long",
                             "sample:short", "sample:shoulder"}) {
        EXPECT_TRUE(find<QPushButton>(name)->isVisible()) << name;
    }
    QTest::mouseClick(find<QPushButton>("sample:"), Qt::LeftButton);
    finishWork();
    EXPECT_TRUE(groom().scalp);
    EXPECT_FALSE(first->isVisible());
    EXPECT_TRUE(parts().player.actor());
    EXPECT_TRUE(parts().player.motions().contains("clip:nod_and_turn"));
}

TEST_F(ShellTest, WhatIsSavedOpensAgainWithTheSameHash) {
    openSampleHair("short");
    const auto before = hash();
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    EXPECT_FALSE(window->isWindowModified());
    trigger("file.new");
    EXPECT_TRUE(document().isEmpty());
    window->open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(document().path(), inFolder("a.hairloom"));
    EXPECT_EQ(parts().preferences.recentFiles().value(0), inFolder("a.hairloom"));
}

TEST_F(ShellTest, WhatAKilledRunLeftBesideRecentFilesIsOfferedForRemoval) {
    openSampleHair("short");
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    const QString left = inFolder(".a.hairloom.0123456789abc.hairloom-part");
    QFile file(left);
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write("half");
    file.close();
    StartPage page(files(), parts().preferences);
    auto* remove = page.findChild<QPushButton*>("removeLeftOver");
    ASSERT_TRUE(remove);
    EXPECT_TRUE(QFileInfo::exists(left));
    remove->click();
    EXPECT_FALSE(QFileInfo::exists(left));
    EXPECT_TRUE(QFileInfo::exists(inFolder("a.hairloom")));
}

TEST_F(ShellTest, SavingOverAFileOfAnotherKindIsRefused) {
    openSampleHair("short");
    QFile file(inFolder("notes.hairloom"));
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write("my notes");
    file.close();
    EXPECT_FALSE(window->saveTo(file.fileName()));
    EXPECT_TRUE(window->statusLine().message().contains("is text"))
        << window->statusLine().message().toStdString();
    ASSERT_TRUE(file.open(QIODevice::ReadOnly));
    EXPECT_EQ(file.readAll(), "my notes");
}

TEST_F(ShellTest, UnreadableFileIsReportedAndChangesNothing) {
    openSampleHair("short");
    const auto before = hash();
    QFile file(inFolder("broken.hair"));
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write("HAIR and then nothing");
    file.close();
    files().open(file.fileName());
    finishWork();
    EXPECT_TRUE(window->statusLine().message().contains("broken.hair"))
        << window->statusLine().message().toStdString();
    EXPECT_EQ(hash(), before);
}

TEST_F(ShellTest, UnsavedChangesAreGuarded) {
    openSampleHair("short");
    ASSERT_TRUE(window->saveTo(inFolder("guarded.hairloom")));
    Groom changed = groom();
    changed.material.specular = 1.25f;
    change("Specular", changed);
    EXPECT_TRUE(window->isWindowModified());
    const auto unsaved = hash();
    window->setUnsavedAnswer(MainWindow::Unsaved::Keep);
    trigger("file.new");
    EXPECT_EQ(hash(), unsaved);
    EXPECT_FALSE(window->close());
    window->setUnsavedAnswer(MainWindow::Unsaved::Save);
    trigger("file.new");
    EXPECT_TRUE(document().isEmpty());
    const auto saved = openProject(inFolder("guarded.hairloom").toStdString());
    ASSERT_TRUE(saved);
    EXPECT_EQ(contentHash(*saved), unsaved);
}

TEST_F(ShellTest, DroppedFilesOpen) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(QString::fromStdString((samplesFolder() / "bust/bust.obj").string()))});
    QDragEnterEvent enter({10, 10}, Qt::CopyAction, &data, Qt::LeftButton, {});
    QCoreApplication::sendEvent(window.get(), &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent drop({10, 10}, Qt::CopyAction, &data, Qt::LeftButton, {});
    QCoreApplication::sendEvent(window.get(), &drop);
    finishWork();
    EXPECT_TRUE(groom().scalp);
}

TEST_F(ShellTest, WorkCanBeCancelled) {
    files().openSample("long");
    parts().tasks.cancel();
    finishWork();
    EXPECT_TRUE(document().isEmpty());
    EXPECT_FALSE(parts().tasks.isBusy());
}

TEST_F(ShellTest, AfterACrashTheWorkIsOffered) {
    openSampleHair("short");
    Groom changed = groom();
    changed.material.specular = 1.25f;
    change("Specular", changed);
    const auto unsaved = hash();
    // A copy whose program is gone: its lock is not held.
    ASSERT_TRUE(saveProject(groom(), recoveryFolder() / "crashed.hairloom"));
    const auto found = recoveryCopies();
    ASSERT_EQ(found.size(), 1u);
    trigger("file.new");
    files().openRecovered(found[0]);
    finishWork();
    EXPECT_EQ(hash(), unsaved);
    EXPECT_TRUE(window->isWindowModified());
    EXPECT_TRUE(removeRecoveryCopy(found[0]));
    EXPECT_TRUE(recoveryCopies().empty());
}

TEST_F(ShellTest, AutosaveKeepsWhatIsUnsavedUntilTheProgramEndsProperly) {
    QtDocument edited;
    const Preferences preferences;
    QString file;
    {
        Autosave autosave(edited, preferences);
        file = autosave.file();
        openSampleHair("short");
        edited.open(groom(), {}, "short");
        autosave.saveNow();
        autosave.finish();
        EXPECT_FALSE(QFile::exists(file)) << "nothing is unsaved yet";
        Groom changed = groom();
        changed.material.specular = 0.75f;
        edited.perform(editing::setMaterial(edited.editing().model(), changed.material));
        autosave.saveNow();
        autosave.finish();
        const auto copy = openProject(file.toStdString());
        ASSERT_TRUE(copy) << copy.error().message();
        EXPECT_EQ(contentHash(*copy), contentHash(edited.groom()));
        EXPECT_TRUE(recoveryCopies().empty()) << "the program still runs";
    }
    EXPECT_FALSE(QFile::exists(file));
}

TEST_F(ShellTest, PreferencesTakeEffectAtOnceAndLast) {
    PreferencesDialog dialog(parts().preferences);
    auto* unit = dialog.findChild<QComboBox*>("unit");
    unit->setCurrentIndex(3);
    Q_EMIT unit->activated(3);
    EXPECT_EQ(parts().preferences.unit(), DisplayUnit::Inch);
    EXPECT_EQ(Preferences().unit(), DisplayUnit::Inch);
    const QColor dark = QApplication::palette().color(QPalette::Window);
    trigger("view.theme");
    EXPECT_GT(QApplication::palette().color(QPalette::Window).lightness(), dark.lightness());
    trigger("view.theme");
    EXPECT_EQ(QApplication::palette().color(QPalette::Window), dark);
}

TEST_F(ShellTest, UndoHoldsAsMuchMemoryAsThePreferencesAllow) {
    openSampleHair("short");
    Groom moved = groom();
    for (int step = 0; step < 3; ++step) {
        for (Vec3f& point : moved.pointAttributes.edit<Vec3f>(attribute::kPosition)) point.y() += 1e-4f;
        document().perform(editing::replaceGroom(document().editing().model(), moved, "Move"));
    }
    EXPECT_EQ(document().historyLimit(), std::size_t{512} << 20u);
    PreferencesDialog dialog(parts().preferences);
    auto* memory = dialog.findChild<QSpinBox*>("undoMemory");
    ASSERT_TRUE(memory);
    memory->setValue(1);
    EXPECT_EQ(memory->value(), kLeastUndoMegabytes);
    EXPECT_EQ(Preferences().undoMegabytes(), kLeastUndoMegabytes) << "kept for the next start";
    EXPECT_EQ(document().historyLimit(), std::size_t{64} << 20u);
    EXPECT_EQ(document().stepCount(), 3) << "these fit";
    openSampleHair("short");
    EXPECT_EQ(document().historyLimit(), std::size_t{64} << 20u) << "of every document";
    document().setHistoryLimit(1);
    for (int step = 0; step < 3; ++step) {
        for (Vec3f& point : moved.pointAttributes.edit<Vec3f>(attribute::kPosition)) point.y() += 1e-4f;
        document().perform(editing::replaceGroom(document().editing().model(), moved, "Move"));
    }
    EXPECT_EQ(document().stepCount(), 1) << "the newest always stays";
}

TEST_F(ShellTest, ShortcutsCanBeChangedAndAreUnique) {
    ShortcutDialog dialog(window->actions());
    auto* edit = dialog.findChild<QKeySequenceEdit*>("view.frame");
    ASSERT_TRUE(edit);
    const QKeySequence taken = window->actions().get("file.save").shortcut();
    edit->setKeySequence(taken);
    Q_EMIT edit->editingFinished();
    EXPECT_EQ(window->actions().get("view.frame").shortcut(), taken);
    EXPECT_TRUE(window->actions().get("file.save").shortcut().isEmpty());
    window->actions().resetShortcuts();
    EXPECT_EQ(window->actions().get("file.save").shortcut(), taken);
}

TEST_F(ShellTest, TheHistoryPanelSaysHowMuchMemoryUndoHolds) {
    openSampleHair("short");
    const auto said = [this] {
        for (const QLabel* label : window->panel("history")->findChildren<QLabel*>()) {
            if (label->text().contains("of 512 MB")) return label->text();
        }
        return QString();
    };
    const QString empty = said();
    EXPECT_FALSE(empty.isEmpty());
    Groom moved = groom();
    for (Vec3f& point : moved.pointAttributes.edit<Vec3f>(attribute::kPosition)) point.y() += 1e-4f;
    document().perform(editing::replaceGroom(document().editing().model(), moved, "Move"));
    EXPECT_NE(said(), empty);
    EXPECT_GT(document().historyBytes(), groom().pointCount() * sizeof(Vec3f) - 1);
}

TEST_F(ShellTest, EmptyWindowDisablesUselessActions) {
    EXPECT_FALSE(window->actions().get("file.save").isEnabled());
    EXPECT_FALSE(window->actions().get("tool.comb").isEnabled());
    EXPECT_FALSE(window->panel("look")->widget()->isEnabled());
    openBust();
    EXPECT_TRUE(window->actions().get("file.save").isEnabled());
    EXPECT_TRUE(window->actions().get("tool.comb").isEnabled());
    EXPECT_TRUE(window->panel("look")->widget()->isEnabled());
}

TEST_F(ShellTest, EveryActionHasATipAndNoTwoShareKeys) {
    QHash<QString, QString> keys;
    EXPECT_GT(window->actions().all().size(), 40u);
    for (const ActionInfo& info : window->actions().all()) {
        EXPECT_FALSE(info.tip.isEmpty()) << info.id.toStdString();
        const QString shortcut = info.shortcut.toString();
        if (shortcut.isEmpty()) continue;
        EXPECT_FALSE(keys.contains(shortcut))
            << info.id.toStdString() << " and " << keys[shortcut].toStdString() << " share "
            << shortcut.toStdString();
        keys[shortcut] = info.id;
    }
}

TEST_F(ShellTest, EveryControlOfThePanelsHasATip) {
    for (const PanelInfo& info : panels()) {
        int controls = 0;
        for (QWidget* control : window->panel(info.id)->widget()->findChildren<QWidget*>()) {
            ++controls;
            const bool isControl =
                qobject_cast<QAbstractButton*>(control) || qobject_cast<QComboBox*>(control) ||
                qobject_cast<QAbstractSpinBox*>(control) || qobject_cast<QSlider*>(control);
            if (!isControl) continue;
            bool hasTip = false;
            for (QWidget* at = control; at && !hasTip; at = at->parentWidget())
                hasTip = !at->toolTip().isEmpty();
            EXPECT_TRUE(hasTip) << info.id.toStdString() << ": " << control->objectName().toStdString() << " "
                                << control->metaObject()->className();
        }
        EXPECT_GT(controls, 0) << info.id.toStdString();
    }
}

TEST_F(ShellTest, ExportIsReadBackAndReported) {
    openSampleHair("short");
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.findChild<QComboBox*>("target")->setCurrentText("Yuksel .hair");
    dialog.exportTo(inFolder("hair.hair"));
    finishWork();
    EXPECT_EQ(dialog.report().strands, groom().strandCount());
    EXPECT_LT(dialog.report().maxErrorMm.value(), 0.001);
    const auto back = importStrands(inFolder("hair.hair").toStdString());
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->groom.strandCount(), groom().strandCount());

    Groom full = groom();
    full.interpolation.followPerGuide = 3;
    document().open(full, {}, "full");
    dialog.findChild<QComboBox*>("what")->setCurrentIndex(1);
    dialog.exportTo(inFolder("hairs.hair"));
    finishWork();
    EXPECT_EQ(dialog.report().strands, 3 * full.strandCount());
}

TEST_F(ShellTest, CardsLeaveByTheSameDialogWithWhatEachLevelLoses) {
    openSampleHair("short");
    openFirstStrands(300);
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.show();
    auto* cards = dialog.findChild<QSpinBox*>("cards");
    EXPECT_FALSE(cards->isVisible()) << "strands have none";
    dialog.findChild<QComboBox*>("target")->setCurrentText("Engines without strands");
    EXPECT_TRUE(cards->isVisible());
    EXPECT_FALSE(dialog.findChild<QComboBox*>("what")->isVisible());
    cards->setValue(12);
    dialog.findChild<QSpinBox*>("textures")->setValue(4);
    dialog.exportTo(inFolder("few.glb"));
    finishWork();
    ASSERT_EQ(dialog.report().levels.size(), 4u) << window->statusLine().message().toStdString();
    EXPECT_LE(dialog.report().levels[0].cards, 12u);
    EXPECT_FALSE(dialog.report().maxErrorMm);
    EXPECT_TRUE(QFileInfo::exists(inFolder("few.glb")));
    const auto* findings = dialog.findChild<QTreeWidget*>("findings");
    EXPECT_FALSE(findings->findItems("cards-12", Qt::MatchExactly).isEmpty());
}

TEST_F(ShellTest, AnAssetForGamesIsExportedWithItsSize) {
    openSampleHair("short");
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.findChild<QComboBox*>("target")->setCurrentText("Game by Hairloom's runtime");
    dialog.exportTo(inFolder("hair.hairrt"));
    finishWork();
    EXPECT_EQ(dialog.report().strands, groom().strandCount());
    EXPECT_LT(dialog.report().maxErrorMm.value(), 0.05);
    EXPECT_EQ(dialog.report().bytes, static_cast<std::uint64_t>(QFileInfo(inFolder("hair.hairrt")).size()));
    const QString size = dialog.locale().formattedDataSize(static_cast<qint64>(dialog.report().bytes), 1,
                                                           QLocale::DataSizeSIFormat);
    const auto labels = dialog.findChildren<QLabel*>();
    EXPECT_TRUE(std::ranges::any_of(labels, [&](const QLabel* label) {
        return label->text().contains(size);
    })) << size.toStdString();
}

TEST_F(ShellTest, APageForBrowsersIsExportedAtRest) {
    openSampleHair("short");
    for (const char* name : {"index.html", "player.js"}) {
        ASSERT_TRUE(QDir().mkpath(inFolder("player")));
        QFile file(inFolder("player/") + name);
        ASSERT_TRUE(file.open(QIODevice::WriteOnly) && file.write("player") > 0);
    }
    qputenv("HAIRLOOM_WEB", inFolder("player").toUtf8());
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.findChild<QComboBox*>("target")->setCurrentText("Web page with moving hair");
    auto* frames = dialog.findChild<QSpinBox*>("frames");
    frames->setValue(3);
    dialog.exportTo(inFolder("page"));
    finishWork();
    EXPECT_FALSE(QFileInfo::exists(inFolder("page"))) << "frames are the page's own";
    frames->setValue(0);
    dialog.exportTo(inFolder("page"));
    finishWork();
    qunsetenv("HAIRLOOM_WEB");
    EXPECT_EQ(dialog.report().format, "web");
    EXPECT_EQ(dialog.report().strands, groom().strandCount());
    for (const char* name : {"index.html", "player.js", "hair.js", "hair.hairrt"})
        EXPECT_TRUE(QFileInfo::exists(inFolder("page/") + name)) << name;
}

TEST_F(ShellTest, ImportShowsTheStrandsBeforeTheyAreTakenAndBindsThemToTheHead) {
    openSampleHair("short");
    const std::size_t strands = groom().strandCount();
    {
        ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
        dialog.findChild<QComboBox*>("target")->setCurrentText("TressFX");
        dialog.exportTo(inFolder("hair.tfx"));
        finishWork();
    }
    openBust();
    ImportDialog dialog(document(), parts().tasks, inFolder("hair.tfx"));
    finishWork();
    EXPECT_EQ(dialog.preview().strandCount(), strands);
    const float metres = dialog.preview().bounds().sizes().y();
    auto* unit = dialog.findChild<QComboBox*>("unit");
    unit->setCurrentText("cm");
    finishWork();
    EXPECT_EQ(dialog.preview().strandCount(), 0) << "hair that lies nowhere near the head is not taken";
    EXPECT_TRUE(std::ranges::any_of(dialog.findChildren<QLabel*>(), [](const QLabel* label) {
        return label->text().contains("with the unit m");
    }));
    unit->setCurrentText("m");
    finishWork();
    EXPECT_EQ(dialog.preview().bounds().sizes().y(), metres);
    files().importStrands(inFolder("hair.tfx"), dialog.options());
    finishWork();
    EXPECT_EQ(groom().strandCount(), strands);
    EXPECT_EQ(groom().rootBindings().size(), strands);
    EXPECT_EQ(document().stepCount(), 1);
    document().undo();
    EXPECT_EQ(groom().strandCount(), 0u);
}

TEST_F(ShellTest, ASavedScriptRepeatsTheStepsOnTheHeadThatWasOpened) {
    openSampleHair("short");
    {
        ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
        dialog.exportTo(inFolder("hair.tfx"));
        finishWork();
    }
    openBust();
    Groom replayed = groom();
    files().importStrands(inFolder("hair.tfx"), {});
    finishWork();
    auto* speed = find<NumberBox>("windSpeed");
    for (const double metresPerSecond : {2.0, 5.0}) speed->spinBox().setValue(metresPerSecond);
    trigger("select.all");
    trigger("select.freeze");
    ASSERT_TRUE(window->saveScriptTo(inFolder("steps.json")));
    const auto text = readTextFile(inFolder("steps.json").toStdString());
    ASSERT_TRUE(text) << text.error().message();
    const auto script = parseDocumentScript("steps.json", *text);
    ASSERT_TRUE(script) << script.error().message();
    const auto report = runScript(*script, replayed);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(contentHash(replayed), hash());
    EXPECT_EQ(replayed.simulation.windSpeed, 5);
}

}  // namespace
}  // namespace hairloom::editor
