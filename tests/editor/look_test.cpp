// SPDX-License-Identifier: GPL-3.0-or-later
// Shading models with their controls, presets and thumbnails, two looks side by side, a reference picture,
// how finely the viewport draws.
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QImage>
#include <QListWidget>
#include <QPushButton>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <string_view>

#include "core/documents/look_presets.h"
#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/live/shown.h"
#include "editor/fields/field_form.h"
#include "editor/fields/number_box.h"
#include "editor/fields/number_spin.h"
#include "editor/fields/price_tag.h"
#include "editor/look/tress.h"
#include "editor/style/theme.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class LookTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
    }
    void chooseModel(int index) {
        auto* models = find<QComboBox>("shadingModel");
        models->setCurrentIndex(index);
        Q_EMIT models->activated(index);
    }
    bool offers(const char* field) {
        return find<QWidget>(field)->isVisibleTo(window->panel("look")->widget());
    }
};

TEST_F(LookTest, EachModelShowsItsOwnControls) {
    const auto before = hash();
    EXPECT_TRUE(offers("specular"));
    EXPECT_FALSE(offers("indexOfRefraction"));
    chooseModel(1);
    EXPECT_EQ(groom().material.shadingModel, ShadingModel::marschner);
    EXPECT_FALSE(offers("specular"));
    EXPECT_TRUE(offers("indexOfRefraction"));
    chooseModel(2);
    EXPECT_TRUE(offers("indexOfRefraction"));
    EXPECT_EQ(document().stepCount(), 2);
    ASSERT_TRUE(window->saveTo(inFolder("sadeghi.hairloom")));
    document().undo();
    document().undo();
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(offers("specular"));
    files().open(inFolder("sadeghi.hairloom"));
    finishWork();
    EXPECT_EQ(groom().material.shadingModel, ShadingModel::sadeghi) << "it belongs to the file";
    EXPECT_TRUE(offers("indexOfRefraction"));
}

TEST_F(LookTest, ChartsFollowTheControls) {
    auto* kinds = find<QComboBox>("shadingChart");
    QWidget* const chart = find<QWidget>("shadingChartImage");
    kinds->parentWidget()->show();
    chart->setFixedSize(340, 480);
    const auto drawn = [&] {
        QApplication::processEvents();
        return chart->grab().toImage();
    };
    EXPECT_EQ(kinds->count(), static_cast<int>(shownKinds().size()));
    const QImage kajiya = drawn();
    HairMaterial material = groom().material;
    material.shininess = 300;
    document().perform(editing::setMaterial(document().editing().model(), material, "Shininess"));
    EXPECT_NE(drawn(), kajiya) << "the highlight is narrower";
    document().undo();
    EXPECT_EQ(drawn(), kajiya);
    chooseModel(1);
    const QImage marschner = drawn();
    EXPECT_NE(marschner, kajiya);
    find<QDoubleSpinBox>("shadingChartLight")->setValue(40);
    EXPECT_NE(drawn(), marschner) << "light from the side moves the lobes";
    find<QDoubleSpinBox>("shadingChartLight")->setValue(0);
    EXPECT_EQ(drawn(), marschner);
    // Tables of a model that has none are said to be none.
    kinds->setCurrentIndex(kinds->findData(QString("tables")));
    const QImage tables = drawn();
    EXPECT_NE(tables, marschner);
    EXPECT_FALSE(chart->isHidden());
    chooseModel(0);
    QApplication::processEvents();
    EXPECT_TRUE(chart->isHidden());
    chooseModel(1);
    EXPECT_EQ(drawn(), tables);
}

TEST_F(LookTest, APresetGivesItsPigmentAndColours) {
    const auto before = hash();
    auto* looks = find<QListWidget>("looks");
    ASSERT_GE(looks->count(), static_cast<int>(lookPresets().size()));
    for (int i = 0; i < static_cast<int>(lookPresets().size()); ++i) {
        const LookPreset& preset = lookPresets()[static_cast<std::size_t>(i)];
        Q_EMIT looks->itemClicked(looks->item(i));
        EXPECT_EQ(groom().material.eumelanin, preset.eumelanin) << preset.name;
        EXPECT_FLOAT_EQ(groom().material.pheomelanin, preset.pheomelanin) << preset.name;
        EXPECT_TRUE((groom().material.rootColour.array() <= groom().material.tipColour.array()).all());
    }
    expectSound();
    document().goToStep(0);
    EXPECT_EQ(hash(), before);
    Q_EMIT looks->itemClicked(looks->item(0));
    const Vec3f black = groom().material.tipColour;
    const auto white = std::ranges::find(lookPresets(), std::string_view("white"),
                                         [](const LookPreset& one) { return std::string_view(one.name); });
    Q_EMIT looks->itemClicked(looks->item(static_cast<int>(white - lookPresets().begin())));
    EXPECT_GT(groom().material.tipColour.minCoeff(), 10 * black.maxCoeff());
}

