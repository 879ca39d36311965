// SPDX-License-Identifier: GPL-3.0-or-later
// Takes: recording what plays, and any frame of it again.
#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>

#include "core/documents/takes.h"
#include "core/editing/document.h"
#include "core/editing/take_shape.h"
#include "core/simulation/rest_positions.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/length_text.h"
#include "editor/fields/number_spin.h"
#include "editor/panels/panel.h"
#include "editor/panels/take_actions.h"
#include "editor/panels/take_export_dialog.h"
#include "editor/panels/take_view.h"
#include "editor/style/icons.h"

namespace hairloom::editor {
namespace {

constexpr int kTakeColumn = 0, kTakeFramesColumn = 1, kTakeSizeColumn = 2, kTakeMotionColumn = 3;
/// Of points that move; docs/formats/take.md has what was measured.
constexpr double kTakeBytesPerPoint = 1.5;

QString takeSizeText(double bytes) {
    constexpr double kKilo = 1e3, kMega = 1e6, kGiga = 1e9;
    if (bytes < kMega) return QString("%1 kB").arg(bytes / kKilo, 0, 'f', 0);
    if (bytes < kGiga) return QString("%1 MB").arg(bytes / kMega, 0, 'f', 1);
    return QString("%1 GB").arg(bytes / kGiga, 0, 'f', 2);
}

class TakesPanel : public QWidget {
  public:
    explicit TakesPanel(const PanelParts& parts)
        : document_(parts.document),
          preferences_(parts.preferences),
          tasks_(parts.tasks),
          messages_(parts.messages),
          player_(parts.player),
          view_(new TakeView(parts, this)),
          actions_(new TakeActions(
              parts, *view_,
              {[this] { return selected(); }, [this](const QString& name) { return fileOf(name); },
               [this](const QString& stem) { return freeName(stem); }},
              this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        addRecording(*layout);
        addList(*layout);
        addScrubbing(*layout);
        addActions(*layout);
        connect(&document_, &QtDocument::replaced, this, [this] {
            finishRecording();
            fill();
        });
        connect(&document_, &QtDocument::titleChanged, this, [this] {
            if (document_.path() == filledFor_) return;
            finishRecording();
            fill();
        });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
            if (contains(changed, editing::kHairParts | editing::kScalpParts)) showState();
        });
        connect(view_, &TakeView::failed, &messages_, &Messages::warn);
        connect(view_, &TakeView::frameShown, this, [this](quint64 number) { showNumber(number); });
        connect(view_, &TakeView::playingChanged, this, [this] { showPlaying(); });
        connect(view_, &TakeView::stopped, this, [this] {
            list_->setCurrentItem(nullptr);
            other_->setCurrentIndex(0);
            showState();
        });
        watch_.setInterval(200);
        connect(&watch_, &QTimer::timeout, this, [this] { watchRecording(); });
        fill();
    }

  private:
    void addRecording(QVBoxLayout& layout) {
        auto* row = new QHBoxLayout;
        name_ = new QLineEdit;
        name_->setObjectName("takeName");
        name_->setPlaceholderText("Name of the take");
        name_->setToolTip("Name of the take to record");
        record_ = new QPushButton(icon("record"), "Record");
        record_->setObjectName("takeRecord");
        record_->setCheckable(true);
        row->addWidget(name_, 1);
        row->addWidget(record_);
        layout.addLayout(row);
        recordState_ = new QLabel;
        recordState_->setObjectName("takeState");
        recordState_->setProperty("role", "dim");
        recordState_->setWordWrap(true);
        layout.addWidget(recordState_);
        connect(record_, &QPushButton::clicked, this,
                [this](bool on) { on ? startRecording() : finishRecording(); });
    }

