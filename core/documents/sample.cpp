// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/sample.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <map>
#include <sstream>

#include "core/base/file.h"
#include "core/documents/body_fit.h"
#include "core/documents/hair_import.h"
#include "core/documents/open.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/groom/file/settings_json.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kPoints = 24;
constexpr std::uint64_t kSeed = 1;

/// Lines of KEY=VALUE; # begins a comment.
Result<std::map<std::string, std::string>> readDescription(const fs::path& path) {
    const auto text = readTextFile(path);
    if (!text) return tl::unexpected(text.error());
    std::map<std::string, std::string> values;
    std::istringstream lines(*text);
    for (std::string line; std::getline(lines, line);) {
        const auto equals = line.find('=');
        if (line.empty() || line[0] == '#' || equals == std::string::npos) continue;
        values[line.substr(0, equals)] = line.substr(equals + 1);
    }
    return values;
}

template <class T>
Result<T> number(const std::map<std::string, std::string>& values, const std::string& key,
                 const fs::path& file) {
    const auto found = values.find(key);
    if (found == values.end()) return failIn(file.string(), {}, "has no " + key, "expected it with a value");
    T value{};
    const char* const end = found->second.data() + found->second.size();
    const auto [last, code] = std::from_chars(found->second.data(), end, value);
    if (code != std::errc() || last != end)
        return failIn(file.string(), {}, key + " is not a number", "expected a number");
    return value;
}

Status readStyleSettings(const fs::path& path, Groom& groom) {
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto document = parseJson(path.string(), *text);
    if (!document) return tl::unexpected(document.error());
    return applySettings(*document, path.string(), groom);
}

Result<Groom> growOnBust(const fs::path& mesh, const fs::path& description) {
    const auto values = readDescription(description);
    if (!values) return tl::unexpected(values.error());
    const auto count = number<std::size_t>(*values, "count", description);
    if (!count) return tl::unexpected(count.error());
    const auto length = number<float>(*values, "length", description);
    if (!length) return tl::unexpected(length.error());
    const auto scalp = values->find("scalp");
    if (scalp == values->end())
        return failIn(description.string(), {}, "has no scalp", "expected it with a selection, as all");

    auto scene = importSceneLoud(mesh.string(), {});
    if (!scene) return tl::unexpected(scene.error());
    const auto head = std::make_shared<const ScalpMesh>(std::move(scene->mesh));
    auto faces = selectFaces(*head, scalp->second);
    if (!faces) return tl::unexpected(faces.error());
    PlacementRequest request;
    request.count = *count;
    request.seed = kSeed;
    const auto placement = placeDarts(*head, *faces, request);
    if (!placement) return tl::unexpected(placement.error());
    auto groom = growStraight(head, std::move(*faces), placement->roots, *length, kPoints);
    if (!groom) return tl::unexpected(groom.error());
    groom->scalpExpression = scalp->second;
    groom->characterFile = mesh.string();
    groom->interpolation.seed = kSeed;
    return groom;
}

}  // namespace

fs::path findSamples(const fs::path& programFolder) {
    const auto holdsSamples = [](const fs::path& folder) {
        std::error_code ignored;
        return fs::is_directory(folder / "bust", ignored) && fs::is_directory(folder / "hairstyles", ignored);
    };
    if (const char* named = std::getenv("HAIRLOOM_SAMPLES"); named && holdsSamples(named)) return named;
    std::error_code ignored;
    fs::path folder = fs::absolute(programFolder, ignored);
    while (!folder.empty()) {
        for (const char* place : {"share/hairloom/samples", "samples"}) {
            if (holdsSamples(folder / place)) return folder / place;
        }
        if (folder == folder.root_path()) break;
        folder = folder.parent_path();
    }
    return {};
}

std::vector<std::string> sampleNames(const fs::path& samples) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(samples / "hairstyles", ignored)) {
        if (entry.path().extension() == ".conf") names.push_back(entry.path().stem().string());
    }
    std::ranges::sort(names);
    return names;
}

Result<Groom> makeSample(const fs::path& samples, const std::string& name, SampleColliders colliders) {
    const fs::path style = samples / "hairstyles" / name;
    auto groom = growOnBust(samples / "bust/bust.glb", style.string() + ".conf");
    if (!groom) return groom;
    const std::string scriptFile = style.string() + ".json";
    const auto text = readTextFile(scriptFile);
    if (!text) return tl::unexpected(text.error());
    const auto script = parseDocumentScript(scriptFile, *text);
    if (!script) return tl::unexpected(script.error());
    if (const auto outcome = runScript(*script, *groom); !outcome) return tl::unexpected(outcome.error());
    auto spheres = readSpheres((samples / "bust/spheres.json").string());
    if (!spheres) return tl::unexpected(spheres.error());
    groom->spheres = std::move(*spheres);
    if (auto status = readStyleSettings(style.string() + ".settings.json", *groom); !status) {
        return tl::unexpected(status.error());
    }
    if (colliders == SampleColliders::skin) {
        const auto actor = actorForColliders({}, *groom);
        if (!actor) return tl::unexpected(actor.error());
        auto fitted = fitBody(*groom, actor->get());
        if (!fitted) return tl::unexpected(fitted.error());
        groom->body = std::move(fitted->field);
    }
    return groom;
}

}  // namespace hairloom
