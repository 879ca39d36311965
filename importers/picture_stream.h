// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures as bytes, for the pipe between hairloom-mesh-reader and its parent, and the names of their kinds.

#include <span>
#include <string>
#include <string_view>

#include "core/render/image.h"
#include "importers/answer_stream.h"
#include "importers/foreign_reader.h"

namespace hairloom {

/// "PNG", "OpenEXR", "JPEG"; also words of a command line.
std::string_view name(PictureKind kind);
std::optional<PictureKind> pictureKindNamed(std::string_view name);
/// By how the content begins.
std::optional<PictureKind> pictureKindOf(std::span<const std::byte> bytes);

void writePicture(const Result<render::LinearImage>& picture, const std::string& lacking,
                  const AnswerWriter::Sink& sink);
/// Errors: the error that was written, or a message that the bytes are no picture within the limits.
Result<render::LinearImage> readPictureAnswer(const std::string& file, std::span<const std::byte> bytes,
                                              std::string& lacking);

}  // namespace hairloom
