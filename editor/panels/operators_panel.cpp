// SPDX-License-Identifier: GPL-3.0-or-later
// The stack of operators: a list in the order in which they act, and the settings of the one that is chosen.
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"
#include "editor/fields/field_form.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

/// What the widest settings need, of vectors: the view must not jump when an operator is chosen.
constexpr int kWidth_px = 344;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

class OperatorsPanel : public QWidget {
  public:
    OperatorsPanel(QtDocument& document, const Preferences& preferences, Messages& messages)
        : document_(document), preferences_(preferences), messages_(messages), list_(new QListWidget) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        setMinimumWidth(kWidth_px);
        auto* first = new QHBoxLayout;
        first->addWidget(makeAddButton());
        first->addWidget(pushButton("operatorBake", tr("Bake"),
                                    tr("Makes the hair as it is all there is; the operators are gone"),
                                    [this] { perform(editing::bakeOperators(model()), kNone); }));
        layout->addLayout(first);
        list_->setObjectName("operators");
        list_->setMinimumHeight(150);
        list_->setToolTip(
            tr("What makes the hair out of its base shape, from the first on; unchecked ones do "
               "nothing. Brush strokes go to a sculpt at the end."));
        layout->addWidget(list_);
        layout->addLayout(makeEditButtons());
        settings_ = new QVBoxLayout;
        layout->addLayout(settings_);
        layout->addStretch(1);
        connect(list_, &QListWidget::currentRowChanged, this, [this] { showSettings(); });
        connect(list_, &QListWidget::itemChanged, this, [this](QListWidgetItem* item) {
            mute(static_cast<std::size_t>(list_->row(item)), item->checkState() != Qt::Checked);
        });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Operators)) refresh();
        });
        connect(&document_, &QtDocument::replaced, this, [this] { chosen_ = kNone; });
        refresh();
    }

  private:
    const editing::Model& model() const { return document_.editing().model(); }
    const std::vector<Operator>& operators() const { return document_.groom().operators; }
    static QString labelOf(const Operator& one) {
        return hairloom::editor::labelOf(QString::fromStdString(one.op).replace('_', ' '));
    }
    static QString sentence(std::string_view words) {
        QString text = QString::fromUtf8(words.data(), static_cast<qsizetype>(words.size()));
        if (!text.isEmpty()) text[0] = text[0].toUpper();
        return text;
    }

    QWidget* makeAddButton() {
        auto* add = new QPushButton(tr("Add"));
        add->setObjectName("operatorAdd");
        add->setToolTip(tr("Adds an operator behind the chosen one"));
        auto* menu = new QMenu(add);
        menu->setToolTipsVisible(true);
        for (const StackOperator& known : stackOperators()) {
            const std::string name(known.name);
            QAction* action = menu->addAction(labelOf(newOperator(name)));
            action->setToolTip(sentence(known.meaning));
            connect(action, &QAction::triggered, this, [this, name] {
                const std::size_t at = chosen() == kNone ? operators().size() : chosen() + 1;
                perform(editing::addOperator(model(), at, newOperator(name)), at);
            });
        }
        add->setMenu(menu);
        return add;
    }

    QLayout* makeEditButtons() {
        auto* row = new QHBoxLayout;
        row->addWidget(
            pushButton("operatorUp", tr("Earlier"), tr("Lets it act before the one above it"), [this] {
                if (chosen() != kNone && chosen() > 0) move(chosen() - 1);
            }));
        row->addWidget(
            pushButton("operatorDown", tr("Later"), tr("Lets it act after the one below it"), [this] {
                if (chosen() != kNone && chosen() + 1 < operators().size()) move(chosen() + 1);
            }));
        row->addWidget(
            pushButton("operatorCopy", tr("Duplicate"), tr("Adds the same again behind it"), [this] {
                if (chosen() != kNone) perform(editing::copyOperator(model(), chosen()), chosen() + 1);
            }));
        row->addWidget(pushButton("operatorRemove", tr("Remove"), tr("Takes the operator away"), [this] {
            if (chosen() != kNone) perform(editing::removeOperator(model(), chosen()), chosen());
        }));
        return row;
    }

    std::size_t chosen() const {
        const int row = list_->currentRow();
        return row < 0 || static_cast<std::size_t>(row) >= operators().size() ? kNone
                                                                              : static_cast<std::size_t>(row);
    }

    /// `then` is chosen when it is done.
    void perform(editing::StackCommand command, std::size_t then) {
        if (!command) {
            messages_.warn(QString::fromStdString(command.error().message()));
            return;
        }
        document_.perform(std::move(*command));
        if (then != kNone) list_->setCurrentRow(std::min(static_cast<int>(then), list_->count() - 1));
    }
    void move(std::size_t to) { perform(editing::moveOperator(model(), chosen(), to), to); }
    void mute(std::size_t index, bool muted) {
        if (index >= operators().size() || operators()[index].enabled == !muted) return;
        Operator changed = operators()[index];
        changed.enabled = !muted;
        const QString name = (muted ? tr("Mute %1") : tr("Unmute %1")).arg(labelOf(changed));
        perform(editing::setOperator(model(), index, changed, name.toStdString()), index);
        refresh();  // where it failed, the check goes back
    }

    void refresh() {
        const int row = list_->currentRow();
        {
            const QSignalBlocker quiet(list_);
            while (list_->count() > static_cast<int>(operators().size()))
                delete list_->takeItem(list_->count() - 1);
            for (std::size_t i = 0; i < operators().size(); ++i) {
                if (static_cast<int>(i) >= list_->count()) list_->addItem(QString());
                QListWidgetItem& item = *list_->item(static_cast<int>(i));
                const Operator& one = operators()[i];
                item.setText(labelOf(one));
                item.setToolTip(sentence(findStackOperator(one.op)->meaning));
                item.setCheckState(one.enabled ? Qt::Checked : Qt::Unchecked);
            }
            if (list_->count() > 0) list_->setCurrentRow(std::clamp(row, 0, list_->count() - 1));
        }
        showSettings();
    }

    /// New controls only where another operator is chosen, so that a slider outlives its own drag.
    void showSettings() {
        const std::size_t index = chosen();
        const std::string op = index == kNone ? std::string() : operators()[index].op;
        if (index == chosen_ && op == shown_) return;
        chosen_ = index;
        shown_ = op;
        while (QLayoutItem* item = settings_->takeAt(0)) {
            if (QWidget* form = item->widget()) {
                form->setParent(nullptr);  // gone at once; one of its controls may be what is talking
                form->deleteLater();
            }
            delete item;
        }
        if (index == kNone) return;
        const auto failed = [this](const QString& words) { messages_.warn(words); };
        settings_->addWidget(heading(labelOf(operators()[index])));
        settings_->addWidget(
            new FieldForm(document_, preferences_, operatorFields(document_.groom(), index, failed)));
        if (!findStackOperator(op)->hasRegion) return;
        auto* region =
            new FieldForm(document_, preferences_, operatorRegionFields(document_.groom(), index, failed));
        settings_->addWidget(collapsible(tr("Region"), region, false));
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Messages& messages_;
    QListWidget* list_;
    QVBoxLayout* settings_ = nullptr;
    std::size_t chosen_ = kNone;
    std::string shown_;
};

}  // namespace

PanelInfo operatorsPanel() {
    return {
        "operators",
        QObject::tr("Operators"),
        "comb",
        Qt::LeftDockWidgetArea,
        25,
        true,
        [](const PanelParts& parts) -> QWidget* {
            return scrolled(column({new OperatorsPanel(parts.document, parts.preferences, parts.messages)}));
        }};
}

}  // namespace hairloom::editor
