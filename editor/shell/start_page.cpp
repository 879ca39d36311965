// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/shell/start_page.h"

#include <QFileInfo>
#include <QImage>
#include <QLabel>
#include <QLocale>
#include <QPixmap>
#include <QPushButton>
#include <QScrollArea>
#include <algorithm>

#include "core/documents/sample.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/field.h"
#include "editor/shell/files.h"
#include "editor/shell/questions.h"
#include "editor/style/icons.h"

namespace hairloom::editor {
namespace {

QPushButton* card(const QString& title, const QString& iconName, const QString& tip) {
    auto* button = new QPushButton(icon(iconName), title);
    button->setProperty("role", "card");
    button->setIconSize({20, 20});
    button->setToolTip(tip);
    button->setCursor(Qt::PointingHandCursor);
    return button;
}

/// What a sample shows, in the order in which they are learned from; so are they on the picture of the
/// manual.
struct SampleLesson {
    const char *name, *shows;
};
constexpr SampleLesson kLessons[] = {
    {"short", QT_TRANSLATE_NOOP("hairloom::editor::StartPage",
                                "Flow, length, clumps and noise: the first stack to read")},
    {"shoulder",
     QT_TRANSLATE_NOOP("hairloom::editor::StartPage", "A parting, a trimmed line and ends that bend in")},
    {"long", QT_TRANSLATE_NOOP("hairloom::editor::StartPage", "Locks with curls towards the tips")},
    {"bob", QT_TRANSLATE_NOOP("hairloom::editor::StartPage", "A fringe and two trim planes")},
    {"afro", QT_TRANSLATE_NOOP("hairloom::editor::StartPage", "Tight curls and frizz on every strand")},
    {"braid", QT_TRANSLATE_NOOP("hairloom::editor::StartPage", "Hair gathered along a curve")}};
constexpr int kLessonColumns = 3;

/// Names of samples as lessons; those that are none come last.
std::vector<std::string> inOrderOfLessons(std::vector<std::string> names) {
    std::ranges::stable_sort(names, {}, [](const std::string& name) {
        return std::ranges::find(kLessons, name, &SampleLesson::name) - std::begin(kLessons);
    });
    return names;
}

/// Its part of the manual's picture of all samples; null where it is not on it.
QPixmap pictureOf(const std::string& name) {
    constexpr int kHeight_px = 84;
    // A picture of few colours would be dithered into them again when it is scaled.
    static const QImage all = QImage(":/docs/pictures/samples.png").convertToFormat(QImage::Format_RGB32);
    const auto at = std::ranges::find(kLessons, name, &SampleLesson::name) - std::begin(kLessons);
    if (all.isNull() || at == std::ssize(kLessons)) return {};
    const int rows = static_cast<int>(std::size(kLessons)) / kLessonColumns;
    const QSize cell(all.width() / kLessonColumns, all.height() / rows);
    const auto column = static_cast<int>(at) % kLessonColumns, row = static_cast<int>(at) / kLessonColumns;
    const QImage part = all.copy(QRect(QPoint(column * cell.width(), row * cell.height()), cell));
    return QPixmap::fromImage(part.scaledToHeight(kHeight_px, Qt::SmoothTransformation));
}

void clear(QLayout& layout) {
    while (QLayoutItem* item = layout.takeAt(0)) {
        delete item->widget();
        delete item;
    }
}

QLabel* dim(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "dim");
    label->setWordWrap(true);
    return label;
}

}  // namespace

StartPage::StartPage(DocumentFiles& files, const Preferences& preferences, QWidget* parent)
    : QWidget(parent),
      files_(files),
      preferences_(preferences),
      recent_(new QVBoxLayout),
      recoveries_(new QVBoxLayout) {
    setProperty("role", "page");
    setAttribute(Qt::WA_StyledBackground);
    // In a narrow view it scrolls.
    auto* area = new QScrollArea;
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    auto* whole = new QVBoxLayout(this);
    whole->setContentsMargins(0, 0, 0, 0);
    whole->addWidget(area);
    auto* sheet = new QWidget;
    sheet->setProperty("role", "page");
    area->setWidget(sheet);
    auto* outer = new QHBoxLayout(sheet);
    outer->addStretch(1);
    auto* page = new QVBoxLayout;
    page->setSpacing(10);
    outer->addLayout(page, 4);
    outer->addStretch(1);
    page->addStretch(2);
    auto* title = new QLabel("Hairloom");
    title->setProperty("role", "title");
    page->addWidget(title);
    auto* first = new QLabel("Open a head and paint where hair grows, or start from a sample.");
    first->setObjectName("firstStep");
    first->setWordWrap(true);
    page->addWidget(first);
    page->addSpacing(8);
    page->addLayout(recoveries_);

    auto* open = card("Open a head, hair or project…", "open",
                      "Heads: OBJ, PLY, STL, FBX, glTF, USD, Alembic. Hair: Alembic, USD, .hair, .tfx, PLY, "
                      "OBJ, Cinema 4D and more. You can also drop a file anywhere in this window.");
    open->setObjectName("open");
    connect(open, &QPushButton::clicked, this, &StartPage::openRequested);
    page->addWidget(open);

    page->addWidget(heading("Samples"));
    auto* samples = new QGridLayout;
    samples->setSpacing(8);
    for (int column = 0; column < kLessonColumns; ++column) samples->setColumnStretch(column, 1);
    page->addLayout(samples);
    const auto folder = samplesFolder();
    const auto addSample = [&](const QString& name, const QString& label, const QString& tip) {
        auto* button = card(label, "hairloom", tip);
        button->setObjectName("sample:" + name);
        connect(button, &QPushButton::clicked, this, [this, name] { files_.openSample(name); });
        const int place = samples->count();
        // The bare head stands alone above the hairstyles.
        if (name.isEmpty())
            samples->addWidget(button, 0, 0, 1, kLessonColumns);
        else
            samples->addWidget(button, 1 + (place - 1) / kLessonColumns, (place - 1) % kLessonColumns);
        return button;
    };
    if (folder.empty()) {
        samples->addWidget(dim("The samples folder was not found next to the program."));
    } else {
        addSample({}, "Bare head", "A bust with a skeleton and clips, no hair");
        for (const std::string& name : inOrderOfLessons(sampleNames(folder))) {
            const QString sample = QString::fromStdString(name);
            const auto lesson = std::ranges::find(kLessons, name, &SampleLesson::name);
            const QString tip =
                QString("Creates the hairstyle “%1” on the bust in a few seconds").arg(sample);
            QPushButton* button =
                addSample(sample, labelOf(sample),
                          lesson == std::end(kLessons) ? tip : QString(lesson->shows) + ". " + tip);
            const QPixmap picture = pictureOf(name);
            if (picture.isNull()) continue;
            button->setIcon(picture);
            button->setIconSize(picture.size());
        }
    }
    page->addWidget(heading("Recent files"));
    page->addLayout(recent_);
    page->addStretch(3);
    connect(&preferences_, &Preferences::recentFilesChanged, this, &StartPage::fillRecent);
    fillRecent();
    fillRecoveries();
    fillLeftOvers();
}

