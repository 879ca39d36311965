// SPDX-License-Identifier: GPL-3.0-or-later
// The loader is opened at run time; the program starts without one and says what is missing.
#include <volk.c>
