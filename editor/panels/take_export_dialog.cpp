// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/take_export_dialog.h"

#include <QDialogButtonBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "core/base/output_batch.h"
#include "core/documents/takes.h"
#include "core/simulation/take_file.h"
#include "editor/document/task_watch.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {
namespace {

constexpr const char* kTakeFormatAtFirst = "abc";

const HairWriter* writerOfTake(const std::string& format) {
    return format == kRecordFormat ? nullptr : &strandWriter(format, hairWriters());
}

SaveFormat fileOfTake(const std::string& format) {
    const HairWriter* const writer = writerOfTake(format);
    if (writer == nullptr) return {"Record of frames", kRecordFormat};
    return {QString::fromStdString(writer->label), QString::fromStdString(writer->suffix())};
}

QString noteOfTake(const std::string& format) {
    const HairWriter* const writer = writerOfTake(format);
    if (writer == nullptr) return "All points of each frame, for hairloom-cli and programs of your own";
    if (writer->holdsClips) return "An asset for games. Its clip plays without simulating";
    return QString::fromStdString(writer->targets.front().note);
}

QSpinBox* frameBox(const char* name, const QString& tip, std::uint64_t frames) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    auto* box = new QSpinBox;
    box->setObjectName(name);
    box->setRange(0, static_cast<int>(std::min(frames - 1, kMost)));
    box->setToolTip(tip);
    box->setAccessibleName(tip);
    return box;
}

/// What is said of a finished export, and whether it is a warning.
std::pair<QString, bool> wordsOfExport(const QString& path, std::uint64_t frames,
                                       const ExportReport& report) {
    QString words = QString("Exported %1: %L2 frames, %3")
                        .arg(QFileInfo(path).fileName())
                        .arg(frames)
                        .arg(numberLocale().formattedDataSize(static_cast<qint64>(report.bytes), 1,
                                                              QLocale::DataSizeSIFormat));
    const auto warning = std::ranges::find(report.findings, Severity::Warning, &Finding::severity);
    if (warning == report.findings.end()) return {words, false};
    return {words + "; " + QString::fromStdString(warning->what), true};
}

}  // namespace

TakeExportDialog::TakeExportDialog(const QString& name, std::filesystem::path take, const TakeInfo& info,
                                   const QtDocument& document, Tasks& tasks, Messages& messages,
                                   QWidget* parent)
    : QDialog(parent),
      name_(name),
      take_(std::move(take)),
      info_(info),
      document_(document),
      tasks_(tasks),
      messages_(messages),
      form_(new QFormLayout),
      format_(new QComboBox),
      what_(new QComboBox),
      first_(frameBox("takeFirst", "First frame to export", info.frames)),
      last_(frameBox("takeLast", "Last frame to export", info.frames)),
      loops_(new QCheckBox("Loop")),
      note_(new QLabel),
      summary_(new QLabel) {
    setWindowTitle("Export take");
    resize(440, 0);
    auto* layout = exportLayout(*this, *form_);
    layout->addLayout(form_);
    for (const std::string& format : formats_) {
        files_.push_back(fileOfTake(format));
        format_->addItem(files_.back().label, QString::fromStdString(format));
    }
    format_->setObjectName("takeFormat");
    format_->setToolTip("Format of the file. You can also type its suffix as the end of the file name");
    format_->setCurrentIndex(std::max(0, format_->findData(kTakeFormatAtFirst)));
    form_->addRow("Format", format_);
    note_->setObjectName("takeFormatNote");
    note_->setProperty("role", "dim");
    note_->setWordWrap(true);
    form_->addRow(QString(), note_);
    what_->addItem("Guides: the strands of the document", static_cast<int>(ExportedHair::guides));
    what_->addItem("Rendered hairs: what the viewport shows", static_cast<int>(ExportedHair::hairs));
    what_->setObjectName("takeWhat");
    what_->setToolTip(
        "Choose guides for programs that interpolate hair themselves. Choose rendered hairs for all others");
    form_->addRow("Hair", what_);
    last_->setValue(last_->maximum());
    auto* range = new QWidget;
    auto* ends = new QHBoxLayout(range);
    ends->setContentsMargins(0, 0, 0, 0);
    ends->addWidget(first_, 1);
    ends->addWidget(new QLabel("to"));
    ends->addWidget(last_, 1);
    form_->addRow("Frames", range);
    loops_->setObjectName("takeLoops");
    loops_->setToolTip("The clip starts again after its last frame");
    loops_->setChecked(loopOfNotes(info.notes).has_value());
    form_->addRow("Clip", loops_);
    summary_->setObjectName("takeWillExport");
    summary_->setWordWrap(true);
    layout->addWidget(summary_);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
    export_ = buttons->addButton("Export…", QDialogButtonBox::AcceptRole);
    export_->setObjectName("takeExportAs");
    export_->setDefault(true);
    export_->setToolTip("Choose a file name and export. v### in the name takes the next free version");
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(export_, &QPushButton::clicked, this, &TakeExportDialog::choosePath);
    connect(format_, &QComboBox::currentIndexChanged, this, &TakeExportDialog::showRows);
    for (QSpinBox* box : {first_, last_})
        connect(box, &QSpinBox::valueChanged, this, &TakeExportDialog::showRows);
    connect(&tasks_, &Tasks::stopped, this, &TakeExportDialog::showRows);
    showRows();
}

