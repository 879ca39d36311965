// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/hair_export.h"

#include <fmt/format.h>

#include "core/interpolation/follow_hairs.h"

namespace hairloom {

Result<ExportReport> exportHair(const Groom& groom, ExportedHair what, const StrandWriter& writer,
                                const std::filesystem::path& path, const StrandExportOptions& options) {
    const std::uint32_t perGuide = groom.interpolation.followPerGuide;
    if (what == ExportedHair::guides || perGuide == 0) {
        auto report = writer.write(groom, path, options);
        if (report && perGuide > 0 && !writer.generatesFollowHairs) {
            report->findings.push_back({Severity::Warning,
                                        fmt::format("{} follow hairs for each guide are left out", perGuide),
                                        "interpolation", "export hairs to write what pictures show"});
        }
        return report;
    }
    const auto bindings = bindFollowHairs(groom, groom.interpolation);
    if (!bindings) return tl::unexpected(bindings.error());
    const auto hairs = bakeFollowHairs(groom, *bindings);
    if (!hairs) return tl::unexpected(hairs.error());
    return writer.write(*hairs, path, options);
}

}  // namespace hairloom
