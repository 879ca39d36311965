// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/viewport.h"

#include <QApplication>
#include <QResizeEvent>
#include <QVBoxLayout>
#include <cmath>
#include <utility>

#include "core/operations/head_places.h"
#include "editor/fields/colour.h"
#include "editor/style/theme.h"
#include "editor/viewport/native_window.h"

namespace hairloom::editor {
namespace {

constexpr const char* kFirstImage = "Drawing the first image";
constexpr int kSettleMs = 220;
constexpr float kTurntableDegrees = 0.6f;  // per tick
constexpr int kTurntableMs = 25;

/// What the environment variable HAIRLOOM_VIEWPORT asks for: "window", "apart" (a window of its own that lies
/// over the viewport, where the system shows no device's picture within another window), "readback", "none"
/// (no pictures at all), or nothing.
QByteArray wishedSurface() {
    return qgetenv("HAIRLOOM_VIEWPORT");
}

Box3f boundsToShow(const Groom& groom, const HairPose* pose) {
    Box3f box = groom.bounds();
    if (pose) {
        for (const Vec3f& point : pose->positions_ws) box.extend(point);
    }
    if (!groom.scalp) return box;
    if (box.isEmpty()) return groom.scalp->bounds();
    for (const std::uint32_t triangle : groom.scalpSelection) {
        for (const std::uint32_t vertex : groom.scalp->triangles()[triangle]) {
            box.extend(groom.scalp->positions()[vertex]);
        }
    }
    // The face belongs to a hairstyle.
    const float headHeight = 0.30f * headScale(groom);
    box.min().y() = std::min(box.min().y(), box.max().y() - headHeight);
    return box;
}

}  // namespace

Viewport::Viewport(QtDocument& document, const Preferences& preferences, QWidget* parent)
    : QWidget(parent), document_(document), preferences_(preferences) {
    setObjectName("viewport");
    setMinimumSize(240, 180);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    useCanvas();
    settle_.setSingleShot(true);
    settle_.setInterval(kSettleMs);
    connect(&settle_, &QTimer::timeout, this, [this] {
        moving_ = false;
        post();
    });
    postSoon_.setSingleShot(true);
    postSoon_.setInterval(0);
    connect(&postSoon_, &QTimer::timeout, this, &Viewport::post);
    turntable_.setInterval(kTurntableMs);
    connect(&turntable_, &QTimer::timeout, this, [this] {
        camera_.spin(kTurntableDegrees);
        redraw(true);
    });
    connect(&renderer_, &RenderThread::deviceReady, this,
            [this](const QString& name, bool wantsWindow, const QString& note) {
                const QByteArray wish = wishedSurface();
                const bool byItself = (wantsWindow && wish.isEmpty()) || wish == "window" || wish == "apart";
                presentsByItself_ = note.isEmpty() && byItself;
                chooseSurface();
                Q_EMIT deviceReady(name, note);
            });
    connect(
        &renderer_, &RenderThread::pictureReady, this,
        [this](const QImage& picture, const PictureReport& report) {
            if (report.document != documents_) return;
            const bool isHead = std::exchange(headFirst_, false);
            if (isHead) redraw();
            if (!report.presented) {
                picture_ = picture;
                pictureCamera_ = report.camera;
                if (canvas_) canvas_->setPicture(picture);
                layMarks();
            }
            waitFor(isHead && document_.groom().strandCount() > 0 ? QString("Drawing the hair") : QString());
            Q_EMIT drawn(report);
        });
    connect(&renderer_, &RenderThread::windowRefused, this, [this](const QString& problem) {
        presentsByItself_ = false;
        chooseSurface();
        redraw();
        Q_EMIT failed(problem);
    });
    connect(&renderer_, &RenderThread::failed, this, [this](const QString& problem) {
        headFirst_ = false;
        waitFor({});
        handOverAll();
        Q_EMIT failed(problem);
    });
    connect(&renderer_, &RenderThread::deviceReplaced, this,
            [this](const QString& name, const QString& note) {
                presentsByItself_ = presentsByItself_ && note.isEmpty();
                chooseSurface();
                redraw();
                Q_EMIT deviceReady(name, note);
            });
    connect(&document_, &QtDocument::changed, this, &Viewport::documentChanged);
    connect(&document_, &QtDocument::replaced, this, [this] {
        pose_.reset();
        framed_ = false;
        ++documents_;
        headFirst_ = !document_.isEmpty() && wishedSurface() != "none" && !renderer_.hasEnded();
        picture_ = {};
        overlay_ = {};
        if (canvas_) canvas_->setPicture({});
        waitFor(headFirst_ ? QString(kFirstImage) : QString());
        layMarks();
    });
    connect(&preferences_, &Preferences::changed, this, [this] {
        showOnCanvas();
        redraw();
    });
    connect(&renderer_, &RenderThread::sidePictureReady, this, &Viewport::sidePictureReady);
}

Viewport::~Viewport() {
    if (window_) renderer_.setWindow(std::nullopt);
    if (apart_) delete window_;
}

void Viewport::waitFor(const QString& what) {
    if (canvas_) canvas_->setWaiting(what);
}

void Viewport::chooseSurface() {
    handOverAll();
    const bool blends = comparison_ || !reference_.isNull();
    presentsByItself_ && !blends ? useWindow() : useCanvas();
}

void Viewport::useCanvas() {
    if (canvas_) return;
    if (window_) {
        window_->removeEventFilter(this);
        renderer_.setWindow(std::nullopt);
        if (apart_) window_->deleteLater();
        window_ = nullptr;
        shown_->deleteLater();
    }
    canvas_ = new Canvas(this);
    canvas_->installEventFilter(this);
    layout()->addWidget(canvas_);
    shown_ = canvas_;
    showOnCanvas();
    if (headFirst_) waitFor(kFirstImage);
    redraw();
}

void Viewport::showOnCanvas() {
    if (!canvas_) return;
    canvas_->setBackground(themeColours(preferences_.theme()).viewport);
    canvas_->setReference(reference_, referenceOpacity_);
    canvas_->setSplit(comparison_ ? std::optional(split_) : std::nullopt);
}

void Viewport::useWindow() {
    if (window_ || !hasNativeWindows()) return;
    apart_ = wishedSurface() == "apart";
    window_ = new QWindow;
    prepareNativeWindow(*window_);
    window_->installEventFilter(this);
    delete canvas_;
    canvas_ = nullptr;
    shown_ = apart_ ? new QWidget(this) : QWidget::createWindowContainer(window_, this);
    shown_->setFocusPolicy(Qt::StrongFocus);
    layout()->addWidget(shown_);
    shown_->show();
    if (apart_) {
        window_->setFlags(Qt::Tool | Qt::FramelessWindowHint);
        window_->setTransientParent(window()->windowHandle());
        placeApart();
        window_->show();
    }
    window_->create();
    redraw();
}

void Viewport::placeApart() {
    window_->setGeometry(QRect(mapToGlobal(QPoint()), size()));
}

void Viewport::surfaceChanged(bool exists) {
    if (exists) {
        renderer_.setWindow(nativeWindow(*window_));
        redraw();
    } else {
        renderer_.setWindow(std::nullopt);
    }
}

QObject* Viewport::input() const {
    return window_ ? static_cast<QObject*>(window_) : canvas_;
}

bool Viewport::waitForPicture(int milliseconds) {
    QElapsedTimer clock;
    clock.start();
    while (settle_.isActive() || postSoon_.isActive() || headFirst_ || !renderer_.isIdle()) {
        QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
        if (clock.elapsed() > milliseconds) return false;
    }
    QCoreApplication::processEvents();
    return true;
}

void Viewport::setTool(Tool* tool) {
    if (tool_ == tool) return;
    if (tool_) {
        tool_->deactivate();
        tool_->disconnect(this);
    }
    tool_ = tool;
    toolPressed_ = false;
    if (tool_) {
        connect(tool_, &Tool::updated, this, [this] {
            redraw(toolPressed_);
            Q_EMIT hintChanged();
        });
        tool_->activate();
    }
    Q_EMIT hintChanged();
    redraw();
}

void Viewport::setPose(std::shared_ptr<const HairPose> pose) {
    pose_ = std::move(pose);
    redraw(pose_ != nullptr);
    Q_EMIT poseChanged();
}
void Viewport::setHairShown(bool on) {
    showHair_ = on;
    redraw();
}
void Viewport::setPreviewDensity(float share) {
    previewDensity_ = std::clamp(share, 0.0f, 1.0f);
    redraw();
}
void Viewport::setHeadShown(bool on) {
    showHead_ = on;
    redraw();
}
void Viewport::setLightTurn(float degrees) {
    lightTurn_ = degrees;
    redraw(true);
    Q_EMIT lightTurned(degrees);
}
void Viewport::setExposure(float factor) {
    exposure_ = factor;
    redraw();
}
void Viewport::setColours(std::shared_ptr<const render::ColourTransform> toDisplay) {
    if (toDisplay == toDisplay_) return;
    toDisplay_ = std::move(toDisplay);
    redraw();
}
void Viewport::setLight(float lights, float environment) {
    lightScale_ = lights;
    environment_ = environment;
    redraw();
}
void Viewport::setTurntable(bool on) {
    on ? turntable_.start() : turntable_.stop();
}
void Viewport::look(render::View view) {
    camera_.look(view);
    redraw();
}
void Viewport::setOrthographic(bool on) {
    camera_.setOrthographic(on);
    redraw();
}

void Viewport::setQuality(const PictureQuality& quality) {
    if (quality == quality_) return;
    quality_ = quality;
    redraw();
    Q_EMIT lookChanged();
}

void Viewport::setComparison(std::optional<Comparison> look) {
    comparison_ = std::move(look);
    chooseSurface();
    showOnCanvas();
    redraw();
    Q_EMIT lookChanged();
}

void Viewport::setSplit(float share) {
    split_ = std::clamp(share, 0.0f, 1.0f);
    showOnCanvas();
    redraw();
}

void Viewport::setReference(const QImage& image, double opacity) {
    reference_ = image;
    referenceOpacity_ = opacity;
    chooseSurface();
    showOnCanvas();
    redraw();
}

void Viewport::frameAll() {
    const float aspect = static_cast<float>(width()) / static_cast<float>(std::max(height(), 1));
    camera_.frame(boundsToShow(document_.groom(), pose_.get()), aspect);
    redraw();
}

void Viewport::addMarks(std::function<void(Marks&)> draw) {
    marks_.push_back(std::move(draw));
}

void Viewport::redraw(bool moving) {
    if (moving) {
        moving_ = true;
        settle_.start();
    }
    // Several changes of one turn of the event loop make one picture.
    if (!postSoon_.isActive()) postSoon_.start();
}

void Viewport::documentChanged(editing::Part parts) {
    if (parts == editing::Part::Cards) return redraw();  // no picture shows them, at most marks do
    // While points move, the groom that the renderer has stays, and nobody parts from a copy of it.
    if (document_.movedStrands().empty()) {
        handOverAll();
    } else {
        noteMoved(document_.movedStrands());
    }
    if (contains(parts, editing::kHairParts) && pose_ && !pose_->onDevice &&
        pose_->positions_ws.size() != document_.groom().pointCount()) {
        pose_.reset();
    }
    if (!framed_ && !document_.isEmpty()) {
        framed_ = true;
        frameAll();
    }
    redraw(toolPressed_);
}

void Viewport::handOverAll() {
    groom_.reset();
    other_.reset();
    moved_.clear();
    isMoved_.clear();
    posted_.reset();
}

std::uint32_t Viewport::previewedPerGuide() const {
    const std::uint32_t all = document_.groom().interpolation.followPerGuide;
    if (previewDensity_ >= 1 || (pose_ && pose_->onDevice)) return all;
    return static_cast<std::uint32_t>(std::lround(previewDensity_ * static_cast<float>(all)));
}

void Viewport::noteMoved(std::span<const std::uint32_t> strands) {
    if (!groom_) return;
    isMoved_.resize(groom_->strandCount(), 0);
    for (const std::uint32_t s : strands) {
        if (std::exchange(isMoved_[s], 1) == 0) moved_.push_back(s);
    }
}

std::shared_ptr<const StrandMoves> Viewport::movesSinceHandedOver() {
    // What was never taken goes along once more.
    if (const auto waiting = renderer_.withdrawMoves()) noteMoved(waiting->strands);
    if (moved_.empty()) return nullptr;
    auto moves = std::make_shared<StrandMoves>();
    for (const std::uint32_t s : moved_) {
        const auto points = document_.groom().strand(s);
        moves->points_ws.insert(moves->points_ws.end(), points.begin(), points.end());
        isMoved_[s] = 0;
    }
    moves->strands = std::exchange(moved_, {});
    return moves;
}

PictureRequest Viewport::requestOfView() const {
    PictureRequest request;
    request.groom = std::make_shared<const Groom>(document_.groom());
    request.pose = pose_;
    finishRequest(request);
    request.moving = false;
    return request;
}

void Viewport::setHeld(bool on) {
    isHeld_ = on;
    if (!on) redraw();
}

void Viewport::postHead() {
    const Groom& groom = document_.groom();
    auto bald = std::make_shared<Groom>();
    bald->scalp = groom.scalp;
    bald->scalpSelection = groom.scalpSelection;
    bald->material = groom.material;
    PictureRequest request;
    request.groom = std::move(bald);
    finishRequest(request);
    request.moving = true;
    renderer_.post(std::move(request));
}

void Viewport::post() {
    if (document_.isEmpty() || isHeld_ || wishedSurface() == "none") return;
    headFirst_ = headFirst_ && document_.groom().scalp && document_.groom().strandCount() > 0;
    if (headFirst_) return postHead();
    const std::uint32_t perGuide = previewedPerGuide();
    if (groom_ && groom_->interpolation.followPerGuide != perGuide) handOverAll();
    const bool anew = !groom_;
    if (anew) {
        Groom shown = document_.groom();  // shares its arrays with the document
        shown.interpolation.followPerGuide = perGuide;
        groom_ = std::make_shared<const Groom>(std::move(shown));
    }
    overlay_ = marksNow();
    layMarks();
    PictureRequest request;
    request.groom = groom_;
    if (!anew) request.moves = movesSinceHandedOver();
    request.pose = pose_;
    finishRequest(request);
    if (comparison_ && canvas_) {
        if (!other_) {
            Groom other = *groom_;
            other.material = comparison_->material;
            other.interpolation = comparison_->interpolation;
            other.shadows = comparison_->shadows;
            other_ = std::make_shared<const Groom>(std::move(other));
        }
        request.other = other_;
        request.otherQuality = comparison_->quality;
        request.split = split_;
    }
    if (!canvas_) {
        request.marks = overlay_;
    } else if (!request.moves) {
        const bool isNew = !posted_ || !showsTheSame(*posted_, request) || posted_->split != request.split ||
                           posted_->moving != request.moving || (pose_ && pose_->onDevice);
        if (!isNew) return;
        posted_ = request;
    } else {
        posted_.reset();
    }
    renderer_.post(std::move(request));
}

render::Overlay Viewport::marksNow() {
    Marks marks;
    positionsWanted_ = false;
    for (const auto& draw : marks_) draw(marks);
    renderJobs()->setWantsPositions(positionsWanted_);
    if (tool_) tool_->draw(marks);
    return marks.overlay();
}

void Viewport::layMarks() {
    if (!canvas_) return;
    const qreal ratio = devicePixelRatioF();
    const QSize size_px(static_cast<int>(std::round(width() * ratio)),
                        static_cast<int>(std::round(height() * ratio)));
    canvas_->setMarks(sheet_.draw(overlay_, picture_.isNull() ? camera_.camera() : pictureCamera_, size_px,
                                  static_cast<float>(ratio), document_.groom(),
                                  pose_ ? &pose_->head : nullptr, showHead_));
}

void Viewport::finishRequest(PictureRequest& request) const {
    request.document = documents_;
    request.camera = camera_.camera();
    const qreal ratio = devicePixelRatioF();
    request.width = static_cast<std::uint32_t>(std::max(16.0, std::round(width() * ratio)));
    request.height = static_cast<std::uint32_t>(std::max(16.0, std::round(height() * ratio)));
    request.moving = moving_;
    request.showHair = showHair_;
    request.showHead = showHead_;
    request.lightTurn = lightTurn_;
    request.exposure = exposure_;
    request.toDisplay = toDisplay_;
    request.lightScale = lightScale_;
    request.environment = environment_;
    request.background = toLinear(themeColours(preferences_.theme()).viewport);
    request.quality = quality_;
    request.seeThrough = canvas_ && !reference_.isNull();
}

void Viewport::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    if (window_ && apart_) placeApart();
    // What was seen across a wide view is seen across a narrow one, and as large again when that grows.
    const auto share = [](const QSize& size_px) {
        return std::min(
            1.0f, static_cast<float>(size_px.width()) / static_cast<float>(std::max(1, size_px.height())));
    };
    if (framed_ && event->oldSize().isValid() && !event->oldSize().isEmpty() && !size().isEmpty())
        camera_.zoom(share(size()) / share(event->oldSize()));
    redraw(true);
}

}  // namespace hairloom::editor
