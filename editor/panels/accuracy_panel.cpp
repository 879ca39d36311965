// SPDX-License-Identifier: GPL-3.0-or-later
// What accuracy costs: the diagram of this hair on this machine, in milliseconds and in pixels of the view,
// and settings taken from it.
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/accuracy/choice.h"
#include "core/accuracy/measures.h"
#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/groom/file/settings_json.h"
#include "core/operations/resample.h"
#include "editor/document/words.h"
#include "editor/fields/length_text.h"
#include "editor/fields/number_box.h"
#include "editor/panels/accuracy_grid.h"
#include "editor/panels/accuracy_plot.h"
#include "editor/panels/error_bars.h"
#include "editor/panels/panel.h"
#include "editor/panels/run_view.h"

namespace hairloom::editor {
namespace {

constexpr double kWorstShare = 0.05;  ///< of all strands

/// What a setting is shown beside, in the order of the list.
enum class Beside { reference, equalTime, equalError, document };

/// What a setting is chosen by.
enum class Choice { click, pixels, milliseconds };

class AccuracyPanel : public QWidget {
  public:
    explicit AccuracyPanel(const PanelParts& parts)
        : document_(parts.document),
          preferences_(parts.preferences),
          player_(parts.player),
          tasks_(parts.tasks),
          messages_(parts.messages),
          viewport_(parts.viewport),
          prices_(parts.prices),
          measures_(new QComboBox),
          plot_(new AccuracyPlot),
          parts_(new ErrorBars(parts.preferences)),
          words_(new QLabel),
          measure_(new QPushButton("Measure")),
          chosenWords_(new QLabel),
          show_(new QPushButton("Show in viewport")),
          beside_(new QComboBox),
          adopt_(new QPushButton("Apply")),
          worst_(new QPushButton("Select worst strands")),
          view_(new RunView(parts, this)),
          pixels_(new NumberBox(0.01, 100, false)),
          milliseconds_(new NumberBox(0.01, 100, false)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        words_->setObjectName("accuracyWords");
        words_->setWordWrap(true);
        layout->addWidget(words_);
        layout->addWidget(measure_);
        addMeasures(*layout);
        layout->addWidget(plot_, 1);
        addChoice(*layout, *pixels_, "accuracyPixels", "Fastest within", "px",
                  "Cheapest settings within this error in the view");
        addChoice(*layout, *milliseconds_, "accuracyMs", "Most accurate within", "ms",
                  "Most accurate settings within this frame time");
        adopt_->setObjectName("accuracyAdopt");
        adopt_->setToolTip(
            "Applies these settings to the document. You can undo this. A different number of points "
            "bakes the operators");
        measure_->setObjectName("accuracyMeasure");
        measure_->setToolTip(
            "Simulates this hair with a grid of settings and compares each with a reference in double "
            "precision. Uses the motion of the viewport or a nod. Takes about half a minute");
        chosenWords_->setObjectName("accuracyChosen");
        chosenWords_->setWordWrap(true);
        show_->setObjectName("accuracyShow");
        show_->setCheckable(true);
        show_->setToolTip(
            "Loops the measured motion with these settings and leaves the document unchanged. The "
            "compared strands are drawn on top, from green (exact) to red (5 px error). Blue strands show "
            "the comparison");
        beside_->setObjectName("accuracyBeside");
        beside_->addItems({"vs. reference", "vs. same frame time", "vs. same error", "vs. current settings"});
        beside_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        beside_->setMinimumContentsLength(8);
        beside_->setToolTip(
            "What the blue strands show. Reference: the exact motion. Same frame time: within a fifth, "
            "with the largest difference in error. Same error: with the largest difference in time. "
            "Current settings: those of the document");
        connect(beside_, &QComboBox::currentIndexChanged, this, [this] { choose(by_); });
        layout->addWidget(chosenWords_);
        layout->addWidget(parts_);
        layout->addWidget(show_);
        layout->addWidget(beside_);
        layout->addWidget(adopt_);
        worst_->setObjectName("accuracyWorst");
        worst_->setToolTip(
            "Selects the 5 % of strands where this setting differs most from the most accurate one");
        connect(worst_, &QPushButton::clicked, this, &AccuracyPanel::selectWorst);
        layout->addWidget(worst_);
        pixels_->setValue(1);
        milliseconds_->setValue(4);
        connect(measure_, &QPushButton::clicked, this, &AccuracyPanel::measure);
        connect(adopt_, &QPushButton::clicked, this, &AccuracyPanel::adopt);
        connect(show_, &QPushButton::toggled, this, [this](bool on) { on ? showChosen() : view_->stop(); });
        connect(view_, &RunView::stopped, this, [this] {
            const QSignalBlocker quiet(show_);
            show_->setChecked(false);
        });
        connect(plot_, &AccuracyPlot::clicked, this, [this](std::size_t run) {
            chosen_ = run;
            choose(Choice::click);
        });
        connect(pixels_, &NumberBox::edited, this, [this] { choose(Choice::pixels); });
        connect(milliseconds_, &NumberBox::edited, this, [this] { choose(Choice::milliseconds); });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
            if (contains(changed, editing::Part::Physics | editing::kHairParts | editing::Part::Spheres)) {
                if (!adopting_) ++changes_;
                refresh();
            }
        });
        connect(&document_, &QtDocument::replaced, this, [this] {
            measured_.reset();
            chosen_.reset();
            by_ = Choice::pixels;
            prices_.clear();
            ++documents_;
            refresh();
        });
        refresh();
    }

