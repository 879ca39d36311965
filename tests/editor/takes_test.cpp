// SPDX-License-Identifier: GPL-3.0-or-later
// The Takes panel, by its buttons.
#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QDockWidget>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QTreeWidget>

#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/documents/takes.h"
#include "core/simulation/frame_record.h"
#include "editor/fields/length_text.h"
#include "editor/panels/new_take_dialog.h"
#include "editor/panels/take_export_dialog.h"
#include "importers/strands.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class TakesTest : public WindowTest {
  protected:
    TakesTest() : WindowTest(isDrawn()) {}

    /// Where pictures are asked for the view has all of the sample.
    static bool isDrawn() { return !qEnvironmentVariableIsEmpty("HAIRLOOM_VIEWPORT"); }
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        if (!isDrawn()) openFirstStrands(60);
        drawQuickly();
        save();
        window->panel("takes")->raise();
    }
    template <class Widget>
    Widget* get(const char* name) {
        return window->findChild<Widget*>(name);
    }
    void click(const char* name) {
        auto* button = get<QPushButton>(name);
        ASSERT_TRUE(button->isEnabled()) << name;
        button->click();
    }
    void save() {
        const QString path = inFolder("hair.hairloom");
        ASSERT_TRUE(window->saveTo(path));
    }
    std::filesystem::path project() { return inFolder("hair.hairloom").toStdString(); }
    /// A take of at least so many frames.
    void record(const char* name, std::uint64_t frames) {
        get<QLineEdit>("takeName")->setText(name);
        click("takeRecord");
        const auto recorded = [this] {
            return get<QLabel>("takeState")->text().section(' ', 0, 0).toULongLong();
        };
        ASSERT_TRUE(QTest::qWaitFor([&] { return recorded() >= frames; }, kPatience));
        click("takeRecord");
    }
    /// A recording in which nothing has played.
    void recordNothing(const char* name) {
        auto take = TakeWriter::open(*takePath(project(), name), document().groom(), 60, {});
        ASSERT_TRUE(take);
        ASSERT_TRUE(take->finish());
    }
    QStringList rows() {
        QStringList names;
        auto* list = get<QTreeWidget>("takes");
        for (int i = 0; i < list->topLevelItemCount(); ++i) names += list->topLevelItem(i)->text(0);
        return names;
    }
    void select(const char* name) {
        auto* list = get<QTreeWidget>("takes");
        list->setCurrentItem(list->findItems(name, Qt::MatchExactly).value(0));
    }
    /// Presses *Export…* of the panel, sets the dialog's rows, then answers with that file name.
    void exportAs(const char* format, int first, int last, const QString& path,
                  std::function<void(TakeExportDialog&)> look = {}) {
        onceAsked<TakeExportDialog>([=, this](TakeExportDialog& dialog) {
            auto* formats = dialog.findChild<QComboBox*>("takeFormat");
            formats->setCurrentIndex(formats->findData(format));
            dialog.findChild<QSpinBox*>("takeFirst")->setValue(first);
            dialog.findChild<QSpinBox*>("takeLast")->setValue(last);
            if (look) look(dialog);
            onceAskedForAFile(path);
            dialog.findChild<QPushButton*>("takeExportAs")->click();
        });
        click("takeExport");
    }
    std::string_view kindOfFile(const char* name) {
        const auto bytes = readFile(inFolder(name).toStdString());
        return bytes ? contentKind(*bytes) : std::string_view();
    }
    std::string said() { return window->statusLine().message().toStdString(); }
    std::vector<Vec3f> shown() {
        return viewport().pose() ? viewport().pose()->positions_ws : std::vector<Vec3f>();
    }
    std::vector<Vec3f> frameOf(const char* name, std::uint64_t number) {
        return readFrame(*takePath(project(), name), groom(), number)->positions_ws;
    }
};

