// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/shell/main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QGridLayout>
#include <QMenuBar>
#include <QMimeData>
#include <QScreen>
#include <QSettings>
#include <QTimer>
#include <QToolBar>
#include <QToolButton>
#include <algorithm>

#include "core/base/write_rules.h"
#include "core/groom/time_line.h"
#include "editor/fields/input_rules.h"
#include "editor/fields/number_spin.h"
#include "editor/panels/panel.h"
#include "editor/shell/files.h"
#include "editor/style/icons.h"
#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

constexpr int kLayoutVersion = 2;
/// What the view has in a window of 1366 pixels, and what is wished of the two columns of panels beside it.
constexpr int kView_px = 700, kNarrowColumn_px = 280, kWideColumn_px = 360;
constexpr const char* kGeometry = "window/geometry";
constexpr const char* kLayout = "window/layout";

/// Two columns of buttons, of which one would be higher than small windows; tools that belong together by
/// their order are apart from the others.
QWidget* toolPalette(const QActionGroup& actions, const ToolBox& tools) {
    auto* palette = new QWidget;
    auto* grid = new QGridLayout(palette);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(0);
    int row = 0, column = 0, kind = 0;
    for (QAction* action : actions.actions()) {
        const Tool* tool = tools.find(action->objectName().section('.', 1));
        const int kindOfTool = tool ? tool->info().order / 100 : 0;
        if (kindOfTool != kind) {
            auto* line = new QFrame;
            line->setProperty("role", "line");
            line->setFixedHeight(1);
            row += column > 0 ? 1 : 0;
            grid->setRowMinimumHeight(row, 7);
            grid->addWidget(line, row++, 0, 1, 2, Qt::AlignVCenter);
            column = 0;
            kind = kindOfTool;
        }
        auto* button = new QToolButton;
        button->setIconSize({18, 18});
        button->setDefaultAction(action);
        grid->addWidget(button, row, column);
        row += column;
        column = 1 - column;
    }
    return palette;
}

}  // namespace

MainWindow::MainWindow()
    : actions_(new Actions(*this)), pages_(new QStackedWidget), toolGroup_(new QActionGroup(this)) {
    setObjectName("mainWindow");
    // Dialogs have the default, what is in the window has its own.
    QLocale::setDefault(numberLocale());
    setLocale(numberLocale());
    new InputRules(this);
    setWindowIcon(icon("hairloom"));
    setAcceptDrops(true);
    setDockNestingEnabled(true);
    setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
    // Along the side there is room for the whole names of all panels.
    setTabPosition(Qt::RightDockWidgetArea, QTabWidget::East);
    // All their names need the height of the window.
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    resize(QSize(1440, 900).boundedTo(screen()->availableSize()));
    // Inputs and what others write are kept as on the command line.
    if (!writeRules().keepInputs) setWriteRules({false, true, "give another name"});

    viewport_ = new Viewport(document_, preferences_);
    tools_.fill({document_, preferences_, messages_, player_, *viewport_});
    autosave_ = std::make_unique<Autosave>(document_, preferences_);
    start_ = new StartPage(files_, preferences_);
    status_ = new StatusLine(document_, preferences_, tasks_, messages_, player_, *viewport_);
    setStatusBar(status_);
    pages_->addWidget(start_);
    pages_->addWidget(viewport_);
    // What stands beside it fits into 856 pixels, then.
    pages_->setMinimumSize(240, 180);
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

    connect(&document_, &QtDocument::replaced, this, [this] { files_.forgetRecovered(); });
    connect(&document_, &QtDocument::saved, this, [this] { files_.discardRecovered(); });
    files_.onProject([this](const QString& path) { return mayOpenProject(path); });
    files_.onChangedMeanwhile([this] { return mayLeaveDocument(); });
    files_.onUnclearHead([this](const QString& path) { showHeadDialog(path, true); });
    files_.onMissingHead([this](const QString& file) { askForHead(file); });
    connect(start_, &StartPage::openRequested, this, &MainWindow::chooseAndOpen);
    connect(&document_, &QtDocument::titleChanged, this, &MainWindow::showTitle);
    connect(&document_, &QtDocument::changed, this, &MainWindow::showPage);
    connect(&preferences_, &Preferences::recentFilesChanged, this, &MainWindow::fillRecentMenu);
    const auto limitHistory = [this] {
        document_.setHistoryLimit(static_cast<std::size_t>(preferences_.undoMegabytes()) << 20u);
    };
    limitHistory();
    connect(&preferences_, &Preferences::changed, this, limitHistory);
    connect(&preferences_, &Preferences::changed, this, [this, theme = preferences_.theme()]() mutable {
        if (theme == preferences_.theme()) return;
        theme = preferences_.theme();
        applyTheme(*qApp, theme);
    });
    connect(autosave_.get(), &Autosave::failed, status_, &StatusLine::setStanding);
    connect(autosave_.get(), &Autosave::upToDate, status_, [this] { status_->setStanding({}); });
    // The session may end the program before anybody answers.
    connect(
        qApp, &QGuiApplication::commitDataRequest, this, [this] { keepUnsaved(); }, Qt::DirectConnection);
    connect(viewport_, &Viewport::keyPressed, this, &MainWindow::runShortcut);
    connect(viewport_, &Viewport::hintChanged, this, [this] {
        const Tool* tool = viewport_->tool();
        status_->setHint(tool ? tool->hint() : QString());
    });
    static_assert(static_cast<int>(SimulateOn::Cpu) == static_cast<int>(EngineWish::cpu));
    const auto chooseEngine = [this] {
        player_.setEngine(static_cast<EngineWish>(preferences_.simulateOn()));
    };
    player_.setRenderJobs(viewport_->renderJobs());
    chooseEngine();
    connect(&preferences_, &Preferences::changed, this, chooseEngine);
    connect(&tools_, &ToolBox::activeChanged, viewport_, &Viewport::setTool);
    connect(&player_, &Player::frameReady, this, [this] { viewport_->setPose(player_.pose()); });
    connect(&keying_, &Keying::changed, this, [this, had = false]() mutable {
        // What has just been keyed, or comes with the project, is seen.
        const bool has = !timeLineOf(document_.groom()).isEmpty();
        if (has && !had) panel("time_line")->show();
        had = has;
    });
    showTitle();
    fillRecentMenu();
    showPage();
}

