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

StrandWriter abcWriter() {
    StrandExportOptions centimetres;
    centimetres.metresPerUnit = 0.01f;
    return {"abc",
            "Alembic .abc",
            "width and colour of each point; root UV, id, group and guide flag of each strand; attributes of "
            "any name",
            "none",
            {{"Blender, Alembic", ".abc in metres, Y up, as Blender takes every Alembic file", {}},
             {"Houdini, Alembic", ".abc in metres, Y up", {}},
             {"Maya, Alembic", ".abc in centimetres, Y up", centimetres}},
            write};
}

}  // namespace hairloom
