// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The window: viewport or start page in the middle, panels around it, tools at the left, menus.

#include <QActionGroup>
#include <QDockWidget>
#include <QMainWindow>
#include <QSet>
#include <QStackedWidget>
#include <optional>
#include <thread>

#include "core/groom/time_line.h"

#include "editor/document/autosave.h"
#include "editor/panels/panel.h"
#include "editor/shell/files.h"
#include "editor/shell/start_page.h"
#include "editor/shell/status_line.h"
#include "editor/style/actions.h"

namespace hairloom::editor {

class ManualWindow;

class MainWindow : public QMainWindow {
    Q_OBJECT

  public:
    MainWindow();
    ~MainWindow() override;

    PanelParts parts() {
        return {document_, preferences_, prices_,    tasks_, messages_,
                player_,   keying_,      *viewport_, tools_, *actions_};
    }
    DocumentFiles& files() { return files_; }
    Actions& actions() { return *actions_; }
    StatusLine& statusLine() { return *status_; }
    Autosave& autosave() { return *autosave_; }
    QDockWidget* panel(const QString& id) const;

    /// Opens a file of any kind; hair goes onto the head that is there, after a look at it.
    void open(const QString& path);
    /// Writes the project on a thread of its own and keeps the window alive meanwhile. Asks where others have
    /// to do with the file. False where the user cancelled or writing failed.
    bool saveTo(const QString& path);
    /// The program ends and nobody can be asked: what is unsaved is in a copy when this returns.
    void keepUnsaved();
    /// Shows the head of a file before it is opened; the dialog is window-modal and deletes itself. Nothing
    /// changes before it is accepted. `mayLeave`: what to do about unsaved changes has been asked.
    void showHeadDialog(const QString& path, bool mayLeave = false);
    /// A project names a file of its head that is not there.
    void askForHead(const QString& missing);
    /// Writes the steps since the document was opened as a script. False, with a word in the status line,
    /// where one cannot be in it or writing failed.
    bool saveScriptTo(const QString& path);
    /// Takes the time line of a file, or the keys of head and wind of a keyframe file. False, with a word in
    /// the status line, where it cannot be read or cannot play on this head.
    bool openTimeLine(const QString& path);
    bool saveTimeLine(const QString& path);
    /// Keys of head and wind alone.
    bool saveMotion(const QString& path);
    /// The overlays that are chosen, and those that come with the tool in hand.
    void drawOverlays(Marks& marks) const;
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
    void chooseGuidesByClustering();
    void fillGroupMenu();
    void addViewActions();
    void addOverlayActions(QMenu& menu);
    void addPlayActions();
    void addTimeLineActions(QMenu& menu);
    /// To the document, as a step that can be undone.
    bool setTimeLine(TimeLine line, const char* name);
    void takeShape();
    void addToolActions();
    void addHelpActions();
    void makePanels();
    void sizeColumns();
    void makeBars();
    void fillRecentMenu();
    void restoreLayout();
    void resetLayout();
    void showTitle();
    void showPage();
    void newDocument();
    void chooseAndOpen();
    void chooseAndImport();
    /// Asks how, with a preview.
    void importHair(const QString& path);
    bool save();
    bool saveAs();
    /// To the next version of its name; as saveAs() where it was never saved.
    bool saveIncremental();
    /// Whether a file may be replaced that other windows may have open.
    bool mayReplaceFile(const QString& path);
    Status write(const QString& path);
    Opening mayOpenProject(const QString& path);
    void reload();
    /// Says what other programs and windows have done to the project's file, once each time.
    void lookAtDisk();
    void chooseAndSaveScript();
    /// True where the document may go.
    bool mayLeaveDocument();
    bool runShortcut(int key, Qt::KeyboardModifiers modifiers);

    void frameSelection();
    void compareWith(const QString& path);
    void showSecurity();
    /// The manual, at the section on the panel or the tool that is used.
    void showManual();

    Preferences preferences_;
    Prices prices_;
    QtDocument document_;
    Tasks tasks_;
    Messages messages_;
    Player player_{document_};
    Keying keying_{document_, player_, messages_};
    DocumentFiles files_{document_, player_, preferences_, tasks_, messages_};
    ToolBox tools_;
    Viewport* viewport_;
    Actions* actions_;
    std::unique_ptr<Autosave> autosave_;
    QStackedWidget* pages_;
    StartPage* start_;
    StatusLine* status_;
    QMenu* recentMenu_ = nullptr;
    QMenu* panelMenu_ = nullptr;
    QSet<QDockWidget*> panelsBehind_;  ///< others, while their menu is open
    QMenu* groupMenu_ = nullptr;
    QActionGroup* toolGroup_;
    ManualWindow* manual_ = nullptr;  ///< made when it is first asked for
    QByteArray firstLayout_;
    Unsaved unsaved_ = Unsaved::Ask;
    bool isSaving_ = false;
    std::thread saver_;
    Status saved_;  ///< what the saver came to
    QString savingTo_;
    quint64 savingState_ = 0;
    FileVersion toldOf_;              ///< the change of the project's file that was told of
    std::size_t toldWindows_ = 0;     ///< other windows on the project that were told of
    std::optional<bool> shownEmpty_;  ///< what showPage() has made of the document
};

}  // namespace hairloom::editor
