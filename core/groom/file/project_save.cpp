// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "core/base/file.h"
#include "core/base/profiler.h"
#include "core/groom/file/project_content.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/project_sections.h"
#include "core/groom/validate.h"
#include "hairloom/body_field.h"

namespace hairloom {
namespace {

/// What the JSON head cannot hold or loading would refuse. Flaws of values (hair that is not finite) are no
/// reason to keep an artist from saving.
Status checkSavable(const Groom& groom) {
    if (auto status = checkStructure(groom); !status) return status;
    for (const Finding& finding : validateSettings(groom))
        return fail(finding.where + ": " + finding.what, finding.fix);
    return {};
}

}  // namespace

Status saveProject(const Groom& groom, const std::filesystem::path& path) {
    HAIRLOOM_PROFILE("groom: save project");
    const auto refuse = [&](const Error& error) { return tl::unexpected(inFile(error, path.string())); };
    if (auto status = checkSavable(groom); !status) return refuse(status.error());
    ArchiveWriter writer{std::string(section::kKind), kProjectVersion};
    const std::vector<std::uint8_t> body = groom.body ? groom.body->toBytes() : std::vector<std::uint8_t>();
    addProjectArrays(writer, groom, body);
    const auto file = writer.finish(projectHead(groom, path));
    if (!file) return refuse(file.error());
    return writeFileAtomically(path, *file);
}

}  // namespace hairloom
