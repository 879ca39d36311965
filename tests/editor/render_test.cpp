// SPDX-License-Identifier: GPL-3.0-or-later
// Images and films of what the viewport shows.

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QSpinBox>

#include "core/editing/settings_commands.h"
#include "core/groom/time_line.h"
#include "core/live/video_file.h"
#include "editor/dialogs/render_dialog.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class RenderTest : public WindowTest {
  protected:
    RenderTest() : WindowTest(true) {}
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        openFirstStrands(200);
        drawQuickly();
        viewport().look(render::View::Front);
        viewport().frameAll();
        ASSERT_TRUE(viewport().waitForPicture(kPatience));
    }
    /// Opens the dialog by its action and gives it to `use`, which closes it.
    void inDialog(std::function<void(RenderDialog&)> use) {
        onceAsked<RenderDialog>(std::move(use));
        trigger("file.render");
    }
    static void set(RenderDialog& dialog, FilmOf of, int width, int height) {
        dialog.findChild<QComboBox*>("renderOf")->setCurrentIndex(static_cast<int>(of));
        dialog.findChild<QSpinBox*>("renderWidth")->setValue(width);
        dialog.findChild<QSpinBox*>("renderHeight")->setValue(height);
    }
    static QPushButton* button(RenderDialog& dialog, const char* name) {
        return dialog.findChild<QPushButton*>(name);
    }
    static QString note(RenderDialog& dialog) { return dialog.findChild<QLabel*>("renderNote")->text(); }
    /// Presses *Render*, answers with that name, and waits for the end.
    void renderAs(RenderDialog& dialog, const char* name) {
        onceAskedForAFile(inFolder(name));
        QTest::mouseClick(button(dialog, "render"), Qt::LeftButton);
        EXPECT_TRUE(QTest::qWaitFor([&] { return !parts().tasks.isBusy(); }, kPatience));
        QCoreApplication::processEvents();
    }
    QStringList written() const { return QDir(folder.path()).entryList(QDir::Files, QDir::Name); }
};

TEST_F(RenderTest, AnImageHasTheSizeAndBackgroundThatWereAskedFor) {
    inDialog([&](RenderDialog& dialog) {
        EXPECT_EQ(dialog.findChild<QSpinBox*>("renderWidth")->value(),
                  static_cast<int>(std::lround(viewport().width() * viewport().devicePixelRatioF())));
        EXPECT_FALSE(dialog.findChild<QSpinBox*>("renderImages")->isVisible());
        set(dialog, FilmOf::View, 160, 120);
        renderAs(dialog, "opaque.png");
        EXPECT_TRUE(note(dialog).startsWith("Rendered opaque.png")) << note(dialog).toStdString();
        dialog.findChild<QCheckBox*>("renderTransparent")->setChecked(true);
        renderAs(dialog, "transparent.png");
        dialog.reject();
    });
    const QImage opaque(inFolder("opaque.png")), clear(inFolder("transparent.png"));
    ASSERT_EQ(opaque.size(), QSize(160, 120));
    ASSERT_EQ(clear.size(), QSize(160, 120));
    EXPECT_EQ(opaque.pixelColor(0, 0).alpha(), 255);
    EXPECT_EQ(clear.pixelColor(0, 0).alpha(), 0);
    int covered = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) covered += clear.pixelColor(x, y).alpha() > 8;
    EXPECT_GT(covered, 50) << "thin hair is in it, and covers little of a pixel";
    EXPECT_TRUE(viewport().waitForPicture(kPatience)) << "the view goes on";
}

TEST_F(RenderTest, ATurntableIsNumberedImagesFromAllSides) {
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Turntable, 96, 96);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(4);
        EXPECT_TRUE(note(dialog).startsWith("4 images")) << note(dialog).toStdString();
        renderAs(dialog, "turn.png");
        dialog.reject();
    });
    ASSERT_EQ(written(), QStringList({"turn_0000.png", "turn_0001.png", "turn_0002.png", "turn_0003.png"}));
    const QImage front(inFolder("turn_0000.png")), side(inFolder("turn_0001.png"));
    EXPECT_NE(front, side);
    EXPECT_EQ(front.size(), QSize(96, 96));
}

