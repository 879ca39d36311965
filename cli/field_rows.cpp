// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/field_rows.h"

#include "core/groom/file/fields.h"

namespace hairloom::cli {

std::vector<Section> settingsSections() {
    return {{"simulation", "how hair moves", fieldRows<runtime::SimulationSettings>()},
            {"material", "how hair looks", fieldRows<HairMaterial>()},
            {"shadows", "how hair shadows itself in images", fieldRows<ShadowSettings>()},
            {"interpolation", "how follow hairs come from guides", fieldRows<InterpolationSettings>()}};
}

std::vector<FieldRow> parameterRows(const editing::BrushInfo& brush) {
    std::vector<FieldRow> rows;
    for (const editing::BrushParameter& parameter : brush.parameters) {
        const Vec3d defaultValue(static_cast<double>(parameter.defaultValue), 0, 0);
        rows.push_back({parameter, valueToJson(parameter, defaultValue)});
    }
    return rows;
}

Report reportOf(const std::vector<FieldRow>& rows, const std::string& prefix) {
    Report report = Report::array();
    for (const auto& [info, defaultValue] : rows) {
        report.push_back(Report{{"field", prefix + info.name},
                                {"unit", info.unit},
                                {"min", info.min},
                                {"max", info.max},
                                {"default", defaultValue},
                                {"meaning", info.meaning}});
    }
    return report;
}

}  // namespace hairloom::cli