MainWindow::~MainWindow() {
    tasks_.drop();
    tasks_.finish();
    // The viewport's last words would go to parts that are gone.
    viewport_->disconnect();
    player_.disconnect();
    delete viewport_;
    viewport_ = nullptr;
}

QDockWidget* MainWindow::panel(const QString& id) const {
    return findChild<QDockWidget*>("panel:" + id);
}

void MainWindow::makePanels() {
    QHash<int, QDockWidget*> lastIn;
    for (const PanelInfo& info : panels()) {
        auto* dock = new QDockWidget(info.title, this);
        dock->setObjectName("panel:" + info.id);
        dock->setWidget(info.make(parts()));
        dock->setMinimumWidth(240);
        addDockWidget(info.area, dock);
        if (QDockWidget* last = lastIn.value(info.area)) tabifyDockWidget(last, dock);
        lastIn[info.area] = dock;
        dock->setVisible(info.open);
        QAction* toggle = dock->toggleViewAction();
        toggle->setIcon(icon(info.icon));
        panelMenu_->addAction(toggle);
        connect(toggle, &QAction::triggered, this, [this, dock](bool on) {
            const bool wasBehind = panelsBehind_.contains(dock);
            if (!on && !wasBehind) return;
            dock->show();
            dock->raise();
        });
    }
    // A panel that is open behind another one comes to the front when it is chosen, and does not close.
    connect(panelMenu_, &QMenu::aboutToShow, this, [this] {
        panelsBehind_.clear();
        for (const PanelInfo& info : panels()) {
            QDockWidget* const dock = panel(info.id);
            if (dock->isVisible() && dock->visibleRegion().isEmpty()) panelsBehind_.insert(dock);
        }
    });
    connect(panelMenu_, &QMenu::aboutToHide, this,
            [this] { QTimer::singleShot(0, this, [this] { panelsBehind_.clear(); }); });
    // The first of each area is in front.
    QSet<int> seen;
    for (const PanelInfo& info : panels()) {
        if (seen.contains(info.area)) continue;
        seen.insert(info.area);
        panel(info.id)->raise();
    }
    sizeColumns();
}

/// Panels get what the view leaves of the window.
void MainWindow::sizeColumns() {
    constexpr int kTabs_px = 28;            // along the right side, which count as the column's
    constexpr int kBeside = 76 + kTabs_px;  // with the tools, and what parts all these
    const int width_px = std::clamp((width() - kView_px - kBeside) / 2, kNarrowColumn_px, kWideColumn_px);
    resizeDocks({panel("tool"), panel("look")}, {width_px, width_px + kTabs_px}, Qt::Horizontal);
}

void MainWindow::makeBars() {
    auto* main = addToolBar("Main");
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

    auto* tools = new QToolBar("Tools");
    tools->setObjectName("bar:tools");
    tools->setMovable(false);
    addToolBar(Qt::LeftToolBarArea, tools);
    tools->addWidget(toolPalette(*toolGroup_, tools_));
}

void MainWindow::restoreLayout() {
    const QSettings settings;
    restoreGeometry(settings.value(kGeometry).toByteArray());
    if (!restoreState(settings.value(kLayout).toByteArray(), kLayoutVersion)) sizeColumns();
}

void MainWindow::resetLayout() {
    restoreState(firstLayout_, kLayoutVersion);
    sizeColumns();
}

void MainWindow::showTitle() {
    setWindowTitle(QString("%1[*] – Hairloom").arg(document_.title()));
    setWindowModified(document_.isModified());
}

void MainWindow::showPage() {
    const bool empty = document_.isEmpty();
    if (shownEmpty_ == empty) return;
    shownEmpty_ = empty;
    pages_->setCurrentWidget(empty ? static_cast<QWidget*>(start_) : viewport_);
    // Nothing to work on: what would do nothing looks so.
    for (const PanelInfo& info : panels()) panel(info.id)->widget()->setEnabled(!empty);
    for (QAction* tool : toolGroup_->actions()) tool->setEnabled(!empty);
    for (const char* id :
         {"file.save", "file.saveAs", "file.saveIncremental", "file.revert", "file.saveScript", "file.import",
          "file.export", "file.render", "timeLine.open", "timeLine.save", "timeLine.saveMotion",
          "timeLine.clear", "play.toggle", "play.step", "play.stepBack", "play.reset", "view.frame",
          "view.turntable", "view.orthographic"}) {
        actions_->get(id).setEnabled(!empty);
    }
}

void MainWindow::fillRecentMenu() {
    recentMenu_->clear();
    for (const QString& path : preferences_.recentFiles()) {
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
    if (isSaving_ || !mayLeaveDocument()) {
        event->ignore();
        return;
    }
    autosave_->dismiss();
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
    if (event->type() == QEvent::PaletteChange) viewport_->redraw();
    if (event->type() == QEvent::ActivationChange && isActiveWindow()) lookAtDisk();
}

}  // namespace hairloom::editor