  protected:
    /// The camera may have moved.
    void showEvent(QShowEvent*) override { lookAgain(); }
    void enterEvent(QEnterEvent*) override { lookAgain(); }

  private:
    static void addChoice(QVBoxLayout& layout, NumberBox& box, const char* name, const QString& label,
                          const QString& unit, const QString& tip) {
        auto* row = new QHBoxLayout;
        auto* words = new QLabel(label);
        words->setBuddy(&box);
        box.setObjectName(name);
        box.setToolTip(tip);
        box.setShown(1, unit, 2);
        row->addWidget(words);
        row->addWidget(&box, 1);
        layout.addLayout(row);
    }

    void addMeasures(QVBoxLayout& layout) {
        measures_->setObjectName("accuracyMeasure");
        for (const MeasureInfo& measure : measures()) {
            measures_->addItem(QString::fromUtf8(measure.label));
            measures_->setItemData(measures_->count() - 1, QString::fromUtf8(measure.meaning),
                                   Qt::ToolTipRole);
        }
        measures_->setToolTip("Error shown on the vertical axis. Lower is better");
        connect(measures_, &QComboBox::currentIndexChanged, this, [this] { refresh(); });
        layout.addWidget(measures_);
    }

    /// Seen side-on, in the middle of the hair.
    double pixelsPerMm() const {
        const Box3f box = document_.groom().bounds();
        if (box.isEmpty()) return 1;
        const float metres = viewport_.camera().metresPerPixel(box.center(), viewport_.viewSize_px());
        return metres > 0 ? 1e-3 / static_cast<double>(metres) : 1;
    }
    /// From the strands that ran to all there are.
    double timeScale() const {
        return static_cast<double>(measured_->groomStrands) / static_cast<double>(measured_->strands);
    }
    QString numbers(std::size_t run) const {
        const WorkPrecisionRun& measured = measured_->runs[run];
        if (measured.diverged) return QString("diverges");
        return QString("%1 ms, %2 px (%3)")
            .arg(measured.milliseconds.median * timeScale(), 0, 'g', 3)
            .arg(measured.error.rmsMm * pixelsPerMm(), 0, 'g', 2)
            .arg(lengthText(1e-3 * measured.error.rmsMm, preferences_));
    }
    QString setting(std::size_t run) const { return QString::fromStdString(describeRun(*measured_, run)); }

