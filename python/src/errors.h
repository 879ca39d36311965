// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Errors of Hairloom as exceptions of Python: hairloom.Error with file, place, what and expected.

#include <nanobind/nanobind.h>

#include <string>

#include "core/base/result.h"

namespace hairloom::python {

namespace nb = nanobind;

/// Throws hairloom.Error. The caller holds the GIL.
[[noreturn]] void raise(const Error& error);
/// Throws hairloom.ArgumentError, which is a ValueError: "NAME FOUND; expected EXPECTED".
[[noreturn]] void raiseArgument(const std::string& name, const std::string& found,
                                const std::string& expected);
/// Throws hairloom.BusyError.
[[noreturn]] void raiseBusy(const std::string& what);

/// The value, or the exception.
template <class T>
T unwrap(Result<T> result) {
    if (!result) raise(result.error());
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace hairloom::python
