// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/groom/file/poses_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/poses.h"
#include "core/groom/time_line.h"

namespace hairloom::cli {
namespace {

struct PoseOptions {
    std::string input;
    std::string name;
    std::string from;
    std::optional<float> amount;
    std::optional<std::uint32_t> mask;
    std::vector<float> ramp;
    std::string output;
    bool make = false;
    bool remove = false;
    bool invert = false;
};

/// Values at even distances from root to tip.
runtime::Ramp rampOf(const std::vector<float>& values) {
    std::vector<runtime::Ramp::Key> keys;
    for (std::size_t k = 0; k < values.size(); ++k)
        keys.push_back({static_cast<float>(k) / static_cast<float>(values.size() - 1), values[k]});
    return runtime::Ramp::of(keys);
}

Status change(Groom& groom, const PoseOptions& options) {
    if (options.remove) return removePose(groom, options.name);
    if (!options.from.empty()) {
        const auto other = openGroom(options.from);
        if (!other) return tl::unexpected(other.error());
        if (auto put = putPoseOf(groom, options.name, *other); !put)
            return tl::unexpected(inFile(put.error(), options.from));
    } else if (options.make) {
        const auto positions = groom.positions();
        const std::vector<Vec3f> shape(positions.begin(), positions.end());
        if (auto put = putPose(groom, options.name, shape); !put) return put;
    }
    const auto found = placeOfPose(groom, options.name);
    if (!found) return tl::unexpected(found.error());
    GroomPose& pose = groom.poses[*found];
    if (options.amount) pose.amount = *options.amount;
    if (options.mask) {
        pose.mask = *options.mask;
        pose.invert = options.invert;
    }
    if (!options.ramp.empty()) pose.ramp = rampOf(options.ramp);
    return {};
}

Report posesReport(const Groom& groom) {
    Report rows = toJson(groom.poses);
    for (std::size_t k = 0; k < groom.poses.size(); ++k) {
        const GroomPose& pose = groom.poses[k];
        const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(pose.name));
        const auto positions = groom.positions();
        float farthest = 0;
        for (std::size_t s = 0; s < groom.strandCount() && !shape.empty(); ++s) {
            const auto known = shape.subspan(groom.offsets[s], groom.offsets[s + 1] - groom.offsets[s]);
            if (!knowsStrand(known)) continue;
            for (std::size_t p = 0; p < known.size(); ++p)
                farthest = std::max(farthest, (known[p] - positions[groom.offsets[s] + p]).norm());
        }
        std::size_t keys = 0;
        for (const SettingTrack& track : timeLineOf(groom).settings) {
            if (track.name == poseAttribute(pose.name)) keys = track.keys.size();
        }
        rows[k]["farthest_mm"] = 1e3f * farthest;
        rows[k]["keys"] = keys;
    }
    return rows;
}

Result<Report> pose(const PoseOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (!options.name.empty()) {
        if (auto changed = change(*groom, options); !changed)
            return tl::unexpected(inFile(changed.error(), options.input));
    }
    Report report{{"strands", groom->strandCount()}, {"poses", posesReport(*groom)}};
    if (!options.output.empty()) {
        if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
        report["output"] = options.output;
    }
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<PoseOptions>();
    job.add_option("groom", options->input, "Groom")->required();
    auto* output = job.add_option("-o,--output", options->output, "Project to write");
    auto* name = job.add_option("--name", options->name, "Pose to make or change")->needs(output);
    output->needs(name);
    auto* make = job.add_flag("--make", options->make,
                              "Makes it from the groom's shape, or gives it that shape if it is there")
                     ->needs(name);
    auto* from =
        job.add_option("--from", options->from, "Likewise, from the shape of this groom of the same strands")
            ->needs(name)
            ->excludes(make);
    job.add_option("--amount", options->amount,
                   "How far simulated hair follows it: 0 not at all, 1 completely, except for collisions")
        ->check(CLI::Range(0.0, 1.0))
        ->needs(name);
    auto* mask = job.add_option("--mask", options->mask,
                                "Painted mask of the strands that follow it. 0 is all of them")
                     ->check(CLI::Range(0u, kPaintedMasks))
                     ->needs(name);
    job.add_flag("--invert", options->invert, "Uses one minus the mask")->needs(mask);
    job.add_option("--ramp", options->ramp,
                   "Shares of the amount at even distances from root to tip, such as 1,0.5,0")
        ->delimiter(',')
        ->expected(2, static_cast<int>(runtime::Ramp::kMaxKeys))
        ->check(CLI::Range(0.0, 1.0))
        ->needs(name);
    job.add_flag("--remove", options->remove, "Removes it. Its keys stay")
        ->needs(name)
        ->excludes(make)
        ->excludes(from);
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return pose(*options); });
    };
}

}  // namespace

Job poseJob() {
    return {"pose", "List, make or change poses that simulated hair follows",
            "hair.hairloom --name Swept --from combed.hairloom --amount 0.6 -o posed.hairloom", declare};
}

}  // namespace hairloom::cli
