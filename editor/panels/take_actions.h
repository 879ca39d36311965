// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The buttons of the Takes panel that make takes of the one that is selected.

#include <QPushButton>
#include <QWidget>
#include <filesystem>
#include <functional>

#include "editor/panels/panel.h"
#include "editor/panels/take_view.h"

namespace hairloom::editor {

class TakeActions : public QWidget {
    Q_OBJECT

  public:
    /// What the panel knows.
    struct Takes {
        std::function<QString()> selected;                                 ///< name; empty: none
        std::function<std::filesystem::path(const QString& name)> fileOf;  ///< empty: no take can be named so
        std::function<QString(const QString& stem)> freeName;              ///< that begins so
    };
    TakeActions(const PanelParts& parts, const TakeView& view, Takes takes, QWidget* parent = nullptr);

    void setActive(bool on);

  Q_SIGNALS:
    void made(const QString& name);

  private:
    void makeLoop();
    void resimulate();
    /// Where a take of that name goes; empty, and the reason is told, where it cannot.
    std::filesystem::path placeFor(const QString& name);
    void told(const QString& name, const QString& words, bool isWarning);

    QtDocument& document_;
    Tasks& tasks_;
    Messages& messages_;
    Player& player_;
    const TakeView& view_;
    Takes takes_;
    QPushButton *loop_, *resimulate_;
};

}  // namespace hairloom::editor
