// SPDX-License-Identifier: GPL-3.0-or-later
// A person who tries everything in no order: clicks, drags, wheels, keys, menus, controls. Nothing ends the
// program, the hair stays sound, and memory stays flat. `./dev soak` does it for long.
#include <QAbstractButton>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QDockWidget>
#include <QMenuBar>
#include <QTimer>
#include <QWheelEvent>
#include <random>
#include <set>

#include "editor/fields/number_box.h"
#include "tests/documents/small_head.h"
#include "tests/editor/resident_memory.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

int numberFrom(const char* variable, int otherwise) {
    bool isNumber = false;
    const int value = qEnvironmentVariableIntValue(variable, &isNumber);
    return isNumber ? value : otherwise;
}

class SoakTest : public WindowTest {
  protected:
    SoakTest() : WindowTest(true) {}
    void SetUp() override {
        WindowTest::SetUp();
        window->resize(900, 620);
        drawQuickly();
        document().open(smallHead(), {}, "small");
        random_.seed(static_cast<unsigned>(numberFrom("HAIRLOOM_SOAK_SEED", 1)));
        // Whoever asks is told no.
        QObject::connect(&closer_, &QTimer::timeout, [] {
            if (QWidget* asks = QApplication::activePopupWidget()) asks->close();
            if (auto* asks = qobject_cast<QDialog*>(QApplication::activeModalWidget())) asks->reject();
        });
        closer_.start(30);
        // Files are another's business, and the window stays.
        for (const ActionInfo& info : window->actions().all()) {
            if (!info.id.startsWith("file.")) actions_.push_back(&window->actions().get(info.id));
        }
    }
    int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    QPoint somewhere() { return {below(viewport().width()), below(viewport().height())}; }
    Qt::KeyboardModifiers modifiers() {
        constexpr Qt::KeyboardModifier kOnes[] = {Qt::NoModifier, Qt::NoModifier, Qt::ShiftModifier,
                                                  Qt::ControlModifier, Qt::AltModifier};
        return kOnes[below(5)];
    }
    template <class Widget>
    Widget* anyVisible() {
        QList<Widget*> all;
        for (Widget* widget : window->findChildren<Widget*>()) {
            if (widget->isVisible() && widget->isEnabled()) all.append(widget);
        }
        return all.isEmpty() ? nullptr : all[below(static_cast<int>(all.size()))];
    }

    void act() {
        switch (below(12)) {
            case 0:
            case 1:
            case 2: {
                constexpr Qt::MouseButton kButtons[] = {Qt::LeftButton, Qt::LeftButton, Qt::RightButton,
                                                        Qt::MiddleButton};
                const QPoint from = somewhere();
                drag({from, from + QPoint(below(60) - 30, below(60) - 30), somewhere()}, modifiers(),
                     kButtons[below(4)]);
                break;
            }
            case 3: {
                const QPoint at = somewhere();
                QWheelEvent wheel(at, viewport().mapToGlobal(at), {}, {0, 120 * (below(3) - 1)}, Qt::NoButton,
                                  modifiers(), Qt::NoScrollPhase, false);
                QApplication::sendEvent(&viewport(), &wheel);
                break;
            }
            case 4:
            case 5:
                key(static_cast<Qt::Key>(Qt::Key_A + below(26)), modifiers());
                break;
            case 6:
            case 7: {
                QAction* action =
                    actions_[static_cast<std::size_t>(below(static_cast<int>(actions_.size())))];
                if (action->isEnabled()) action->trigger();
                break;
            }
            case 8:
                if (auto* box = anyVisible<QComboBox>(); box && box->count() > 0) {
                    box->setCurrentIndex(below(box->count()));
                    Q_EMIT box->activated(box->currentIndex());
                }
                break;
            case 9:
                if (auto* number = anyVisible<NumberBox>()) {
                    number->setFocus();
                    QTest::keyClick(number, below(2) == 0 ? Qt::Key_Up : Qt::Key_Down);
                }
                break;
            case 10:
                trigger(below(3) == 0 ? "play.reset" : "play.toggle");
                break;
            default:
                if (below(4) == 0) parts().preferences.setSimulateOn(static_cast<SimulateOn>(below(3)));
                trigger(below(3) == 0 ? "edit.redo" : "edit.undo");
        }
        QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
    }

    /// As at first, so that what is compared is not another document.
    void startOver() {
        parts().player.reset();
        parts().tasks.cancel();
        finishWork();
        viewport().setComparison({});
        viewport().setTurntable(false);
        drawQuickly();
        document().open(smallHead(), {}, "small");
        viewport().frameAll();
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
    }

    std::mt19937 random_;
    std::vector<QAction*> actions_;
    QTimer closer_;
};

TEST_F(SoakTest, RandomActionsLeaveTheWindowSound) {
    const int actions = numberFrom("HAIRLOOM_SOAK_ACTIONS", 120);
    constexpr int kRound = 500;
    double early = 0, megabytes = 0;
    for (int done = 0; done < actions;) {
        for (int i = 0; i < std::min(kRound, actions) && done < actions; ++i, ++done) act();
        ASSERT_TRUE(window->isVisible());
        EXPECT_FALSE(hasErrors(validate(groom()))) << "after " << done << " actions";
        startOver();
        megabytes = residentMegabytes();
        if (early == 0 && done >= actions / 4) early = megabytes;
        if (actions > kRound) std::printf("%d actions, %.0f MB\n", done, megabytes), std::fflush(stdout);
    }
    // Shaders of what was not seen before are compiled once.
    EXPECT_LT(megabytes, early + 200);
}

/// A key that two things answer to does neither.
TEST_F(SoakTest, NoKeyIsTakenTwice) {
    std::map<QString, QString> taken;
    for (const QAction* menu : window->menuBar()->actions()) {
        const QKeySequence mnemonic = QKeySequence::mnemonic(menu->text());
        if (!mnemonic.isEmpty()) taken[mnemonic.toString()] = menu->text();
    }
    for (const QAction* action : window->findChildren<QAction*>()) {
        for (const QKeySequence& shortcut : action->shortcuts()) {
            const auto [found, isNew] = taken.insert({shortcut.toString(), action->text()});
            EXPECT_TRUE(isNew || found->second == action->text())
                << shortcut.toString().toStdString() << ": " << found->second.toStdString() << " and "
                << action->text().toStdString();
        }
    }
}

}  // namespace
}  // namespace hairloom::editor
