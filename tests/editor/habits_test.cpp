// SPDX-License-Identifier: GPL-3.0-or-later
// What somebody who knows other programs expects of every control, and what must never surprise them.
#include <QAbstractItemView>
#include <QAccessible>
#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QRegularExpression>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>
#include <QTreeWidget>
#include <cmath>
#include <set>

#include "core/editing/stack_commands.h"
#include "core/operations/head_places.h"
#include "core/operations/stack.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/head_dialog.h"
#include "editor/dialogs/preferences_dialog.h"
#include "editor/dialogs/shortcut_dialog.h"
#include "editor/fields/input_rules.h"
#include "editor/fields/number_box.h"
#include "editor/tools/handle_tool.h"
#include "tests/editor/wheel.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class HabitsTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        activate();
    }
    void activate() {
        window->activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
    }
    void add(std::string_view name) {
        auto command =
            editing::addOperator(document().editing().model(), groom().operators.size(), newOperator(name));
        ASSERT_TRUE(command) << command.error().message();
        document().perform(std::move(*command));
    }
};

TEST_F(HabitsTest, TheWheelOverAnyFieldScrollsItsPanelAndChangesNothing) {
    openSampleHair("short");
    const auto before = hash();
    std::size_t fields = 0, scrolled = 0;
    for (const PanelInfo& info : panels()) {
        QDockWidget* dock = window->panel(info.id);
        dock->raise();
        QCoreApplication::processEvents();
        for (QWidget* field : dock->findChildren<QWidget*>()) {
            const bool isField = qobject_cast<QAbstractSpinBox*>(field) || qobject_cast<QComboBox*>(field) ||
                                 qobject_cast<QSlider*>(field);
            if (!isField || !field->isVisible()) continue;
            ++fields;
            QScrollArea* area = nullptr;
            for (QWidget* at = field; at && !area; at = at->parentWidget())
                area = qobject_cast<QScrollArea*>(at);
            if (area) area->verticalScrollBar()->setValue(0);
            for (int i = 0; i < 3; ++i) turnWheel(*field, 1);
            EXPECT_FALSE(field->hasFocus()) << field->objectName().toStdString();
            if (area && area->verticalScrollBar()->value() > 0) ++scrolled;
        }
    }
    EXPECT_GT(fields, 60u);
    EXPECT_GT(scrolled, 30u);
    EXPECT_EQ(document().stepCount(), 0);
    EXPECT_EQ(hash(), before);
}

TEST_F(HabitsTest, AFieldThatHasTheFocusTakesTheWheel) {
    openSampleHair("short");
    window->panel("physics")->raise();
    auto& spin = find<NumberBox>("windSpeed")->spinBox();
    spin.setFocus();
    ASSERT_TRUE(spin.hasFocus());
    turnWheel(spin, -1);
    EXPECT_GT(groom().simulation.windSpeed, 0.0f);
}

TEST_F(HabitsTest, DecimalsAreTakenWithPointAndComma) {
    openSampleHair("short");
    window->panel("physics")->raise();
    auto& spin = find<NumberBox>("windSpeed")->spinBox();
    for (const auto& [typed, wanted] : std::vector<std::pair<QString, float>>{
             {"0.4", 0.4f}, {"0,4", 0.4f}, {"7", 7.0f}, {"1,25", 1.25f}, {",5", 0.5f}, {"3.", 3.0f}}) {
        spin.setFocus();
        spin.selectAll();
        QTest::keyClicks(&spin, typed);
        QTest::keyClick(&spin, Qt::Key_Return);
        EXPECT_FLOAT_EQ(groom().simulation.windSpeed, wanted) << typed.toStdString();
    }
    for (const auto& [typed, wanted] : std::vector<std::pair<QString, QString>>{{"0,4", "0.4"},
                                                                                {"1,234.5", "1234.5"},
                                                                                {"1.234,5", "1234.5"},
                                                                                {"1,234,567", "1234567"},
                                                                                {"12", "12"},
                                                                                {"1.2.3", "1.2.3"}}) {
        EXPECT_EQ(withDecimalPoint(typed), wanted);
    }
}

