// SPDX-License-Identifier: GPL-3.0-or-later
// The Operators panel: what it shows, what each of its buttons does, strokes on top, undo of all of it.
#include <QClipboard>
#include <QComboBox>
#include <QFile>
#include <QGuiApplication>
#include <QImage>
#include <QInputDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <QWidgetAction>
#include <algorithm>
#include <set>

#include "core/editing/selection_commands.h"
#include "core/operations/stack.h"
#include "editor/fields/number_box.h"
#include "editor/fields/ramp_edit.h"
#include "editor/tools/brush_tool.h"
#include "editor/tools/curve_tool.h"
#include "tests/editor/operators_fixture.h"

namespace hairloom::editor {
namespace {

TEST_F(OperatorsTest, ASampleOpensWithItsStack) {
    EXPECT_EQ(rows(), sampleStack());
    expectEvaluated();
    EXPECT_FALSE(document().isModified());
}

TEST_F(OperatorsTest, ADragOfASliderIsOneStepThatTheHairFollows) {
    const auto before = hash();
    const Vec3f tip = groom().strand(7).back();
    choose(kClump);
    NumberBox* strength = number("strength");
    EXPECT_NEAR(strength->value(), 0.75, 1e-6);
    strength->slider().setSliderDown(true);
    for (const int position : {100, 300, 0}) strength->slider().setValue(position);
    strength->slider().setSliderDown(false);
    ASSERT_EQ(number("strength"), strength) << "the slider outlives its drag";
    EXPECT_EQ(document().stepCount(), 1);
    EXPECT_NE(groom().strand(7).back(), tip);
    expectEvaluated();
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
    EXPECT_NEAR(strength->value(), 0.75, 1e-6) << "shows what undo brought back";
}

TEST_F(OperatorsTest, ButtonsDoWhatTheySayAndAreUndone) {
    const auto before = hash();
    choose(kClump);
    add("Curl");
    EXPECT_EQ(rows(), stackWith("Curl", kClump + 1));
    EXPECT_EQ(list().currentRow(), kClump + 1) << "what was added is chosen";
    EXPECT_TRUE(number("frequency"));
    click("operatorUp");
    EXPECT_EQ(list().currentRow(), kClump) << "the choice goes along";
    EXPECT_EQ(rows().at(kClump), "Curl");
    click("operatorDown");
    click("operatorCopy");
    EXPECT_EQ(rows().count("Curl"), 2);
    expectEvaluated();
    const auto curled = hash();
    list().item(kClump + 1)->setCheckState(Qt::Unchecked);
    EXPECT_FALSE(groom().operators[kClump + 1].enabled);
    EXPECT_NE(hash(), curled);
    click("operatorRemove");
    click("operatorRemove");
    expectEvaluated();
    click("operatorBake");
    EXPECT_TRUE(rows().isEmpty());
    EXPECT_TRUE(groom().operators.empty());
    undoAll();
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(list().count(), sampleStack().size());
}

TEST_F(OperatorsTest, SoloCopyAndPasteDoWhatTheySay) {
    choose(1);
    click("operatorSolo");
    for (std::size_t i = 0; i < groom().operators.size(); ++i)
        EXPECT_EQ(groom().operators[i].enabled, i == 1) << i;
    expectEvaluated();
    click("operatorSolo");
    for (const Operator& one : groom().operators) EXPECT_TRUE(one.enabled);
    choose(kClump);
    click("operatorClip");
    const Operator copied = groom().operators[kClump];
    choose(list().count() - 1);
    click("operatorPaste");
    EXPECT_EQ(rows(), stackWith("Clump", sampleStack().size()));
    EXPECT_EQ(groom().operators.back(), copied);
    expectEvaluated();
    QGuiApplication::clipboard()->setText("not operators");
    const auto before = hash();
    click("operatorPaste");
    EXPECT_EQ(hash(), before);
}

TEST_F(OperatorsTest, AStackIsKeptWithAPictureAndUsedAgain) {
    auto* presets = window->panel("operators")->findChild<QPushButton*>("operatorPresets");
    ASSERT_TRUE(presets);
    const auto entry = [&](const QString& name) {
        Q_EMIT presets->menu()->aboutToShow();
        for (QAction* action : presets->menu()->actions()) {
            if (action->text() == name) return action;
        }
        return static_cast<QAction*>(nullptr);
    };
    onceAsked<QInputDialog>([](QInputDialog& dialog) {
        dialog.setTextValue("Tousled");
        dialog.accept();
    });
    entry("Save stack as preset…")->trigger();
    auto* kept = qobject_cast<QWidgetAction*>(entry("Tousled"));
    ASSERT_TRUE(kept) << window->statusLine().message().toStdString();
    auto* button = qobject_cast<QToolButton*>(kept->defaultWidget());
    ASSERT_TRUE(button);
    const QImage picture = button->icon().pixmap(64, 64).toImage();
    ASSERT_FALSE(picture.isNull());
    std::set<QRgb> colours;
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) colours.insert(picture.pixel(x, y));
    }
    EXPECT_GT(colours.size(), 50u) << "hair on a head";
    const std::size_t before = groom().operators.size();
    button->click();
    EXPECT_EQ(groom().operators.size(), 2 * before);
    undoAll();
}

