// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pages of docs, which are in the program: read without a network, wherever it is installed.

#include <QDialog>
#include <QLineEdit>
#include <QListWidget>
#include <QTextBrowser>

namespace hairloom::editor {

/// Name of the manual's section on a panel, by its id; empty: the manual has none of its own.
QString manualSection(const QString& panel);

/// The name that links give a heading: "6. Simulate" is "6-simulate".
QString headingName(const QString& heading);

class ManualWindow : public QDialog {
    Q_OBJECT

  public:
    explicit ManualWindow(QWidget* parent = nullptr);

    /// A page ("manual.md", "formats/script.md") from its top or from a heading on.
    void open(const QString& page, const QString& heading = {});
    const QTextBrowser& text() const { return *text_; }

  private:
    void follow(const QUrl& link);
    void fillContents();
    void goTo(int block);
    /// Of the heading of that name; −1: there is none.
    int blockOf(const QString& heading) const;
    void search(bool backwards);

    QListWidget* contents_;
    QTextBrowser* text_;
    QLineEdit* search_;
};

}  // namespace hairloom::editor
