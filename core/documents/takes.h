// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The takes of a project: what its simulation played, each a file in the folder "hair.takes" beside
// "hair.hairloom".

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/groom/groom.h"
#include "core/simulation/take_file.h"

namespace hairloom {

std::filesystem::path takesFolder(const std::filesystem::path& project);

/// The file of a take, which need not exist. Errors: a name that cannot be one of a file on every system.
Result<std::filesystem::path> takePath(const std::filesystem::path& project, const std::string& name);

struct Take {
    std::string name;
    std::filesystem::path file;
    TakeInfo info;
    std::string problem;  ///< why it cannot be read; empty where it can
};

struct Takes {
    std::vector<Take> takes;             ///< in order of name
    std::vector<std::string> recovered;  ///< names of those whose writer was ended, that were found just now
};
/// What a writer that was ended has left becomes a take by the name that it was to have, or where there is
/// one already by "NAME (recovered)".
Takes findTakes(const std::filesystem::path& project);

/// Errors: no such take (naming those there are), it cannot be removed.
Status removeTake(const std::filesystem::path& project, const std::string& name);
/// Errors: as takePath(), no such take, one of the new name.
Status renameTake(const std::filesystem::path& project, const std::string& from, const std::string& to);
/// A take that is there. Errors: as takePath(), no such take.
Result<std::filesystem::path> existingTake(const std::filesystem::path& project, const std::string& name);

/// A take, read for that groom. Errors: as TakeReader::open() and use().
Result<TakeReader> openTakeFor(const std::filesystem::path& path, const Groom& groom);

/// What whoever plays a groom notes in a take: a JSON object of "motion", "engine", "pre_roll" and
/// "settings".
std::string takeNotes(const std::string& motion, const Groom& groom, const std::string& engine,
                      std::uint64_t preRoll);
/// "motion" of such notes; empty where they have none.
std::string motionOfNotes(const std::string& notes);

/// Of a take that repeats: behind its last frame comes its first.
struct LoopNotes {
    std::uint64_t first = 0;  ///< frame of the motion's own that is frame 0 here
    std::uint64_t frames = 0, blend = 0;
};
/// The notes of a take, with "loop" as well.
std::string withLoop(const std::string& notes, const LoopNotes& loop);
/// Nothing of a take that does not repeat.
std::optional<LoopNotes> loopOfNotes(const std::string& notes);

/// Seconds behind the start of the time line at a frame of a take of that, whose first frame is the one
/// behind the start, or the first of a repeat. Nothing of takes of other motions.
std::optional<float> timeLineSeconds(const TakeInfo& info, std::uint64_t frame);
/// The other way: the frame of such a take nearest to that time, at least 0; it need not have it. Of a loop
/// it has it.
std::uint64_t frameAtTimeLine(const TakeInfo& info, float seconds);

/// Distances of points of the same number in frames of the same number, millimetres.
struct TakeDifference {
    struct Frame {
        std::uint64_t number = 0;
        double rmsMm = 0, largestMm = 0;
    };
    std::vector<Frame> frames;
    double rmsMm = 0, largestMm = 0;
    std::uint64_t worstFrame = 0;  ///< where it is largest
};
/// Of frames that both have. Errors: those of reading; other frames a second; none in common. `progress` is
/// told the frames that are done.
Result<TakeDifference> compareTakes(const std::filesystem::path& a, const std::filesystem::path& b,
                                    const Groom& groom, const std::function<void(std::uint64_t)>& progress);

}  // namespace hairloom
