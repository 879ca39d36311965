// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/device_work.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/groom/move_strands.h"

namespace hairloom::editor {

software::DeviceChoice chosenDevice() {
    const QByteArray wish = qgetenv("HAIRLOOM_RENDERER");
    if (wish == "software")
        return {software::makeDevice(), "the software renderer draws: HAIRLOOM_RENDERER asks for it"};
    const QByteArray surface = qgetenv("HAIRLOOM_VIEWPORT");
    if (wish == "device" || surface == "window" || surface == "apart") {
        if (auto found = gpu::createDevice()) return {std::move(*found), {}};
    }
    return software::chooseDevice();
}

Status Looks::take(PictureRequest request) {
    split_ = request.split;
    if (!request.other) {
        other_.reset();
        return work_.take(std::move(request));
    }
    PictureRequest left = request;
    left.groom = std::exchange(request.other, nullptr);
    left.other.reset();
    left.quality = request.otherQuality;
    if (!other_) other_.emplace(device_, played_);
    if (auto taken = other_->take(std::move(left)); !taken) return taken;
    return work_.take(std::move(request));
}

Result<std::pair<QImage, PictureReport>> Looks::draw() {
    auto drawn = work_.draw();
    if (drawn && drawn->first.isNull()) other_.reset();  // a window shows it
    if (!drawn || !other_) return drawn;
    auto left = other_->draw();
    if (!left) return left;
    QImage& picture = drawn->first;
    const QImage beside =
        left->first.size() == picture.size() ? left->first : left->first.scaled(picture.size());
    const int columns = std::clamp(
        static_cast<int>(std::lround(split_ * static_cast<float>(picture.width()))), 0, picture.width());
    for (int y = 0; y < picture.height(); ++y) {
        std::copy_n(reinterpret_cast<const QRgb*>(beside.constScanLine(y)), columns,
                    reinterpret_cast<QRgb*>(picture.scanLine(y)));
    }
    drawn->second.milliseconds += left->second.milliseconds;
    return drawn;
}

std::uint32_t Looks::frames() const {
    return other_ ? std::min(work_.frames(), other_->frames()) : work_.frames();
}

void Looks::takeBack() {
    work_.takeBack();
    if (other_) other_->takeBack();
}

void Looks::holdAverage(bool on) {
    work_.holdAverage(on);
    if (other_) other_->holdAverage(on);
}

void Looks::holdMaps(bool on) {
    work_.holdMaps(on);
    if (other_) other_->holdMaps(on);
}

void Looks::forget() {
    work_.forget();
    other_.reset();
}

DeviceWork::DeviceWork(std::shared_ptr<const std::atomic<bool>> drop)
    : DeviceWork(std::move(drop), chosenDevice()) {}

DeviceWork::DeviceWork(std::shared_ptr<const std::atomic<bool>> drop, std::string why)
    : DeviceWork(std::move(drop), software::DeviceChoice{software::makeDevice(), std::move(why)}) {}

DeviceWork::DeviceWork(std::shared_ptr<const std::atomic<bool>> drop, software::DeviceChoice choice)
    : note_(std::move(choice.why)),
      drop_(std::move(drop)),
      device_(std::move(choice.device)),
      played_(*device_),
      shown_(*device_, &played_) {
    if (!software::isSoftware(*device_)) return;
    stillDevice_ = software::makeDevice(drop_);
    still_.emplace(*stillDevice_, nullptr);
}

void DeviceWork::joinMoves(PictureRequest& request) {
    if (request.groom != handed_) handed_ = moved_ = request.groom;
    if (request.moves) {
        auto moved = std::make_shared<Groom>(*moved_);
        moveStrands(*moved, request.moves->strands, request.moves->points_ws);
        moved_ = std::move(moved);
        request.moves.reset();
    }
    request.groom = moved_;
}

Status DeviceWork::take(PictureRequest request) {
    if (!still_) return shown_.take(std::move(request));
    joinMoves(request);
    const bool showsMore = stillOf_ && !stillWaits_ && !quickWaits_ && still_->frames() > 0;
    keepsAverage_ = showsMore && !request.moving && showsTheSame(*stillOf_, request);
    if (keepsAverage_) return still_->take(std::move(request));
    stillOf_.reset();
    stillWaits_ = request.moving ? std::nullopt : std::optional(request);
    quickWaits_ = true;
    // Shadows take longer than all the rest.
    const bool turnsLight = std::exchange(lightTurn_, request.lightTurn) != request.lightTurn;
    const bool holds = request.moving && !turnsLight;
    request.moving = true;
    auto taken = shown_.take(std::move(request));
    shown_.holdMaps(holds);
    return taken;
}

Result<std::pair<QImage, PictureReport>> DeviceWork::draw() {
    if (!still_) return shown_.draw();
    if (std::exchange(quickWaits_, false)) {
        auto drawn = shown_.draw();
        if (drawn) drawn->second.moving = !stillWaits_;
        return drawn;
    }
    if (stillWaits_) {
        stillOf_ = std::exchange(stillWaits_, std::nullopt);
        if (auto taken = still_->take(*stillOf_); !taken) return tl::unexpected(taken.error());
    }
    still_->holdAverage(std::exchange(keepsAverage_, false));
    auto drawn = still_->draw();
    if (!drawn) still_->takeBack();
    return drawn;
}

bool DeviceWork::isComplete() const {
    if (!still_) return shown_.isComplete();
    return !quickWaits_ && !keepsAverage_ && !stillWaits_ && (!stillOf_ || still_->isComplete());
}

void DeviceWork::forget() {
    shown_.forget();
    if (still_) still_->forget();
    stillWaits_.reset();
    stillOf_.reset();
    quickWaits_ = keepsAverage_ = false;
}

Result<QImage> DeviceWork::drawAlone(PictureRequest request) {
    const bool filters = request.quality.filter != render::PostFilter::none;
    const auto exact = filters ? nullptr : std::exchange(request.toDisplay, nullptr);
    RenderWork work(stillDevice_ ? *stillDevice_ : *device_, stillDevice_ ? nullptr : &played_);
    if (auto taken = work.take(std::move(request)); !taken) return tl::unexpected(taken.error());
    QImage picture;
    while (!work.isComplete()) {
        if (*drop_) return fail("the image was dropped");
        auto drawn = work.draw();
        if (!drawn) return tl::unexpected(drawn.error());
        picture = std::move(drawn->first);
    }
    return exact ? work.shownBy(*exact) : picture;
}

}  // namespace hairloom::editor
