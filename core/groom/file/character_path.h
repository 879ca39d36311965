// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a project names the file of its head, so that it finds it again.

#include <filesystem>
#include <string>

namespace hairloom {

/// What the project at `project` keeps of a file: the way there from its own folder where the file lies in
/// this, in the folder above, or below either, so that both may move together; else the absolute path. Names
/// of files that are not there stay as they are.
std::string characterNameFor(const std::string& file, const std::filesystem::path& project);

/// The file that the project at `project` names, with its absolute path: from the project's folder, else (as
/// projects of before have it) from the current one, else of its name in the project's folder or one directly
/// in it. Where it is in none of these, the name as it stands.
std::string findCharacter(const std::string& name, const std::filesystem::path& project);

}  // namespace hairloom
