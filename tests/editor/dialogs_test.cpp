// SPDX-License-Identifier: GPL-3.0-or-later
// All dialogs: by keyboard, for screen readers, on a small screen, and given up.
#include <QAccessible>
#include <QCheckBox>
#include <QDir>
#include <QPointer>
#include <QPushButton>
#include <QToolButton>
#include <map>
#include <set>

#include "tests/editor/controls_fixture.h"
#include "tests/editor/nothing_clipped.h"

namespace hairloom::editor {
namespace {

class DialogsTest : public ControlsTest {
  protected:
    void SetUp() override {
        ControlsTest::SetUp();
        openSampleHair("short");
        openFirstStrands(60);
    }
    static bool canHaveFocus(const QWidget& control) {
        return control.isEnabled() && (control.focusPolicy() & Qt::TabFocus) != 0;
    }
    /// The window system says that it is active in its own time, and sometimes takes it back at first.
    static void activate(QDialog& dialog) {
        ASSERT_TRUE(QTest::qWaitFor(
            [&] {
                const QWidget* focus = QApplication::focusWidget();
                const bool isActive = focus && focus->window() == &dialog;
                if (!isActive) dialog.activateWindow();
                return isActive;
            },
            kPatience));
        ASSERT_TRUE(QApplication::focusWidget());
    }
    /// Each of them is given another value, and each button pressed that does no more than that.
    static void changeAllIn(QDialog& dialog) {
        std::vector<QPointer<QWidget>> controls;
        for (QWidget* control : controlsOf(dialog)) controls.emplace_back(control);
        for (auto* list : dialog.findChildren<QTreeWidget*>()) list->selectAll();
        for (const QPointer<QWidget>& control : controls) {
            if (!control || !control->isVisible() || !control->isEnabled()) continue;
            if (auto* box = qobject_cast<QComboBox*>(control)) {
                if (box->count() == 0) continue;
                box->setCurrentIndex((box->currentIndex() + 1) % box->count());
                Q_EMIT box->activated(box->currentIndex());
            } else if (auto* spin = qobject_cast<QAbstractSpinBox*>(control)) {
                spin->stepUp();
            } else if (auto* edit = qobject_cast<QLineEdit*>(control)) {
                edit->setText(edit->text() + "x");
            } else if (auto* button = qobject_cast<QAbstractButton*>(control)) {
                const bool leaves = qobject_cast<QDialogButtonBox*>(button->parentWidget()) ||
                                    button->objectName() == "cluster";
                if (!leaves) button->click();
            }
        }
    }
};

TEST_F(DialogsTest, EveryControlHasANameAndFitsASmallScreen) {
    std::size_t named = 0;
    inEachDialog([&](QDialog& dialog, const QString& name) {
        for (QWidget* control : controlsOf(dialog)) {
            const std::string what = nameOf(name, *control);
            EXPECT_TRUE((control->focusPolicy() & Qt::TabFocus) != 0 || isReachedByArrows(*control)) << what;
            QAccessibleInterface* spoken = QAccessible::queryAccessibleInterface(control);
            ASSERT_TRUE(spoken) << what;
            EXPECT_FALSE(spoken->text(QAccessible::Name).isEmpty()) << what;
            ++named;
        }
        for (auto* bar : dialog.findChildren<QProgressBar*>())
            EXPECT_FALSE(bar->accessibleName().isEmpty()) << nameOf(name, *bar);
        expectNothingClipped(dialog, name);
        EXPECT_LE(dialog.width(), 1280) << name.toStdString();
        EXPECT_LE(dialog.height(), 800) << name.toStdString();
    });
    EXPECT_GT(named, 100u);
}

TEST_F(DialogsTest, TabReachesEveryControlWhereItIsSeen) {
    inEachDialog([&](QDialog& dialog, const QString& name) {
        activate(dialog);
        std::set<QWidget*> missing;
        for (QWidget* control : controlsOf(dialog)) {
            if (canHaveFocus(*control) && !isReachedByArrows(*control)) missing.insert(control);
        }
        constexpr int kMost = 2000;  // a page of the manual has many links
        for (int i = 0; i < kMost && !missing.empty(); ++i) {
            QWidget* const at = QApplication::focusWidget();
            ASSERT_TRUE(at) << name.toStdString() << " loses the focus";
            missing.erase(at);
            ASSERT_FALSE(at->visibleRegion().isEmpty()) << nameOf(name, *at) << " is not in sight";
            const auto* button = qobject_cast<QAbstractButton*>(at);
            if (button && button->group() && button->group()->exclusive() && button->isChecked()) {
                QTest::keyClick(at, Qt::Key_Right);
                EXPECT_NE(QApplication::focusWidget(), at) << nameOf(name, *at) << ": arrows";
            }
            QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
        }
        for (const QWidget* control : missing) ADD_FAILURE() << nameOf(name, *control) << " is not reached";
    });
}

TEST_F(DialogsTest, FocusIsSeenOnEveryControl) {
    std::size_t seen = 0;
    inEachDialog([&](QDialog& dialog, const QString& name) {
        activate(dialog);
        for (QWidget* control : controlsOf(dialog)) {
            if (!canHaveFocus(*control)) continue;
            control->setFocus(Qt::TabFocusReason);
            if (!control->hasFocus()) continue;
            const QImage with = control->grab().toImage();
            control->clearFocus();
            EXPECT_NE(control->grab().toImage(), with)
                << nameOf(name, *control) << " looks the same with the focus";
            ++seen;
        }
    });
    EXPECT_GT(seen, 100u);
}

TEST_F(DialogsTest, ReturnAndSpacePressTheButtonThatHasTheFocus) {
    std::size_t pressed = 0, searched = 0;
    inEachDialog([&](QDialog& dialog, const QString& name) {
        activate(dialog);
        std::map<QAbstractButton*, int> clicks;
        for (auto* button : dialog.findChildren<QAbstractButton*>()) {
            // What they do is another test's.
            QObject::disconnect(button, &QAbstractButton::clicked, nullptr, nullptr);
            QObject::connect(button, &QAbstractButton::clicked, &dialog,
                             [&clicks, button] { ++clicks[button]; });
        }
        for (QWidget* control : controlsOf(dialog)) {
            auto* button = qobject_cast<QAbstractButton*>(control);
            if (!button || !canHaveFocus(*button) || qobject_cast<QCheckBox*>(button)) continue;
            for (const Qt::Key key : {Qt::Key_Return, Qt::Key_Enter, Qt::Key_Space}) {
                button->setFocus();
                clicks.clear();
                QTest::keyClick(button, key);
                EXPECT_EQ(clicks.size(), 1u) << nameOf(name, *button) << ", key " << key;
                EXPECT_EQ(clicks[button], 1) << nameOf(name, *button) << ", key " << key;
            }
            ++pressed;
        }
        // Words that are looked for end no dialog.
        for (auto* edit : dialog.findChildren<QLineEdit*>()) {
            if (!edit->placeholderText().startsWith("Search") && !edit->placeholderText().startsWith("Find"))
                continue;
            edit->setFocus();
            clicks.clear();
            QTest::keyClick(edit, Qt::Key_Return);
            EXPECT_TRUE(clicks.empty()) << nameOf(name, *edit);
            EXPECT_TRUE(dialog.isVisible()) << nameOf(name, *edit);
            ++searched;
        }
    });
    EXPECT_GT(pressed, 20u);
    EXPECT_GE(searched, 3u) << "of shortcuts, groups of a head, the manual";
}

TEST_F(DialogsTest, EscapeLeavesEverythingAsItWas) {
    QDir files(folder.path());
    inEachDialog([&](QDialog& dialog, const QString& name) {
        const auto before = hash();
        const int steps = document().stepCount();
        const QString title = document().title();
        const QStringList recent = parts().preferences.recentFiles();
        files.refresh();
        const QStringList there = files.entryList(QDir::Files);
        activate(dialog);
        changeAllIn(dialog);
        finishWork();
        changeAllIn(dialog);
        // Not from a field of keys, which takes Escape as one.
        for (auto* button : dialog.findChildren<QPushButton*>())
            if (button->isVisible() && button->isEnabled()) button->setFocus();
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_Escape);
        EXPECT_FALSE(dialog.isVisible()) << name.toStdString();
        finishWork();
        EXPECT_EQ(hash(), before) << name.toStdString();
        EXPECT_EQ(document().stepCount(), steps) << name.toStdString();
        EXPECT_EQ(document().title(), title) << name.toStdString();
        EXPECT_EQ(parts().preferences.recentFiles(), recent) << name.toStdString();
        files.refresh();
        EXPECT_EQ(files.entryList(QDir::Files), there) << name.toStdString();
        EXPECT_FALSE(parts().tasks.isBusy()) << name.toStdString();
        EXPECT_FALSE(parts().player.isPlaying()) << name.toStdString();
    });
}

TEST_F(DialogsTest, APreviewIsTurnedByKeys) {
    std::size_t turned = 0;
    inEachDialog([&](QDialog& dialog, const QString& name) {
        activate(dialog);
        for (auto* preview : dialog.findChildren<StrandPreview*>()) {
            preview->setFocus();
            QImage last = preview->grab().toImage();
            for (const Qt::Key key : {Qt::Key_Left, Qt::Key_Up, Qt::Key_Plus}) {
                QTest::keyClick(preview, key);
                const QImage now = preview->grab().toImage();
                EXPECT_NE(now, last) << name.toStdString() << ", key " << key;
                last = now;
            }
            for (const Qt::Key key : {Qt::Key_Minus, Qt::Key_Down, Qt::Key_Right})
                QTest::keyClick(preview, key);
            ++turned;
        }
    });
    EXPECT_EQ(turned, 2u) << "of Import and Head";
}

TEST_F(DialogsTest, ReturnOnAnActionGoesToItsShortcut) {
    ShortcutDialog dialog(window->actions(), window.get());
    dialog.show();
    activate(dialog);
    auto* search = dialog.findChild<QLineEdit*>("searchShortcuts");
    ASSERT_TRUE(search);
    search->setFocus();
    QTest::keyClicks(search, "export");
    QTest::keyClick(search, Qt::Key_Return);
    auto* list = dialog.findChild<QTreeWidget*>();
    EXPECT_TRUE(list->hasFocus());
    ASSERT_TRUE(list->currentItem());
    EXPECT_FALSE(list->currentItem()->isHidden());
    QTest::keyClick(list, Qt::Key_Return);
    EXPECT_EQ(QApplication::focusWidget(), list->itemWidget(list->currentItem(), 1));
    EXPECT_TRUE(dialog.isVisible());
}

}  // namespace
}  // namespace hairloom::editor
