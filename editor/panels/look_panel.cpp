// SPDX-License-Identifier: GPL-3.0-or-later
// How the hair looks: presets, the shading model with the controls that it has, colour by pigment or by
// picker, how finely it is drawn, and the hairs between the guides.
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "core/documents/look_presets.h"
#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "editor/fields/field_form.h"
#include "editor/fields/image_button.h"
#include "editor/look/parts.h"
#include "editor/panels/key_this.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

constexpr const char* kModel = "shadingModel";
constexpr unsigned kKajiya = 1, kMarschner = 2, kSadeghi = 4;
constexpr unsigned kFibres = kMarschner | kSadeghi;
constexpr unsigned kAll = kKajiya | kFibres;

/// Rows of fields that belong together, for some of the models.
struct Group {
    const char* title;
    QStringList fields;
    unsigned models;
    bool open;
};

const std::vector<Group>& groups() {
    static const std::vector<Group> all{
        {"Colour",
         {"rootColour", "tipColour", "gradientStart", "gradientEnd", "colourVariation"},
         kAll,
         true},
        {"Pigment",
         {"colourSource", "eumelanin", "pheomelanin", "tipMelanin", "melaninVariation"},
         kAll,
         true},
        {"Streaks",
         {"streakShare", "streakWidth", "streakSoftness", "streakColourSource", "streakColour",
          "streakMelanin", "streakSeed"},
         kAll,
         false},
        {"Grey", {"greyShare", "greySeed"}, kAll, false},
        {"Dye",
         {"dyeStrength", "dyeColour", "dyeStart", "dyeEnd", "dyeRegrowth", "dyeRegrowthSoftness"},
         kAll,
         false},
        {"Fibre",
         {"rootRadius", "tipScale", "radiusVariation", "scaleTiltDegrees", "rootOpacity", "tipOpacity"},
         kAll,
         true},
        {"Highlights", {"specular", "shininess"}, kKajiya, true},
        {"Energy", {"energy"}, kKajiya | kSadeghi, false},
        {"Fibre optics", {"indexOfRefraction", "longitudinalRoughness", "azimuthalRoughness"}, kFibres, true},
        {"Cross-section", {"eccentricity"}, kAll, false},
        {"First highlight (R)", {"rIntensity", "rWidth", "rShiftDegrees"}, kFibres, false},
        {"Transmission (TT)", {"ttIntensity", "ttWidth", "ttShiftDegrees"}, kFibres, false},
        {"Second highlight (TRT)", {"trtIntensity", "trtWidth", "trtShiftDegrees"}, kFibres, false},
        {"Caustics",
         {"causticWidthDegrees", "causticFade", "causticIntensity", "azimuthalSolver"},
         kMarschner,
         false},
        {"Colours of the highlights",
         {"rColour", "ttColour", "trtColour", "ttAzimuthalWidth"},
         kSadeghi,
         false},
        {"Glints",
         {"glintIntensity", "glintWidthDegrees", "glintNearDegrees", "glintFarDegrees"},
         kSadeghi,
         false},
        {"Emission and tentacles",
         {"emission", "emissionRootColour", "emissionTipColour", "tubes"},
         kAll,
         false},
    };
    return all;
}

