// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair with levels of detail on a character that walks, and a crowd of it.

#include <array>
#include <cmath>
#include <vector>

#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_samples.h"

namespace hairloom::test {

/// A character that nods about its neck and walks to and fro.
struct Walk {
    std::array<float, 12> head{};
    std::array<float, 3> wind{};
    game::Frame frame;

    explicit Walk(int f, double late = 0, float still = 1) {
        const double t = f / 60.0 + late;
        const auto angle = still * static_cast<float>(0.3 * std::sin(6 * t));
        const float c = std::cos(angle), s = std::sin(angle);
        head = {c, 0, s, still * static_cast<float>(0.2 * std::sin(3 * t)), 0, 1, 0, 0, -s, 0, c, 0};
        wind = {still * static_cast<float>(1.5 + std::sin(2 * t)), 0, still * 0.5f};
        frame.time = t;
        frame.head = head.data();
        frame.wind = wind.data();
    }
};

class RuntimeLevels : public AssetTest {
  protected:
    void SetUp() override {
        AssetTest::SetUp();
        bytes_ = written(hair());
        ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size()));
        ASSERT_TRUE(first_.make(asset_, HL_GUIDES | HL_LEVELS));
    }
    static Groom hair() {
        Groom groom = dome(10, 1, 16, 0.18f);
        groom.interpolation.followPerGuide = 20;
        groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}};
        return groom;
    }
    game::Instance another() const {
        game::Instance copy;
        EXPECT_TRUE(copy.copy(first_));
        return copy;
    }
    static std::vector<Vec3f> guides(const game::Instance& hair) {
        std::vector<Vec3f> points(hair.describe().guide_points);
        const hl_out out{points.data(), points.size() * sizeof(Vec3f), sizeof(Vec3f)};
        EXPECT_EQ(hl_instance_read_guides(hair.get(), out, game::kNothing, game::kNothing, nullptr), HL_OK);
        return points;
    }
    static float rootMeanSquare(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
        double sum = 0;
        for (std::size_t p = 0; p < a.size(); ++p) sum += static_cast<double>((a[p] - b[p]).squaredNorm());
        return static_cast<float>(std::sqrt(sum / static_cast<double>(a.size())));
    }
    static hl_level level(const game::Instance& hair, std::uint32_t number) {
        hl_level level{};
        EXPECT_EQ(hl_instance_level(hair.get(), number, &level, nullptr), HL_OK);
        return level;
    }

    std::vector<std::byte> bytes_;
    game::Asset asset_;
    game::Instance first_;
};

/// Characters side by side, each farther off than the one before, and planned each frame.
struct Crowd {
    std::vector<game::Instance> hair;
    std::vector<hl_viewed> viewed;
    hl_crowd_limits limits{};
    hl_crowd_report report{};

    Crowd(const game::Instance& first, std::size_t count) : hair(count), viewed(count) {
        hl_crowd_limits_init(&limits);
        for (std::size_t c = 0; c < count; ++c) {
            EXPECT_TRUE(hair[c].copy(first));
            viewed[c].hair = hair[c].get();
        }
    }
    void step(int f) {
        for (std::size_t c = 0; f == 1 && c < hair.size(); ++c)
            ASSERT_TRUE(hair[c].reset(Walk(0, 0.3 * static_cast<double>(c)).frame));
        for (std::size_t c = 0; c < hair.size(); ++c)
            viewed[c].pixels_per_metre =
                2000 / (1 + static_cast<float>(c) + 0.5f * std::sin(0.05f * static_cast<float>(f)));
        hl_error error{};
        ASSERT_EQ(hl_crowd_plan(&limits, viewed.data(), viewed.size(), &report, &error), HL_OK)
            << error.words;
        for (std::size_t c = 0; c < hair.size(); ++c)
            ASSERT_TRUE(hair[c].step(Walk(f, 0.3 * static_cast<double>(c)).frame));
    }
};

}  // namespace hairloom::test
