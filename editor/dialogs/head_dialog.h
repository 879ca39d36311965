// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A look at the head of a file before it is opened: its size, unit, axis, groups and what hair collides with.

#include <QButtonGroup>
#include <QDialog>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "core/documents/head_import.h"
#include "editor/document/preferences.h"
#include "editor/document/tasks.h"

namespace hairloom::editor {

class GroupRoles;
class StrandPreview;

class HeadDialog : public QDialog {
    Q_OBJECT

  public:
    HeadDialog(Tasks& tasks, const Preferences& preferences, const QString& path, QWidget* parent = nullptr);

    /// As chosen; at first as guessed.
    HeadImportOptions options() const;

    /// Also stops what still runs: nothing shows it any more. Reading that the user has cancelled is said.
    void done(int result) override;

  private:
    /// Waits while other work runs.
    void read();
    void take(std::shared_ptr<const ImportedScene> scene);
    /// Size and picture of what the options leave, and then the spheres.
    void refresh();
    /// The spheres that the options lead to, off the interface thread; a later call takes the place of one
    /// that runs.
    void fit();
    void show(const editing::SphereFit& fit);
    float metresPerUnit() const;
    /// What the mesh as it was read is scaled by.
    float toMetres() const;

    Tasks& tasks_;
    const Preferences& preferences_;
    QString path_;
    std::shared_ptr<const ImportedScene> scene_;  ///< as read without options; null until then
    std::shared_ptr<const ScalpMesh> head_;       ///< what the options leave of it
    bool statesUnit_ = false;                     ///< the file does, and it stands
    bool reading_ = false, isRead_ = false;       ///< the file; isRead_ also where it cannot be
    bool fitting_ = false, outdated_ = false;     ///< what is being fitted serves no more
    QButtonGroup* unit_;
    QButtonGroup* up_;
    GroupRoles* groups_;
    QSpinBox* spheres_;
    QLabel* fit_;
    QLabel* summary_;
    StrandPreview* view_;
    QPushButton* open_;
};

}  // namespace hairloom::editor
