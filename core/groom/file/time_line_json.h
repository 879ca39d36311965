// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The time line as JSON: one form for project files, scripts and the command line (docs/formats/hairloom.md),
// and its keys of head and wind as files of motion have them (docs/formats/motion.md).

#include "core/groom/file/json_reader.h"
#include "core/groom/time_line.h"

namespace hairloom {

nlohmann::ordered_json toJson(const TimeLine& line);

/// The member "time_line". Complaints: those of problemsOf(), too.
TimeLine readTimeLine(JsonReader& reader);

/// As `timeline --json` prints it.
std::string timeLineText(const TimeLine& line);
/// Such a text; `file` is named in errors. Other members of it are ignored.
Result<TimeLine> parseTimeLine(const std::string& file, std::string_view text);

/// Keys of the head and the wind alone, as a file of motion.
std::string motionText(const TimeLine& line);
/// A time line with the keys of such a text and nothing else. Errors: what is no motion, keys that do not
/// ascend, a wind above 1000 m/s.
Result<TimeLine> parseMotion(const std::string& file, std::string_view text);

}  // namespace hairloom
