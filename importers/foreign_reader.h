// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Foreign files by way of hairloom-mesh-reader, a process that can do nothing but read them.

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/render/image.h"
#include "importers/child_process.h"
#include "importers/raw_strands.h"

namespace hairloom {

/// What the program writes of `file` where it is asked for `kind` ("stl", "strands"), with more words. Errors
/// name the file.
Result<std::vector<std::byte>> readInChild(const std::string& kind, const std::filesystem::path& file,
                                           std::vector<std::string> words, const ChildLimits& limits);

/// Once in a run, since it is of the machine and of no file: the layers of confinement that were lacking,
/// unless there are none.
void sayWhatTheGuardLacks(const std::string& lacking);

/// The file's own numbers. Errors: as importStrands().
Result<RawStrands> readStrandsInChild(const std::filesystem::path& file, const StrandImportOptions& options);

enum class PictureKind : std::uint8_t { Png, Exr, Jpeg };

/// A picture of one of the kinds, told by its content. Linear RGB; PNG and JPEG are taken for sRGB. Errors,
/// which name the file: not there, none of these, damaged, larger than core/render/picture_limits.h allows.
Result<render::LinearImage> readPicture(const std::filesystem::path& file,
                                        std::initializer_list<PictureKind> kinds);

}  // namespace hairloom
