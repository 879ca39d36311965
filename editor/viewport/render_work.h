// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the render thread keeps between pictures: renderer, the scene on the device, and the window or texture
// that it draws into. Used on that thread only.

#include <QImage>
#include <optional>

#include "core/gpu/device.h"
#include "core/live/groom_scene.h"
#include "core/render/renderer.h"
#include "editor/viewport/picture_request.h"
#include "editor/viewport/played_hair.h"

namespace hairloom::editor {

class RenderWork {
  public:
    /// Both outlive it. `played`: hair that is simulated on the device, for requests that show it; may be
    /// null.
    RenderWork(gpu::Device& device, PlayedHair* played);

    Status setWindow(const std::optional<gpu::NativeWindow>& window);
    /// Takes what differs from the last request to the device.
    Status take(PictureRequest request);
    /// One more frame. The image is null where a window shows it.
    Result<std::pair<QImage, PictureReport>> draw();
    /// The average by a view itself, of which devices have but a table. At least one frame is drawn.
    Result<QImage> shownBy(const render::ColourTransform& toDisplay) const;
    /// The average of the last request is complete, or nothing was asked for.
    bool isComplete() const;
    /// Frames in the average that was shown last.
    std::uint32_t frames() const { return renderer_.accumulated(); }
    /// The last frame was left (software::kDropped): the next does it.
    void takeBack() { renderer_.takeBack(); }
    /// While true, draw() shows the average as it is.
    void holdAverage(bool on) { renderer_.holdAverage(on); }
    /// While true, light and shadows stay as they were: Renderer::holdMaps().
    void holdMaps(bool on) { renderer_.holdMaps(on); }
    /// Drops the last request: it could not be drawn.
    void forget() {
        handed_.reset();
        moved_.reset();
        unkeyed_.reset();
        keyed_.reset();
        last_.reset();
        scene_.reset();
    }

  private:
    void takeMoves(PictureRequest& request);
    /// The groom with the material that its time line keys at the time of the pose.
    void takeKeys(PictureRequest& request);
    Status takeScene(const PictureRequest& request, bool draft);
    /// As this device draws it.
    Groom shownOf(const Groom& groom, bool draft) const;
    Status replaceScene(const PictureRequest& request, bool draft);
    Status movePoints(const PictureRequest& request);
    /// What the request shows where the device simulates it; null: it does not.
    MovingHair* playedIn(const PictureRequest& request) const;
    Status moveStrands(const PictureRequest& request, const StrandMoves& moves);
    Status showWidths(const PictureRequest& request);
    Status showDye(const PictureRequest& request);
    Status resize(std::uint32_t width, std::uint32_t height);
    void adapt(double milliseconds);
    render::RenderOptions options() const;
    Result<QImage> readBack() const;

    gpu::Device& device_;
    PlayedHair* played_;
    bool software_;  ///< the device is the software renderer
    render::Renderer renderer_;
    std::optional<gpu::NativeWindow> window_;
    std::unique_ptr<gpu::SwapChain> swapChain_;  ///< null: pictures are read back from target_
    gpu::TexturePtr target_;
    std::uint32_t width_ = 0, height_ = 0;  ///< of the target

    std::shared_ptr<const Groom> handed_;           ///< as the last request had it
    std::shared_ptr<Groom> moved_;                  ///< the same with all moves since then; null: none
    std::shared_ptr<const Groom> unkeyed_, keyed_;  ///< of the last request whose pose has a time; null: none
    float keyedTime_ = 0;
    std::optional<PictureRequest> last_;  ///< its groom is moved_ or keyed_ where there is one
    std::optional<GroomScene> scene_;     ///< of last_
    bool hairShown_ = true, headShown_ = true;
    bool draft_ = false;       ///< scene_ is without follow hairs
    bool needsDraft_ = false;  ///< follow hairs are too slow to move
    float scale_ = 1;          ///< of pictures in motion that are read back, so that they come in time
};

}  // namespace hairloom::editor
