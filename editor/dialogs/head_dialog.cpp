// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/head_dialog.h"

#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPointer>
#include <QToolButton>
#include <algorithm>
#include <utility>

#include "core/documents/open.h"
#include "core/editing/sphere_parts.h"
#include "editor/dialogs/group_roles.h"
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

ScalpMesh scaled(const ScalpMesh& mesh, float by) {
    std::vector<Vec3f> positions(mesh.positions().begin(), mesh.positions().end());
    for (Vec3f& position : positions) position *= by;
    return mesh.moved(std::move(positions));
}

}  // namespace

HeadDialog::HeadDialog(Tasks& tasks, const Preferences& preferences, const QString& path, QWidget* parent)
    : QDialog(parent),
      tasks_(tasks),
      preferences_(preferences),
      path_(path),
      unit_(new QButtonGroup(this)),
      up_(new QButtonGroup(this)),
      groups_(new GroupRoles(preferences)),
      spheres_(new QSpinBox),
      fit_(new QLabel),
      summary_(new QLabel),
      view_(new StrandPreview) {
    setObjectName("headDialog");
    setWindowTitle(QString("Head %1").arg(QFileInfo(path).fileName()));
    resize(820, 620);
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
    form->addRow("Unit", choices(*unit_, "headUnit", units,
                                 "Length of one unit in the file. FBX, glTF and most USD files state "
                                 "their unit, so it is fixed for them"));
    form->addRow("Up", choices(*up_, "headUp", {QString("Y"), QString("Z")},
                               "Up axis of the file. Change it if the head lies on its back"));
    side->addWidget(groups_, 1);
    spheres_->setObjectName("colliderSpheres");
    spheres_->setRange(1, static_cast<int>(editing::kMaxPartSpheres));
    spheres_->setValue(static_cast<int>(HeadImportOptions().colliderSpheres));
    spheres_->setKeyboardTracking(false);
    spheres_->setToolTip(
        "Number of spheres for all groups that collide, shared by area. Each group gets 1 to 64. More "
        "spheres fit closer and cost more");
    auto* colliders = new QFormLayout;
    colliders->addRow("Spheres", spheres_);
    side->addLayout(colliders);
    fit_->setObjectName("colliderFit");
    fit_->setProperty("role", "dim");
    fit_->setWordWrap(true);
    side->addWidget(fit_);
    open_ = acceptOrCancel(*this, *side, "Open", "Open the head as shown");
    open_->setObjectName("headOpen");
    setTabOrder(open_, view_);
    connect(unit_, &QButtonGroup::idClicked, this, &HeadDialog::refresh);
    connect(up_, &QButtonGroup::idClicked, this, &HeadDialog::refresh);
    connect(groups_, &GroupRoles::changed, this, &HeadDialog::refresh);
    connect(spheres_, &QSpinBox::valueChanged, this, &HeadDialog::fit);
    connect(&tasks_, &Tasks::stopped, this, [this] {
        const bool wasReading = std::exchange(reading_, false);
        fitting_ = false;
        if (!isRead_ && !wasReading && isVisible()) read();
        if (std::exchange(outdated_, false)) fit();
    });
    open_->setEnabled(false);
    read();
}

void HeadDialog::read() {
    summary_->setText("Reading…");
    using Read = std::pair<std::shared_ptr<const ImportedScene>, QString>;
    reading_ = tasks_.run<Read>(
        QString("Reading %1").arg(QFileInfo(path_).fileName()),
        [path = path_.toStdString()](TaskControl&) -> Result<Read> {
            auto scene = importSceneLoud(path, {});
            if (!scene) return Read{nullptr, errorText(scene.error())};
            return Read{std::make_shared<const ImportedScene>(std::move(*scene)), QString()};
        },
        [self = QPointer(this)](const Read& read) {
            if (!self) return;
            self->isRead_ = true;
            if (read.first) {
                self->take(read.first);
            } else {
                self->summary_->setText(read.second);
            }
        });
}

