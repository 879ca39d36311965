// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom::render {

/// A perspective or orthographic camera; world space, metres.
struct Camera {
    Vec3f eye_ws{0, 1.6f, 1};
    Vec3f target_ws{0, 1.6f, 0};
    Vec3f up_ws = Vec3f::UnitY();
    float verticalFov = 22;  ///< degrees, 1…150
    /// Metres from the lower to the upper edge of the picture, without perspective; 0: as the field of view
    /// has it.
    float orthographicHeight = 0;

    bool isOrthographic() const { return orthographicHeight > 0; }
};

enum class View { Front, Back, Left, Right, ThreeQuarter, Top, Bottom };

/// "front", "back", "left", "right", "three-quarter", "top", "bottom". The head looks along +Z; left is the
/// head's left (+X). From above the face is below in the picture, from below it is above.
Result<View> parseView(std::string_view name);

/// A camera that sees all of `bounds_ws` with a small margin. `aspect` = width / height. Empty bounds are
/// taken as a cube of 0.3 m around the origin.
Camera frame(View view, const Box3f& bounds_ws, float aspect);

/// Errors: not finite, no viewing direction, up along it, field of view out of range.
Status check(const Camera& camera);

/// Metres that a pixel covers at a point, in a picture `height_px` ≥ 1 pixels high. Points behind the eye
/// count as close before it.
float metresPerPixel(const Camera& camera, const Vec3f& point_ws, float height_px);

/// Right-handed view space (-Z forward) from world space.
Mat4f viewMatrix(const Camera& camera);
/// Clip space with depth 0 (near) … 1 (far).
Mat4f projectionMatrix(float verticalFovDegrees, float aspect, float nearPlane, float farPlane);
/// The same of the camera, which may be orthographic; the near plane may then lie behind the eye.
Mat4f projectionMatrix(const Camera& camera, float aspect, float nearPlane, float farPlane);

}  // namespace hairloom::render