TEST_F(TakesTest, WhatPlaysIsRecordedAndScrubbed) {
    ASSERT_TRUE(parts().player.setMotion("nod"));
    record("nod", 20);
    EXPECT_FALSE(parts().player.isPlaying());
    EXPECT_EQ(rows(), QStringList{"nod"});
    const auto info = TakeReader::open(*takePath(project(), "nod"))->info();
    EXPECT_TRUE(info.isFinished);
    EXPECT_GE(info.frames, 20u);
    EXPECT_EQ(motionOfNotes(info.notes), "nod");
    // It is selected and shown; the slider goes anywhere, backwards, too.
    auto* slider = get<QSlider>("takeFrame");
    EXPECT_EQ(slider->maximum(), static_cast<int>(info.frames) - 1);
    for (const int number : {15, 3, 18, 0}) {
        slider->setValue(number);
        EXPECT_EQ(shown(), frameOf("nod", static_cast<std::uint64_t>(number))) << number;
    }
    EXPECT_NE(frameOf("nod", 0), frameOf("nod", 15));
    // What was recorded is what the simulation plays.
    click("takePlay");
    EXPECT_TRUE(QTest::qWaitFor([&] { return slider->value() > 3; }, kPatience));
    click("takePlay");
    parts().player.play();
    EXPECT_FALSE(get<QPushButton>("takePlay")->isEnabled()) << "the simulation is shown again";
    parts().player.reset();
}

TEST_F(TakesTest, ATakeIsRenamedAndDeletedOnceConfirmed) {
    record("a", 8);
    record("b", 8);
    select("a");
    auto* list = get<QTreeWidget>("takes");
    list->currentItem()->setText(0, "c/d");
    QCoreApplication::processEvents();
    EXPECT_TRUE(window->statusLine().message().contains("cannot name a take"));
    EXPECT_EQ(rows(), (QStringList{"a", "b"}));
    select("a");
    list->currentItem()->setText(0, "c");
    QCoreApplication::processEvents();
    EXPECT_EQ(rows(), (QStringList{"b", "c"}));
    EXPECT_TRUE(std::filesystem::exists(*takePath(project(), "c")));
    onceAsked<QMessageBox>([](QMessageBox& box) { box.reject(); });
    click("takeDelete");
    EXPECT_EQ(rows().size(), 2);
    onceAsked<QMessageBox>([](QMessageBox& box) { box.findChild<QPushButton*>("takeDeleteYes")->click(); });
    click("takeDelete");
    EXPECT_EQ(rows(), QStringList{"b"});
    EXPECT_FALSE(std::filesystem::exists(*takePath(project(), "c")));
}

TEST_F(TakesTest, AFrameBecomesTheRestShapeAndIsUndone) {
    ASSERT_TRUE(parts().player.setMotion("nod"));
    record("nod", 12);
    get<QSlider>("takeFrame")->setValue(11);
    const std::uint64_t before = hash();
    click("takeShape");
    EXPECT_NE(hash(), before);
    EXPECT_EQ(window->statusLine().message(), "Frame 11 is now the rest shape");
    document().undo();
    EXPECT_EQ(hash(), before);
}

TEST_F(TakesTest, ATakeIsMadeALoop) {
    ASSERT_TRUE(parts().player.setMotion("nod"));
    record("nod", 112);
    const std::uint64_t frames = TakeReader::open(*takePath(project(), "nod"))->info().frames;
    onceAsked<NewTakeDialog>([&](NewTakeDialog& dialog) {
        EXPECT_EQ(dialog.name(), "nod loop");
        auto* make = dialog.findChild<QPushButton*>("newTakeMake");
        auto* words = dialog.findChild<QLabel*>("newTakeWords");
        // A nod comes back after 48 frames.
        dialog.findChild<QSpinBox*>("loopFirst")->setValue(4);
        EXPECT_FALSE(make->isEnabled());
        EXPECT_TRUE(words->text().contains("4 frames before it")) << words->text().toStdString();
        dialog.findChild<QSpinBox*>("loopFirst")->setValue(60);
        dialog.findChild<QSpinBox*>("loopLast")->setValue(107);
        EXPECT_TRUE(make->isEnabled());
        EXPECT_TRUE(words->text().startsWith("48 frames")) << words->text().toStdString();
        if (isDrawn()) {
            QCoreApplication::processEvents();
            QDir().mkpath(HAIRLOOM_SCREENSHOTS);
            EXPECT_TRUE(onScreen().save(HAIRLOOM_SCREENSHOTS "/take-loop.png"));
        }
        make->click();
    });
    click("takeLoop");
    finishWork();
    EXPECT_EQ(said().rfind("“nod loop” closes within 0.00 mm", 0), 0u) << said();
    EXPECT_EQ(rows(), (QStringList{"nod", "nod loop"}));
    const auto info = TakeReader::open(*takePath(project(), "nod loop"))->info();
    EXPECT_EQ(info.frames, 48u);
    ASSERT_TRUE(loopOfNotes(info.notes));
    EXPECT_EQ(loopOfNotes(info.notes)->first, 60u);
    // It is shown, and says in the list that it repeats.
    EXPECT_EQ(get<QSlider>("takeFrame")->maximum(), 47);
    EXPECT_EQ(shown(), frameOf("nod loop", 0));
    EXPECT_EQ(frameOf("nod loop", 0), frameOf("nod", 60));
    EXPECT_TRUE(get<QTreeWidget>("takes")->currentItem()->toolTip(0).contains("Repeats every 48 frames"));
    // A clip of it loops unless somebody says otherwise.
    exportAs("runtime", 0, 47, inFolder("loop.hairrt"), [](TakeExportDialog& dialog) {
        EXPECT_TRUE(dialog.findChild<QCheckBox*>("takeLoops")->isChecked());
    });
    finishWork();
    EXPECT_EQ(kindOfFile("loop.hairrt"), "a runtime asset");
    // A range after which the head is elsewhere makes nothing.
    select("nod");
    onceAsked<NewTakeDialog>([&](NewTakeDialog& dialog) {
        dialog.findChild<QSpinBox*>("loopFirst")->setValue(60);
        dialog.findChild<QSpinBox*>("loopLast")->setValue(90);
        dialog.findChild<QPushButton*>("newTakeMake")->click();
    });
    click("takeLoop");
    finishWork();
    EXPECT_NE(said().find("repeats every 31 frames"), std::string::npos) << said();
    EXPECT_EQ(rows().size(), 2);
    EXPECT_GT(frames, 107u);
}