    void addList(QVBoxLayout& layout) {
        list_ = new QTreeWidget;
        list_->setObjectName("takes");
        list_->setHeaderLabels({"Take", "Frames", "Size", "Motion"});
        list_->setRootIsDecorated(false);
        list_->setToolTip("Select a take to show it. Press F2 or double-click to rename it");
        QHeaderView& header = *list_->header();
        header.setStretchLastSection(false);
        header.setMinimumSectionSize(30);
        header.setSectionResizeMode(kTakeColumn, QHeaderView::Stretch);
        for (const int column : {kTakeFramesColumn, kTakeSizeColumn})
            header.setSectionResizeMode(column, QHeaderView::ResizeToContents);
        header.resizeSection(kTakeMotionColumn, 60);
        list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        list_->setMinimumHeight(120);
        list_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
        layout.addWidget(list_, 1);
        connect(list_, &QTreeWidget::currentItemChanged, this, [this] {
            if (!filling_) showSelected();
        });
        connect(list_, &QTreeWidget::itemClicked, this, [this] {
            if (!view_->isShown()) showSelected();
        });
        connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
            if (!filling_) rename(*item);
        });
    }

    void addScrubbing(QVBoxLayout& layout) {
        auto* row = new QHBoxLayout;
        play_ = new QPushButton(icon("play"), {});
        play_->setObjectName("takePlay");
        play_->setToolTip("Play or pause the take");
        play_->setAccessibleName("Play the take");
        slider_ = new QSlider(Qt::Horizontal);
        slider_->setObjectName("takeFrame");
        slider_->setToolTip("Frame of the take");
        number_ = new QLabel;
        number_->setObjectName("takeNumber");
        speed_ = new QComboBox;
        speed_->setObjectName("takeSpeed");
        speed_->setToolTip("Speed of playback");
        for (const double speed : {0.1, 0.25, 0.5, 1.0, 2.0})
            speed_->addItem(QString("%1 ×").arg(speed), speed);
        speed_->setCurrentIndex(3);
        row->addWidget(play_);
        row->addWidget(slider_, 1);
        row->addWidget(number_);
        row->addWidget(speed_);
        layout.addLayout(row);
        connect(play_, &QPushButton::clicked, this, [this] { view_->setPlaying(!view_->isPlaying()); });
        connect(slider_, &QSlider::valueChanged, this, [this](int value) {
            if (showing_) return;
            view_->setPlaying(false);
            view_->showFrame(static_cast<std::uint64_t>(value));
        });
        connect(speed_, &QComboBox::currentIndexChanged, this,
                [this] { view_->setSpeed(speed_->currentData().toDouble()); });
    }

    void addActions(QVBoxLayout& layout) {
        other_ = new QComboBox;
        other_->setObjectName("takeOther");
        other_->setToolTip(
            QString("Colours strands by their distance from another take. Green is none, red is %1 or more")
                .arg(lengthText(static_cast<double>(kRedDistance), preferences_)));
        connect(other_, &QComboBox::activated, this, [this] {
            if (auto status = view_->compareWith(fileOf(other_->currentData().toString())); !status) {
                messages_.warn(errorText(status.error()));
                other_->setCurrentIndex(0);
            }
        });
        layout.addWidget(other_);
        distance_ = new QLabel;
        distance_->setObjectName("takeDistance");
        distance_->setWordWrap(true);
        layout.addWidget(distance_);
        auto* row = new QHBoxLayout;
        shape_ =
            pushButton("takeShape", "Set as rest shape",
                       "Makes the hair of this frame the authored shape on the head at rest. You can undo it",
                       [this] { takeShape(); });
        export_ = pushButton("takeExport", "Export…",
                             "Export the selected take as Alembic, USD, a clip for games or a record of "
                             "frames",
                             [this] { exportSelected(); });
        rename_ = pushButton("takeRename", "Rename", "Rename the selected take (F2)", [this] {
            if (auto* item = list_->currentItem()) list_->editItem(item, kTakeColumn);
        });
        remove_ =
            pushButton("takeDelete", "Delete…", "Delete the file of the selected take", [this] { remove(); });
        layout.addWidget(shape_);
        layout.addWidget(actions_);
        connect(actions_, &TakeActions::made, this, [this](const QString& name) { fill(name); });
        for (QPushButton* button : {export_, rename_, remove_}) row->addWidget(button);
        layout.addLayout(row);
    }

    std::filesystem::path project() const { return std::filesystem::path(document_.path().toStdU16String()); }
    std::filesystem::path fileOf(const QString& name) const {
        if (name.isEmpty()) return {};
        const auto path = takePath(project(), name.toStdString());
        return path ? *path : std::filesystem::path();
    }
    QString selected() const {
        return list_->currentItem() ? list_->currentItem()->data(kTakeColumn, Qt::UserRole).toString()
                                    : QString();
    }

    /// Takes again what is in the folder; `selects` is the one that is selected then.
    void fill(const QString& selects = {}) {
        filling_ = true;
        view_->stop();
        list_->clear();
        other_->clear();
        other_->addItem("No comparison");
        filledFor_ = document_.path();
        if (!document_.path().isEmpty()) {
            const Takes found = findTakes(project());
            for (const std::string& name : found.recovered)
                messages_.say(QString("The take “%1” was recovered. Its recording had been interrupted")
                                  .arg(QString::fromStdString(name)));
            const std::uint64_t shape = takeShapeHash(document_.groom());
            for (const Take& take : found.takes) addRow(take, shape);
        }
        filling_ = false;
        if (name_->text().isEmpty() || !fileIsFree(name_->text())) name_->setText(freeName());
        for (int i = 0; i < list_->topLevelItemCount() && !selects.isEmpty(); ++i) {
            if (list_->topLevelItem(i)->text(kTakeColumn) == selects)
                list_->setCurrentItem(list_->topLevelItem(i));
        }
        showState();
    }

    void addRow(const Take& take, std::uint64_t shape) {
        const QString name = QString::fromStdString(take.name);
        const QString motion = QString::fromStdString(motionOfNotes(take.info.notes));
        auto* row = new QTreeWidgetItem({name, QString::number(take.info.frames),
                                         takeSizeText(static_cast<double>(take.info.bytes)), motion});
        row->setData(kTakeColumn, Qt::UserRole, name);
        row->setFlags(row->flags() | Qt::ItemIsEditable);
        QStringList tip;
        if (!take.problem.empty()) tip += QString::fromStdString(take.problem);
        if (take.problem.empty()) {
            tip += QString("%1 frames per second, largest error %2 mm")
                       .arg(static_cast<double>(take.info.framesPerSecond))
                       .arg(1e3 * static_cast<double>(take.info.largestError), 0, 'f', 3);
            if (!take.info.isFinished) tip += "Its recording was interrupted";
            if (const auto loop = loopOfNotes(take.info.notes))
                tip.front() += QString(". Repeats every %L1 frames").arg(loop->frames);
            if (take.info.shapeHash != shape) tip += "The groom or its head has changed shape since";
        }
        if (tip.size() > 1 || !take.problem.empty()) row->setIcon(kTakeColumn, icon("warning"));
        for (int column = 0; column <= kTakeMotionColumn; ++column) row->setToolTip(column, tip.join('\n'));
        row->setTextAlignment(kTakeFramesColumn, Qt::AlignRight | Qt::AlignVCenter);
        row->setTextAlignment(kTakeSizeColumn, Qt::AlignRight | Qt::AlignVCenter);
        list_->addTopLevelItem(row);
        if (take.problem.empty()) other_->addItem(QString("Compare with %1").arg(name), name);
    }

    bool fileIsFree(const QString& name) const {
        std::error_code code;
        const auto file = fileOf(name);
        return !file.empty() && !std::filesystem::exists(file, code);
    }
    QString freeName() const {
        for (int i = 1;; ++i) {
            const QString name = QString("take %1").arg(i);
            if (document_.path().isEmpty() || fileIsFree(name)) return name;
        }
    }
    /// The stem itself where it is free.
    QString freeName(const QString& stem) const {
        for (int i = 1;; ++i) {
            const QString name = i == 1 ? stem : QString("%1 %2").arg(stem).arg(i);
            if (document_.path().isEmpty() || fileOf(name).empty() || fileIsFree(name)) return name;
        }
    }

    // --- Recording ---

    void startRecording() {
        record_->setChecked(false);
        const auto failed = [&](const Error& error) { messages_.warn(errorText(error)); };
        const auto path = takePath(project(), name_->text().toStdString());
        if (!path) return failed(path.error());
        if (!fileIsFree(name_->text()))
            return messages_.warn(
                QString("There is a take “%1” already. Choose another name").arg(name_->text()));
        std::error_code code;
        const auto folder = path->parent_path();
        std::filesystem::create_directory(folder, code);
        if (code)
            return messages_.warn(
                QString("%1 cannot be made: %2")
                    .arg(QString::fromStdString(folder.string()), QString::fromStdString(code.message())));
        const FramePace pace = player_.pace();
        auto writer = TakeWriter::open(
            *path, document_.groom(), pace.framesPerSecond,
            takeNotes(player_.motion().toStdString(), document_.groom(), "cpu", pace.preRoll));
        if (!writer) {
            std::filesystem::remove(folder, code);  // where nothing is in it
            return failed(writer.error());
        }
        recorder_ = std::make_shared<TakeRecorder>(std::move(*writer));
        recordedName_ = name_->text();
        view_->stop();
        player_.setEngine(EngineWish::cpu);
        // Frames of the time line's takes are those of its range.
        if (player_.motion() == Player::kTimeLine) player_.reset();
        player_.setRecorder(recorder_);
        if (!player_.isPlaying()) player_.play();
        watch_.start();
        showState();
    }

    void finishRecording() {
        if (!recorder_) return;
        watch_.stop();
        player_.setRecorder(nullptr);
        player_.setEngine(static_cast<EngineWish>(preferences_.simulateOn()));
        player_.pause();
        const Status status = recorder_->finish();
        const std::uint64_t frames = recorder_->frames();
        recorder_.reset();
        if (!status) messages_.warn(errorText(status.error()));
        if (status && frames == 0) {
            // Nothing has played.
            if (auto removed = removeTake(std::filesystem::path(filledFor_.toStdU16String()),
                                          recordedName_.toStdString());
                !removed)
                messages_.warn(errorText(removed.error()));
            return fill();
        }
        if (status) messages_.say(QString("Recorded %1 frames as “%2”").arg(frames).arg(recordedName_));
        fill(recordedName_);
    }

    void watchRecording() {
        if (recorder_ && recorder_->hasFailed()) return finishRecording();
        showState();
    }

    // --- What the selected one is for ---

    void showSelected() {
        const QString name = selected();
        if (name.isEmpty() || recorder_) return;
        if (auto status = view_->show(fileOf(name)); !status) messages_.warn(errorText(status.error()));
        showState();
    }

    void exportSelected() {
        const std::filesystem::path take = fileOf(selected());
        const auto reader = TakeReader::open(take);
        if (!reader) return messages_.warn(errorText(reader.error()));
        if (reader->info().frames == 0)
            return messages_.warn(QString("The take “%1” has no frames").arg(selected()));
        TakeExportDialog(selected(), take, reader->info(), document_, tasks_, messages_, this).exec();
    }

    /// The name has been edited, or what stands beside it, which comes back.
    void rename(QTreeWidgetItem& item) {
        const QString old = item.data(kTakeColumn, Qt::UserRole).toString(), name = item.text(kTakeColumn);
        QString kept = old;
        if (name != old) {
            view_->stop();
            const auto status = renameTake(project(), old.toStdString(), name.toStdString());
            if (status) kept = name;
            if (!status) messages_.warn(errorText(status.error()));
        }
        // Not while the list still handles the edit.
        QMetaObject::invokeMethod(
            this, [this, kept] { fill(kept); }, Qt::QueuedConnection);
    }

    void remove() {
        const QString name = selected();
        if (name.isEmpty()) return;
        QMessageBox box(QMessageBox::Warning, "Delete take", QString("Delete the take “%1”?").arg(name),
                        QMessageBox::NoButton, this);
        box.setInformativeText("Its file goes. This cannot be undone.");
        auto* yes = box.addButton("Delete", QMessageBox::DestructiveRole);
        yes->setObjectName("takeDeleteYes");
        yes->setToolTip("Delete the file of the take");
        auto* no = box.addButton("Cancel", QMessageBox::RejectRole);
        no->setToolTip("Keep the take");
        box.setDefaultButton(no);
        box.setEscapeButton(no);
        box.exec();
        if (box.clickedButton() != yes) return;
        view_->stop();
        if (auto status = removeTake(project(), name.toStdString()); !status)
            messages_.warn(errorText(status.error()));
        fill();
    }

    void takeShape() {
        const RecordedFrame* const frame = view_->frame();
        if (frame == nullptr) return;
        const std::uint64_t number = view_->number();
        auto command =
            editing::takeShape(document_.editing().model(),
                               restPositions(document_.groom(), frame->positions_ws, frame->pose), true);
        if (!command) return messages_.warn(errorText(command.error()));
        player_.reset();
        document_.perform(std::move(*command));
        messages_.say(QString("Frame %1 is now the rest shape").arg(number));
    }

    // --- What is shown ---

    void showNumber(quint64 number) {
        showing_ = true;
        slider_->setMaximum(static_cast<int>(std::max<std::uint64_t>(view_->info().frames, 1) - 1));
        slider_->setValue(static_cast<int>(number));
        number_->setText(QString("%1 / %2").arg(number).arg(view_->info().frames));
        showing_ = false;
        showDistance();
    }
    void showDistance() {
        const auto distance = view_->distance();
        distance_->setVisible(distance.has_value());
        if (!distance) return;
        const auto text = [&](double metres) { return lengthText(metres, preferences_); };
        distance_->setText(
            QString("Apart: %1 on average, %2 at most. Strands are red from %3.")
                .arg(text(distance->mean), text(distance->largest), text(static_cast<double>(kRedDistance))));
    }

    void showPlaying() { play_->setIcon(icon(view_->isPlaying() ? "pause" : "play")); }

    void showState() {
        const bool saved = !document_.path().isEmpty(), hair = document_.groom().strandCount() > 0;
        const bool records = recorder_ != nullptr;
        record_->setEnabled(records || (saved && hair));
        record_->setChecked(records);
        record_->setText(records ? "Stop" : "Record");
        record_->setToolTip(records ? "Stop and keep the take"
                                    : "Keep what plays from now on, of a time line from its start. The CPU "
                                      "simulates while you record");
        name_->setEnabled(!records);
        list_->setEnabled(!records);
        const double perMinute = kTakeBytesPerPoint * static_cast<double>(document_.groom().pointCount()) *
                                 60 * static_cast<double>(player_.pace().framesPerSecond);
        if (records)
            recordState_->setText(QString("%1 frames, %2")
                                      .arg(recorder_->frames())
                                      .arg(takeSizeText(static_cast<double>(recorder_->bytes()))));
        else if (!saved)
            recordState_->setText("Save the project to record: takes are kept beside it.");
        else if (!hair)
            recordState_->setText("There are no strands to record yet.");
        else
            recordState_->setText(QString("A minute takes about %1.").arg(takeSizeText(perMinute)));
        const bool shown = view_->isShown();
        for (QWidget* widget : std::initializer_list<QWidget*>{play_, slider_, speed_, other_, shape_})
            widget->setEnabled(shown && !records);
        actions_->setActive(shown && !records);
        for (QPushButton* button : {export_, rename_, remove_})
            button->setEnabled(!selected().isEmpty() && !records);
        if (!shown) number_->setText({});
        showDistance();
        showPlaying();
    }

    QtDocument& document_;
    Preferences& preferences_;
    Tasks& tasks_;
    Messages& messages_;
    Player& player_;
    TakeView* view_;
    TakeActions* actions_;
    QLineEdit* name_ = nullptr;
    QPushButton *record_ = nullptr, *play_ = nullptr, *shape_ = nullptr, *export_ = nullptr,
                *rename_ = nullptr, *remove_ = nullptr;
    QLabel *recordState_ = nullptr, *number_ = nullptr, *distance_ = nullptr;
    QTreeWidget* list_ = nullptr;
    QSlider* slider_ = nullptr;
    QComboBox *speed_ = nullptr, *other_ = nullptr;
    QTimer watch_;
    std::shared_ptr<TakeRecorder> recorder_;
    QString recordedName_, filledFor_;
    bool filling_ = false;
    bool showing_ = false;  ///< the slider follows the view
};

}  // namespace

PanelInfo takesPanel() {
    return {"takes",
            QString("Takes"),
            "record",
            Qt::RightDockWidgetArea,
            75,
            true,
            [](const PanelParts& parts) -> QWidget* { return scrolled(column({new TakesPanel(parts)})); }};
}

}  // namespace hairloom::editor
