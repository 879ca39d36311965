// SPDX-License-Identifier: GPL-3.0-or-later
// Opening, saving and leaving, with the questions that these ask.
#include <QEventLoop>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <thread>

#include "core/base/output_file.h"
#include "core/base/write_rules.h"
#include "core/editing/document.h"
#include "core/groom/file/project_file.h"
#include "editor/dialogs/head_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "editor/document/publishing.h"
#include "editor/document/words.h"
#include "editor/shell/files.h"
#include "editor/shell/main_window.h"
#include "editor/shell/questions.h"

namespace hairloom::editor {

bool MainWindow::mayLeaveDocument() {
    if (!document_.isModified()) return true;
    Unsaved answer = unsaved_;
    if (answer == Unsaved::Ask) {
        const auto button = QMessageBox::question(
            this, "Unsaved changes", QString("Save the changes to %1?").arg(document_.title()),
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
    document_.open({}, {}, {});
}

void MainWindow::open(const QString& path) {
    const auto openIt = [this, path] {
        if (mayLeaveDocument()) files_.open(path);
    };
    if (!document_.groom().scalp) return openIt();
    files_.tellKind(path, [this, path, openIt](FileKind kind) {
        kind == FileKind::Strands ? importHair(path) : openIt();
    });
}

void MainWindow::importHair(const QString& path) {
    ImportDialog dialog(document_, tasks_, path, this);
    if (dialog.exec() == QDialog::Accepted) files_.importStrands(path, dialog.options());
}

void MainWindow::showHeadDialog(const QString& path, bool mayLeave) {
    auto* dialog = new HeadDialog(tasks_, preferences_, path, this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog, path, mayLeave] {
        if (mayLeave || mayLeaveDocument()) files_.openHead(path, dialog->options());
    });
    dialog->open();
}

void MainWindow::askForHead(const QString& missing) {
    auto* question = new QMessageBox(
        QMessageBox::Question, "Head not found",
        QString("The head file %1 no longer exists. Without it the hairstyle has neither skeleton nor clips.")
            .arg(missing),
        QMessageBox::NoButton, this);
    question->setObjectName("missingHead");
    question->setAttribute(Qt::WA_DeleteOnClose);
    QAbstractButton* find = question->addButton("Find it…", QMessageBox::AcceptRole);
    find->setObjectName("findHead");
    question->addButton("Continue without it", QMessageBox::RejectRole);
    connect(find, &QAbstractButton::clicked, this, [this, missing] {
        const QString path = QFileDialog::getOpenFileName(
            this, QString("Find %1").arg(QFileInfo(missing).fileName()), {}, headFilter());
        if (!path.isEmpty()) files_.findHead(path);
    });
    question->open();
}

void MainWindow::chooseAndOpen() {
    const QString path = QFileDialog::getOpenFileName(this, "Open", {}, openFilter());
    if (!path.isEmpty()) open(path);
}

void MainWindow::chooseAndImport() {
    const QString path = QFileDialog::getOpenFileName(this, "Import hair", {}, strandFilter());
    if (!path.isEmpty()) importHair(path);
}

bool MainWindow::mayReplaceFile(const QString& path) {
    const std::filesystem::path file = path.toStdString();
    if (!document_.path().isEmpty() && isSameProject(file, document_.path().toStdString())) return true;
    const auto windows = autosave_->otherWindowsWith(path);
    return windows.empty() || askToReplaceOpenProject(this, path, windows);
}

/// The document may be drawn and played meanwhile; what people do waits.
Status MainWindow::write(const QString& path) {
    QEventLoop loop;
    isSaving_ = true;
    savingTo_ = path;
    savingState_ = document_.editing().state();
    autosave_->pause(true);
    saver_ = std::thread([this, &loop, groom = document_.groom(), file = path.toStdString()] {
        {
            const std::lock_guard lock(autosave_->writing());
            saved_ = saveProject(groom, file);
        }
        QMetaObject::invokeMethod(&loop, &QEventLoop::quit, Qt::QueuedConnection);
    });
    loop.exec(QEventLoop::ExcludeUserInputEvents);
    if (saver_.joinable()) saver_.join();
    isSaving_ = false;
    return saved_;
}

void MainWindow::keepUnsaved() {
    if (saver_.joinable()) {
        saver_.join();
        if (saved_) document_.noteSaved(savingTo_, savingState_);
    }
    autosave_->keep();
}

bool MainWindow::saveTo(const QString& path) {
    if (isSaving_) return false;
    if (const std::filesystem::path file = path.toStdString(); isChangedByOthers(file)) {
        switch (askAboutChangedProject(this, path)) {
            case ChangedAnswer::SaveAs:
                return saveAs();
            case ChangedAnswer::Overwrite:
                noteInput(file, fileVersion(file));
                break;
            case ChangedAnswer::Reload:
                reload();
                return false;
            case ChangedAnswer::Cancel:
                return false;
        }
    }
    if (!mayReplaceFile(path)) return false;
    messages_.say(QString("Saving %1").arg(QFileInfo(path).fileName()));
    const Status written = write(path);
    if (written) document_.noteSaved(path, savingState_);
    autosave_->pause(false);
    if (!written) {
        messages_.warn(errorText(written.error()));
        return false;
    }
    preferences_.addRecentFile(path);
    messages_.say(QString("%1 saved").arg(QFileInfo(path).fileName()));
    return true;
}

bool MainWindow::save() {
    return document_.path().isEmpty() ? saveAs() : saveTo(document_.path());
}

bool MainWindow::saveAs() {
    const QString name = document_.path().isEmpty()
                             ? QFileInfo(document_.title()).completeBaseName() + ".hairloom"
                             : document_.path();
    const QString path = QFileDialog::getSaveFileName(this, "Save", name, "Hairloom projects (*.hairloom)");
    return !path.isEmpty() && saveTo(withNextVersion(path));
}

bool MainWindow::saveIncremental() {
    return document_.path().isEmpty() ? saveAs() : saveTo(nextVersionOf(document_.path()));
}

bool MainWindow::saveScriptTo(const QString& path) {
    const auto script = document_.editing().script();
    const Status saved =
        script ? writeFileAtomically(path.toStdString(), *script) : Status(tl::unexpected(script.error()));
    if (!saved) {
        messages_.warn(QString("No script: %1").arg(errorText(saved.error())));
        return false;
    }
    messages_.say(QString("%1: %L2 steps").arg(QFileInfo(path).fileName()).arg(document_.doneSteps()));
    return true;
}

void MainWindow::chooseAndSaveScript() {
    const QString name = QFileInfo(document_.title()).completeBaseName() + ".json";
    const QString path = QFileDialog::getSaveFileName(this, "Save script", name, "Scripts (*.json)");
    if (!path.isEmpty()) saveScriptTo(path);
}

Opening MainWindow::mayOpenProject(const QString& path) {
    for (const RecoveryCopy& copy : recoveryCopies()) {
        const bool isOfIt =
            !copy.of.project.empty() && !copy.isOlder && isSameProject(copy.of.project, path.toStdString());
        if (!isOfIt) continue;
        const WaitingAnswer answer = askAboutWaitingCopy(this, path, copy);
        if (answer == WaitingAnswer::Cancel) return Opening::Not;
        if (answer == WaitingAnswer::Recover) {
            files_.openRecovered(copy);
            return Opening::Not;
        }
        break;
    }
    const auto windows = autosave_->otherWindowsWith(path);
    if (windows.empty()) return Opening::AsItself;
    switch (askAboutOpenProject(this, path, windows)) {
        case ElsewhereAnswer::Open:
            return Opening::AsItself;
        case ElsewhereAnswer::OpenCopy:
            return Opening::AsCopy;
        case ElsewhereAnswer::Cancel:
            break;
    }
    return Opening::Not;
}

void MainWindow::reload() {
    if (document_.path().isEmpty()) return messages_.say("This document was never saved");
    files_.reload();
}

void MainWindow::lookAtDisk() {
    const std::filesystem::path file = document_.path().toStdString();
    if (file.empty() || isSaving_) return;
    const QString name = document_.title();
    if (const FileVersion now = fileVersion(file); isChangedByOthers(file) && now != toldOf_) {
        toldOf_ = now;
        return messages_.warn(
            QString("%1 was saved by another program or window. Saving will ask what to do, and "
                    "File ▸ Revert to saved opens that version")
                .arg(name));
    }
    const std::size_t windows = autosave_->otherWindows().size();
    if (windows > toldWindows_)
        messages_.warn(
            QString("%1 is also open in another window. Each window warns you before it overwrites the other")
                .arg(name));
    toldWindows_ = windows;
}

}  // namespace hairloom::editor
