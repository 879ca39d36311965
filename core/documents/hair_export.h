// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair of a project into a file of another program.

#include <string>
#include <vector>

#include "core/documents/sampled_motion.h"
#include "core/levels/level_chain.h"
#include "core/simulation/frame_record.h"
#include "exporters/strands.h"

namespace hairloom {

enum class ExportedHair {
    guides,  ///< the strands of the groom, for programs that interpolate themselves
    hairs,   ///< the follow hairs that pictures show; the strands where the groom has none
    all,     ///< those, and beside them the guides that they follow; of writers that keep these apart
};

/// What of a hairstyle is written.
struct HairToExport {
    ExportedHair hair = ExportedHair::guides;
    std::vector<std::string> layers;  ///< by their names; empty: all
    /// Of all strands; empty: at rest; one in the file: as they are there. So many at both ends are not in
    /// the file, and serve its shutter (framesAround()).
    std::vector<RecordedFrame> frames;
    std::size_t framesBefore = 0, framesAfter = 0;
    double firstFrame = 0;       ///< number in the file of the first frame that is in it
    double framesPerSecond = 0;  ///< of the file; 0: of the record
    Shutter shutter{};
    /// So many random storms find what a game may do to the guides (core/stability/certificate.h; its
    /// thousand take half a minute or so). The report has it, and files that can carry it. 0: none.
    std::uint32_t storms = 0;

    /// Of formats that hold cards; those stand for the hairs that pictures show.
    LevelBudget levels;
    cards::Progress progress;        ///< share of all, with what is being made; may be empty
    cards::Cancel cancel = nullptr;  ///< of the same; may be null
};

/// Writes, reads back and compares as the writer does; cards are made and measured. The report says how many
/// follow hairs stay behind where guides alone are written. Errors: those of the writer, of
/// bindFollowHairs(), certify(), makeLevels() and levelFile(); a layer that is not there; several frames for
/// a format that holds one shape; units, axes or points of strands for cards.
Result<ExportReport> exportHair(const Groom& groom, const HairToExport& wanted, const HairWriter& writer,
                                const std::filesystem::path& path, const StrandExportOptions& options);

}  // namespace hairloom