void HeadDialog::take(std::shared_ptr<const ImportedScene> scene) {
    scene_ = std::move(scene);
    const HeadGuess guess = guessHead(*scene_);
    const auto units = lengthUnits();
    statesUnit_ = scene_->statesUnit;
    const auto known = std::ranges::find_if(units, [&](const LengthUnit& u) {
        const bool isGuessed = !statesUnit_ && !guess.unit.empty();
        return isGuessed ? guess.unit == u.name : static_cast<float>(u.metres) == scene_->metresPerUnit;
    });
    if (known != units.end()) unit_->button(static_cast<int>(known - units.begin()))->setChecked(true);
    for (QAbstractButton* button : unit_->buttons()) {
        button->setEnabled(!statesUnit_);
        if (statesUnit_) button->setToolTip("The file states its unit, so it is fixed");
    }
    up_->button(guess.zUp ? 1 : 0)->setChecked(true);
    groups_->setGroups(scene_->mesh, guess.helpers);
    refresh();
}

float HeadDialog::metresPerUnit() const {
    if (statesUnit_ || unit_->checkedId() < 0) return scene_->metresPerUnit;
    return static_cast<float>(lengthUnits()[static_cast<std::size_t>(unit_->checkedId())].metres);
}

float HeadDialog::toMetres() const {
    return scene_ ? metresPerUnit() / scene_->metresPerUnit : 1;
}

HeadImportOptions HeadDialog::options() const {
    HeadImportOptions options;
    // What a file without a unit is read in needs no word.
    if (!statesUnit_ && toMetres() != 1) options.metresPerUnit = metresPerUnit();
    options.zUp = up_->checkedId() == 1;
    options.leaveOut = groups_->groupsOf(GroupRole::LeftOut);
    options.collideWith = groups_->groupsOf(GroupRole::Collide);
    options.colliderSpheres = static_cast<std::uint32_t>(spheres_->value());
    return options;
}

void HeadDialog::refresh() {
    if (!scene_) return;
    auto part = partOfHead(scene_->mesh, options());
    open_->setEnabled(part.has_value());
    head_ = part ? std::make_shared<const ScalpMesh>(scaled(*part, toMetres())) : nullptr;
    if (!part) {
        summary_->setText(errorText(part.error()));
    } else {
        const Vec3f size = head_->bounds().sizes();
        const auto odd = implausibleSize(static_cast<double>(size.maxCoeff()), 1);
        summary_->setText(
            QString("<p><b>%1</b> high, %2 wide, %3 deep</p><p>%L4 triangles</p>%5")
                .arg(lengthText(size.y(), preferences_), lengthText(size.x(), preferences_),
                     lengthText(size.z(), preferences_))
                .arg(head_->triangleCount())
                .arg(odd ? QString("<p>Unlikely size for a head: check the unit.</p>") : QString()));
    }
    fit();
}

void HeadDialog::fit() {
    if (fitting_) {
        outdated_ = true;
        tasks_.drop();
        return;
    }
    const HeadImportOptions wanted = options();
    spheres_->setEnabled(!wanted.collideWith.empty());
    view_->show(Groom(), head_);
    if (!scene_ || wanted.collideWith.empty()) {
        fit_->setText("No group is set to collide");
        return;
    }
    fit_->setText("Fitting spheres…");
    using Fit = std::pair<editing::SphereFit, QString>;
    fitting_ = tasks_.run<Fit>(
        "Fitting spheres",
        [scene = scene_, wanted, scale = toMetres()](TaskControl& control) -> Result<Fit> {
            auto fit = fitColliders(scaled(scene->mesh, scale), {}, wanted, control.cancelFlag());
            if (!fit) return Fit{{}, errorText(fit.error())};
            return Fit{std::move(*fit), {}};
        },
        [self = QPointer(this)](const Fit& fit) {
            if (!self) return;
            if (fit.second.isEmpty()) {
                self->show(fit.first);
            } else {
                self->fit_->setText(fit.second);
            }
        });
    outdated_ = !fitting_;  // other work is under way
}

void HeadDialog::show(const editing::SphereFit& fit) {
    const auto length = [this](float metres) {
        return lengthText(static_cast<double>(metres), preferences_);
    };
    fit_->setText(QString("%1 spheres: worst gap %2, mean %3, largest bulge %4")
                      .arg(fit.spheres.size())
                      .arg(length(fit.worstGap), length(fit.meanGap), length(fit.worstBulge)));
    view_->show(Groom(), head_, fit.spheres);
}

void HeadDialog::done(int result) {
    outdated_ = false;
    if (reading_ || fitting_) {
        reading_ ? tasks_.cancel() : tasks_.drop();
        tasks_.finish();
    }
    QDialog::done(result);
}

}  // namespace hairloom::editor
