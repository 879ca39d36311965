// SPDX-License-Identifier: GPL-3.0-or-later
// Poses: other shapes of the hairstyle that simulated hair follows, and how far.
#include <QFileDialog>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/documents/open.h"
#include "core/editing/document.h"
#include "core/editing/pose_commands.h"
#include "core/editing/settings_commands.h"
#include "core/groom/poses.h"
#include "core/simulation/rest_positions.h"
#include "editor/document/words.h"
#include "editor/fields/field_form.h"
#include "editor/fields/number_spin.h"
#include "editor/fields/ramp_edit.h"
#include "editor/panels/key_this.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

enum Column { kName, kAmount };

class PosesPanel : public QWidget {
  public:
    PosesPanel(QtDocument& document, const Preferences& preferences, const Prices& prices, Messages& messages,
               Player& player, Keying& keying)
        : document_(document),
          preferences_(preferences),
          prices_(prices),
          messages_(messages),
          player_(player),
          keying_(keying),
          list_(new QTreeWidget),
          none_(new QLabel("Click Add, then Swap, groom the pose and swap back. Then set how far the hair "
                           "follows it.")),
          ramp_(new RampEdit) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        makeList();
        layout->addWidget(list_);
        none_->setWordWrap(true);
        layout->addWidget(none_);
        auto* first = new QHBoxLayout;
        first->addWidget(
            pushButton("poseAdd", "Add",
                       "Make a pose from the shape that the view shows: the authored one, or the "
                       "played frame",
                       [this] { put(freshPoseName(document_.groom())); }));
        first->addWidget(pushButton("poseUpdate", "Update",
                                    "Replace the shape of this pose by the shape that the view shows",
                                    [this] {
                                        if (const GroomPose* pose = shown()) put(pose->name);
                                    }));
        first->addWidget(
            pushButton("poseSwap", "Swap",
                       "Exchange the authored shape and the pose, to groom the pose with all tools. "
                       "Swap again when you are done",
                       [this] {
                           if (const GroomPose* pose = shown())
                               perform(editing::swapPose(model(), pose->name));
                       }));
        layout->addLayout(first);
        auto* second = new QHBoxLayout;
        second->addWidget(pushButton("poseImport", "From file…",
                                     "Make a pose from the shape of another project with the same strands",
                                     [this] { import(); }));
        second->addWidget(pushButton("poseRemove", "Remove", "Remove this pose. Its keys stay", [this] {
            if (const GroomPose* pose = shown()) perform(editing::removePose(model(), pose->name));
        }));
        layout->addLayout(second);
        settings_ = new QVBoxLayout;
        layout->addLayout(settings_);
        makeRamp();
        layout->addWidget(ramp_);
        connect(list_, &QTreeWidget::currentItemChanged, this, [this] { showSettings(); });
        connect(list_, &QTreeWidget::itemChanged, this, &PosesPanel::rename);
        connect(&document_, &QtDocument::replaced, this, [this] {
            shown_.reset();
            refresh();
        });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Physics | editing::Part::Strands)) refresh();
        });
        refresh();
    }

  private:
    const editing::Model& model() const { return document_.editing().model(); }
    const std::vector<GroomPose>& poses() const { return document_.groom().poses; }
    std::size_t chosen() const {
        return static_cast<std::size_t>(std::max(list_->indexOfTopLevelItem(list_->currentItem()), 0));
    }
    const GroomPose* shown() const { return chosen() < poses().size() ? &poses()[chosen()] : nullptr; }

    void makeList() {
        list_->setObjectName("poses");
        list_->setHeaderLabels({"Pose", "Amount"});
        list_->setRootIsDecorated(false);
        list_->setMinimumHeight(96);
        list_->header()->setStretchLastSection(false);
        list_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
        list_->header()->setSectionResizeMode(kAmount, QHeaderView::ResizeToContents);
        list_->setToolTip("Shapes that simulated hair follows. Double-click a name to rename a pose");
    }

    void makeRamp() {
        ramp_->setObjectName("poseRamp");
        ramp_->setToolTip(
            "<p><b>Share of the amount from root to tip</b></p><p>Drag a key to change how far the hair "
            "follows the pose there. Click the line to add a key. Right-click or press Delete to remove "
            "one. Arrow keys move the last key you touched.</p>");
        connect(ramp_, &RampEdit::begun, this, [this] { interaction_ = QtDocument::nextMergeKey(); });
        connect(ramp_, &RampEdit::edited, this, [this](const runtime::Ramp& ramp) {
            if (!shown()) return;
            std::vector<GroomPose> changed = poses();
            changed[chosen()].ramp = ramp;
            document_.performMerged(interaction_,
                                    [&](const editing::Model& now) -> std::unique_ptr<editing::Command> {
                                        auto made = editing::setPoses(now, changed, "Pose: ramp");
                                        if (made) return std::move(*made);
                                        messages_.warn(errorText(made.error()));
                                        return nullptr;
                                    });
        });
    }

    void perform(Result<std::unique_ptr<editing::Command>> command) {
        if (!command) return messages_.warn(errorText(command.error()));
        document_.perform(std::move(*command));
    }

    /// Of the frame that is played, else of the document.
    void put(const std::string& name) {
        const auto& frame = player_.frame();
        if (!frame) {
            perform(editing::poseOfShape(model(), name));
        } else if (frame->pose->positions_ws.size() != document_.groom().pointCount()) {
            return messages_.warn(
                "This frame is only on the GPU. Set the simulation to CPU (Edit ▸ Preferences)");
        } else {
            perform(editing::putPose(
                model(), name,
                restPositions(document_.groom(), frame->pose->positions_ws, frame->pose->head)));
        }
        choose(name);
    }

    void choose(const std::string& name) {
        if (const auto at = findPose(document_.groom(), name))
            list_->setCurrentItem(list_->topLevelItem(static_cast<int>(*at)));
    }

    void import() {
        const QString path =
            QFileDialog::getOpenFileName(this, "Pose from file", {}, "Hairloom projects (*.hairloom)");
        if (path.isEmpty()) return;
        auto other = openGroom(path.toStdString());
        if (!other) return messages_.warn(errorText(other.error()));
        const std::string name = freshPoseName(document_.groom());
        perform(editing::putPoseOf(model(), name, *other));
        choose(name);
    }

    void rename(QTreeWidgetItem* item, int column) {
        const auto index = static_cast<std::size_t>(list_->indexOfTopLevelItem(item));
        if (index >= poses().size()) return;
        if (column != kName) return refresh();  // the slider below sets it
        const std::string to = item->text(kName).trimmed().toStdString();
        if (!to.empty()) perform(editing::renamePose(model(), poses()[index].name, to));
        refresh();  // a name that is refused goes back
    }

    /// New controls only where another pose is chosen, so that a slider outlives its own drag.
    void showSettings() {
        const GroomPose* pose = shown();
        ramp_->setVisible(pose != nullptr);
        if (pose) ramp_->setRamp(pose->ramp);
        const auto now = pose ? std::optional(std::pair(chosen(), pose->name)) : std::nullopt;
        if (now == shown_) return;
        shown_ = now;
        while (QLayoutItem* item = settings_->takeAt(0)) {
            if (QWidget* form = item->widget()) {
                form->setParent(nullptr);  // gone at once; one of its controls may be what is talking
                form->deleteLater();
            }
            delete item;
        }
        if (!pose) return;
        auto* keys = new KeyThis(keying_, [track = poseAttribute(pose->name)](const char* setting) {
            return std::string_view(setting) == "poseAmount" ? track : std::string();
        });
        auto* form = new FieldForm(document_, preferences_, poseFields(chosen()), &prices_, keys);
        keys->setParent(form);
        settings_->addWidget(form);
    }

    void refresh() {
        const QSignalBlocker quiet(list_);
        while (list_->topLevelItemCount() > static_cast<int>(poses().size()))
            delete list_->takeTopLevelItem(list_->topLevelItemCount() - 1);
        for (std::size_t i = 0; i < poses().size(); ++i) {
            const int row = static_cast<int>(i);
            QTreeWidgetItem* item = list_->topLevelItem(row);
            if (!item) {
                item = new QTreeWidgetItem(list_);
                item->setFlags(item->flags() | Qt::ItemIsEditable);
            }
            item->setText(kName, QString::fromStdString(poses()[i].name));
            item->setText(kAmount, numberLocale().toString(static_cast<double>(poses()[i].amount), 'g', 3));
        }
        if (!list_->currentItem() && !poses().empty()) list_->setCurrentItem(list_->topLevelItem(0));
        none_->setVisible(poses().empty());
        for (const char* name : {"poseUpdate", "poseSwap", "poseRemove"})
            findChild<QPushButton*>(name)->setEnabled(!poses().empty());
        showSettings();
    }

    QtDocument& document_;
    const Preferences& preferences_;
    const Prices& prices_;
    Messages& messages_;
    Player& player_;
    Keying& keying_;
    QTreeWidget* list_;
    QLabel* none_;
    RampEdit* ramp_;
    QVBoxLayout* settings_ = nullptr;
    std::optional<std::pair<std::size_t, std::string>> shown_;  ///< pose whose settings are shown
    quint64 interaction_ = 0;                                   ///< one drag is one step of the history
};

}  // namespace

PanelInfo posesPanel() {
    return {"poses",
            QString("Poses"),
            "grow",
            Qt::RightDockWidgetArea,
            65,
            false,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({new PosesPanel(parts.document, parts.preferences, parts.prices,
                                                       parts.messages, parts.player, parts.keying)}));
            }};
}

}  // namespace hairloom::editor
