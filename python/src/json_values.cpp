// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/src/json_values.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <filesystem>
#include <system_error>

#include "python/src/errors.h"

namespace hairloom::python {
namespace {

nb::module_ values() {
    return nb::module_::import_("hairloom._values");
}

}  // namespace

std::string jsonOf(nb::handle value) {
    return nb::cast<std::string>(values().attr("to_json")(value));
}

nb::object valueOfJson(const std::string& text) {
    return values().attr("from_json")(text);
}

MotionFile::MotionFile(nb::handle motion) {
    if (nb::try_cast(motion, name_)) return;
    if (std::filesystem::path path; nb::try_cast(motion, path)) {
        name_ = path.string();
        return;
    }
    name_ = nb::cast<std::string>(values().attr("motion_file")(motion));
    made_ = true;
}

MotionFile::~MotionFile() {
    std::error_code ignored;
    if (made_) std::filesystem::remove(name_, ignored);
}

}  // namespace hairloom::python
