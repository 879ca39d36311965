// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/shell/main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QSettings>
#include <QToolBar>

#include "editor/dialogs/import_dialog.h"
#include "editor/document/files.h"
#include "editor/panels/panel.h"
#include "editor/shell/icons.h"
#include "editor/shell/theme.h"

namespace hairloom::editor {
namespace {

constexpr int kLayoutVersion = 1;
constexpr const char* kGeometry = "window/geometry";
constexpr const char* kLayout = "window/layout";

}  // namespace

MainWindow::MainWindow()
    : actions_(new Actions(*this)), pages_(new QStackedWidget), toolGroup_(new QActionGroup(this)) {
    setObjectName("mainWindow");
    setWindowIcon(icon("hairloom"));
    setAcceptDrops(true);
    setDockNestingEnabled(true);
    setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
    resize(1440, 900);

    session_.viewport = new Viewport(session_.document, session_.preferences);
    session_.tools.fill(session_);
    autosave_ = std::make_unique<Autosave>(session_.document, session_.preferences);
    start_ = new StartPage(session_);
    status_ = new StatusLine(session_);
    setStatusBar(status_);
    pages_->addWidget(start_);
    pages_->addWidget(session_.viewport);
    setCentralWidget(pages_);

    addFileActions();
    addEditActions();
    addSelectActions();
    addViewActions();
    addPlayActions();
    addToolActions();
    makePanels();
    addHelpActions();
    makeBars();
    firstLayout_ = saveState(kLayoutVersion);
    restoreLayout();

    connect(start_, &StartPage::openRequested, this, &MainWindow::chooseAndOpen);
    connect(&session_.document, &Document::titleChanged, this, &MainWindow::showTitle);
    connect(&session_.document, &Document::changed, this, &MainWindow::showPage);
    connect(&session_.preferences, &Preferences::recentFilesChanged, this, &MainWindow::fillRecentMenu);
    connect(&session_.preferences, &Preferences::changed, this,
            [this, theme = session_.preferences.theme()]() mutable {
                if (theme == session_.preferences.theme()) return;
                theme = session_.preferences.theme();
                applyTheme(*qApp, theme);
            });
    connect(autosave_.get(), &Autosave::failed, &session_.messages, &Messages::warn);
    connect(session_.viewport, &Viewport::keyPressed, this, &MainWindow::runShortcut);
    connect(session_.viewport, &Viewport::hintChanged, this, [this] {
        const Tool* tool = session_.viewport->tool();
        status_->setHint(tool ? tool->hint() : QString());
    });
    connect(&session_.tools, &ToolBox::activeChanged, session_.viewport, &Viewport::setTool);
    connect(&session_.player, &Player::frameReady, this, [this] {
        const auto& frame = session_.player.frame();
        session_.viewport->setPose(frame ? frame->pose : nullptr);
    });
    showTitle();
    fillRecentMenu();
    showPage();
}

MainWindow::~MainWindow() {
    session_.tasks.cancel();
    session_.tasks.finish();
    // The viewport's last words would go to parts that are gone.
    session_.viewport->disconnect();
    session_.player.disconnect();
    delete session_.viewport;
    session_.viewport = nullptr;
}

QDockWidget* MainWindow::panel(const QString& id) const {
    return findChild<QDockWidget*>("panel:" + id);
}

void MainWindow::makePanels() {
    QHash<int, QDockWidget*> lastIn;
    for (const PanelInfo& info : panels()) {
        auto* dock = new QDockWidget(info.title, this);
        dock->setObjectName("panel:" + info.id);
        dock->setWidget(info.make(session_));
        dock->setMinimumWidth(240);
        addDockWidget(info.area, dock);
        if (QDockWidget* last = lastIn.value(info.area)) tabifyDockWidget(last, dock);
        lastIn[info.area] = dock;
        dock->setVisible(info.open);
        QAction* toggle = dock->toggleViewAction();
        toggle->setIcon(icon(info.icon));
        panelMenu_->addAction(toggle);
    }
    // The first of each area is in front.
    QSet<int> seen;
    for (const PanelInfo& info : panels()) {
        if (seen.contains(info.area)) continue;
        seen.insert(info.area);
        panel(info.id)->raise();
    }
    resizeDocks({panel("look")}, {360}, Qt::Horizontal);
}

void MainWindow::makeBars() {
    auto* main = addToolBar(tr("Main"));
    main->setObjectName("bar:main");
    main->setIconSize({20, 20});
    main->setMovable(false);
    for (const char* id : {"file.open", "file.save", "file.import", "file.export"})
        main->addAction(&actions_->get(id));
    main->addSeparator();
    for (const char* id : {"edit.undo", "edit.redo"}) main->addAction(&actions_->get(id));
    main->addSeparator();
    for (const char* id : {"play.toggle", "play.step", "play.reset"}) main->addAction(&actions_->get(id));
    main->addSeparator();
    for (const char* id : {"view.frame", "view.turntable", "view.orthographic"})
        main->addAction(&actions_->get(id));

    auto* tools = new QToolBar(tr("Tools"));
    tools->setObjectName("bar:tools");
    tools->setIconSize({20, 20});
    addToolBar(Qt::LeftToolBarArea, tools);
    tools->addActions(toolGroup_->actions());
}

void MainWindow::restoreLayout() {
    const QSettings settings;
    restoreGeometry(settings.value(kGeometry).toByteArray());
    restoreState(settings.value(kLayout).toByteArray(), kLayoutVersion);
}

void MainWindow::resetLayout() {
    restoreState(firstLayout_, kLayoutVersion);
}

void MainWindow::showTitle() {
    setWindowTitle(tr("%1[*] – Hairloom").arg(session_.document.title()));
    setWindowModified(session_.document.isModified());
}

void MainWindow::showPage() {
    const bool empty = session_.document.isEmpty();
    if (shownEmpty_ == empty) return;
    shownEmpty_ = empty;
    pages_->setCurrentWidget(empty ? static_cast<QWidget*>(start_) : session_.viewport);
    // Nothing to work on: what would do nothing looks so.
    for (const PanelInfo& info : panels()) panel(info.id)->widget()->setEnabled(!empty);
    for (QAction* tool : toolGroup_->actions()) tool->setEnabled(!empty);
    for (const char* id : {"file.save", "file.saveAs", "file.import", "file.export", "play.toggle",
                           "play.step", "play.reset", "view.frame", "view.turntable", "view.orthographic"}) {
        actions_->get(id).setEnabled(!empty);
    }
}

bool MainWindow::mayLeaveDocument() {
    if (!session_.document.isModified()) return true;
    Unsaved answer = unsaved_;
    if (answer == Unsaved::Ask) {
        const auto button = QMessageBox::question(
            this, tr("Unsaved changes"), tr("Save the changes to %1?").arg(session_.document.title()),
            QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
        answer = button == QMessageBox::Save      ? Unsaved::Save
                 : button == QMessageBox::Discard ? Unsaved::Discard
                                                  : Unsaved::Keep;
    }
    if (answer == Unsaved::Save) return save();
    return answer == Unsaved::Discard;
}

void MainWindow::newDocument() {
    if (!mayLeaveDocument()) return;
    session_.document.open({}, {}, {});
}

void MainWindow::open(const QString& path) {
    const bool ontoHead = session_.document.groom().scalp && kindOf(path) == FileKind::Strands;
    if (!ontoHead) {
        if (mayLeaveDocument()) openFile(session_, path);
        return;
    }
    ImportDialog dialog(session_, path, this);
    if (dialog.exec() == QDialog::Accepted) importStrandsInto(session_, path, dialog.options());
}

void MainWindow::chooseAndOpen() {
    const QString path = QFileDialog::getOpenFileName(this, tr("Open"), {}, openFilter());
    if (!path.isEmpty()) open(path);
}

void MainWindow::chooseAndImport() {
    const QString path = QFileDialog::getOpenFileName(this, tr("Import hair"), {}, strandFilter());
    if (path.isEmpty()) return;
    ImportDialog dialog(session_, path, this);
    if (dialog.exec() == QDialog::Accepted) importStrandsInto(session_, path, dialog.options());
}

bool MainWindow::saveTo(const QString& path) {
    if (auto saved = session_.document.save(path); !saved) {
        session_.messages.warn(QString::fromStdString(saved.error().message()));
        return false;
    }
    session_.preferences.addRecentFile(path);
    session_.messages.say(tr("%1 saved").arg(QFileInfo(path).fileName()));
    return true;
}

bool MainWindow::save() {
    return session_.document.path().isEmpty() ? saveAs() : saveTo(session_.document.path());
}

bool MainWindow::saveAs() {
    const QString name = session_.document.path().isEmpty()
                             ? QFileInfo(session_.document.title()).completeBaseName() + ".hairloom"
                             : session_.document.path();
    const QString path =
        QFileDialog::getSaveFileName(this, tr("Save"), name, tr("Hairloom projects (*.hairloom)"));
    return !path.isEmpty() && saveTo(path);
}

void MainWindow::fillRecentMenu() {
    recentMenu_->clear();
    for (const QString& path : session_.preferences.recentFiles()) {
        QAction* action = recentMenu_->addAction(QFileInfo(path).fileName());
        action->setToolTip(path);
        connect(action, &QAction::triggered, this, [this, path] { open(path); });
    }
    recentMenu_->setEnabled(!recentMenu_->isEmpty());
}

bool MainWindow::runShortcut(int key, Qt::KeyboardModifiers modifiers) {
    const QKeySequence pressed(QKeyCombination(modifiers & ~Qt::KeypadModifier, static_cast<Qt::Key>(key)));
    for (const ActionInfo& info : actions_->all()) {
        QAction& action = actions_->get(info.id);
        if (action.shortcut().isEmpty() || action.shortcut() != pressed || !action.isEnabled()) continue;
        action.trigger();
        return true;
    }
    return false;
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (!mayLeaveDocument()) {
        event->ignore();
        return;
    }
    QSettings settings;
    settings.setValue(kGeometry, saveGeometry());
    settings.setValue(kLayout, saveState(kLayoutVersion));
    event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    for (const QUrl& url : event->mimeData()->urls()) {
        if (url.isLocalFile()) event->acceptProposedAction();
    }
}

void MainWindow::dropEvent(QDropEvent* event) {
    for (const QUrl& url : event->mimeData()->urls()) {
        if (!url.isLocalFile()) continue;
        event->acceptProposedAction();
        open(url.toLocalFile());
        return;
    }
}

void MainWindow::changeEvent(QEvent* event) {
    QMainWindow::changeEvent(event);
    if (event->type() == QEvent::PaletteChange) session_.viewport->redraw();
}

}  // namespace hairloom::editor
