// SPDX-License-Identifier: GPL-3.0-or-later
// Alembic curves with the attributes of Unreal's groom schema, version 1.5.

#include "exporters/alembic_curves.h"

namespace hairloom {
namespace {

Result<ExportReport> write(const Groom& groom, const std::filesystem::path& path,
                           const StrandExportOptions& options) {
    return writeAlembic(groom, path, options, true);
}

}  // namespace

HairWriter abcUnrealWriter() {
    StrandExportOptions centimetres;
    centimetres.metresPerUnit = 0.01f;
    centimetres.limits = {"Unreal", 0, 255, 2, false};
    HairWriter writer{
        "abc-unreal",
        "Alembic .abc for Unreal's groom importer",
        "what abc carries, and Unreal's groom schema 1.5: widths, closest guides and their weights, version "
        "and tool",
        "Unreal reads units as centimetres",
        {{"unreal", "Unreal groom",
          ".abc in centimetres, Y up. Import it with rotation 90, 0, 0 and scale 1, -1, 1", centimetres}},
        write};
    writer.animates = true;
    writer.marksGuides = true;
    return writer;
}

}  // namespace hairloom
