// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/cost/head_scene.h"
#include "core/render/picture.h"
#include "tests/gpu/test_backend.h"

namespace hairloom::render {

/// A device with validation; any message of the layers fails the test.
class RenderTest : public testing::Test {
  protected:
    void SetUp() override {
        auto result = gpu::createDevice(gpu::testDevice());
        ASSERT_TRUE(result) << result.error().message();
        device = std::move(*result);
    }
    void TearDown() override {
        if (device == nullptr) return;
        for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
    }
    std::unique_ptr<gpu::Device> device;
};

/// Strands and a mesh that own their data.
struct TestStrands {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    std::vector<float> radii;

    void add(std::initializer_list<Vec3f> points, float radius) {
        positions.insert(positions.end(), points.begin(), points.end());
        radii.resize(positions.size(), radius);
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    RenderStrands view() const {
        RenderStrands strands;
        strands.offsets = offsets;
        strands.positions_ws = positions;
        strands.radii = radii;
        return strands;
    }
};

/// A head around the origin, with strands combed down from the crown.
struct TestHead {
    std::vector<Vec3f> positions;
    std::vector<std::uint32_t> indices;
    TestStrands strands;

    explicit TestHead(std::uint32_t strandCount) {
        scenes::HeadSkin skin(16, 24);
        positions = std::move(skin.points);
        indices = std::move(skin.indices);
        scenes::CombedStrands combed(strandCount);
        strands = {std::move(combed.offsets), std::move(combed.positions), std::move(combed.radii)};
    }
    RenderScene scene() const {
        RenderScene result;
        RenderMesh mesh;
        mesh.positions_ws = positions;
        mesh.indices = indices;
        result.meshes = {mesh};
        result.strands = {strands.view()};
        result.camera = frame(View::ThreeQuarter, boundsOf(result), 1);
        result.lights = studioLights(result.camera);
        return result;
    }
};

/// A square of 2 m on the ground around the origin.
struct TestPlate {
    std::vector<Vec3f> corners{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};

    RenderMesh mesh() const {
        RenderMesh result;
        result.positions_ws = corners;
        result.indices = indices;
        return result;
    }
};

/// Linear RGB.
inline Vec3d meanColour(const LinearImage& image) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        sum += Vec3f(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]).cast<double>();
    return sum / (static_cast<double>(image.rgba.size()) / 4);
}

/// Of the root mean square difference of their colours to 255, alpha left out.
inline double decibels(const Image& a, const Image& b) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const double d = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
        sum += d * d;
        ++count;
    }
    return 10 * std::log10(255 * 255 / std::max(sum / count, 1e-9));
}

inline double meanLuminance(const LinearImage& image) {
    return meanColour(image).dot(Vec3d(0.2126, 0.7152, 0.0722));
}

}  // namespace hairloom::render
