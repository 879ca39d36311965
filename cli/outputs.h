// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The files that a job writes, kept for it from its beginning: what must not be replaced is refused before
// anything is computed, and a second job that writes the same file is told.

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "cli/job.h"

namespace hairloom::cli {

struct Output {
    const std::string& path;     ///< no file where it is empty
    std::string_view kind = {};  ///< one of hairloom::content, where the job knows it
};

Result<Report> withOutputs(std::initializer_list<Output> outputs, const std::function<Result<Report>()>& run);

}  // namespace hairloom::cli
