// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/render_thread.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <utility>

#include "editor/document/words.h"
#include "editor/viewport/device_work.h"
#include "editor/viewport/native_window.h"

namespace hairloom::editor {
namespace {

QString nameOf(const DeviceWork& on) {
    return QString::fromStdString(on.info().name);
}
QString noteOf(const DeviceWork& on) {
    return QString::fromStdString(on.note());
}

}  // namespace

RenderThread::RenderThread(QObject* parent) : QObject(parent) {
    qRegisterMetaType<PictureReport>();
    jobs_ = std::make_shared<RenderJobs>([this] {
        // Not between the thread's look for jobs and its sleep.
        {
            const std::lock_guard lock(mutex_);
            dropStill();
        }
        wake_.notify_all();
    });
    thread_ = std::thread([this] { run(); });
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        dropStill();
    }
    wake_.notify_all();
    thread_.join();
}

void RenderThread::post(PictureRequest request) {
    {
        const std::lock_guard lock(mutex_);
        next_ = std::move(request);
        idle_ = false;
        dropStill();
    }
    wake_.notify_all();
}

std::shared_ptr<const StrandMoves> RenderThread::withdrawMoves() {
    const std::lock_guard lock(mutex_);
    return next_ ? std::exchange(next_->moves, nullptr) : nullptr;
}

void RenderThread::postSide(const QString& name, PictureRequest request) {
    postSide(
        std::make_shared<Side>(Side{std::move(request), name, [this, name](const Result<QImage>& picture) {
                                        if (picture) Q_EMIT sidePictureReady(name, *picture);
                                    }}));
}

void RenderThread::postSide(Ticket side) {
    {
        const std::lock_guard lock(mutex_);
        const bool isThumbnail = !side->name.isEmpty();
        if (isThumbnail) std::erase_if(side_, [&](const Ticket& other) { return other->name == side->name; });
        const auto behind = std::ranges::find_if(
            side_, [&](const Ticket& other) { return !isThumbnail && !other->name.isEmpty(); });
        side_.insert(behind, std::move(side));
    }
    wake_.notify_all();
}

void RenderThread::withdraw(const Ticket& side) {
    const std::lock_guard lock(mutex_);
    side->isWithdrawn = true;
    side_.remove(side);
    if (drawn_ == side) dropStill();
}

Result<QImage> RenderThread::drawAside(PictureRequest request, const std::function<bool()>& isCancelled) {
    constexpr std::chrono::milliseconds kPatience(50);
    const auto made = std::make_shared<std::promise<Result<QImage>>>();
    std::future<Result<QImage>> picture = made->get_future();
    const auto ticket = std::make_shared<Side>(
        Side{std::move(request), {}, [made](Result<QImage> drawn) { made->set_value(std::move(drawn)); }});
    postSide(ticket);
    while (picture.wait_for(kPatience) != std::future_status::ready) {
        if (!isCancelled() && !hasEnded()) continue;
        withdraw(ticket);
        return fail("the image was cancelled");
    }
    return picture.get();
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
    dropStill();
    wake_.notify_all();
    constexpr std::chrono::milliseconds kPatience(5);
    while (!windowTaken_.wait_for(lock, kPatience, [this] { return !windowChanged_ || ended_; })) {
        lock.unlock();
        answerWindowSystem();
        lock.lock();
    }
}

void RenderThread::draw(std::unique_ptr<DeviceWork>& on, std::optional<PictureRequest> request) {
    Status ready;
    if (request) ready = on->take(*request);
    if (ready) {
        beginDroppable(on->canBeDropped());
        auto drawn = on->draw();
        const bool dropped = endDroppable();
        if (drawn) {
            Q_EMIT pictureReady(drawn->first, drawn->second);
            return;
        }
        if (dropped) return;
        ready = tl::unexpected(drawn.error());
    }
    on->forget();
    const bool lost = on->isLost();
    // Another one, or the same begun anew, or the software renderer where that can what this one cannot; what
    // was drawn is drawn again.
    auto another = lost ? std::make_unique<DeviceWork>(drop_) : nullptr;
    if (!lost && !on->isSoftware() && request) {
        auto software = std::make_unique<DeviceWork>(
            drop_, "the software renderer draws: " + on->info().name + ": " + ready.error().message());
        if (software->take(*request) && software->draw()) another = std::move(software);
    }
    if (!another) {
        Q_EMIT failed(errorText(ready.error()));
        return;
    }
    on = std::move(another);
    {
        const std::lock_guard lock(mutex_);
        windowChanged_ = window_.has_value() && !on->isSoftware();
    }
    Q_EMIT deviceReplaced(nameOf(*on), noteOf(*on));
}

void RenderThread::beginDroppable(bool can) {
    const std::lock_guard lock(mutex_);
    droppable_ = can;
    *drop_ = can && (next_ || stop_ || windowChanged_);
}

bool RenderThread::endDroppable() {
    const std::lock_guard lock(mutex_);
    droppable_ = false;
    return drop_->exchange(false);
}

void RenderThread::drawSide(DeviceWork& on, const Ticket& side) {
    beginDroppable(true);
    auto picture = on.drawAlone(side->request);
    const bool dropped = endDroppable();
    {
        const std::lock_guard lock(mutex_);
        drawn_.reset();
        if (side->isWithdrawn) return;
        if (!picture && dropped) {
            const bool isThumbnail = !side->name.isEmpty();
            const bool isOld = isThumbnail && std::ranges::any_of(side_, [&](const Ticket& other) {
                                   return other->name == side->name;
                               });
            const auto first = std::ranges::find_if(
                side_, [&](const Ticket& other) { return !isThumbnail || !other->name.isEmpty(); });
            if (!isOld) side_.insert(first, side);
            return;
        }
    }
    side->done(std::move(picture));
}

void RenderThread::run() {
    auto on = std::make_unique<DeviceWork>(drop_);
    const bool wantsWindow = on->info().presents && on->info().type != gpu::DeviceType::Cpu;
    // By way of the event loop: listeners may connect after the constructor.
    QMetaObject::invokeMethod(this, [this, name = nameOf(*on), note = noteOf(*on), wantsWindow] {
        Q_EMIT deviceReady(name, wantsWindow, note);
    });
    while (true) {
        std::optional<PictureRequest> request;
        {
            std::unique_lock lock(mutex_);
            const bool complete = on->isComplete();
            idle_ = !next_ && complete;
            wake_.wait(lock, [&] {
                return stop_ || next_ || windowChanged_ || !complete || !side_.empty() || jobs_->hasJobs();
            });
            if (stop_) break;
            if (jobs_->hasJobs()) {
                lock.unlock();
                jobs_->run(&on->played());
                lock.lock();
                if (!next_ && !windowChanged_ && complete && side_.empty()) continue;
            }
            if (windowChanged_) {
                const auto taken = on->setWindow(window_);
                windowChanged_ = false;
                lock.unlock();
                windowTaken_.notify_all();
                if (!taken) Q_EMIT windowRefused(errorText(taken.error()));
                continue;
            }
            request = std::exchange(next_, std::nullopt);
            if (!request && complete) {
                const Ticket side = drawn_ = side_.front();
                side_.pop_front();
                lock.unlock();
                drawSide(*on, side);
                continue;
            }
        }
        draw(on, std::move(request));
    }
    jobs_->close();
    const std::lock_guard lock(mutex_);
    ended_ = true;
    windowTaken_.notify_all();
}

}  // namespace hairloom::editor