    void measure() {
        auto motion = player_.makeMeasuredMotion();
        if (!motion) return messages_.warn(errorText(motion.error()));
        const auto groom = std::make_shared<const Groom>(document_.groom());
        const std::shared_ptr<const HeadMotion> moves = std::move(*motion);
        const auto keep = [this, document = documents_, change = changes_](const WorkPrecision& result) {
            if (document != documents_) return;
            // A point of another diagram is none of this one.
            if (by_ == Choice::click && (!measured_ || measured_->options.axes != result.options.axes))
                by_ = Choice::pixels;
            measured_ = std::make_shared<const WorkPrecision>(result);
            measuredAt_ = QDateTime::currentDateTime();
            measuredChange_ = change;
            refresh();
        };
        const bool began = tasks_.measure<WorkPrecision>(
            "Measuring accuracy",
            [this, groom, moves, keep](TaskControl& control) {
                return measureGrid(*groom, *moves, control, [&](const WorkPrecision& result) {
                    const auto keepUnlessDone = [this, keep, result] {
                        if (measuring_) keep(result);
                    };
                    QMetaObject::invokeMethod(this, keepUnlessDone, Qt::QueuedConnection);
                });
            },
            [this, keep](const WorkPrecision& result) {
                measuring_ = false;
                keep(result);
            });
        measuring_ = measuring_ || began;
    }
    bool isOutdated() const { return measuredChange_ != changes_; }

    void choose(Choice by) {
        by_ = by;
        if (!measured_) return;
        refresh();
        if (show_->isChecked()) showChosen();
    }
    void lookAgain() {
        const auto before = chosen_;
        refresh();
        if (chosen_ != before && show_->isChecked()) showChosen();
    }
    /// Pixels are those of the view as it is now, so that a limit may mean another setting than before.
    void findChosen() {
        if (by_ == Choice::pixels)
            chosen_ = cheapestWithinError(*measured_, pixels_->value() / pixelsPerMm());
        if (by_ == Choice::milliseconds)
            chosen_ = mostExactWithinTime(*measured_, milliseconds_->value() / timeScale());
    }

    void showChosen() {
        if (chosen_ && !measured_->runs[*chosen_].diverged) return view_->show(measured_, *chosen_, beside());
        view_->stop();
    }

    /// The run that the chosen one is shown beside; nothing: the reference.
    std::optional<std::size_t> beside() const {
        std::optional<std::size_t> other;
        switch (static_cast<Beside>(beside_->currentIndex())) {
            case Beside::equalTime:
                other = pairOfEqualTime(*measured_, *chosen_);
                break;
            case Beside::equalError:
                other = pairOfEqualError(*measured_, *chosen_);
                break;
            case Beside::document:
                other = runOf(*measured_, document_.groom());
                break;
            case Beside::reference:
                break;
        }
        if (other && (other == chosen_ || measured_->runs[*other].diverged)) return std::nullopt;
        return other;
    }
    QString besideInWords() const {
        if (static_cast<Beside>(beside_->currentIndex()) == Beside::reference) return {};
        const auto other = beside();
        if (!other) return QString(" No matching measurement. The reference is shown in blue.");
        return QString(" Shown in blue: %1: %2.").arg(setting(*other), numbers(*other));
    }

    /// Those of all strands that the chosen setting, or that of the document, takes farthest from the most
    /// exact that was measured.
    void selectWorst() {
        const auto run = chosen_ ? chosen_ : runOf(*measured_, document_.groom());
        const auto best = mostExactWithinTime(*measured_, std::numeric_limits<double>::infinity());
        if (!run || !best || *run == *best || measured_->runs[*run].diverged)
            return messages_.say("Choose a setting other than the most accurate one");
        auto motion = player_.makeMeasuredMotion();
        if (!motion) return messages_.warn(errorText(motion.error()));
        const auto groom = std::make_shared<const Groom>(document_.groom());
        const std::shared_ptr<const HeadMotion> moves = std::move(*motion);
        tasks_.run<std::vector<std::uint32_t>>(
            "Comparing strands",
            [groom, moves, measured = measured_, run = *run,
             best = *best](TaskControl& control) -> Result<std::vector<std::uint32_t>> {
                const auto cancelled = [&] { return control.isCancelled(); };
                const auto other = previewRun(*groom, *moves, *measured, run, cancelled);
                if (!other) return tl::unexpected(other.error());
                const auto exact = previewRun(*groom, *moves, *measured, best, cancelled);
                if (!exact) return tl::unexpected(exact.error());
                return strandsFarthestApart(*groom, *other, *exact, kWorstShare);
            },
            [this, groom](const std::vector<std::uint32_t>& strands) {
                if (document_.groom().offsets.version() != groom->offsets.version()) return;
                document_.perform(
                    editing::selectStrands(document_.editing().model(), strands, editing::Choice::Replace));
                messages_.say(
                    QString("Selected %L1 strands: the 5 % that differ most from the most accurate setting")
                        .arg(strands.size()));
            });
    }

