// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "cli/documents.h"
#include "cli/head_options.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/documents/head_transfer.h"
#include "core/groom/file/project_file.h"

namespace hairloom::cli {
namespace {

constexpr float kFar_m = 0.005f;  ///< roots that were farther off are named
constexpr std::size_t kNamed = 100, kNamedInWords = 3;
constexpr std::size_t kFewFar = 10;  ///< one in so many far roots is worth no word

struct TransferOptions {
    std::string input, to, output;
    HeadOptions head;
};

Result<Report> transferHair(const TransferOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    Progress bar("transferring", 1000);
    const WorkWatch watch{[&](double share) { bar.done(static_cast<std::size_t>(1000 * share)); }};
    const auto done = transferToFile(*groom, options.to, headImportOptions(options.head), watch);
    if (!done) return tl::unexpected(inFile(done.error(), options.input));
    const Transfer* const transfer = &done->transfer;
    if (transfer->baked)
        log::warning("{}: its operators refer to places on the old head, so they were baked", options.input);
    Report report;
    report["strands"] = groom->strandCount();
    report["same_mesh"] = transfer->sameMesh;
    report["scale"] = transfer->fit.scale;
    report["max_root_error_mm"] = 1e3 * static_cast<double>(*std::ranges::max_element(transfer->distances));
    const auto far = static_cast<std::size_t>(
        std::ranges::count_if(transfer->distances, [](float d) { return d > kFar_m; }));
    report["strands_far"] = far;
    if (far > groom->strandCount() / kFewFar)
        log::warning(
            "{}: {} of {} roots moved more than {} mm to reach its surface. Heads may be unlike each other, "
            "or hair lies on another part: look at it, and use --turn, --up or --leave-out",
            options.to, far, groom->strandCount(), 1e3f * kFar_m);
    report["strands_named"] = Report::array();
    const std::size_t named = isReportJson() ? kNamed : kNamedInWords;
    for (std::size_t s = 0; s < transfer->distances.size() && report["strands_named"].size() < named; ++s) {
        if (transfer->distances[s] > kFar_m)
            report["strands_named"].push_back(Report{{"strand", s}, {"mm", 1e3f * transfer->distances[s]}});
    }
    report["layers"] = Report::array();
    for (const Layer& layer : groom->layers) report["layers"].push_back(layer.name);
    report["groups"] = groom->groupNames;
    report["resampled_fps"] = nullptr;  // beside import, which may resample motion
    report["head"] = headReport(done->taken, done->words);
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<TransferOptions>();
    job.add_option("groom", options->input, "Hair that grows on a head")->required();
    job.add_option("--to", options->to, "New head")->required();
    addHeadOptions(job, options->head);
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return transferHair(*options); });
    };
}

}  // namespace

Job transferJob() {
    return {"transfer", "Transfer a hairstyle to another head",
            "bob.hairloom --to head.obj --unit dm -o bob2.hairloom", declare};
}

}  // namespace hairloom::cli
