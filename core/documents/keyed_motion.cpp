// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/keyed_motion.h"

#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/groom/file/time_line_json.h"
#include "core/simulation/time_line_motion.h"

namespace hairloom {

Result<TimeLine> loadMotionKeys(const std::string& file) {
    const auto text = readTextFile(file, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    return parseMotion(file, *text);
}

Status saveMotionKeys(const std::string& file, const TimeLine& line) {
    if (line.head.empty() && line.wind.empty())
        return failIn(file, {}, "the time line has no keys of head or wind to save", "key one of them first");
    return writeFileAtomically(file, motionText(line));
}

Result<std::unique_ptr<HeadMotion>> readKeyedMotion(const std::string& file) {
    auto line = loadMotionKeys(file);
    if (!line) return tl::unexpected(line.error());
    line->loop = false;
    return makeTimeLineMotion(std::move(*line), nullptr, {});
}

}  // namespace hairloom
