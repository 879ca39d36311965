// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A take into files of other programs and of games. Films are made where images are (core/live/film.h).

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/work_watch.h"
#include "core/documents/hair_export.h"
#include "core/simulation/take_file.h"
#include "exporters/strands.h"

namespace hairloom {

/// The format of a record of frames, which simulate writes, too.
inline constexpr const char* kRecordFormat = "frames";

/// Names of formats that takes are exported in, without those of films: a record, an asset for games, and
/// strands that move.
std::vector<std::string> takeExportFormats();

/// Whether follow hairs may be written, not the strands alone: an asset for games makes them itself, and a
/// record is of what was simulated.
bool canExportHairs(std::string_view format);

struct TakeToExport {
    std::string name;                          ///< that a clip gets
    std::string format;                        ///< one of takeExportFormats()
    std::uint64_t first = 0, last = 0;         ///< frames, counted from 0, both in the file
    bool loops = false;                        ///< of a clip: behind the last frame comes the first
    ExportedHair hair = ExportedHair::guides;  ///< of formats that canExportHairs()
    WorkWatch watch{};
};

/// Of a reader that uses this groom. Errors: no such frames; those of reading and of exportHair(); strands
/// that take more memory than 4 GB.
Result<ExportReport> exportTake(TakeReader& reader, const Groom& groom, const TakeToExport& wanted,
                                const std::filesystem::path& path);

}  // namespace hairloom