TEST_F(LookTest, ASelectedPresetShowsItsColour) {
    auto* looks = find<QListWidget>("looks");
    for (int i = 0; i < looks->count(); ++i) {
        const QIcon icon = looks->item(i)->icon();
        EXPECT_EQ(icon.pixmap(looks->iconSize(), QIcon::Selected).toImage(),
                  icon.pixmap(looks->iconSize(), QIcon::Normal).toImage())
            << i;
    }
}

TEST_F(LookTest, APresetMayTurnTheHighlightsAndANaturalOneLeavesThem) {
    const auto choose = [&](const char* name) {
        auto* looks = find<QListWidget>("looks");
        const auto found =
            std::ranges::find(lookPresets(), std::string_view(name),
                              [](const LookPreset& one) { return std::string_view(one.name); });
        ASSERT_NE(found, lookPresets().end()) << name;
        Q_EMIT looks->itemClicked(looks->item(static_cast<int>(found - lookPresets().begin())));
    };
    choose("neon");
    EXPECT_EQ(groom().material.shadingModel, ShadingModel::sadeghi);
    EXPECT_LT(groom().material.rColour.y(), 0.5f);
    choose("glints");
    EXPECT_EQ(groom().material.rColour, Vec3f(Vec3f::Ones())) << "that of another look goes";
    EXPECT_EQ(groom().material.glintIntensity, 5);
    choose("brown");
    EXPECT_EQ(groom().material.glintIntensity, 5);
    EXPECT_EQ(document().stepCount(), 3);
}

TEST_F(LookTest, CausticsAreControlsOfMarschnerAndMoveItsCharts) {
    EXPECT_FALSE(offers("causticWidthDegrees"));
    chooseModel(2);
    EXPECT_FALSE(offers("causticWidthDegrees"));
    chooseModel(1);
    for (const char* field : {"causticWidthDegrees", "causticFade", "causticIntensity", "azimuthalSolver"})
        EXPECT_TRUE(find<QWidget>(field)) << field;
    auto* kinds = find<QComboBox>("shadingChart");
    QWidget* const chart = find<QWidget>("shadingChartImage");
    kinds->parentWidget()->show();
    chart->setFixedSize(340, 280);
    kinds->setCurrentIndex(kinds->findData(QString("marschner-n")));
    const auto drawn = [&] {
        QApplication::processEvents();
        return chart->grab().toImage();
    };
    find<NumberBox>("azimuthalRoughness")->spinBox().setValue(0.01);
    const QImage usual = drawn();
    find<NumberBox>("causticWidthDegrees")->spinBox().setValue(40);
    EXPECT_FLOAT_EQ(groom().material.causticWidthDegrees, 40);
    const QImage wide = drawn();
    EXPECT_NE(wide, usual);
    find<NumberBox>("causticIntensity")->spinBox().setValue(4);
    const QImage strong = drawn();
    EXPECT_NE(strong, wide);
    auto* solver = find<QComboBox>("azimuthalSolver");
    solver->setCurrentIndex(1);
    Q_EMIT solver->activated(1);
    EXPECT_EQ(groom().material.azimuthalSolver, AzimuthalSolver::cubic);
    EXPECT_NE(drawn(), strong);
}

