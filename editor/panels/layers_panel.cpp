// SPDX-License-Identifier: GPL-3.0-or-later
// Layers: what is shown, locked, coloured, operated on and exported together.
#include <QCheckBox>
#include <QHeaderView>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "core/editing/document.h"
#include "core/editing/layer_commands.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/groom/strand_subset.h"
#include "editor/document/words.h"
#include "editor/fields/field_form.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

enum Column { kName, kVisible, kLocked, kStrands };

class LayersPanel : public QWidget {
  public:
    LayersPanel(QtDocument& document, const Preferences& preferences, Messages& messages)
        : document_(document),
          preferences_(preferences),
          messages_(messages),
          list_(new QTreeWidget),
          ownMaterial_(new QCheckBox("Own material")) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        makeList();
        layout->addWidget(list_);
        auto* first = new QHBoxLayout;
        first->addWidget(pushButton("layerAdd", "Add", "Add a layer and move the selected strands to it",
                                    [this] { add(); }));
        first->addWidget(pushButton("layerRemove", "Remove",
                                    "Remove the layer and move its strands to the first remaining one",
                                    [this] { perform(editing::removeLayer(model(), chosen())); }));
        first->addWidget(pushButton("layerSolo", "Solo", "Show only this layer. Click again to show all",
                                    [this] { solo(); }));
        layout->addLayout(first);
        auto* second = new QHBoxLayout;
        second->addWidget(pushButton("layerSelect", "Select strands", "Select the strands of this layer",
                                     [this] { select(); }));
        second->addWidget(
            pushButton("layerMove", "Move here", "Move the selected strands to this layer",
                       [this] { perform(editing::moveToLayer(model(), selected(), chosen())); }));
        layout->addLayout(second);
        ownMaterial_->setObjectName("layerOwnMaterial");
        ownMaterial_->setToolTip("Gives the layer its own colour, thickness and shading");
        connect(ownMaterial_, &QCheckBox::clicked, this, &LayersPanel::giveMaterial);
        settings_ = new QVBoxLayout;
        layout->addLayout(settings_);
        connect(list_, &QTreeWidget::currentItemChanged, this, [this] { showSettings(); });
        connect(&document_, &QtDocument::replaced, this, [this] { shown_.reset(); });
        connect(list_, &QTreeWidget::itemChanged, this, &LayersPanel::takeChange);
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Layers | editing::Part::Material | editing::Part::Strands |
                                    editing::Part::StrandFlags))
                refresh();
        });
        refresh();
    }

  private:
    const editing::Model& model() const { return document_.editing().model(); }
    const std::vector<Layer>& layers() const { return document_.groom().layers; }
    std::vector<std::uint32_t> selected() const {
        return editing::strandsWithFlag(document_.groom(), attribute::kSelected);
    }
    std::uint32_t chosen() const {
        const int row = list_->indexOfTopLevelItem(list_->currentItem());
        return static_cast<std::uint32_t>(std::clamp(row, 0, static_cast<int>(layers().size()) - 1));
    }

    void makeList() {
        list_->setObjectName("layers");
        list_->setHeaderLabels({"Layer", "Shown", "Locked", "Strands"});
        list_->setRootIsDecorated(false);
        list_->setMinimumHeight(120);
        list_->header()->setStretchLastSection(false);
        list_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
        for (const int column : {kVisible, kLocked, kStrands})
            list_->header()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
        list_->setToolTip(
            "Show, lock, edit and export strands together. Double-click a name to rename a layer. The "
            "region of an operator can select a layer.");
    }

    void giveMaterial(bool own) {
        std::vector<Layer> changed = layers();
        std::optional<HairMaterial>& material = changed[chosen()].material;
        material.reset();
        if (own) material = document_.groom().material;
        set(std::move(changed));
    }

    /// New controls only where another layer is chosen, or its material comes or goes, so that a slider
    /// outlives its own drag.
    void showSettings() {
        const std::uint32_t layer = chosen();
        const bool own = layers()[layer].material.has_value();
        ownMaterial_->setChecked(own);
        if (shown_ == std::pair(layer, own)) return;
        shown_ = {layer, own};
        ownMaterial_->setParent(this);
        while (QLayoutItem* item = settings_->takeAt(0)) {
            if (QWidget* form = item->widget(); form && form != ownMaterial_) {
                form->setParent(nullptr);  // gone at once; one of its controls may be what is talking
                form->deleteLater();
            }
            delete item;
        }
        settings_->addWidget(new FieldForm(document_, preferences_, {layerDensityField(layer)}));
        settings_->addWidget(ownMaterial_);
        if (!own) return;
        const QStringList most{"shadingModel",
                               "rootColour",
                               "tipColour",
                               "colourVariation",
                               "colourSource",
                               "eumelanin",
                               "rootRadius",
                               "tipScale",
                               "specular",
                               "shininess",
                               "longitudinalRoughness",
                               "azimuthalRoughness"};
        std::vector<Field> others;
        for (const Field& field : layerMaterialFields(layer)) {
            if (!most.contains(QLatin1String(field.name))) others.push_back(field);
        }
        settings_->addWidget(new FieldForm(document_, preferences_, pick(layerMaterialFields(layer), most)));
        settings_->addWidget(
            collapsible("More material settings", new FieldForm(document_, preferences_, others), false));
    }

    void perform(Result<std::unique_ptr<editing::Command>> command) {
        if (!command) return messages_.warn(errorText(command.error()));
        document_.perform(std::move(*command));
    }
    void set(std::vector<Layer> changed) {
        document_.perform(editing::setLayers(model(), std::move(changed)));
    }

    QString freeName() const {
        for (std::size_t number = layers().size() + 1;; ++number) {
            const QString name = QString("Layer %1").arg(number);
            if (std::ranges::none_of(layers(), [&](const Layer& l) { return l.name == name.toStdString(); }))
                return name;
        }
    }

    void add() {
        std::vector<Layer> changed = layers();
        changed.emplace_back().name = freeName().toStdString();
        const std::vector<std::uint32_t> moving = selected();
        set(changed);
        const auto last = static_cast<std::uint32_t>(changed.size() - 1);
        list_->setCurrentItem(list_->topLevelItem(static_cast<int>(last)));
        if (!moving.empty()) perform(editing::moveToLayer(model(), moving, last));
    }

    void solo() {
        std::vector<Layer> changed = layers();
        const std::size_t own = chosen();
        bool alone = changed[own].visible;
        for (std::size_t i = 0; i < changed.size(); ++i) alone = alone && (i == own || !changed[i].visible);
        for (std::size_t i = 0; i < changed.size(); ++i) changed[i].visible = alone || i == own;
        set(std::move(changed));
    }

    void select() {
        const auto strands = strandsOfLayer(document_.groom(), chosen());
        document_.perform(editing::selectStrands(model(), strands, editing::Choice::Replace));
    }

    void takeChange(QTreeWidgetItem* item, int column) {
        const auto index = static_cast<std::size_t>(list_->indexOfTopLevelItem(item));
        if (index >= layers().size()) return;
        std::vector<Layer> changed = layers();
        const bool checked = item->checkState(column) == Qt::Checked;
        if (column == kVisible) changed[index].visible = checked;
        if (column == kLocked) changed[index].locked = checked;
        const QString name = item->text(kName).trimmed();
        if (column == kName && !name.isEmpty()) changed[index].name = name.toStdString();
        set(std::move(changed));
        refresh();  // an empty name goes back
    }

    void refresh() {
        const QSignalBlocker quiet(list_);
        while (list_->topLevelItemCount() > static_cast<int>(layers().size()))
            delete list_->takeTopLevelItem(list_->topLevelItemCount() - 1);
        for (std::size_t i = 0; i < layers().size(); ++i) {
            const int row = static_cast<int>(i);
            if (row >= list_->topLevelItemCount()) {
                auto* fresh = new QTreeWidgetItem(list_);
                fresh->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsEditable |
                                Qt::ItemIsUserCheckable);
            }
            QTreeWidgetItem& item = *list_->topLevelItem(row);
            item.setText(kName, QString::fromStdString(layers()[i].name));
            item.setCheckState(kVisible, layers()[i].visible ? Qt::Checked : Qt::Unchecked);
            item.setCheckState(kLocked, layers()[i].locked ? Qt::Checked : Qt::Unchecked);
            const auto strands = strandsOfLayer(document_.groom(), static_cast<std::uint32_t>(i)).size();
            item.setText(kStrands, QStringLiteral("%L1").arg(strands));
        }
        if (list_->currentItem() == nullptr) list_->setCurrentItem(list_->topLevelItem(0));
        showSettings();
        find<QPushButton>("layerRemove")->setEnabled(layers().size() > 1);
        find<QPushButton>("layerMove")->setEnabled(!selected().empty());
    }
    template <class W>
    W* find(const char* name) const {
        return findChild<W*>(QLatin1String(name));
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Messages& messages_;
    QTreeWidget* list_;
    QCheckBox* ownMaterial_;
    QVBoxLayout* settings_ = nullptr;
    std::optional<std::pair<std::uint32_t, bool>> shown_;  ///< layer, and whether it has its own material
};

}  // namespace

PanelInfo layersPanel() {
    return {"layers",
            QString("Layers"),
            "overlay",
            Qt::LeftDockWidgetArea,
            28,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({new LayersPanel(parts.document, parts.preferences, parts.messages)}));
            }};
}

}  // namespace hairloom::editor