bool TakeExportDialog::canChooseHair(const std::string& format) const {
    return document_.groom().interpolation.followPerGuide > 0 && canExportHairs(format);
}

TakeToExport TakeExportDialog::wanted() const {
    TakeToExport asked;
    asked.name = name_.toStdString();
    asked.format = formats_[static_cast<std::size_t>(format_->currentIndex())];
    asked.first = static_cast<std::uint64_t>(first_->value());
    asked.last = static_cast<std::uint64_t>(last_->value());
    const HairWriter* const writer = writerOfTake(asked.format);
    asked.hair = canChooseHair(asked.format) ? static_cast<ExportedHair>(what_->currentData().toInt())
                                             : ExportedHair::guides;
    asked.loops = writer != nullptr && writer->holdsClips && loops_->isChecked();
    return asked;
}

void TakeExportDialog::showRows() {
    const TakeToExport asked = wanted();
    const HairWriter* const writer = writerOfTake(asked.format);
    form_->setRowVisible(loops_, writer != nullptr && writer->holdsClips);
    form_->setRowVisible(what_, canChooseHair(asked.format));
    note_->setText(noteOfTake(asked.format));
    const bool runsForward = asked.first <= asked.last;
    const bool hasChanged = info_.shapeHash != takeShapeHash(document_.groom());
    QString words;
    if (!runsForward)
        words = "The last frame comes before the first.";
    else if (hasChanged)
        words = "The groom or its head has changed shape since this take was recorded. ";
    if (runsForward) {
        const std::uint64_t frames = asked.last - asked.first + 1;
        words += QString("%L1 frames last %2 s at %3 frames per second.")
                     .arg(frames)
                     .arg(static_cast<double>(frames) / static_cast<double>(info_.framesPerSecond), 0, 'f', 2)
                     .arg(static_cast<double>(info_.framesPerSecond));
    }
    summary_->setText(words);
    export_->setEnabled(runsForward && !tasks_.isBusy());
    adjustSize();
}

void TakeExportDialog::choosePath() {
    const int format = format_->currentIndex();
    const QString name = QFileInfo(document_.title()).completeBaseName() + '-' + name_ + '.' +
                         files_[static_cast<std::size_t>(format)].suffix;
    const auto place = askWhereToSave(this, windowTitle(), name, files_, format);
    if (!place) return;
    format_->setCurrentIndex(place->format);
    if (mayReplaceFile(this, place->path)) exportTo(place->path);
}

void TakeExportDialog::exportTo(const QString& path) {
    const TakeToExport asked = wanted();
    const std::uint64_t frames = asked.last - asked.first + 1;
    const bool started = tasks_.run<ExportReport>(
        QString("Exporting %1").arg(QFileInfo(path).fileName()),
        [groom = document_.groom(), take = take_, asked, path](TaskControl& control) -> Result<ExportReport> {
            auto reader = openTakeFor(take, groom);
            if (!reader) return tl::unexpected(reader.error());
            TakeToExport watched = asked;
            watched.watch = watchOf(control);
            OutputBatch batch;
            auto report = exportTake(*reader, groom, watched, path.toStdString());
            if (!report) return report;
            if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
            return report;
        },
        [&messages = messages_, path, frames](ExportReport report) {
            const auto [words, isWarning] = wordsOfExport(path, frames, report);
            if (isWarning) return messages.warn(words);
            messages.say(words);
        });
    if (started) accept();
}

}  // namespace hairloom::editor
