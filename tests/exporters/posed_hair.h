// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair with poses, in a runtime asset and as games play it.

#include "core/groom/poses.h"
#include "tests/exporters/asset_bytes.h"
#include "tests/exporters/levels_sample.h"

namespace hairloom::test {

/// Strands turned about their roots, and bent more towards the tip.
inline std::vector<Vec3f> turned(const Groom& groom, const Vec3f& axis, float angle) {
    std::vector<Vec3f> shape(groom.positions().begin(), groom.positions().end());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto points = groom.strand(s);
        for (std::size_t p = 1; p < points.size(); ++p) {
            const float share = static_cast<float>(p) / static_cast<float>(points.size() - 1);
            const std::size_t at = groom.offsets[s] + p;
            shape[at] =
                shape[at - 1] + Eigen::AngleAxisf(angle * (0.5f + share), axis) * (points[p] - points[p - 1]);
        }
    }
    return shape;
}

/// Hair with two poses; the second has a mask and a ramp.
inline Groom posed() {
    Groom groom = dome(6, 1, 14, 0.16f);
    groom.interpolation.followPerGuide = 5;
    groom.simulation.strandModel = runtime::StrandModel::rods;
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.09f, ""}};
    EXPECT_TRUE(putPose(groom, "Swept", turned(groom, Vec3f::UnitX(), 0.5f)));
    EXPECT_TRUE(putPose(groom, "Wet", turned(groom, Vec3f::UnitZ(), -0.8f)));
    std::vector<float> painted;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) painted.push_back(s % 3 == 0 ? 0.75f : 0.0f);
    groom.strandAttributes.set(maskAttribute(2), painted);
    groom.poses[1].mask = 2;
    groom.poses[1].ramp = runtime::Ramp::straight(1, 0.5f);
    return groom;
}

class RuntimePoses : public AssetTest {
  protected:
    void open(const Groom& groom, std::uint32_t what = HL_GUIDES, ExportReport* report = nullptr) {
        bytes_ = written(groom, report);
        game::Error error;
        ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size(), &error)) << error.what();
        ASSERT_TRUE(asset_.check(&error)) << error.what();
        ASSERT_TRUE(hair_.make(asset_, what, nullptr, &error)) << error.what();
    }
    static std::vector<Vec3f> guides(const game::Instance& hair) {
        std::vector<Vec3f> points(hair.describe().guide_points);
        const hl_out out{points.data(), points.size() * sizeof(Vec3f), sizeof(Vec3f)};
        EXPECT_EQ(hl_instance_read_guides(hair.get(), out, game::kNothing, game::kNothing, nullptr), HL_OK);
        return points;
    }
    static float farthest(std::span<const Vec3f> a, std::span<const Vec3f> b) {
        float most = 0;
        for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, (a[p] - b[p]).norm());
        return most;
    }
    static void play(game::Instance& hair, int from, int to, float still = 1) {
        for (int f = from; f < to; ++f) ASSERT_TRUE(hair.step(Walk(f, 0, still).frame));
    }
    static std::vector<std::byte> saved(const game::Instance& hair) {
        std::size_t size = 0;
        EXPECT_EQ(hl_instance_save(hair.get(), nullptr, 0, &size, nullptr), HL_OK);
        std::vector<std::byte> bytes(size);
        EXPECT_EQ(hl_instance_save(hair.get(), bytes.data(), size, &size, nullptr), HL_OK);
        return bytes;
    }
    hl_effect poseEffect(const game::Instance& hair) {
        for (std::uint32_t e = 0;; ++e) {
            hl_effect effect{};
            if (hl_instance_effect(hair.get(), e, &effect, nullptr) != HL_OK) return {};
            if (std::string_view(effect.name) == "pose") return effect;
        }
    }

    std::vector<std::byte> bytes_;
    game::Asset asset_;
    game::Instance hair_;
};

}  // namespace hairloom::test
