// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a program that fails says so: a line for people, and an object for programs where they asked for one.

#include <exception>
#include <string>
#include <utility>

#include "core/base/result.h"

namespace hairloom::cli {

/// What was typed is wrong: the program ends with status 2.
class WrongUsage : public std::exception {
  public:
    explicit WrongUsage(Error error) : error_(std::move(error)) {}
    WrongUsage(std::string problem, std::string expected)
        : error_{{}, {}, std::move(problem), std::move(expected)} {}
    const Error& error() const { return error_; }
    const char* what() const noexcept override { return error_.problem.c_str(); }

  private:
    Error error_;
};

/// The value of what was typed; throws WrongUsage where there is none.
template <class T>
T orWrongUsage(Result<T> typed) {
    if (!typed) throw WrongUsage(std::move(typed.error()));
    return std::move(*typed);
}
inline void orWrongUsage(Status typed) {
    if (!typed) throw WrongUsage(std::move(typed.error()));
}

/// A line on standard error; with `json` also printErrorObject().
void printError(const Error& error, bool json);

/// {"error": {"file", "place", "what", "expected"}} on standard output, where "place" is {"line": N},
/// {"byte": N} or null, and the others are texts or null.
void printErrorObject(const Error& error);

/// Writes standard output out. Errors: it is full or closed.
Status flushOutput();

/// A standard stream that the caller closed would give its number to the next file that is opened, which then
/// got what is printed.
void keepStandardStreams();

}  // namespace hairloom::cli
