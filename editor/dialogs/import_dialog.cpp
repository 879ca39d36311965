// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/import_dialog.h"

#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPointer>
#include <utility>

#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/viewport/strand_preview.h"
#include "importers/length_unit.h"

namespace hairloom::editor {

ImportDialog::ImportDialog(QtDocument& document, Tasks& tasks, const QString& path, QWidget* parent)
    : QDialog(parent),
      document_(document),
      tasks_(tasks),
      path_(path),
      unit_(new QComboBox),
      up_(new QComboBox),
      segments_(new QSpinBox),
      order_(new QComboBox),
      particle_(new QComboBox),
      points_(new QSpinBox),
      form_(new QFormLayout),
      summary_(new QLabel),
      view_(new StrandPreview) {
    setWindowTitle(QString("Import %1").arg(QFileInfo(path).fileName()));
    resize(760, 480);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(16);
    layout->addWidget(view_, 1);
    auto* side = new QVBoxLayout;
    layout->addLayout(side);
    form_->setVerticalSpacing(8);
    side->addLayout(form_);
    for (const LengthUnit& unit : lengthUnits()) unit_->addItem(unit.name, unit.metres);
    unit_->setObjectName("unit");
    unit_->setToolTip(
        "Length of one unit in the file. Change it if the strands are far too large or too small for the "
        "head.");
    up_->setObjectName("up");
    up_->addItems({"Y up", "Z up"});
    up_->setToolTip("Up axis of the file. Change it if the hair lies on its side.");
    segments_->setObjectName("segments");
    segments_->setRange(0, 65535);
    segments_->setSpecialValueText("found");
    segments_->setToolTip("Segments of each Cinema 4D ribbon. 0 detects them from the faces");
    order_->setObjectName("order");
    order_->addItems({"Found", "Left and right in turn", "One edge, then the other", "Around"});
    order_->setToolTip(
        "Vertex order of a Cinema 4D ribbon. If it is wrong, strands zigzag, or tips are where roots "
        "should be");
    particle_->setObjectName("particle");
    particle_->addItems({"First edge", "Middle"});
    particle_->setToolTip(
        "Position of the particles within a Cinema 4D ribbon: on every second vertex, or between its edges");
    points_->setObjectName("pointsPerStrand");
    points_->setRange(0, 65536);
    points_->setSpecialValueText("found");
    points_->setToolTip(
        "Points per strand, for files that only have points. 0 detects them from the distances between "
        "the points");
    form_->addRow("Unit", unit_);
    form_->addRow("Axis", up_);
    form_->addRow("Vertex order", order_);
    form_->addRow("Particles", particle_);
    form_->addRow("Segments", segments_);
    form_->addRow("Points per strand", points_);
    auto* legend =
        new QLabel(QString("<span style='color:%1'>●</span> root &nbsp; <span style='color:%2'>●</span> tip")
                       .arg(StrandPreview::rootColour().name(), StrandPreview::tipColour().name()));
    form_->addRow(QString(), legend);
    summary_->setWordWrap(true);
    summary_->setFixedWidth(240);
    summary_->setAlignment(Qt::AlignTop);
    side->addWidget(summary_, 1);
    take_ = acceptOrCancel(*this, *side, "Import",
                           "Import the strands as shown. On a head, they are bound to its scalp");
    setTabOrder(take_, view_);
    connect(unit_, &QComboBox::currentIndexChanged, this, &ImportDialog::read);
    connect(up_, &QComboBox::currentIndexChanged, this, &ImportDialog::read);
    connect(order_, &QComboBox::currentIndexChanged, this, &ImportDialog::read);
    connect(particle_, &QComboBox::currentIndexChanged, this, &ImportDialog::read);
    for (QSpinBox* box : {segments_, points_}) {
        box->setKeyboardTracking(false);
        connect(box, &QSpinBox::valueChanged, this, &ImportDialog::read);
    }
    view_->markEnds(true);
    read();
}

StrandImportOptions ImportDialog::options() const {
    StrandImportOptions options;
    options.metresPerUnit = static_cast<float>(unit_->currentData().toDouble());
    options.up = up_->currentIndex() == 1 ? UpAxis::Z : UpAxis::Y;
    options.ribbonSegments = static_cast<std::uint32_t>(segments_->value());
    options.ribbonOrder = static_cast<RibbonOrder>(order_->currentIndex());
    options.ribbonParticle = static_cast<RibbonParticle>(particle_->currentIndex());
    options.pointsPerStrand = static_cast<std::uint32_t>(points_->value());
    return options;
}

namespace {

/// "Vertex order: around; 12 segments"
QString wordsFor(const RibbonsFound& found) {
    const QString orders[] = {QString("mixed"), QString("left and right in turn"),
                              QString("one edge, then the other"), QString("around")};
    const QString order = found.sides > 2 && found.order == RibbonOrder::Interleaved
                              ? QString("ring after ring")
                              : orders[static_cast<std::size_t>(found.order)];
    QString text = QString("<p>Vertex order: %1; ").arg(order);
    text += found.fewestSegments == found.mostSegments
                ? QString("%L1 segments</p>").arg(found.mostSegments)
                : QString("%L1 to %L2 segments</p>").arg(found.fewestSegments).arg(found.mostSegments);
    if (found.sides > 2) text += QString("<p>Tubes of %1 sides</p>").arg(found.sides);
    return text;
}

}  // namespace

void ImportDialog::read() {
    summary_->setText("Reading…");
    take_->setEnabled(false);
    // A later change of the options supersedes what is being read.
    tasks_.drop();
    tasks_.finish();
    StrandImportOptions wanted = options();
    reading_ = tasks_.run<Preview>(
        QString("Reading %1").arg(QFileInfo(path_).fileName()),
        [path = path_, wanted, scalp = document_.groom().scalp](TaskControl&) -> Result<Preview> {
            StrandImportOptions onHead = wanted;
            onHead.scalp = scalp.get();
            auto imported = importStrands(path.toStdString(), onHead);
            Preview preview;
            const bool asked = wanted.ribbonSegments > 0 || wanted.ribbonOrder != RibbonOrder::Detect;
            preview.hasRibbons = asked;
            preview.hasRuns = wanted.pointsPerStrand > 0;
            if (!imported) {
                // Shown here instead of in the status line: options may mend it.
                preview.text = errorText(imported.error());
                preview.hasRibbons = preview.hasRuns = true;
                return preview;
            }
            preview.hasRibbons = asked || imported->ribbons.has_value();
            preview.text = QString("<p><b>%1</b></p><p>%L2 strands, %L3 points</p>")
                               .arg(QString::fromStdString(imported->format).toHtmlEscaped())
                               .arg(imported->groom.strandCount())
                               .arg(imported->groom.pointCount());
            if (imported->ribbons) preview.text += wordsFor(*imported->ribbons);
            const Vec3f size = imported->groom.bounds().sizes();
            preview.text += QString("<p>%1 × %2 × %3 m</p>")
                                .arg(size.x(), 0, 'g', 3)
                                .arg(size.y(), 0, 'g', 3)
                                .arg(size.z(), 0, 'g', 3);
            if (!imported->dropped.empty()) {
                preview.text += QString("<p>%L1 strands cannot be used.</p>").arg(imported->dropped.size());
            }
            for (const Finding& finding : imported->warnings) {
                preview.text += "<p>" + QString::fromStdString(finding.what).toHtmlEscaped() + "</p>";
                preview.hasRuns = preview.hasRuns || finding.where == "points";
            }
            preview.groom = std::move(imported->groom);
            return preview;
        },
        [self = QPointer(this)](Preview preview) {
            if (self) self->showPreview(std::move(preview));
        });
}

void ImportDialog::done(int result) {
    if (std::exchange(reading_, false)) {
        tasks_.cancel();
        tasks_.finish();
    }
    QDialog::done(result);
}

void ImportDialog::showPreview(Preview preview) {
    reading_ = false;
    preview_ = std::move(preview.groom);
    summary_->setText(preview.text);
    // Choices that the file does not have are no choices.
    for (QWidget* choice :
         {static_cast<QWidget*>(order_), static_cast<QWidget*>(particle_), static_cast<QWidget*>(segments_)})
        choice->setEnabled(preview.hasRibbons);
    points_->setEnabled(preview.hasRuns);
    take_->setEnabled(preview_.strandCount() > 0);
    view_->show(preview_, document_.groom().scalp);
}

}  // namespace hairloom::editor