void StartPage::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    // Work that has been saved since is no longer what a crash left.
    clear(*recoveries_);
    fillRecoveries();
    fillLeftOvers();
}

void StartPage::fillRecent() {
    clear(*recent_);
    const QStringList files = preferences_.recentFiles();
    if (files.isEmpty()) recent_->addWidget(dim("Recent files appear here."));
    for (const QString& path : files.mid(0, 6)) {
        auto* button = card(QFileInfo(path).fileName(), "history", path);
        connect(button, &QPushButton::clicked, this, [this, path] { files_.open(path); });
        recent_->addWidget(button);
    }
}

void StartPage::fillRecoveries() {
    for (const RecoveryCopy& copy : recoveryCopies()) {
        if (copy.isOlder) continue;
        auto* row = new QWidget;
        auto* layout = new QHBoxLayout(row);
        layout->setContentsMargins(0, 0, 0, 0);
        QString title =
            QString("Unsaved work: %1, %2").arg(QString::fromStdString(copy.of.name), timeText(copy.when));
        QString tip = QString("Recover the work that was not saved when the program ended");
        if (copy.isProjectChanged) {
            title = QString("%1 (the project was saved elsewhere since)").arg(title);
            tip += QString(
                ". Since then the project was saved by another program or window, and the copy does not "
                "have those changes");
        }
        auto* restore = card(title, "warning", tip);
        restore->setObjectName("recover");
        auto* discard = new QPushButton("Discard");
        discard->setObjectName("discardRecovery");
        discard->setToolTip("Delete this recovery copy permanently");
        layout->addWidget(restore, 1);
        layout->addWidget(discard);
        connect(restore, &QPushButton::clicked, this, [this, copy] { files_.openRecovered(copy); });
        connect(discard, &QPushButton::clicked, row, [row, copy, restore] {
            if (const auto removed = removeRecoveryCopy(copy); !removed)
                restore->setText(errorText(removed.error()));
            else
                row->deleteLater();
        });
        recoveries_->addWidget(row);
    }
}

void StartPage::fillLeftOvers() {
    QStringList folders;
    for (const QString& path : preferences_.recentFiles()) folders += QFileInfo(path).path();
    if (const auto recovery = recoveryFolder(); !recovery.empty())
        folders += QString::fromStdString(recovery.string());
    folders.removeDuplicates();
    for (const QString& folder : folders) {
        for (const LeftOver& leftOver : findLeftOvers(folder.toStdString())) addLeftOver(leftOver);
    }
}

void StartPage::addLeftOver(const LeftOver& leftOver) {
    auto* row = new QWidget;
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    const QString target = QString::fromStdString(leftOver.target);
    const QString file = QString::fromStdString(leftOver.file.string());
    const QString size = QLocale().formattedDataSize(static_cast<qint64>(leftOver.bytes));
    auto* label = dim(
        leftOver.whole
            ? QString("%1 may be damaged: the program ended while saving it. %2 has the complete content.")
                  .arg(target, file)
            : QString("The program ended while saving %1 and left %2.").arg(target, size));
    label->setToolTip(file);
    auto* remove = new QPushButton("Remove");
    remove->setObjectName("removeLeftOver");
    remove->setToolTip(QString("Delete the leftover file. %1 is not changed").arg(target));
    layout->addWidget(label, 1);
    layout->addWidget(remove);
    connect(remove, &QPushButton::clicked, row, [row, label, leftOver] {
        if (const auto removed = removeLeftOver(leftOver); !removed)
            label->setText(errorText(removed.error()));
        else
            row->deleteLater();
    });
    recoveries_->addWidget(row);
}

}  // namespace hairloom::editor