TEST_F(LookTest, ShadowsBelongToTheProjectAndHaveTheirCharts) {
    const auto before = hash();
    auto* kinds = find<QComboBox>("shadingChart");
    QWidget* const chart = find<QWidget>("shadingChartImage");
    kinds->parentWidget()->show();
    chart->setFixedSize(340, 280);
    kinds->setCurrentIndex(kinds->findData(QString("deep-opacity-map")));
    const auto drawn = [&] {
        QApplication::processEvents();
        return chart->grab().toImage();
    };
    const QImage three = drawn();
    EXPECT_FALSE(chart->isHidden());
    find<NumberBox>("shadowLayers")->spinBox().setValue(9);
    EXPECT_EQ(groom().shadows.layers, 9u);
    EXPECT_NE(drawn(), three) << "of nine layers there are three charts";
    auto* filter = find<QComboBox>("shadowFilter");
    filter->setCurrentIndex(2);
    Q_EMIT filter->activated(2);
    EXPECT_EQ(groom().shadows.filter, ShadowFiltering::five);
    auto* shadowKinds = find<QComboBox>("shadows");
    const int adaptive = shadowKinds->findText("Adaptive");
    ASSERT_GE(adaptive, 0);
    shadowKinds->setCurrentIndex(adaptive);
    Q_EMIT shadowKinds->activated(adaptive);
    find<NumberBox>("shadowNodes")->spinBox().setValue(16);
    EXPECT_EQ(groom().shadows.kind, ShadowKind::adaptive);
    const auto changed = hash();
    EXPECT_NE(changed, before);
    ASSERT_TRUE(window->saveTo(inFolder("shadows.hairloom")));
    document().goToStep(0);
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(drawn(), three);
    files().open(inFolder("shadows.hairloom"));
    finishWork();
    EXPECT_EQ(hash(), changed) << "it belongs to the file";
    EXPECT_EQ(groom().shadows.layers, 9u);
    EXPECT_EQ(groom().shadows.kind, ShadowKind::adaptive);
    EXPECT_EQ(groom().shadows.nodes, 16u);
}

TEST_F(LookTest, LooksAreKeptInFilesAndFoundAgain) {
    const std::filesystem::path looks = folder.path().toStdString();
    HairMaterial material;
    applyLook(lookPresets()[4], material);
    material.scaleTiltDegrees = 3.5f;
    material.specular = 1.75f;
    ASSERT_TRUE(saveLook(looks, "my auburn", material));
    EXPECT_EQ(savedLooks(looks), std::vector<std::string>{"my auburn"});
    const auto back = loadLook(looks, "my auburn");
    ASSERT_TRUE(back) << back.error().message();
    Groom a, b;
    a.material = material;
    b.material = *back;
    EXPECT_EQ(contentHash(a), contentHash(b));
    EXPECT_FALSE(saveLook(looks, "../elsewhere", material));
    EXPECT_FALSE(loadLook(looks, "no such"));
}

TEST_F(LookTest, ColoursFollowThePigmentWhenAsked) {
    find<NumberBox>("eumelanin")->spinBox().setValue(6);
    find<QPushButton>("colourByMelanin")->click();
    const Vec3f dark = groom().material.tipColour;
    find<NumberBox>("eumelanin")->spinBox().setValue(0.1);
    find<QPushButton>("colourByMelanin")->click();
    EXPECT_GT(groom().material.tipColour.minCoeff(), dark.maxCoeff());
    EXPECT_EQ(document().stepCount(), 4);
}

TEST_F(LookTest, AnImageGivesStrandsTheirMelaninAndOneClickTakesItAway) {
    QImage image(2, 2, QImage::Format_RGB32);
    image.fill(qRgb(64, 64, 64));
    ASSERT_TRUE(image.save(inFolder("pale.png")));
    auto* even = find<QPushButton>("evenMelanin");
    const auto isOffered = [&] { return even->isVisibleTo(window->panel("look")->widget()); };
    EXPECT_FALSE(isOffered());
    QFile broken(inFolder("broken.png"));
    ASSERT_TRUE(broken.open(QIODevice::WriteOnly) && broken.write("no picture") > 0);
    broken.close();
    const auto before = hash();
    onceAskedForAFile(inFolder("broken.png"));
    find<QPushButton>("melaninImage")->click();
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(window->statusLine().message().contains("broken.png"))
        << window->statusLine().message().toStdString();
    onceAskedForAFile(inFolder("pale.png"));
    find<QPushButton>("melaninImage")->click();
    const auto melanin = groom().strandAttributes.view<float>(attribute::kMelanin);
    ASSERT_EQ(melanin.size(), groom().strandCount());
    EXPECT_NEAR(melanin[0], 64.0f / 255, 2e-3f);
    EXPECT_TRUE(isOffered());
    even->click();
    EXPECT_EQ(hash(), before);
    EXPECT_FALSE(isOffered());
    document().undo();
    EXPECT_TRUE(isOffered());
    EXPECT_EQ(document().stepCount(), 2);
}