TEST_F(RenderTest, ImagesThatAreThereAreReplacedOnlyWhenToldTo) {
    QFile there(inFolder("turn_0001.png"));
    ASSERT_TRUE(QImage(4, 4, QImage::Format_RGB32).save(there.fileName()));
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Turntable, 32, 32);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(2);
        onceAsked<QMessageBox>([](QMessageBox& question) {
            QTest::mouseClick(question.button(QMessageBox::No), Qt::LeftButton);
        });
        renderAs(dialog, "turn.png");
        dialog.reject();
    });
    EXPECT_EQ(written(), QStringList({"turn_0001.png"}));
    EXPECT_EQ(QImage(there.fileName()).width(), 4);
}

TEST_F(RenderTest, AFilmOfTheSimulationMoves) {
    ASSERT_TRUE(parts().player.setMotion("spin"));
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Simulation, 64, 64);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(3);
        dialog.findChild<QComboBox*>("renderRate")->setCurrentText("10");
        renderAs(dialog, "move.png");
        dialog.findChild<QComboBox*>("renderFiles")
            ->setCurrentIndex(static_cast<int>(FilmFiles::AnimatedPng));
        renderAs(dialog, "film.png");
        dialog.reject();
    });
    EXPECT_NE(QImage(inFolder("move_0000.png")), QImage(inFolder("move_0002.png")));
    QFile film(inFolder("film.png"));
    ASSERT_TRUE(film.open(QIODevice::ReadOnly));
    EXPECT_EQ(film.readAll().count("fcTL"), 3) << "three frames";
    EXPECT_FALSE(parts().player.hasFrame()) << "what the window plays is as it was";
}

TEST_F(RenderTest, AFilmOfTheTimeLineHasTheKeysOfTheMaterial) {
    TimeLine line;
    for (const char* name : {"material.rootColour", "material.tipColour"})
        line.settings.push_back({name, {{0, Vec3d(0.2, 0.2, 0.2)}, {0.1f, Vec3d(1, 0, 0)}}});
    keySetting(line, "material.colourSource", 0, Vec3d(static_cast<double>(ColourSource::colours), 0, 0));
    auto made = editing::setTimeLine(document().editing().model(), line, "Keys");
    ASSERT_TRUE(made);
    document().perform(std::move(*made));
    ASSERT_EQ(parts().player.motion(), Player::kTimeLine);
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Simulation, 64, 64);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(2);
        dialog.findChild<QComboBox*>("renderRate")->setCurrentText("10");
        renderAs(dialog, "keys.png");
        dialog.reject();
    });
    const auto redness = [this](const char* name) {
        const QImage picture(inFolder(name));
        long sum = 0;
        for (int y = 0; y < picture.height(); ++y) {
            for (int x = 0; x < picture.width(); ++x)
                sum += picture.pixelColor(x, y).red() - picture.pixelColor(x, y).green();
        }
        return sum;
    };
    EXPECT_GT(redness("keys_0001.png"), redness("keys_0000.png") + 1000) << "a few hairs on a grey ground";
}

TEST_F(RenderTest, TextIsBurntInAndVersionsAreTaken) {
    ASSERT_TRUE(parts().player.setMotion("spin"));
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::View, 320, 160);
        EXPECT_FALSE(dialog.findChild<QCheckBox*>("burnInFrame")->isEnabled()) << "a view has no frame";
        renderAs(dialog, "view_v##.png");
        for (const char* name : {"burnInTake", "burnInSettings", "renderManifest"})
            dialog.findChild<QCheckBox*>(name)->setChecked(true);
        renderAs(dialog, "view_v##.png");
        EXPECT_TRUE(note(dialog).startsWith("Rendered view_v02.png")) << note(dialog).toStdString();
        dialog.reject();
    });
    ASSERT_EQ(written(), QStringList({"view_v01.png", "view_v02.png", "view_v02.png.manifest.json"}));
    const QImage plain(inFolder("view_v01.png")), burnt(inFolder("view_v02.png"));
    const QRect above(0, 0, 320, 100), corner(0, 120, 160, 40);
    EXPECT_EQ(plain.copy(above), burnt.copy(above));
    EXPECT_NE(plain.copy(corner), burnt.copy(corner));
}

