// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects of the engine run, why, and what each costs; each can be left out for a try.
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/simulation/effect_switch.h"
#include "editor/fields/field.h"
#include "editor/panels/panel.h"
#include "editor/panels/stability_gauge.h"

namespace hairloom::editor {
namespace {

enum Column { kName, kMs, kMb, kWhy, kColumns };

class EffectsPanel : public QWidget {
  public:
    EffectsPanel(QtDocument& document, Player& player)
        : document_(document),
          player_(player),
          table_(new QTreeWidget),
          note_(new QLabel),
          trial_(new QWidget) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        makeTable();
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        layout->addWidget(table_, 1);
        layout->addWidget(note_);
        layout->addWidget(trial_);
        makeTrial();
        const auto refreshSeen = [this] {
            if (isVisible()) refresh();
        };
        connect(&player_, &Player::frameReady, this, refreshSeen);
        connect(&player_, &Player::planPreviewChanged, this, refreshSeen);
        connect(table_, &QTreeWidget::itemChanged, this, &EffectsPanel::takeCheck);
        refresh();
    }

  protected:
    void showEvent(QShowEvent*) override {
        player_.setPlanPreviewActive(true);
        refresh();
    }
    void hideEvent(QHideEvent*) override { player_.setPlanPreviewActive(false); }

  private:
    void makeTable() {
        table_->setObjectName("effects");
        table_->setHeaderLabels({tr("Effect"), tr("ms"), tr("MB"), tr("Why")});
        table_->setRootIsDecorated(false);
        table_->setWordWrap(true);
        table_->setSelectionMode(QAbstractItemView::NoSelection);
        table_->setFocusPolicy(Qt::NoFocus);
        table_->setMinimumHeight(340);
        table_->header()->resizeSection(kName, 104);
        table_->header()->resizeSection(kMs, 66);
        table_->header()->resizeSection(kMb, 44);
        table_->header()->setSectionResizeMode(kWhy, QHeaderView::Stretch);
        table_->setToolTip(
            tr("Milliseconds a frame, summed over threads; megabytes of its own; and why it runs or "
               "does not. Untick an effect to try the hair without it."));
    }

    void makeTrial() {
        auto* row = new QHBoxLayout(trial_);
        row->setContentsMargins(0, 0, 0, 0);
        auto* keep = new QPushButton(tr("Leave out for good"));
        keep->setObjectName("effectsKeep");
        keep->setToolTip(tr("Changes the document so that these effects are off; can be undone"));
        auto* all = new QPushButton(tr("All as authored"));
        all->setObjectName("effectsAll");
        all->setToolTip(tr("Ends the try: every effect runs that the document calls for"));
        row->addWidget(keep);
        row->addWidget(all);
        connect(keep, &QPushButton::clicked, this, &EffectsPanel::keepTrial);
        connect(all, &QPushButton::clicked, this, [this] { player_.setLeftOut({}); });
    }

    void keepTrial() {
        Groom groom = document_.groom();
        for (const QString& effect : player_.leftOut()) {
            turnEffectOff(groom.simulation, effect.toStdString());
            if (effect.toStdString() == kCollisionEffect) groom.spheres.clear();
        }
        player_.setLeftOut({});
        document_.perform(
            editing::setSettings(document_.editing().model(), groom, tr("Leave effects out").toStdString()));
    }

    void takeCheck(QTreeWidgetItem* item, int column) {
        if (column != kName || filling_ || !(item->flags() & Qt::ItemIsUserCheckable)) return;
        const QString effect = item->data(kName, Qt::UserRole).toString();
        QStringList leftOut = player_.leftOut();
        const bool out = item->checkState(kName) == Qt::Unchecked;
        if (leftOut.contains(effect) == out) return;
        out ? leftOut.append(effect) : static_cast<void>(leftOut.removeAll(effect));
        player_.setLeftOut(leftOut);
    }

    void refresh() {
        filling_ = true;
        const std::vector<EffectReport> effects = player_.effects();
        const auto& frame = player_.frame();
        note_->setText(frame              ? tr("Mean of %L1 frames").arg(frame->stats.frames)
                       : !effects.empty() ? tr("What would run; play (Space) to see what it costs.")
                                          : tr("Place hair to see what its simulation would run."));
        while (table_->topLevelItemCount() > static_cast<int>(effects.size()))
            delete table_->takeTopLevelItem(0);
        while (table_->topLevelItemCount() < static_cast<int>(effects.size()))
            table_->addTopLevelItem(new QTreeWidgetItem);
        for (std::size_t i = 0; i < effects.size(); ++i) {
            show(*table_->topLevelItem(static_cast<int>(i)), effects[i], frame != nullptr);
        }
        wrapRows(*table_);
        trial_->setVisible(!player_.leftOut().isEmpty());
        filling_ = false;
    }

    void show(QTreeWidgetItem& item, const EffectReport& effect, bool measured) {
        const QString name = QString::fromStdString(effect.name);
        const bool leftOut = player_.leftOut().contains(name);
        item.setText(kName, labelOf(name));
        item.setData(kName, Qt::UserRole, name);
        const bool switchable = canTurnOff(effect.name) && (effect.on || leftOut);
        if (switchable) {
            item.setFlags(item.flags() | Qt::ItemIsUserCheckable);
            item.setCheckState(kName, leftOut ? Qt::Unchecked : Qt::Checked);
        } else {
            item.setFlags(item.flags() & ~Qt::ItemIsUserCheckable);
            item.setData(kName, Qt::CheckStateRole, {});
        }
        item.setToolTip(kName, canTurnOff(effect.name) ? tr("Untick to try the hair without it")
                                                       : tr("Follows from the hair's shape and speed"));
        const QString none = QStringLiteral("–");
        item.setText(kMs, effect.on && measured ? QString::number(effect.milliseconds, 'f', 3) : none);
        item.setText(kMb,
                     effect.on ? QString::number(static_cast<double>(effect.bytes) / 1e6, 'f', 1) : none);
        item.setText(kWhy, leftOut ? tr("left out for a try") : QString::fromStdString(effect.why));
        item.setToolTip(kWhy, item.text(kWhy));
        item.setTextAlignment(kMs, Qt::AlignRight | Qt::AlignVCenter);
        item.setTextAlignment(kMb, Qt::AlignRight | Qt::AlignVCenter);
        const QColor colour =
            palette().color(effect.on ? QPalette::Active : QPalette::Disabled, QPalette::Text);
        for (int c = 0; c < kColumns; ++c) item.setForeground(c, colour);
    }

    QtDocument& document_;
    Player& player_;
    QTreeWidget* table_;
    QLabel* note_;
    QWidget* trial_;
    bool filling_ = false;
};

}  // namespace

PanelInfo effectsPanel() {
    return {"effects",
            QObject::tr("Effects"),
            "effects",
            Qt::RightDockWidgetArea,
            90,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column(
                    {heading(QObject::tr("Stability")), new StabilityGauge(parts.document, parts.preferences),
                     heading(QObject::tr("Effects")), new EffectsPanel(parts.document, parts.player)}));
            }};
}

}  // namespace hairloom::editor
