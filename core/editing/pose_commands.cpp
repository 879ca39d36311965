// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/pose_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/editing/settings_commands.h"
#include "core/groom/poses.h"
#include "core/groom/time_line.h"

namespace hairloom::editing {
namespace {

std::string shapeRecord(const std::string& name, std::span<const Vec3f> positions_ss) {
    auto numbers = nlohmann::ordered_json::array();
    for (const Vec3f& position : positions_ss) {
        for (int c = 0; c < 3; ++c) numbers.push_back(readableDecimal(position[c]));
    }
    return recordOf("put_pose", {{"name", name}, {"positions", std::move(numbers)}});
}

}  // namespace

Result<std::unique_ptr<Command>> putPose(const Model& model, const std::string& name,
                                         std::span<const Vec3f> positions_ss) {
    Groom groom = model.groom;
    if (auto put = hairloom::putPose(groom, name, positions_ss); !put) return tl::unexpected(put.error());
    return replaceGroom(model, std::move(groom), "Pose " + name, shapeRecord(name, positions_ss));
}

Result<std::unique_ptr<Command>> poseOfShape(const Model& model, const std::string& name) {
    Groom groom = model.groom;
    if (auto put = hairloom::putPose(groom, name, model.groom.positions()); !put)
        return tl::unexpected(put.error());
    return replaceGroom(model, std::move(groom), "Pose " + name, recordOf("put_pose", {{"name", name}}));
}

Result<std::unique_ptr<Command>> putPoseOf(const Model& model, const std::string& name, const Groom& other) {
    Groom groom = model.groom;
    if (auto put = hairloom::putPoseOf(groom, name, other); !put) return tl::unexpected(put.error());
    const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(name));
    std::string record = shapeRecord(name, shape);
    return replaceGroom(model, std::move(groom), "Pose " + name, std::move(record));
}

Result<std::unique_ptr<Command>> swapPose(const Model& model, const std::string& name) {
    Groom groom = model.groom;
    if (auto swapped = hairloom::swapPose(groom, name); !swapped) return tl::unexpected(swapped.error());
    return replaceGroom(model, std::move(groom), "Swap with pose " + name,
                        recordOf("swap_pose", {{"name", name}}));
}

Result<std::unique_ptr<Command>> removePose(const Model& model, const std::string& name) {
    Groom groom = model.groom;
    if (auto removed = hairloom::removePose(groom, name); !removed) return tl::unexpected(removed.error());
    return replaceGroom(model, std::move(groom), "Remove pose " + name,
                        recordOf("remove_pose", {{"name", name}}));
}

Result<std::unique_ptr<Command>> renamePose(const Model& model, const std::string& from,
                                            const std::string& to) {
    Groom groom = model.groom;
    const auto found = findPose(groom, from);
    if (!found) return fail(fmt::format("no pose is called '{}'", from), "expected the name of a pose");
    if (from == to) return nullptr;
    if (auto named = checkPoseName(to); !named) return tl::unexpected(named.error());
    if (findPose(groom, to))
        return fail(fmt::format("another pose is called '{}'", to), "expected a name that is free");
    const auto& attributes = groom.pointAttributes.all();
    if (const auto shape = attributes.find(poseAttribute(from)); shape != attributes.end()) {
        AttributeData data = shape->second;
        groom.pointAttributes.erase(poseAttribute(from));
        groom.pointAttributes.set(poseAttribute(to), std::move(data));
    }
    groom.poses[*found].name = to;
    if (groom.timeLine) {
        TimeLine line = *groom.timeLine;
        std::erase_if(line.settings,
                      [&](const SettingTrack& track) { return track.name == poseAttribute(to); });
        for (SettingTrack& track : line.settings) {
            if (track.name == poseAttribute(from)) track.name = poseAttribute(to);
        }
        if (line != *groom.timeLine) groom.timeLine = std::make_shared<const TimeLine>(std::move(line));
    }
    return replaceGroom(model, std::move(groom), "Rename pose",
                        recordOf("rename_pose", {{"name", from}, {"to", to}}));
}

namespace {

MakeCommand readPutPose(JsonReader& reader) {
    const std::string name = reader.string("name");
    if (!reader.has("positions"))
        return [name](const Document& document) { return poseOfShape(document.model(), name); };
    constexpr double kFarthest{kFarthestPosed};
    const auto numbers = reader.numbers("positions", -kFarthest, kFarthest, 3 * kMaxNumbers, "m");
    if (numbers.size() % 3 != 0)
        reader.complain("positions", fmt::format("has {} numbers", numbers.size()),
                        "expected three for each point");
    std::vector<Vec3f> positions(numbers.size() / 3);
    for (std::size_t p = 0; p < positions.size(); ++p)
        positions[p] = Vec3d(numbers[3 * p], numbers[3 * p + 1], numbers[3 * p + 2]).cast<float>();
    return [name, positions = std::move(positions)](const Document& document) {
        return putPose(document.model(), name, positions);
    };
}

MakeCommand readSwapPose(JsonReader& reader) {
    return
        [name = reader.string("name")](const Document& document) { return swapPose(document.model(), name); };
}

MakeCommand readRemovePose(JsonReader& reader) {
    return [name = reader.string("name")](const Document& document) {
        return removePose(document.model(), name);
    };
}

MakeCommand readRenamePose(JsonReader& reader) {
    const std::string from = reader.string("name"), to = reader.string("to");
    return [from, to](const Document& document) { return renamePose(document.model(), from, to); };
}

constexpr RecordedOperation kPoseCommandsRecords[] = {
    {"put_pose", readPutPose},
    {"swap_pose", readSwapPose},
    {"remove_pose", readRemovePose},
    {"rename_pose", readRenamePose},
};

}  // namespace

RecordList poseCommandsRecords() {
    return kPoseCommandsRecords;
}

}  // namespace hairloom::editing
