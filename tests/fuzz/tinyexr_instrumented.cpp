// SPDX-License-Identifier: GPL-3.0-or-later
// The library with sanitizers in it: this one's functions go before those of the system's.

#define TINYEXR_USE_MINIZ 0
#define TINYEXR_IMPLEMENTATION
#include <zlib.h>

#include <tinyexr.h>
