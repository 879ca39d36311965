// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recorded operations, as `hairloom-cli groom --script` replays them. docs/formats/script.md lists the
// operations.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/operations/operation.h"

namespace hairloom {

inline constexpr std::uint32_t kScriptVersion = 1;

struct ScriptStep {
    std::string operation;
    RunOperation run;
};

struct Script {
    std::vector<ScriptStep> steps;
};

/// An operation of another room: reads its members (complaints are the reader's) and gives what runs it.
struct ScriptExtension {
    std::string_view name;
    std::function<RunOperation(JsonReader&)> read;
};

/// `text` is the JSON; `file` is named in errors. Errors name the JSON path, what stands there and what is
/// allowed: syntax, a newer version, an unknown operation or member, a value out of range.
Result<Script> parseScript(const std::string& file, std::string_view text,
                           std::span<const ScriptExtension> extensions = {});

struct ScriptReport {
    std::size_t strokes = 0;  ///< operations run
    /// Strands whose points differ from before the first operation, and those that came or went; by id.
    std::size_t touchedStrands = 0;
    std::vector<std::size_t> touchedByStep;
};

/// Runs all operations, in order. On error the groom is as it was.
Result<ScriptReport> runScript(const Script& script, Groom& groom);

/// The fields of the "region" that every operation takes.
const std::vector<FieldRow>& scriptRegionFields();

}  // namespace hairloom
