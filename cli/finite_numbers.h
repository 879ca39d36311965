// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Options that take a number take no other: neither nan nor inf, nor one that single precision cannot hold.

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace hairloom::cli {

/// Adds the check to every option of `job` that takes numbers.
void refuseNumbersThatAreNone(CLI::App& job);

/// Throws WrongUsage where an option of the job that was parsed is empty, or a list has an empty item: CLI11
/// leaves those out.
void refuseEmptyItems(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace hairloom::cli
