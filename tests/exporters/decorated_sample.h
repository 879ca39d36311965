// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair with attributes, and an instance of it, for tests of what engines ask hairloom.h for.

#include <array>
#include <cmath>

#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_samples.h"

namespace hairloom::test {

/// A dome with UVs, colours, an attribute of an artist's, two layers; hair in wind.
inline Groom decorated() {
    Groom groom = dome(5, 2, 12, 0.15f);
    groom.interpolation.followPerGuide = 6;
    groom.simulation.windSpeed = 3;
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}};
    const std::size_t strands = groom.strandCount();
    std::vector<Vec2f> uvs;
    std::vector<Vec3f> colours;
    std::vector<std::int32_t> ages;
    std::vector<std::uint32_t> layers;
    for (std::size_t s = 0; s < strands; ++s) {
        const float share = static_cast<float>(s) / static_cast<float>(strands);
        uvs.emplace_back(share, 0.5f);
        colours.emplace_back(share, 0.25f, 0);
        ages.push_back(static_cast<std::int32_t>(s) - 3);
        layers.push_back(s % 2);
    }
    groom.strandAttributes.set(attribute::kRootUv, uvs);
    groom.strandAttributes.set(attribute::kStrandColour, colours);
    groom.strandAttributes.set("age", ages);
    groom.layers = {{"Base", true, false, 1, {}}, {"Brows", true, false, 0.5f, {}}};
    groom.strandAttributes.set(attribute::kLayer, layers);
    return groom;
}

class RuntimeReads : public AssetTest {
  protected:
    void open(const Groom& groom) {
        bytes_ = written(groom);
        ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size(), &error_)) << error_.what();
        info_ = asset_.describe();
    }
    void make(std::uint32_t what) {
        ASSERT_TRUE(hair_.make(asset_, what, nullptr, &error_)) << error_.what();
    }
    void step(game::Instance& hair, int frame) {
        std::array<float, 12> head{1, 0, 0, 0.01f * static_cast<float>(frame), 0, 1, 0, 0, 0, 0, 1, 0};
        game::Frame given;
        given.time = frame / 60.0;
        given.head = head.data();
        ASSERT_TRUE(hair.step(given, &error_)) << error_.what();
    }
    std::size_t points(bool hairs = true) {
        const hl_instance_info info = hair_.describe();
        return hairs ? std::size_t{info.hairs} * info.points_per_hair : info.guide_points;
    }

    std::vector<std::byte> bytes_;
    game::Asset asset_;
    hl_asset_info info_{};
    game::Instance hair_;
    game::Error error_;
};

}  // namespace hairloom::test