TEST_F(HabitsTest, NumbersLookAlikeInEveryLocale) {
    const QLocale own;
    for (const QLocale::Language language : {QLocale::German, QLocale::French, QLocale::English}) {
        window->close();
        window.reset();
        QLocale::setDefault(QLocale(language));
        open();
        openSampleHair("short");
        auto& spin = find<NumberBox>("windSpeed")->spinBox();
        spin.setValue(2.5);
        EXPECT_TRUE(spin.text().startsWith("2.5")) << spin.text().toStdString();
        EXPECT_TRUE(find<QLabel>("counts")->text().contains("4,000 strands"))
            << find<QLabel>("counts")->text().toStdString();
        EXPECT_FALSE(
            find<NumberBox>("windSpeed")->toolTip().contains(QRegularExpression("[0-9],[0-9]{1,2}[^0-9]")));
    }
    QLocale::setDefault(own);
}

TEST_F(HabitsTest, SpacePressesTheButtonThatHasTheFocusAndPlaysFromTheView) {
    openSampleHair("short");
    openFirstStrands(20);
    window->panel("scalp")->raise();
    auto* preview = find<QPushButton>("saveLook");
    window->panel("look")->raise();
    QCoreApplication::processEvents();
    auto* box = window->panel("view")->findChild<QCheckBox*>("hair");
    window->panel("view")->raise();
    box->setFocus();
    ASSERT_TRUE(box->hasFocus());
    const bool was = box->isChecked();
    QTest::keyClick(box, Qt::Key_Space);
    EXPECT_NE(box->isChecked(), was);
    EXPECT_FALSE(parts().player.isPlaying());
    ASSERT_TRUE(preview);
    static_cast<QWidget*>(viewport().input())->setFocus();
    QTest::keyClick(static_cast<QWidget*>(viewport().input()), Qt::Key_Space);
    EXPECT_TRUE(parts().player.isPlaying());
    parts().player.reset();
}

TEST_F(HabitsTest, ReturnOpensASampleFromTheStartPage) {
    auto* bare = find<QPushButton>("sample:");
    bare->setFocus();
    ASSERT_TRUE(bare->hasFocus());
    QTest::keyClick(bare, Qt::Key_Return);
    finishWork();
    EXPECT_TRUE(groom().scalp) << window->statusLine().message().toStdString();
}

TEST_F(HabitsTest, CancellingAHeadThatLooksWrongLeavesTheDocumentAsItWas) {
    openSampleHair("short");
    const auto before = hash();
    const QString title = document().title();
    QFile file(inFolder("huge.obj"));
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write("v 0 0 0\nv 17 0 0\nv 0 17 0\nv 0 0 17\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    file.close();
    window->open(file.fileName());
    // What the file is, and then what is in it.
    ASSERT_TRUE(QTest::qWaitFor([&] { return window->findChild<HeadDialog*>() != nullptr; }, kPatience));
    auto* dialog = window->findChild<HeadDialog*>();
    finishWork();
    EXPECT_EQ(hash(), before) << "nothing is opened before it is accepted";
    dialog->reject();
    finishWork();
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(document().title(), title);
    EXPECT_FALSE(parts().preferences.recentFiles().contains(file.fileName()));
}

TEST_F(HabitsTest, EveryControlIsReachedByKeyboardAndHasAName) {
    openSampleHair("short");
    add("flow");
    std::size_t named = 0;
    for (const PanelInfo& info : panels()) {
        window->panel(info.id)->raise();
        QCoreApplication::processEvents();
        for (QWidget* control : window->panel(info.id)->findChildren<QWidget*>()) {
            const bool isControl =
                qobject_cast<QAbstractButton*>(control) || qobject_cast<QAbstractSpinBox*>(control) ||
                qobject_cast<QComboBox*>(control) || qobject_cast<QAbstractItemView*>(control);
            if (!isControl || !control->isVisible() || control->objectName().startsWith("qt_")) continue;
            if (qobject_cast<QHeaderView*>(control)) continue;
            const std::string what = info.id.toStdString() + ": " + control->objectName().toStdString() +
                                     " " + control->metaObject()->className();
            EXPECT_TRUE(control->focusPolicy() & Qt::TabFocus) << what;
            QAccessibleInterface* spoken = QAccessible::queryAccessibleInterface(control);
            ASSERT_TRUE(spoken) << what;
            EXPECT_FALSE(spoken->text(QAccessible::Name).isEmpty()) << what;
            ++named;
        }
    }
    EXPECT_GT(named, 100u);
}

TEST_F(HabitsTest, ExportOffersEachProgramOnceAndSaysWhatItWillWrite) {
    openSampleHair("short");
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player,
                        window.get());
    dialog.show();
    auto* target = dialog.findChild<QComboBox*>("target");
    auto* format = dialog.findChild<QComboBox*>("format");
    std::set<QString> names;
    for (int i = 0; i < target->count(); ++i)
        EXPECT_TRUE(names.insert(target->itemText(i)).second) << target->itemText(i).toStdString();
    EXPECT_TRUE(names.contains("Blender"));
    EXPECT_TRUE(names.contains("Unity hair"));
    const auto* will = dialog.findChild<QLabel*>("willWrite");
    const auto bytesSaid = [&] {
        const auto said = QRegularExpression("about ([0-9.]+) ([kM]?)B").match(will->text());
        EXPECT_TRUE(said.hasMatch()) << will->text().toStdString();
        return said.captured(1).toDouble() * (said.captured(2) == "M"   ? 1e6
                                              : said.captured(2) == "k" ? 1e3
                                                                        : 1);
    };
    for (int i = 0; i < target->count(); ++i) {
        target->setCurrentIndex(i);
        for (int f = 0; f < format->count(); ++f) {
            format->setCurrentIndex(f);
            if (!will->text().contains("about") || target->currentText() == "Web page with moving hair")
                continue;
            const double said = bytesSaid();
            const QString name = target->currentText() + ", " + format->itemText(f);
            dialog.exportTo(inFolder(qPrintable(QString("said_%1_%2.file").arg(i).arg(f))));
            finishWork();
            ASSERT_GT(dialog.report().bytes, 0u)
                << name.toStdString() << ": " << window->statusLine().message().toStdString();
            const double ratio = said / static_cast<double>(dialog.report().bytes);
            EXPECT_GT(ratio, 0.67) << name.toStdString();
            EXPECT_LT(ratio, 1.5) << name.toStdString();
        }
    }
}

