// SPDX-License-Identifier: MIT
// One character's hair for a page: hairloom.h as functions that take and return numbers alone, since
// JavaScript fills no structs. Arrays are addresses in the module's memory.

#include <emscripten/emscripten.h>
#include <hairloom/hairloom.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace {

/// Texels in a row of the texture that positions go to.
constexpr std::size_t kRow = 1024;

hl_error error;
hl_asset asset;
hl_asset_info info;
std::vector<unsigned char> file;
void* assetBytes = nullptr;  // in it
std::vector<float> hairs, guides;
std::array<char, 128> name{};
std::vector<std::uint32_t> offsets;
hl_instance* hair = nullptr;
/// What is drawn: follow hairs, or guides where the asset has none.
struct Drawn {
    std::uint32_t hairs, points;
} drawn{};
std::array<float, 12> head{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

hl_frame frameOf(float dt, double time) {
    hl_frame frame;
    hl_frame_init(&frame);
    frame.dt = dt;
    frame.time = time;
    frame.head = head.data();
    return frame;
}

hl_out outOf(std::vector<float>& values) {
    return {values.data(), values.size() * sizeof(float), 3 * sizeof(float)};
}

}  // namespace

extern "C" {

/// Room for an asset of so many bytes.
EMSCRIPTEN_KEEPALIVE void* hairReserve(std::size_t bytes) {
    // Emscripten's allocator gives 8 bytes of alignment, whatever the type asks for.
    constexpr std::size_t kAlignment = 16;
    std::size_t room = bytes + kAlignment;
    file.resize(room);
    assetBytes = file.data();
    return std::align(kAlignment, bytes, assetBytes, room);
}

/// What went wrong in the last call that did not return 0.
EMSCRIPTEN_KEEPALIVE const char* hairWords() {
    return error.words;
}

/// Takes the asset whose bytes were put where hairReserve() said; 0 or an hl_code.
EMSCRIPTEN_KEEPALIVE int hairOpen(std::size_t bytes) {
    hl_code code = hl_asset_open(&asset, assetBytes, bytes, &error);
    if (code == HL_OK) code = hl_asset_check(&asset, &error);
    if (code == HL_OK) code = hl_asset_describe(&asset, &info, &error);
    if (code == HL_OK) code = hl_instance_make(&asset, HL_HAIRS, nullptr, &hair, &error);
    if (code != HL_OK) return code;
    guides.resize(3 * std::size_t{info.guide_points});
    offsets.resize(std::size_t{info.guides} + 1);
    code = hl_instance_offsets(hair, offsets.data(), offsets.size(), &error);
    if (code != HL_OK) return code;
    drawn = {info.hairs, info.points_per_hair};
    if (info.hairs == 0) {
        drawn.hairs = info.guides;
        for (std::size_t g = 0; g + 1 < offsets.size(); ++g)
            drawn.points = std::max(drawn.points, offsets[g + 1] - offsets[g]);
    }
    const std::size_t points = std::size_t{drawn.hairs} * drawn.points;
    hairs.resize(3 * ((points + kRow - 1) / kRow * kRow));
    return HL_OK;
}

EMSCRIPTEN_KEEPALIVE std::uint32_t hairGuideCount() {
    return info.guides;
}
EMSCRIPTEN_KEEPALIVE std::uint32_t hairGuidePoints() {
    return info.guide_points;
}
EMSCRIPTEN_KEEPALIVE std::uint32_t hairCount() {
    return drawn.hairs;
}
EMSCRIPTEN_KEEPALIVE std::uint32_t hairPointsPerHair() {
    return drawn.points;
}

/// Where the name of a setting goes, with a zero behind it: 127 bytes at most.
EMSCRIPTEN_KEEPALIVE char* hairName() {
    return name.data();
}
/// A number of the asset's setting of that name, "material.rootColour"; not a number where there is none.
EMSCRIPTEN_KEEPALIVE double hairNumber(std::size_t component) {
    std::array<double, 3> values{};
    std::size_t written = 0;
    const hl_code code =
        hl_asset_numbers(&asset, name.data(), values.data(), values.size(), &written, &error);
    return code == HL_OK && component < written && component < values.size() ? values[component]
                                                                             : __builtin_nan("");
}

/// Three rows of four, to be filled before a step: from the head at rest to the world.
EMSCRIPTEN_KEEPALIVE float* hairHeadMatrix() {
    return head.data();
}

EMSCRIPTEN_KEEPALIVE int hairReset() {
    const hl_frame frame = frameOf(1.0f / 60, 0);
    return hl_instance_reset(hair, &frame, &error);
}

/// `wind` in m/s along x, y and z. Where `authored` is not 0 the asset's own wind blows.
EMSCRIPTEN_KEEPALIVE int hairStep(float dt, double time, float windX, float windY, float windZ,
                                  int authored) {
    const std::array<float, 3> wind{windX, windY, windZ};
    hl_frame frame = frameOf(dt, time);
    if (authored == 0) frame.wind = wind.data();
    return hl_instance_step(hair, &frame, &error);
}

/// Positions of all guides, root to tip; null where something is wrong.
EMSCRIPTEN_KEEPALIVE const float* hairReadGuides() {
    return hl_instance_read_guides(hair, outOf(guides), {}, {}, &error) == HL_OK ? guides.data() : nullptr;
}
/// Positions of all hairs that are drawn, root to tip, filled up to whole rows of 1,024 points; null where
/// something is wrong. A shorter guide stays where its tip is.
EMSCRIPTEN_KEEPALIVE const float* hairReadHairs() {
    if (info.hairs > 0)
        return hl_instance_read_hairs(hair, outOf(hairs), {}, {}, &error) == HL_OK ? hairs.data() : nullptr;
    if (!hairReadGuides()) return nullptr;
    auto to = hairs.begin();
    for (std::size_t g = 0; g + 1 < offsets.size(); ++g) {
        for (std::uint32_t p = 0; p < drawn.points; ++p) {
            const std::uint32_t point = std::min(offsets[g] + p, offsets[g + 1] - 1);
            to = std::copy_n(&guides[3 * std::size_t{point}], 3, to);
        }
    }
    return hairs.data();
}
}
