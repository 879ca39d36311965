// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/web_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <system_error>

#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/render/display_table.h"
#include "importers/child_process.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlayer = "player.js";
constexpr const char* kIndex = "index.html";

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
        std::uint32_t three = 0;
        for (std::size_t i = 0; i < 3; ++i)
            three = three << 8u | (i < count ? static_cast<std::uint32_t>(bytes[at + i]) : 0u);
        for (std::size_t digit = 0; digit < 4; ++digit)
            text += digit <= count ? kDigits[three >> (18 - 6 * digit) & 63u] : '=';
    }
    return text;
}

template <class T>
std::string base64Of(const std::vector<T>& values) {
    return base64(std::as_bytes(std::span(values)));
}

/// What the page draws of the head: positions as floats, normals as 16 bits, triangles as 32.
nlohmann::json headOf(const ScalpMesh& mesh) {
    std::vector<float> positions;
    std::vector<std::int16_t> normals;
    std::vector<std::uint32_t> triangles;
    for (const Vec3f& position : mesh.positions())
        positions.insert(positions.end(), {position.x(), position.y(), position.z()});
    for (const Vec3f& normal : mesh.normals()) {
        for (int axis = 0; axis < 3; ++axis)
            normals.push_back(
                static_cast<std::int16_t>(std::lround(std::clamp(normal[axis], -1.0f, 1.0f) * 32767.0f)));
    }
    for (const Triangle& triangle : mesh.triangles())
        triangles.insert(triangles.end(), triangle.begin(), triangle.end());
    return {{"positions", base64Of(positions)},
            {"normals", base64Of(normals)},
            {"triangles", base64Of(triangles)}};
}

std::array<float, 3> numbersOf(const Vec3f& value) {
    return {value.x(), value.y(), value.z()};
}

/// A view as the page has it: code values as halves, red the fastest.
struct PageView {
    nlohmann::json json;
    int worst = 0;  ///< render::DisplayTable::worst, of the halves
};

PageView viewOf(const render::ColourTransform& toDisplay) {
    render::DisplayTable table = toDisplay.displayTable();
    std::vector<std::uint16_t> halves;
    halves.reserve(3 * table.codes.size());
    for (std::array<float, 4>& code : table.codes) {
        for (std::size_t c = 0; c < 3; ++c) {
            const Eigen::half rounded(code[c]);
            code[c] = static_cast<float>(rounded);
            halves.push_back(Eigen::numext::bit_cast<std::uint16_t>(rounded));
        }
    }
    return {{{"side", table.side}, {"toe", table.toe}, {"top", table.top}, {"codes", base64Of(halves)}},
            render::displayTableError(table, toDisplay)};
}

/// The script that hands page and asset over. Heads turn about the middle of the roots; pictures show the
/// hair, and what of the head is between it.
std::string sceneScript(const Groom& groom, const std::string& title, std::span<const std::byte> asset,
                        const std::optional<PageView>& view) {
    Box3f roots, hair = groom.bounds();
    for (std::size_t s = 0; s < groom.strandCount(); ++s) roots.extend(groom.strand(s).front());
    const runtime::SimulationSettings& settings = groom.simulation;
    const runtime::Float3& wind = settings.windDirection;
    const float length = std::sqrt(wind.x * wind.x + wind.y * wind.y + wind.z * wind.z);
    const float speed = length > 0 ? settings.windSpeed / length : 0;
    nlohmann::json scene = {{"title", title},
                            {"pivot", numbersOf(roots.center())},
                            {"middle", numbersOf(hair.center())},
                            {"radius", 0.5f * hair.diagonal().norm()},
                            {"wind", {wind.x * speed, wind.y * speed, wind.z * speed}},
                            {"asset", base64(asset)}};
    if (groom.scalp) scene["head"] = headOf(*groom.scalp);
    if (view) scene["view"] = view->json;
    // The title comes from a file's name, which may be of any bytes.
    return "globalThis.hairloomScene = " +
           scene.dump(0, ' ', true, nlohmann::json::error_handler_t::replace) + ";\n";
}

struct PlayerFiles {
    std::string index, player;
};
Result<PlayerFiles> readPlayer() {
    const fs::path from = findWebPlayer(programFolder());
    if (from.empty())
        return fail("the player for browsers was not found",
                    "build it with `./dev web`, or set HAIRLOOM_WEB to its folder");
    auto index = readTextFile(from / kIndex);
    if (!index) return tl::unexpected(index.error());
    auto player = readTextFile(from / kPlayer);
    if (!player) return tl::unexpected(player.error());
    return PlayerFiles{std::move(*index), std::move(*player)};
}

}  // namespace

fs::path findWebPlayer(const fs::path& programFolder) {
    const auto holdsPlayer = [](const fs::path& folder) {
        std::error_code ignored;
        return fs::is_regular_file(folder / kIndex, ignored) &&
               fs::is_regular_file(folder / kPlayer, ignored);
    };
    if (const char* named = std::getenv("HAIRLOOM_WEB")) return holdsPlayer(named) ? named : fs::path();
    std::error_code ignored;
    for (fs::path folder = fs::absolute(programFolder, ignored); !folder.empty();
         folder = folder.parent_path()) {
        if (holdsPlayer(folder / "share/hairloom/web")) return folder / "share/hairloom/web";
        if (folder == folder.root_path()) break;
    }
    return {};
}

Result<ExportReport> exportWebPage(const Groom& groom, const HairToExport& wanted, const fs::path& folder,
                                   const render::ColourTransform* toDisplay) {
    auto player = readPlayer();
    if (!player) return tl::unexpected(player.error());
    std::error_code code;
    const bool isNew = fs::create_directories(folder, code);
    if (code) return failIn(folder.string(), {}, "cannot be created: " + code.message(), "expected a folder");
    const fs::path asset = folder / "hair.hairrt";
    auto report = exportHair(groom, wanted, strandWriter("runtime"), asset, {});
    if (!report) {
        if (isNew) fs::remove(folder, code);  // only where it is empty
        return report;
    }
    const auto bytes = readFile(asset);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto view = toDisplay != nullptr ? std::optional(viewOf(*toDisplay)) : std::nullopt;
    const std::string title = fs::absolute(folder, code).lexically_normal().filename().string();
    const std::vector<std::pair<std::string, std::string>> files{
        {kIndex, std::move(player->index)},
        {kPlayer, std::move(player->player)},
        {"hair.js", sceneScript(groom, title, *bytes, view)},
    };
    auto written = writeFiles(folder, files);
    if (!written) return tl::unexpected(written.error());
    report->format = kWebFormat;
    if (view && view->worst > 1)
        report->findings.push_back(
            {Severity::Warning,
             fmt::format("the page differs from the colour config's view by up to {} of 255", view->worst),
             "hair.js", "use a view that bends less sharply, or images of render"});
    for (const auto& [name, text] : files) report->bytes += text.size();
    return report;
}

}  // namespace hairloom
