// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for runtime assets, as games open them: an input is changes of a small asset. What is not
// refused is played.

#include <cstdlib>
#include <vector>

#include "hairloom/hairloom.hpp"
#include "tests/fuzz/changed_asset.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom::game;
    hairloom::AssetBytes file = hairloom::changedAsset(data, size);
    Error error;
    Asset opened;
    Instance hair;
    if (!opened.open(file.bytes().data(), file.size, &error) || !opened.check(&error)) {
        if (error.what().empty()) std::abort();
        return 0;
    }
    const hl_asset_info info = opened.describe();
    for (std::uint32_t bone = 0; bone < info.bones; ++bone) {
        hl_bone found{};
        if (hl_asset_bone(opened.get(), bone, &found, &error) != HL_OK) std::abort();
    }
    opened.number("material.rootColour", 0);
    if (std::size_t{info.hairs} * info.points_per_hair > 100'000) return 0;
    if (!hair.make(opened, HL_HAIRS, nullptr, &error)) return error.what().empty() ? std::abort(), 0 : 0;
    std::vector<float> points;
    for (const double seconds : {0.0, 0.05, 0.4, 0.1}) hair.play(opened, Frame(), seconds, &error);
    for (std::uint32_t pose = 0; pose < info.poses; ++pose) {
        if (!hair.setPose(pose, 0.7f, &error)) std::abort();
    }
    for (int f = 0; f < 3; ++f) hair.step(Frame(), &error);
    hair.readGuides(points);
    if (info.hairs > 0) hair.readHairs(points);
    return 0;
}
