// SPDX-License-Identifier: GPL-3.0-or-later
// What must never surprise somebody who uses the window, of every control of a kind wherever it is.
#include <QAbstractItemView>
#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QSpinBox>
#include <QTreeWidget>

#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "tests/editor/controls_fixture.h"

namespace hairloom::editor {
namespace {

class SurprisesTest : public ControlsTest {
  protected:
    /// What scrolls up and down is not cut at its right side, nor are columns of tables.
    static void expectAllAcross(QAbstractScrollArea& area, const std::string& name) {
        const auto isCut = [&] {
            if (const auto* scroll = qobject_cast<QScrollArea*>(&area); scroll && scroll->widgetResizable())
                return scroll->widget()->minimumSizeHint().width() > scroll->viewport()->width();
            const auto* table = qobject_cast<QTreeView*>(&area);
            return table && table->header()->isVisible() &&
                   table->header()->length() > table->viewport()->width();
        };
        EXPECT_TRUE(QTest::qWaitFor([&] { return !isCut(); }, kPatience))
            << name << ", " << area.objectName().toStdString() << " has " << area.viewport()->width();
    }
    void inEachPanel(const std::function<void(QDockWidget&, const QString&)>& look) {
        for (const PanelInfo& info : panels()) {
            window->panel(info.id)->show();
            window->panel(info.id)->raise();
            QCoreApplication::processEvents();
            look(*window->panel(info.id), info.id);
        }
    }
    void setOperators(std::vector<Operator> operators) {
        auto step = editing::setOperators(document().editing().model(), std::move(operators), "Operators");
        ASSERT_TRUE(step) << step.error().message();
        document().perform(std::move(*step));
        QCoreApplication::processEvents();
    }
};

TEST_F(SurprisesTest, TheWheelOverWhateverLiesInAPanelOrDialogChangesNothing) {
    openSampleHair("short");
    Operator curl = newOperator("curl");
    Mask mask = maskOf(curl);
    mask.ramp = runtime::Ramp::straight(0, 1);
    setMaskOf(curl, mask);
    setOperators({newOperator("part"), curl});
    const auto before = hash();
    const int steps = document().stepCount();
    inEachPanel([](QDockWidget& panel, const QString& name) { expectWheelChangesNothingIn(panel, name); });
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(document().stepCount(), steps);
    inEachDialog([](QDialog& dialog, const QString& name) { expectWheelChangesNothingIn(dialog, name); });
    EXPECT_EQ(hash(), before);
}

TEST_F(SurprisesTest, EveryNumberIsTakenWithPointAndComma) {
    openSampleHair("short");
    std::size_t numbers = 0;
    const auto look = [&](const QWidget& place, const QString& name) {
        for (auto* spin : place.findChildren<QDoubleSpinBox*>()) {
            if (spin->decimals() == 0) continue;
            const std::string what = nameOf(name, *spin);
            // Between its limits, as it would be typed.
            const double value = std::clamp(0.4, spin->minimum(), spin->maximum());
            QString point = QString::number(value, 'f', spin->decimals()), comma = point;
            comma.replace('.', ',');
            int end = 0;
            EXPECT_NE(spin->validate(comma, end), QValidator::Invalid) << what;
            EXPECT_NEAR(spin->valueFromText(comma), value, 1e-6 + 1e-3 * std::abs(value)) << what;
            EXPECT_EQ(spin->valueFromText(comma), spin->valueFromText(point)) << what;
            EXPECT_FALSE(spin->text().contains(',')) << what << " shows " << spin->text().toStdString();
            ++numbers;
        }
    };
    const QLocale own;
    QLocale::setDefault(QLocale(QLocale::German));
    inEachPanel(look);
    inEachDialog(look);
    QLocale::setDefault(own);
    EXPECT_GT(numbers, 60u);
}

TEST_F(SurprisesTest, FocusIsSeenOnEveryControl) {
    openBust();
    std::size_t seen = 0;
    inEachPanel([&](QDockWidget& panel, const QString& name) {
        for (QWidget* control : controlsOf(panel)) {
            if (!control->isEnabled() || control->focusPolicy() == Qt::NoFocus) continue;
            const QImage without = control->grab().toImage();
            control->setFocus(Qt::TabFocusReason);
            if (!control->hasFocus()) continue;
            const QImage with = control->grab().toImage();
            control->clearFocus();
            EXPECT_NE(with, without) << nameOf(name, *control) << " looks the same with the focus";
            ++seen;
        }
    });
    EXPECT_GT(seen, 60u);
}

TEST_F(SurprisesTest, SpacePressesButtonsAndReturnChoosesOnLists) {
    openBust();
    setOperators({newOperator("flow"), newOperator("noise")});
    window->panel("operators")->raise();
    QCoreApplication::processEvents();
    auto* list = window->panel("operators")->findChild<QListWidget*>("operators");
    list->setCurrentRow(0);
    // A button, not the view's Play.
    auto* copy = find<QPushButton>("operatorCopy");
    copy->setFocus();
    ASSERT_TRUE(copy->hasFocus());
    QTest::keyClick(copy, Qt::Key_Space);
    EXPECT_EQ(groom().operators.size(), 3u);
    EXPECT_FALSE(parts().player.isPlaying());
    // Return on a step of the history goes there.
    window->panel("history")->raise();
    QCoreApplication::processEvents();
    auto* history = window->panel("history")->findChild<QListWidget*>();
    ASSERT_TRUE(history);
    history->setFocus();
    history->setCurrentRow(0);
    QTest::keyClick(history, Qt::Key_Return);
    EXPECT_TRUE(groom().operators.empty());
}

TEST_F(SurprisesTest, MessagesBeginWithACapitalAndNamesOfFilesStay) {
    const auto shown = [&](const QString& text) {
        parts().messages.say(text);
        return window->statusLine().message();
    };
    EXPECT_EQ(shown("no scalp is selected; select it first"), "No scalp is selected; select it first");
    EXPECT_EQ(shown("bust.obj: a head"), "bust.obj: a head");
    EXPECT_EQ(shown("v_002: saved"), "v_002: saved");
    EXPECT_EQ(shown("Saved"), "Saved");
    EXPECT_EQ(shown(""), "");
}

TEST_F(SurprisesTest, ACancelledImportLeavesEverything) {
    openSampleHair("short");
    ExportDialog exports(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    exports.findChild<QComboBox*>("target")->setCurrentText("Yuksel .hair");
    exports.exportTo(inFolder("a.hair"));
    finishWork();
    const auto before = hash();
    const int steps = document().stepCount();
    const QString title = document().title();
    const QStringList recent = parts().preferences.recentFiles();
    ImportDialog dialog(document(), parts().tasks, inFolder("a.hair"), window.get());
    dialog.show();
    finishWork();
    for (auto* box : dialog.findChildren<QComboBox*>())
        box->setCurrentIndex((box->currentIndex() + 1) % std::max(1, box->count()));
    finishWork();
    dialog.reject();
    finishWork();
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(document().stepCount(), steps);
    EXPECT_EQ(document().title(), title);
    EXPECT_EQ(parts().preferences.recentFiles(), recent);
    // Nor does a dialog of exports that is closed write anything.
    const QStringList files = QDir(folder.path()).entryList(QDir::Files);
    exports.findChild<QComboBox*>("target")->setCurrentText("TressFX");
    exports.reject();
    finishWork();
    EXPECT_EQ(QDir(folder.path()).entryList(QDir::Files), files);
}

TEST_F(SurprisesTest, PanelsWithNothingInThemSayWhatWouldFillThem) {
    const auto look = [](QDockWidget& panel, const QString& name) {
        int words = 0, usable = 0;
        for (const auto* label : panel.findChildren<QLabel*>()) {
            if (label->isVisible() && !label->objectName().startsWith("qt_"))
                words = std::max(words, static_cast<int>(label->text().split(' ').size()));
        }
        for (const QWidget* control : controlsOf(panel)) {
            const auto* view = qobject_cast<const QAbstractItemView*>(control);
            usable += control->isEnabled() && (!view || view->model()->rowCount() > 0) ? 1 : 0;
        }
        EXPECT_TRUE(words >= 4 || usable > 0) << name.toStdString() << " says nothing and offers nothing";
        // A list without a row has words beside it.
        for (const auto* view : panel.findChildren<QAbstractItemView*>()) {
            if (view->isVisible() && view->model() && view->model()->rowCount() == 0) {
                EXPECT_GE(words, 4) << nameOf(name, *view) << " is empty";
            }
        }
    };
    openBust();
    inEachPanel(look);
}

TEST_F(SurprisesTest, NoOperatorMakesItsPanelScrollSideways) {
    openBust();
    trigger("view.resetLayout");  // columns as they are on a screen of 1280 pixels
    window->panel("operators")->raise();
    std::vector<Operator> all;
    for (const StackOperator& kind : stackOperators()) all.push_back(newOperator(kind.name));
    setOperators(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
        window->panel("operators")->findChild<QListWidget*>("operators")->setCurrentRow(static_cast<int>(i));
        QCoreApplication::processEvents();
        for (QAbstractScrollArea* area : window->panel("operators")->findChildren<QAbstractScrollArea*>()) {
            if (!area->isVisible()) continue;
            // Settings that have just come are laid out in steps.
            EXPECT_TRUE(QTest::qWaitFor([&] { return !area->horizontalScrollBar()->isVisible(); }, kPatience))
                << all[i].op << ", " << area->objectName().toStdString() << ": " << area->width() << " for "
                << area->findChild<QWidget*>()->minimumSizeHint().width();
            expectAllAcross(*area, all[i].op);
        }
    }
}

TEST_F(SurprisesTest, NoPanelIsCutWhereColumnsAreAsNarrowAsTheyGet) {
    openSampleHair("short");
    for (const QSize& size : {QSize(1280, 800), QSize(1000, 700)}) {
        window->resize(size);
        trigger("view.resetLayout");
        inEachPanel([&](QDockWidget& panel, const QString& name) {
            for (QAbstractScrollArea* area : panel.findChildren<QAbstractScrollArea*>()) {
                if (area->isVisible()) expectAllAcross(*area, name.toStdString());
            }
        });
    }
}

TEST_F(SurprisesTest, WhyIsReadableAndPricesLostInNoiseSaySo) {
    openSampleHair("short");
    window->panel("effects")->raise();
    auto* table = find<QTreeWidget>("effects");
    ASSERT_TRUE(QTest::qWaitFor([&] { return table->topLevelItemCount() > 5; }, kPatience));
    trigger("view.resetLayout");  // columns as they are on a screen of 1280 pixels
    QCoreApplication::processEvents();
    EXPECT_FALSE(table->horizontalScrollBar()->isVisible());
    EXPECT_LE(table->header()->length(), table->viewport()->width());
    const auto expectReadable = [&] {
        for (int i = 0; i < table->topLevelItemCount(); ++i) {
            const QTreeWidgetItem& item = *table->topLevelItem(i)->child(0);
            if (item.isHidden()) continue;
            const QString why = item.text(0);
            EXPECT_FALSE(why.isEmpty());
            const QRect cell = table->visualItemRect(&item);
            ASSERT_FALSE(cell.isEmpty()) << why.toStdString() << " is folded away";
            const int room = cell.width() - 8;
            const QRect needed =
                table->fontMetrics().boundingRect(QRect(0, 0, room, 10'000), Qt::TextWordWrap, why);
            EXPECT_LE(needed.width(), room) << why.toStdString() << ": a word is too long";
            EXPECT_LE(needed.height(), cell.height() + 2) << why.toStdString();
            EXPECT_LE(needed.height(), 3 * table->fontMetrics().height())
                << why.toStdString() << " is a tower";
        }
    };
    expectReadable();
    openFirstStrands(12);
    QCoreApplication::processEvents();
    find<QPushButton>("effectsMeasure")->click();
    parts().tasks.finish();
    QCoreApplication::processEvents();
    int priced = 0;
    for (int i = 1; i < table->topLevelItemCount(); ++i) {
        const QTreeWidgetItem& item = *table->topLevelItem(i);
        const QString price = item.text(1);
        EXPECT_FALSE(price.startsWith('-') || price.startsWith(u'−')) << price.toStdString();
        priced += item.toolTip(1).isEmpty() ? 0 : 1;
        if (price == QString::fromUtf8("≈ 0")) {
            EXPECT_TRUE(item.toolTip(1).contains("spread")) << item.toolTip(1).toStdString();
        } else if (price == "< 0") {
            EXPECT_TRUE(item.toolTip(1).contains("longer without")) << item.toolTip(1).toStdString();
        }
    }
    EXPECT_GT(priced, 0);
    expectReadable();
}

}  // namespace
}  // namespace hairloom::editor
