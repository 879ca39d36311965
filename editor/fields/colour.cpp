// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/colour.h"

#include <algorithm>
#include <cmath>

namespace hairloom::editor {
namespace {

// IEC 61966-2-1.
float encode(float linear) {
    const float value = std::clamp(linear, 0.0f, 1.0f);
    return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
}
float decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

QColor fromLinear(const Vec3f& linear) {
    return QColor::fromRgbF(std::clamp(encode(linear.x()), 0.0f, 1.0f),
                            std::clamp(encode(linear.y()), 0.0f, 1.0f),
                            std::clamp(encode(linear.z()), 0.0f, 1.0f));
}

Vec3f toLinear(const QColor& colour) {
    return {decode(colour.redF()), decode(colour.greenF()), decode(colour.blueF())};
}

}  // namespace hairloom::editor
