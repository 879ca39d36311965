// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Options that take a number take no other: neither nan nor inf, nor one that single precision cannot hold.

#include <CLI/App.hpp>

namespace hairloom::cli {

/// Adds the check to every option of `job` that takes numbers.
void refuseNumbersThatAreNone(CLI::App& job);

}  // namespace hairloom::cli
