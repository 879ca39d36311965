// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "core/animation/actor.h"

namespace hairloom::editor {

/// Name of the bone that carries the skin around a point of the head at rest; empty where none does.
inline std::string boneNear(const Actor& actor, const Vec3f& point_ss) {
    const auto bone = actor.boneNear(point_ss);
    return bone ? actor.skeleton().bones()[*bone].name : std::string();
}

}  // namespace hairloom::editor
