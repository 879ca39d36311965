// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Errors that a user can cause or meet: what is wrong, where, and what was expected. Broken contracts between
// functions are assertions instead.

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <variant>

namespace hairloom {

/// A line of a text file, counted from 1.
struct Line {
    std::uint64_t number;
};

/// An offset into a binary file, counted from 0.
struct Byte {
    std::uint64_t offset;
};

using Place = std::variant<std::monostate, Line, Byte>;

struct Error {
    std::string file;      ///< path as the user gave it; empty when no file is concerned
    Place place;           ///< where in the file, when known
    std::string problem;   ///< what is wrong, naming what was found
    std::string expected;  ///< what would have been right; may be empty

    /// "FILE[:LINE|@BYTE]: problem; expected", leaving out what is empty.
    std::string message() const;
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

/// For `return fail(...)` in a function that returns any Result.
tl::unexpected<Error> fail(std::string problem, std::string expected = {});
tl::unexpected<Error> failIn(std::string file, Place place, std::string problem, std::string expected = {});

/// The same error, told of `file` when it names none yet.
Error inFile(Error error, const std::string& file);

/// Of words "problem; expected", as the runtime's are.
Error errorOfWords(const std::string& words);

/// The same error, with what would have been right when it names nothing yet.
Error expecting(Error error, const std::string& expected);

}  // namespace hairloom
