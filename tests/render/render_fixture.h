// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
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

/// An ellipsoid of the size of a head around the origin, with strands combed down from the crown.
struct TestHead {
    std::vector<Vec3f> positions;
    std::vector<std::uint32_t> indices;
    TestStrands strands;

    explicit TestHead(std::uint32_t strandCount) {
        constexpr std::uint32_t kRings = 16, kSectors = 24;
        const Vec3f axes(0.075f, 0.11f, 0.095f);
        for (std::uint32_t r = 0; r <= kRings; ++r) {
            for (std::uint32_t s = 0; s < kSectors; ++s) {
                positions.push_back(at(axes, kPi * static_cast<float>(r) / kRings,
                                       2 * kPi * static_cast<float>(s) / kSectors));
            }
        }
        for (std::uint32_t r = 0; r < kRings; ++r) {
            for (std::uint32_t s = 0; s < kSectors; ++s) {
                const std::uint32_t a = r * kSectors + s, b = r * kSectors + (s + 1) % kSectors;
                for (const std::uint32_t i : {a, b, a + kSectors, b, b + kSectors, a + kSectors})
                    indices.push_back(i);
            }
        }
        Random random(11);
        for (std::uint32_t i = 0; i < strandCount; ++i) {
            const float phi = random.uniform(0, 2 * kPi);
            const float theta = random.uniform(0.05f, 1.2f);
            const float lift = random.uniform(1.02f, 1.12f);
            for (int k = 0; k < 8; ++k) {
                const float grown = 1 + (lift - 1) * std::min(1.0f, static_cast<float>(k) / 2.0f);
                strands.positions.push_back(at(axes * grown, theta + 0.16f * static_cast<float>(k), phi));
                strands.radii.push_back(0.00015f);
            }
            strands.offsets.push_back(static_cast<std::uint32_t>(strands.positions.size()));
        }
    }
    static Vec3f at(const Vec3f& axes, float theta, float phi) {
        return {axes.x() * std::sin(theta) * std::cos(phi), axes.y() * std::cos(theta),
                axes.z() * std::sin(theta) * std::sin(phi)};
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

inline double meanLuminance(const LinearImage& image) {
    return meanColour(image).dot(Vec3d(0.2126, 0.7152, 0.0722));
}

}  // namespace hairloom::render
