// SPDX-License-Identifier: GPL-3.0-or-later
// What the stages of a device do for tessellated ribbons, by its own counters, against the thesis' count of
// vertices (Rünz 2012, Section 6.2).
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// Straight hairs side by side, each seen whole: their patches are cut once a segment.
RenderScene straightHairs(TestStrands& strands, std::initializer_list<int> segments) {
    for (const int count : segments) {
        const float y = 0.02f * static_cast<float>(strands.offsets.size());
        for (int k = 0; k <= count; ++k) {
            strands.positions.emplace_back(0.3f * static_cast<float>(k) / static_cast<float>(count) - 0.15f,
                                           y, 0.0f);
            strands.radii.push_back(0.002f);
        }
        strands.offsets.push_back(static_cast<std::uint32_t>(strands.positions.size()));
    }
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.camera.eye_ws = {0, 0.1f, 0.8f};
    scene.camera.target_ws = {0, 0.1f, 0};
    return scene;
}

class StatisticsTest : public testing::Test {
  protected:
    void SetUp() override {
        gpu::DeviceOptions options = gpu::testDevice();
        options.statistics = true;
        auto made = gpu::createDevice(options);
        ASSERT_TRUE(made) << made.error().message();
        device = std::move(*made);
        if (!device->info().statistics) GTEST_SKIP() << "no pipeline statistics on this device";
    }
    void TearDown() override {
        if (device == nullptr) return;
        for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
    }
    gpu::PassCounts drawn(const RenderScene& scene, Ribbons ribbons) {
        RenderOptions options;
        options.width = options.height = 96;
        options.frames = 1;
        options.samples = 1;
        options.shadows = Shadows::none;
        options.ribbons = ribbons;
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        if (!picture) return {};
        for (const gpu::PassTime& pass : picture->passes) {
            if (pass.name == passName(Pass::curves)) {
                EXPECT_FALSE(pass.counts) << "kernels have no stages";
            }
            if (pass.name == passName(Pass::draw)) return pass.counts.value_or(gpu::PassCounts{});
        }
        ADD_FAILURE() << "nothing was drawn";
        return {};
    }
    std::unique_ptr<gpu::Device> device;
};

// The perimeter of a domain that is cut f times along and once across has 2 (f + 1) vertices. Devices cut its
// inside twice across, which adds f − 1 along the middle: 3f + 1 in all, as printed.
TEST_F(StatisticsTest, PatchesThatAreCutFTimesHave3FPlus1Vertices) {
    if (!device->info().tessellation) GTEST_SKIP() << "no tessellation on this device";
    for (const int segments : {1, 2, 5, 21}) {
        TestStrands strands;
        const gpu::PassCounts counts =
            drawn(straightHairs(strands, {segments, segments, segments}), Ribbons::tessellated);
        const auto f = static_cast<std::uint64_t>(segments);
        EXPECT_EQ(counts.patches, 3u);
        // Some GPUs evaluate a vertex again for another of its triangles.
        EXPECT_GE(counts.evaluations, 3 * (3 * f + 1)) << segments;
        EXPECT_EQ(counts.primitives, 3 * (4 * f - 2)) << segments;
        if (device->info().type == gpu::DeviceType::Cpu) {
            EXPECT_EQ(counts.evaluations, 3 * (3 * f + 1)) << segments;
        }
        EXPECT_GT(counts.fragments, 0u);
    }
    // 70 segments are patches of 21, 21, 21 and 7.
    TestStrands strands;
    const gpu::PassCounts counts = drawn(straightHairs(strands, {70}), Ribbons::tessellated);
    EXPECT_EQ(counts.patches, 4u);
    EXPECT_GE(counts.evaluations, 3u * 70u + 4u);
}

TEST_F(StatisticsTest, StripsHaveTwoVerticesAPointOfTheCurve) {
    TestStrands strands;
    const gpu::PassCounts counts = drawn(straightHairs(strands, {5, 5}), Ribbons::strip);
    EXPECT_EQ(counts.patches, 0u);
    EXPECT_EQ(counts.evaluations, 0u);
    // Two curve segments a segment: 11 points. Restarts of a strip may count as vertices.
    EXPECT_GE(counts.vertices, 2u * 2u * 11u);
    EXPECT_LE(counts.vertices, 2u * (2u * 11u + 1u));
    EXPECT_EQ(counts.primitives, 2u * 20u);
    EXPECT_GT(counts.fragments, 0u);
}

TEST(Statistics, AreThereOnlyWhereTheyWereAskedFor) {
    auto device = gpu::createDevice(gpu::testDevice());
    ASSERT_TRUE(device) << device.error().message();
    TestStrands strands;
    RenderOptions options;
    options.width = options.height = 16;
    options.frames = 1;
    options.ribbons = Ribbons::strip;
    const auto picture = renderPicture(**device, straightHairs(strands, {5}), options);
    ASSERT_TRUE(picture) << picture.error().message();
    for (const gpu::PassTime& pass : picture->passes) EXPECT_FALSE(pass.counts) << pass.name;
}

}  // namespace
}  // namespace hairloom::render
