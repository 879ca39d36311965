// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_report.h"

namespace hairloom::cli {

Report planReport(const render::RenderPlan& plan) {
    Report passes = Report::array();
    for (std::size_t i = 0; i < render::kPassCount; ++i) {
        const auto pass = static_cast<render::Pass>(i);
        passes.push_back(
            Report{{"name", render::passName(pass)}, {"on", plan.runs(pass)}, {"why", plan.passes[i].why}});
    }
    Report targets = Report::array();
    for (std::size_t i = 0; i < render::kTargetCount; ++i) {
        const render::PlannedTarget& target = plan.targets[i];
        if (target.width == 0) continue;
        targets.push_back(Report{{"name", render::targetName(static_cast<render::TargetId>(i))},
                                 {"width", target.width},
                                 {"height", target.height},
                                 {"samples", target.samples},
                                 {"bytes", target.bytes()},
                                 {"why", target.why}});
    }
    Report buffers = Report::array();
    for (std::size_t i = 0; i < render::kBufferCount; ++i) {
        const render::PlannedBuffer& buffer = plan.buffers[i];
        if (buffer.elements == 0) continue;
        buffers.push_back(Report{{"name", render::bufferName(static_cast<render::BufferId>(i))},
                                 {"bytes", buffer.bytes()},
                                 {"why", buffer.why}});
    }
    return Report{{"passes", std::move(passes)},
                  {"targets", std::move(targets)},
                  {"buffers", std::move(buffers)},
                  {"tables", Report{{"bytes", plan.tables.bytes}, {"why", plan.tables.why}}},
                  {"bytes", plan.bytes()}};
}

}  // namespace hairloom::cli
