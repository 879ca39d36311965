// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/answer_stream.h"

#include <fmt/format.h>

#include <variant>

namespace hairloom {
namespace {

enum class Where : std::uint8_t { Unknown, Line, Byte };

}  // namespace

void writeError(AnswerWriter& writer, const Error& error) {
    const Line* const line = std::get_if<Line>(&error.place);
    const Byte* const byte = std::get_if<Byte>(&error.place);
    writer(error.file);
    writer.choice(line ? Where::Line : byte ? Where::Byte : Where::Unknown, Where::Byte);
    writer(line ? line->number : byte ? byte->offset : std::uint64_t{0});
    writer(error.problem);
    writer(error.expected);
}

Error readError(AnswerReader& reader) {
    Error error;
    Where where = Where::Unknown;
    std::uint64_t number = 0;
    reader(error.file);
    reader.choice(where, Where::Byte);
    reader(number);
    reader(error.problem);
    reader(error.expected);
    if (where == Where::Line) error.place = Line{number};
    if (where == Where::Byte) error.place = Byte{number};
    return error;
}

Error invalidAnswer(const std::string& file, std::size_t bytes) {
    return {file,
            {},
            fmt::format("the reader's answer of {} bytes is invalid", bytes),
            "the file is damaged in a way that breaks the reader"};
}

}  // namespace hairloom
