// SPDX-License-Identifier: GPL-3.0-or-later
// The manual in the program.

#include <gtest/gtest.h>

#include <QDir>
#include <QFile>
#include <QPushButton>
#include <QRegularExpression>
#include <QScrollBar>
#include <QTextBlock>

#include "editor/dialogs/manual_window.h"
#include "editor/fields/number_box.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class HelpTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        window->activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
    }
    ManualWindow* manual() { return window->findChild<ManualWindow*>(); }
    /// The heading at the top of the page that is shown.
    QString topHeading() {
        QTextBlock block = manual()->text().cursorForPosition(QPoint(20, 20)).block();
        while (block.isValid() && block.blockFormat().headingLevel() == 0) block = block.previous();
        return block.text();
    }
};

QStringList pages() {
    QStringList found;
    for (const QString& folder : {QString(), QString("formats/")})
        for (const QString& name : QDir(":/docs/" + folder).entryList({"*.md"})) found.append(folder + name);
    return found;
}

TEST_F(HelpTest, F1OpensTheManualWithoutADocument) {
    QTest::keyClick(window.get(), Qt::Key_F1);
    ASSERT_TRUE(manual());
    EXPECT_TRUE(manual()->isVisible());
    EXPECT_TRUE(manual()->text().toPlainText().contains("takes you from a bare head"));
    EXPECT_GT(manual()->findChild<QListWidget*>("manualContents")->count(), 10);
    QTest::keyClick(manual(), Qt::Key_Escape);
    EXPECT_FALSE(manual()->isVisible());
}

TEST_F(HelpTest, F1InAPanelOpensItsSection) {
    openSampleHair("short");
    window->panel("physics")->raise();
    auto& spin = find<NumberBox>("windSpeed")->spinBox();
    spin.setFocus();
    QTest::keyClick(&spin, Qt::Key_F1);
    ASSERT_TRUE(manual());
    EXPECT_EQ(topHeading(), "6. Simulate");
    manual()->close();
    window->activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
    trigger("tool.comb");
    window->setFocus();
    trigger("help.manual");
    EXPECT_EQ(topHeading(), "4. Groom");
}

TEST_F(HelpTest, EveryPanelHasASectionThatIsThere) {
    trigger("help.manual");
    for (const PanelInfo& info : panels()) {
        if (info.id == "history") continue;  // explained where undo is
        const QString section = manualSection(info.id);
        ASSERT_FALSE(section.isEmpty()) << info.id.toStdString();
        manual()->open("manual.md", section);
        EXPECT_EQ(headingName(manual()->text().textCursor().block().text()), section);
    }
}

TEST_F(HelpTest, LinksContentsAndSearchGoWhereTheySay) {
    trigger("help.manual");
    auto* text = manual()->findChild<QTextBrowser*>("manualText");
    Q_EMIT text->anchorClicked(QUrl("formats/script.md#formulas"));
    EXPECT_EQ(text->source(), QUrl("qrc:/docs/formats/script.md"));
    EXPECT_EQ(headingName(topHeading()), "formulas");
    // From there a link back out of its folder.
    Q_EMIT text->anchorClicked(QUrl("../manual.md#7-look"));
    EXPECT_EQ(topHeading(), "7. Look");
    Q_EMIT text->anchorClicked(QUrl("no-such-page.md"));
    EXPECT_EQ(topHeading(), "7. Look") << "stays";
    auto* contents = manual()->findChild<QListWidget*>("manualContents");
    const auto found = contents->findItems("2. Select the scalp", Qt::MatchContains);
    ASSERT_EQ(found.size(), 1);
    contents->setCurrentItem(found[0]);
    EXPECT_EQ(topHeading(), "2. Select the scalp");
    auto* search = manual()->findChild<QLineEdit*>("manualSearch");
    QTest::keyClicks(search, "Clump");
    QTest::keyClick(search, Qt::Key_Return);
    EXPECT_EQ(text->textCursor().selectedText().toLower(), "clump");
}

/// All links between pages, not only the manual's: what is installed is complete.
TEST_F(HelpTest, EveryPageIsInTheProgramAndSoAreThePicturesOfTheManual) {
    const QStringList names = pages();
    EXPECT_GT(names.size(), 20);
    const QRegularExpression link("\\]\\(([^)#]*)(#[^)]*)?\\)");
    for (const QString& name : names) {
        QFile file(":/docs/" + name);
        ASSERT_TRUE(file.open(QIODevice::ReadOnly));
        const QString content = QString::fromUtf8(file.readAll());
        for (auto links = link.globalMatch(content); links.hasNext();) {
            const QString to = links.next().captured(1);
            const bool isPage = to.endsWith(".md") && !to.contains("://");
            const bool isPicture = name == "manual.md" && to.startsWith("pictures/");
            const QString target = QUrl("qrc:/docs/" + name).resolved(QUrl(to)).path();
            if (isPicture || (isPage && target.startsWith("/docs/"))) {
                EXPECT_TRUE(QFile::exists(":" + target)) << name.toStdString() << ": " << to.toStdString();
            }
        }
    }
}

TEST_F(HelpTest, SamplesStandInAnOrderThatTeachesWithTheirPictures) {
    QPoint last(-1, -1);
    QByteArray lastIcon;
    for (const char* name : {"short", "shoulder", "long", "bob", "afro", "braid"}) {
        auto* button = find<QPushButton>((std::string("sample:") + name).c_str());
        const QPoint at = button->mapTo(window.get(), QPoint());
        EXPECT_TRUE(at.y() > last.y() || (at.y() == last.y() && at.x() > last.x())) << name;
        last = at;
        EXPECT_GE(button->iconSize().height(), 64) << name;
        const QImage picture = button->icon().pixmap(button->iconSize()).toImage();
        const QByteArray bytes(reinterpret_cast<const char*>(picture.constBits()), picture.sizeInBytes());
        EXPECT_NE(bytes, lastIcon) << name;
        lastIcon = bytes;
        EXPECT_TRUE(button->toolTip().contains("Creates the hairstyle")) << name;
        EXPECT_GT(button->toolTip().size(), 70) << name;
    }
}

}  // namespace
}  // namespace hairloom::editor
