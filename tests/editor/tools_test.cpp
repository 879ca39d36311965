// SPDX-License-Identifier: GPL-3.0-or-later
// Brushes and tools of the scalp in a person's hand: each changes what it should, undo and redo restore every
// bit, Esc leaves nothing behind, and hair stays sound.
#include <QCheckBox>
#include <QLabel>
#include <QPointingDevice>
#include <QPushButton>
#include <QTabletEvent>
#include <algorithm>

#include "core/base/random.h"
#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "core/groom/point_dye.h"
#include "editor/fields/number_box.h"
#include "editor/tools/brush_tool.h"
#include "tests/editor/tools_fixture.h"

namespace hairloom::editor {
namespace {

class BrushToolTest : public ToolsTest, public testing::WithParamInterface<const char*> {};

TEST_P(BrushToolTest, AStrokeChangesHairAndIsOneStep) {
    auto& tool = dynamic_cast<BrushTool&>(activate(GetParam()));
    tool.setRadius(0.03f);
    tool.setStrength(1);
    strokeAndBack(GetParam());
}

TEST_P(BrushToolTest, EscapeCancelsTheStroke) {
    auto& tool = dynamic_cast<BrushTool&>(activate(GetParam()));
    tool.setRadius(0.03f);
    const auto before = hash();
    press(crown);
    moveTo(crown + QPoint(30, 5));
    moveTo(crown + QPoint(60, 5));
    key(Qt::Key_Escape);
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(document().stepCount(), 0);
    release(crown + QPoint(60, 5));
    EXPECT_EQ(hash(), before);
}

INSTANTIATE_TEST_SUITE_P(All, BrushToolTest,
                         testing::Values("comb", "brush", "grab", "smooth", "puff", "pinch", "length", "cut",
                                         "cut_line", "delete", "dye_paint", "mask_paint", "freeze",
                                         "straighten", "curl", "noise", "twist", "clump", "mirror", "level",
                                         "width_paint", "slide"),
                         [](const auto& brush) { return std::string(brush.param); });

TEST_F(ToolsTest, KeysChangeSizeAndStrength) {
    auto& tool = dynamic_cast<BrushTool&>(activate("comb"));
    const float radius = tool.settings().radius;
    key(Qt::Key_BracketRight);
    EXPECT_GT(tool.settings().radius, radius);
    key(Qt::Key_BracketLeft);
    EXPECT_FLOAT_EQ(tool.settings().radius, radius);
    const float strength = tool.settings().strength;
    key(Qt::Key_BracketRight, Qt::ShiftModifier);
    EXPECT_GT(tool.settings().strength, strength);
    moveTo(crown);
    key(Qt::Key_F);
    moveTo(crown + QPoint(40, 0));
    EXPECT_GT(tool.settings().radius, radius);
    press(crown + QPoint(40, 0));
    release(crown + QPoint(40, 0));
    EXPECT_EQ(document().stepCount(), 0) << "the click ends the resizing and combs nothing";
}

TEST_F(ToolsTest, ThePanelShowsSettingsThatComeFromElsewhere) {
    auto& tool = dynamic_cast<BrushTool&>(activate("comb"));
    const auto shown = [&](const char* name) {
        const auto boxes = window->findChildren<NumberBox*>(name);
        const auto box = std::ranges::find_if(boxes, [](const NumberBox* b) { return b->isVisible(); });
        EXPECT_NE(box, boxes.end()) << name;
        return box == boxes.end() ? 0.0 : (*box)->value();
    };
    const auto expectShown = [&] {
        EXPECT_FLOAT_EQ(static_cast<float>(shown("brushRadius")), tool.settings().radius);
        EXPECT_FLOAT_EQ(static_cast<float>(shown("brushStrength")), tool.settings().strength);
    };
    tool.setRadius(0.047f);
    tool.setStrength(0.37f);
    expectShown();
    key(Qt::Key_BracketRight);
    key(Qt::Key_BraceLeft);
    expectShown();
    moveTo(crown);
    key(Qt::Key_F);
    moveTo(crown + QPoint(-25, 0));
    expectShown();
    EXPECT_NE(tool.settings().radius, 0.047f);
}

TEST_F(ToolsTest, ControlInvertsAndShiftSmooths) {
    auto& tool = dynamic_cast<BrushTool&>(activate("length"));
    tool.setRadius(0.03f);
    tool.setStrength(1);
    const auto lengthOfAll = [this] {
        double sum = 0;
        for (std::size_t s = 0; s < groom().strandCount(); ++s) {
            const auto strand = groom().strand(s);
            for (std::size_t p = 1; p < strand.size(); ++p)
                sum += static_cast<double>((strand[p] - strand[p - 1]).norm());
        }
        return sum;
    };
    const double before = lengthOfAll();
    drag({crown, crown + QPoint(40, 5)});
    EXPECT_GT(lengthOfAll(), before * (1 + 1e-5));
    trigger("edit.undo");
    drag({crown, crown + QPoint(40, 5)}, Qt::ControlModifier);
    EXPECT_LT(lengthOfAll(), before * (1 - 1e-5));
    trigger("edit.undo");
    drag({crown, crown + QPoint(40, 5)}, Qt::ShiftModifier);
    EXPECT_NEAR(lengthOfAll(), before, before * 1e-4) << "smoothing keeps lengths";
    EXPECT_EQ(document().stepName(0), "Smooth");
}

TEST_F(ToolsTest, CombingKeepsRootsAndLengths) {
    auto& tool = dynamic_cast<BrushTool&>(activate("comb"));
    tool.setRadius(0.04f);
    const Groom before = groom();
    drag({crown, crown + QPoint(30, 8), crown + QPoint(60, 20)});
    std::size_t moved = 0;
    for (std::size_t s = 0; s < groom().strandCount(); ++s) {
        const auto a = before.strand(s), b = groom().strand(s);
        ASSERT_EQ(a.size(), b.size());
        EXPECT_EQ(a.front(), b.front());
        moved += a.back() != b.back() ? 1 : 0;
        for (std::size_t p = 1; p < a.size(); ++p) {
            const float rest = (a[p] - a[p - 1]).norm();
            ASSERT_NEAR((b[p] - b[p - 1]).norm(), rest, 1e-3f * rest + 1e-6f) << "strand " << s;
        }
    }
    EXPECT_GT(moved, 10u);
}

TEST_F(ToolsTest, BrushesShareTheirSizeOrKeepItInTheViewWhereAsked) {
    auto& comb = dynamic_cast<BrushTool&>(activate("comb"));
    const auto check = [&](const char* name, bool on) {
        const auto boxes = window->findChildren<QCheckBox*>(name);
        const auto box = std::ranges::find_if(boxes, [](const QCheckBox* b) { return b->isVisible(); });
        ASSERT_NE(box, boxes.end()) << name;
        if ((*box)->isChecked() != on) (*box)->click();
    };
    comb.setRadius(0.031f);
    auto& grab = dynamic_cast<BrushTool&>(activate("grab"));
    EXPECT_NE(grab.settings().radius, 0.031f) << "each has its own";
    activate("comb");
    check("brushSame", true);
    activate("grab");
    EXPECT_EQ(grab.settings().radius, 0.031f);
    grab.setStrength(0.77f);
    activate("comb");
    EXPECT_EQ(comb.settings().strength, 0.77f);

    check("brushInPixels", true);
    moveTo(crown);
    const float near = comb.settings().radius;
    const Box3f hair = groom().bounds();
    const auto pixelsOfTenCentimetres = [&] {
        const Vec3f top(0, hair.max().y() - 0.03f, hair.max().z());
        const QPoint across = at(top + 0.05f * Vec3f::UnitX()) - at(top - 0.05f * Vec3f::UnitX());
        return std::hypot(static_cast<float>(across.x()), static_cast<float>(across.y()));
    };
    const float before = pixelsOfTenCentimetres();
    viewport().camera().zoom(0.5f);
    moveTo(crown + QPoint(3, 0));
    const float farther = before / pixelsOfTenCentimetres();
    EXPECT_GT(farther, 1.7f);
    EXPECT_NEAR(comb.settings().radius, farther * near, 0.2f * near) << "the ring is as large as it was";
    check("brushInPixels", false);
    check("brushSame", false);
}

TEST_F(ToolsTest, BrushesReachAllHairBeforeTheHeadUnlessADepthIsAskedFor) {
    auto& tool = dynamic_cast<BrushTool&>(activate("puff"));
    const auto depthOfAStroke = [&](bool through) {
        const auto boxes = window->findChildren<QCheckBox*>("brushThroughHair");
        const auto box = std::ranges::find_if(boxes, [](const QCheckBox* b) { return b->isVisible(); });
        if ((*box)->isChecked() != through) (*box)->click();
        press(crown);
        const float depth = document().editing().stroke()->stroke().settings.depth;
        release(crown);
        trigger("edit.undo");
        return depth;
    };
    EXPECT_EQ(depthOfAStroke(false), tool.settings().depth);
    EXPECT_GE(depthOfAStroke(true), tool.settings().depth);
    EXPECT_LT(depthOfAStroke(true), 0.15f) << "not the hair behind the head";
}

TEST_F(ToolsTest, TheStatusLineCountsWhatIsSelected) {
    auto* counts = find<QLabel>("counts");
    EXPECT_FALSE(counts->text().contains("selected"));
    activate("select");
    drag({crown + QPoint(-30, -30), crown + QPoint(0, -30), crown + QPoint(0, 30), crown + QPoint(-30, 30)});
    const std::size_t selected = editing::strandsWithFlag(groom(), attribute::kSelected).size();
    ASSERT_GT(selected, 0u);
    EXPECT_TRUE(counts->text().startsWith(QStringLiteral("%L1 of ").arg(selected)))
        << counts->text().toStdString();
    trigger("edit.undo");
    EXPECT_FALSE(counts->text().contains("selected"));
}

TEST_F(ToolsTest, APartingIsBrushedOnTheHead) {
    auto& tool = dynamic_cast<BrushTool&>(activate("part"));
    tool.setRadius(0.03f);
    tool.setStrength(1);
    Vec3f front = groom().strand(0).front();
    for (std::size_t s = 1; s < groom().strandCount(); ++s) {
        const Vec3f& root = groom().strand(s).front();
        if (root.z() > front.z()) front = root;
    }
    crown = at(front);
    strokeAndBack("part");
}

TEST_F(ToolsTest, AddGrowsHairOnTheScalp) {
    auto& tool = dynamic_cast<BrushTool&>(activate("add"));
    tool.setRadius(0.02f);
    tool.setParameter("density", 40);
    // On the scalp: at the root nearest to the view.
    Vec3f front = groom().strand(0).front();
    for (std::size_t s = 1; s < groom().strandCount(); ++s) {
        const Vec3f& root = groom().strand(s).front();
        if (root.z() > front.z()) front = root;
    }
    crown = at(front);
    strokeAndBack("add");
}

TEST_F(ToolsTest, ScalpIsPaintedBoxedAndLassoed) {
    trigger("file.new");
    openBust();
    viewport().look(render::View::Front);
    viewport().frameAll();
    const Box3f box = groom().scalp->bounds();
    const QPoint top = at(Vec3f(0, box.max().y() - 0.03f, 0.08f));
    for (const char* id : {"scalp_paint", "scalp_box", "scalp_lasso"}) {
        if (auto* brush = dynamic_cast<BrushTool*>(&activate(id))) brush->setRadius(0.03f);
        const auto before = hash();
        drag({top, top + QPoint(60, 0), top + QPoint(60, 50), top + QPoint(10, 60)});
        EXPECT_FALSE(groom().scalpSelection.empty()) << id;
        const auto after = hash();
        trigger("edit.undo");
        EXPECT_EQ(hash(), before) << id;
        EXPECT_TRUE(groom().scalpSelection.empty()) << id;
        trigger("edit.redo");
        EXPECT_EQ(hash(), after) << id;
        trigger("edit.undo");
    }
}

TEST_F(ToolsTest, DensityIsPaintedAndCtrlBringsItBack) {
    auto& tool = dynamic_cast<BrushTool&>(activate("density_paint"));
    tool.setRadius(0.03f);
    tool.setStrength(1);
    // Where nothing is painted density is full, and the brush's value is 0.
    drag({crown, crown + QPoint(20, 4), crown + QPoint(40, 8)});
    ASSERT_EQ(groom().scalpDensity.size(), groom().scalp->vertexCount());
    const float thinned = *std::ranges::min_element(groom().scalpDensity);
    EXPECT_LT(thinned, 0.9f);
    const auto after = hash();
    trigger("edit.undo");
    EXPECT_NE(hash(), after);
    trigger("edit.redo");
    EXPECT_EQ(hash(), after);
    drag({crown, crown + QPoint(20, 4), crown + QPoint(40, 8)}, Qt::ControlModifier);
    EXPECT_GT(*std::ranges::min_element(groom().scalpDensity), thinned);
}

TEST_F(ToolsTest, DyeIsPaintedTakenOffAndSmoothed) {
    activate("dye_paint");
    const auto sum = [this] {
        double all = 0;
        for (const float value : groom().pointAttributes.view<float>(attribute::kPointDye))
            all += static_cast<double>(value);
        return all;
    };
    const Groom before = groom();
    drag({crown, crown + QPoint(20, 4), crown + QPoint(40, 8)});
    const double painted = sum();
    EXPECT_GT(painted, 5);
    EXPECT_EQ(groom().material.dyeStrength, 1) << "the material had no dye to show";
    EXPECT_TRUE(std::ranges::equal(groom().positions(), before.positions())) << "hair stays where it is";
    drag({crown, crown + QPoint(20, 4)}, Qt::ShiftModifier);
    EXPECT_EQ(document().stepName(1), "Paint dye") << "Shift smooths the mask and not the hair";
    EXPECT_TRUE(std::ranges::equal(groom().positions(), before.positions()));
    EXPECT_NE(sum(), painted);
    const double smoothed = sum();
    drag({crown, crown + QPoint(20, 4), crown + QPoint(40, 8)}, Qt::ControlModifier);
    EXPECT_LT(sum(), 0.8 * smoothed);
    // A project keeps it.
    const auto painting = hash();
    const QString file = inFolder("dyed.hairloom");
    ASSERT_TRUE(document().editing().save(file.toStdString()));
    const auto saved = editing::Document::open(file.toStdString());
    ASSERT_TRUE(saved);
    EXPECT_EQ(contentHash((*saved)->groom()), painting);
}

TEST_F(ToolsTest, ThePressureOfAPenIsThatOfTheDabs) {
    activate("comb");
    const QPointingDevice pen("pen", 1, QInputDevice::DeviceType::Stylus, QPointingDevice::PointerType::Pen,
                              QInputDevice::Capability::Pressure, 1, 1);
    QObject* const target = viewport().input();
    const auto touch = [&](QEvent::Type type, double pressure) {
        QTabletEvent event(type, &pen, crown, crown, pressure, 0, 0, 0, 0, 0, Qt::NoModifier, Qt::LeftButton,
                           Qt::LeftButton);
        QCoreApplication::sendEvent(target, &event);
    };
    parts().preferences.setTabletCurve(2);
    touch(QEvent::TabletPress, 0.5);
    press(crown);
    touch(QEvent::TabletMove, 0.8);
    moveTo(crown + QPoint(30, 6));
    const auto dabs = document().editing().stroke()->stroke().dabs;
    release(crown + QPoint(30, 6));
    touch(QEvent::TabletRelease, 0);
    ASSERT_GE(dabs.size(), 2u);
    EXPECT_NEAR(dabs.front().pressure, 0.25f, 1e-3f) << "after the curve of the preferences";
    EXPECT_NEAR(dabs.back().pressure, 0.64f, 1e-3f);
}

TEST_F(ToolsTest, RootsArePreviewedAndFollowTheSettings) {
    auto* preview = find<QPushButton>("placePreview");
    const auto noted = [&](const QString& words) {
        for (const QLabel* label : window->panel("scalp")->findChildren<QLabel*>()) {
            if (label->text().contains(words)) return true;
        }
        return false;
    };
    const auto before = hash();
    preview->click();
    finishWork();
    Groom fewer = groom();
    fewer.placement.count = 777;
    change("Count", fewer);
    finishWork();
    EXPECT_TRUE(noted("777 roots"));
    EXPECT_TRUE(find<QLabel>("placeCount")->text().startsWith("Places about 777 strands on "));
    Groom many = groom();
    many.interpolation.followPerGuide = 9;
    change("Follow hairs", many);
    EXPECT_TRUE(noted("With 9 interpolated hairs each: 7"))
        << find<QLabel>("placeCount")->text().toStdString();
    trigger("edit.undo");
    preview->click();
    EXPECT_FALSE(noted("777 roots"));
    trigger("edit.undo");
    EXPECT_EQ(hash(), before) << "a preview places nothing";
}

TEST_F(ToolsTest, StrandsAreSelectedAndBrushesKeepToThem) {
    activate("select");
    drag({crown + QPoint(-30, -30), crown + QPoint(0, -30), crown + QPoint(0, 30), crown + QPoint(-30, 30)});
    const auto flags = groom().strandAttributes.view<std::uint8_t>(attribute::kSelected);
    const std::vector<std::uint8_t> selected(flags.begin(), flags.end());
    const auto count = std::ranges::count(selected, std::uint8_t{1});
    ASSERT_GT(count, 0);
    ASSERT_LT(static_cast<std::size_t>(count), groom().strandCount());
    const Groom before = groom();
    auto& comb = dynamic_cast<BrushTool&>(activate("comb"));
    comb.setRadius(0.05f);
    drag({crown + QPoint(-40, 0), crown + QPoint(0, 8), crown + QPoint(60, 20)});
    for (std::size_t s = 0; s < groom().strandCount(); ++s) {
        if (selected[s] != 0) continue;
        ASSERT_EQ(before.strand(s).back(), groom().strand(s).back()) << s;
    }
    EXPECT_EQ(document().doneSteps(), 2);
}

TEST_F(ToolsTest, RandomActionsNeverBreakTheDocument) {
    Random random(7, 1);
    const std::vector<QString> ids{"comb",        "brush",  "grab",        "smooth",        "puff",
                                   "pinch",       "length", "cut",         "cut_line",      "add",
                                   "delete",      "freeze", "scalp_paint", "density_paint", "select",
                                   "scalp_lasso", "sphere", "wind",        "replace",       "scalp_box"};
    const auto below = [&random](int count) {
        return static_cast<int>(random.below(static_cast<std::uint32_t>(count)));
    };
    const auto somewhere = [&] { return crown + QPoint(below(200) - 100, below(160) - 40); };
    for (int action = 0; action < 500; ++action) {
        switch (below(9)) {
            case 0:
                trigger("edit.undo");
                break;
            case 1:
                trigger("edit.redo");
                break;
            case 2:
                key(std::array{Qt::Key_BracketLeft, Qt::Key_BracketRight, Qt::Key_Escape,
                               Qt::Key_F}[static_cast<std::size_t>(below(4))]);
                break;
            case 8:
                trigger(std::array{"select.all", "select.none", "select.invert", "select.hide", "select.show",
                                   "select.freeze", "select.thaw",
                                   "select.hideOthers"}[static_cast<std::size_t>(below(8))]);
                break;
            case 3:
                activate(ids[static_cast<std::size_t>(below(static_cast<int>(ids.size())))]);
                break;
            default: {
                const auto modifiers = std::array<Qt::KeyboardModifiers, 4>{
                    Qt::NoModifier, Qt::NoModifier, Qt::ControlModifier,
                    Qt::ShiftModifier}[static_cast<std::size_t>(below(4))];
                drag({somewhere(), somewhere(), somewhere()}, modifiers);
            }
        }
        if (action % 50 == 49) expectSound();
        if (HasFailure()) FAIL() << "after action " << action;
    }
    document().goToStep(document().stepCount());
    const auto last = hash();
    const int steps = document().stepCount();
    document().goToStep(0);
    document().goToStep(steps);
    EXPECT_EQ(hash(), last) << "all the way back and forth";
}

}  // namespace
}  // namespace hairloom::editor
