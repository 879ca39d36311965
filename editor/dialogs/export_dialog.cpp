// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/export_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHeaderView>
#include <QPointer>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "core/base/output_batch.h"
#include "core/colour/colour_choice.h"
#include "core/documents/hair_export.h"
#include "core/documents/web_page.h"
#include "core/groom/strand_subset.h"
#include "core/live/played_frames.h"
#include "core/stability/certificate.h"
#include "editor/dialogs/export_choices.h"
#include "editor/document/publishing.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/length_text.h"
#include "editor/fields/number_spin.h"
#include "editor/fields/save_file.h"
#include "exporters/usd_scene.h"
#include "importers/length_unit.h"

namespace hairloom::editor {

namespace {

constexpr int kMostFrames = 10000;

/// Bytes of a point in the formats' files, measured on the samples; text takes what its digits take.
double bytesOfPoint(const HairWriter& writer) {
    static const std::map<std::string, double> bytes{
        {"abc", 17}, {"abc-unreal", 21}, {"hair", 16}, {"obj-c4d", 98}, {"obj-lines", 42},
        {"ply", 20}, {"runtime", 11},    {"tfx", 16},  {"usda", 55},    {"usdc", 17}};
    const auto found = bytes.find(writer.name);
    return found == bytes.end() ? 16 : found->second;
}

/// What USD has of hair at rest beside the curves: the scalp, and where operators start from.
double bytesBeside(const HairWriter& writer, const Groom& groom, std::size_t pointsOfOperators) {
    const bool isText = writer.name == "usda";
    if (!isText && writer.name != "usdc") return 0;
    return static_cast<double>(groom.scalpSelection.size()) * (isText ? 137 : 52) +
           static_cast<double>(pointsOfOperators) * (isText ? 39 : 12);
}

/// More than a game moves each by itself.
constexpr std::size_t kManyGuides = 6000;

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
      format_(new QComboBox),
      what_(new QComboBox),
      layers_(new QComboBox),
      frames_(new QSpinBox),
      motion_(new MotionRows(player.pace(), this)),
      note_(new QLabel),
      problem_(new QLabel),
      many_(new QLabel),
      cluster_(new QPushButton("Guides by clustering…")),
      unit_(new QComboBox),
      up_(new QComboBox),
      points_(new QSpinBox),
      cards_(new QSpinBox),
      textures_(new QSpinBox),
      certify_(new QCheckBox("What your game may do to this hair")),
      physics_(new QCheckBox("Physics of curves")),
      manifest_(new QCheckBox("Hashes of the files and the project")),
      summary_(new QLabel),
      findings_(new QTreeWidget) {
    setWindowTitle("Export hair");
    resize(620, 640);
    auto* layout = exportLayout(*this, *form_);
    layout->addLayout(form_);
    for (const ExportProgram& program : programsToExportFor()) target_->addItem(program.name);
    target_->setObjectName("target");
    target_->setToolTip("Sets the format, unit, up axis and point count that this program expects");
    format_->setObjectName("format");
    format_->setToolTip("Formats that the program reads, with the most complete one first");
    what_->addItem("Guides: the strands of the document", static_cast<int>(ExportedHair::guides));
    what_->addItem("Rendered hairs: what the viewport shows", static_cast<int>(ExportedHair::hairs));
    what_->setObjectName("what");
    what_->setToolTip(
        "Choose guides for programs that interpolate hair themselves. Choose rendered hairs for all others");
    layers_->setObjectName("layers");
    layers_->addItem("All layers");
    layers_->addItem("Visible layers");
    for (const Layer& layer : document_.groom().layers)
        layers_->addItem(QString::fromStdString(layer.name), QString::fromStdString(layer.name));
    layers_->setToolTip("Which layers to export");
    frames_->setObjectName("frames");
    frames_->setRange(0, kMostFrames);
    frames_->setSpecialValueText("at rest");
    frames_->setToolTip(
        "Number of frames to simulate for the file, with the motion of the viewport or a nod. "
        "Formats without animation hold one frame");
    note_->setProperty("role", "dim");
    note_->setWordWrap(true);
    problem_->setObjectName("problem");
    problem_->setWordWrap(true);
    problem_->setProperty("role", "problem");
    many_->setObjectName("manyGuides");
    many_->setWordWrap(true);
    cluster_->setObjectName("cluster");
    cluster_->setAutoDefault(false);
    cluster_->setToolTip("Closes this dialog and reduces the strands to a few guides that the others follow");
    connect(cluster_, &QPushButton::clicked, this, [this] { done(kWantsClustering); });
    for (const LengthUnit& unit : lengthUnits()) unit_->addItem(unit.name, unit.metres);
    unit_->setToolTip(
        "Length of one unit in the file. A wrong unit makes hair a hundred times too large or too small");
    up_->addItems({"Y up", "Z up"});
    up_->setToolTip("Up axis of the file");
    points_->setRange(0, 1024);
    points_->setSpecialValueText("unchanged");
    points_->setToolTip("Resamples every strand to this number of evenly spaced points");
    form_->addRow("Target", target_);
    form_->addRow("Format", format_);
    form_->addRow(QString(), note_);
    form_->addRow(QString(), problem_);
    form_->addRow("Strands", what_);
    form_->addRow("Layers", layers_);
    form_->addRow("Frames", frames_);
    motion_->addTo(*form_);
    form_->addRow("Unit", unit_);
    form_->addRow("Axis", up_);
    form_->addRow("Points per strand", points_);
    const LevelBudget budget;
    cards_->setObjectName("cards");
    cards_->setRange(1, 4096);
    cards_->setValue(static_cast<int>(budget.cards));
    cards_->setToolTip(
        "Maximum number of cards in the nearest level. Farther levels have a half and a quarter of them");
    textures_->setObjectName("textures");
    textures_->setRange(0, 256);
    textures_->setValue(static_cast<int>(budget.chain.textures));
    textures_->setSpecialValueText("Automatic");
    textures_->setToolTip(
        "Maximum number of textures in a level. Cards that look alike share one. Automatic makes as many as "
        "fit "
        "the atlas that 32 need");
    form_->addRow("Cards", cards_);
    form_->addRow("Textures", textures_);
    certify_->setObjectName("certify");
    certify_->setToolTip(
        "Tests the hair in a thousand random storms, which takes about half a minute. The report has the "
        "result, and a runtime asset carries it");
    form_->addRow("Stress test", certify_);
    physics_->setObjectName("physics");
    physics_->setToolTip(
        "Adds deformable curves for simulators that read USD's physics (PhysicsCurvesDeformableSimAPI), "
        "with the "
        "stiffness and thickness of the hair");
    form_->addRow("Simulators", physics_);
    manifest_->setObjectName("manifest");
    manifest_->setToolTip(
        "Writes NAME.manifest.json beside the files: their bytes and hashes, the project, and its settings");
    form_->addRow("Manifest", manifest_);
    layout->addWidget(many_);
    layout->addWidget(cluster_, 0, Qt::AlignLeft);
    summary_->setObjectName("willWrite");
    summary_->setWordWrap(true);
    layout->addWidget(summary_);
    findings_->setObjectName("findings");
    findings_->setAccessibleName("Findings");
    findings_->setHeaderLabels({"Finding", "Where", "What to do"});
    findings_->setRootIsDecorated(false);
    findings_->setWordWrap(true);
    findings_->header()->resizeSection(0, 240);
    findings_->header()->resizeSection(1, 110);
    findings_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    findings_->setSelectionMode(QAbstractItemView::NoSelection);
    layout->addWidget(findings_, 1);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    write_ = buttons->addButton("Export…", QDialogButtonBox::AcceptRole);
    write_->setObjectName("export");
    write_->setDefault(true);
    write_->setToolTip("Choose a file name and export. v### in the name takes the next free version");
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(write_, &QPushButton::clicked, this, &ExportDialog::choosePath);
    connect(target_, &QComboBox::currentIndexChanged, this, &ExportDialog::takeProgram);
    connect(format_, &QComboBox::currentIndexChanged, this, [this](int index) {
        if (index >= 0) takeTarget();
    });
    for (QComboBox* box : {what_, layers_, unit_, up_})
        connect(box, &QComboBox::currentIndexChanged, this, &ExportDialog::showWhatWillBeWritten);
    for (QSpinBox* box : {frames_, points_, cards_})
        connect(box, &QSpinBox::valueChanged, this, &ExportDialog::showWhatWillBeWritten);
    connect(motion_, &MotionRows::changed, this, &ExportDialog::showWhatWillBeWritten);
    connect(&tasks_, &Tasks::stopped, this, [this] { write_->setEnabled(canWrite()); });
    takeProgram(0);
}

void ExportDialog::takeProgram(int index) {
    {
        const QSignalBlocker quiet(format_);
        format_->clear();
        for (const ExportChoice& choice :
             programsToExportFor()[static_cast<std::size_t>(std::max(index, 0))].choices)
            format_->addItem(QString::fromStdString(choice.writer->label));
    }
    form_->setRowVisible(format_, format_->count() > 1);
    takeTarget();
}

bool ExportDialog::canWrite() const {
    return document_.groom().strandCount() > 0 && !tasks_.isBusy() &&
           problemOf(exportChoice(target_->currentIndex(), format_->currentIndex())).isEmpty();
}

std::vector<std::string> ExportDialog::layersToWrite() const {
    std::vector<std::string> names;
    for (const Layer& layer : document_.groom().layers) {
        const bool isShown = layers_->currentIndex() == 1 && layer.visible;
        if (isShown || layers_->currentData().toString().toStdString() == layer.name)
            names.push_back(layer.name);
    }
    return names;
}

void ExportDialog::showWhatWillBeWritten() {
    const ExportChoice& choice = exportChoice(target_->currentIndex(), format_->currentIndex());
    const Groom& groom = document_.groom();
    motion_->show(*form_, choice.writer->animates && !choice.isPage && frames_->value() > 0);
    form_->setRowVisible(physics_, choice.writer->holdsPhysics && frames_->value() == 0);
    // What was found belongs to what was written, which would be something else now.
    findings_->clear();
    report_ = {};
    const std::vector<std::string> names = layersToWrite();
    std::vector<std::uint32_t> strands(groom.strandCount());
    std::iota(strands.begin(), strands.end(), 0u);
    if (!names.empty()) strands = strandsOfLayers(groom, names).value_or(std::vector<std::uint32_t>());
    if (layers_->currentIndex() == 1 && names.empty()) strands.clear();
    const bool isAsset = choice.writer->generatesFollowHairs;
    const auto flags = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
    std::size_t guides = 0, points = 0;
    for (const std::uint32_t s : strands) {
        guides += s < flags.size() ? flags[s] != 0 : 1;
        points += groom.offsets[s + 1] - groom.offsets[s];
    }
    many_->setVisible(isAsset && guides > kManyGuides);
    cluster_->setVisible(isAsset && guides > kManyGuides);
    many_->setText(
        QString("A game would simulate all %L1 guides, which is slow. Fewer guides with interpolated hairs "
                "look the same and cost a tenth.")
            .arg(guides));
    if (choice.writer->holdsCards()) {
        summary_->setText(QString("Will write up to %L1 cards and a shell, for %L2 strands. Each level is "
                                  "compared with the strands at its distance.")
                              .arg(cards_->value())
                              .arg(strands.size()));
        return;
    }
    std::size_t count = strands.size();
    const auto perGuide = static_cast<std::size_t>(groom.interpolation.followPerGuide);
    const auto hair = static_cast<ExportedHair>(what_->currentData().toInt());
    const bool isBaked = hair != ExportedHair::guides && perGuide > 0;
    if (isBaked) {
        const std::size_t perStrand = perGuide + (hair == ExportedHair::all ? 1 : 0);
        points = count > 0 ? points / count * guides * perStrand : 0;
        count = guides * perStrand;
    }
    if (points_->value() > 0) points = count * static_cast<std::size_t>(points_->value());
    const auto frames =
        motion_->isVisibleIn(*form_) ? static_cast<double>(motion_->samplesOf(frames_->value())) : 1.0;
    double bytes = static_cast<double>(points) * bytesOfPoint(*choice.writer) * frames;
    const bool hasOperators = !isBaked && usdHasOperators(groom, optionsAsked());
    if (frames_->value() == 0) bytes += bytesBeside(*choice.writer, groom, hasOperators ? points : 0);
    summary_->setText(
        QString(
            "Will write %L1 strands with %L2 points, about %3. The file is read back and compared with the "
            "hair.")
            .arg(count)
            .arg(points)
            .arg(numberLocale().formattedDataSize(static_cast<qint64>(bytes), 1, QLocale::DataSizeSIFormat)));
}

void ExportDialog::takeTarget() {
    const ExportChoice& choice = exportChoice(target_->currentIndex(), format_->currentIndex());
    const ExportTarget& target = *choice.target;
    const bool cards = choice.writer->holdsCards();
    for (QWidget* ofStrands : {static_cast<QWidget*>(what_), static_cast<QWidget*>(unit_),
                               static_cast<QWidget*>(up_), static_cast<QWidget*>(points_)})
        form_->setRowVisible(ofStrands, !cards);
    for (QWidget* ofCards : {cards_, textures_}) form_->setRowVisible(ofCards, cards);
    frames_->setMaximum(cards ? 1 : kMostFrames);
    const int all = what_->findData(static_cast<int>(ExportedHair::all));
    if (all < 0 && choice.writer->keepsGuides)
        what_->addItem("Rendered hairs, with guides beside them", static_cast<int>(ExportedHair::all));
    else if (all >= 0 && !choice.writer->keepsGuides)
        what_->removeItem(all);
    note_->setText(QString::fromStdString(target.note));
    const QString problem = problemOf(choice);
    problem_->setText(problem);
    form_->setRowVisible(problem_, !problem.isEmpty());
    write_->setEnabled(canWrite());
    for (int i = 0; i < unit_->count(); ++i) {
        if (static_cast<float>(unit_->itemData(i).toDouble()) == target.options.metresPerUnit)
            unit_->setCurrentIndex(i);
    }
    up_->setCurrentIndex(target.options.up == UpAxis::Z ? 1 : 0);
    points_->setValue(static_cast<int>(target.options.pointsPerStrand));
    showWhatWillBeWritten();
}

void ExportDialog::choosePath() {
    const ExportChoice& choice = exportChoice(target_->currentIndex(), format_->currentIndex());
    const QString title = QFileInfo(document_.title()).completeBaseName();
    if (choice.isPage) {
        const QString folder = QFileDialog::getExistingDirectory(this, "Folder for the web page");
        if (!folder.isEmpty()) exportTo(folder + "/" + title);
        return;
    }
    const int chosen = std::max(0, format_->currentIndex());
    const std::vector<ExportChoice>& choices =
        programsToExportFor()[static_cast<std::size_t>(std::max(0, target_->currentIndex()))].choices;
    std::vector<SaveFormat> formats;
    for (const ExportChoice& one : choices)
        formats.push_back(
            {QString::fromStdString(one.writer->label), QString::fromStdString(one.writer->suffix())});
    const QString name = title + '.' + formats[static_cast<std::size_t>(chosen)].suffix;
    const auto place = askWhereToSave(this, windowTitle(), name, formats, chosen);
    if (!place) return;
    format_->setCurrentIndex(place->format);
    if (canWrite() && mayReplaceFile(this, place->path)) exportTo(place->path);
}

StrandExportOptions ExportDialog::optionsAsked() const {
    StrandExportOptions options;
    options.limits = exportChoice(target_->currentIndex(), format_->currentIndex()).target->options.limits;
    options.metresPerUnit = static_cast<float>(unit_->currentData().toDouble());
    options.up = up_->currentIndex() == 1 ? UpAxis::Z : UpAxis::Y;
    options.pointsPerStrand = static_cast<std::uint32_t>(points_->value());
    options.physics = physics_->isVisibleTo(this) && physics_->isChecked();
    return options;
}

void ExportDialog::exportTo(const QString& path) {
    const ExportChoice& choice = exportChoice(target_->currentIndex(), format_->currentIndex());
    const HairWriter& writer = *choice.writer;
    const StrandExportOptions options = optionsAsked();
    HairToExport wanted;
    wanted.hair = static_cast<ExportedHair>(what_->currentData().toInt());
    if (certify_->isChecked()) wanted.storms = CertificateOptions{}.storms;
    wanted.levels.cards = static_cast<std::uint32_t>(cards_->value());
    wanted.levels.chain.textures = static_cast<std::uint32_t>(textures_->value());
    wanted.layers = layersToWrite();
    if (layers_->currentIndex() == 1 && wanted.layers.empty())
        return messages_.warn("No layer is visible, so there is nothing to export");
    if (choice.isPage && frames_->value() > 0)
        return messages_.warn("A web page simulates the hair itself: set Frames to “at rest”");
    std::shared_ptr<const render::ColourTransform> view;
    if (choice.isPage) {
        const auto colours = colour::chooseColours(preferences_.colours());
        if (!colours) return messages_.warn(errorText(colours.error()));
        if (*colours) view = (*colours)->toDisplay;
    }
    auto motion = player_.makeMeasuredMotion();
    if (!motion) return messages_.warn(errorText(motion.error()));
    const std::shared_ptr<const HeadMotion> moves = std::move(*motion);
    // One more for the end of the last frame's shutter.
    const bool hasShutter = motion_->isVisibleIn(*form_) && motion_->apply(wanted);
    PlayedRange range{static_cast<std::uint32_t>(frames_->value()) + (hasShutter ? 1u : 0u),
                      player_.pace().framesPerSecond};
    if (motion_->isVisibleIn(*form_)) {
        range.framesPerSecond = motion_->framesPerSecond();
        range.preRoll = motion_->preRoll();
        range.handles = motion_->handles();
        range.count += 2 * range.handles;
    }
    std::optional<ManifestSource> manifest;
    if (manifest_->isChecked()) manifest = manifestSource(document_, "Export: " + target_->currentText());
    write_->setEnabled(false);
    const bool started = tasks_.run<ExportReport>(
        QString("Exporting %1").arg(QFileInfo(path).fileName()),
        [groom = document_.groom(), wanted, moves, range, manifest, path, options, &writer,
         isPage = choice.isPage, view](TaskControl& control) mutable -> Result<ExportReport> {
            const float simulated = range.count > 0 ? 0.5f : 0;
            if (range.count > 0) {
                auto frames = playFrames(groom, *moves, range, [&](std::uint32_t done) {
                    control.setProgress(simulated * static_cast<float>(done) /
                                        static_cast<float>(range.preRoll + range.count));
                    return !control.isCancelled();
                });
                if (!frames) return tl::unexpected(frames.error());
                wanted.frames = std::move(*frames);
            }
            wanted.progress = [&](std::string_view, double share) {
                control.setProgress(simulated + (1 - simulated) * static_cast<float>(share));
            };
            wanted.cancel = control.cancelFlag();
            OutputBatch batch;
            auto report = isPage ? exportWebPage(groom, wanted, path.toStdString(), view.get())
                                 : exportHair(groom, wanted, writer, path.toStdString(), options);
            if (!report) return report;
            if (manifest) {
                manifest->groom = &groom;
                const std::filesystem::path output = path.toStdString();
                const auto name = isPage ? output / "manifest.json" : manifestName(output);
                if (auto status = addManifest(name, *manifest); !status)
                    return tl::unexpected(status.error());
            }
            if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
            return report;
        },
        [self = QPointer(this), &messages = messages_, path](ExportReport report) {
            messages.say(
                (report.levels.empty() ? QString("Exported %1 and read it back") : QString("Exported %1"))
                    .arg(QFileInfo(path).fileName()));
            if (!self) return;
            self->report_ = std::move(report);
            self->showReport();
        });
    if (!started) write_->setEnabled(canWrite());
}

QString ExportDialog::summary() const {
    const QString size =
        locale().formattedDataSize(static_cast<qint64>(report_.bytes), 1, QLocale::DataSizeSIFormat);
    if (!report_.levels.empty())
        return QString("%1: %L2 strands as cards, %L3 vertices, %4.")
            .arg(QString::fromStdString(report_.format))
            .arg(report_.strands)
            .arg(report_.points)
            .arg(size);
    QString words = QString("%1: %L2 strands, %L3 points, %4.")
                        .arg(QString::fromStdString(report_.format))
                        .arg(report_.strands)
                        .arg(report_.points)
                        .arg(size);
    if (report_.maxErrorMm)
        words += ' ' + QString("Largest distance of a point in the file from the hair: %1.")
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
            "certificate",
            QString("%1 random storms; %2 failed beyond these limits")
                .arg(limits->storms)
                .arg(limits->failed)
                .toStdString());
    for (const std::string& companion : report_.companions)
        add(companion, "in a separate file", "exported with the strands");
    for (const LeftBehind& left : report_.leftBehind) add(left.what, "not exported", left.fix);
    for (const Finding& finding : report_.findings)
        add(finding.what, QString::fromStdString(finding.where), finding.fix);
    for (const ComparedAttribute& attribute : report_.attributes)
        add(attribute.name, "attribute",
            QString("exported as %1").arg(attribute.maxError, 0, 'g', 3).toStdString());
    for (const WrittenLevel& level : report_.levels)
        add(level.name, QString("from %1 m").arg(level.distance, 0, 'f', 2),
            QString("coverage %1, light %2 of the strands, FLIP %3")
                .arg(level.coverage, 0, 'f', 3)
                .arg(level.light, 0, 'f', 3)
                .arg(level.flip, 0, 'f', 3)
                .toStdString());
    if (findings_->topLevelItemCount() == 0)
        findings_->addTopLevelItem(new QTreeWidgetItem({QString("Nothing to fix")}));
    wrapRows(*findings_);
}

}  // namespace hairloom::editor
