// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs a program that may crash, hang or eat memory, and hands back what it wrote.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

struct ChildLimits {
    std::chrono::milliseconds time{8'000};                  ///< then the child is killed
    std::uint64_t residentBytes = std::uint64_t{3} << 29u;  ///< 1.5 GiB; then the child is killed
    std::uint64_t outputBytes = std::uint64_t{1} << 29u;    ///< 512 MiB; then the child is killed
    /// The first eight bytes say how many follow: room is made for them at once, up to the limit.
    bool startsWithLength = false;
    bool startsPrograms = false;  ///< it may start others: Windows denies that to a child without it
};

/// Standard output of `program` run with `arguments`, with `input` on its standard input and its standard
/// error discarded. Errors: cannot be started, ended by a signal or a status other than 0, over a limit,
/// checkStop(). The error's text starts with `name` ("the mesh reader"). No process is left behind.
Result<std::vector<std::byte>> runChild(const std::string& name, const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments, const ChildLimits& limits,
                                        std::span<const std::byte> input = {});

/// The folder of the running program; empty where the system does not tell.
std::filesystem::path programFolder();

}  // namespace hairloom
