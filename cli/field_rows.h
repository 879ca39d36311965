// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What there is to set, as lists of described fields: for `set --list`, `groom --list` and the reference
// page.

#include <string>
#include <vector>

#include "cli/job.h"
#include "core/editing/brush_list.h"
#include "core/groom/file/json_reader.h"

namespace hairloom::cli {

struct Section {
    std::string name;   ///< as in project files and in SECTION.FIELD=VALUE
    std::string holds;  ///< a few words
    std::vector<FieldRow> fields;
};
/// The settings of a groom that `set` sets.
std::vector<Section> settingsSections();

/// What a brush has beside the settings of all.
std::vector<FieldRow> parameterRows(const editing::BrushInfo& brush);

/// field, unit, min, max, default, meaning; the field's name behind `prefix`.
Report reportOf(const std::vector<FieldRow>& rows, const std::string& prefix = {});

}  // namespace hairloom::cli
