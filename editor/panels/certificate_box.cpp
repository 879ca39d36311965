// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/certificate_box.h"

#include <QLocale>
#include <QVBoxLayout>
#include <memory>

#include "core/editing/document.h"

namespace hairloom::editor {

CertificateBox::CertificateBox(QtDocument& document, Tasks& tasks, QWidget* parent)
    : QWidget(parent),
      document_(document),
      tasks_(tasks),
      words_(new QLabel),
      certify_(new QPushButton("Stress test")) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    words_->setObjectName("certificateWords");
    words_->setWordWrap(true);
    certify_->setObjectName("certify");
    certify_->setToolTip(
        "Tests this hair in a thousand random storms to find the head speed, wind and frame time that it "
        "withstands in a game. Takes about half a minute");
    layout->addWidget(words_);
    layout->addWidget(certify_);
    connect(certify_, &QPushButton::clicked, this, &CertificateBox::certify);
    connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
        if (!contains(changed, editing::Part::Physics | editing::kHairParts | editing::Part::Spheres)) return;
        ++changes_;
        refresh();
    });
    connect(&document_, &QtDocument::replaced, this, [this] {
        certificate_.reset();
        ++documents_;
        refresh();
    });
    refresh();
}

void CertificateBox::certify() {
    const auto groom = std::make_shared<const Groom>(document_.groom());
    tasks_.run<Certificate>(
        "Stress test",
        [groom](TaskControl& control) {
            CertificateOptions options;
            options.progress = [&](std::size_t done, std::size_t total) {
                control.setProgress(static_cast<float>(done) / static_cast<float>(total));
            };
            options.cancelled = [&] { return control.isCancelled(); };
            return hairloom::certify(*groom, options);
        },
        [this, document = documents_, change = changes_](Certificate certificate) {
            if (document != documents_) return;
            certificate_ = std::move(certificate);
            triedChange_ = change;
            triedAt_ = QDateTime::currentDateTime();
            refresh();
        });
}

void CertificateBox::refresh() {
    certify_->setEnabled(document_.groom().strandCount() > 0);
    const QString age = triedChange_ != changes_ ? QString("Before the last change: ") : QString();
    words_->setText(certificate_ ? QString("%1%2 Tested at %3.")
                                       .arg(age, QString::fromStdString(inWords(*certificate_)),
                                            QLocale().toString(triedAt_, QLocale::ShortFormat))
                                 : QString());
    words_->setVisible(certificate_.has_value());
}

}  // namespace hairloom::editor
