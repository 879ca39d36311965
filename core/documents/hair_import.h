// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair of another program in place of a groom's, as a person imports it and as a script repeats it.

#include <string>
#include <string_view>

#include "core/groom/groom.h"
#include "core/operations/script.h"
#include "importers/strands.h"

namespace hairloom {

/// The strands of a file, bound to the head of `groom` where it has one. Of the options all but the scalp
/// count. Errors: as importStrands().
Result<ImportedStrands> importHairFor(const Groom& groom, const std::string& path,
                                      StrandImportOptions options);

/// Operators that came with the strands, as this version knows them; otherwise they go, with a warning.
void checkOperators(const std::string& path, ImportedStrands& imported);

/// Puts strands, group names and scalp selection of `hair` in place of the groom's, and its layers where it
/// has several; settings and spheres stay.
void replaceHair(Groom& groom, const Groom& hair);

/// Puts guides behind the strands of a groom; all others become hairs that are not simulated. Attributes that
/// one of both lacks are zeros there; radii are the material's. Operators go, and strands stay as they are.
void appendGuides(Groom& groom, const Groom& guides);

/// The operation "import" of a script (JSON) that does both. It holds the file's absolute path, not the file.
std::string importRecord(const std::string& path, const StrandImportOptions& options);

/// parseScript() with all operations that a document's script may hold: those of core/operations, an editor's
/// steps, "import" and "transfer". `file` is named in errors.
Result<Script> parseDocumentScript(const std::string& file, std::string_view text);

}  // namespace hairloom
