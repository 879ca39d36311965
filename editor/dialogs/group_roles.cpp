// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/group_roles.h"

#include <QHeaderView>
#include <QKeyEvent>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <map>

#include "editor/fields/blocks.h"
#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

constexpr int kName = 0, kRole = 1, kRoleWidth_px = 90;

struct RoleWords {
    const char *name, *button, *word, *act, *tip;
};
constexpr std::array<RoleWords, 3> kWords{
    {{"groupHead", "Keep", "Head", "Use the selected groups as part of the head, where hair can grow",
      "Part of the head: visible, and hair can grow on it"},
     {"groupLeaveOut", "Leave out", "Left out", "Do not load the selected groups", "Not loaded"},
     {"groupCollide", "Collide with", "Collides",
      "Hide the selected groups and fit collision spheres to them, as for a collar or a hat",
      "Hidden, but hair collides with spheres fitted to it"}}};

GroupRole roleOf(const QTreeWidgetItem& item) {
    return static_cast<GroupRole>(item.data(kRole, Qt::UserRole).toInt());
}
const RoleWords& wordsOf(GroupRole role) {
    return kWords[static_cast<std::size_t>(role)];
}

}  // namespace

GroupRoles::GroupRoles(const Preferences& preferences, QWidget* parent)
    : QWidget(parent),
      preferences_(preferences),
      list_(new QTreeWidget),
      search_(searchBox("headSearch", "Search groups", "Filter groups by name", *list_)) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    layout->addWidget(search_);
    list_->setObjectName("headGroups");
    list_->setAccessibleName("Groups and their roles");
    list_->setHeaderLabels({"Group", "Role"});
    list_->headerItem()->setToolTip(
        kRole, "Click to change the role, or press the space bar to change all selected groups");
    list_->setRootIsDecorated(false);
    list_->setUniformRowHeights(true);
    list_->setAllColumnsShowFocus(true);
    list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
    list_->header()->setStretchLastSection(false);
    list_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
    list_->header()->setSectionResizeMode(kRole, QHeaderView::Fixed);
    list_->header()->resizeSection(kRole, kRoleWidth_px);
    layout->addWidget(list_, 1);
    auto* row = new QHBoxLayout;
    row->setSpacing(6);
    for (std::size_t role = 0; role < kWords.size(); ++role) {
        auto* button = pushButton(kWords[role].name, QString(kWords[role].button), QString(kWords[role].act),
                                  [this, role] { giveSelected(static_cast<GroupRole>(role)); });
        button->setEnabled(false);
        button->setAutoDefault(false);
        row->addWidget(button, 1);
        buttons_.push_back(button);
    }
    layout->addLayout(row);
    list_->installEventFilter(this);
    connect(list_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item, int column) {
        if (column == kRole) giveNext(item);
    });
    connect(list_, &QTreeWidget::itemSelectionChanged, this, [this] {
        for (QPushButton* button : buttons_) button->setEnabled(!selected().empty());
    });
    connect(search_, &QLineEdit::textChanged, this, &GroupRoles::search);
}

void GroupRoles::setGroups(const ScalpMesh& mesh, const std::vector<std::string>& helpers) {
    list_->clear();
    // Groups of one name cannot be told apart.
    std::map<std::string, std::size_t> faces;
    for (const std::uint32_t group : mesh.triangleGroups()) ++faces[mesh.groupNames()[group]];
    for (const std::string& name : mesh.groupNames()) {
        const auto count = faces.find(name);
        if (count == faces.end()) continue;
        auto* item = new QTreeWidgetItem(list_, {QString::fromStdString(name)});
        item->setToolTip(kName, QString("%1: %L2 triangles").arg(item->text(kName)).arg(count->second));
        const bool helper = std::ranges::find(helpers, name) != helpers.end();
        setRole(*item, helper ? GroupRole::LeftOut : GroupRole::Head);
        faces.erase(count);
    }
    if (QTreeWidgetItem* first = list_->topLevelItem(0))
        list_->setCurrentItem(first, kName, QItemSelectionModel::NoUpdate);
}

std::vector<std::string> GroupRoles::groupsOf(GroupRole role) const {
    std::vector<std::string> names;
    for (int row = 0; row < list_->topLevelItemCount(); ++row) {
        const QTreeWidgetItem& item = *list_->topLevelItem(row);
        if (roleOf(item) == role) names.push_back(item.text(kName).toStdString());
    }
    return names;
}

bool GroupRoles::eventFilter(QObject* watched, QEvent* event) {
    const bool isSpace =
        event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Space;
    if (watched != list_ || !isSpace) return QWidget::eventFilter(watched, event);
    giveNext(list_->currentItem());
    return true;
}

void GroupRoles::search(const QString& words) {
    for (int row = 0; row < list_->topLevelItemCount(); ++row) {
        QTreeWidgetItem* item = list_->topLevelItem(row);
        item->setHidden(!item->text(kName).contains(words, Qt::CaseInsensitive));
    }
    for (QPushButton* button : buttons_) button->setEnabled(!selected().empty());
}

std::vector<QTreeWidgetItem*> GroupRoles::selected() const {
    std::vector<QTreeWidgetItem*> items;
    for (QTreeWidgetItem* item : list_->selectedItems()) {
        if (!item->isHidden()) items.push_back(item);
    }
    return items;
}

void GroupRoles::giveSelected(GroupRole role) {
    for (QTreeWidgetItem* item : selected()) setRole(*item, role);
    Q_EMIT changed();
}

void GroupRoles::giveNext(QTreeWidgetItem* item) {
    if (!item || item->isHidden()) return;
    const auto next = static_cast<GroupRole>((static_cast<std::size_t>(roleOf(*item)) + 1) % kWords.size());
    if (item->isSelected()) return giveSelected(next);
    setRole(*item, next);
    Q_EMIT changed();
}

void GroupRoles::setRole(QTreeWidgetItem& item, GroupRole role) const {
    const ThemeColours colours = themeColours(preferences_.theme());
    const QColor colour = role == GroupRole::Head      ? colours.text
                          : role == GroupRole::LeftOut ? colours.dimText
                                                       : colours.caution;
    item.setData(kRole, Qt::UserRole, static_cast<int>(role));
    item.setText(kRole, QString(wordsOf(role).word));
    item.setToolTip(kRole, QString(wordsOf(role).tip));
    for (const int column : {kName, kRole}) item.setForeground(column, colour);
}

}  // namespace hairloom::editor
