// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/render_thread.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "editor/document/words.h"
#include "editor/viewport/native_window.h"
#include "editor/viewport/render_work.h"

namespace hairloom::editor {
namespace {

Status takeBoth(gpu::Device& device, const LiveWork& live, RenderWork& work, std::optional<RenderWork>& other,
                float& split, PictureRequest request) {
    split = request.split;
    if (!request.other) {
        other.reset();
        return work.take(std::move(request));
    }
    PictureRequest left = request;
    left.groom = std::exchange(request.other, nullptr);
    left.other.reset();
    left.quality = request.otherQuality;
    if (!other) other.emplace(device, &live);
    if (auto taken = other->take(std::move(left)); !taken) return taken;
    return work.take(std::move(request));
}

Result<std::pair<QImage, PictureReport>> drawBoth(RenderWork& work, std::optional<RenderWork>& other,
                                                  float split) {
    auto drawn = work.draw();
    if (drawn && drawn->first.isNull()) other.reset();  // a window shows it
    if (!drawn || !other) return drawn;
    auto left = other->draw();
    if (!left) return left;
    QImage& picture = drawn->first;
    const QImage beside =
        left->first.size() == picture.size() ? left->first : left->first.scaled(picture.size());
    const int columns = std::clamp(static_cast<int>(std::lround(split * static_cast<float>(picture.width()))),
                                   0, picture.width());
    for (int y = 0; y < picture.height(); ++y) {
        std::copy_n(reinterpret_cast<const QRgb*>(beside.constScanLine(y)), columns,
                    reinterpret_cast<QRgb*>(picture.scanLine(y)));
    }
    drawn->second.milliseconds += left->second.milliseconds;
    return drawn;
}

/// All frames of a picture, with a renderer of its own.
Result<QImage> drawAlone(gpu::Device& device, PictureRequest request) {
    RenderWork work(device, nullptr);
    if (auto taken = work.take(std::move(request)); !taken) return tl::unexpected(taken.error());
    QImage picture;
    while (!work.isComplete()) {
        auto drawn = work.draw();
        if (!drawn) return tl::unexpected(drawn.error());
        picture = std::move(drawn->first);
    }
    return picture;
}

/// A device and what the thread has on it.
struct DeviceWork {
    explicit DeviceWork(std::unique_ptr<gpu::Device> made)
        : device(std::move(made)), live(*device), work(*device, &live) {}

    bool isComplete() const { return work.isComplete() && (!other || other->isComplete()); }
    /// It refuses all, and will.
    bool isLost() const { return !device->createCommandList(); }

    std::unique_ptr<gpu::Device> device;
    LiveWork live;
    RenderWork work;
    std::optional<RenderWork> other;  ///< the look to compare with
};

}  // namespace

RenderThread::RenderThread(QObject* parent) : QObject(parent) {
    qRegisterMetaType<PictureReport>();
    live_ = std::make_shared<LiveLink>([this] {
        // Not between the thread's look for jobs and its sleep.
        { const std::lock_guard lock(mutex_); }
        wake_.notify_all();
    });
    thread_ = std::thread([this] { run(); });
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void RenderThread::post(PictureRequest request) {
    {
        const std::lock_guard lock(mutex_);
        next_ = std::move(request);
        idle_ = false;
    }
    wake_.notify_all();
}

std::shared_ptr<const StrandMoves> RenderThread::withdrawMoves() {
    const std::lock_guard lock(mutex_);
    return next_ ? std::exchange(next_->moves, nullptr) : nullptr;
}

void RenderThread::postSide(const QString& name, PictureRequest request) {
    {
        const std::lock_guard lock(mutex_);
        side_.insert_or_assign(name, std::move(request));
    }
    wake_.notify_all();
}

bool RenderThread::isIdle() const {
    const std::lock_guard lock(mutex_);
    return idle_ || ended_;
}

bool RenderThread::hasEnded() const {
    const std::lock_guard lock(mutex_);
    return ended_;
}

void RenderThread::setWindow(std::optional<gpu::NativeWindow> window) {
    std::unique_lock lock(mutex_);
    window_ = window;
    windowChanged_ = true;
    wake_.notify_all();
    constexpr std::chrono::milliseconds kPatience(5);
    while (!windowTaken_.wait_for(lock, kPatience, [this] { return !windowChanged_ || ended_; })) {
        lock.unlock();
        answerWindowSystem();
        lock.lock();
    }
}

void RenderThread::run() {
    auto device = gpu::createDevice();
    if (!device) {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        windowTaken_.notify_all();
        live_->close();
        QMetaObject::invokeMethod(
            this, [this, problem = errorText(device.error())] { Q_EMIT deviceReady({}, false, problem); });
        return;
    }
    auto on = std::make_unique<DeviceWork>(std::move(*device));
    float split = 0.5f;
    const gpu::DeviceInfo& info = on->device->info();
    const bool wantsWindow = info.presents && info.type != gpu::DeviceType::Cpu;
    // By way of the event loop: listeners may connect after the constructor.
    QMetaObject::invokeMethod(this, [this, name = QString::fromStdString(info.name), wantsWindow] {
        Q_EMIT deviceReady(name, wantsWindow, {});
    });
    while (true) {
        std::optional<PictureRequest> request;
        {
            std::unique_lock lock(mutex_);
            const bool complete = on->isComplete();
            idle_ = !next_ && complete;
            wake_.wait(lock, [&] {
                return stop_ || next_ || windowChanged_ || !complete || !side_.empty() || live_->hasJobs();
            });
            if (stop_) break;
            if (live_->hasJobs()) {
                lock.unlock();
                live_->run(&on->live);
                lock.lock();
                if (!next_ && !windowChanged_ && complete && side_.empty()) continue;
            }
            if (windowChanged_) {
                const auto taken = on->work.setWindow(window_);
                windowChanged_ = false;
                lock.unlock();
                windowTaken_.notify_all();
                if (!taken) Q_EMIT windowRefused(errorText(taken.error()));
                continue;
            }
            request = std::exchange(next_, std::nullopt);
            if (!request && complete) {
                auto asked = side_.extract(side_.begin());
                lock.unlock();
                if (auto picture = drawAlone(*on->device, std::move(asked.mapped()))) {
                    Q_EMIT sidePictureReady(asked.key(), *picture);
                }
                continue;
            }
        }
        Status ready;
        if (request) ready = takeBoth(*on->device, on->live, on->work, on->other, split, std::move(*request));
        if (ready) {
            auto drawn = drawBoth(on->work, on->other, split);
            if (drawn) {
                Q_EMIT pictureReady(drawn->first, drawn->second);
                continue;
            }
            ready = tl::unexpected(drawn.error());
        }
        on->work.forget();
        on->other.reset();
        Q_EMIT failed(errorText(ready.error()));
        if (!on->isLost()) continue;
        // Another one, or the same begun anew; what was drawn is drawn again.
        auto another = gpu::createDevice();
        if (!another) continue;
        on = std::make_unique<DeviceWork>(std::move(*another));
        {
            const std::lock_guard lock(mutex_);
            windowChanged_ = window_.has_value();
        }
        Q_EMIT deviceReplaced();
    }
    live_->close();
    const std::lock_guard lock(mutex_);
    ended_ = true;
    windowTaken_.notify_all();
}

}  // namespace hairloom::editor
