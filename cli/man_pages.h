// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Manual pages of section 1, made from what jobs and brushes say of themselves.

#include <string>

namespace hairloom::cli {

/// Of hairloom-cli: every job with its options.
std::string commandLineManPage();
/// Of hairloom, the editor: what it opens, and its brushes.
std::string editorManPage();

}  // namespace hairloom::cli
