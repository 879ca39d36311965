// SPDX-License-Identifier: GPL-3.0-or-later
// Three hairstyles from the bare bust to an exported file, as docs/manual.md counts them: with the mouse and
// the keys, in at most sixty actions each.
#include <QCheckBox>
#include <QElapsedTimer>
#include <QTreeWidget>

#include "core/base/file.h"
#include "core/documents/hair_import.h"
#include "core/geometry/curve.h"
#include "core/operations/full_head.h"
#include "core/operations/stack.h"
#include "importers/strands.h"
#include "tests/editor/mouse_fixture.h"

namespace hairloom::editor {
namespace {

constexpr int kMostActions = 60;

/// With pictures where docs/pictures/make_editor_pictures.sh runs it.
class StyleWalkTest : public MouseTest {
  protected:
    StyleWalkTest() : MouseTest(isForManual()) {}
    static bool isForManual() { return !qEnvironmentVariableIsEmpty("HAIRLOOM_MANUAL"); }

    void SetUp() override {
        MouseTest::SetUp();
        window->resize(1440, 900);
        clicks = keys = 0;
        clock_.start();
    }
    NumberBox& ofOperator(const char* field) {
        auto* box = window->panel("operators")->findChild<NumberBox*>(field);
        EXPECT_TRUE(box) << field;
        return *box;
    }
    /// One of the three numbers of a point or a direction of the chosen operator.
    QDoubleSpinBox& ofOperator(const char* field, int component) {
        auto* box = window->panel("operators")->findChild<QWidget*>(field);
        EXPECT_TRUE(box) << field;
        return *box->findChildren<QDoubleSpinBox*>()[component];
    }
    void unfold(const char* panel, const char* part) {
        for (auto* fold : window->panel(panel)->findChildren<QToolButton*>()) {
            if (fold->isVisible() && fold->text() == part) return click(*fold);
        }
        ADD_FAILURE() << "nothing to unfold: " << part;
    }
    /// Metres, of the strands.
    float longest() {
        float most = 0;
        for (std::size_t s = 0; s < groom().strandCount(); ++s)
            most = std::max(most, polylineLength(groom().strand(s)));
        return most;
    }
    float lowest() {
        float least = std::numeric_limits<float>::max();
        for (const Vec3f& point : groom().positions()) least = std::min(least, point.y());
        return least;
    }
    void openBareHead() {
        click("sample:");
        finishWork();
        ASSERT_TRUE(groom().scalp);
        top = Vec3f(0, groom().scalp->bounds().max().y(), 0);
        open("scalp");
        auto& groups = *find<QComboBox>("scalpGroup");
        pick(groups, groups.findData("material:scalp"));
        ASSERT_FALSE(groom().scalpSelection.empty());
    }
    void place(const QString& count, const QString& centimetres) {
        type("count", count);
        type("length", centimetres);
        click("place");
        finishWork();
        ASSERT_GT(groom().strandCount(), 0u) << window->statusLine().message().toStdString();
        EXPECT_EQ(groom().interpolation.followPerGuide, followHairsToFill(groom(), groom().strandCount()))
            << "new hair covers the scalp by itself";
    }
    /// Out to the program of that name: the file can be read and has all guides.
    void finish(const QString& style, const QString& program) {
        expectSound();
        ++keys;  // Ctrl+E
        onceAsked<ExportDialog>([&](ExportDialog& dialog) {
            auto& targets = *dialog.findChild<QComboBox*>("target");
            const int entry = targets.findText(program);
            EXPECT_GE(entry, 0) << program.toStdString();
            targets.setCurrentIndex(entry);
            Q_EMIT targets.activated(entry);
            clicks += 2;
            exportAllOf(dialog);
        });
        trigger("file.export");
        EXPECT_FALSE(QDir(folder.path()).entryList({"*.abc", "*.usd*", "*.hairrt"}).isEmpty());
        EXPECT_LE(clicks + keys, kMostActions) << style.toStdString();
        RecordProperty("clicks", clicks);
        RecordProperty("keys", keys);
        RecordProperty("milliseconds", static_cast<int>(clock_.elapsed()));
        std::printf("%s: %d clicks, %d keys, %.1f s\n", style.toUtf8().constData(), clicks, keys,
                    1e-3 * static_cast<double>(clock_.elapsed()));
        replay(style);
        if (!isForManual()) return;
        viewport().look(render::View::ThreeQuarter);
        viewport().frameAll();
        viewport().redraw();
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        keepForManual(viewport().picture(), "style-" + style);
    }