TEST_F(RenderTest, ATurntableBecomesAVideo) {
    if (!canWriteVideo()) GTEST_SKIP() << "built without libavcodec";
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Turntable, 64, 48);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(3);
        dialog.findChild<QComboBox*>("renderFiles")->setCurrentIndex(static_cast<int>(FilmFiles::Mp4));
        EXPECT_FALSE(dialog.findChild<QCheckBox*>("renderTransparent")->isEnabled());
        renderAs(dialog, "turn.mp4");
        dialog.reject();
    });
    ASSERT_EQ(written(), QStringList({"turn.mp4"}));
    QFile file(inFolder("turn.mp4"));
    ASSERT_TRUE(file.open(QIODevice::ReadOnly));
    const QByteArray bytes = file.readAll();
    EXPECT_EQ(bytes.mid(4, 4), "ftyp");
    // Sample Size Box (ISO/IEC 14496-12, 8.7.3): its count, behind the version and the size of all samples.
    const auto sizes = bytes.indexOf("stsz");
    ASSERT_GT(sizes, 0);
    EXPECT_EQ(bytes.mid(sizes + 12, 4), QByteArray("\0\0\0\3", 4));
}

TEST_F(RenderTest, FormatAndFileNameFollowOneAnother) {
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Turntable, 32, 32);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(2);
        auto* files = dialog.findChild<QComboBox*>("renderFiles");
        const auto format = [&] { return static_cast<FilmFiles>(files->currentIndex()); };
        // What is typed chooses the format, whatever was set before.
        renderAs(dialog, "film.WEBP");
        EXPECT_EQ(format(), FilmFiles::AnimatedWebp);
        renderAs(dialog, "turn.png");
        EXPECT_EQ(format(), FilmFiles::Pictures);
        files->setCurrentIndex(static_cast<int>(FilmFiles::AnimatedWebp));
        renderAs(dialog, "film.v2");
        EXPECT_EQ(format(), FilmFiles::AnimatedWebp) << "a suffix of no format";
        // The type that is chosen among files renames, and becomes the format.
        onceAsked<QFileDialog>([&](QFileDialog& dialogOfFiles) {
            auto* name = dialogOfFiles.findChild<QLineEdit*>("fileNameEdit");
            auto* types = dialogOfFiles.findChild<QComboBox*>("fileTypeCombo");
            EXPECT_TRUE(types->currentText().startsWith("Animated WebP"))
                << types->currentText().toStdString();
            EXPECT_TRUE(name->text().endsWith(".webp")) << name->text().toStdString();
            name->setText(inFolder("moved.webp"));
            const int png = types->findText("Animated PNG", Qt::MatchStartsWith);
            types->setCurrentIndex(png);
            Q_EMIT types->activated(png);
            EXPECT_EQ(name->text(), inFolder("moved.png"));
            QMetaObject::invokeMethod(&dialogOfFiles, "accept");
        });
        QTest::mouseClick(button(dialog, "render"), Qt::LeftButton);
        finishWork();
        EXPECT_EQ(format(), FilmFiles::AnimatedPng);
        // A view is one PNG.
        set(dialog, FilmOf::View, 32, 32);
        renderAs(dialog, "view.webp");
        dialog.reject();
    });
    EXPECT_EQ(written(), QStringList({"film.WEBP", "film.v2.webp", "moved.png", "turn_0000.png",
                                      "turn_0001.png", "view.webp.png"}));
    const auto beginning = [this](const char* name) {
        QFile file(inFolder(name));
        EXPECT_TRUE(file.open(QIODevice::ReadOnly)) << name;
        return file.read(12);
    };
    for (const char* name : {"film.WEBP", "film.v2.webp"}) EXPECT_EQ(beginning(name).mid(8), "WEBP") << name;
    for (const char* name : {"moved.png", "turn_0000.png", "view.webp.png"})
        EXPECT_EQ(beginning(name).mid(1, 3), "PNG") << name;
}

