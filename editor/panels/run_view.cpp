// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/run_view.h"

#include "editor/document/words.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

constexpr float kRed_px = 5;  ///< error at which strands are red
constexpr float kLine_px = 2;
const QColor kOther(90, 170, 255);

}  // namespace

RunView::RunView(const PanelParts& parts, QObject* parent)
    : QObject(parent),
      document_(parts.document),
      player_(parts.player),
      tasks_(parts.tasks),
      messages_(parts.messages),
      viewport_(parts.viewport) {
    connect(&timer_, &QTimer::timeout, this, &RunView::showFrame);
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts_) {
        if (contains(parts_, editing::kHairParts | editing::Part::Physics | editing::Part::Spheres)) stop();
    });
    connect(&document_, &QtDocument::replaced, this, &RunView::stop);
    connect(&player_, &Player::stateChanged, this, [this] {
        if (player_.isPlaying()) stop();
    });
    connect(&tasks_, &Tasks::stopped, this, [this] {
        if (!simulating_) return;
        simulating_ = false;
        // What has come of it is known once the task's end has been handled.
        const auto stopUnlessShown = [this] {
            if (!preview_ && !simulating_) stop();
        };
        QMetaObject::invokeMethod(this, stopUnlessShown, Qt::QueuedConnection);
    });
    viewport_.addMarks([this](Marks& marks) { draw(marks); });
}

void RunView::show(std::shared_ptr<const WorkPrecision> measured, std::size_t run,
                   std::optional<std::size_t> beside) {
    if (simulating_) {
        next_ = Wish{std::move(measured), run, beside};
        return;
    }
    auto motion = player_.makeMeasuredMotion();
    if (!motion) return messages_.warn(errorText(motion.error()));
    player_.pause();
    measured_ = std::move(measured);
    run_ = run;
    beside_ = beside;
    const auto groom = std::make_shared<const Groom>(document_.groom());
    const std::shared_ptr<const HeadMotion> moves = std::move(*motion);
    const bool began = tasks_.run<RunPreview>(
        "Simulating the preview",
        [groom, moves, kept = measured_, run](TaskControl& control) {
            return previewRun(*groom, *moves, *kept, run, [&] { return control.isCancelled(); });
        },
        [this, asked = ++asked_](RunPreview preview) {
            if (asked == asked_) begin(std::move(preview));
            if (!next_) return;
            const Wish next = *std::exchange(next_, std::nullopt);
            show(next.measured, next.run, next.beside);
        });
    if (!began) return stop();
    simulating_ = true;
}

void RunView::begin(RunPreview preview) {
    preview_ = std::move(preview);
    frame_ = 0;
    constexpr double kSecond_ms = 1000;
    timer_.start(static_cast<int>(kSecond_ms / static_cast<double>(measured_->options.time.framesPerSecond)));
    showFrame();
}

void RunView::stop() {
    ++asked_;
    next_.reset();
    if (preview_) {
        preview_.reset();
        timer_.stop();
        viewport_.setPose(player_.pose());
    }
    Q_EMIT stopped();
}

void RunView::showFrame() {
    frame_ = (frame_ + 1) % preview_->poses.size();
    auto pose = std::make_shared<HairPose>();
    pose->head = inWorld(preview_->poses[frame_]);
    pose->positions_ws = preview_->positions_ws[frame_];
    const Vec3f origin_ws = preview_->poses[frame_].origin_ws.cast<float>();
    for (Vec3f& point_ws : pose->positions_ws) point_ws += origin_ws;
    viewport_.setPose(std::move(pose));
}

void RunView::draw(Marks& marks) const {
    if (!preview_ || frame_ == 0) return;
    const Trajectory &run = measured_->runs[run_].trajectory, &truth = measured_->groundTruthTrajectory;
    const Trajectory& other = beside_ ? measured_->runs[*beside_].trajectory : truth;
    const std::size_t perFrame = truth.pointsPerFrame, first = (frame_ - 1) * perFrame;
    for (const Trajectory* drawn : {&run, &truth, &other}) {
        if (drawn->points_ws.size() < first + perFrame) return;
    }
    const Vec3f origin_ws = preview_->poses[frame_].origin_ws.cast<float>();
    const float red = kRed_px * viewport_.camera().metresPerPixel(document_.groom().bounds().center(),
                                                                  viewport_.viewSize_px());
    for (std::size_t p = 0; p + 1 < perFrame; ++p) {
        if ((p + 1) % measured_->options.pointsCompared == 0) continue;  // the next strand's
        const auto segment = [&](const Trajectory& of, const QColor& colour) {
            marks.line(origin_ws + of.points_ws[first + p], origin_ws + of.points_ws[first + p + 1], colour,
                       kLine_px, Marks::Depth::OnTop);
        };
        const float error = (run.points_ws[first + p + 1] - truth.points_ws[first + p + 1]).norm();
        segment(other, kOther);
        segment(run, heat(red > 0 ? error / red : 0));
    }
}

}  // namespace hairloom::editor
