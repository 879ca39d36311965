// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Grooms into strand files. What each format carries and loses stands in docs/formats/strands.md.

#include <array>
#include <cstdint>
#include <filesystem>

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

/// Points per strand that TressFX can have.
inline constexpr std::array<std::uint32_t, 5> kTfxPointCounts{4, 8, 16, 32, 64};

/// Both replace `path` atomically, read the file back and compare. Strands that no consumer could use (fewer
/// than two points, not finite, of no length) are left out and reported. Errors: nothing left to write, a
/// limit of the format that options cannot mend, a file that cannot be written or does not read back.

/// Yuksel .hair: segments, points, thickness (diameter), and transparency and colours where the groom has
/// them.
Result<ExportReport> writeHair(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options = {});

/// TressFX .tfx version 4. Strands are resampled to `pointsPerStrand`, or to the allowed count nearest to
/// most strands. Inverse mass is 0 for the first two vertices and 1 for the others. Root UVs are always
/// written.
Result<ExportReport> writeTfx(const Groom& groom, const std::filesystem::path& path,
                              const StrandExportOptions& options = {});

}  // namespace hairloom