TEST_F(HabitsTest, FindingsOfAnExportBelongToTheTargetThatIsChosen) {
    openSampleHair("short");
    openFirstStrands(40);
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    auto* target = dialog.findChild<QComboBox*>("target");
    auto* findings = dialog.findChild<QTreeWidget*>("findings");
    target->setCurrentText("TressFX");
    dialog.exportTo(inFolder("few.tfx"));
    finishWork();
    EXPECT_GT(findings->topLevelItemCount(), 0);
    target->setCurrentText("Yuksel .hair");
    EXPECT_EQ(findings->topLevelItemCount(), 0);
}

TEST_F(HabitsTest, ATargetThatCannotWorkHereSaysSoFirst) {
    openSampleHair("short");
    qputenv("HAIRLOOM_WEB", inFolder("nothing").toUtf8());
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.show();
    dialog.findChild<QComboBox*>("target")->setCurrentText("Web page with moving hair");
    qunsetenv("HAIRLOOM_WEB");
    auto* problem = dialog.findChild<QLabel*>("problem");
    EXPECT_TRUE(problem->isVisible());
    EXPECT_TRUE(problem->text().contains("./dev web")) << problem->text().toStdString();
    for (const auto* button : dialog.findChildren<QPushButton*>()) {
        if (button->text() == "Export…") {
            EXPECT_FALSE(button->isEnabled());
        }
    }
    dialog.findChild<QComboBox*>("target")->setCurrentText("Yuksel .hair");
    EXPECT_FALSE(problem->isVisible());
}

TEST_F(HabitsTest, ManyGuidesForAGameWarnAndOfferFewer) {
    openSampleHair("short");
    Groom few = groom();
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.show();
    auto* target = dialog.findChild<QComboBox*>("target");
    auto* cluster = dialog.findChild<QPushButton*>("cluster");
    target->setCurrentText("Game by Hairloom's runtime");
    EXPECT_FALSE(cluster->isVisible()) << "4,000 guides";
    Groom many = firstStrands(few, 2000);
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (int copy = 0; copy < 8; ++copy) {
        for (std::size_t s = 0; s < many.strandCount(); ++s) {
            const auto strand = many.strand(s);
            positions.insert(positions.end(), strand.begin(), strand.end());
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        }
    }
    document().open(makeGroom(offsets, positions), {}, "many");
    target->setCurrentText("Yuksel .hair");
    EXPECT_FALSE(cluster->isVisible());
    target->setCurrentText("Game by Hairloom's runtime");
    ASSERT_TRUE(cluster->isVisible());
    EXPECT_TRUE(dialog.findChild<QLabel*>("manyGuides")->text().contains("16,000"));
    cluster->click();
    EXPECT_EQ(dialog.result(), ExportDialog::kWantsClustering);
}

