// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Makes the pictures of the viewport on a thread of its own, which owns the device: into a window's swap
// chain where there is one, else read back. Of several requests that come while it is busy, the last one
// counts; while none comes, it adds frames to the average.

#include <QImage>
#include <QObject>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "core/base/result.h"
#include "core/gpu/device.h"
#include "editor/viewport/picture_request.h"
#include "editor/viewport/render_jobs.h"

namespace hairloom::editor {

class DeviceWork;

class RenderThread : public QObject {
    Q_OBJECT

  public:
    explicit RenderThread(QObject* parent = nullptr);
    ~RenderThread() override;

    void post(PictureRequest request);
    /// Takes the moves out of a request that still waits; null: none waits, or it has none.
    std::shared_ptr<const StrandMoves> withdrawMoves();
    /// A small picture of something else, drawn when nothing waits; of two of one name the later counts.
    void postSide(const QString& name, PictureRequest request);
    /// The same, and waits for it: for work off the interface thread. It comes before small
    /// pictures. Errors: it cannot be drawn, `isCancelled` says so, the thread has ended.
    Result<QImage> drawAside(PictureRequest request, const std::function<bool()>& isCancelled);
    /// Nothing is being drawn or waits to be, the average is complete.
    bool isIdle() const;
    /// No picture will come any more.
    bool hasEnded() const;

    /// Pictures go to this window from now on; to no window where it is empty. Waits until that is so: a
    /// window may be destroyed after it has been taken away.
    void setWindow(std::optional<gpu::NativeWindow> window);

    /// For who simulates on the device; may outlive this.
    const std::shared_ptr<RenderJobs>& jobs() const { return jobs_; }

  Q_SIGNALS:
    /// The device has been found. `note` says why it is the software renderer; empty: it is not.
    /// `wantsWindow`: it can show pictures by itself and is fast enough not to need them smaller.
    void deviceReady(const QString& name, bool wantsWindow, const QString& note);
    void pictureReady(const QImage& picture, const hairloom::editor::PictureReport& report);
    void sidePictureReady(const QString& name, const QImage& picture);
    /// The window cannot be drawn to; pictures are read back instead.
    void windowRefused(const QString& problem);
    void failed(const QString& problem);
    /// The device was lost or could not draw, and there is another that has nothing yet: what was asked for
    /// has to be again. `note` as above.
    void deviceReplaced(const QString& name, const QString& note);

  private:
    void run();
    void draw(std::unique_ptr<DeviceWork>& on, std::optional<PictureRequest> request);
    /// A picture of something else.
    struct Side {
        PictureRequest request;
        QString name;                              ///< of a thumbnail; empty: somebody waits for it
        std::function<void(Result<QImage>)> done;  ///< on this thread
        bool isWithdrawn = false;                  ///< with mutex_: nobody wants it any more
    };
    using Ticket = std::shared_ptr<Side>;
    void postSide(Ticket side);
    void withdraw(const Ticket& side);
    void drawSide(DeviceWork& on, const Ticket& side);
    void beginDroppable(bool can);
    /// Whether it was dropped.
    bool endDroppable();
    /// With mutex_: something else waits, which a picture that takes long makes room for.
    void dropStill() {
        if (droppable_) *drop_ = true;
    }

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable windowTaken_;
    std::optional<PictureRequest> next_;
    std::list<Ticket> side_;  ///< in the order in which they are drawn
    Ticket drawn_;            ///< what drawSide() draws; null: nothing
    std::optional<gpu::NativeWindow> window_;
    bool windowChanged_ = false;
    bool idle_ = true;
    bool stop_ = false;
    bool ended_ = false;
    bool droppable_ = false;  ///< what is being drawn may be left
    const std::shared_ptr<std::atomic<bool>> drop_ = std::make_shared<std::atomic<bool>>(false);
    std::shared_ptr<RenderJobs> jobs_;
    std::thread thread_;
};

}  // namespace hairloom::editor
