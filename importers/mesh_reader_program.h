// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where the program is that reads STL, FBX and glTF.

#include <filesystem>

namespace hairloom {

/// Beside the running program, or what the environment variable HAIRLOOM_MESH_READER names.
std::filesystem::path meshReaderProgram();

}  // namespace hairloom
