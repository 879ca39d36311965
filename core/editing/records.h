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

/// Ascending numbers as first, count, first, count …
nlohmann::ordered_json runsOf(std::span<const std::uint32_t> ascending);
/// Complaints: an odd number of values, numbers that do not ascend, too many of them.
std::vector<std::uint32_t> readRuns(JsonReader& reader, std::string_view name);

/// {"op": op, …members}, on one line.
std::string recordOf(std::string_view op, nlohmann::ordered_json members);

/// What a recorded operation makes of a document: a command, null where it changes nothing.
using MakeCommand = std::function<Result<std::unique_ptr<Command>>(const Document&)>;
struct RecordedOperation {
    std::string_view name;
    MakeCommand (*read)(JsonReader&);
};
std::span<const RecordedOperation> recordedOperations();

}  // namespace hairloom::editing