TEST_F(HabitsTest, KeysOfToolsAreBackOnceWordsAreTypedOrGivenUp) {
    openSampleHair("short");
    window->panel("operators")->raise();
    window->panel("operators")->findChild<QListWidget*>("operators")->setCurrentRow(0);
    auto* button = window->panel("operators")->findChild<QToolButton*>("lengthFormulaButton");
    auto* formula = window->panel("operators")->findChild<QLineEdit*>("lengthFormula");
    ASSERT_TRUE(button && formula);
    QTest::mouseClick(button, Qt::LeftButton);
    ASSERT_TRUE(formula->hasFocus());
    QTest::keyClicks(formula, "0.05+0.01*random");
    QTest::keyClick(formula, Qt::Key_Return);
    EXPECT_FALSE(formula->hasFocus());
    const auto typed = hash();
    formula->setFocus();
    formula->selectAll();
    QTest::keyClicks(formula, "1/0");
    QTest::keyClick(formula, Qt::Key_Return);
    EXPECT_TRUE(formula->hasFocus()) << "there is something to mend";
    QTest::keyClick(formula, Qt::Key_Escape);
    EXPECT_FALSE(formula->hasFocus());
    EXPECT_EQ(formula->text(), "0.05+0.01*random") << "the last good one";
    EXPECT_FALSE(find<QLabel>("lengthFormulaProblem")->isVisible());
    EXPECT_EQ(hash(), typed);
    window->panel("scalp")->raise();
    auto* expression = find<QLineEdit>("scalpExpression");
    expression->setFocus();
    QTest::keyClicks(expression, "above:0.9");
    QTest::keyClick(expression, Qt::Key_Escape);
    EXPECT_FALSE(expression->hasFocus());
    EXPECT_EQ(expression->text(), "");
    EXPECT_EQ(hash(), typed);
}

TEST_F(HabitsTest, NoPanelScrollsSideways) {
    openSampleHair("short");
    for (const int width : {1280, 1024}) {
        window->resize(width, 800);
        for (const PanelInfo& info : panels()) {
            window->panel(info.id)->raise();
            QCoreApplication::processEvents();
            for (QAbstractScrollArea* area : window->panel(info.id)->findChildren<QAbstractScrollArea*>()) {
                if (!area->isVisible()) continue;
                EXPECT_FALSE(area->horizontalScrollBar()->isVisible())
                    << info.id.toStdString() << ", " << area->objectName().toStdString() << " at " << width;
            }
        }
    }
}

TEST_F(HabitsTest, TheViewShowsAsMuchAcrossWhenTheWindowShrinksAndComesBack) {
    openHairFromTheFront();
    const auto across = [this] {
        const Box3f box = groom().bounds();
        const auto left = viewport().camera().project({box.min().x(), box.center().y(), box.center().z()},
                                                      viewport().viewSize_px());
        const auto right = viewport().camera().project({box.max().x(), box.center().y(), box.center().z()},
                                                       viewport().viewSize_px());
        return std::pair(left->x(), right->x());
    };
    // Of the shorter side of the view, which the panels leave more or less of.
    const auto share = [&] {
        return (across().second - across().first) / std::min(viewport().width(), viewport().height());
    };
    window->resize(1280, 700);
    QCoreApplication::processEvents();
    viewport().frameAll();
    const double wide = share();
    for (const QSize size : {QSize(900, 1000), QSize(1280, 700)}) {
        window->resize(size);
        const auto isSeenWhole = [&] { return across().first > 0 && across().second < viewport().width(); };
        EXPECT_TRUE(QTest::qWaitFor(isSeenWhole, kPatience)) << size.width();
    }
    EXPECT_TRUE(QTest::qWaitFor([&] { return std::abs(share() - wide) < 0.005; }, kPatience)) << share();
    EXPECT_NEAR(0.5 * (across().first + across().second), 0.5 * viewport().width(), 2);
}