TEST_F(OperatorsTest, ClassesOfCurlArePresets) {
    auto* presets = window->panel("operators")->findChild<QPushButton*>("operatorPresets");
    ASSERT_TRUE(presets);
    const auto curl = [&](const QString& name) {
        Q_EMIT presets->menu()->aboutToShow();
        for (QAction* menu : presets->menu()->actions()) {
            if (menu->text() != "Curl") continue;
            for (QAction* action : menu->menu()->actions())
                if (action->text() == name) return action->trigger();
        }
        ADD_FAILURE() << name.toStdString();
    };
    const std::size_t before = groom().operators.size();
    curl("Curly");
    EXPECT_EQ(groom().operators.size(), before + 3);
    curl("Woolly");
    EXPECT_EQ(groom().operators.size(), before + 2) << "in place of the other class";
    expectEvaluated();
    curl("Straight");
    EXPECT_EQ(groom().operators.size(), before);
    undoAll();
}

TEST_F(OperatorsTest, AMaskLimitsAnOperatorAndItsRampIsDrawn) {
    choose(kClump);
    const auto whole = hash();
    auto* ramp = window->panel("operators")->findChild<RampEdit*>("maskRamp");
    ASSERT_TRUE(ramp);
    Q_EMIT ramp->begun();
    Q_EMIT ramp->edited(runtime::Ramp::straight(0, 1));
    EXPECT_EQ(maskOf(groom().operators[kClump]).ramp, runtime::Ramp::straight(0, 1));
    EXPECT_NE(hash(), whole);
    EXPECT_EQ(document().stepCount(), 1);
    expectEvaluated();
    auto* map = window->panel("operators")->findChild<QComboBox*>("map");
    ASSERT_TRUE(map);
    Q_EMIT map->activated(static_cast<int>(MaskMap::mask1));
    EXPECT_EQ(maskOf(groom().operators[kClump]).map, MaskMap::mask1);
    expectEvaluated();
    undoAll();
    EXPECT_EQ(hash(), whole);
}

TEST_F(OperatorsTest, AnImageBecomesAMaskAndTheDensityOfRoots) {
    QImage image(64, 64, QImage::Format_RGB32);
    image.fill(Qt::black);
    // Stripes, so that some roots are on black and some on white, wherever the scalp lies in it.
    const auto isWhite = [](int x) { return x / 4 % 2 == 1; };
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            if (isWhite(x)) image.setPixel(x, y, qRgb(255, 255, 255));
        }
    }
    ASSERT_TRUE(image.save(inFolder("half.png")));
    QFile broken(inFolder("broken.png"));
    ASSERT_TRUE(broken.open(QIODevice::WriteOnly) && broken.write("no picture") > 0);
    broken.close();
    choose(kClump);
    const auto before = hash();
    onceAskedForAFile(inFolder("broken.png"));
    window->panel("operators")->findChild<QPushButton*>("maskImage")->click();
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(window->statusLine().message().contains("broken.png"))
        << window->statusLine().message().toStdString();
    onceAskedForAFile(inFolder("half.png"));
    window->panel("operators")->findChild<QPushButton*>("maskImage")->click();
    EXPECT_EQ(maskOf(groom().operators[kClump]).map, MaskMap::mask3) << "the sample uses two";
    const auto mask = groom().strandAttributes.view<float>("mask.3");
    ASSERT_EQ(mask.size(), groom().strandCount());
    const auto uvs = groom().strandAttributes.view<Vec2f>(attribute::kRootUv);
    std::size_t white = 0;
    for (std::size_t s = 0; s < mask.size(); ++s) {
        ASSERT_NEAR(mask[s], isWhite(static_cast<int>(64 * uvs[s].x())) ? 1.0f : 0.0f, 1e-6f) << s;
        white += mask[s] > 0.5f ? 1 : 0;
    }
    EXPECT_GT(white, 0u);
    EXPECT_LT(white, mask.size());
    expectEvaluated();
    trigger("edit.undo");
    EXPECT_EQ(hash(), before) << "one step";
    // Masks that are in use stay as they are; where all are, it says so.
    const std::vector<float> painted(groom().strandCount(), 0.5f);
    document().perform(editing::setMask(document().editing().model(), 3, painted));
    onceAskedForAFile(inFolder("half.png"));
    window->panel("operators")->findChild<QPushButton*>("maskImage")->click();
    EXPECT_EQ(maskOf(groom().operators[kClump]).map, MaskMap::mask4);
    EXPECT_EQ(groom().strandAttributes.view<float>("mask.3")[0], 0.5f);
    trigger("edit.undo");
    document().perform(editing::setMask(document().editing().model(), 4, painted));
    const auto used = hash();
    onceAskedForAFile(inFolder("half.png"));
    window->panel("operators")->findChild<QPushButton*>("maskImage")->click();
    EXPECT_EQ(hash(), used);
    EXPECT_TRUE(window->statusLine().message().contains("all 4 masks are in use", Qt::CaseInsensitive))
        << window->statusLine().message().toStdString();
    undoAll();
    EXPECT_EQ(hash(), before);
    const auto density = groom().scalpDensity;
    onceAskedForAFile(inFolder("half.png"));
    window->panel("scalp")->findChild<QPushButton*>("densityImage")->click();
    EXPECT_EQ(groom().scalpDensity.size(), groom().scalp->vertexCount());
    EXPECT_NE(groom().scalpDensity, density);
    undoAll();
    EXPECT_EQ(hash(), before);
}