TEST_F(TakesTest, ATakeIsSimulatedAnewFromTheFrameThatIsShown) {
    record("rest", 20);
    const std::uint64_t frames = TakeReader::open(*takePath(project(), "rest"))->info().frames;
    Groom windy = groom();
    windy.simulation.windSpeed = 12;
    change("Wind", windy);
    select("rest");
    get<QSlider>("takeFrame")->setValue(9);
    onceAsked<NewTakeDialog>([&](NewTakeDialog& dialog) {
        EXPECT_EQ(dialog.findChild<QSpinBox*>("resimulateAt")->value(), 9);
        EXPECT_EQ(dialog.findChild<QSpinBox*>("resimulateFrames")->value(), static_cast<int>(frames) - 10);
        dialog.findChild<QSpinBox*>("resimulateFrames")->setValue(30);
        dialog.findChild<QPushButton*>("newTakeMake")->click();
    });
    click("takeResimulate");
    finishWork();
    EXPECT_EQ(said(), "Simulated 30 frames of “rest from 9” from frame 9 on");
    EXPECT_EQ(get<QSlider>("takeFrame")->maximum(), 39);
    EXPECT_EQ(frameOf("rest from 9", 9), frameOf("rest", 9));
    const auto last = frameOf("rest from 9", 39), before = frameOf("rest", 9);
    float moved = 0;
    for (std::size_t p = 0; p < last.size(); ++p) moved = std::max(moved, (last[p] - before[p]).norm());
    EXPECT_GT(moved, 0.005f) << "wind blows now";
    // Another name that is taken makes nothing.
    onceAsked<NewTakeDialog>([&](NewTakeDialog& dialog) {
        dialog.findChild<QLineEdit*>("newTakeName")->setText("rest");
        dialog.findChild<QPushButton*>("newTakeMake")->click();
    });
    click("takeResimulate");
    EXPECT_NE(said().find("already"), std::string::npos) << said();
    EXPECT_FALSE(parts().tasks.isBusy());
}

TEST_F(TakesTest, FollowHairsOfATakeAreAChoice) {
    openFirstStrands(20);
    Groom followed = groom();
    followed.interpolation.followPerGuide = 4;
    change("Follow hairs", followed);
    save();
    record("rest", 8);
    exportAs("abc", 0, 3, inFolder("hairs.abc"), [](TakeExportDialog& dialog) {
        auto* what = dialog.findChild<QComboBox*>("takeWhat");
        EXPECT_TRUE(what->isVisible());
        what->setCurrentIndex(1);
        auto* formats = dialog.findChild<QComboBox*>("takeFormat");
        formats->setCurrentIndex(formats->findData("runtime"));
        EXPECT_FALSE(what->isVisible()) << "a game makes them itself";
        formats->setCurrentIndex(formats->findData("abc"));
    });
    finishWork();
    StrandImportOptions animated;
    animated.frames = true;
    const auto alembic = importStrands(inFolder("hairs.abc").toStdString(), animated);
    ASSERT_TRUE(alembic) << alembic.error().message();
    EXPECT_EQ(alembic->frames.size(), 4u);
    EXPECT_EQ(alembic->groom.strandCount(), 80u);
}

