// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces carry hair, and placing hair on them.
#include <QComboBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "core/editing/document.h"
#include "core/editing/place.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/editing/surface_disc.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/operations/curl_class.h"
#include "core/operations/full_head.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/field_form.h"
#include "editor/fields/image_button.h"
#include "editor/fields/number_box.h"
#include "editor/fields/number_spin.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

class ScalpPanel : public QWidget {
  public:
    ScalpPanel(QtDocument& document, Messages& messages)
        : document_(document),
          messages_(messages),
          groups_(new QComboBox),
          expression_(new QLineEdit),
          area_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        area_->setProperty("role", "dim");
        area_->setWordWrap(true);
        groups_->setObjectName("scalpGroup");
        groups_->setToolTip("Selects all faces of a group or material of the head file");
        connect(groups_, &QComboBox::activated, this, [this](int index) {
            if (index > 0) select(groups_->itemData(index).toString());
            groups_->setCurrentIndex(0);
        });
        expression_->setObjectName("scalpExpression");
        expression_->setPlaceholderText("cap:70, above:0.5 …");
        expression_->setToolTip(
            "Select faces by expression, then press Enter: all, group:NAME, material:NAME, cap:DEGREES "
            "(faces that lean up to this angle from up), above:SHARE of the height, grow:N, shrink:N, "
            "invert, connected. A comma combines terms.");
        connect(expression_, &QLineEdit::returnPressed, this, [this] {
            select(expression_->text());
            expression_->clearFocus();
        });
        layout->addWidget(groups_);
        layout->addWidget(expression_);
        layout->addLayout(makeButtons());
        layout->addWidget(area_);
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::kScalpParts)) refresh();
        });
        refresh();
    }

  private:
    QGridLayout* makeButtons() {
        auto* grid = new QGridLayout;
        grid->setSpacing(6);
        const auto add = [&](const char* name, const QString& text, const QString& tip,
                             std::function<FaceSet()> faces) {
            auto* button = new QPushButton(text);
            button->setObjectName(name);
            button->setToolTip(tip);
            connect(button, &QPushButton::clicked, this, [this, faces = std::move(faces)] {
                if (groom().scalp) perform(faces());
            });
            grid->addWidget(button, grid->count() / 3, grid->count() % 3);
        };
        add("scalpGrow", "Grow", "Grow selection",
            [this] { return growSelection(mesh(), groom().scalpSelection, 1); });
        add("scalpShrink", "Shrink", "Shrink selection",
            [this] { return shrinkSelection(mesh(), groom().scalpSelection, 1); });
        add("scalpInvert", "Invert", "Invert selection",
            [this] { return invertSelection(mesh(), groom().scalpSelection); });
        add("scalpSymmetric", "Mirror", "Mirror selection", [this] {
            return editing::symmetricFaces(mesh(), *document_.editing().surface(), groom().scalpSelection);
        });
        add("scalpConnected", "Largest", "Keep only the largest connected piece", [this] {
            const auto pieces = connectedPieces(mesh(), groom().scalpSelection);
            return pieces.empty() ? FaceSet() : pieces.front();
        });
        add("scalpClear", "Clear", "Clear selection", [] { return FaceSet(); });
        return grid;
    }

    const Groom& groom() const { return document_.groom(); }
    const ScalpMesh& mesh() const { return *groom().scalp; }

    void select(const QString& expression) {
        if (!groom().scalp || expression.isEmpty()) return;
        auto faces = selectFaces(mesh(), expression.toStdString());
        if (!faces) {
            messages_.warn(errorText(faces.error()));
            return;
        }
        perform(*faces, expression);
    }

    void perform(const FaceSet& faces, const QString& expression = {}) {
        const auto& model = document_.editing().model();
        document_.perform(
            editing::selectScalp(model, faces, editing::Choice::Replace, expression.toStdString()));
    }

    void refresh() {
        setEnabled(groom().scalp != nullptr);
        if (!groom().scalp) {
            area_->setText("Open a head first.");
            return;
        }
        const FaceSet& faces = groom().scalpSelection;
        area_->setText(faces.empty()
                           ? QString("No faces selected: paint them (P) or choose a group.")
                           : QString("%L1 faces, %2\u00a0cm²")
                                 .arg(faces.size())
                                 .arg(numberLocale().toString(selectionArea(mesh(), faces) * 1e4, 'f', 0)));
        if (shownHead_ == groom().scalp) return;
        shownHead_ = groom().scalp;
        groups_->clear();
        groups_->addItem("Group or material…");
        for (const std::string& name : mesh().groupNames()) {
            groups_->addItem(QString::fromStdString(name), "group:" + QString::fromStdString(name));
        }
        for (const std::string& name : mesh().materialNames()) {
            groups_->addItem(QString("%1 (material)").arg(QString::fromStdString(name)),
                             "material:" + QString::fromStdString(name));
        }
    }

    QtDocument& document_;
    Messages& messages_;
    QComboBox* groups_;
    QLineEdit* expression_;
    QLabel* area_;
    std::shared_ptr<const ScalpMesh> shownHead_;
};

