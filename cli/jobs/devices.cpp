// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "cli/job.h"
#include "core/gpu/device.h"
#include "importers/reader_security.h"

namespace hairloom::cli {
namespace {

Result<Report> devices() {
    const auto found = gpu::listDevices();
    if (!found) return tl::unexpected(found.error());
    Report rows = Report::array();
    for (const gpu::DeviceInfo& info : *found) {
        rows.push_back(Report{{"index", info.index},
                              {"name", info.name},
                              {"backend", gpu::toString(info.backend)},
                              {"type", gpu::toString(info.type)},
                              {"api", info.apiVersion},
                              {"driver", info.driver},
                              {"usable", info.usable},
                              {"why_unusable", info.unusableReason},
                              {"samples", info.sampleCounts},
                              {"tessellation", info.tessellation},
                              {"timestamp_period_ns", info.timestampPeriodNs},
                              {"max_buffer_bytes", info.maxBufferBytes},
                              {"max_texture_size", info.maxTextureSize},
                              {"memory_bytes", info.memoryBytes}});
    }
    return Report{{"devices", std::move(rows)}};
}

/// "true" and "false" as such, numbers as numbers.
Report valueOf(const std::string& text) {
    const Report value = Report::parse(text, nullptr, false);
    return value.is_discarded() ? Report(text) : value;
}

Result<Report> security() {
    const auto found = readerSecurity();
    if (!found) return tl::unexpected(found.error());
    Report rows;
    for (const auto& [name, value] : *found) rows[name] = valueOf(value);
    return Report{{"security", std::move(rows)}};
}

JobRun declare(CLI::App& job) {
    const auto asksSecurity = std::make_shared<bool>(false);
    job.add_flag(
        "--security", *asksSecurity,
        "Report what the process that parses untrusted meshes cannot do on this machine, by testing it");
    return [asksSecurity](const std::string&) { return *asksSecurity ? security() : devices(); };
}

}  // namespace

Job devicesJob() {
    return {"devices", "List GPUs and what each supports", "--json", declare};
}

}  // namespace hairloom::cli
