// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The groups of a head's file, and what each is for.

#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <string>
#include <vector>

#include "core/geometry/scalp_mesh.h"
#include "editor/document/preferences.h"

namespace hairloom::editor {

enum class GroupRole { Head, LeftOut, Collide };

class GroupRoles : public QWidget {
    Q_OBJECT

  public:
    explicit GroupRoles(const Preferences& preferences, QWidget* parent = nullptr);

    /// Those among `helpers` are left out, the others the head's. changed() is not said.
    void setGroups(const ScalpMesh& mesh, const std::vector<std::string>& helpers);
    std::vector<std::string> groupsOf(GroupRole role) const;

  Q_SIGNALS:
    void changed();

  protected:
    /// The space bar in the list.
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void search(const QString& words);
    /// Of all that are selected and shown.
    void giveSelected(GroupRole role);
    /// `item`, with all that are selected where it is one of them, gets the role after its own.
    void giveNext(QTreeWidgetItem* item);
    void setRole(QTreeWidgetItem& item, GroupRole role) const;
    std::vector<QTreeWidgetItem*> selected() const;

    const Preferences& preferences_;
    QTreeWidget* list_;
    QLineEdit* search_;
    std::vector<QPushButton*> buttons_;
};

}  // namespace hairloom::editor
