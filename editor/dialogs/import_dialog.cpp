// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/import_dialog.h"

#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPointer>

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
      summary_(new QLabel),
      view_(new StrandPreview) {
    setWindowTitle(tr("Import %1").arg(QFileInfo(path).fileName()));
    resize(760, 480);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(16);
    layout->addWidget(view_, 1);
    auto* side = new QVBoxLayout;
    layout->addLayout(side);
    auto* form = new QFormLayout;
    form->setVerticalSpacing(8);
    side->addLayout(form);
    for (const LengthUnit& unit : lengthUnits()) unit_->addItem(unit.name, unit.metres);
    unit_->setObjectName("unit");
    unit_->setToolTip(
        tr("Length of one unit in the file. Change it if the strands are far too large or too small for the "
           "head."));
    up_->setObjectName("up");
    up_->addItems({tr("Y up"), tr("Z up")});
    up_->setToolTip(tr("Up axis of the file. Change it if the hair lies on its side."));
    segments_->setObjectName("segments");
    segments_->setRange(0, 511);
    segments_->setSpecialValueText(tr("found"));
    segments_->setToolTip(tr("Segments of each Cinema 4D ribbon. 0 detects them from the faces"));
    form->addRow(tr("Unit"), unit_);
    form->addRow(tr("Axis"), up_);
    form->addRow(tr("Segments"), segments_);
    summary_->setWordWrap(true);
    summary_->setFixedWidth(240);
    summary_->setAlignment(Qt::AlignTop);
    side->addWidget(summary_, 1);
    take_ = acceptOrCancel(*this, *side, tr("Import"),
                           tr("Import the strands as shown. On a head, they are bound to its scalp"));
    connect(unit_, &QComboBox::currentIndexChanged, this, &ImportDialog::read);
    connect(up_, &QComboBox::currentIndexChanged, this, &ImportDialog::read);
    connect(segments_, &QSpinBox::valueChanged, this, &ImportDialog::read);
    read();
}

StrandImportOptions ImportDialog::options() const {
    StrandImportOptions options;
    options.metresPerUnit = static_cast<float>(unit_->currentData().toDouble());
    options.up = up_->currentIndex() == 1 ? UpAxis::Z : UpAxis::Y;
    options.ribbonSegments = static_cast<std::uint32_t>(segments_->value());
    return options;
}

void ImportDialog::read() {
    summary_->setText(tr("Reading…"));
    take_->setEnabled(false);
    // A later change of the options supersedes what is being read.
    tasks_.cancel();
    tasks_.finish();
    tasks_.run<std::pair<Groom, QString>>(
        tr("Reading %1").arg(QFileInfo(path_).fileName()),
        [path = path_, options = options()](TaskControl&) -> Result<std::pair<Groom, QString>> {
            auto imported = importStrands(path.toStdString(), options);
            if (!imported) {
                // Shown here instead of in the status line: options may mend it.
                return std::pair(Groom(), errorText(imported.error()));
            }
            QString text = QObject::tr("<p><b>%1</b></p><p>%L2 strands, %L3 points</p>")
                               .arg(QString::fromStdString(imported->format).toHtmlEscaped())
                               .arg(imported->groom.strandCount())
                               .arg(imported->groom.pointCount());
            const Vec3f size = imported->groom.bounds().sizes();
            text += QObject::tr("<p>%1 × %2 × %3 m</p>")
                        .arg(size.x(), 0, 'g', 3)
                        .arg(size.y(), 0, 'g', 3)
                        .arg(size.z(), 0, 'g', 3);
            if (!imported->dropped.empty()) {
                text += QObject::tr("<p>%L1 strands cannot be used.</p>").arg(imported->dropped.size());
            }
            for (const Finding& finding : imported->warnings) {
                text += "<p>" + QString::fromStdString(finding.what).toHtmlEscaped() + "</p>";
            }
            return std::pair(std::move(imported->groom), text);
        },
        [self = QPointer(this)](std::pair<Groom, QString> found) {
            if (!self) return;
            self->preview_ = std::move(found.first);
            self->summary_->setText(found.second);
            self->take_->setEnabled(self->preview_.strandCount() > 0);
            self->view_->show(self->preview_, self->document_.groom().scalp);
        });
}

}  // namespace hairloom::editor