/// What placing needs, held while it runs.
using Roots = std::vector<SurfacePoint>;

class PlacePanel : public QWidget {
  public:
    PlacePanel(QtDocument& document, const Preferences& preferences, const Prices& prices, Tasks& tasks,
               Messages& messages, Viewport& viewport)
        : document_(document),
          tasks_(tasks),
          messages_(messages),
          viewport_(viewport),
          curl_(new QComboBox),
          count_(new QLabel),
          note_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(new FieldForm(document, preferences, placementFields(), &prices));
        curl_->setObjectName("placeCurl");
        curl_->setToolTip(
            "Curl of new strands, by operators that stay in the stack. None leaves the stack as it is. Tight "
            "curls "
            "need many points per strand");
        curl_->addItem("None");
        for (const CurlClass& curl : curlClasses()) curl_->addItem(labelOf(QString(curl.name)));
        auto* shape = new QFormLayout;
        shape->addRow("Curl", curl_);
        layout->addLayout(shape);
        auto* preview = new QPushButton("Preview roots");
        preview->setObjectName("placePreview");
        preview->setCheckable(true);
        preview->setToolTip("Shows where roots will be placed and updates as you change settings");
        auto* place = new QPushButton("Place hair");
        place->setObjectName("place");
        place->setToolTip(
            "Grows strands on the whole scalp and replaces the existing ones. New hair gets interpolated "
            "hairs "
            "until "
            "it covers the scalp. Once you set their number yourself, it stays");
        auto* row = new QHBoxLayout;
        row->addWidget(preview);
        row->addWidget(place);
        layout->addLayout(row);
        auto* density = new NumberBox(0, 100, true);
        density->setObjectName("previewDensity");
        density->setShown(1, QStringLiteral("%"), 0);
        density->setValue(100);
        density->setToolTip(
            "Share of the interpolated hairs that the viewport draws, to work faster. Renders and exports "
            "have "
            "all hairs");
        connect(density, &NumberBox::edited, this,
                [this](double percent) { viewport_.setPreviewDensity(static_cast<float>(0.01 * percent)); });
        auto* form = new QFormLayout;
        form->addRow("Preview density", density);
        layout->addLayout(form);
        count_->setObjectName("placeCount");
        count_->setWordWrap(true);
        count_->setProperty("role", "dim");
        layout->addWidget(count_);
        fill_ = pushButton(
            "fillHead", "Full head of hair",
            QString("Adds interpolated hairs until the scalp is as dense as a person's: %1 hairs per "
                    "cm², spread between the strands. More hairs take longer to draw")
                .arg(kHairsPerCm2),
            [this] { fill(); });
        layout->addWidget(fill_);
        layout->addWidget(imageButton(
            "densityImage", "Density from image…",
            "Reads the root density from a PNG at the UVs of the head's vertices. The next Place hair "
            "uses it",
            [this](const MaskImage& image) -> Status {
                if (!document_.groom().scalp)
                    return fail("there is no head to apply densities to", "open one");
                const auto values = valuesAtVertices(image, *document_.groom().scalp);
                if (!values) return tl::unexpected(values.error());
                document_.perform(editing::setDensity(document_.editing().model(), *values));
                return {};
            },
            [this](const QString& problem) { messages_.warn(problem); }));
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        layout->addWidget(note_);
        connect(place, &QPushButton::clicked, this, [this, preview] {
            preview->setChecked(false);
            this->place();
        });
        connect(preview, &QPushButton::toggled, this, [this](bool on) {
            previewing_ = on;
            refresh();
        });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Placement | editing::kScalpParts)) refresh();
            if (contains(parts, editing::Part::Placement | editing::kScalpParts |
                                    editing::Part::Interpolation | editing::Part::Strands))
                foretell();
        });
        foretell();
        viewport_.addMarks([this](Marks& marks) {
            const Groom& groom = document_.groom();
            if (!groom.scalp) return;
            for (const SurfacePoint& root : roots_) {
                marks.point(groom.scalp->pointAt(root.triangle, root.barycentric), QColor(90, 230, 140), 4);
            }
        });
    }

  private:
    /// What the next *Place hair* makes, by area.
    void foretell() {
        const Groom& groom = document_.groom();
        fill_->setEnabled(groom.strandCount() > 0);
        count_->clear();
        if (!groom.scalp || groom.scalpSelection.empty()) return;
        const double area_cm2 = 1e4 * maskedArea(*groom.scalp, groom.scalpSelection, groom.scalpDensity);
        const double density = static_cast<double>(groom.placement.densityPerCm2);
        const double strands = density > 0 ? density * area_cm2 : groom.placement.count;
        const auto whole = [](double number) { return static_cast<qlonglong>(std::llround(number)); };
        QString text =
            QString("Places about %L1 strands on %L2\u00a0cm²").arg(whole(strands)).arg(whole(area_cm2));
        if (area_cm2 > 0)
            text +=
                QString(", %1\u00a0per\u00a0cm²").arg(numberLocale().toString(strands / area_cm2, 'f', 1));
        const auto guides = static_cast<std::size_t>(std::max(1.0, strands));
        const std::uint32_t each =
            isFilledByItself(groom) ? followHairsToFill(groom, guides) : groom.interpolation.followPerGuide;
        if (each > 0)
            text +=
                QString(". With %L1 interpolated hairs each: %L2 hairs, %3\u00a0per\u00a0cm²")
                    .arg(each)
                    .arg(whole(strands * (each + 1.0)))
                    .arg(numberLocale().toString(strands * (each + 1.0) / std::max(area_cm2, 1e-9), 'f', 0));
        count_->setText(text);
    }

    /// One step.
    void fill() {
        Groom full = document_.groom();
        if (auto status = fillHead(full); !status) return messages_.warn(errorText(status.error()));
        document_.perform(editing::setSettings(document_.editing().model(), full, "Full head of hair"));
        messages_.say(QString("%L1 interpolated hairs per guide").arg(full.interpolation.followPerGuide));
    }

    void refresh() {
        roots_.clear();
        note_->clear();
        viewport_.redraw();
        if (!previewing_ || !document_.groom().scalp) return;
        tasks_.run<Roots>(
            "Placing roots",
            [groom = document_.groom()](TaskControl&) { return editing::placeRoots(groom, {}); },
            [this](Roots roots) {
                roots_ = std::move(roots);
                note_->setText(QString("%L1 roots").arg(roots_.size()));
                viewport_.redraw();
            });
    }

    void place() {
        using Command = std::shared_ptr<std::unique_ptr<editing::Command>>;
        tasks_.run<Command>(
            "Placing hair",
            [groom = document_.groom()](TaskControl&) -> Result<Command> {
                auto command = editing::place(groom, {}, {});
                if (!command) return tl::unexpected(command.error());
                if (*command && isFilledByItself(groom)) *command = filled(groom, std::move(*command));
                return std::make_shared<std::unique_ptr<editing::Command>>(std::move(*command));
            },
            [this, strandsBefore = document_.groom().offsets.version(),
             selection = document_.groom().scalpSelection](const Command& command) {
                const Groom& groom = document_.groom();
                if (groom.offsets.version() != strandsBefore || groom.scalpSelection != selection) {
                    messages_.warn("The hair has changed in the meantime: place it again");
                    return;
                }
                document_.perform(std::move(*command));
                messages_.say(QString("%L1 strands placed").arg(document_.groom().strandCount()));
                curl();
            });
    }

    /// What places hair, and interpolated hairs between it, as one step.
    static std::unique_ptr<editing::Command> filled(const Groom& groom,
                                                    std::unique_ptr<editing::Command> place) {
        editing::Model after{groom, {}};
        place->exchange(after);
        Groom full = after.groom;
        auto fill = fillHead(full) ? editing::setSettings(after, full, "Full head of hair") : nullptr;
        place->exchange(after);
        const std::string name = place->name();
        std::vector<std::unique_ptr<editing::Command>> steps;
        steps.push_back(std::move(place));
        steps.push_back(std::move(fill));
        return editing::together(name, std::move(steps));
    }

    /// Another step: the operators of the class that is chosen.
    void curl() {
        const int chosen = curl_->currentIndex();
        if (chosen <= 0) return;
        const CurlClass& curl = curlClasses()[static_cast<std::size_t>(chosen) - 1];
        const Groom& groom = document_.groom();
        auto command = editing::setOperators(document_.editing().model(), withCurl(groom.operators, curl),
                                             std::string("Curl ") + curl.name);
        if (!command) return messages_.warn(errorText(command.error()));
        if (*command) document_.perform(std::move(*command));
        const std::uint32_t needed = pointsForCurl(curl, groom.placement.length);
        if (groom.placement.points < needed)
            messages_.warn(QString("%1 points per strand are too few for these curls: %2 make them round")
                               .arg(groom.placement.points)
                               .arg(needed));
    }

    QtDocument& document_;
    Tasks& tasks_;
    Messages& messages_;
    Viewport& viewport_;
    QComboBox* curl_;
    QLabel* count_;
    QLabel* note_;
    QPushButton* fill_ = nullptr;
    Roots roots_;
    bool previewing_ = false;
};

}  // namespace

PanelInfo scalpPanel() {
    return {"scalp",
            QString("Scalp"),
            "scalp-paint",
            Qt::LeftDockWidgetArea,
            20,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({heading("Where hair grows"),
                                        new ScalpPanel(parts.document, parts.messages), heading("Place hair"),
                                        new PlacePanel(parts.document, parts.preferences, parts.prices,
                                                       parts.tasks, parts.messages, parts.viewport)}));
            }};
}

}  // namespace hairloom::editor