TEST_F(OperatorsTest, ThePenOfAPartingGivesItItsCurve) {
    choose(1);
    add("Part");
    ASSERT_EQ(groom().operators[2].op, "part");
    click("curveDraw");
    auto* tool = dynamic_cast<CurveTool*>(parts().tools.active());
    ASSERT_TRUE(tool);
    const auto pointer = [](double x, double y) {
        Pointer at;
        at.at_px = {x, y};
        at.button = Qt::LeftButton;
        return at;
    };
    const QSize size = parts().viewport.size();
    const double x = size.width() / 2.0, y = size.height() / 3.0;
    tool->press(pointer(x, y));
    for (int i = 1; i <= 20; ++i) tool->drag(pointer(x + i, y - 3 * i));
    tool->release(pointer(x + 20, y - 60));
    EXPECT_GE(curveOf(groom().operators[2]).points.size(), 2u);
    expectEvaluated();
    click("curveClear");
    EXPECT_TRUE(curveOf(groom().operators[2]).points.empty());
    undoAll();
    EXPECT_EQ(list().count(), sampleStack().size());
}

TEST_F(OperatorsTest, ButtonsOfAnEmptyStackDoNoHarm) {
    click("operatorBake");
    const auto baked = hash();
    for (const char* button : {"operatorUp", "operatorDown", "operatorCopy", "operatorRemove", "operatorBake",
                               "operatorSolo", "operatorClip"})
        click(button);
    EXPECT_EQ(hash(), baked);
    EXPECT_EQ(document().stepCount(), 1);
    add("Noise");
    EXPECT_EQ(rows(), QStringList{"Noise"});
    EXPECT_NE(hash(), baked);
    undoAll();
    choose(0);
    click("operatorUp");
    choose(list().count() - 1);
    click("operatorDown");
    EXPECT_FALSE(document().editing().canUndo()) << "nothing to exchange with";
}

TEST_F(OperatorsTest, BrushStrokesGoToASculptThatFollows) {
    viewport().look(render::View::Back);
    viewport().frameAll();
    trigger("tool.comb");
    dynamic_cast<BrushTool&>(*parts().tools.find("comb")).setRadius(0.04f);
    const auto before = hash();
    const float top = groom().scalp->bounds().max().y();
    drag({at(Vec3f(0.02f, top - 0.06f, -0.1f)), at(Vec3f(0.02f, top - 0.1f, -0.11f)),
          at(Vec3f(0.02f, top - 0.14f, -0.11f))});
    ASSERT_NE(hash(), before);
    EXPECT_EQ(rows().last(), "Sculpt");
    expectEvaluated();
    choose(list().count() - 1);
    NumberBox* weight = number("weight");
    weight->spinBox().setValue(0);
    expectEvaluated();
    const auto unsculpted = std::vector<Vec3f>(groom().positions().begin(), groom().positions().end());
    undoAll();
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(std::ranges::equal(groom().positions(), unsculpted)) << "a weight of 0 takes all back";
    EXPECT_EQ(list().count(), sampleStack().size());
}

