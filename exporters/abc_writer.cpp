// SPDX-License-Identifier: GPL-3.0-or-later
// Alembic curves as any program reads them.

#include "exporters/alembic_curves.h"

namespace hairloom {
namespace {

Result<ExportReport> write(const Groom& groom, const std::filesystem::path& path,
                           const StrandExportOptions& options) {
    return writeAlembic(groom, path, options, false);
}

}  // namespace

HairWriter abcWriter() {
    StrandExportOptions centimetres;
    centimetres.metresPerUnit = 0.01f;
    StrandExportOptions unity;
    unity.limits = unityLimits();
    HairWriter writer{
        "abc",
        "Alembic .abc",
        "width and colour of each point; root UV, id, group and guide flag of each strand; all attributes",
        "none",
        {{"blender", "Blender, Alembic", ".abc in metres, Y up, as Blender reads every Alembic file", {}},
         {"houdini", "Houdini, Alembic", ".abc in metres, Y up", {}},
         {"maya", "Maya, Alembic", ".abc in centimetres, Y up", centimetres},
         {"unity", "Unity hair", ".abc in metres, Y up, with 3 to 128 points and at most 64,000 strands",
          unity}},
        write};
    writer.animates = true;
    return writer;
}

}  // namespace hairloom
