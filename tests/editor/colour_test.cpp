// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of a studio in the window; tests/colour holds them against OpenColorIO.
#include <QComboBox>
#include <QLabel>

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
        EXPECT_TRUE(viewport().waitForPicture(120'000));
        return viewport().picture().copy();
    }
    QString state() { return find<QLabel>("colourState")->text(); }
};

TEST_F(ColourTest, AConfigIsChosenShownAndKept) {
    const QImage standard = picture();
    EXPECT_FALSE(find<QComboBox>("colourDisplay")->isEnabled());
    onceAskedForAFile(QString::fromStdString(studio()));
    choose("colourConfig", "Choose…");
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

}  // namespace
}  // namespace hairloom::editor
