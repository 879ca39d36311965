// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/take_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/base/output_file.h"
#include "core/documents/motions.h"
#include "core/documents/takes.h"
#include "core/simulation/frame_record.h"
#include "core/simulation/rest_positions.h"
#include "core/simulation/resume.h"
#include "core/simulation/simulation.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

/// A loop that was not finished is none, and no take that somebody wants back.
template <class T>
Result<T> orNothing(Result<T> made, const fs::path& to) {
    if (made) return made;
    for (const LeftOver& leftOver : findLeftOvers(to.parent_path())) {
        if (!leftOver.whole && fs::path(leftOver.target).filename() == to.filename())
            static_cast<void>(removeLeftOver(leftOver));
    }
    return made;
}

/// Metres, of the strands' first points.
double farthestRoot(const Groom& groom, std::span<const Vec3f> a, std::span<const Vec3f> b) {
    float farthest = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::uint32_t root = groom.offsets[s];
        if (root < groom.offsets[s + 1]) farthest = std::max(farthest, (a[root] - b[root]).norm());
    }
    return static_cast<double>(farthest);
}

Result<LoopReport> writeLoop(TakeReader& source, const Groom& groom, const LoopToMake& wanted,
                             const fs::path& to) {
    const TakeInfo& info = source.info();
    const std::uint64_t frames = wanted.last - wanted.first + 1;
    const auto loops = loopOfNotes(info.notes);
    const LoopNotes notes{wanted.first + (loops ? loops->first : 0), frames, wanted.blend};
    auto writer = TakeWriter::open(to, groom, info.framesPerSecond, withLoop(info.notes, notes));
    if (!writer) return tl::unexpected(writer.error());
    LoopCloser loop(groom.offsets.view(), frames, wanted.blend, info.framesPerSecond);
    for (std::uint64_t number = wanted.first - LoopCloser::leads(wanted.blend); number <= wanted.last;
         ++number) {
        auto frame = source.frame(number);
        if (!frame) return tl::unexpected(frame.error());
        if (number < wanted.first) {
            loop.lead(frame->positions_ws);
            continue;
        }
        if (auto added = writer->add(loop.close(frame->positions_ws), frame->pose); !added)
            return tl::unexpected(added.error());
        const auto share = static_cast<double>(number - wanted.first + 1) / static_cast<double>(frames);
        if (auto status = wanted.watch.at(share); !status) return tl::unexpected(status.error());
    }
    if (auto finished = writer->finish(); !finished) return tl::unexpected(finished.error());
    return loop.report();
}

/// Frames over which hair leads in: twist and joints then are what they were.
constexpr std::uint64_t kLeadIn = 12;

/// The last frames that are copied.
using LeadIn = std::deque<RecordedFrame>;

Result<LeadIn> keepFrames(TakeReader& source, const TakeToResume& wanted, TakeWriter& writer,
                          const WorkWatch& watch) {
    LeadIn frames;
    for (std::uint64_t number = 0; number <= wanted.at; ++number) {
        auto frame = source.frame(number);
        if (!frame) return tl::unexpected(frame.error());
        if (auto added = writer.add(frame->positions_ws, frame->pose); !added)
            return tl::unexpected(added.error());
        if (frames.size() > kLeadIn) frames.pop_front();
        frames.push_back(std::move(*frame));
        const auto share = static_cast<double>(number + 1) / static_cast<double>(wanted.at + 1);
        if (auto status = watch.at(share); !status) return tl::unexpected(status.error());
    }
    return frames;
}

/// The first of these frames, as fast as it goes to the next one; without speed where there is none.
Result<std::shared_ptr<const runtime::State>> stateOfFirst(RecordedStates& states, const LeadIn& frames) {
    const RecordedFrame& first = frames.front();
    return states.at(first, first, frames.size() > 1 ? frames[1] : first, 1 / first.framesPerSecond);
}

