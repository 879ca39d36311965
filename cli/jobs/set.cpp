// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "core/base/file.h"
#include "core/groom/fields.h"
#include "core/groom/project_file.h"

namespace hairloom::cli {
namespace {

struct SetOptions {
    std::string input;
    std::vector<std::string> assignments;
    std::string from;
    bool list = false;
    std::string output;
};

}  // namespace
}  // namespace hairloom::cli
