// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What of a groom's attributes a file has, and what stays behind.

#include "exporters/prepared_strands.h"

namespace hairloom {

/// Fills `attributes` and `leftBehind` of the report from what the file reads back as. `readBack` has the
/// strands of `prepared`, in order; `metresPerUnit` is of the file.
void compareAttributes(const Groom& groom, const PreparedStrands& prepared, float metresPerUnit,
                       const ImportedStrands& readBack, ExportReport& report);

}  // namespace hairloom
