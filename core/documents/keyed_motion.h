// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A motion of the head as data: a JSON file of keys (docs/formats/motion.md).

#include <memory>
#include <string>

#include "core/groom/time_line.h"
#include "core/simulation/motion.h"

namespace hairloom {

/// A time line with the keys of head and wind that the file has, and nothing else. Errors: a file that cannot
/// be read, what is no motion, keys that do not ascend, a wind above 1000 m/s.
Result<TimeLine> loadMotionKeys(const std::string& file);
/// The keys of head and wind of a time line. Errors: it has none; those of writing.
Status saveMotionKeys(const std::string& file, const TimeLine& line);

/// Moves head, roots and spheres rigidly about the head's own origin, the world's in the rest pose. Errors:
/// as loadMotionKeys().
Result<std::unique_ptr<HeadMotion>> readKeyedMotion(const std::string& file);

}  // namespace hairloom
