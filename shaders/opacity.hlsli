// SPDX-License-Identifier: GPL-3.0-or-later
// One whole fibre in a layer; 64 of them fill it.
#define OPACITY_UNIT (1.0 / 64.0)
