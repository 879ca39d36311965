// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/sample_material.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/file.h"
#include "core/documents/open.h"
#include "core/groom/file/settings_json.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "materials";

}  // namespace

std::vector<std::string> sampleMaterials(const fs::path& samples) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(samples / kFolder, none)) {
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
    std::ranges::sort(names);
    return names;
}

Status applyMaterial(const fs::path& samples, const std::string& nameOrFile, Groom& groom) {
    const auto names = sampleMaterials(samples);
    const bool isSample = std::ranges::find(names, nameOrFile) != names.end();
    std::error_code none;
    if (!isSample && !fs::exists(nameOrFile, none)) {
        return fail(fmt::format("there is no material '{}'", nameOrFile),
                    fmt::format("expected a JSON file, or one of {}", fmt::join(names, ", ")));
    }
    const fs::path path = isSample ? samples / kFolder / (nameOrFile + ".json") : fs::path(nameOrFile);
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto document = parseJson(path.string(), *text);
    if (!document) return tl::unexpected(document.error());
    groom.material = HairMaterial();
    if (auto status = applySettings(*document, path.string(), groom); !status) return status;
    const auto material = document->find("material");
    if (material != document->end() && (material->contains("rootRadius") || material->contains("tipScale")))
        groom.pointAttributes.erase(attribute::kRadius);
    return {};
}

}  // namespace hairloom
