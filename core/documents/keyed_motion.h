// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A motion of the head as data: a JSON file of keys (docs/formats/motion.md).

#include <memory>
#include <string>

#include "core/simulation/motion.h"

namespace hairloom {

/// Moves head, roots and spheres rigidly about the head's own origin, the world's in the rest pose. Keys may
/// turn and jump as they like. Errors: a file that cannot be read, what is no motion, keys that do not
/// ascend, a wind above 1000 m/s.
Result<std::unique_ptr<HeadMotion>> readKeyedMotion(const std::string& file);

}  // namespace hairloom
