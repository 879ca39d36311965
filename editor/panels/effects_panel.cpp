// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects of the engine run, why, and what each costs; each can be left out for a try.
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "core/cost/effect_cost.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/simulation/effect_switch.h"
#include "editor/document/tasks.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/field.h"
#include "editor/fields/number_box.h"
#include "editor/panels/certificate_box.h"
#include "editor/panels/cost_bars.h"
#include "editor/panels/live_costs.h"
#include "editor/panels/panel.h"
#include "editor/panels/stability_gauge.h"

namespace hairloom::editor {
namespace {

constexpr std::uint32_t kMeasuredFrames = 20, kMeasuredRuns = 5;
constexpr std::size_t kMostStrands = 20'000;  ///< that run; times of more are in proportion
constexpr const char* kBudgetKey = "frameBudget";
constexpr double kUsualBudget_ms = 4;

enum Column { kName, kMs, kMb, kColumns };

class EffectsPanel : public QWidget {
  public:
    explicit EffectsPanel(const PanelParts& parts)
        : document_(parts.document),
          player_(parts.player),
          tasks_(parts.tasks),
          budget_(new NumberBox(0.1, 100, false)),
          table_(new QTreeWidget),
          bars_(new CostBars(parts.preferences, table_)),
          note_(new QLabel),
          measure_(new QPushButton("Measure on/off")),
          trial_(new QWidget) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        makeBudget(*layout);
        makeTable();
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        layout->addWidget(table_, 1);
        layout->addWidget(note_);
        layout->addWidget(measure_);
        layout->addWidget(trial_);
        makeMeasure();
        makeTrial();
        const auto refreshSeen = paced(*this, [this] {
            if (isVisible()) refresh();
        });
        connect(&player_, &Player::frameReady, this, refreshSeen);
        connect(&player_, &Player::planPreviewChanged, this, refreshSeen);
        connect(&player_, &Player::stateChanged, this, refreshSeen);
        connect(table_, &QTreeWidget::itemChanged, this, &EffectsPanel::takeCheck);
        connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
            if (contains(changed, editing::Part::Physics | editing::kHairParts | editing::Part::Spheres))
                ++changes_;
        });
        connect(&document_, &QtDocument::replaced, this, [this] {
            costs_.reset();
            live_.restart();
            ++documents_;
        });
        refresh();
    }

  protected:
    void showEvent(QShowEvent*) override {
        player_.setPlanPreviewActive(true);
        refresh();
    }
    void hideEvent(QHideEvent*) override { player_.setPlanPreviewActive(false); }

  private:
    void makeBudget(QVBoxLayout& layout) {
        auto* row = new QHBoxLayout;
        auto* words = new QLabel("Frame budget");
        words->setBuddy(budget_);
        budget_->setObjectName("effectsBudget");
        budget_->setToolTip(
            "Simulation time that a frame may take, drawn as the line through the bars. Time beyond it is "
            "red");
        budget_->setShown(1, "ms", 1);
        budget_->setValue(std::clamp(QSettings().value(kBudgetKey, kUsualBudget_ms).toDouble(), 0.1, 100.0));
        connect(budget_, &NumberBox::edited, this, [this](double milliseconds) {
            QSettings().setValue(kBudgetKey, milliseconds);
            refresh();
        });
        row->addWidget(words);
        row->addWidget(budget_, 1);
        layout.addLayout(row);
    }

    void makeTable() {
        table_->setObjectName("effects");
        table_->setHeaderLabels({"Effect", "ms", "MB"});
        table_->setRootIsDecorated(false);
        // Why an effect runs is below it, where it has the whole width.
        table_->setItemsExpandable(false);
        table_->setIndentation(14);
        table_->setWordWrap(true);
        table_->setSelectionMode(QAbstractItemView::NoSelection);
        table_->setMinimumHeight(340);
        table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        table_->header()->resizeSection(kMs, 70);
        table_->header()->resizeSection(kMb, 40);
        table_->header()->setStretchLastSection(false);
        table_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
        table_->setItemDelegateForColumn(kMs, bars_);
        table_->setToolTip(
            "Frame time of each effect, averaged over the last half second of playback, its memory in "
            "megabytes, and why it runs or does not. Clear a checkbox to preview the hair without that "
            "effect.");
    }

    void makeMeasure() {
        measure_->setObjectName("effectsMeasure");
        measure_->setToolTip(
            "Runs the hair with and without each effect on the CPU and shows what each adds to a frame. "
            "Effects that share one solve can only be measured this way");
        connect(measure_, &QPushButton::clicked, this, &EffectsPanel::measure);
    }

    /// Each effect on and off, while the head moves as it does in the view.
    void measure() {
        auto motion = player_.makeMeasuredMotion();
        if (!motion) return;
        const auto groom = std::make_shared<const Groom>(document_.groom());
        const std::shared_ptr<const HeadMotion> moves = std::move(*motion);
        tasks_.measure<EffectCosts>(
            "Measuring effects",
            [groom, moves](TaskControl& control) {
                EffectCostOptions options;
                options.time.frames = kMeasuredFrames;
                options.repeats = kMeasuredRuns;
                options.strands = kMostStrands;
                options.progress = [&](std::size_t done, std::size_t total) {
                    control.setProgress(static_cast<float>(done) / static_cast<float>(total));
                };
                options.cancelled = [&] { return control.isCancelled(); };
                return measureEffectCosts(*groom, *moves, options);
            },
            [this, document = documents_, change = changes_](EffectCosts costs) {
                if (document != documents_) return;
                costs_ = std::move(costs);
                costsChange_ = change;
                refresh();
            });
    }

    /// What is shown of on and off: not while it plays, when bars are live.
    const EffectCosts* costs() const { return costs_ && !player_.isPlaying() ? &*costs_ : nullptr; }
    const EffectCost* costOf(const std::string& effect) const {
        if (!costs()) return nullptr;
        const auto found = std::ranges::find(costs()->effects, effect, &EffectCost::name);
        return found != costs()->effects.end() ? &*found : nullptr;
    }

    /// Why a price is none, and what else turning the effect off changed.
    static QString sentenceOf(const EffectCost& cost) {
        QString note = QString::fromStdString(cost.note);
        if (!note.isEmpty()) note[0] = note[0].toUpper();
        return note;
    }
    static QString noteOf(const EffectCost& cost) {
        return cost.note.empty() ? QString() : QStringLiteral(". ") + sentenceOf(cost);
    }

    /// What an effect adds to a frame; else, in a run, what its own stages take.
    void showMilliseconds(QTreeWidgetItem& item, const EffectReport& effect, bool measured) const {
        item.setText(kMs, QStringLiteral("–"));
        item.setToolTip(kMs, {});
        item.setData(kMs, CostBars::kMilliseconds, {});
        if (!effect.on) return;
        const double live = live_.millisecondsOf(effect.name);
        const EffectCost* const cost = costOf(effect.name);
        if (cost && cost->costMilliseconds) {
            const Quartiles& ms = *cost->costMilliseconds;
            item.setText(kMs, lostInSpread(ms) ? QString("≈ 0")
                              : cost->price()  ? QString::number(ms.median, 'f', 3)
                                               : QString("< 0"));
            item.setData(kMs, CostBars::kMilliseconds, std::max(ms.median, 0.0));
            item.setToolTip(
                kMs,
                QString(
                    "%1 ms per frame with it, %2 without. The middle half of the runs is between %3 and %4")
                        .arg(costs_->milliseconds.median, 0, 'f', 2)
                        .arg(cost->millisecondsOff->median, 0, 'f', 2)
                        .arg(ms.q1, 0, 'f', 3)
                        .arg(ms.q3, 0, 'f', 3) +
                    noteOf(*cost));
        } else if (cost && !cost->note.empty()) {
            item.setToolTip(kMs, sentenceOf(*cost));
        } else if (measured && live > 0) {
            item.setText(kMs, QString::number(live, 'f', 3));
            item.setData(kMs, CostBars::kMilliseconds, live);
            item.setToolTip(kMs, "Share of the frame time");
        } else if (measured) {
            item.setToolTip(kMs, "Part of the shared strand solve. Use Measure on/off to get its cost");
        }
    }

    /// In a row of its own below it.
    void sayWhy(QTreeWidgetItem& item, const QString& why) const {
        if (item.childCount() == 0) {
            auto* const row = new QTreeWidgetItem(&item);
            row->setFlags(Qt::ItemIsEnabled);
            row->setFirstColumnSpanned(true);
            item.setExpanded(true);
        }
        QTreeWidgetItem& row = *item.child(0);
        row.setText(kName, why);
        row.setToolTip(kName, why);
        row.setForeground(kName, palette().color(QPalette::PlaceholderText));
        row.setHidden(why.isEmpty());
    }

    /// The frame as a whole, against the budget.
    void showFrame(QTreeWidgetItem& item) const {
        const double ms = costs() ? costs()->milliseconds.median : live_.frame();
        const bool onGpu = player_.engine() && player_.engine()->kind == EngineKind::gpu && !costs();
        item.setText(kName, "Whole frame");
        item.setData(kName, Qt::UserRole, "frame");
        item.setData(kName, Qt::CheckStateRole, {});
        item.setFlags(item.flags() & ~Qt::ItemIsUserCheckable);
        constexpr double kRound_ms = 100;  // from which on nobody asks for hundredths
        const int decimals = ms < kRound_ms ? 2 : 0;
        item.setText(kMs, ms > 0 ? QString::number(ms, 'f', decimals) : QStringLiteral("–"));
        item.setData(kMs, CostBars::kMilliseconds, ms > 0 ? QVariant(ms) : QVariant());
        item.setTextAlignment(kMs, Qt::AlignRight | Qt::AlignVCenter);
        const QString of = QString("%1 % of the budget").arg(100 * ms / budget_->value(), 0, 'f', 0);
        sayWhy(item, ms > 0 ? (onGpu ? QString("%1, on the GPU").arg(of) : of) : QString());
        QFont bold = font();
        bold.setBold(true);
        for (int c = 0; c < kColumns; ++c) item.setFont(c, bold);
    }

    void makeTrial() {
        auto* row = new QHBoxLayout(trial_);
        row->setContentsMargins(0, 0, 0, 0);
        auto* keep = new QPushButton("Remove from document");
        keep->setObjectName("effectsKeep");
        keep->setToolTip("Turns these effects off in the document. You can undo this");
        auto* all = new QPushButton("Re-enable all");
        all->setObjectName("effectsAll");
        all->setToolTip("Re-enable all effects");
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
            if (effect.toStdString() == kBodyEffect) groom.body.reset();
        }
        player_.setLeftOut({});
        document_.perform(editing::setSettings(document_.editing().model(), groom, "Disable effects"));
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

    QString words(bool nothing) const {
        if (nothing) return QString("Place hair to see which effects its simulation runs.");
        if (const EffectCosts* costs = this->costs()) {
            const QString age = costsChange_ != changes_ ? QString(" before the last change") : QString();
            return QString("Measured on and off, of %1 ms per frame on the CPU%2.")
                .arg(costs->milliseconds.median, 0, 'f', 2)
                .arg(age);
        }
        if (!player_.frame()) return QString("Effects that will run. Press Play (Space) to see their cost.");
        const bool onGpu = player_.engine() && player_.engine()->kind == EngineKind::gpu;
        return onGpu ? QString("Live, on the GPU: one kernel simulates the strands with all their effects")
                     : QString("Live, on the CPU: mean of the last half second");
    }

    void refresh() {
        filling_ = true;
        const std::vector<EffectReport> effects = player_.effects();
        const auto& frame = player_.frame();
        note_->setText(words(effects.empty()));
        measure_->setVisible(!effects.empty());
        if (frame) live_.add(*frame);
        const int rows = effects.empty() ? 0 : static_cast<int>(effects.size()) + 1;
        while (table_->topLevelItemCount() > rows) delete table_->takeTopLevelItem(rows);
        while (table_->topLevelItemCount() < rows) table_->addTopLevelItem(new QTreeWidgetItem);
        bars_->setScale(budget_->value(), costs() ? costs()->milliseconds.median : live_.frame());
        if (rows > 0) showFrame(*table_->topLevelItem(0));
        for (std::size_t i = 0; i < effects.size(); ++i) {
            show(*table_->topLevelItem(static_cast<int>(i) + 1), effects[i], frame != nullptr);
        }
        table_->viewport()->update();
        wrapRows(*table_);
        trial_->setVisible(!player_.leftOut().isEmpty());
        filling_ = false;
    }

    void show(QTreeWidgetItem& item, const EffectReport& effect, bool measured) {
        const QString name = QString::fromStdString(effect.name);
        const bool leftOut = player_.leftOut().contains(name);
        item.setText(kName, labelOf(name));
        item.setData(kName, Qt::UserRole, name);
        const bool known = canTurnOff(document_.groom().simulation, effect.name);
        const bool switchable = known && (effect.on || leftOut);
        if (switchable) {
            item.setFlags(item.flags() | Qt::ItemIsUserCheckable);
            item.setCheckState(kName, leftOut ? Qt::Unchecked : Qt::Checked);
        } else {
            item.setFlags(item.flags() & ~Qt::ItemIsUserCheckable);
            item.setData(kName, Qt::CheckStateRole, {});
        }
        item.setToolTip(kName, known ? QString("Clear to preview the hair without this effect")
                                     : QString("Depends on the shape and speed of the hair"));
        const QString none = QStringLiteral("–");
        showMilliseconds(item, effect, measured);
        item.setText(kMb,
                     effect.on ? QString::number(static_cast<double>(effect.bytes) / 1e6, 'f', 1) : none);
        sayWhy(item, leftOut ? QString("disabled for preview") : QString::fromStdString(effect.why));
        item.setTextAlignment(kMs, Qt::AlignRight | Qt::AlignVCenter);
        item.setTextAlignment(kMb, Qt::AlignRight | Qt::AlignVCenter);
        const QColor colour =
            palette().color(effect.on ? QPalette::Active : QPalette::Disabled, QPalette::Text);
        for (int c = 0; c < kColumns; ++c) item.setForeground(c, colour);
    }

    QtDocument& document_;
    Player& player_;
    Tasks& tasks_;
    NumberBox* budget_;
    QTreeWidget* table_;
    CostBars* bars_;
    QLabel* note_;
    QPushButton* measure_;
    QWidget* trial_;
    LiveCosts live_;
    bool filling_ = false;
    std::optional<EffectCosts> costs_;
    std::uint32_t documents_ = 0;                  ///< replaced so far
    std::uint32_t changes_ = 0, costsChange_ = 0;  ///< of the document, and when `costs_` began
};

}  // namespace

PanelInfo effectsPanel() {
    return {"effects",
            QString("Effects"),
            "effects",
            Qt::RightDockWidgetArea,
            90,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(
                    column({heading("Stability"), new StabilityGauge(parts.document, parts.preferences),
                            new CertificateBox(parts.document, parts.tasks), heading("Effects"),
                            new EffectsPanel(parts)}));
            }};
}

}  // namespace hairloom::editor
