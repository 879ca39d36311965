// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The poses of a groom as JSON, without their shapes, which are point attributes.

#include <vector>

#include "core/groom/file/json_reader.h"
#include "core/groom/poses.h"

namespace hairloom {

nlohmann::ordered_json toJson(const std::vector<GroomPose>& poses);
/// The member "poses". Complaints: numbers out of range, a name that is none or is there twice, more than
/// kMaxGroomPoses.
std::vector<GroomPose> readPoses(JsonReader& reader);

}  // namespace hairloom
