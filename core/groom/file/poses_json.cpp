// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/poses_json.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {

nlohmann::ordered_json toJson(const std::vector<GroomPose>& poses) {
    auto list = nlohmann::ordered_json::array();
    for (const GroomPose& pose : poses) {
        nlohmann::ordered_json entry{{"name", pose.name}};
        entry.update(fieldsToJson(pose));
        list.push_back(std::move(entry));
    }
    return list;
}

std::vector<GroomPose> readPoses(JsonReader& reader) {
    std::vector<GroomPose> poses;
    for (JsonReader& entry : reader.objects("poses")) {
        GroomPose pose;
        pose.name = entry.string("name");
        if (const auto named = checkPoseName(pose.name); !named)
            entry.complain("name", named.error().problem, named.error().expected);
        else if (std::ranges::count(poses, pose.name, &GroomPose::name) > 0)
            entry.complain("name", fmt::format("is \"{}\" again", pose.name), "expected each name once");
        entry.fields(pose);
        entry.finish();
        poses.push_back(std::move(pose));
    }
    if (poses.size() > kMaxGroomPoses)
        reader.complain("poses", fmt::format("has {} entries", poses.size()),
                        fmt::format("expected at most {}", kMaxGroomPoses));
    return poses;
}

}  // namespace hairloom
