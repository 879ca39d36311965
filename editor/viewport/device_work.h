// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A device and what the render thread has on it: the document's picture, the look to compare with, hair that
// is simulated there.
//
// The software renderer has two pictures of each: one that is quick and shown at once, and a still that is
// drawn frame by frame while nothing moves and may be left at any moment. Each has a device of its own, since
// only the still's is stopped.

#include <atomic>
#include <string>

#include "core/software/device.h"
#include "editor/viewport/render_work.h"

namespace hairloom::editor {

/// The best device there is. HAIRLOOM_RENDERER=software takes the software renderer in any case, and =device,
/// or a window of the device's own, a graphics API's device even where that runs on the processor.
software::DeviceChoice chosenDevice();

/// A picture, and beside it that of the look it is compared with.
class Looks {
  public:
    Looks(gpu::Device& device, PlayedHair* played)
        : device_(device), played_(played), work_(device, played) {}

    Status setWindow(const std::optional<gpu::NativeWindow>& window) { return work_.setWindow(window); }
    Status take(PictureRequest request);
    Result<std::pair<QImage, PictureReport>> draw();
    bool isComplete() const { return work_.isComplete() && (!other_ || other_->isComplete()); }
    std::uint32_t frames() const;
    void takeBack();
    void holdAverage(bool on);
    void holdMaps(bool on);
    void forget();

  private:
    gpu::Device& device_;
    PlayedHair* played_;
    RenderWork work_;
    std::optional<RenderWork> other_;  ///< the look to compare with
    float split_ = 0.5f;
};

class DeviceWork {
  public:
    /// The chosen device. `drop` stops stills of the software renderer.
    explicit DeviceWork(std::shared_ptr<const std::atomic<bool>> drop);
    /// The software renderer, because of `why`.
    DeviceWork(std::shared_ptr<const std::atomic<bool>> drop, std::string why);
    DeviceWork(const DeviceWork&) = delete;
    DeviceWork& operator=(const DeviceWork&) = delete;

    const gpu::DeviceInfo& info() const { return device_->info(); }
    bool isSoftware() const { return still_.has_value(); }
    /// Why the software renderer draws; empty: it does not.
    const std::string& note() const { return note_; }
    PlayedHair& played() { return played_; }

    Status setWindow(const std::optional<gpu::NativeWindow>& window) { return shown_.setWindow(window); }
    Status take(PictureRequest request);
    /// One more picture of the last request.
    Result<std::pair<QImage, PictureReport>> draw();
    bool isComplete() const;
    /// draw() takes long, and `drop` stops it.
    bool canBeDropped() const { return still_ && !quickWaits_ && !keepsAverage_; }
    void forget();
    /// The device refuses all, and will.
    bool isLost() const { return !device_->createCommandList(); }
    /// All frames of a picture of something else, with a renderer of its own. A view is exact,
    /// but for filters, which blend code values. `drop` stops it: the software
    /// renderer at once, another after a frame.
    Result<QImage> drawAlone(PictureRequest request);

  private:
    DeviceWork(std::shared_ptr<const std::atomic<bool>> drop, software::DeviceChoice choice);
    /// Moves of strands become a groom of their own: not every picture takes every request.
    void joinMoves(PictureRequest& request);

    std::string note_;
    std::shared_ptr<const std::atomic<bool>> drop_;
    std::unique_ptr<gpu::Device> device_, stillDevice_;
    PlayedHair played_;
    Looks shown_;  ///< of the software renderer: what is quick
    // Of the software renderer.
    std::optional<Looks> still_;
    std::optional<PictureRequest> stillWaits_;  ///< still_ has yet to take it
    std::optional<PictureRequest> stillOf_;     ///< what it has
    bool quickWaits_ = false;                   ///< shown_ has a request that it has not drawn
    bool keepsAverage_ = false;                 ///< still_ is to be shown again as it is
    float lightTurn_ = 0;                       ///< of the last request
    std::shared_ptr<const Groom> handed_, moved_;
};

}  // namespace hairloom::editor