    void adopt() {
        if (!measured_ || !chosen_) return;
        const WorkPrecisionRun& run = measured_->runs[*chosen_];
        Groom groom = document_.groom();
        applyValues(measured_->options.axes, run.values, groom.simulation);
        const std::string name = "Apply " + describeRun(*measured_, *chosen_);
        const auto points = findAxis(measured_->options.axes, kPointsAxis);
        adopting_ = true;
        if (points && run.values[*points] != maxPoints(groom)) {
            const ResampleSettings resampled{static_cast<std::uint32_t>(run.values[*points])};
            if (auto touched = resample(groom, resampled); !touched) {
                messages_.warn(errorText(touched.error()));
            } else {
                const std::string record =
                    "[" + editing::recordOf("resample", {{"points", resampled.points}}) + ", " +
                    editing::recordOf("simulation", {{"settings", toJson(groom.simulation)}}) + "]";
                document_.perform(
                    editing::replaceGroom(document_.editing().model(), std::move(groom), name, record));
            }
        } else {
            document_.perform(editing::setPhysics(document_.editing().model(), groom.simulation, name));
        }
        adopting_ = false;
        refresh();
    }

    /// What going from one run to a more exact one means.
    QString step(const WorkPrecisionRun& from, std::size_t to) const {
        const WorkPrecisionRun& run = measured_->runs[to];
        const double pixels = (from.error.rmsMm - run.error.rmsMm) * pixelsPerMm();
        const double ms = (run.milliseconds.median - from.milliseconds.median) * timeScale();
        const QString nearer = QString::number(pixels, 'g', 2), time = QString::number(std::abs(ms), 'g', 2);
        return ms > 0
                   ? QString("The next step, %1, reduces the error by %2 px for %3 ms more.")
                         .arg(setting(to), nearer, time)
                   : QString("%1 is more accurate by %2 px and saves %3 ms.").arg(setting(to), nearer, time);
    }

    QString sentence() const {
        if (document_.groom().strandCount() == 0) return QString("Place hair to measure its accuracy.");
        if (!measured_)
            return QString(
                "How accurate is this hair, and what would improve it? Measure it with other substeps and "
                "points.");
        QString text;
        const auto now = runOf(*measured_, document_.groom());
        if (now) {
            text = QString("Now %1: %2.").arg(setting(*now), numbers(*now));
            const WorkPrecisionRun& has = measured_->runs[*now];
            if (const auto next = nextStep(*measured_, *now); next && !has.diverged) {
                text += ' ' + step(has, *next);
            } else if (!next) {
                text += ' ' + QString("No measured setting has a smaller error.");
            }
        }
        if (measured_->strands < measured_->groomStrands)
            text += ' ' + QString("Times are scaled to all %L1 strands.").arg(measured_->strands);
        if (isOutdated()) text += ' ' + QString("Measured before the last change.");
        return text;
    }

    /// What other values of each setting would cost, for the rows where they are set.
    void showPrices() {
        QHash<QString, SettingPrices> prices;
        const auto now = runOf(*measured_, document_.groom());
        const std::vector<GridAxis>& axes = measured_->options.axes;
        for (std::size_t a = 0; a < axes.size() && now; ++a) {
            SettingPrices& setting = prices[QString::fromStdString(axes[a].field)];
            setting.unit = QString("px");
            setting.measured = measuredAt_;
            setting.outdated = isOutdated();
            for (const std::size_t r : runsAlong(*measured_, *now, a)) {
                const WorkPrecisionRun& run = measured_->runs[r];
                if (run.diverged || !(run.milliseconds.median > 0)) continue;
                setting.values.push_back({QString::fromStdString(axisValueText(axes[a], run.values[a])),
                                          run.milliseconds.median * timeScale(),
                                          run.error.rmsMm * pixelsPerMm(), r == *now});
            }
        }
        prices_.set(Prices::Of::Motion, prices);
    }

