// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands as operations of a script: what is written when one is made and read when it is replayed.
// docs/formats/script.md describes them.

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/editing/command.h"
#include "core/groom/file/json_reader.h"

namespace hairloom::editing {

class Document;

using Indices = std::vector<std::uint32_t>;
using CommandResult = Result<std::unique_ptr<Command>>;

/// Of values in a record, at most.
inline constexpr std::size_t kMaxNumbers = 4'000'000;

/// Ascending numbers as first, count, first, count …
nlohmann::ordered_json runsOf(std::span<const std::uint32_t> ascending);
/// Complaints: an odd number of values, numbers that do not ascend, too many of them.
Indices readRuns(JsonReader& reader, std::string_view name);
/// Error: the last of ascending indices is not below `count`. `what` is one of them, "strand".
Status checkBelow(const Indices& indices, std::size_t count, std::string_view what);

/// {"op": op, …members}, on one line.
std::string recordOf(std::string_view op, nlohmann::ordered_json members);

/// What a recorded operation makes of a document: a command, null where it changes nothing.
using MakeCommand = std::function<CommandResult(const Document&)>;
struct RecordedOperation {
    std::string_view name;
    MakeCommand (*read)(JsonReader&);
};
/// Those of a file: who writes a record reads it, too. NAME.cpp has them as nameRecords().
using RecordList = std::span<const RecordedOperation>;
const std::vector<RecordList>& recordLists();

}  // namespace hairloom::editing