TEST_F(RenderTest, CancelLeavesNoFileAndTheDialogGoesOn) {
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Turntable, 64, 64);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(2000);
        onceAskedForAFile(inFolder("turn.png"));
        QTest::mouseClick(button(dialog, "render"), Qt::LeftButton);
        EXPECT_TRUE(QTest::qWaitFor([&] { return parts().tasks.progress() > 0; }, kPatience));
        EXPECT_FALSE(button(dialog, "render")->isEnabled());
        EXPECT_TRUE(QTest::qWaitFor([&] { return note(dialog).contains("of 2000"); }, kPatience))
            << note(dialog).toStdString();
        QTest::keyClick(&dialog, Qt::Key_Escape);
        EXPECT_TRUE(dialog.isVisible()) << "the first press cancels the work";
        EXPECT_TRUE(QTest::qWaitFor([&] { return !parts().tasks.isBusy(); }, kPatience));
        EXPECT_TRUE(note(dialog).startsWith("Cancelled")) << note(dialog).toStdString();
        EXPECT_TRUE(written().isEmpty()) << written().join(' ').toStdString();
        dialog.findChild<QSpinBox*>("renderImages")->setValue(2);
        renderAs(dialog, "again.png");
        EXPECT_EQ(written().size(), 2);
        QTest::keyClick(&dialog, Qt::Key_Escape);
        EXPECT_FALSE(dialog.isVisible());
    });
    EXPECT_TRUE(viewport().waitForPicture(kPatience));
}

TEST_F(RenderTest, WhatCannotBeIsSaidBeforeAnythingIsDrawn) {
    inDialog([&](RenderDialog& dialog) {
        set(dialog, FilmOf::Turntable, 8192, 8192);
        dialog.findChild<QSpinBox*>("renderImages")->setValue(3600);
        EXPECT_TRUE(button(dialog, "render")->isEnabled()) << "numbered images are written as they come";
        dialog.findChild<QComboBox*>("renderFiles")
            ->setCurrentIndex(static_cast<int>(FilmFiles::AnimatedWebp));
        EXPECT_FALSE(button(dialog, "render")->isEnabled());
        EXPECT_TRUE(note(dialog).contains("memory")) << note(dialog).toStdString();
        dialog.findChild<QSpinBox*>("renderImages")->setValue(2);
        set(dialog, FilmOf::View, 32, 32);
        EXPECT_TRUE(button(dialog, "render")->isEnabled());
        set(dialog, FilmOf::Turntable, 32, 32);
        dialog.renderTo(inFolder("film.png"));
        EXPECT_TRUE(QTest::qWaitFor([&] { return !parts().tasks.isBusy(); }, kPatience));
        QCoreApplication::processEvents();
        EXPECT_TRUE(note(dialog).contains("expected .webp")) << note(dialog).toStdString();
        set(dialog, FilmOf::View, 32, 32);
        dialog.renderTo(inFolder("no/such/folder.png"));
        EXPECT_TRUE(QTest::qWaitFor([&] { return !parts().tasks.isBusy(); }, kPatience));
        QCoreApplication::processEvents();
        EXPECT_TRUE(note(dialog).contains("folder")) << note(dialog).toStdString();
        dialog.reject();
    });
    EXPECT_TRUE(written().isEmpty());
}

}  // namespace
}  // namespace hairloom::editor
