// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Marks drawn by the interface itself, to lie over a picture that was made before: nothing waits for the
// next.

#include <QImage>
#include <QRect>
#include <QSize>
#include <array>
#include <span>
#include <vector>

#include "core/groom/groom.h"
#include "core/render/camera.h"
#include "core/render/overlay.h"
#include "core/simulation/motion.h"

namespace hairloom::editor {

class MarkSheet {
  public:
    /// Marks, as large as they reach in the view.
    struct Sheet {
        QImage image;  ///< colour times coverage; null: no mark is in sight
        QRect at_px;   ///< where it lies, device pixels of the view
    };

    /// Seen by `camera` in a view of `size_px` device pixels. The head of `groom`, moved by `pose` (null: at
    /// rest), hides what lies behind it, unless `showsHead` is false. Marks are `scale` times their size.
    /// Nothing where there is no memory for it, or the marks are not valid.
    Sheet draw(const render::Overlay& marks, const render::Camera& camera, const QSize& size_px, float scale,
               const Groom& groom, const HeadPose* pose, bool showsHead);

  private:
    std::span<const float> depthOfHead(const Mat4f& clipFromWorld, const QSize& size_px,
                                       std::span<const Vec3f> positions_ws, const ScalpMesh& head);

    // The last depths, and what they are of.
    std::vector<float> depths_;
    Mat4f seenAs_ = Mat4f::Zero();
    QSize size_px_;
    std::vector<Vec3f> positions_ws_;
};

}  // namespace hairloom::editor