TEST_F(LookTest, AMaskOrAnImageGivesStrandsTheirStiffnessAndOneClickTakesItAway) {
    auto* even = find<QPushButton>("evenStiffness");
    auto* masks = find<QComboBox>("stiffnessMask");
    const auto isOffered = [&] { return even->isVisibleTo(even->parentWidget()); };
    EXPECT_FALSE(isOffered());
    ASSERT_EQ(masks->count(), static_cast<int>(kPaintedMasks));
    const auto before = hash();
    ASSERT_FALSE(groom().strandAttributes.has(maskAttribute(4)));
    masks->setCurrentIndex(3);
    find<QPushButton>("stiffnessFromMask")->click();
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(window->statusLine().message().contains("Nothing is painted in mask 'Mask 4'"))
        << window->statusLine().message().toStdString();

    std::vector<float> painted(groom().strandCount(), 0.0f);
    painted[3] = 1;
    painted[4] = 0.5f;
    document().perform(editing::setMask(document().editing().model(), 4, painted));
    document().perform(editing::setMaskNames(document().editing().model(), {"", "", "", "Gel"}).value());
    EXPECT_EQ(masks->currentText(), "Gel (4)") << "it stays chosen";
    const auto masked = hash();
    find<NumberSpin>("stiffnessBlack")->setValue(0.5);
    find<NumberSpin>("stiffnessWhite")->setValue(8);
    EXPECT_EQ(hash(), masked) << "until it is taken";
    find<QPushButton>("stiffnessFromMask")->click();
    const auto stiffness = groom().strandAttributes.view<float>(attribute::kStiffness);
    ASSERT_EQ(stiffness.size(), groom().strandCount());
    EXPECT_EQ(stiffness[0], 0.5f);
    EXPECT_EQ(stiffness[3], 8.0f);
    EXPECT_EQ(stiffness[4], 4.25f);
    EXPECT_TRUE(isOffered());
    even->click();
    EXPECT_EQ(hash(), masked);
    EXPECT_FALSE(isOffered());

    QImage image(2, 2, QImage::Format_RGB32);
    image.fill(qRgb(255, 255, 255));
    ASSERT_TRUE(image.save(inFolder("white.png")));
    onceAskedForAFile(inFolder("white.png"));
    find<QPushButton>("stiffnessImage")->click();
    EXPECT_NEAR(groom().strandAttributes.view<float>(attribute::kStiffness)[0], 8, 1e-2f);
    document().undo();
    EXPECT_EQ(hash(), masked);
}

TEST_F(LookTest, SwappingLooksIsAStep) {
    find<QPushButton>("compareKeep")->click();
    const auto a = hash();
    find<NumberBox>("specular")->spinBox().setValue(1.5);
    const auto b = hash();
    find<QPushButton>("compareSwap")->click();
    EXPECT_EQ(hash(), a);
    find<QPushButton>("compareSwap")->click();
    EXPECT_EQ(hash(), b);
    EXPECT_EQ(document().stepCount(), 3);
}

class LookPictureTest : public LookTest {
  protected:
    void SetUp() override {
        qputenv("HAIRLOOM_VIEWPORT", "readback");
        LookTest::SetUp();
        qputenv("HAIRLOOM_VIEWPORT", "readback");
        window->resize(820, 520);
        Groom guides = groom();
        guides.interpolation.followPerGuide = 0;
        document().open(std::move(guides), {}, "guides");
        viewport().look(render::View::Front);
        drawQuickly();
    }
    QImage shot() {
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        EXPECT_FALSE(viewport().picture().isNull()) << window->statusLine().message().toStdString();
        return viewport().picture().convertToFormat(QImage::Format_RGB32);
    }
    static double difference(const QImage& a, const QImage& b, const QRect& where) {
        double sum = 0;
        for (int y = where.top(); y <= where.bottom(); ++y) {
            for (int x = where.left(); x <= where.right(); ++x) {
                sum += std::abs(qGray(a.pixel(x, y)) - qGray(b.pixel(x, y)));
            }
        }
        return sum / (where.width() * where.height());
    }
};