TEST_F(TakesTest, ThoseOfAWindowThatWasKilledAreThereAgain) {
    {
        std::filesystem::create_directory(takesFolder(project()));
        auto writer = TakeWriter::open(*takePath(project(), "lost"), groom(), 60, "{}");
        ASSERT_TRUE(writer);
        for (int f = 0; f < 10; ++f) ASSERT_TRUE(writer->add(groom().positions(), {}));
    }
    files().open(inFolder("hair.hairloom"));
    finishWork();
    EXPECT_EQ(rows(), QStringList{"lost"});
    select("lost");
    EXPECT_EQ(get<QSlider>("takeFrame")->maximum(), 7);
}

TEST_F(TakesTest, DistancesToAnotherTakeAreDrawn) {
    record("calm", 10);
    Groom windy = groom();
    windy.simulation.windSpeed = 20;
    change("Wind", windy);
    parts().player.reset();
    record("windy", 10);
    auto* other = get<QComboBox>("takeOther");
    const int calm = other->findData("calm");
    ASSERT_GT(calm, 0);
    other->setCurrentIndex(calm);
    Q_EMIT other->activated(calm);
    get<QSlider>("takeFrame")->setValue(9);
    EXPECT_EQ(shown(), frameOf("windy", 9));
    const auto windyFrame = frameOf("windy", 9), calmFrame = frameOf("calm", 9);
    float largest = 0;
    for (std::size_t i = 0; i < windyFrame.size(); ++i)
        largest = std::max(largest, (windyFrame[i] - calmFrame[i]).norm());
    const auto* const words = get<QLabel>("takeDistance");
    EXPECT_TRUE(
        words->text().contains(lengthText(static_cast<double>(largest), parts().preferences) + " at most"))
        << words->text().toStdString() << ", " << largest;
    EXPECT_FALSE(words->isHidden());
    if (!isDrawn()) return;
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    QCoreApplication::processEvents();
    QDir().mkpath(HAIRLOOM_SCREENSHOTS);
    EXPECT_TRUE(onScreen().save(HAIRLOOM_SCREENSHOTS "/takes.png"));
}

TEST_F(TakesTest, ATakeIsExportedForOtherPrograms) {
    // Without a head, out of which an export would push hair.
    openFirstStrands(60);
    save();
    ASSERT_TRUE(parts().player.setMotion("nod"));
    record("nod", 16);
    // The record holds the very frames that were asked for, under the suffix of its format.
    exportAs("frames", 3, 12, inFolder("nod"));
    finishWork();
    EXPECT_EQ(said().rfind("Exported nod.frames: 10 frames", 0), 0u) << said();
    for (const std::uint64_t number : {0u, 9u}) {
        const auto frame = readFrame(inFolder("nod.frames").toStdString(), groom(), number);
        ASSERT_TRUE(frame) << frame.error().message();
        EXPECT_EQ(frame->positions_ws, frameOf("nod", 3 + number)) << number;
        EXPECT_EQ(frame->framesInRecord, 10u);
    }
    exportAs("abc", 3, 12, inFolder("nod.abc"));
    finishWork();
    StrandImportOptions animated;
    animated.frames = true;
    const auto alembic = importStrands(inFolder("nod.abc").toStdString(), animated);
    ASSERT_TRUE(alembic) << alembic.error().message();
    ASSERT_EQ(alembic->frames.size(), 10u);
    for (const std::size_t number : {std::size_t{0}, std::size_t{9}}) {
        const std::vector<Vec3f> taken = frameOf("nod", 3 + number);
        ASSERT_EQ(alembic->frames[number].size(), taken.size());
        float farthest = 0;
        for (std::size_t p = 0; p < taken.size(); ++p)
            farthest = std::max(farthest, (alembic->frames[number][p] - taken[p]).norm());
        EXPECT_LT(farthest, 1e-6f) << number;
    }
    // A suffix that is typed chooses the format.
    exportAs("abc", 0, 4, inFolder("nod.usdc"));
    finishWork();
    EXPECT_EQ(kindOfFile("nod.usdc"), "a binary USD file");
    exportAs("runtime", 0, 9, inFolder("nod.hairrt"), [](TakeExportDialog& dialog) {
        auto* loops = dialog.findChild<QCheckBox*>("takeLoops");
        EXPECT_TRUE(loops->isVisible());
        loops->setChecked(true);
        if (!isDrawn()) return;
        QCoreApplication::processEvents();
        QDir().mkpath(HAIRLOOM_SCREENSHOTS);
        EXPECT_TRUE(onScreen().save(HAIRLOOM_SCREENSHOTS "/take-export.png"));
    });
    finishWork();
    EXPECT_EQ(kindOfFile("nod.hairrt"), "a runtime asset");
}

