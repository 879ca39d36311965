// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/src/errors.h"

#include <nanobind/stl/string.h>

#include "core/base/utf8.h"

namespace hairloom::python {
namespace {

/// Of hairloom/errors.py, so that people read and catch plain Python classes.
[[noreturn]] void raiseAs(const char* type, const Error& error) {
    nb::object place = nb::none();
    if (const auto* line = std::get_if<Line>(&error.place)) {
        nb::dict at;
        at["line"] = line->number;
        place = at;
    } else if (const auto* byte = std::get_if<Byte>(&error.place)) {
        nb::dict at;
        at["byte"] = byte->offset;
        place = at;
    }
    const auto textOrNone = [](const std::string& text) -> nb::object {
        if (text.empty()) return nb::none();
        return nb::cast(cleanUtf8(text));
    };
    const nb::object made =
        nb::module_::import_("hairloom.errors")
            .attr(type)(textOrNone(error.file), place, cleanUtf8(error.problem), textOrNone(error.expected));
    PyErr_SetObject(made.type().ptr(), made.ptr());
    throw nb::python_error();
}

}  // namespace

void raise(const Error& error) {
    raiseAs("Error", error);
}

void raiseArgument(const std::string& name, const std::string& found, const std::string& expected) {
    raiseAs("ArgumentError", {{}, {}, name + ' ' + found, "expected " + expected});
}

void raiseBusy(const std::string& what) {
    raiseAs(
        "BusyError",
        {{}, {}, what + " is in use by another thread", "expected one thread at a time, or a copy for each"});
}

}  // namespace hairloom::python
