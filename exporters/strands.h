// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Grooms into strand files. What each format carries and loses stands in docs/formats/strands.md.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"
#include "exporters/report.h"
#include "importers/strands.h"

namespace hairloom {

struct StrandExportOptions {
    float metresPerUnit = 1.0f;  ///< > 0; metres in one unit of the file
    UpAxis up = UpAxis::Y;       ///< axis of the file that points up; Z up becomes (x, −z, y)
    std::uint32_t pointsPerStrand =
        0;  ///< resamples every strand evenly to so many; 0 keeps what the format allows
};

/// A program that reads a format, and what it wants of a file.
struct ExportTarget {
    std::string name;
    std::string note;
    StrandExportOptions options;
};

/// A format that hair is written in. One file NAME_writer.cpp of this folder: nameWriter() says what it is.
struct StrandWriter {
    std::string name;     ///< as `--format` has it: the suffix of its files and, behind a hyphen, for whom
    std::string label;    ///< "TressFX .tfx"
    std::string carries;  ///< in words: what else than positions
    std::string limits;   ///< in words
    std::vector<ExportTarget> targets;  ///< at least one
    std::string suffix() const { return name.substr(0, name.find('-')); }
    /// Replaces `path` atomically, reads the file back and compares. Strands that no consumer could use
    /// (fewer than two points, not finite, of no length) are left out and reported. Errors: nothing left to
    /// write, a limit of the format that options cannot mend, a file that cannot be written or does not read
    /// back.
    Result<ExportReport> (*write)(const Groom& groom, const std::filesystem::path& path,
                                  const StrandExportOptions& options);
};
const std::vector<StrandWriter>& strandWriters();
/// The writer of that name; there must be one.
const StrandWriter& strandWriter(std::string_view name);

}  // namespace hairloom
