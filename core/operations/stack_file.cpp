// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/stack_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/groom/file/operators_json.h"

namespace hairloom {
namespace {

constexpr std::string_view kSuffix = ".stack.json";

}  // namespace

std::string operatorsText(std::span<const Operator> operators) {
    return nlohmann::ordered_json{{"operators", toJson(operators)}}.dump(2) + "\n";
}

Result<std::vector<Operator>> parseOperators(const std::string& file, std::string_view text) {
    const auto json = parseJson(file, text);
    if (!json) return tl::unexpected(json.error());
    JsonReader reader(*json, file);
    auto operators = readOperators(reader);
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return operators;
}

Result<std::vector<Operator>> loadOperators(const std::filesystem::path& path) {
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    return parseOperators(path.string(), *text);
}

Status saveOperators(const std::filesystem::path& path, std::span<const Operator> operators) {
    std::vector<Operator> kept;
    std::ranges::copy_if(operators, std::back_inserter(kept),
                         [](const Operator& one) { return one.op != kSculpt; });
    if (kept.empty())
        return failIn(path.string(), {}, "there is no operator to save",
                      "expected at least one that is not a sculpt, because a sculpt only fits its own hair");
    return writeFileAtomically(path, operatorsText(kept));
}

std::vector<std::string> stackPresets(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
        const std::string file = entry.path().filename().string();
        if (file.size() > kSuffix.size() && file.ends_with(kSuffix))
            names.push_back(file.substr(0, file.size() - kSuffix.size()));
    }
    std::ranges::sort(names);
    return names;
}

Result<std::filesystem::path> stackPresetFile(const std::filesystem::path& folder, const std::string& name) {
    if (name.empty() || name.find_first_of("/\\:*?\"<>|") != std::string::npos || name.front() == '.')
        return fail("'" + name + "' is not a valid name for a preset",
                    "expected a name without / \\ : * ? \" < > |");
    return folder / (name + std::string(kSuffix));
}

}  // namespace hairloom
