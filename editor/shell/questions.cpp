// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/shell/questions.h"

#include <QAbstractButton>
#include <QCoreApplication>
#include <QDateTime>
#include <QFileInfo>
#include <QLocale>
#include <QMessageBox>
#include <QPushButton>
#include <QStringList>
#include <chrono>

#include "editor/document/words.h"

namespace hairloom::editor {
namespace {

/// The buttons of a question in order; the last one is what Escape means.
struct Choice {
    const char* name;
    QString label;
    QString tip;
    QMessageBox::ButtonRole role;
};

/// Which of the choices was made.
int ask(QWidget* parent, const QString& title, const QString& text, const QString& more,
        std::initializer_list<Choice> choices) {
    QMessageBox box(QMessageBox::Warning, title, text, QMessageBox::NoButton, parent);
    box.setInformativeText(more);
    std::vector<QAbstractButton*> buttons;
    for (const Choice& choice : choices) {
        QPushButton* const button = box.addButton(choice.label, choice.role);
        button->setObjectName(choice.name);
        button->setToolTip(choice.tip);
        buttons.push_back(button);
    }
    box.setDefaultButton(static_cast<QPushButton*>(buttons.front()));
    box.setEscapeButton(buttons.back());
    box.exec();
    for (std::size_t i = 0; i < buttons.size(); ++i) {
        if (box.clickedButton() == buttons[i]) return static_cast<int>(i);
    }
    return static_cast<int>(buttons.size()) - 1;
}

QString nameOf(const QString& path) {
    return QFileInfo(path).fileName();
}

QString processesOf(const std::vector<OpenDocument>& windows) {
    QStringList processes;
    for (const OpenDocument& window : windows) processes += QString::number(window.process);
    processes.removeDuplicates();
    return processes.join(", ");
}

}  // namespace

QString securityText(const std::vector<std::pair<std::string, std::string>>& rows) {
    QStringList lines;
    for (const auto& [name, value] : rows) {
        const QString shown = labelOf(QString::fromStdString(name).section('_', 1).replace('_', ' '));
        if (name.starts_with("layer_"))
            lines += QString("Layer “%1”: %2").arg(shown, QString::fromStdString(value));
        if (name.starts_with("refuses_"))
            lines += (value == "true" ? QString("%1: refused") : QString("%1: NOT refused")).arg(shown);
    }
    return lines.join('\n');
}

QString timeText(std::filesystem::file_time_type time) {
    // Both clocks at once: libstdc++ 12 has no conversion between them.
    const auto ago = std::filesystem::file_time_type::clock::now() - time;
    const auto ago_ms = std::chrono::duration_cast<std::chrono::milliseconds>(ago).count();
    return QLocale().toString(QDateTime::currentDateTime().addMSecs(-ago_ms), QLocale::ShortFormat);
}

ChangedAnswer askAboutChangedProject(QWidget* parent, const QString& path) {
    const QString when = QLocale().toString(QFileInfo(path).lastModified(), QLocale::ShortFormat);
    const int choice = ask(
        parent, "Changed on disk", QString("%1 was saved by another program or window.").arg(nameOf(path)),
        QString("It was saved at %1, after you opened or saved it here. If you overwrite it, that version is "
                "lost.")
            .arg(when),
        {{"changedSaveAs", QString("Save &as…"), QString("Keep both: save yours to another file"),
          QMessageBox::AcceptRole},
         {"changedOverwrite", QString("&Overwrite"), QString("Keep only yours"),
          QMessageBox::DestructiveRole},
         {"changedReload", QString("&Reload"),
          QString("Keep only theirs: reload the file and discard your changes"),
          QMessageBox::DestructiveRole},
         {"changedCancel", QString("Cancel"), QString("Do not save"), QMessageBox::RejectRole}});
    return static_cast<ChangedAnswer>(choice);
}

ElsewhereAnswer askAboutOpenProject(QWidget* parent, const QString& path,
                                    const std::vector<OpenDocument>& windows) {
    const int choice =
        ask(parent, "Open in another window", QString("%1 is open in another window.").arg(nameOf(path)),
            QString("Process %1 has opened it. If both save, each warns you before it overwrites the other.")
                .arg(processesOf(windows)),
            {{"elsewhereOpen", QString("&Open anyway"), QString("Open the same file in this window, too"),
              QMessageBox::AcceptRole},
             {"elsewhereCopy", QString("Open a &copy"),
              QString("Open its content, and ask for another name when you save"), QMessageBox::ActionRole},
             {"elsewhereCancel", QString("Cancel"), QString("Do not open it"), QMessageBox::RejectRole}});
    return static_cast<ElsewhereAnswer>(choice);
}

bool askToReplaceOpenProject(QWidget* parent, const QString& path, const std::vector<OpenDocument>& windows) {
    return ask(parent, "Open in another window", QString("%1 is open in another window.").arg(nameOf(path)),
               QString("Process %1 has opened it. That window warns you when it saves. The current content "
                       "of the "
                       "file is replaced.")
                   .arg(processesOf(windows)),
               {{"replaceOverwrite", QString("&Overwrite"), QString("Replace the file"),
                 QMessageBox::DestructiveRole},
                {"replaceCancel", QString("Cancel"), QString("Do not save"), QMessageBox::RejectRole}}) == 0;
}

WaitingAnswer askAboutWaitingCopy(QWidget* parent, const QString& path, const RecoveryCopy& copy) {
    QString more = QString(
                       "A copy from %1 has the work that was not saved when the program ended. If you open "
                       "the saved project, the copy is kept and the start page shows it.")
                       .arg(timeText(copy.when));
    if (copy.isProjectChanged)
        more += ' ' + QString(
                          "Since then the project was saved by another program or window. The copy does not "
                          "have those changes.");
    const int choice =
        ask(parent, "Unsaved work", QString("There is unsaved work on %1.").arg(nameOf(path)), more,
            {{"waitingRecover", QString("&Recover"), QString("Recover the unsaved work"),
              QMessageBox::AcceptRole},
             {"waitingOpen", QString("&Open the saved project"), QString("Open the saved project"),
              QMessageBox::ActionRole},
             {"waitingCancel", QString("Cancel"), QString("Do not open it"), QMessageBox::RejectRole}});
    return static_cast<WaitingAnswer>(choice);
}

}  // namespace hairloom::editor
