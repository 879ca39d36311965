// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// RawScene as bytes, for the pipe between hairloom-mesh-reader and its parent. Both come from one build, so
// there is no version to negotiate; the reader treats the bytes as hostile all the same.

#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/file.h"
#include "importers/raw_scene.h"

namespace hairloom {

/// Begins the first warning of a scene whose reader lacked layers of confinement; their names follow.
inline constexpr std::string_view kGuardWarning = "guard: ";

/// The scene, or the reason why there is none.
ByteWriter writeRawScene(const Result<RawScene>& scene);

/// What writeRawScene() wrote; the scene is not validated further than that it can be held. Errors: the error
/// that was written, or a message that the bytes are no scene. `file` is named in errors.
Result<RawScene> readRawScene(const std::string& file, std::span<const std::byte> bytes);

}  // namespace hairloom
