// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The window: viewport or start page in the middle, panels around it, tools at the left, menus.

#include <QActionGroup>
#include <QDockWidget>
#include <QMainWindow>
#include <QStackedWidget>
#include <optional>

#include "editor/document/autosave.h"
#include "editor/session.h"
#include "editor/shell/actions.h"
#include "editor/shell/start_page.h"
#include "editor/shell/status_line.h"

namespace hairloom::editor {

class MainWindow : public QMainWindow {
    Q_OBJECT

  public:
    MainWindow();
    ~MainWindow() override;

    Session& session() { return session_; }
    Actions& actions() { return *actions_; }
    StatusLine& statusLine() { return *status_; }
    QDockWidget* panel(const QString& id) const;

    /// Opens a file of any kind; hair goes onto the head that is there, after a look at it.
    void open(const QString& path);
    /// False where the user cancelled or writing failed.
    bool saveTo(const QString& path);
    /// What to do about unsaved changes: answers without asking, for tests and scripts.
    enum class Unsaved { Ask, Save, Discard, Keep };
    void setUnsavedAnswer(Unsaved answer) { unsaved_ = answer; }

  protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;
    void changeEvent(QEvent* event) override;

  private:
    void addFileActions();
    void addEditActions();
    void addSelectActions();
    void fillGroupMenu();
    void addViewActions();
    void addPlayActions();
    void addToolActions();
    void addHelpActions();
    void makePanels();
    void makeBars();
    void fillRecentMenu();
    void restoreLayout();
    void resetLayout();
    void showTitle();
    void showPage();
    void newDocument();
    void chooseAndOpen();
    void chooseAndImport();
    bool save();
    bool saveAs();
    /// True where the document may go.
    bool mayLeaveDocument();
    bool runShortcut(int key, Qt::KeyboardModifiers modifiers);

    Session session_;
    Actions* actions_;
    std::unique_ptr<Autosave> autosave_;
    QStackedWidget* pages_;
    StartPage* start_;
    StatusLine* status_;
    QMenu* recentMenu_ = nullptr;
    QMenu* panelMenu_ = nullptr;
    QMenu* groupMenu_ = nullptr;
    QActionGroup* toolGroup_;
    QByteArray firstLayout_;
    Unsaved unsaved_ = Unsaved::Ask;
    std::optional<bool> shownEmpty_;  ///< what showPage() has made of the document
};

}  // namespace hairloom::editor
