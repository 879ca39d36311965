// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/render_dialog.h"

#include <QDialogButtonBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QMessageBox>
#include <QPointer>
#include <QStandardItemModel>
#include <QStyle>
#include <QVBoxLayout>
#include <cmath>

#include "core/base/output_batch.h"
#include "core/live/video_file.h"
#include "core/simulation/settings_text.h"
#include "editor/document/publishing.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/number_spin.h"
#include "editor/fields/save_file.h"

namespace hairloom::editor {
namespace {

constexpr int kMostPixels = 8192;  // along a side
constexpr int kMostImages = 3600;

QSpinBox* pixels(const char* name, int value, const QString& tip) {
    auto* box = new QSpinBox;
    box->setObjectName(name);
    box->setRange(16, kMostPixels);
    box->setValue(value);
    box->setToolTip(tip);
    box->setAccessibleName(tip);
    return box;
}

/// In the order of FilmFiles.
std::vector<SaveFormat> formatsOfFilms() {
    std::vector<SaveFormat> formats{{"Numbered PNG images", suffixOf(FilmFiles::Pictures)},
                                    {"Animated PNG", suffixOf(FilmFiles::AnimatedPng)},
                                    {"Animated WebP", suffixOf(FilmFiles::AnimatedWebp)},
                                    {"MP4 video", suffixOf(FilmFiles::Mp4)}};
    formats[static_cast<std::size_t>(FilmFiles::Mp4)].isOffered = canWriteVideo();
    return formats;
}

}  // namespace

RenderDialog::RenderDialog(Viewport& viewport, Player& player, Tasks& tasks, Messages& messages,
                           const QtDocument& document, QWidget* parent)
    : QDialog(parent),
      viewport_(viewport),
      player_(player),
      tasks_(tasks),
      messages_(messages),
      document_(document),
      form_(new QFormLayout),
      rows_(new QWidget),
      of_(new QComboBox),
      images_(new QSpinBox),
      passes_(new QSpinBox),
      rate_(new QComboBox),
      files_(new QComboBox),
      transparent_(new QCheckBox("Transparent")),
      frame_(new QCheckBox("Frame")),
      take_(new QCheckBox("Project and motion")),
      settings_(new QCheckBox("Settings")),
      manifest_(new QCheckBox("Hashes of the images and the project")),
      note_(new QLabel),
      progress_(new QProgressBar) {
    setWindowTitle("Render");
    resize(440, 0);
    auto* layout = exportLayout(*this, *form_);
    rows_->setLayout(form_);
    form_->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(rows_);

    of_->setObjectName("renderOf");
    of_->addItems({"Image of the current view", "Turntable: the camera circles the head",
                   "Animation: the simulation from rest"});
    of_->setToolTip("The animation has the motion of the viewport, or a nod if the head is at rest");
    form_->addRow("Render", of_);
    const PictureRequest view = viewport_.requestOfView();
    width_ = pixels("renderWidth", static_cast<int>(view.width), "Width in pixels");
    height_ = pixels("renderHeight", static_cast<int>(view.height), "Height in pixels");
    auto* size = new QWidget;
    auto* sides = new QHBoxLayout(size);
    sides->setContentsMargins(0, 0, 0, 0);
    sides->addWidget(width_, 1);
    sides->addWidget(new QLabel(QStringLiteral("×")));
    sides->addWidget(height_, 1);
    form_->addRow("Size", size);
    passes_->setObjectName("renderPasses");
    passes_->setRange(1, 256);
    passes_->setValue(static_cast<int>(viewport_.quality().frames));
    passes_->setToolTip("Frames averaged for each image. More frames resolve finer hair and take longer");
    form_->addRow("Averaged frames", passes_);
    transparent_->setObjectName("renderTransparent");
    transparent_->setToolTip("Saves the background as transparent, to composite the hair elsewhere");
    form_->addRow("Background", transparent_);
    images_->setObjectName("renderImages");
    images_->setRange(2, kMostImages);
    images_->setValue(72);
    images_->setToolTip("Number of images in the film");
    form_->addRow("Images", images_);
    rate_->setObjectName("renderRate");
    for (const int rate : {60, 30, 20, 15, 12, 10}) rate_->addItem(QString::number(rate), rate);
    rate_->setCurrentIndex(1);
    rate_->setToolTip("Images per second of the film. The hair is always simulated at 60 frames per second");
    form_->addRow("Frame rate", rate_);
    files_->setObjectName("renderFiles");
    for (const SaveFormat& format : formatsOfFilms()) files_->addItem(format.label);
    files_->setToolTip(
        "Numbered images for editing, one animated file to show. WebP is lossy and a tenth "
        "as large. MP4 (H.264) plays everywhere, at any length, without transparency. A file name with the "
        "suffix of another format chooses that");
    if (!canWriteVideo()) {
        auto* items = qobject_cast<QStandardItemModel*>(files_->model());
        items->item(static_cast<int>(FilmFiles::Mp4))->setEnabled(false);
        items->item(static_cast<int>(FilmFiles::Mp4))
            ->setToolTip("This program was built without libavcodec");
    }
    form_->addRow("Files", files_);
    auto* burnIn = new QWidget;
    auto* texts = new QHBoxLayout(burnIn);
    texts->setContentsMargins(0, 0, 0, 0);
    const auto addText = [&](QCheckBox* box, const char* name, const QString& tip) {
        box->setObjectName(name);
        box->setToolTip(tip);
        texts->addWidget(box);
    };
    addText(frame_, "burnInFrame", "Writes the number of the frame into each image");
    addText(take_, "burnInTake", "Writes the names of the project and the motion into each image");
    addText(settings_, "burnInSettings", "Writes the strand model, substeps and wind into each image");
    texts->addStretch(1);
    form_->addRow("Burn in", burnIn);
    manifest_->setObjectName("renderManifest");
    manifest_->setToolTip(
        "Writes NAME.manifest.json beside the images: their bytes and hashes, the project, and its settings");
    form_->addRow("Manifest", manifest_);
    note_->setObjectName("renderNote");
    note_->setWordWrap(true);
    layout->addWidget(note_);
    progress_->setObjectName("renderProgress");
    progress_->setRange(0, 1000);
    progress_->setTextVisible(false);
    progress_->setAccessibleName("Progress of rendering");
    progress_->hide();
    layout->addWidget(progress_);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    close_ = buttons->button(QDialogButtonBox::Close);
    close_->setObjectName("renderClose");
    render_ = buttons->addButton("Render…", QDialogButtonBox::AcceptRole);
    render_->setObjectName("render");
    render_->setDefault(true);
    render_->setToolTip("Choose a file name and render. v### in the name takes the next free version");
    layout->addWidget(buttons);
    connect(render_, &QPushButton::clicked, this, &RenderDialog::choosePath);
    connect(buttons, &QDialogButtonBox::rejected, this, &RenderDialog::reject);
    for (QComboBox* box : {of_, rate_, files_})
        connect(box, &QComboBox::currentIndexChanged, this, &RenderDialog::showRows);
    for (QSpinBox* box : {width_, height_, images_})
        connect(box, &QSpinBox::valueChanged, this, &RenderDialog::showRows);
    poll_.setInterval(100);
    connect(&poll_, &QTimer::timeout, this, &RenderDialog::showWork);
    connect(&tasks_, &Tasks::failed, this, [this](const QString& problem) {
        if (isWorking()) end(problem, true);
    });
    connect(&tasks_, &Tasks::stopped, this, [this] {
        if (work_ == Work::Cancels) end("Cancelled. No file was written", false);
    });
    showRows();
}

RenderDialog::~RenderDialog() {
    if (!isWorking()) return;
    tasks_.cancel();
    viewport_.setHeld(false);
}

Film RenderDialog::filmAsked() const {
    Film film;
    film.of = static_cast<FilmOf>(of_->currentIndex());
    film.files = static_cast<FilmFiles>(files_->currentIndex());
    if (film.of != FilmOf::View) film.images = static_cast<std::uint32_t>(images_->value());
    film.imagesPerSecond = static_cast<std::uint32_t>(rate_->currentData().toInt());
    film.view.width = static_cast<std::uint32_t>(width_->value());
    film.view.height = static_cast<std::uint32_t>(height_->value());
    return film;
}

std::vector<std::string> RenderDialog::linesAsked(const Film& film, const Groom& groom) const {
    std::vector<std::string> lines;
    if (take_->isChecked()) {
        const QString motion = film.of == FilmOf::Simulation ? player_.measuredMotion()
                               : player_.hasFrame()          ? player_.motion()
                                                             : QStringLiteral("at rest");
        lines.push_back(QString("%1, %2").arg(document_.title(), motion).toStdString());
    }
    if (settings_->isChecked()) lines.push_back(settingsText(groom.simulation));
    return lines;
}

void RenderDialog::showRows() {
    const Film film = filmAsked();
    const bool isFilm = film.of != FilmOf::View;
    for (QWidget* row :
         {static_cast<QWidget*>(images_), static_cast<QWidget*>(rate_), static_cast<QWidget*>(files_)})
        form_->setRowVisible(row, isFilm);
    const bool fits = film.bytesHeld() <= kMostBytesOfFilm;
    render_->setEnabled(fits && !isWorking());
    note_->setProperty("role", fits ? "dim" : "problem");
    note_->style()->polish(note_);
    if (!fits) {
        note_->setText(
            QString("An animation of this size needs %1 of memory. Choose numbered images, fewer images "
                    "or a smaller size.")
                .arg(numberLocale().formattedDataSize(static_cast<qint64>(film.bytesHeld()), 1,
                                                      QLocale::DataSizeSIFormat)));
    } else if (isFilm) {
        note_->setText(QString("%1 images last %2 s.")
                           .arg(film.images)
                           .arg(static_cast<double>(film.images) / film.imagesPerSecond, 0, 'f', 1));
    } else {
        note_->setText("Camera, lights and look are those of the viewport, without its overlays.");
    }
    frame_->setEnabled(isFilm);
    transparent_->setEnabled(!film.isAnimation() || film.files != FilmFiles::Mp4);
    // Rows that come or go change the height that is needed.
    adjustSize();
}

bool RenderDialog::mayReplace(const QString& path, const Film& film) {
    if (film.of == FilmOf::View || film.isAnimation()) return mayReplaceFile(this, path);
    int there = 0;
    for (std::uint32_t i = 0; i < film.images; ++i) {
        std::error_code code;
        if (std::filesystem::exists(numbered(path.toStdString(), i), code)) ++there;
    }
    return there == 0 ||
           QMessageBox::question(this, "Replace images",
                                 QString("%L1 images of this name are there. Replace them?").arg(there)) ==
               QMessageBox::Yes;
}

void RenderDialog::choosePath() {
    const Film film = filmAsked();
    const bool isView = film.of == FilmOf::View;
    const std::vector<SaveFormat> formats =
        isView ? std::vector<SaveFormat>{{"PNG image", suffixOf(FilmFiles::Pictures)}} : formatsOfFilms();
    const int chosen = isView ? 0 : files_->currentIndex();
    const QString name = QFileInfo(document_.title()).completeBaseName() + '.' +
                         formats[static_cast<std::size_t>(chosen)].suffix;
    const auto place = askWhereToSave(this, windowTitle(), name, formats, chosen);
    if (!place) return;
    if (!isView) files_->setCurrentIndex(place->format);
    // The note says why where that format takes more memory than there may be.
    if (render_->isEnabled() && mayReplace(place->path, filmAsked())) renderTo(place->path);
}

void RenderDialog::renderTo(const QString& path) {
    Film film = filmAsked();
    film.path = path.toStdString();
    PictureRequest view = viewport_.requestOfView();
    view.width = film.view.width;
    view.height = film.view.height;
    view.seeThrough = transparent_->isEnabled() && transparent_->isChecked();
    view.quality.frames = static_cast<std::uint32_t>(passes_->value());
    film.burnsInFrame = frame_->isEnabled() && frame_->isChecked();
    film.burntIn = linesAsked(film, *view.groom);
    if (manifest_->isChecked()) film.manifest = manifestSource(document_, "Render: " + of_->currentText());
    film.view = std::move(view);
    if (film.of == FilmOf::Simulation) {
        auto motion = player_.makeMeasuredMotion();
        if (!motion) return end(errorText(motion.error()), true);
        film.motion = std::move(*motion);
        film.isOfTimeLine = player_.measuredMotion() == Player::kTimeLine;
    }
    player_.pause();
    work_ = Work::Runs;
    path_ = path;
    count_ = film.images;
    clock_.start();
    const bool started = tasks_.run<bool>(
        QString("Rendering %1").arg(QFileInfo(path).fileName()),
        [film = std::move(film), &viewport = viewport_](TaskControl& control) -> Result<bool> {
            const auto isCancelled = [&control] { return control.isCancelled(); };
            auto made = makeFilm(
                film,
                [&](PictureRequest request) { return viewport.drawAside(std::move(request), isCancelled); },
                [&](float share) {
                    control.setProgress(share);
                    return !control.isCancelled();
                });
            if (!made) return tl::unexpected(made.error());
            return true;
        },
        [self = QPointer(this), &messages = messages_, path](bool) {
            const QString words = QString("Rendered %1").arg(QFileInfo(path).fileName());
            messages.say(words);
            if (self)
                self->end(QString("%1 in %2 s")
                              .arg(words)
                              .arg(static_cast<double>(self->clock_.elapsed()) / 1000, 0, 'f', 1),
                          false);
        });
    if (!started) return;  // failed() has said why
    viewport_.setHeld(true);
    rows_->setEnabled(false);
    render_->setEnabled(false);
    close_->setText("Cancel");
    progress_->show();
    poll_.start();
    showWork();
}

void RenderDialog::showWork() {
    const double share = std::max(0.0, static_cast<double>(tasks_.progress()));
    progress_->setValue(static_cast<int>(std::lround(1000 * share)));
    if (work_ == Work::Cancels) return note_->setText("Cancelling…");
    const int image = std::min(static_cast<int>(count_), static_cast<int>(share * count_) + 1);
    QString words =
        count_ > 1 ? QString("Rendering image %1 of %2").arg(image).arg(count_) : QString("Rendering");
    const double elapsed = static_cast<double>(clock_.elapsed()) / 1000;
    if (share > 0 && share < 1 && elapsed > 2)
        words += ", " + QString("about %1 s left").arg(std::ceil(elapsed * (1 - share) / share), 0, 'f', 0);
    note_->setText(words);
}

void RenderDialog::end(const QString& words, bool isWarning) {
    work_ = Work::None;
    poll_.stop();
    viewport_.setHeld(false);
    progress_->hide();
    rows_->setEnabled(true);
    close_->setText("Close");
    showRows();
    note_->setProperty("role", isWarning ? "problem" : "dim");
    note_->style()->polish(note_);
    note_->setText(words);
    adjustSize();
}

void RenderDialog::reject() {
    if (!isWorking()) return QDialog::reject();
    work_ = Work::Cancels;
    tasks_.cancel();
    showWork();
}

}  // namespace hairloom::editor
