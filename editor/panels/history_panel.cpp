// SPDX-License-Identifier: GPL-3.0-or-later
// What was done, what can be done again, and the memory that it takes.
#include <QLabel>
#include <QListWidget>
#include <QVBoxLayout>

#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

class HistoryPanel : public QWidget {
  public:
    explicit HistoryPanel(QtDocument& document)
        : document_(document), list_(new QListWidget), memory_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(12, 8, 12, 12);
        list_->setObjectName("steps");
        list_->setToolTip("Click a step, or press Return, to undo or redo to it");
        memory_->setProperty("role", "dim");
        memory_->setToolTip("Memory limit of the undo history. Beyond it, the oldest steps are deleted");
        layout->addWidget(list_, 1);
        layout->addWidget(memory_);
        connect(list_, &QListWidget::itemClicked, this,
                [this](QListWidgetItem* item) { document_.goToStep(list_->row(item)); });
        connect(list_, &QListWidget::itemActivated, this,
                [this](QListWidgetItem* item) { document_.goToStep(list_->row(item)); });
        connect(&document_, &QtDocument::historyChanged, this, [this] { fill(); });
        connect(&document_, &QtDocument::replaced, this, [this] { fill(); });
        fill();
    }

  private:
    void fill() {
        list_->clear();
        list_->addItem("As opened");
        for (int step = 0; step < document_.stepCount(); ++step) {
            auto* item = new QListWidgetItem(document_.stepName(step));
            if (step >= document_.doneSteps()) {
                // Undone, and a click away.
                item->setForeground(palette().color(QPalette::PlaceholderText));
                QFont slanted = item->font();
                slanted.setItalic(true);
                item->setFont(slanted);
            }
            list_->addItem(item);
        }
        list_->setCurrentRow(document_.doneSteps());
        constexpr double kMega = 1 << 20;
        memory_->setText(QString("Memory: %1 of %2 MB")
                             .arg(static_cast<double>(document_.historyBytes()) / kMega, 0, 'f', 1)
                             .arg(static_cast<double>(document_.historyLimit()) / kMega, 0, 'f', 0));
    }

    QtDocument& document_;
    QListWidget* list_;
    QLabel* memory_;
};

}  // namespace

PanelInfo historyPanel() {
    return {"history",
            QString("History"),
            "history",
            Qt::LeftDockWidgetArea,
            40,
            true,
            [](const PanelParts& parts) -> QWidget* { return new HistoryPanel(parts.document); }};
}

}  // namespace hairloom::editor
