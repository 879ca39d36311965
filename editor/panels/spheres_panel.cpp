// SPDX-License-Identifier: GPL-3.0-or-later
// What hair collides with: the skin of the head, and spheres in a list with their numbers; fitting them, and
// how well they do.
#include <QCheckBox>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QStyledItemDelegate>
#include <QTimer>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "core/documents/body_fit.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/editing/sphere_commands.h"
#include "core/editing/sphere_parts.h"
#include "core/groom/spheres.h"
#include "core/simulation/scene_input.h"
#include "editor/fields/length_text.h"
#include "editor/fields/option_form.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

constexpr float kNearHair = 0.04f;       // metres: skin that spheres have to cover
constexpr float kCapsuleError = 0.001f;  // metres that skin may lie inside capsules, or as deep as in spheres

/// A column whose texts cannot be edited.
class ShownOnly : public QStyledItemDelegate {
  public:
    using QStyledItemDelegate::QStyledItemDelegate;
    QWidget* createEditor(QWidget*, const QStyleOptionViewItem&, const QModelIndex&) const override {
        return nullptr;
    }
};

class SpheresPanel : public QWidget {
  public:
    SpheresPanel(QtDocument& document, const Preferences& preferences, Tasks& tasks, Messages& messages,
                 Player& player, Viewport& viewport)
        : document_(document),
          preferences_(preferences),
          tasks_(tasks),
          messages_(messages),
          player_(player),
          viewport_(viewport),
          list_(new QTreeWidget),
          bone_(new QComboBox),
          joined_(new QComboBox),
          shapes_(new QComboBox),
          count_(new QSpinBox),
          fit_(new QLabel),
          skin_(new QCheckBox("Collide with the skin")),
          skinFit_(new QLabel),
          skinSpheres_(new QLabel),
          skinNote_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        makeSkin(*layout);
        list_->setObjectName("spheres");
        list_->setHeaderLabels({"Sphere", "Radius", "Bone", "Capsule"});
        list_->headerItem()->setToolTip(3, "The sphere that this one makes a capsule with");
        list_->setRootIsDecorated(false);
        list_->setMinimumHeight(200);
        list_->header()->setStretchLastSection(false);
        list_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
        list_->header()->setMaximumSectionSize(70);  // of a long name its beginning
        list_->header()->setSectionResizeMode(3, QHeaderView::Stretch);
        list_->setToolTip(
            "Spheres that hair collides with. Joined ones make a capsule. Double-click a name, or press F2, "
            "to "
            "change it");
        list_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
        for (const int column : {1, 2, 3}) list_->setItemDelegateForColumn(column, new ShownOnly(list_));
        connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) { rename(*item); });
        layout->addWidget(list_, 1);

        auto* row = new QHBoxLayout;
        row->addWidget(pushButton("sphereMirror", "Mirror",
                                  "Add a copy of the sphere on the other side of the head", [this] {
                                      onSelected([](const editing::Model& model, std::size_t index) {
                                          return editing::mirrorSphere(model, index);
                                      });
                                  }));
        row->addWidget(pushButton("sphereRemove", "Remove", "Remove the sphere", [this] {
            onSelected([](const editing::Model& model, std::size_t index) {
                return editing::removeSphere(model, index);
            });
        }));
        layout->addLayout(row);
        makeNumbers(*layout);

        layout->addWidget(heading("Fit to head"));
        auto* fitRow = new QHBoxLayout;
        count_->setObjectName("sphereCount");
        count_->setRange(1, 64);
        count_->setValue(12);
        count_->setSuffix(" spheres");
        count_->setToolTip("Number of spheres. More spheres fit closer to the skin and cost more");
        shapes_->setObjectName("sphereShapes");
        shapes_->addItems({"Spheres", "Capsules"});
        shapes_->setToolTip("Capsules join spheres of one bone. They close gaps that spheres leave");
        auto* fit = pushButton("sphereFit", "Fit",
                               "Replaces the spheres with ones that cover head, neck and shoulders near "
                               "the hair. Spheres of colliding groups stay",
                               [this] { this->fit(); });
        fitRow->addWidget(shapes_);
        fitRow->addWidget(count_, 1);
        fitRow->addWidget(fit);
        layout->addLayout(fitRow);
        fit_->setProperty("role", "dim");
        fit_->setWordWrap(true);
        layout->addWidget(fit_);
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Spheres)) refresh();
        });
        connect(&player_, &Player::motionsChanged, this, &SpheresPanel::refresh);
        connect(list_, &QTreeWidget::currentItemChanged, this, [this] {
            showNumbers();
            viewport_.redraw();
        });
        viewport_.addMarks([this](Marks& marks) {
            // While hair moves, so do the spheres. A panel behind others in its tab counts as visible to Qt.
            if (visibleRegion().isEmpty() || !selected() || player_.hasFrame()) return;
            const CollisionSphere& sphere = spheres()[*selected()];
            marks.circle(sphere.centre, -viewport_.camera().forward_ws(), sphere.radius, QColor(255, 200, 80),
                         2.5f, Marks::Depth::OnTop);
        });
        refresh();
    }

  private:
    const std::vector<CollisionSphere>& spheres() const { return document_.groom().spheres; }

    void makeSkin(QVBoxLayout& layout) {
        layout.addWidget(heading("Skin of the head"));
        skin_->setObjectName("bodyCheck");
        skin_->setToolTip("Keeps hair out of the head's own skin, wherever it bends. The CPU simulates it");
        auto* again = pushButton("bodyFit", "Fit",
                                 "Measures the skin again, where the hair reaches. Do this after hair has "
                                 "become longer or the head has changed",
                                 [this] { fitSkin(); });
        auto* row = new QHBoxLayout;
        row->addWidget(skin_, 1);
        row->addWidget(again);
        layout.addLayout(row);
        skinFit_->setObjectName("bodyWords");
        skinFit_->setProperty("role", "dim");
        skinFit_->setWordWrap(true);
        layout.addWidget(skinFit_);
        skinSpheres_->setObjectName("bodySpheres");
        skinSpheres_->setProperty("role", "dim");
        skinSpheres_->setWordWrap(true);
        layout.addWidget(skinSpheres_);
        skinNote_->setObjectName("bodyNote");
        skinNote_->setWordWrap(true);
        layout.addWidget(skinNote_);
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Physics)) sayWhatPasses();
        });
        connect(&player_, &Player::planPreviewChanged, this, &SpheresPanel::sayWhatPasses);
        connect(skin_, &QCheckBox::clicked, this, [this](bool checked) {
            if (checked) return fitSkin();
            document_.perform(editing::setBody(document_.editing().model(), nullptr, "Remove skin collider"));
        });
    }

    void showSkin() {
        const auto& body = document_.groom().body;
        const QSignalBlocker quiet(skin_);
        skin_->setChecked(body != nullptr);
        skin_->setEnabled(document_.groom().scalp != nullptr);
        sayWhatPasses();
        if (body && body == fitted_) return;  // says how well it fits
        skinFit_->setText(body ? QString("%1 kB").arg(static_cast<double>(body->bytes()) / 1000, 0, 'f', 0)
                               : QString());
    }

    /// What moves the hair in the preview may know of spheres alone.
    void sayWhatPasses() {
        const Groom& groom = document_.groom();
        const bool springs = groom.simulation.strandModel != runtime::StrandModel::rods;
        const bool passes = groom.body && (springs || player_.method().method != SimulationMethod::strands);
        skinNote_->setVisible(passes);
        skinNote_->setText(!passes ? QString()
                           : springs
                               ? QString("Springs pass through the skin. Select rods as the strand model, or "
                                         "fit spheres")
                               : QString("This simulation method ignores the skin. Select the strand "
                                         "engine, or fit spheres"));
        const auto ofSkin = skinSpheresOf(groom);
        const auto left = std::ranges::count(ofSkin, 1);
        skinSpheres_->setVisible(!passes && left > 0);
        skinSpheres_->setText(passes || left == 0
                                  ? QString()
                                  : QString("%1 of %2 spheres lie in the skin. Hair meets the skin instead")
                                        .arg(left)
                                        .arg(groom.spheres.size()));
    }

    void fitSkin() {
        showSkin();  // is checked when it is there
        const Groom& groom = document_.groom();
        if (!groom.scalp) return;
        tasks_.run<BakedBody>(
            "Fitting the skin",
            [groom, actor = player_.actor()](TaskControl&) { return fitBody(groom, actor.get()); },
            [this, scalp = groom.scalp](BakedBody baked) {
                // Another head has other skin.
                if (document_.groom().scalp != scalp) return;
                const auto length = [this](float metres) {
                    return lengthText(static_cast<double>(metres), preferences_);
                };
                QString words = QString("Worst gap %1, mean %2, largest bulge %3; %4 kB")
                                    .arg(length(baked.fit.worstGap), length(baked.fit.meanGap),
                                         length(baked.fit.worstBulge))
                                    .arg(static_cast<double>(baked.field->bytes()) / 1000, 0, 'f', 0);
                for (const std::string& note : baked.notes)
                    words += QStringLiteral("\n") + QString::fromStdString(note);
                fitted_ = baked.field;
                skinFit_->setText(words);
                document_.perform(editing::setBody(document_.editing().model(), std::move(baked.field),
                                                   "Fit skin collider"));
            });
    }

    void makeNumbers(QVBoxLayout& layout) {
        numbers_ = new OptionForm(preferences_);
        numbers_->addNumber(
            "selectedRadius", "Radius", "Radius of the selected sphere", "m", 0.001, 0.5, false,
            [this] { return selected() ? static_cast<double>(spheres()[*selected()].radius) : 0.001; },
            [this](double radius) {
                onSelected([radius](const editing::Model& model, std::size_t index) {
                    return editing::resizeSphere(model, index, static_cast<float>(radius));
                });
            });
        bone_->setObjectName("sphereBone");
        bone_->setToolTip("Bone that carries the sphere. Without one it moves with the head");
        connect(bone_, &QComboBox::activated, this, [this](int index) {
            const std::string bone = index == 0 ? std::string() : bone_->itemText(index).toStdString();
            onSelected([bone](const editing::Model& model, std::size_t at) {
                return editing::attachSphere(model, at, bone);
            });
        });
        numbers_->addWidget("Bone", bone_);
        joined_->setObjectName("sphereJoined");
        joined_->setToolTip("Another sphere, with which this one makes a tapered capsule");
        connect(joined_, &QComboBox::activated, this, [this](int index) {
            const std::int32_t other = joined_->itemData(index).toInt();
            onSelected([other](const editing::Model& model, std::size_t at) {
                return editing::joinSphere(model, at, other);
            });
        });
        numbers_->addWidget("Capsule with", joined_);
        layout.addWidget(numbers_);
    }

    std::optional<std::size_t> selected() const {
        const int row = list_->indexOfTopLevelItem(list_->currentItem());
        if (row < 0 || static_cast<std::size_t>(row) >= spheres().size()) return std::nullopt;
        return static_cast<std::size_t>(row);
    }

    template <class MakeCommand>
    void onSelected(MakeCommand make) {
        const auto index = selected();
        if (!index) {
            messages_.say("Select a sphere in the list first");
            return;
        }
        document_.perform(make(document_.editing().model(), *index));
    }

    void refresh() {
        showSkin();
        // One that is new is what people go on with.
        const bool grew =
            list_->topLevelItemCount() > 0 && static_cast<int>(spheres().size()) > list_->topLevelItemCount();
        const int row =
            grew ? static_cast<int>(spheres().size()) - 1 : list_->indexOfTopLevelItem(list_->currentItem());
        const QSignalBlocker quiet(list_);
        list_->clear();
        for (const CollisionSphere& sphere : spheres()) {
            auto* item = new QTreeWidgetItem(
                {QString::fromStdString(sphere.name),
                 lengthText(static_cast<double>(sphere.radius), preferences_),
                 sphere.bone.empty() ? QStringLiteral("–") : QString::fromStdString(sphere.bone),
                 joinedName(sphere)});
            item->setFlags(item->flags() | Qt::ItemIsEditable);
            list_->addTopLevelItem(item);
        }
        if (!spheres().empty()) {
            list_->setCurrentItem(list_->topLevelItem(std::clamp(row, 0, list_->topLevelItemCount() - 1)));
        }
        showNumbers();
    }

    QString joinedName(const CollisionSphere& sphere) const {
        const bool isJoined =
            sphere.joined >= 0 && static_cast<std::size_t>(sphere.joined) < spheres().size();
        if (!isJoined) return QStringLiteral("–");
        return QString::fromStdString(spheres()[static_cast<std::size_t>(sphere.joined)].name);
    }

    void rename(QTreeWidgetItem& item) {
        const auto index = static_cast<std::size_t>(list_->indexOfTopLevelItem(&item));
        const std::string name = item.text(0).trimmed().toStdString();
        // Not while the view still closes its editor: a refresh replaces all items.
        QTimer::singleShot(0, this, [this, index, name] {
            if (index >= spheres().size()) return;
            if (name.empty() || name == spheres()[index].name) return refresh();
            document_.perform(editing::renameSphere(document_.editing().model(), index, name));
        });
    }

    void showNumbers() {
        numbers_->setEnabled(selected().has_value());
        numbers_->refresh();
        bone_->clear();
        bone_->addItem("none");
        if (const auto& actor = player_.actor()) {
            for (const Bone& bone : actor->skeleton().bones())
                bone_->addItem(QString::fromStdString(bone.name));
        }
        joined_->clear();
        joined_->addItem("none", -1);
        if (!selected()) return;
        const CollisionSphere& shown = spheres()[*selected()];
        for (std::size_t s = 0; s < spheres().size(); ++s) {
            if (s != *selected())
                joined_->addItem(QString::fromStdString(spheres()[s].name), static_cast<int>(s));
        }
        joined_->setCurrentIndex(std::max(joined_->findData(shown.joined), 0));
        const QString bone = QString::fromStdString(shown.bone);
        // Named in the document, though no skeleton has it here.
        if (!bone.isEmpty() && bone_->findText(bone) < 0) bone_->addItem(bone);
        bone_->setCurrentIndex(bone.isEmpty() ? 0 : bone_->findText(bone));
    }

    void fit() {
        const Groom& groom = document_.groom();
        if (!groom.scalp) return;
        tasks_.run<editing::SphereFit>(
            "Fitting spheres",
            [groom, count = count_->value(), joins = shapes_->currentIndex() == 1,
             actor = player_.actor()](TaskControl&) {
                editing::SphereFitOptions options;
                options.count = static_cast<std::uint32_t>(count);
                if (groom.strandCount() > 0) options.region = editing::facesNearHair(groom, kNearHair);
                auto fit = editing::fitSpheres(*groom.scalp, options);
                if (!fit) return fit;
                if (actor) attachSpheres(*actor, fit->spheres);
                if (!joins) return fit;
                editing::joinSpheres(*groom.scalp, options.region, kCapsuleError, fit->spheres);
                *fit = editing::measureSpheres(*groom.scalp, options.region, std::move(fit->spheres));
                return fit;
            },
            [this](editing::SphereFit fit) {
                const auto length = [this](float metres) {
                    return lengthText(static_cast<double>(metres), preferences_);
                };
                fit_->setText(QString("Worst gap %1, mean %2, largest bulge %3")
                                  .arg(length(fit.worstGap), length(fit.meanGap), length(fit.worstBulge)));
                auto all = editing::spheresOfParts(spheres());
                appendSpheres(all, fit.spheres);
                document_.perform(
                    editing::setSpheres(document_.editing().model(), std::move(all), "Fit spheres"));
            });
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Tasks& tasks_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    QTreeWidget* list_;
    OptionForm* numbers_ = nullptr;
    QComboBox* bone_;
    QComboBox* joined_;
    QComboBox* shapes_;
    QSpinBox* count_;
    QLabel* fit_;
    QCheckBox* skin_;
    QLabel* skinFit_;
    QLabel* skinSpheres_;
    QLabel* skinNote_;
    std::shared_ptr<const runtime::BodyField> fitted_;  ///< that the words are of
};

}  // namespace

PanelInfo spheresPanel() {
    return {"spheres",
            QString("Spheres"),
            "sphere",
            Qt::RightDockWidgetArea,
            80,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({new SpheresPanel(parts.document, parts.preferences, parts.tasks,
                                                         parts.messages, parts.player, parts.viewport)}));
            }};
}

}  // namespace hairloom::editor
