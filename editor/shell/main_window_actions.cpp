// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of the window: menus, shortcuts, tooltips.
#include <QApplication>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <algorithm>

#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "core/editing/take_shape.h"
#include "core/simulation/rest_positions.h"
#include "editor/dialogs/comparison_dialog.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/manual_window.h"
#include "editor/dialogs/preferences_dialog.h"
#include "editor/dialogs/render_dialog.h"
#include "editor/dialogs/shortcut_dialog.h"
#include "editor/document/words.h"
#include "editor/overlays/overlay_mode.h"
#include "editor/shell/main_window.h"
#include "editor/shell/questions.h"
#include "editor/style/icons.h"
#include "importers/reader_security.h"

namespace hairloom::editor {
namespace {

Box3f boundsOfSelection(const Groom& groom) {
    Box3f box;
    for (const std::uint32_t s : editing::strandsWithFlag(groom, attribute::kSelected)) {
        for (const Vec3f& point : groom.strand(s)) box.extend(point);
    }
    if (!box.isEmpty() || !groom.scalp) return box;
    for (const std::uint32_t face : groom.scalpSelection) {
        for (const std::uint32_t vertex : groom.scalp->triangles()[face]) {
            box.extend(groom.scalp->positions()[vertex]);
        }
    }
    return box;
}

}  // namespace

void MainWindow::frameSelection() {
    const Box3f box = boundsOfSelection(document_.groom());
    if (box.isEmpty()) {
        messages_.say("Nothing is selected");
        return;
    }
    Viewport& viewport = *viewport_;
    const float aspect =
        static_cast<float>(viewport.width()) / static_cast<float>(std::max(viewport.height(), 1));
    viewport.camera().frame(box, aspect);
    viewport.redraw();
}

void MainWindow::compareWith(const QString& path) {
    files_.compareWith(path, [this, name = QFileInfo(path).fileName()](const GroomComparison& comparison,
                                                                       ComparedParts parts) {
        // Beside the window, so that you can go through the list there.
        auto* dialog = new ComparisonDialog(comparison, parts, name, this);
        dialog->setAttribute(Qt::WA_DeleteOnClose);
        dialog->show();
    });
}

void MainWindow::addFileActions() {
    QMenu* menu = menuBar()->addMenu("&File");
    menu->setToolTipsVisible(true);
    const auto add = [&](const ActionInfo& info, std::function<void()> run) {
        menu->addAction(&actions_->add(info, std::move(run)));
    };
    add({"file.new", QString("&New"), "new", QString("Close the document and show the start page"),
         QKeySequence::New},
        [this] { newDocument(); });
    add({"file.open", QString("&Open…"), "open", QString("Open a project, a head or hair"),
         QKeySequence::Open},
        [this] { chooseAndOpen(); });
    add({"file.openHead", QString("Open &head…"), "",
         QString("Check the size, unit, axis and groups of a head before you open it"),
         QKeySequence("Ctrl+Shift+O")},
        [this] {
            const QString path = QFileDialog::getOpenFileName(this, "Open a head", {}, headFilter());
            if (!path.isEmpty()) showHeadDialog(path);
        });
    recentMenu_ = menu->addMenu(icon("history"), "Open &recent");
    recentMenu_->setToolTipsVisible(true);
    menu->addSeparator();
    add({"file.save", QString("&Save"), "save", QString("Save the project"), QKeySequence::Save},
        [this] { save(); });
    add({"file.saveAs", QString("Save &as…"), "", QString("Save the project to another file"),
         QKeySequence("Ctrl+Shift+S")},
        [this] { saveAs(); });
    add({"file.saveIncremental", QString("Save &incremental"), "",
         QString("Save the project as its next version: bob_v002 after bob or bob_v001"),
         QKeySequence("Ctrl+Alt+S")},
        [this] { saveIncremental(); });
    add({"file.revert",
         QString("Re&vert to saved"),
         "",
         QString("Reload the saved project. Asks before it discards changes"),
         {}},
        [this] {
            if (mayLeaveDocument()) reload();
        });
    add({"file.saveScript",
         QString("Save s&cript…"),
         "",
         QString("Save your steps since the document was opened, for hairloom-cli groom to replay"),
         {}},
        [this] { chooseAndSaveScript(); });
    menu->addSeparator();
    add({"file.import", QString("&Import hair…"), "import",
         QString("Preview strands from another program and import them onto the head"),
         QKeySequence("Ctrl+I")},
        [this] { chooseAndImport(); });
    add({"file.transfer",
         QString("&Transfer to another head…"),
         "",
         QString("Fit the hairstyle to the size and position of another head"),
         {}},
        [this] {
            const QString path = QFileDialog::getOpenFileName(this, "Transfer to a head", {}, headFilter());
            if (!path.isEmpty()) files_.transferTo(path);
        });
    add({"file.blend",
         QString("&Blend with hair…"),
         "",
         QString("Blend the shape of the hair with another hairstyle on the same head. The blend is a Sculpt "
                 "operator: change its weight and mask to adjust it"),
         {}},
        [this] {
            const QString path = QFileDialog::getOpenFileName(this, "Blend with hair", {}, blendFilter());
            if (!path.isEmpty()) files_.blendWith(path);
        });
    add({"file.compare",
         QString("&Compare with…"),
         "",
         QString("List what changed since another version of the hair: settings, layers, operators, strands"),
         {}},
        [this] {
            const QString path = QFileDialog::getOpenFileName(this, "Compare with", {}, blendFilter());
            if (!path.isEmpty()) compareWith(path);
        });
    add({"file.export", QString("&Export hair…"), "export",
         QString("Export the hair for a game, then read it back and compare"), QKeySequence("Ctrl+E")},
        [this] {
            ExportDialog dialog(document_, preferences_, tasks_, messages_, player_, this);
            if (dialog.exec() == ExportDialog::kWantsClustering) chooseGuidesByClustering();
        });
    add({"file.render", QString("Re&nder…"), "",
         QString("Render the view, a turntable or the simulation to images or an animation"),
         QKeySequence("F12")},
        [this] {
            RenderDialog dialog(*viewport_, player_, tasks_, messages_, document_, this);
            dialog.exec();
        });
    menu->addSeparator();
    add({"file.quit", QString("&Quit"), "", QString("Quit Hairloom"), QKeySequence("Ctrl+Q")},
        [this] { close(); });
}

void MainWindow::addEditActions() {
    QMenu* menu = menuBar()->addMenu("&Edit");
    menu->setToolTipsVisible(true);
    const auto add = [&](const ActionInfo& info, std::function<void()> run) -> QAction& {
        QAction& action = actions_->add(info, std::move(run));
        menu->addAction(&action);
        return action;
    };
    QAction& undo =
        add({"edit.undo", QString("&Undo"), "undo", QString("Undo the last step"), QKeySequence("Ctrl+Z")},
            [this] { document_.undo(); });
    QAction& redo = add({"edit.redo", QString("&Redo"), "redo", QString("Redo the last undone step"),
                         QKeySequence("Ctrl+Shift+Z")},
                        [this] { document_.redo(); });
    const auto enable = [this, &undo, &redo] {
        const QtDocument& document = document_;
        undo.setEnabled(document.doneSteps() > 0);
        redo.setEnabled(document.doneSteps() < document.stepCount());
        undo.setText(undo.isEnabled() ? QString("&Undo %1").arg(document.stepName(document.doneSteps() - 1))
                                      : QString("&Undo"));
        redo.setText(redo.isEnabled() ? QString("&Redo %1").arg(document.stepName(document.doneSteps()))
                                      : QString("&Redo"));
    };
    connect(&document_, &QtDocument::historyChanged, this, enable);
    connect(&document_, &QtDocument::replaced, this, enable);
    enable();
    menu->addSeparator();
    add({"edit.preferences", QString("&Preferences…"), "settings",
         QString("Theme, units, navigation, pen, autosave, undo memory"), QKeySequence("Ctrl+,")},
        [this] {
            PreferencesDialog dialog(preferences_, this);
            dialog.exec();
        });
    add({"edit.shortcuts",
         QString("&Keyboard shortcuts…"),
         "keyboard",
         QString("Show and change keyboard shortcuts"),
         {}},
        [this] {
            ShortcutDialog dialog(*actions_, this);
            dialog.exec();
        });
}

void MainWindow::addViewActions() {
    QMenu* menu = menuBar()->addMenu("&View");
    menu->setToolTipsVisible(true);
    const auto add = [&](const ActionInfo& info, std::function<void()> run) -> QAction& {
        QAction& action = actions_->add(info, std::move(run));
        menu->addAction(&action);
        return action;
    };
    add({"view.frame", QString("&Frame all"), "frame", QString("Frame all hair"), QKeySequence("Home")},
        [this] { viewport_->frameAll(); });
    add({"view.frameSelection", QString("Frame s&election"), "",
         QString("Frame the selected strands, or the selected part of the head if no strand is selected"),
         QKeySequence("Shift+Home")},
        [this] { frameSelection(); });
    const struct {
        const char *id, *text, *key;
        render::View view;
    } kViews[] = {
        {"view.front", "From the &front", "1", render::View::Front},
        {"view.back", "From the &back", "Ctrl+1", render::View::Back},
        {"view.left", "From the &left", "3", render::View::Left},
        {"view.right", "From the &right", "Ctrl+3", render::View::Right},
        {"view.top", "From &above", "7", render::View::Top},
        {"view.bottom", "From bel&ow", "Ctrl+7", render::View::Bottom},
        {"view.threeQuarter", "Three &quarters", "0", render::View::ThreeQuarter},
    };
    for (const auto& view : kViews) {
        add({view.id, QString(view.text), "", QString("View the head from this side"),
             QKeySequence(view.key)},
            [this, at = view.view] { viewport_->look(at); });
    }
    menu->addSeparator();
    QAction& ortho = add({"view.orthographic", QString("&Orthographic"), "ortho",
                          QString("Switch between perspective and orthographic"), QKeySequence("5"), true},
                         [] {});
    connect(&ortho, &QAction::toggled, viewport_, &Viewport::setOrthographic);
    QAction& turntable = add({"view.turntable", QString("&Turntable"), "turntable",
                              QString("Rotate the view around the head"), QKeySequence("Shift+T"), true},
                             [] {});
    connect(&turntable, &QAction::toggled, viewport_, &Viewport::setTurntable);
    menu->addSeparator();
    addOverlayActions(*menu);
    panelMenu_ = menu->addMenu("&Panels");
    panelMenu_->setObjectName("panels");
    add({"view.resetLayout", QString("Reset la&yout"), "", QString("Restore the default panel layout"), {}},
        [this] { resetLayout(); });
    add({"view.theme", QString("Light or &dark"), "theme", QString("Switch between the two themes"),
         QKeySequence("Ctrl+T")},
        [this] {
            Preferences& preferences = preferences_;
            preferences.setTheme(preferences.theme() == Theme::Dark ? Theme::Light : Theme::Dark);
        });
}

void MainWindow::addOverlayActions(QMenu& menu) {
    QMenu* overlays = menu.addMenu(icon("overlay"), "Ov&erlays");
    overlays->setToolTipsVisible(true);
    for (const OverlayMode& mode : overlayModes()) {
        QAction& action = actions_->add(
            {QString("overlay.") + mode.id, QString(mode.title), "", QString(mode.tip), {}, true}, [] {});
        connect(&action, &QAction::toggled, viewport_, [this] { viewport_->redraw(); });
        overlays->addAction(&action);
    }
    viewport_->addMarks([this](Marks& marks) { drawOverlays(marks); });
}

void MainWindow::drawOverlays(Marks& marks) const {
    const Tool* const tool = tools_.active();
    for (const OverlayMode& mode : overlayModes()) {
        const bool comes = tool && std::ranges::find(mode.tools, tool->info().id) != mode.tools.end();
        const bool isBare = mode.onBareHeads && document_.groom().strandCount() == 0;
        if (comes || isBare || actions_->get(QString("overlay.") + mode.id).isChecked())
            mode.draw({document_.groom(), *viewport_, player_}, marks);
    }
}

void MainWindow::addPlayActions() {
    QMenu* menu = menuBar()->addMenu("&Simulation");
    menu->setToolTipsVisible(true);
    const auto add = [&](const ActionInfo& info, std::function<void()> run) -> QAction& {
        QAction& action = actions_->add(info, std::move(run));
        menu->addAction(&action);
        return action;
    };
    QAction& toggle = add({"play.toggle", QString("&Play"), "play", QString("Play or pause the simulation"),
                           QKeySequence("Space")},
                          [this] { player_.isPlaying() ? player_.pause() : player_.play(); });
    add({"play.step", QString("&Step"), "step",
         QString("Advance the simulation by one frame, or the play head if it was moved"), QKeySequence(".")},
        [this] { player_.stepForward(); });
    add({"play.stepBack", QString("Step &back"), "step-back", QString("Move the play head back by one frame"),
         QKeySequence(",")},
        [this] { player_.scrubFrames(-1); });
    add({"play.reset", QString("&Reset to rest"), "reset", QString("Reset the hair to its authored shape"),
         QKeySequence("Shift+Space")},
        [this] { player_.reset(); });
    add({"play.take",
         QString("Set as rest s&hape"),
         "grow",
         QString("Makes the current hair the authored shape on the head at rest. It keeps this shape under "
                 "gravity"),
         {}},
        [this] { takeShape(); });
    menu->addSeparator();
    addTimeLineActions(*menu);
    connect(&player_, &Player::stateChanged, this, [this, &toggle] {
        toggle.setIcon(icon(player_.isPlaying() ? "pause" : "play"));
        toggle.setText(player_.isPlaying() ? QString("&Pause") : QString("&Play"));
    });
}

void MainWindow::takeShape() {
    player_.pause();
    const auto frame = player_.frame();
    if (!frame) {
        messages_.say("Play the simulation first: its current shape becomes the rest shape");
        return;
    }
    if (frame->pose->positions_ws.size() != document_.groom().pointCount()) {
        messages_.warn("This frame is only on the GPU. Set the simulation to CPU (Edit ▸ Preferences)");
        return;
    }
    const std::vector<Vec3f> shape =
        restPositions(document_.groom(), frame->pose->positions_ws, frame->pose->head);
    auto command = editing::takeShape(document_.editing().model(), shape, true);
    if (!command) {
        messages_.warn(errorText(command.error()));
        return;
    }
    player_.reset();
    document_.perform(std::move(*command));
    messages_.say("The current shape is now the rest shape");
}

void MainWindow::addToolActions() {
    QMenu* menu = menuBar()->addMenu("&Tools");
    menu->setToolTipsVisible(true);
    toolGroup_->setExclusive(true);
    const auto add = [&](const ActionInfo& info, Tool* tool) {
        QAction& action = actions_->add(info, [this, tool] { tools_.activate(tool); });
        toolGroup_->addAction(&action);
        menu->addAction(&action);
        connect(&tools_, &ToolBox::activeChanged, &action,
                [&action, tool](Tool* active) { action.setChecked(active == tool); });
    };
    add({"tool.view", QString("Move the view"), "navigate",
         QString("Drag to orbit, drag with the middle button to pan, scroll to zoom"), QKeySequence("Q"),
         true},
        nullptr);
    for (const auto& tool : tools_.all()) {
        const ToolInfo& info = tool->info();
        add({"tool." + info.id, info.name, info.icon, info.tip, info.shortcut, true}, tool.get());
    }
    actions_->get("tool.view").setChecked(true);
}

void MainWindow::addHelpActions() {
    QMenu* menu = menuBar()->addMenu("&Help");
    menu->setToolTipsVisible(true);
    menu->addAction(&actions_->add({"help.manual", QString("&Manual"), "",
                                    QString("Open the manual at the section on the panel that has the focus"),
                                    QKeySequence::HelpContents},
                                   [this] { showManual(); }));
    menu->addAction(&actions_->add(
        {"help.about", QString("&About Hairloom"), "hairloom", QString("Version and licence"), {}}, [this] {
            QMessageBox::about(
                this, "Hairloom",
                QString("<p><b>Hairloom %1</b></p><p>Hairstyles for games. GPL-3.0-or-later.</p>")
                    .arg(QCoreApplication::applicationVersion()));
        }));
    menu->addAction(
        &actions_->add({"help.security",
                        QString("&File reader sandbox…"),
                        "",
                        QString("Test what the process that reads imported files is kept from doing"),
                        {}},
                       [this] { showSecurity(); }));
}

void MainWindow::showManual() {
    QString section;
    for (const QWidget* at = QApplication::focusWidget(); at && section.isEmpty(); at = at->parentWidget()) {
        for (const PanelInfo& info : panels()) {
            if (at == panel(info.id)) section = manualSection(info.id);
        }
    }
    if (section.isEmpty() && tools_.active()) section = manualSection("tool");
    if (!manual_) manual_ = new ManualWindow(this);
    manual_->open("manual.md", section);
}

void MainWindow::showSecurity() {
    using Rows = std::vector<std::pair<std::string, std::string>>;
    tasks_.run<Rows>(
        "Testing the sandbox", [](TaskControl&) { return readerSecurity(); },
        [this](const Rows& rows) {
            auto* box = new QMessageBox(QMessageBox::Information, "File reader sandbox",
                                        "A separate process reads files from other programs. Tested "
                                        "on this system:",
                                        QMessageBox::Close, this);
            box->setObjectName("security");
            box->setInformativeText(securityText(rows));
            box->setAttribute(Qt::WA_DeleteOnClose);
            box->open();
        });
}

}  // namespace hairloom::editor
