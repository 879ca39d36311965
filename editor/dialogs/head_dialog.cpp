// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/head_dialog.h"

#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPointer>
#include <QToolButton>
#include <algorithm>

#include "core/scene/open.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/length_text.h"
#include "editor/viewport/strand_preview.h"
#include "importers/length_unit.h"

namespace hairloom::editor {
namespace {

/// Buttons side by side of which one is down.
QWidget* choices(QButtonGroup& group, const QString& name, const QStringList& labels, const QString& tip) {
    auto* row = new QWidget;
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(2);
    for (const QString& label : labels) {
        auto* button = new QToolButton;
        button->setText(label);
        button->setCheckable(true);
        button->setObjectName(name + ":" + label);
        button->setToolTip(tip);
        group.addButton(button, static_cast<int>(group.buttons().size()));
        layout->addWidget(button);
    }
    layout->addStretch(1);
    group.button(0)->setChecked(true);
    return row;
}

}  // namespace

HeadDialog::HeadDialog(Tasks& tasks, const Preferences& preferences, const QString& path, QWidget* parent)
    : QDialog(parent),
      tasks_(tasks),
      preferences_(preferences),
      path_(path),
      unit_(new QButtonGroup(this)),
      up_(new QButtonGroup(this)),
      search_(new QLineEdit),
      groups_(new QListWidget),
      summary_(new QLabel),
      view_(new StrandPreview) {
    setObjectName("headDialog");
    setWindowTitle(tr("Head %1").arg(QFileInfo(path).fileName()));
    resize(820, 540);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(16);
    layout->addWidget(view_, 1);
    auto* side = new QVBoxLayout;
    layout->addLayout(side);
    summary_->setObjectName("headSize");
    summary_->setWordWrap(true);
    summary_->setFixedWidth(280);
    side->addWidget(summary_);
    auto* form = new QFormLayout;
    side->addLayout(form);
    QStringList units;
    for (const LengthUnit& unit : lengthUnits()) units.append(unit.name);
    form->addRow(tr("Unit"), choices(*unit_, "headUnit", units,
                                     tr("One unit of the file. FBX and glTF state theirs, which stands")));
    form->addRow(tr("Up"),
                 choices(*up_, "headUp", {tr("Y"), tr("Z")},
                         tr("Axis of the file that points up. A head on its back needs the other")));
    search_->setObjectName("headSearch");
    search_->setPlaceholderText(tr("Search groups"));
    search_->setToolTip(tr("Shows the groups whose names have these words"));
    side->addWidget(search_);
    groups_->setObjectName("headGroups");
    groups_->setToolTip(
        tr("Groups that are checked are shown, carry hair and collide with it; the others are left out"));
    side->addWidget(groups_, 1);
    open_ = acceptOrCancel(*this, *side, tr("Open"), tr("Opens the head as shown"));
    connect(search_, &QLineEdit::textChanged, this, &HeadDialog::search);
    connect(unit_, &QButtonGroup::idClicked, this, &HeadDialog::refresh);
    connect(up_, &QButtonGroup::idClicked, this, &HeadDialog::refresh);
    connect(groups_, &QListWidget::itemChanged, this, &HeadDialog::refresh);
    read();
}

void HeadDialog::read() {
    summary_->setText(tr("Reading…"));
    using Read = std::pair<std::shared_ptr<ImportedScene>, QString>;
    tasks_.run<Read>(
        tr("Reading %1").arg(QFileInfo(path_).fileName()),
        [path = path_.toStdString()](TaskControl&) -> Result<Read> {
            auto scene = importSceneLoud(path, {});
            if (!scene) return Read{nullptr, errorText(scene.error())};
            return Read{std::make_shared<ImportedScene>(std::move(*scene)), QString()};
        },
        [self = QPointer(this)](const Read& read) {
            if (!self) return;
            if (read.first) {
                self->take(std::move(*read.first));
            } else {
                self->summary_->setText(read.second);
            }
        });
}

void HeadDialog::take(ImportedScene scene) {
    scene_ = std::move(scene);
    guess_ = guessHead(*scene_);
    const auto units = lengthUnits();
    const auto known =
        std::ranges::find_if(units, [&](const LengthUnit& u) { return guess_.unit == u.name; });
    if (known != units.end()) unit_->button(static_cast<int>(known - units.begin()))->setChecked(true);
    up_->button(guess_.zUp ? 1 : 0)->setChecked(true);
    fillGroups();
    open_->setEnabled(true);
    refresh();
}

void HeadDialog::fillGroups() {
    const QSignalBlocker quiet(groups_);
    groups_->clear();
    const ScalpMesh& mesh = scene_->mesh;
    std::vector<std::size_t> faces(mesh.groupNames().size(), 0);
    for (const std::uint32_t group : mesh.triangleGroups()) ++faces[group];
    for (std::size_t g = 0; g < faces.size(); ++g) {
        const bool helper = std::ranges::find(guess_.helpers, mesh.groupNames()[g]) != guess_.helpers.end();
        auto* item = new QListWidgetItem(QString::fromStdString(mesh.groupNames()[g]), groups_);
        item->setToolTip(tr("%L1 triangles").arg(faces[g]));
        item->setCheckState(helper ? Qt::Unchecked : Qt::Checked);
    }
}

void HeadDialog::search(const QString& words) {
    for (int row = 0; row < groups_->count(); ++row) {
        QListWidgetItem* item = groups_->item(row);
        item->setHidden(!item->text().contains(words, Qt::CaseInsensitive));
    }
}

double HeadDialog::metresPerUnit() const {
    return lengthUnits()[static_cast<std::size_t>(std::max(unit_->checkedId(), 0))].metres;
}

HeadImportOptions HeadDialog::options() const {
    HeadImportOptions options;
    // Metres are what a file without a unit has.
    if (unit_->checkedId() > 0) options.metresPerUnit = static_cast<float>(metresPerUnit());
    options.zUp = up_->checkedId() == 1;
    for (int row = 0; row < groups_->count(); ++row) {
        if (groups_->item(row)->checkState() != Qt::Checked)
            options.leaveOut.push_back(groups_->item(row)->text().toStdString());
    }
    return options;
}

void HeadDialog::refresh() {
    if (!scene_) return;
    auto part = partOfHead(scene_->mesh, options());
    open_->setEnabled(part.has_value());
    if (!part) {
        summary_->setText(errorText(part.error()));
        return;
    }
    const auto scale = static_cast<float>(metresPerUnit());
    std::vector<Vec3f> positions(part->positions().begin(), part->positions().end());
    for (Vec3f& position : positions) position *= scale;
    const auto shown = std::make_shared<const ScalpMesh>(part->moved(std::move(positions)));
    const Vec3f size = shown->bounds().sizes();
    const auto odd = implausibleSize(static_cast<double>(size.maxCoeff()), 1);
    summary_->setText(tr("<p><b>%1</b> high, %2 wide, %3 deep</p><p>%L4 triangles</p>%5")
                          .arg(lengthText(size.y(), preferences_), lengthText(size.x(), preferences_),
                               lengthText(size.z(), preferences_))
                          .arg(shown->triangleCount())
                          .arg(odd ? tr("<p>That is neither a head nor a human.</p>") : QString()));
    view_->show(Groom(), shown);
}

}  // namespace hairloom::editor
