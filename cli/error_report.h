// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a program that fails says so: a line for people, and an object for programs where they asked for one.

#include <string>

#include "core/base/result.h"

namespace hairloom::cli {

/// A line on standard error; with `json` also printErrorObject().
void printError(const Error& error, bool json);

/// {"error": {"file", "place", "what", "expected"}} on standard output, where "place" is {"line": N},
/// {"byte": N} or null, and the others are texts or null.
void printErrorObject(const Error& error);

/// Writes standard output out. Errors: it is full or closed.
Status flushOutput();

/// A standard stream that the caller closed would give its number to the next file that is opened, which then
/// got what is printed.
void keepStandardStreams();

}  // namespace hairloom::cli