  private:
    /// The steps as a script make the same hair of the same head.
    void replay(const QString& style) {
        const std::string file = inFolder((style + ".json").toUtf8().constData()).toStdString();
        ASSERT_TRUE(window->saveScriptTo(QString::fromStdString(file)));
        const auto text = readTextFile(file);
        ASSERT_TRUE(text) << text.error().message();
        if (isForManual())
            QFile::copy(QString::fromStdString(file),
                        qEnvironmentVariable("HAIRLOOM_MANUAL") + "/walk-" + style + ".json");
        const auto script = parseDocumentScript(file, *text);
        ASSERT_TRUE(script) << script.error().message();
        const auto made = hash();
        files().openSample({});
        finishWork();
        Groom again = groom();
        const auto report = runScript(*script, again);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(contentHash(again), made);
        document().open(std::move(again), {}, style);
    }

    QElapsedTimer clock_;
};

TEST_F(StyleWalkTest, ABobWithAFringe) {
    openBareHead();
    place("600", "32");
    open("operators");
    addOperator("Flow");
    // Cut at the jaw.
    addOperator("Trim");
    viewport().look(render::View::Left);
    viewport().frameAll();
    ++keys;  // 3
    click(*window->panel("operators")->findChild<QPushButton*>("planePointPick"));
    ++clicks;
    const QPoint jaw = at(onHead(0.06f, 0.2f, 0.03f));
    press(jaw), release(jaw);
    EXPECT_NE(groom().operators[1].settings, "{}") << "the point lies on the head";
    const float below = top.y() - 0.22f;
    EXPECT_LT(lowest(), below);
    type(ofOperator("planeNormal", 1), "-1");
    EXPECT_GT(lowest(), below) << "cut";
    // And over the eyes.
    shortcut("view.front");
    ASSERT_TRUE(viewport().waitForPicture(kPatience));  // one draws over what one sees
    tool("cut_line");
    stroke(
        {at(onHead(-0.055f, 0.095f, 0.09f)), at(onHead(0, 0.09f, 0.1f)), at(onHead(0.055f, 0.095f, 0.09f))});
    EXPECT_EQ(groom().operators.back().op, "sculpt");
    open("operators");
    chooseOperator(1);
    addOperator("Clump");
    addOperator("Bend");
    ASSERT_EQ(groom().operators.size(), 5u);
    finish("bob", "Blender");
}

TEST_F(StyleWalkTest, LongWavesWithAPartingAndABraid) {
    openBareHead();
    place("600", "45");
    open("operators");
    addOperator("Flow");
    addOperator("Part");
    shortcut("view.front");
    drawCurve({onHead(0.01f, 0.03f, 0.07f), onHead(0.01f, 0.015f, 0.05f), onHead(0.01f, 0.005f, 0.02f)});
    addOperator("Wave");
    shortcut("view.back");
    tool("select");
    stroke({at(onHead(-0.03f, 0.06f, -0.1f)), at(onHead(0.03f, 0.06f, -0.1f)),
            at(onHead(0.03f, 0.12f, -0.1f)), at(onHead(-0.03f, 0.12f, -0.1f))});
    ASSERT_NO_FATAL_FAILURE(addLayerOfSelection());
    shortcut("select.none");
    open("operators");
    chooseOperator(2);
    addOperator("Braid");
    drawCurve({onHead(0, 0.12f, -0.1f), onHead(0, 0.2f, -0.1f), onHead(0, 0.32f, -0.1f)});
    unfold("operators", "Region");
    type(ofOperator("layer"), "2");
    ASSERT_EQ(groom().operators.size(), 4u);
    EXPECT_GE(curveOf(groom().operators[1]).points.size(), 2u);
    EXPECT_GE(curveOf(groom().operators[3]).points.size(), 2u);
    finish("waves", "Unreal groom");
}

TEST_F(StyleWalkTest, AShortFadeWithABeard) {
    openBareHead();
    // The beard grows where the jaw is painted.
    shortcut("view.front");
    const std::size_t faces = groom().scalpSelection.size();
    tool("scalp_paint");
    stroke({at(onHead(-0.05f, 0.17f, 0.05f)), at(onHead(-0.025f, 0.2f, 0.08f)), at(onHead(0, 0.205f, 0.09f)),
            at(onHead(0.025f, 0.2f, 0.08f)), at(onHead(0.05f, 0.17f, 0.05f))});
    EXPECT_GT(groom().scalpSelection.size(), faces);
    open("scalp");
    place("900", "5");
    tool("select");
    stroke({at(onHead(-0.09f, 0.13f, 0.05f)), at(onHead(-0.09f, 0.28f, 0.05f)),
            at(onHead(0.09f, 0.28f, 0.05f)), at(onHead(0.09f, 0.13f, 0.05f))});
    ASSERT_NO_FATAL_FAILURE(addLayerOfSelection());
    shortcut("select.none");
    open("operators");
    addOperator("Set length");
    type(ofOperator("length"), "5");
    type(ofOperator("gradientDistance"), "16");
    type(ofOperator("farScale"), "0.1");
    addOperator("Flow");
    EXPECT_LT(longest(), 0.052f);
    finish("fade", "Game by Hairloom's runtime");
}

}  // namespace
}  // namespace hairloom::editor
