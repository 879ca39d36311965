// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/render_thread.h"

#include <chrono>
#include <utility>

#include "editor/viewport/native_window.h"
#include "editor/viewport/render_work.h"

namespace hairloom::editor {

RenderThread::RenderThread(QObject* parent) : QObject(parent) {
    qRegisterMetaType<PictureReport>();
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

bool RenderThread::isIdle() const {
    const std::lock_guard lock(mutex_);
    return idle_ || ended_;
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
        QMetaObject::invokeMethod(this, [this, problem = QString::fromStdString(device.error().message())] {
            Q_EMIT deviceReady({}, false, problem);
        });
        return;
    }
    RenderWork work(std::move(*device));
    const gpu::DeviceInfo& info = work.info();
    const bool wantsWindow = info.presents && info.type != gpu::DeviceType::Cpu;
    // By way of the event loop: listeners may connect after the constructor.
    QMetaObject::invokeMethod(this, [this, name = QString::fromStdString(info.name), wantsWindow] {
        Q_EMIT deviceReady(name, wantsWindow, {});
    });
    while (true) {
        std::optional<PictureRequest> request;
        {
            std::unique_lock lock(mutex_);
            idle_ = !next_ && work.isComplete();
            wake_.wait(lock, [&] { return stop_ || next_ || windowChanged_ || !work.isComplete(); });
            if (stop_) break;
            if (windowChanged_) {
                const auto taken = work.setWindow(window_);
                windowChanged_ = false;
                lock.unlock();
                windowTaken_.notify_all();
                if (!taken) Q_EMIT windowRefused(QString::fromStdString(taken.error().message()));
                continue;
            }
            request = std::exchange(next_, std::nullopt);
        }
        Status ready;
        if (request) ready = work.take(std::move(*request));
        if (ready) {
            auto drawn = work.draw();
            if (drawn) {
                Q_EMIT pictureReady(drawn->first, drawn->second);
                continue;
            }
            ready = tl::unexpected(drawn.error());
        }
        work.forget();
        Q_EMIT failed(QString::fromStdString(ready.error().message()));
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    windowTaken_.notify_all();
}

}  // namespace hairloom::editor
