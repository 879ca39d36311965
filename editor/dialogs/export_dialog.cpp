// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/export_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHeaderView>
#include <QPointer>
#include <QVBoxLayout>
#include <algorithm>
#include <atomic>

#include "core/documents/hair_export.h"
#include "core/documents/web_page.h"
#include "core/live/played_frames.h"
#include "core/stability/certificate.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/length_text.h"
#include "importers/length_unit.h"

namespace hairloom::editor {

namespace {

constexpr float kFramesPerSecond = 60;
constexpr int kMostFrames = 10000;

/// A program, and the writer of the format that it reads.
struct Choice {
    const StrandWriter* writer;
    const ExportTarget* target;
    bool isPage = false;  ///< a folder around the writer's file
};

const ExportTarget& pageTarget() {
    static const ExportTarget target{
        "browser",
        "Web page with moving hair",
        "A folder with index.html that opens without a network and plays the runtime asset",
        {}};
    return target;
}

/// By the names of the formats.
const std::vector<Choice>& choices() {
    static const std::vector<Choice> all = [] {
        std::vector<Choice> list;
        for (const StrandWriter& writer : hairWriters()) {
            for (const ExportTarget& target : writer.targets) list.push_back({&writer, &target});
        }
        list.push_back({&strandWriter("runtime"), &pageTarget(), true});
        std::ranges::stable_sort(list, {}, [](const Choice& choice) { return choice.writer->label; });
        return list;
    }();
    return all;
}

}  // namespace

ExportDialog::ExportDialog(QtDocument& document, const Preferences& preferences, Tasks& tasks,
                           Messages& messages, const Player& player, QWidget* parent)
    : QDialog(parent),
      document_(document),
      preferences_(preferences),
      tasks_(tasks),
      messages_(messages),
      player_(player),
      form_(new QFormLayout),
      target_(new QComboBox),
      what_(new QComboBox),
      layers_(new QComboBox),
      frames_(new QSpinBox),
      note_(new QLabel),
      unit_(new QComboBox),
      up_(new QComboBox),
      points_(new QSpinBox),
      cards_(new QSpinBox),
      textures_(new QSpinBox),
      certify_(new QCheckBox(tr("What your game may do to this hair"))),
      summary_(new QLabel),
      findings_(new QTreeWidget) {
    setWindowTitle(tr("Export hair"));
    resize(620, 560);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(20, 20, 20, 16);
    layout->setSpacing(12);
    form_->setHorizontalSpacing(16);
    form_->setVerticalSpacing(8);
    form_->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    layout->addLayout(form_);
    for (const Choice& choice : choices()) target_->addItem(QString::fromStdString(choice.target->name));
    target_->setObjectName("target");
    target_->setToolTip(tr("Sets the unit, up axis and point count that this program expects"));
    what_->addItem(tr("Guides: the strands of the document"), static_cast<int>(ExportedHair::guides));
    what_->addItem(tr("Rendered hairs: what the viewport shows"), static_cast<int>(ExportedHair::hairs));
    what_->setObjectName("what");
    what_->setToolTip(tr(
        "Choose guides for programs that interpolate hair themselves. Choose rendered hairs for all others"));
    layers_->setObjectName("layers");
    layers_->addItem(tr("All layers"));
    layers_->addItem(tr("Visible layers"));
    for (const Layer& layer : document_.groom().layers)
        layers_->addItem(QString::fromStdString(layer.name), QString::fromStdString(layer.name));
    layers_->setToolTip(tr("Which layers to export"));
    frames_->setObjectName("frames");
    frames_->setRange(0, kMostFrames);
    frames_->setSpecialValueText(tr("at rest"));
    frames_->setToolTip(
        tr("Number of 1/60 s frames to simulate for the file, with the motion of the viewport or a nod. "
           "Formats without animation hold one frame"));
    note_->setProperty("role", "dim");
    note_->setWordWrap(true);
    for (const LengthUnit& unit : lengthUnits()) unit_->addItem(unit.name, unit.metres);
    unit_->setToolTip(
        tr("Length of one unit in the file. A wrong unit makes hair a hundred times too large or too small"));
    up_->addItems({tr("Y up"), tr("Z up")});
    up_->setToolTip(tr("Up axis of the file"));
    points_->setRange(0, 1024);
    points_->setSpecialValueText(tr("unchanged"));
    points_->setToolTip(tr("Resamples every strand to this number of evenly spaced points"));
    form_->addRow(tr("Target"), target_);
    form_->addRow(QString(), note_);
    form_->addRow(tr("Strands"), what_);
    form_->addRow(tr("Layers"), layers_);
    form_->addRow(tr("Frames"), frames_);
    form_->addRow(tr("Unit"), unit_);
    form_->addRow(tr("Axis"), up_);
    form_->addRow(tr("Points per strand"), points_);
    const LevelBudget budget;
    cards_->setObjectName("cards");
    cards_->setRange(1, 4096);
    cards_->setValue(static_cast<int>(budget.cards));
    cards_->setToolTip(
        tr("Maximum number of cards in the nearest level. Farther levels have a half and a quarter of them"));
    textures_->setObjectName("textures");
    textures_->setRange(1, 256);
    textures_->setValue(static_cast<int>(budget.chain.textures));
    textures_->setToolTip(tr("Maximum number of textures in a level. Cards that look alike share one"));
    form_->addRow(tr("Cards"), cards_);
    form_->addRow(tr("Textures"), textures_);
    certify_->setObjectName("certify");
    certify_->setToolTip(
        tr("Tests the hair in a thousand random storms, which takes about half a minute. The report has the "
           "result, and a runtime asset carries it"));
    form_->addRow(tr("Certify"), certify_);
    summary_->setWordWrap(true);
    layout->addWidget(summary_);
    findings_->setObjectName("findings");
    findings_->setHeaderLabels({tr("Finding"), tr("Where"), tr("What to do")});
    findings_->setRootIsDecorated(false);
    findings_->setWordWrap(true);
    findings_->header()->resizeSection(0, 240);
    findings_->header()->resizeSection(1, 110);
    findings_->setSelectionMode(QAbstractItemView::NoSelection);
    layout->addWidget(findings_, 1);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    write_ = buttons->addButton(tr("Export…"), QDialogButtonBox::AcceptRole);
    write_->setDefault(true);
    write_->setToolTip(tr("Choose a file name and export"));
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(write_, &QPushButton::clicked, this, &ExportDialog::choosePath);
    connect(target_, &QComboBox::currentIndexChanged, this, &ExportDialog::takeTarget);
    takeTarget(0);
    write_->setEnabled(document_.groom().strandCount() > 0);
}

void ExportDialog::takeTarget(int index) {
    const Choice& choice = choices()[static_cast<std::size_t>(index)];
    const ExportTarget& target = *choice.target;
    const bool cards = choice.writer->holdsCards();
    for (QWidget* ofStrands : {static_cast<QWidget*>(what_), static_cast<QWidget*>(unit_),
                               static_cast<QWidget*>(up_), static_cast<QWidget*>(points_)})
        form_->setRowVisible(ofStrands, !cards);
    for (QWidget* ofCards : {cards_, textures_}) form_->setRowVisible(ofCards, cards);
    frames_->setMaximum(cards ? 1 : kMostFrames);
    summary_->setText(cards ? tr("Each level is compared with the strands at its distance.")
                            : tr("The file is read back after export and compared with the hair."));
    note_->setText(QString::fromStdString(target.note));
    for (int i = 0; i < unit_->count(); ++i) {
        if (static_cast<float>(unit_->itemData(i).toDouble()) == target.options.metresPerUnit)
            unit_->setCurrentIndex(i);
    }
    up_->setCurrentIndex(target.options.up == UpAxis::Z ? 1 : 0);
    points_->setValue(static_cast<int>(target.options.pointsPerStrand));
}

void ExportDialog::choosePath() {
    const Choice& choice = choices()[static_cast<std::size_t>(target_->currentIndex())];
    const QString title = QFileInfo(document_.title()).completeBaseName();
    if (choice.isPage) {
        const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder for the web page"));
        if (!folder.isEmpty()) exportTo(folder + "/" + title);
        return;
    }
    const QString suffix = "." + QString::fromStdString(choice.writer->suffix());
    const QString name = title + suffix;
    const QString path = QFileDialog::getSaveFileName(this, windowTitle(), name, "*" + suffix);
    if (!path.isEmpty()) exportTo(path);
}

void ExportDialog::exportTo(const QString& path) {
    const Choice& choice = choices()[static_cast<std::size_t>(target_->currentIndex())];
    const StrandWriter& writer = *choice.writer;
    StrandExportOptions options;
    options.limits = choice.target->options.limits;
    options.metresPerUnit = static_cast<float>(unit_->currentData().toDouble());
    options.up = up_->currentIndex() == 1 ? UpAxis::Z : UpAxis::Y;
    options.pointsPerStrand = static_cast<std::uint32_t>(points_->value());
    HairToExport wanted;
    wanted.hair = static_cast<ExportedHair>(what_->currentData().toInt());
    if (certify_->isChecked()) wanted.storms = CertificateOptions{}.storms;
    wanted.levels.cards = static_cast<std::uint32_t>(cards_->value());
    wanted.levels.chain.textures = static_cast<std::uint32_t>(textures_->value());
    for (const Layer& layer : document_.groom().layers) {
        const bool isShown = layers_->currentIndex() == 1 && layer.visible;
        if (isShown || layers_->currentData().toString().toStdString() == layer.name)
            wanted.layers.push_back(layer.name);
    }
    if (layers_->currentIndex() == 1 && wanted.layers.empty())
        return messages_.warn(tr("No layer is visible, so there is nothing to export"));
    if (choice.isPage && frames_->value() > 0)
        return messages_.warn(tr("A web page simulates the hair itself: set Frames to “at rest”"));
    auto motion = player_.makeMeasuredMotion();
    if (!motion) return messages_.warn(errorText(motion.error()));
    const std::shared_ptr<const HeadMotion> moves = std::move(*motion);
    const auto count = static_cast<std::uint32_t>(frames_->value());
    write_->setEnabled(false);
    const bool started = tasks_.run<ExportReport>(
        tr("Exporting %1").arg(QFileInfo(path).fileName()),
        [groom = document_.groom(), wanted, moves, count, path, options, &writer,
         isPage = choice.isPage](TaskControl& control) mutable -> Result<ExportReport> {
            if (count > 0) {
                auto frames = playFrames(groom, *moves, count, kFramesPerSecond, [&](std::uint32_t done) {
                    control.setProgress(static_cast<float>(done) / static_cast<float>(count));
                    return !control.isCancelled();
                });
                if (!frames) return tl::unexpected(frames.error());
                wanted.frames = std::move(*frames);
            }
            std::atomic<bool> stop = false;
            wanted.progress = [&](std::string_view, double share) {
                control.setProgress(static_cast<float>(share));
                stop = control.isCancelled();
            };
            wanted.cancel = &stop;
            if (isPage) return exportWebPage(groom, wanted, path.toStdString());
            return exportHair(groom, wanted, writer, path.toStdString(), options);
        },
        [self = QPointer(this), &messages = messages_, path](ExportReport report) {
            messages.say((report.levels.empty() ? tr("Exported %1 and read it back") : tr("Exported %1"))
                             .arg(QFileInfo(path).fileName()));
            if (!self) return;
            self->report_ = std::move(report);
            self->showReport();
        });
    if (!started) write_->setEnabled(true);
    connect(&tasks_, &Tasks::stopped, this, [this] { write_->setEnabled(true); });
}

QString ExportDialog::summary() const {
    const QString size =
        locale().formattedDataSize(static_cast<qint64>(report_.bytes), 1, QLocale::DataSizeSIFormat);
    if (!report_.levels.empty())
        return tr("%1: %L2 strands as cards, %L3 vertices, %4.")
            .arg(QString::fromStdString(report_.format))
            .arg(report_.strands)
            .arg(report_.points)
            .arg(size);
    QString words = tr("%1: %L2 strands, %L3 points, %4.")
                        .arg(QString::fromStdString(report_.format))
                        .arg(report_.strands)
                        .arg(report_.points)
                        .arg(size);
    if (report_.maxErrorMm)
        words += ' ' + tr("Largest distance of a point in the file from the hair: %1.")
                           .arg(lengthText(1e-3 * *report_.maxErrorMm, preferences_));
    return words;
}

void ExportDialog::showReport() {
    summary_->setText(summary());
    findings_->clear();
    const auto add = [&](const std::string& what, const QString& where, const std::string& fix) {
        auto* item = new QTreeWidgetItem({QString::fromStdString(what), where, QString::fromStdString(fix)});
        for (int c = 0; c < 3; ++c) item->setToolTip(c, item->text(c));
        findings_->addTopLevelItem(item);
    };
    if (const auto& limits = report_.safeLimits)
        add("withstands " +
                inWords(StormStrength{static_cast<double>(limits->largestStep),
                                      static_cast<double>(limits->rootSpeed),
                                      static_cast<double>(limits->turn), static_cast<double>(limits->wind)}),
            tr("certificate"),
            tr("%1 random storms; %2 failed beyond these limits")
                .arg(limits->storms)
                .arg(limits->failed)
                .toStdString());
    for (const std::string& companion : report_.companions)
        add(companion, tr("in a separate file"), tr("exported with the strands").toStdString());
    for (const LeftBehind& left : report_.leftBehind) add(left.what, tr("not exported"), left.fix);
    for (const Finding& finding : report_.findings)
        add(finding.what, QString::fromStdString(finding.where), finding.fix);
    for (const ComparedAttribute& attribute : report_.attributes)
        add(attribute.name, tr("attribute"),
            tr("exported as %1").arg(attribute.maxError, 0, 'g', 3).toStdString());
    for (const WrittenLevel& level : report_.levels)
        add(level.name, tr("from %1 m").arg(level.distance, 0, 'f', 2),
            tr("coverage %1, light %2 of the strands, FLIP %3")
                .arg(level.coverage, 0, 'f', 3)
                .arg(level.light, 0, 'f', 3)
                .arg(level.flip, 0, 'f', 3)
                .toStdString());
    if (findings_->topLevelItemCount() == 0)
        findings_->addTopLevelItem(new QTreeWidgetItem({tr("Nothing to fix")}));
    wrapRows(*findings_);
}

}  // namespace hairloom::editor