TEST_F(OperatorsTest, AnotherDocumentShowsItsOwn) {
    choose(list().count() - 1);
    openBust();
    EXPECT_TRUE(rows().isEmpty());
    EXPECT_FALSE(window->panel("operators")->findChild<NumberBox*>("weight"));
    openSampleHair("long");
    EXPECT_EQ(list().count(), 12);
    EXPECT_EQ(rows().at(6), "Curl");
}

TEST_F(OperatorsTest, EachColourOfAnImageBecomesAMaskInOneStep) {
    QImage image(64, 64, QImage::Format_RGB32);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x)
            image.setPixel(x, y, x / 4 % 2 == 1 ? qRgb(0, 0, 255) : qRgb(255, 128, 0));
    }
    ASSERT_TRUE(image.save(inFolder("regions.png")));
    choose(kClump);
    const auto before = hash();
    onceAskedForAFile(inFolder("regions.png"));
    window->panel("operators")->findChild<QPushButton*>("regionsImage")->click();
    EXPECT_TRUE(window->statusLine().message().contains("mask 3: orange ("))
        << window->statusLine().message().toStdString();
    EXPECT_TRUE(window->statusLine().message().contains("mask 4: blue (")) << "the sample uses two";
    EXPECT_EQ(groom().maskNames, (std::vector<std::string>{"", "", "orange", "blue"}));
    const auto orange = groom().strandAttributes.view<float>("mask.3");
    const auto blue = groom().strandAttributes.view<float>("mask.4");
    ASSERT_EQ(orange.size(), groom().strandCount());
    ASSERT_EQ(blue.size(), groom().strandCount());
    for (std::size_t s = 0; s < blue.size(); ++s) ASSERT_EQ(orange[s] + blue[s], 1.0f) << s;
    EXPECT_GT(std::ranges::count(blue, 1.0f), 0);
    EXPECT_GT(std::ranges::count(orange, 1.0f), 0);
    EXPECT_EQ(document().stepCount(), 1);
    const auto filled = hash();
    onceAskedForAFile(inFolder("regions.png"));
    window->panel("operators")->findChild<QPushButton*>("regionsImage")->click();
    EXPECT_TRUE(window->statusLine().message().contains("0 of 4 are free"))
        << window->statusLine().message().toStdString();
    EXPECT_EQ(hash(), filled) << "what is painted stays";
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
}

TEST_F(OperatorsTest, ANumberBecomesAFormulaAndBack) {
    choose(kClump);
    const auto before = hash();
    auto* button = window->panel("operators")->findChild<QToolButton*>("strengthFormulaButton");
    auto* edit = window->panel("operators")->findChild<QLineEdit*>("strengthFormula");
    auto* problem = window->panel("operators")->findChild<QLabel*>("strengthFormulaProblem");
    ASSERT_TRUE(button && edit && problem);
    EXPECT_FALSE(window->panel("operators")->findChild<QToolButton*>("spacingFormulaButton"))
        << "one number says where all clumps are";
    EXPECT_FALSE(edit->isVisible());
    QTest::mouseClick(button, Qt::LeftButton);
    ASSERT_TRUE(edit->isVisible());
    const auto type = [&](const QString& text) {
        edit->setFocus();
        edit->setText(text);
        QTest::keyClick(edit, Qt::Key_Return);
        QCoreApplication::processEvents();
    };
    type("0.2 + 0.8*random");
    EXPECT_FALSE(problem->isVisible()) << problem->text().toStdString();
    EXPECT_EQ(formulaOf(groom().operators[kClump], "strength"), "0.2 + 0.8*random");
    EXPECT_FALSE(number("strength")->isEnabled());
    EXPECT_NE(hash(), before);
    expectEvaluated();
    const auto formed = hash();
    for (const auto& [wrong, said] :
         std::initializer_list<std::pair<const char*, const char*>>{{"1/0", "no number"},
                                                                    {"3*random", "expected 0 to 1"},
                                                                    {"t", "along the strand"},
                                                                    {"strength", "not known"},
                                                                    {"noise(", "ends"}}) {
        type(wrong);
        EXPECT_TRUE(problem->isVisible()) << wrong;
        EXPECT_TRUE(problem->text().contains(said)) << problem->text().toStdString();
        EXPECT_EQ(hash(), formed) << "the last good one stays";
    }
    EXPECT_EQ(document().stepCount(), 1);
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(number("strength")->isEnabled());
    trigger("edit.redo");
    EXPECT_EQ(hash(), formed);
    QTest::mouseClick(button, Qt::LeftButton);
    EXPECT_EQ(hash(), before) << "the number stayed beside it";
    EXPECT_FALSE(edit->isVisible());
}

}  // namespace
}  // namespace hairloom::editor
