// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards shaped by hand as JSON: one form for project files and scripts (docs/formats/script.md).

#include "core/groom/file/json_reader.h"
#include "core/groom/groom.h"

namespace hairloom {

nlohmann::ordered_json toJson(const CardEdit& edit);
nlohmann::ordered_json toJson(const std::vector<CardEdit>& edits);

/// The member "card_edits". Complaints: numbers out of range, a strip of other than kCardStations, more than
/// kMaxCardEdits or kMaxCardRoots.
std::vector<CardEdit> readCardEdits(JsonReader& reader);

}  // namespace hairloom
