// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/take_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/base/output_batch.h"
#include "core/simulation/frame_record.h"

namespace hairloom {
namespace {

/// Bytes of frames that are held at once.
constexpr double kMostHeld = 4e9;

/// Each frame of the range, in order.
Status visitFrames(TakeReader& reader, const TakeToExport& wanted, const WorkWatch& watch,
                   const std::function<Status(RecordedFrame)>& visit) {
    const auto count = static_cast<double>(wanted.last - wanted.first + 1);
    for (std::uint64_t number = wanted.first; number <= wanted.last; ++number) {
        auto frame = reader.frame(number);
        if (!frame) return tl::unexpected(frame.error());
        if (auto status = visit(std::move(*frame)); !status) return status;
        if (auto status = watch.at(static_cast<double>(number - wanted.first + 1) / count); !status)
            return status;
    }
    return {};
}

Result<ExportReport> exportFrames(TakeReader& reader, const Groom& groom, const TakeToExport& wanted,
                                  const std::filesystem::path& path) {
    auto recorder = FrameRecorder::open(path, groom, reader.info().framesPerSecond);
    if (!recorder) return tl::unexpected(recorder.error());
    const auto status = visitFrames(reader, wanted, wanted.watch, [&](const RecordedFrame& frame) {
        return recorder->add(frame.positions_ws, frame.pose);
    });
    if (!status) return tl::unexpected(status.error());
    if (auto finished = recorder->finish(); !finished) return tl::unexpected(finished.error());
    ExportReport report;
    report.format = kRecordFormat;
    report.strands = groom.strandCount();
    report.points = groom.pointCount();
    report.frames = static_cast<std::size_t>(wanted.last - wanted.first + 1);
    std::error_code code;
    const auto bytes = std::filesystem::file_size(whereWritten(path), code);
    report.bytes = code ? 0 : bytes;
    return report;
}

Result<ExportReport> exportClip(TakeReader& reader, const Groom& groom, const HairWriter& writer,
                                const TakeToExport& wanted, const std::filesystem::path& path) {
    auto clip = std::make_shared<ClipToWrite>();
    clip->name = wanted.name;
    clip->framesPerSecond = static_cast<double>(reader.info().framesPerSecond);
    clip->frames = wanted.last - wanted.first + 1;
    clip->loops = wanted.loops;
    clip->frame = [&](std::uint64_t number) -> Result<ClipToWrite::Frame> {
        auto frame = reader.frame(wanted.first + number);
        if (!frame) return tl::unexpected(frame.error());
        HeadPose pose = inWorld(std::move(frame->pose));
        return ClipToWrite::Frame{std::move(frame->positions_ws), pose.head_ws,
                                  std::move(pose.scalpPositions_ws)};
    };
    StrandExportOptions options = writer.targets.front().options;
    options.clip = std::move(clip);
    HairToExport hair;
    hair.cancel = wanted.watch.cancelled;
    if (wanted.watch.progress)
        hair.progress = [&](std::string_view, double share) { wanted.watch.progress(share); };
    return exportHair(groom, hair, writer, path, options);
}

Result<ExportReport> exportStrands(TakeReader& reader, const Groom& groom, const HairWriter& writer,
                                   const TakeToExport& wanted, const std::filesystem::path& path) {
    // A frame holds the head's vertices and spheres, and bones as matrices.
    // Follow hairs come beside the strands that they follow.
    const std::size_t drawn =
        wanted.hair == ExportedHair::guides ? 0 : groom.interpolation.followPerGuide + std::size_t{1};
    const std::size_t vectors = reader.info().points * (1 + drawn) +
                                (groom.scalp ? groom.scalp->vertexCount() : 0) + groom.spheres.size();
    const double bytes =
        static_cast<double>(wanted.last - wanted.first + 1) * static_cast<double>(vectors * sizeof(Vec3f));
    if (bytes > kMostHeld)
        return fail(
            fmt::format("frames {} to {} take {:.1f} GB of memory", wanted.first, wanted.last, bytes / 1e9),
            fmt::format("expected at most {:.0f} GB: export fewer frames at once", kMostHeld / 1e9));
    HairToExport hair;
    hair.hair = wanted.hair;
    hair.firstFrame = static_cast<double>(wanted.first);
    hair.cancel = wanted.watch.cancelled;
    constexpr double kReading = 0.3;  // of the time
    if (wanted.watch.progress)
        hair.progress = [&](std::string_view, double share) {
            wanted.watch.progress(kReading + (1 - kReading) * share);
        };
    // Wisps widen by their speed, known from the frame before.
    if (wanted.hair != ExportedHair::guides && wanted.first > 0) {
        auto before = reader.frame(wanted.first - 1);
        if (!before) return tl::unexpected(before.error());
        hair.frames.push_back(std::move(*before));
        hair.framesBefore = 1;
    }
    const auto status =
        visitFrames(reader, wanted, wanted.watch.part(0, kReading), [&](RecordedFrame frame) -> Status {
            hair.frames.push_back(std::move(frame));
            return {};
        });
    if (!status) return tl::unexpected(status.error());
    return exportHair(groom, hair, writer, path, writer.targets.front().options);
}

}  // namespace

std::vector<std::string> takeExportFormats() {
    std::vector<std::string> names{kRecordFormat};
    for (const HairWriter& writer : hairWriters()) {
        if (writer.animates || writer.holdsClips) names.push_back(writer.name);
    }
    return names;
}

bool canExportHairs(std::string_view format) {
    return format != kRecordFormat && std::ranges::any_of(hairWriters(), [&](const HairWriter& writer) {
               return writer.name == format && writer.animates;
           });
}

Result<ExportReport> exportTake(TakeReader& reader, const Groom& groom, const TakeToExport& wanted,
                                const std::filesystem::path& path) {
    if (wanted.last < wanted.first || wanted.last >= reader.info().frames)
        return fail(fmt::format("frames {} to {} were requested", wanted.first, wanted.last),
                    fmt::format("the take has {} frames, counted from 0", reader.info().frames));
    if (wanted.format == kRecordFormat) return exportFrames(reader, groom, wanted, path);
    const HairWriter& writer = strandWriter(wanted.format, hairWriters());
    return writer.holdsClips ? exportClip(reader, groom, writer, wanted, path)
                             : exportStrands(reader, groom, writer, wanted, path);
}

}  // namespace hairloom
