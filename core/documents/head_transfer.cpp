// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/head_transfer.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/documents/open.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {
namespace {

constexpr double kMaxMetresPerUnit = 1e6;

RunOperation readTransfer(JsonReader& reader) {
    const std::string path = reader.string("file");
    const auto unit = static_cast<float>(reader.number("metresPerUnit", 0, kMaxMetresPerUnit, "m"));
    return [path, unit](Groom& groom) -> Result<std::size_t> {
        const auto transfer = transferToFile(groom, path, unit);
        if (!transfer) return tl::unexpected(transfer.error());
        return groom.strandCount();
    };
}

}  // namespace

Result<Transfer> transferToFile(Groom& groom, const std::string& path, float metresPerUnit) {
    MeshImportOptions options;
    if (metresPerUnit > 0) options.metresPerUnit = metresPerUnit;
    auto scene = importSceneLoud(path, options);
    if (!scene) return tl::unexpected(scene.error());
    auto transfer = transferTo(groom, std::make_shared<const ScalpMesh>(std::move(scene->mesh)));
    if (!transfer) return transfer;
    groom.characterFile = path;
    groom.characterMetresPerUnit = metresPerUnit;
    return transfer;
}

std::string transferRecord(const std::string& path, float metresPerUnit) {
    const nlohmann::ordered_json record{{"op", "transfer"},
                                        {"file", std::filesystem::absolute(path).string()},
                                        {"metresPerUnit", readableDecimal(metresPerUnit)}};
    return record.dump();
}

ScriptExtension transferExtension() {
    return {"transfer", readTransfer};
}

}  // namespace hairloom