TEST_F(LookPictureTest, ModelsAndTheirControlsShowInThePicture) {
    QImage last = shot();
    for (const int model : {1, 2, 0}) {
        chooseModel(model);
        const QImage now = shot();
        EXPECT_GT(difference(last, now, now.rect()), 0.05) << "model " << model;
        last = now;
        find<NumberBox>(model == 0 ? "specular" : "longitudinalRoughness")
            ->spinBox()
            .setValue(model == 0 ? 2 : 0.9 - 0.2 * model);
        const QImage turned = shot();
        EXPECT_GT(difference(last, turned, now.rect()), 0.01) << "control of model " << model;
        last = turned;
    }
}

TEST_F(LookPictureTest, TwoLooksStandSideBySideAndTheLineIsDragged) {
    const QImage a = shot();
    find<QPushButton>("compareKeep")->click();
    Groom pale = groom();
    applyLook(*findLook("white"), pale.material);
    change("Look", pale);
    const QImage b = shot();
    find<QPushButton>("compareShow")->setChecked(true);
    const QImage both = shot();
    const int half = both.width() / 2;
    const QRect left(0, 0, half - 2, both.height()),
        right(half + 2, 0, both.width() - half - 2, both.height());
    EXPECT_LT(difference(both, a, left), 0.02);
    EXPECT_LT(difference(both, b, right), 0.02);
    EXPECT_GT(difference(a, b, left), 0.2);
    const QPoint line(viewport().width() / 2, 60);
    drag({line, line + QPoint(-40, 0), line + QPoint(-100, 0)});
    EXPECT_LT(viewport().split(), 0.45f);
    const QImage dragged = shot();
    EXPECT_LT(difference(dragged, b, right), 0.02);
    find<QPushButton>("compareShow")->setChecked(false);
    EXPECT_LT(difference(shot(), b, b.rect()), 0.02);
}

TEST_F(LookPictureTest, QualityChangesThePicture) {
    const QImage before = shot();
    auto* shadows = find<QComboBox>("shadows");
    const int none = shadows->findText("None");
    ASSERT_GE(none, 0);
    shadows->setCurrentIndex(none);
    Q_EMIT shadows->activated(none);
    EXPECT_EQ(groom().shadows.kind, ShadowKind::none);
    const QImage bright = shot();
    EXPECT_GT(difference(before, bright, before.rect()), 0.1);
    auto* frames = find<QComboBox>("frames");
    frames->setCurrentIndex(0);
    Q_EMIT frames->activated(0);
    EXPECT_EQ(viewport().quality().frames, 1u);
    EXPECT_GT(difference(bright, shot(), bright.rect()), 0);
}

TEST_F(LookPictureTest, AReferencePictureStandsBehindTheHead) {
    QImage red(64, 64, QImage::Format_RGB32);
    red.fill(QColor(200, 20, 20));
    viewport().setReference(red, 1);
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const QImage seen = viewport().grab().toImage();
    const QImage& picture = viewport().picture();
    ASSERT_TRUE(picture.hasAlphaChannel());
    // A square that is as large as fits.
    const int top = std::max(0, (seen.height() - seen.width()) / 2);
    const QPoint corner(seen.width() / 2, top + 4), middle(seen.width() / 2, seen.height() / 2);
    EXPECT_GT(seen.pixelColor(corner).red(), 190) << "above the head";
    EXPECT_LT(seen.pixelColor(corner).green(), 40);
    EXPECT_GT(seen.pixelColor(middle).green(), 40) << "the head is opaque";
    viewport().setReference({}, 1);
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_LT(viewport().grab().toImage().pixelColor(corner).red(), 100);
}

TEST_F(LookPictureTest, ThumbnailsAreDrawnWhenNothingElseIs) {
    QImage thumbnail;
    QObject::connect(&viewport(), &Viewport::sidePictureReady, window.get(),
                     [&](const QString& name, const QImage& picture) {
                         if (name == "test") thumbnail = picture;
                     });
    HairMaterial material;
    applyLook(lookPresets()[0], material);
    viewport().requestSidePicture("test", tressPicture(material, 64));
    ASSERT_TRUE(QTest::qWaitFor([&] { return !thumbnail.isNull(); }, kPatience));
    EXPECT_EQ(thumbnail.size(), QSize(64, 64));
    EXPECT_LT(qGray(thumbnail.pixel(32, 32)), 90) << "black hair";
    EXPECT_EQ(qAlpha(thumbnail.pixel(32, 32)), 255);
    EXPECT_EQ(qAlpha(thumbnail.pixel(1, 32)), 0) << "beside it";
}

