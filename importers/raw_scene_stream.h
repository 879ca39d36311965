// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// RawScene as bytes, for the pipe between hairloom-mesh-reader and its parent.

#include <cstddef>
#include <span>
#include <string>

#include "importers/answer_stream.h"
#include "importers/raw_scene.h"

namespace hairloom {

/// The scene, or the reason why there is none; `lacking` names the layers of confinement that its reader
/// lacked.
void writeRawScene(const Result<RawScene>& scene, const std::string& lacking, const AnswerWriter::Sink& sink);

/// What writeRawScene() wrote; the scene is not validated further than that it can be held. Errors: the error
/// that was written, or a message that the bytes are no scene. `file` is named in errors.
Result<RawScene> readRawScene(const std::string& file, std::span<const std::byte> bytes,
                              std::string& lacking);

}  // namespace hairloom
