// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects of the engine run, why, and what each costs, while the simulation plays.
#include <QHeaderView>
#include <QLabel>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "editor/fields/field.h"
#include "editor/panels/list.h"
#include "editor/panels/panel.h"
#include "editor/panels/stability_gauge.h"
#include "editor/session.h"

namespace hairloom::editor {
namespace {

class EffectsPanel : public QWidget {
  public:
    explicit EffectsPanel(Session& session) : session_(session), table_(new QTreeWidget), note_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        table_->setObjectName("effects");
        table_->setHeaderLabels({tr("Effect"), tr("ms"), tr("MB"), tr("Why")});
        table_->setRootIsDecorated(false);
        table_->setMinimumHeight(320);
        table_->header()->resizeSection(0, 92);
        table_->header()->resizeSection(1, 56);
        table_->header()->resizeSection(2, 48);
        table_->setToolTip(tr(
            "Milliseconds a frame, summed over threads; megabytes of its own; and why it runs or does not"));
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        layout->addWidget(table_, 1);
        layout->addWidget(note_);
        connect(&session_.player, &Player::frameReady, this, &EffectsPanel::refresh);
        refresh();
    }

  private:
    void refresh() {
        const auto& frame = session_.player.frame();
        note_->setText(frame ? tr("Mean of %L1 frames").arg(frame->stats.frames)
                             : tr("Play the simulation (Space) to see what runs."));
        const std::size_t rows = frame ? frame->stats.effects.size() : 0;
        while (table_->topLevelItemCount() > static_cast<int>(rows)) delete table_->takeTopLevelItem(0);
        while (table_->topLevelItemCount() < static_cast<int>(rows))
            table_->addTopLevelItem(new QTreeWidgetItem);
        for (std::size_t i = 0; i < rows; ++i) {
            const EffectReport& effect = frame->stats.effects[i];
            QTreeWidgetItem* const item = table_->topLevelItem(static_cast<int>(i));
            item->setText(0, labelOf(QString::fromStdString(effect.name)));
            item->setText(1, effect.on ? QString::number(effect.milliseconds, 'f', 3) : QStringLiteral("–"));
            item->setText(2, effect.on ? QString::number(static_cast<double>(effect.bytes) / 1e6, 'f', 1)
                                       : QStringLiteral("–"));
            item->setText(3, QString::fromStdString(effect.why));
            item->setToolTip(3, item->text(3));
            item->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
            item->setTextAlignment(2, Qt::AlignRight | Qt::AlignVCenter);
            const QColor colour =
                palette().color(effect.on ? QPalette::Active : QPalette::Disabled, QPalette::Text);
            for (int c = 0; c < 4; ++c) item->setForeground(c, colour);
        }
    }

    Session& session_;
    QTreeWidget* table_;
    QLabel* note_;
};

}  // namespace

QWidget* makeEffectsPanel(Session& session) {
    return scrolled(column({heading(QObject::tr("Stability")), new StabilityGauge(session),
                            heading(QObject::tr("Effects")), new EffectsPanel(session)}));
}

}  // namespace hairloom::editor
