// SPDX-License-Identifier: GPL-3.0-or-later
// The Layers panel as a groomer uses it: a fringe on a layer of its own, soloed, locked, renamed, and undone.
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QTreeWidget>

#include "core/editing/selection_commands.h"
#include "core/groom/strand_subset.h"
#include "editor/fields/field.h"
#include "editor/fields/number_box.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class LayersTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        window->panel("layers")->raise();
        QCoreApplication::processEvents();
    }
    QTreeWidget& list() { return *find<QTreeWidget>("layers"); }
    QTreeWidgetItem& row(int index) { return *list().topLevelItem(index); }
    void click(const char* button) { find<QPushButton>(button)->click(); }
    void select(std::uint32_t count) {
        std::vector<std::uint32_t> strands;
        for (std::uint32_t s = 0; s < count; ++s) strands.push_back(s);
        document().perform(
            editing::selectStrands(document().editing().model(), strands, editing::Choice::Replace));
    }
};

TEST_F(LayersTest, SelectedStrandsGetALayerOfTheirOwn) {
    const auto before = hash();
    ASSERT_EQ(list().topLevelItemCount(), 1);
    EXPECT_FALSE(find<QPushButton>("layerRemove")->isEnabled()) << "the only one stays";
    EXPECT_FALSE(find<QPushButton>("layerMove")->isEnabled()) << "nothing is selected";
    select(40);
    click("layerAdd");
    ASSERT_EQ(list().topLevelItemCount(), 2);
    EXPECT_EQ(row(1).text(0), "Layer 2");
    EXPECT_EQ(row(1).text(3), "40");
    EXPECT_EQ(strandsOfLayer(groom(), 1).size(), 40u);
    row(1).setText(0, "Fringe");
    EXPECT_EQ(groom().layers[1].name, "Fringe");
    row(1).setText(0, "  ");
    EXPECT_EQ(row(1).text(0), "Fringe") << "a layer has a name";
    expectSound();
    while (document().editing().canUndo()) trigger("edit.undo");
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(list().topLevelItemCount(), 1);
}

TEST_F(LayersTest, SoloShowsOneAndThenAll) {
    select(40);
    click("layerAdd");
    click("layerSolo");
    EXPECT_FALSE(groom().layers[0].visible);
    EXPECT_TRUE(groom().layers[1].visible);
    EXPECT_EQ(row(0).checkState(1), Qt::Unchecked);
    click("layerSolo");
    EXPECT_TRUE(groom().layers[0].visible);
    row(0).setCheckState(2, Qt::Checked);
    EXPECT_TRUE(groom().layers[0].locked);
}

TEST_F(LayersTest, StrandsAreSelectedByLayerAndComeBackWhenItGoes) {
    select(40);
    click("layerAdd");
    select(3);
    list().setCurrentItem(&row(1));
    click("layerSelect");
    EXPECT_EQ(editing::strandsWithFlag(groom(), attribute::kSelected).size(), 40u);
    list().setCurrentItem(&row(0));
    click("layerMove");
    EXPECT_EQ(strandsOfLayer(groom(), 0).size(), groom().strandCount());
    list().setCurrentItem(&row(1));
    click("layerRemove");
    EXPECT_EQ(list().topLevelItemCount(), 1);
    expectSound();
}

TEST_F(LayersTest, ALayerHasItsOwnDensityAndMaterial) {
    select(40);
    click("layerAdd");
    const auto before = hash();
    auto& density = *find<NumberBox>("layerDensity");
    auto& spin = *density.findChild<QDoubleSpinBox*>();
    spin.setValue(0.5);
    EXPECT_EQ(groom().layers[1].density, 0.5f);
    EXPECT_EQ(groom().layers[0].density, 1);
    auto& own = *find<QCheckBox>("layerOwnMaterial");
    QWidget& panel = *window->panel("layers");
    EXPECT_FALSE(panel.findChild<QWidget*>("rootColour"));
    own.click();
    ASSERT_TRUE(groom().layers[1].material);
    EXPECT_EQ(groom().layers[1].material->rootColour, groom().material.rootColour)
        << "it begins as the hairstyle's";
    auto* shininess = panel.findChild<NumberBox*>("shininess");
    ASSERT_TRUE(shininess);
    const float ofHair = groom().material.shininess;
    shininess->findChild<QDoubleSpinBox*>()->setValue(150);
    EXPECT_EQ(groom().layers[1].material->shininess, 150);
    EXPECT_EQ(groom().material.shininess, ofHair);
    for (const auto& field : layerMaterialFields(1))
        EXPECT_TRUE(panel.findChild<QWidget*>(field.name)) << field.name << " is offered";
    ASSERT_TRUE(window->saveTo(inFolder("fringe.hairloom")));
    list().setCurrentItem(&row(0));
    EXPECT_FALSE(own.isChecked());
    EXPECT_FALSE(panel.findChild<QWidget*>("shininess"));
    list().setCurrentItem(&row(1));
    own.click();
    EXPECT_FALSE(groom().layers[1].material);
    document().undo();
    EXPECT_TRUE(groom().layers[1].material);
    EXPECT_TRUE(own.isChecked());
    expectSound();
    while (hash() != before && document().editing().canUndo()) document().undo();
    EXPECT_EQ(hash(), before);
    EXPECT_FALSE(own.isChecked());
    files().open(inFolder("fringe.hairloom"));
    finishWork();
    ASSERT_EQ(groom().layers.size(), 2u);
    EXPECT_EQ(groom().layers[1].density, 0.5f);
    EXPECT_EQ(groom().layers[1].material->shininess, 150);
}

}  // namespace
}  // namespace hairloom::editor
