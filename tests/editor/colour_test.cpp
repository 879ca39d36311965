// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of a studio in the window; tests/colour holds them against OpenColorIO.
#include <QComboBox>
#include <QFile>
#include <QLabel>
#include <cmath>
#include <future>

#include "tests/editor/window_fixture.h"
#include "tests/support/source_dir.h"

namespace hairloom::editor {
namespace {

std::string studio() {
    return (sourceDir() / "tests/colour/studio/config.ocio").string();
}

class ColourTest : public WindowTest {
  protected:
    ColourTest() : WindowTest(true) {}
    void SetUp() override {
        if (!colour::hasOpenColorIO()) GTEST_SKIP() << "built without OpenColorIO";
        WindowTest::SetUp();
        openSampleHair("short");
        drawQuickly();
    }
    void TearDown() override {
        if (window) WindowTest::TearDown();
    }
    void choose(const char* box, const char* text) {
        auto* choices = find<QComboBox>(box);
        const int index = choices->findText(text);
        ASSERT_GE(index, 0) << text;
        choices->setCurrentIndex(index);
        Q_EMIT choices->activated(index);
    }
    QImage picture() {
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        return viewport().picture().copy();
    }
    /// As *Render* makes it.
    QImage still(PictureRequest request) {
        auto drawn = std::async(std::launch::async, [&] {
            return viewport().drawAside(std::move(request), [] { return false; });
        });
        while (drawn.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
            QCoreApplication::processEvents();
        auto picture = drawn.get();
        EXPECT_TRUE(picture) << picture.error().message();
        return picture ? *picture : QImage();
    }
    void write(const QString& file, const QByteArray& text) {
        QFile out(file);
        ASSERT_TRUE(out.open(QIODevice::WriteOnly));
        out.write(text);
    }
    /// A config that displays light as it is by these displays and views.
    QString configOf(const QByteArray& displays) {
        write(inFolder("config.ocio"),
              "ocio_profile_version: 2\nroles: {default: light, scene_linear: light}\ndisplays:\n" +
                  displays + "colorspaces:\n  - !<ColorSpace> {name: light}\n");
        return inFolder("config.ocio");
    }
    void chooseFile(const QString& file) {
        onceAskedForAFile(file);
        choose("colourConfig", "Choose…");
    }
    QString state() { return find<QLabel>("colourState")->text(); }
};

TEST_F(ColourTest, AConfigIsChosenShownAndKept) {
    const QImage standard = picture();
    EXPECT_FALSE(find<QComboBox>("colourDisplay")->isEnabled());
    chooseFile(QString::fromStdString(studio()));
    EXPECT_EQ(find<QComboBox>("colourView")->currentText(), "Film");
    const QImage film = picture();
    EXPECT_NE(film, standard);
    choose("colourView", "Raw");
    const QImage raw = picture();
    EXPECT_NE(raw, film);
    EXPECT_EQ(state(), "");
    choose("colourDisplay", "Rec. 1886");
    EXPECT_EQ(find<QComboBox>("colourView")->currentText(), "Un-tone-mapped");
    const auto kept = parts().preferences.colours();
    EXPECT_EQ(kept.config, studio());
    EXPECT_EQ(kept.display, "Rec. 1886");
    EXPECT_EQ(Preferences().colours(), kept) << "the next window has them";
    choose("colourConfig", "Standard");
    EXPECT_EQ(viewport().colours(), nullptr);
    EXPECT_EQ(picture(), standard);
}

TEST_F(ColourTest, WhatCannotBeUsedLeavesTheStandardColoursAndSaysWhy) {
    const QImage standard = picture();
    for (const auto& [choice, expected] : std::vector<std::pair<colour::ColourChoice, const char*>>{
             {{"/nowhere/config.ocio", {}, {}}, "/nowhere/config.ocio"},
             {{studio(), "P3", {}}, "expected one of sRGB, Rec. 1886"},
             {{studio(), "sRGB", "Lost"}, "lost.cube"}}) {
        parts().preferences.setColours(choice);
        EXPECT_TRUE(state().contains(expected)) << state().toStdString();
        EXPECT_TRUE(state().startsWith("Standard colours are shown."));
        EXPECT_TRUE(window->statusLine().message().contains(expected));
        EXPECT_EQ(picture(), standard);
    }
    // A display that is not there is mended from the lists.
    parts().preferences.setColours({studio(), "P3", {}});
    choose("colourDisplay", "sRGB");
    EXPECT_EQ(state(), "");
    EXPECT_NE(picture(), standard);
}

/// Light on or off: what a table, which blends, cannot show.
class Threshold final : public render::ColourTransform {
  public:
    void apply(std::span<float> rgba) const override {
        for (std::size_t i = 0; i < rgba.size(); ++i) {
            if (i % 4 != 3) rgba[i] = rgba[i] < 0.05f ? 0.0f : 1.0f;
        }
    }
};

TEST_F(ColourTest, AStillIsTheViewItselfAndTheViewportWithinACodeValueOfIt) {
    chooseFile(QString::fromStdString(studio()));
    const QImage live = picture();
    EXPECT_EQ(state(), "");
    const QImage exact = still(viewport().requestOfView());
    ASSERT_EQ(exact.size(), live.size());
    int worst = 0, changed = 0;
    for (int y = 0; y < live.height(); ++y) {
        for (int x = 0; x < live.width(); ++x) {
            const QRgb a = live.pixel(x, y), b = exact.pixel(x, y);
            const int apart = std::max({std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)),
                                        std::abs(qBlue(a) - qBlue(b))});
            worst = std::max(worst, apart);
            changed += apart > 0;
        }
    }
    EXPECT_LE(worst, 1) << changed << " pixels";
    viewport().setColours(std::make_shared<Threshold>());
    picture();
    EXPECT_TRUE(state().contains("of 255")) << state().toStdString();
    PictureRequest request = viewport().requestOfView();
    request.seeThrough = true;
    for (const bool seeThrough : {false, true}) {
        request.seeThrough = seeThrough;
        const QImage hard = still(request);
        int lit = 0;
        for (int y = 0; y < hard.height(); ++y) {
            for (int x = 0; x < hard.width(); ++x) {
                const QRgb pixel = hard.pixel(x, y);
                for (const int code : {qRed(pixel), qGreen(pixel), qBlue(pixel)}) {
                    ASSERT_TRUE(code == 0 || code == 255) << code;
                    lit += code > 0;
                }
            }
        }
        EXPECT_GT(lit, 1000);
    }
}

TEST_F(ColourTest, AConfigThatWasMendedIsReadAgainWhereItIsChosenAgain) {
    QDir(folder.path()).mkdir("luts");
    const QString from = QString::fromStdString(studio());
    ASSERT_TRUE(QFile::copy(from, inFolder("config.ocio")));
    const QString luts = QFileInfo(from).path() + "/luts/";
    for (const char* name : {"film.cube", "warm.cc"})
        ASSERT_TRUE(QFile::copy(luts + name, inFolder("luts/") + name));
    chooseFile(inFolder("config.ocio"));
    choose("colourView", "Lost");
    EXPECT_TRUE(state().contains("lost.cube")) << state().toStdString();
    EXPECT_EQ(viewport().colours(), nullptr);
    ASSERT_TRUE(QFile::copy(luts + "film.cube", inFolder("luts/lost.cube")));
    choose("colourConfig", "config.ocio");
    EXPECT_EQ(state(), "");
    EXPECT_NE(viewport().colours(), nullptr);
    EXPECT_EQ(find<QComboBox>("colourView")->currentText(), "Lost") << "the view is kept";
    ASSERT_TRUE(QFile::remove(inFolder("config.ocio")));
    choose("colourConfig", "config.ocio");
    EXPECT_TRUE(state().contains("config.ocio")) << "it is gone";
    EXPECT_EQ(viewport().colours(), nullptr);
}

TEST_F(ColourTest, NamesAreShownAsTheyAre) {
    const QString display = "Büro 🎬", view = "<b>Fett</b> & „schräg“";
    chooseFile(configOf(QString("  %1:\n    - !<View> {name: \"%2\", colorspace: light}\n"
                                "  second:\n    - !<View> {name: one, colorspace: light}\n"
                                "    - !<View> {name: two, colorspace: gone}\n")
                            .arg(display, view)
                            .toUtf8()));
    EXPECT_EQ(find<QComboBox>("colourDisplay")->currentText(), display);
    EXPECT_EQ(find<QComboBox>("colourView")->currentText(), view);
    EXPECT_EQ(find<QComboBox>("colourView")->count(), 1);
    EXPECT_NE(viewport().colours(), nullptr);
    EXPECT_TRUE(state().contains("is taken for it")) << state().toStdString();
    choose("colourDisplay", "second");
    choose("colourView", "two");
    EXPECT_TRUE(state().contains("gone")) << state().toStdString();
    choose("colourDisplay", display.toUtf8().constData());
    EXPECT_NE(viewport().colours(), nullptr);
    EXPECT_EQ(Preferences().colours().view, "");
    choose("colourView", view.toUtf8().constData());
    EXPECT_EQ(Preferences().colours().view, view.toStdString());
}

TEST_F(ColourTest, WindowsHaveTheirOwnColoursAndTheNextHasTheLast) {
    chooseFile(QString::fromStdString(studio()));
    const auto first = viewport().colours();
    MainWindow other;
    other.setUnsavedAnswer(MainWindow::Unsaved::Discard);
    EXPECT_EQ(other.parts().preferences.colours(), parts().preferences.colours());
    EXPECT_NE(other.parts().viewport.colours(), nullptr);
    other.parts().preferences.setColours({colour::kNoConfig, {}, {}});
    EXPECT_EQ(other.parts().viewport.colours(), nullptr);
    EXPECT_EQ(viewport().colours(), first);
    other.close();
    EXPECT_EQ(Preferences().colours().config, colour::kNoConfig);
}

/// $OCIO is what a studio sets for all programs.
TEST_F(ColourTest, TheEnvironmentsConfigIsTakenAndNoneIsStandard) {
    TearDown();
    qputenv("OCIO", "/nowhere/studio.ocio");
    SetUp();
    EXPECT_TRUE(state().contains("($OCIO names this file)")) << state().toStdString();
    EXPECT_EQ(find<QComboBox>("colourConfig")->currentText(), "$OCIO");
    EXPECT_EQ(viewport().colours(), nullptr);
    choose("colourConfig", "Standard");
    EXPECT_EQ(state(), "");
    qputenv("OCIO", QByteArray::fromStdString(studio()));
    choose("colourConfig", "$OCIO");
    EXPECT_EQ(find<QComboBox>("colourView")->currentText(), "Film");
    EXPECT_NE(viewport().colours(), nullptr);
    qunsetenv("OCIO");
}

}  // namespace
}  // namespace hairloom::editor