TEST_F(HabitsTest, AllSixSidesHaveAKey) {
    openHairFromTheFront();
    const auto looks = [&](const char* id) {
        trigger(id);
        return viewport().camera().forward_ws();
    };
    EXPECT_NEAR(looks("view.top").dot(-Vec3f::UnitY()), 1, 1e-4f);
    EXPECT_NEAR(viewport().camera().up_ws().dot(-Vec3f::UnitZ()), 1, 1e-4f) << "the face is below";
    EXPECT_NEAR(looks("view.bottom").dot(Vec3f::UnitY()), 1, 1e-4f);
    EXPECT_NEAR(looks("view.front").dot(-Vec3f::UnitZ()), 1, 1e-4f);
    EXPECT_EQ(window->actions().get("view.top").shortcut(), QKeySequence("7"));
    EXPECT_EQ(window->actions().get("view.bottom").shortcut(), QKeySequence("Ctrl+7"));
    EXPECT_FALSE(window->actions().get("view.turntable").shortcut().isEmpty());
}

TEST_F(HabitsTest, PointsOfAnOperatorAreDraggedAndPickedOnTheHead) {
    openHairFromTheFront();
    document().perform(std::move(*editing::setOperators(document().editing().model(), {}, "None")));
    add("flow");
    window->panel("operators")->raise();
    auto* tool = dynamic_cast<HandleTool*>(parts().tools.find("handles"));
    ASSERT_TRUE(tool);
    parts().tools.activate(tool);
    tool->setOperator(0);
    trigger("view.top");
    viewport().frameAll();
    const auto handles = tool->handles();
    ASSERT_GE(handles.size(), 4u);
    EXPECT_EQ(std::string(handles[0].field.name), "crown");
    EXPECT_EQ(tool->place_ss(handles[0]), crownOfHead(groom())) << "where the operator finds it";
    const QPoint from = at(tool->place_ss(handles[0]));
    drag({from, from + QPoint(10, 10), from + QPoint(40, 20)});
    const Vec3f moved = tool->place_ss(handles[0]);
    EXPECT_GT((moved - crownOfHead(groom())).norm(), 0.005f);
    EXPECT_NEAR(std::abs(document().editing().skin()->distanceAt(moved).distance), 0, 0.002f);
    EXPECT_EQ(document().stepCount(), 3) << "one drag is one step";
    // Esc takes a drag back.
    const QPoint again = at(moved);
    press(again);
    moveTo(again + QPoint(30, -30));
    key(Qt::Key_Escape);
    EXPECT_LT((tool->place_ss(handles[0]) - moved).norm(), 1e-5f);
    release(again);
    // Picked: beside the head nothing happens, on it the point is there.
    find<QPushButton>("crownPick")->click();
    const auto before = hash();
    press(QPoint(3, 3));
    release(QPoint(3, 3));
    EXPECT_EQ(hash(), before);
    const QPoint onHead = at(topOfHead(groom()));
    press(onHead);
    release(onHead);
    EXPECT_LT((tool->place_ss(handles[0]) - topOfHead(groom())).norm(), 0.01f);
    expectSound();
}

TEST_F(HabitsTest, EmptyPanelsSayWhatWouldFillThem) {
    openBust();
    window->panel("operators")->raise();
    QCoreApplication::processEvents();
    EXPECT_TRUE(find<QLabel>("operatorsNone")->isVisible());
    add("flow");
    QCoreApplication::processEvents();
    EXPECT_FALSE(window->findChild<QLabel*>("operatorsNone"));
}

TEST_F(HabitsTest, OperatorsMoveByKeysAndDeleteTakesTheOperatorNotTheStrands) {
    openSampleHair("short");
    document().perform(std::move(*editing::setOperators(document().editing().model(), {}, "None")));
    add("flow");
    add("noise");
    window->panel("operators")->raise();
    QCoreApplication::processEvents();
    auto* list = window->panel("operators")->findChild<QListWidget*>("operators");
    list->setFocus();
    list->setCurrentRow(1);
    QTest::keyClick(list, Qt::Key_Up, Qt::AltModifier);
    EXPECT_EQ(groom().operators[0].op, "noise");
    const std::size_t strands = groom().strandCount();
    trigger("select.all");
    QTest::keyClick(list, Qt::Key_Delete);
    EXPECT_EQ(groom().operators.size(), 1u);
    EXPECT_EQ(groom().strandCount(), strands);
}

}  // namespace
}  // namespace hairloom::editor