Result<ResumeReport> writeResumed(TakeReader& source, const Groom& given, const HeadMotion& motion,
                                  const std::string& name, const TakeToResume& wanted, const fs::path& to) {
    const float rate = source.info().framesPerSecond;
    const FramePace pace{rate, 0};
    Groom groom = given;
    // The take's first frame is the one behind the start of the motion.
    KeyedSettings keyed(motion, given.simulation,
                        pace.timeOf(static_cast<float>(wanted.at + 1), pace.steps()));
    groom.simulation = keyed.first();
    ResumeReport report{wanted.at + 1, wanted.frames, 0};
    if (report.simulated == 0) report.simulated = source.info().frames - report.kept;
    auto writer = TakeWriter::open(to, groom, rate, takeNotes(name, given, "cpu", 0));
    if (!writer) return tl::unexpected(writer.error());
    const double whole = static_cast<double>(report.kept + report.simulated);
    constexpr double kCopying = 0.1;  // of the time that a frame takes
    const double copied = kCopying * static_cast<double>(report.kept) / whole;
    const auto kept = keepFrames(source, wanted, *writer, wanted.watch.part(0, copied));
    if (!kept) return tl::unexpected(kept.error());

    const HeadPose last = motion.poseAt(pace.timeOf(static_cast<float>(report.kept), pace.steps()));
    report.headMm =
        1e3 * farthestRoot(groom, posedPositions(groom, inWorld(last)), kept->back().positions_ws);
    if (report.headMm > LoopSeam::kClosedMm)
        return fail(fmt::format("at frame {} the head is {:.1f} mm from where the motion '{}' has it",
                                wanted.at, report.headMm, name),
                    "expected the motion of the take, recorded from its start, with the head where it was");
    // Hair leads in from the first of the frames before, number `from` of the motion.
    const std::uint64_t from = report.kept - (kept->size() - 1);
    const float frameTime = 1 / rate;
    const auto secondsOf = [&](std::uint64_t frame) {
        return static_cast<double>(frame) / static_cast<double>(rate);
    };
    auto simulation = Simulation::make(groom, kept->front().pose);
    if (!simulation) return tl::unexpected(simulation.error());
    auto states = RecordedStates::make(groom);
    if (!states) return tl::unexpected(states.error());
    const auto first = stateOfFirst(*states, *kept);
    if (!first) return tl::unexpected(first.error());
    bool isGoing = simulation->setState(**first, secondsOf(from));
    HeadPose pose;
    const auto stepFrame = [&](std::uint64_t frame) -> Status {
        for (std::uint32_t step = 1; step <= pace.steps(); ++step) {
            const float time = pace.timeOf(static_cast<float>(frame), step);
            if (auto set = keyed.give(*simulation, time); !set) return set;
            HeadStep head = stepOf(motion, pose, time - pace.dt(), time);
            simulation->step(pace.dt(), head);
            pose = std::move(head.end);
        }
        return {};
    };
    for (std::size_t i = 1; i < kept->size() && isGoing; ++i) {
        if (auto stepped = stepFrame(from + i); !stepped) return tl::unexpected(stepped.error());
        if (i + 1 == kept->size()) break;
        const auto state = states->pulled(*simulation, (*kept)[i].positions_ws, frameTime);
        isGoing = state && simulation->setState(*state, secondsOf(from + i));
    }
    if (!isGoing) return fail("hair cannot continue from the frame", "expected strands as the take has them");
    const WorkWatch watch = wanted.watch.part(copied, 1);
    for (std::uint64_t frame = 1; frame <= report.simulated; ++frame) {
        if (auto stepped = stepFrame(report.kept + frame); !stepped) return tl::unexpected(stepped.error());
        if (auto added = writer->add(simulation->positions_ws(), inWorld(pose)); !added)
            return tl::unexpected(added.error());
        const auto share = static_cast<double>(frame) / static_cast<double>(report.simulated);
        if (auto status = watch.at(share); !status) return tl::unexpected(status.error());
    }
    if (auto finished = writer->finish(); !finished) return tl::unexpected(finished.error());
    return report;
}

}  // namespace

