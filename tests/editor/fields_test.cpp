// SPDX-License-Identifier: GPL-3.0-or-later
// Controls that are made from the tables of fields: they show the document, change it undoably, one drag is
// one step.
#include <QCheckBox>
#include <QComboBox>

#include "editor/document/words.h"
#include "editor/fields/colour.h"
#include "editor/fields/field_form.h"
#include "editor/fields/number_box.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class FieldsTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
    }
};

TEST_F(FieldsTest, EveryFieldHasAControlThatShowsItsValue) {
    for (const Field& field : simulationFields()) {
        QWidget* control = window->panel("physics")->findChild<QWidget*>(field.name);
        ASSERT_TRUE(control) << std::string(field.name);
        EXPECT_FALSE(control->toolTip().isEmpty()) << std::string(field.name);
        if (auto* box = qobject_cast<NumberBox*>(control)) {
            EXPECT_EQ(box->value(), field.value(groom(), 0)) << std::string(field.name);
        }
    }
    for (const auto& fields : {materialFields(), followHairFields()}) {
        for (const Field& field : fields) {
            EXPECT_TRUE(window->panel("look")->findChild<QWidget*>(field.name)) << std::string(field.name);
        }
    }
}

TEST_F(FieldsTest, TypingANumberIsOneStepAndCanBeUndone) {
    auto* box = find<NumberBox>("windSpeed");
    const auto before = hash();
    box->spinBox().setValue(7.5);
    EXPECT_EQ(groom().simulation.windSpeed, 7.5f);
    EXPECT_EQ(document().stepCount(), 1);
    const auto after = hash();
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(box->value(), 0.0);
    trigger("edit.redo");
    EXPECT_EQ(hash(), after);
}

TEST_F(FieldsTest, OneDragOfASliderIsOneStep) {
    auto* box = find<NumberBox>("angularStiffness");
    const auto before = hash();
    box->slider().setSliderDown(true);
    for (const int position : {100, 250, 300, 700}) box->slider().setValue(position);
    box->slider().setSliderDown(false);
    EXPECT_EQ(document().stepCount(), 1);
    EXPECT_FLOAT_EQ(groom().simulation.angularStiffness, 0.7f);
    box->slider().setSliderDown(true);
    box->slider().setValue(100);
    box->slider().setSliderDown(false);
    EXPECT_EQ(document().stepCount(), 2);
    document().goToStep(0);
    EXPECT_EQ(hash(), before);
}

TEST_F(FieldsTest, LengthsAreShownInTheUnitOfThePreferences) {
    auto* box = find<NumberBox>("windGustSize");
    parts().preferences.setUnit(DisplayUnit::Centimetre);
    EXPECT_DOUBLE_EQ(box->spinBox().value(), 50.0);
    parts().preferences.setUnit(DisplayUnit::Metre);
    EXPECT_DOUBLE_EQ(box->spinBox().value(), 0.5);
    parts().preferences.setUnit(DisplayUnit::Inch);
    EXPECT_NEAR(box->spinBox().value(), 0.5 / 0.0254, 1e-3);
    EXPECT_EQ(document().stepCount(), 0) << "showing is no change";
}

TEST_F(FieldsTest, WhatSpansThousandsHasAUnitASliderAndStepsThatFit) {
    auto* radius = window->panel("look")->findChild<NumberBox*>("rootRadius");
    ASSERT_TRUE(radius);
    EXPECT_EQ(radius->spinBox().suffix(), QStringLiteral(" µm"));
    EXPECT_NEAR(radius->spinBox().value(), 1e6 * static_cast<double>(groom().material.rootRadius), 0.051);
    EXPECT_GT(radius->slider().value(), 100) << "hair of people lies within the slider";
    const double before = radius->spinBox().value();
    radius->spinBox().stepUp();
    EXPECT_GT(radius->spinBox().value(), before);
    EXPECT_LE(radius->spinBox().value(), 1.2 * before) << "one step";
    auto* length = window->panel("scalp")->findChild<NumberBox*>("length");
    ASSERT_TRUE(length);
    EXPECT_NEAR(length->value(), 0.07, 1e-6);
    EXPECT_GT(length->slider().value(), 200) << "7 cm of 5 m";
    EXPECT_LT(length->slider().value(), 800);
}

TEST_F(FieldsTest, ChoicesAndDefaults) {
    auto* integrator = find<QComboBox>("integrator");
    Q_EMIT integrator->activated(5);
    EXPECT_EQ(groom().simulation.integrator, runtime::Integrator::rk4);
    EXPECT_EQ(integrator->currentIndex(), 5);
}

TEST(FieldTest, ColoursGoToTheScreenAndBack) {
    for (int grey = 0; grey < 256; grey += 15) {
        const QColor colour(grey, 255 - grey, grey / 2);
        EXPECT_EQ(fromLinear(toLinear(colour)).rgb(), colour.rgb());
    }
    EXPECT_NEAR(toLinear(QColor::fromRgbF(0.5f, 0.5f, 0.5f)).x(), 0.2140f, 1e-3f);
}

TEST(FieldTest, LabelsAreReadable) {
    EXPECT_EQ(labelOf("windGustSize"), "Wind gust size");
}

}  // namespace
}  // namespace hairloom::editor
