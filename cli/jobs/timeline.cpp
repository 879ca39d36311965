// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/documents/keyed_motion.h"
#include "core/documents/motions.h"
#include "core/documents/open.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/time_line_json.h"

namespace hairloom::cli {
namespace {

struct TimelineOptions {
    std::string input;
    std::string from;
    std::string motion;
    std::string keep;
    std::string keepMotion;
    std::string character;
    std::string output;
};

/// The time line that the options make of the groom's.
Result<TimeLine> edited(const TimelineOptions& options, const TimeLine& before) {
    TimeLine line = before;
    if (!options.from.empty()) {
        const auto text = readTextFile(options.from, kMaxJsonBytes);
        if (!text) return tl::unexpected(text.error());
        auto read = parseTimeLine(options.from, *text);
        if (!read) return read;
        line = std::move(*read);
    }
    if (!options.motion.empty()) {
        auto keys = loadMotionKeys(options.motion);
        if (!keys) return keys;
        line.head = std::move(keys->head);
        line.wind = std::move(keys->wind);
    }
    return line;
}

/// Clips that the head has, where its file can be read: a time line without clips needs none.
Report clipsOf(const TimelineOptions& options, const Groom& groom) {
    Report clips = Report::array();
    if (options.character.empty() && groom.characterFile.empty()) return clips;
    const auto actor = loadActor(options.character, groom);
    if (!actor) return {};
    for (const Clip& clip : (*actor)->clips())
        clips.push_back(Report{{"name", clip.name}, {"seconds", readableDecimal(clip.duration)}});
    return clips;
}

Result<Report> timeline(const TimelineOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    auto line = edited(options, timeLineOf(*groom));
    if (!line) return tl::unexpected(line.error());
    if (!options.output.empty()) {
        groom->timeLine = std::make_shared<const TimeLine>(*line);
        // What cannot play is not saved.
        const auto motion = makeMotion(std::string(kTimeLineMotion), options.character, *groom);
        if (!motion) return tl::unexpected(motion.error());
        if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    }
    Report report{{"time_line", toJson(*line)},
                  {"frames", line->frameCount()},
                  {"clips", clipsOf(options, *groom)},
                  {"keyable", keyableNames(*groom)}};
    if (!options.keep.empty()) {
        if (auto kept = writeFileAtomically(options.keep, timeLineText(*line)); !kept)
            return tl::unexpected(kept.error());
        report["kept"] = options.keep;
    }
    if (!options.keepMotion.empty()) {
        if (auto kept = saveMotionKeys(options.keepMotion, *line); !kept) return tl::unexpected(kept.error());
        report["kept_motion"] = options.keepMotion;
    }
    if (!options.output.empty()) report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<TimelineOptions>();
    job.add_option("groom", options->input, "Groom")->required();
    auto* output = job.add_option("-o,--output", options->output, "Project to write");
    job.add_option("--from", options->from,
                   "Replaces the time line with that of this file, as printed by --json "
                   "(docs/formats/hairloom.md)")
        ->needs(output);
    job.add_option("--motion", options->motion,
                   "Replaces the keys of head and wind with those of this keyframe file F.json")
        ->needs(output);
    job.add_option("--keep", options->keep, "File for the time line, for --from")->excludes(output);
    job.add_option("--keep-motion", options->keepMotion,
                   "Keyframe file F.json for its keys of head and wind, for --motion of any job")
        ->excludes(output);
    job.add_option("--character", options->character,
                   "File with skeleton and clips, if other than the scalp's file");
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject},
                            {options->keep, content::kJson},
                            {options->keepMotion, content::kJson}},
                           [&] { return timeline(*options); });
    };
}

}  // namespace

Job timelineJob() {
    return {"timeline", "List or set the time line: clips, keys of head, wind and settings",
            "hair.hairloom --from line.json -o moving.hairloom", declare};
}

}  // namespace hairloom::cli