class LookPanel : public QWidget {
  public:
    explicit LookPanel(const PanelParts& parts)
        : document_(parts.document),
          preferences_(parts.preferences),
          prices_(parts.prices),
          messages_(parts.messages),
          viewport_(parts.viewport),
          keys_(new KeyThis(parts.keying, "material", this)),
          layout_(new QVBoxLayout(this)) {
        layout_->setContentsMargins(0, 0, 0, 0);
        layout_->setSpacing(8);
        layout_->addWidget(collapsible("Presets", makePresetList(document_, messages_, viewport_)));
        layout_->addWidget(collapsible("Compare", makeCompareBar(document_, viewport_)));
        layout_->addWidget(form(pick(materialFields(), {kModel})));
        makeGroups();
        layout_->addWidget(collapsible("Shading charts", makeShadingChart(document_, preferences_), false));
        layout_->addWidget(
            collapsible("Edges and shadows",
                        column({makePictureForm(preferences_, prices_, viewport_), form(shadowFields()),
                                makePicturePrices(document_, parts.tasks, viewport_, parts.prices)}),
                        false));
        layout_->addWidget(collapsible("Interpolated hairs", form(followHairFields()), false));
        connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
            if (contains(changed, editing::Part::Material | editing::Part::Strands)) refresh();
        });
        refresh();
    }

  private:
    FieldForm* form(const std::vector<Field>& fields, FieldKeys* keys = nullptr) {
        return new FieldForm(document_, preferences_, fields, &prices_, keys);
    }

    void makeGroups() {
        const std::vector<Field> fields = materialFields();
        for (const Group& group : groups()) {
            QWidget* rows = form(pick(fields, group.fields), keys_);
            if (QLatin1String(group.title) == QLatin1String("Pigment")) rows = withPigmentButtons(rows);
            QWidget* const section = collapsible(QString(group.title), rows, group.open);
            layout_->addWidget(section);
            shownFor_.emplace_back(section, group.models);
        }
        // Fields that materials have gained since.
        std::vector<Field> others;
        for (const Field& field : fields) {
            const auto has = [&](const Group& group) { return group.fields.contains(field.name); };
            if (QLatin1String(field.name) != QLatin1String(kModel) && std::ranges::none_of(groups(), has))
                others.push_back(field);
        }
        if (!others.empty()) layout_->addWidget(collapsible("More", form(others, keys_), false));
    }

    /// For Kajiya-Kay, which knows colours only, and for those who want to go on from a natural colour.
    QWidget* withPigmentButtons(QWidget* rows) {
        auto* widget = new QWidget;
        auto* layout = new QVBoxLayout(widget);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(5);
        layout->addWidget(rows);
        auto* button = new QPushButton("Colours from the pigment");
        button->setObjectName("colourByMelanin");
        button->setToolTip("Set root and tip colour from melanin");
        connect(button, &QPushButton::clicked, this, [this] {
            HairMaterial material = document_.groom().material;
            colourByMelanin(material);
            document_.perform(
                editing::setMaterial(document_.editing().model(), material, "Colours from the pigment"));
        });
        layout->addWidget(button);
        layout->addWidget(imageButton(
            "melaninImage", "Melanin from image…",
            "Multiplies the melanin of each strand by a PNG at the root UVs. White keeps the melanin above, "
            "black has none",
            [this](const MaskImage& image) { return takeMelanin(image); },
            [this](const QString& problem) { messages_.warn(problem); }));
        evenMelanin_->setObjectName("evenMelanin");
        evenMelanin_->setToolTip("Removes the strands' own melanin, of an image or an attribute");
        connect(evenMelanin_, &QPushButton::clicked, this,
                [this] { document_.perform(editing::setMelanin(document_.editing().model(), {})); });
        layout->addWidget(evenMelanin_);
        return widget;
    }

    Status takeMelanin(const MaskImage& image) {
        const auto shares = valuesAtRoots(image, document_.groom());
        if (!shares) return tl::unexpected(shares.error());
        document_.perform(editing::setMelanin(document_.editing().model(), *shares));
        return {};
    }

    void refresh() {
        const auto model = static_cast<unsigned>(document_.groom().material.shadingModel);
        for (const auto& [group, models] : shownFor_) group->setVisible((models >> model) & 1u);
        evenMelanin_->setVisible(document_.groom().strandAttributes.has(attribute::kMelanin));
    }

    QtDocument& document_;
    const Preferences& preferences_;
    const Prices& prices_;
    Messages& messages_;
    Viewport& viewport_;
    KeyThis* keys_;
    QVBoxLayout* layout_;
    std::vector<std::pair<QWidget*, unsigned>> shownFor_;
    QPushButton* evenMelanin_ = new QPushButton("Even melanin");
};

}  // namespace

PanelInfo lookPanel() {
    return {"look",
            QString("Look"),
            "look",
            Qt::RightDockWidgetArea,
            50,
            true,
            [](const PanelParts& parts) -> QWidget* { return scrolled(column({new LookPanel(parts)})); }};
}

}  // namespace hairloom::editor
