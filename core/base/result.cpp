// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/result.h"

#include <fmt/format.h>

namespace hairloom {

std::string Error::message() const {
    std::string text = file;
    if (const auto* line = std::get_if<Line>(&place)) text += fmt::format(":{}", line->number);
    if (const auto* byte = std::get_if<Byte>(&place)) text += fmt::format("@{}", byte->offset);
    if (!text.empty()) text += ": ";
    text += problem;
    if (!expected.empty()) text += "; " + expected;
    return text;
}

tl::unexpected<Error> fail(std::string problem, std::string expected) {
    return tl::unexpected<Error>(Error{{}, {}, std::move(problem), std::move(expected)});
}

tl::unexpected<Error> failIn(std::string file, Place place, std::string problem, std::string expected) {
    return tl::unexpected<Error>(Error{std::move(file), place, std::move(problem), std::move(expected)});
}

Error inFile(Error error, const std::string& file) {
    if (error.file.empty()) error.file = file;
    return error;
}

Error errorOfWords(const std::string& words) {
    const auto end = words.find("; ");
    if (end == std::string::npos) return {{}, {}, words, {}};
    return {{}, {}, words.substr(0, end), words.substr(end + 2)};
}

Error expecting(Error error, const std::string& expected) {
    if (error.expected.empty()) error.expected = expected;
    return error;
}

}  // namespace hairloom
