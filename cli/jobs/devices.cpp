// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job.h"
#include "core/gpu/device.h"

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

JobRun declare(CLI::App&) {
    return [](const std::string&) { return devices(); };
}

}  // namespace

Job devicesJob() {
    return {"devices", "List the GPUs and what each supports", "--json", declare};
}

}  // namespace hairloom::cli
