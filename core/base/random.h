// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The runtime's random numbers, so that what is drawn here a game draws as well.

#include "hairloom/random.h"

namespace hairloom {

using runtime::Random;

}  // namespace hairloom
