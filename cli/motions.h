// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "core/simulation/motion.h"

namespace hairloom::cli {

/// The motion that --motion names: none, spin, nod or clip:NAME. Clips come from `character`, or where that
/// is empty from the file that the groom's scalp came from.
Result<std::unique_ptr<HeadMotion>> makeMotion(const std::string& name, const std::string& character,
                                               const Groom& groom);

}  // namespace hairloom::cli
