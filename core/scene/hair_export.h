// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair of a project into a file of another program.

#include <string>
#include <vector>

#include "core/simulation/frame_record.h"
#include "exporters/strands.h"

namespace hairloom {

enum class ExportedHair {
    guides,  ///< the strands of the groom, for programs that interpolate themselves
    hairs,   ///< the follow hairs that pictures show; the strands where the groom has none
};

/// What of a hairstyle is written.
struct HairToExport {
    ExportedHair hair = ExportedHair::guides;
    std::vector<std::string> layers;    ///< by their names; empty: all
    std::vector<RecordedFrame> frames;  ///< of all strands; empty: at rest; one: as they are there
    std::uint64_t firstFrame = 0;       ///< number of the first of them
};

/// Writes, reads back and compares as the writer does. The report says how many follow hairs stay behind
/// where guides alone are written. Errors: those of the writer and of bindFollowHairs(); a layer that is not
/// there; several frames for a format that holds one shape.
Result<ExportReport> exportHair(const Groom& groom, const HairToExport& wanted, const StrandWriter& writer,
                                const std::filesystem::path& path, const StrandExportOptions& options);

}  // namespace hairloom
