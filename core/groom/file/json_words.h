// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// JSON for people.

#include <nlohmann/json.hpp>
#include <string>

namespace hairloom {

/// With numbers of four digits, as a person reads them.
nlohmann::ordered_json withFewDigits(const nlohmann::ordered_json& value);

/// On one line, cut to `longest` bytes with "…" behind. Bytes that are not UTF-8 become replacement
/// characters.
std::string shortText(const nlohmann::ordered_json& value, std::size_t longest);

}  // namespace hairloom