    void refresh() {
        words_->setText(sentence());
        measure_->setEnabled(document_.groom().strandCount() > 0);
        const bool any = measured_ != nullptr;
        plot_->setVisible(any);
        measures_->setVisible(any);
        if (!any) parts_->hide();
        for (QWidget* control : {static_cast<QWidget*>(pixels_), static_cast<QWidget*>(milliseconds_)})
            control->setEnabled(any);
        if (any) findChosen();
        adopt_->setEnabled(any && chosen_ && chosen_ != runOf(*measured_, document_.groom()));
        show_->setEnabled(any && chosen_);
        beside_->setEnabled(any && chosen_);
        worst_->setEnabled(any);
        chosenWords_->setVisible(any);
        if (!any) return;
        chosenWords_->setText(chosenInWords());
        showParts();
        showDiagram();
        showPrices();
    }

    QString chosenInWords() const {
        const QString limits[] = {QString(), QString("within %1 px").arg(pixels_->value(), 0, 'g', 3),
                                  QString("within %1 ms").arg(milliseconds_->value(), 0, 'g', 3)};
        const QString& limit = limits[static_cast<int>(by_)];
        if (!chosen_)
            return by_ == Choice::click ? QString("Click a point or set a limit")
                                        : QString("No measured setting is %1.").arg(limit);
        const QString which = by_ == Choice::pixels         ? QString("Fastest %1").arg(limit)
                              : by_ == Choice::milliseconds ? QString("Most accurate %1").arg(limit)
                                                            : QString("Chosen");
        const QString has = chosen_ == runOf(*measured_, document_.groom())
                                ? QString(" This is the current setting.")
                                : QString();
        return QString("%1: %2: %3.").arg(which, setting(*chosen_), numbers(*chosen_)) + has +
               besideInWords();
    }

    /// What the error of the chosen setting, or of the document's, is made of.
    void showParts() {
        const auto run = chosen_ ? chosen_ : runOf(*measured_, document_.groom());
        const bool known = run && measured_->runs[*run].parts;
        parts_->setVisible(known);
        if (known)
            parts_->setParts(*measured_->runs[*run].parts, measured_->groundTruthUncertaintyMm,
                             pixelsPerMm());
    }

    void showDiagram() {
        const MeasureInfo& measure = measures()[static_cast<std::size_t>(measures_->currentIndex())];
        const std::vector<bool> front = frontBy(*measured_, measure.measure);
        const double scale = timeScale(), upwards = measure.length ? pixelsPerMm() : 1;
        std::vector<AccuracyPoint> points;
        for (std::size_t r = 0; r < measured_->runs.size(); ++r) {
            const WorkPrecisionRun& run = measured_->runs[r];
            points.push_back({run.milliseconds.median * scale, run.milliseconds.q1 * scale,
                              run.milliseconds.q3 * scale,
                              run.diverged ? 0 : valueOf(run, measure.measure) * upwards, run.diverged,
                              front[r], setting(r)});
        }
        plot_->setAxes("Cost: time per frame", "ms", QString::fromUtf8(measure.label));
        plot_->setPoints(std::move(points), measure.length ? QString("px") : QString::fromUtf8(measure.unit));
        plot_->setMarked(runOf(*measured_, document_.groom()), chosen_);
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Player& player_;
    Tasks& tasks_;
    Messages& messages_;
    Viewport& viewport_;
    Prices& prices_;
    QComboBox* measures_;
    AccuracyPlot* plot_;
    ErrorBars* parts_;
    QLabel* words_;
    QPushButton* measure_;
    QLabel* chosenWords_;
    QPushButton* show_;
    QComboBox* beside_;
    QPushButton *adopt_, *worst_;
    RunView* view_;
    NumberBox *pixels_, *milliseconds_;
    std::shared_ptr<const WorkPrecision> measured_;
    QDateTime measuredAt_;
    std::optional<std::size_t> chosen_;
    Choice by_ = Choice::pixels;
    std::uint32_t documents_ = 0;                     ///< replaced so far
    std::uint32_t changes_ = 0, measuredChange_ = 0;  ///< of the document, and when `measured_` began
    bool adopting_ = false;
    bool measuring_ = false;  ///< rounds that arrive are newer than what is shown
};

}  // namespace

PanelInfo accuracyPanel() {
    return {"accuracy",
            QString("Accuracy"),
            "effects",
            Qt::RightDockWidgetArea,
            95,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({heading("Cost and error"), new AccuracyPanel(parts)}));
            }};
}

}  // namespace hairloom::editor
