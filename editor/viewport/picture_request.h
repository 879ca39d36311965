// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the viewport asks its render thread for, and what it is told.

#include <QMetaType>
#include <memory>
#include <optional>
#include <vector>

#include "core/groom/groom.h"
#include "core/render/camera.h"
#include "core/render/overlay.h"
#include "core/simulation/motion.h"
#include "editor/viewport/picture_quality.h"

namespace hairloom::editor {

/// Where hair and head are at a moment of the simulation.
struct HairPose {
    std::vector<Vec3f> positions_ws;   ///< per point of the groom
    std::vector<Vec3f> velocities_ws;  ///< likewise, m/s; empty at rest
    HeadPose head;
    /// The device moves the hair itself (PlayedHair): positions, where there are any, are of a frame or two
    /// ago.
    bool onDevice = false;
    /// Seconds on the groom's time line, whose keys of the material count then; none: the pose is not of it.
    std::optional<float> lineTime;
};

/// Strands that have moved since a groom was handed over, so that a stroke hands over what it touches and no
/// more.
struct StrandMoves {
    std::vector<std::uint32_t> strands;
    std::vector<Vec3f> points_ws;  ///< of these, one strand after the other
};

struct PictureRequest {
    std::uint32_t document = 0;          ///< of which it is, as the viewport counts them
    std::shared_ptr<const Groom> groom;  ///< another pointer is another groom
    /// Since the last request with this groom, in all that are drawn of it; null: none.
    std::shared_ptr<const StrandMoves> moves;
    std::shared_ptr<const HairPose> pose;  ///< null: at rest
    render::Camera camera;
    render::Overlay marks;                ///< that the device draws
    std::uint32_t width = 1, height = 1;  ///< device pixels
    bool moving = false;                  ///< something moves: fast before fine
    bool showHair = true;
    bool showHead = true;
    float lightTurn = 0;  ///< degrees by which the lights are turned about the vertical
    float exposure = 1.6f;
    /// render::RenderOptions::toDisplay; another pointer is another view.
    std::shared_ptr<const render::ColourTransform> toDisplay;
    float lightScale = 1;                     ///< factor on the lights
    float environment = 1;                    ///< factor on the light from around
    Vec3f background{0.02f, 0.022f, 0.025f};  ///< linear RGB
    bool seeThrough = false;  ///< where nothing is, the picture is transparent instead; read back only
    PictureQuality quality;
    /// Another look of the same hair for the part of the picture left of `split` (0…1, of its width); null:
    /// none. Read back only.
    std::shared_ptr<const Groom> other;
    PictureQuality otherQuality;
    float split = 0.5f;
};

/// The same picture: they differ at most in their marks, in the line between two looks and in haste.
bool showsTheSame(const PictureRequest& a, const PictureRequest& b);

struct PictureReport {
    std::uint32_t document = 0;  ///< of the request
    render::Camera camera;       ///< likewise
    double milliseconds = 0;     ///< of this frame, everything included
    std::uint64_t hairs = 0;     ///< drawn
    std::uint32_t frames = 0;    ///< in the average
    bool moving = false;
    int displayError = 0;    ///< Renderer::displayError()
    bool presented = false;  ///< shown by the device; else the picture comes along
};

}  // namespace hairloom::editor

Q_DECLARE_METATYPE(hairloom::editor::PictureReport)