TEST_F(LookPictureTest, ThumbnailsShowTheColourOfTheirLook) {
    constexpr int kSide = 64;
    std::map<QString, QImage> made;
    QObject::connect(&viewport(), &Viewport::sidePictureReady, window.get(),
                     [&](const QString& name, const QImage& picture) { made[name] = picture; });
    for (const ShadingModel model : {ShadingModel::kajiya, ShadingModel::marschner}) {
        double last = -6;
        std::vector<QImage> earlier;
        for (const char* look : {"black", "brown", "copper", "blond", "white"}) {  // ever brighter
            HairMaterial material;
            applyLook(*findLook(look), material);
            material.shadingModel = model;
            const QString name = QString("%1 of model %2").arg(look).arg(static_cast<int>(model));
            viewport().requestSidePicture(name, tressPicture(material, kSide));
            ASSERT_TRUE(QTest::qWaitFor([&] { return made.contains(name); }, kPatience));
            const QImage picture = made[name];
            const auto meanOf = [](const auto& value) {
                double sum = 0;
                for (int y = kSide / 4; y < 3 * kSide / 4; ++y)  // hair and nothing else
                    for (int x = 3 * kSide / 8; x < 5 * kSide / 8; ++x) sum += value(x, y);
                return sum / (kSide / 2 * (kSide / 4));
            };
            const double bright = meanOf([&](int x, int y) { return qGray(picture.pixel(x, y)); });
            const double blown =
                meanOf([&](int x, int y) { return qGray(picture.pixel(x, y)) > 252 ? 1 : 0; });
            EXPECT_GT(bright, last + 6) << name.toStdString();
            EXPECT_GT(bright, std::string_view(look) == "black" ? 2 : 30) << name.toStdString();
            EXPECT_LT(blown, 0.1) << name.toStdString();
            for (const QImage& other : earlier) {
                const double apart = meanOf([&](int x, int y) {
                    const QColor a = picture.pixelColor(x, y), b = other.pixelColor(x, y);
                    return std::abs(a.red() - b.red()) + std::abs(a.green() - b.green()) +
                           std::abs(a.blue() - b.blue());
                });
                EXPECT_GT(apart, 24) << name.toStdString() << " looks like another";
            }
            last = bright;
            earlier.push_back(picture);
        }
    }
}

TEST_F(LookPictureTest, ThumbnailsStandOnTheListOfAnyTheme) {
    window->panel("look")->raise();
    auto* looks = find<QListWidget>("looks");
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const auto isDrawn = [&] { return looks->item(1)->data(Qt::UserRole).toBool(); };
    ASSERT_TRUE(QTest::qWaitFor(isDrawn, kPatience));
    for (const Theme theme : {Theme::Light, Theme::Dark}) {
        parts().preferences.setTheme(theme);
        QCoreApplication::processEvents();
        EXPECT_TRUE(isDrawn());
        const QRect item = looks->visualItemRect(looks->item(1));
        const QImage shown = looks->viewport()->grab(item).toImage();
        const int scale = shown.width() / item.width();
        const int left = (item.width() - looks->iconSize().width()) / 2 + 2;
        const QColor beside = shown.pixelColor(scale * left, scale * 30);
        const QColor field = themeColours(theme).field;
        EXPECT_NEAR(qGray(beside.rgb()), qGray(field.rgb()), 3) << beside.name().toStdString();
    }
}

TEST_F(LookTest, SettingsOfThePictureSayWhatTheyCost) {
    openFirstStrands(50);
    viewport().resize(64, 48);
    auto* tag = find<PriceTag>("samplesCost");
    EXPECT_TRUE(tag->words().isEmpty());
    const auto before = hash();
    find<QPushButton>("pictureMeasure")->click();
    finishWork();
    EXPECT_EQ(hash(), before);
    for (const char* setting : {"samples", "shadows", "shadowResolution", "shadowFilter", "shadowLayers",
                                "layerEnds", "subdivisions", "transparency"}) {
        const auto* priced = find<PriceTag>((QString(setting) + "Cost").toUtf8().constData());
        EXPECT_TRUE(priced->words().contains("FLIP")) << setting;
    }
    EXPECT_TRUE(tag->toolTip().contains("Measured at"));
    PictureQuality quality = viewport().quality();
    quality.subdivisions = 1;
    viewport().setQuality(quality);
    EXPECT_TRUE(tag->toolTip().contains("before the last change"));
}

}  // namespace
}  // namespace hairloom::editor
