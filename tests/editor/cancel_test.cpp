// SPDX-License-Identifier: GPL-3.0-or-later
// A file that takes long to read, and a user who does not wait for it.
#include <QDialogButtonBox>
#include <QDir>
#include <QFile>
#include <QPushButton>
#include <QToolButton>

#include "core/base/write_rules.h"
#include "editor/dialogs/head_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

/// Within so many milliseconds nothing of a cancelled read is left, on a machine that does other work, too.
constexpr int kPrompt_ms = 2000;

/// Processes that read the file: it stands in their words.
std::size_t readersOf(const QString& path) {
    std::size_t count = 0;
    for (const QString& process : QDir("/proc").entryList(QDir::Dirs | QDir::NoDotAndDotDot)) {
        QFile words("/proc/" + process + "/cmdline");
        if (!words.open(QIODevice::ReadOnly)) continue;
        const QByteArray all = words.readAll();
        count += all.contains("hairloom-mesh-reader") && all.contains(path.toUtf8()) ? 1 : 0;
    }
    return count;
}

class CancelTest : public WindowTest {
  protected:
    /// A flat sheet of many faces, which may be a head or hair of Cinema 4D as far as its beginning tells.
    QString largeObj(const char* name) {
        constexpr int kSide = 1400;
        QByteArray text = "o sheet\n";
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x)
                text += "v " + QByteArray::number(0.0001 * x, 'f', 4) + " 0.1 " +
                        QByteArray::number(0.0001 * y, 'f', 4) + "\n";
        }
        const auto vertex = [](int x, int y) { return QByteArray::number(1 + y * kSide + x) + " "; };
        for (int y = 0; y + 1 < kSide; ++y) {
            for (int x = 0; x + 1 < kSide; ++x)
                text +=
                    "f " + vertex(x, y) + vertex(x, y + 1) + vertex(x + 1, y + 1) + vertex(x + 1, y) + "\n";
        }
        const QString path = inFolder(name);
        QFile file(path);
        EXPECT_TRUE(file.open(QIODevice::WriteOnly) && file.write(text) == text.size());
        return path;
    }
    static void expectReadingBegins(const QString& path) {
        ASSERT_TRUE(QTest::qWaitFor([&] { return readersOf(path) > 0; }, kPatience)) << "nothing is read";
    }
    void expectReadingEnds(const QString& path) {
        QElapsedTimer waited;
        waited.start();
        EXPECT_TRUE(
            QTest::qWaitFor([&] { return readersOf(path) == 0 && !parts().tasks.isBusy(); }, kPrompt_ms))
            << readersOf(path) << " readers after " << waited.elapsed() << " ms";
    }
    QString said() { return window->statusLine().message(); }
    void expectASecondReadWorks() {
        openBust();
        EXPECT_GT(groom().scalp->triangleCount(), 0u);
    }
};

TEST_F(CancelTest, OpeningEndsAtOnceAndLeavesTheDocument) {
    openSampleHair("short");
    const auto before = hash();
    const QString path = largeObj("large.obj");
    for (int i = 0; i < 2; ++i) {
        window->open(path);
        expectReadingBegins(path);
        auto* cancel = find<QToolButton>("cancelTask");
        ASSERT_TRUE(cancel->isVisible());
        cancel->click();
        expectReadingEnds(path);
        EXPECT_EQ(said(), "Reading large.obj was cancelled");
        EXPECT_FALSE(cancel->isVisible());
        EXPECT_EQ(hash(), before);
        EXPECT_EQ(window->findChild<QDialog*>(), nullptr) << "a dialog asks about it";
    }
    trigger("file.new");
    window->open(path);
    expectReadingBegins(path);
    find<QToolButton>("cancelTask")->click();
    expectReadingEnds(path);
    EXPECT_EQ(said(), "Opening large.obj was cancelled");
    EXPECT_TRUE(document().isEmpty());
    expectASecondReadWorks();
}

TEST_F(CancelTest, TheDialogOfHeadsEndsReading) {
    const QString path = largeObj("head.obj");
    window->showHeadDialog(path);
    auto* dialog = window->findChild<HeadDialog*>();
    ASSERT_TRUE(dialog);
    expectReadingBegins(path);
    EXPECT_FALSE(dialog->findChild<QPushButton*>("headOpen")->isEnabled()) << "nothing is seen of it yet";
    QTest::keyClick(dialog, Qt::Key_Escape);
    expectReadingEnds(path);
    EXPECT_EQ(said(), "Reading head.obj was cancelled");
    EXPECT_TRUE(document().isEmpty());
    expectASecondReadWorks();
}

TEST_F(CancelTest, TheDialogOfHairEndsReading) {
    openBust();
    const auto before = hash();
    const QString path = largeObj("hair.obj");
    onceAsked<ImportDialog>([&](ImportDialog& dialog) {
        expectReadingBegins(path);
        dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel)->click();
    });
    onceAskedForAFile(path);
    trigger("file.import");
    expectReadingEnds(path);
    EXPECT_EQ(said(), "Reading hair.obj was cancelled");
    EXPECT_EQ(hash(), before);
    expectASecondReadWorks();
}

TEST_F(CancelTest, TheDialogOfHeadsWaitsForOtherWork) {
    files().openSample("short");
    window->showHeadDialog(QString::fromStdString((samplesFolder() / "bust/bust.glb").string()));
    auto* dialog = window->findChild<HeadDialog*>();
    ASSERT_TRUE(dialog);
    auto* open = dialog->findChild<QPushButton*>("headOpen");
    EXPECT_TRUE(QTest::qWaitFor([&] { return open->isEnabled(); }, kPatience))
        << dialog->findChild<QLabel*>("headSize")->text().toStdString();
    dialog->reject();
}

TEST_F(CancelTest, AProjectThatOthersHaveChangedStaysChangedUntilItIsShown) {
    openSampleHair("short");
    const QString path = inFolder("mine.hairloom");
    ASSERT_TRUE(window->saveTo(path));
    QFile file(path);
    ASSERT_TRUE(file.open(QIODevice::Append));
    file.write("x");
    file.close();
    ASSERT_TRUE(isChangedByOthers(path.toStdString()));
    files().reload();
    finishWork();
    EXPECT_TRUE(isChangedByOthers(path.toStdString())) << "it could not be read: " << said().toStdString();
}

}  // namespace
}  // namespace hairloom::editor
