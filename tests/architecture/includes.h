// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The #include lines of every source file of the repository, C++ and HLSL, and the files they name.

#include <string>
#include <vector>

namespace hairloom {

struct Include {
    std::string file;     ///< from the top of the repository
    std::string written;  ///< between the quotes or brackets
    std::string target;   ///< from the top of the repository; empty for a file that is none of ours
};

/// Every source file, from the top of the repository; ascending.
const std::vector<std::string>& sourceFiles();
const std::vector<Include>& allIncludes();
/// "a.cpp includes b.h"
std::string describe(const Include& include);
/// The licence that the file's first line names, "MIT"; empty where it names none.
std::string licenceOf(const std::string& file);

}  // namespace hairloom
