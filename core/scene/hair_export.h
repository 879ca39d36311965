// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair of a project into a file of another program.

#include "exporters/strands.h"

namespace hairloom {

enum class ExportedHair {
    guides,  ///< the strands of the groom, for programs that interpolate themselves
    hairs,   ///< the follow hairs that pictures show, at rest; the strands where the groom has none
};

/// Writes, reads back and compares as the writer does. The report says how many follow hairs stay behind
/// where guides alone are written. Errors: those of the writer and of bindFollowHairs().
Result<ExportReport> exportHair(const Groom& groom, ExportedHair what, const StrandWriter& writer,
                                const std::filesystem::path& path, const StrandExportOptions& options);

}  // namespace hairloom