Result<std::pair<std::uint64_t, std::uint64_t>> lastRepeat(const TakeInfo& info, const Groom& groom,
                                                           std::uint64_t blend) {
    const TimeLine& line = timeLineOf(groom);
    if (loopOfNotes(info.notes))
        return fail("the take repeats already", "expected one that does not, or the first and last frame");
    if (motionOfNotes(info.notes) != kTimeLineMotion)
        return fail(fmt::format("the take is of the motion '{}'", motionOfNotes(info.notes)),
                    "expected the first and last frame of a repeat, or a take of the time line");
    if (line.framesPerSecond != info.framesPerSecond)
        return fail(fmt::format("the take has {:g} frames a second", info.framesPerSecond),
                    fmt::format("the time line has {:g}", line.framesPerSecond));
    const std::uint64_t frames = line.frameCount(), repeats = info.frames / frames;
    const std::uint64_t first = repeats > 0 ? (repeats - 1) * frames : 0;
    if (repeats < 2 || first < LoopCloser::leads(blend))
        return fail(
            fmt::format("the take has {} frames, and the time line repeats every {}", info.frames, frames),
            fmt::format("expected two repeats or more, and {} frames before the last",
                        LoopCloser::leads(blend)));
    return std::pair(first, first + frames - 1);
}

Status checkLoop(const TakeInfo& info, const LoopToMake& wanted) {
    if (wanted.last < wanted.first || wanted.last >= info.frames)
        return fail(fmt::format("frames {} to {} were requested", wanted.first, wanted.last),
                    fmt::format("the take has {} frames, counted from 0", info.frames));
    const std::uint64_t frames = wanted.last - wanted.first + 1;
    if (frames < 2 || frames < wanted.blend)
        return fail(fmt::format("a loop of {} frames with a blend of {}", frames, wanted.blend),
                    "expected at least two frames, and no longer blend");
    const std::uint64_t leads = LoopCloser::leads(wanted.blend);
    if (wanted.first < leads)
        return fail(fmt::format("frame {} has {} frames before it", wanted.first, wanted.first),
                    fmt::format("expected at least {}, which the blend leads over to: record more than one "
                                "repeat",
                                leads));
    return {};
}

Result<LoopReport> makeLoop(TakeReader& source, const Groom& groom, const LoopToMake& wanted,
                            const fs::path& to) {
    if (auto status = checkLoop(source.info(), wanted); !status) return tl::unexpected(status.error());
    const auto last = source.frame(wanted.last);
    if (!last) return tl::unexpected(last.error());
    const auto before = source.frame(wanted.first - 1);
    if (!before) return tl::unexpected(before.error());
    const double headMm = 1e3 * farthestRoot(groom, last->positions_ws, before->positions_ws);
    if (headMm > LoopSeam::kClosedMm)
        return fail(
            fmt::format("the head is {:.1f} mm elsewhere in frame {} than in frame {}", headMm, wanted.last,
                        wanted.first - 1),
            fmt::format("expected a motion that repeats every {} frames", wanted.last - wanted.first + 1));
    return orNothing(writeLoop(source, groom, wanted, to), to);
}

Result<ResumeReport> resumeTake(TakeReader& source, const Groom& groom, const HeadMotion& motion,
                                const std::string& name, const TakeToResume& wanted, const fs::path& to) {
    const std::uint64_t frames = source.info().frames;
    if (loopOfNotes(source.info().notes))
        return fail("the take repeats",
                    "expected one that starts where its motion does, as what it was made of");
    if (wanted.at >= frames)
        return fail(fmt::format("there is no frame {}", wanted.at),
                    fmt::format("the take has {} frames, counted from 0", frames));
    if (wanted.frames == 0 && wanted.at + 1 == frames)
        return fail(fmt::format("frame {} is the last one", wanted.at),
                    "expected an earlier frame, or how many frames to simulate");
    return orNothing(writeResumed(source, groom, motion, name, wanted, to), to);
}

}  // namespace hairloom