TEST_F(TakesTest, AnExportOfATakeIsCancelledAndSaysWhatIsWrong) {
    record("calm", 12);
    exportAs("abc", 0, 10, inFolder("no/such/folder/calm.abc"));
    finishWork();
    EXPECT_NE(said().find("folder"), std::string::npos) << said();
    exportAs("abc", 0, 10, inFolder("calm.abc"));
    ASSERT_TRUE(parts().tasks.isBusy());
    parts().tasks.cancel();
    finishWork();
    EXPECT_FALSE(QFile::exists(inFolder("calm.abc")));
    // What is there stays where its replacement is refused.
    QFile there(inFolder("calm.usda"));
    ASSERT_TRUE(there.open(QIODevice::WriteOnly) && there.write("#usda 1.0\n") > 0);
    there.close();
    onceAsked<TakeExportDialog>([&](TakeExportDialog& dialog) {
        auto* write = dialog.findChild<QPushButton*>("takeExportAs");
        dialog.findChild<QSpinBox*>("takeFirst")->setValue(9);
        dialog.findChild<QSpinBox*>("takeLast")->setValue(4);
        EXPECT_FALSE(write->isEnabled());
        EXPECT_TRUE(dialog.findChild<QLabel*>("takeWillExport")->text().contains("before the first"));
        dialog.findChild<QSpinBox*>("takeFirst")->setValue(4);
        onceAsked<QFileDialog>([&](QFileDialog& files) {
            onceAsked<QMessageBox>([](QMessageBox& question) { question.button(QMessageBox::No)->click(); });
            files.findChild<QLineEdit*>("fileNameEdit")->setText(there.fileName());
            QMetaObject::invokeMethod(&files, "accept");
        });
        write->click();
        EXPECT_FALSE(parts().tasks.isBusy());
        dialog.reject();
    });
    click("takeExport");
    EXPECT_EQ(QFileInfo(there.fileName()).size(), 10);
}

TEST_F(TakesTest, AGroomOfOtherPointsExportsNoTake) {
    record("calm", 12);
    document().open(firstStrands(groom(), 30), inFolder("hair.hairloom"), "hair");
    select("calm");
    exportAs("abc", 0, 7, inFolder("calm.abc"), [](TakeExportDialog& dialog) {
        EXPECT_TRUE(dialog.findChild<QLabel*>("takeWillExport")->text().contains("has changed shape"));
    });
    finishWork();
    EXPECT_NE(said().find("points"), std::string::npos) << said();
    EXPECT_FALSE(QFile::exists(inFolder("calm.abc")));
}

TEST_F(TakesTest, NothingIsRecordedOfAProjectWithoutAFile) {
    document().open(groom(), {}, "new");
    EXPECT_FALSE(get<QPushButton>("takeRecord")->isEnabled());
    EXPECT_TRUE(get<QLabel>("takeState")->text().contains("Save the project"));
    EXPECT_TRUE(rows().isEmpty());
}

TEST_F(TakesTest, ATakeWithoutFramesIsTold) {
    std::filesystem::create_directory(takesFolder(project()));
    recordNothing("nothing");
    files().open(inFolder("hair.hairloom"));
    finishWork();
    select("nothing");
    EXPECT_TRUE(window->statusLine().message().contains("has no frames"))
        << window->statusLine().message().toStdString();
    EXPECT_FALSE(get<QPushButton>("takePlay")->isEnabled());
}

}  // namespace
}  // namespace hairloom::editor
