// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/sphere_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace hairloom {
namespace {

std::vector<runtime::Sphere> scattered(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> any(-1.0f, 1.0f), size(0.001f, 0.2f);
    std::vector<runtime::Sphere> spheres;
    for (std::size_t i = 0; i < count; ++i)
        spheres.push_back({{any(random), any(random), any(random)}, size(random)});
    return spheres;
}

TEST(SphereTree, FindsWhatATestOfEverySphereFinds) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1.2f, 1.2f);
    std::size_t touches = 0;
    for (const std::size_t count : {1u, 2u, 3u, 17u, 300u}) {
        const std::vector<runtime::Sphere> spheres = scattered(count, static_cast<unsigned>(count));
        const SphereTree tree(spheres);
        EXPECT_EQ(tree.nodeCount(), 2 * count - 1);
        for (int n = 0; n < 5000; ++n) {
            const runtime::Float3 point{any(random), any(random), any(random)};
            const float margin = n % 2 == 0 ? 0.0f : 0.05f;
            std::vector<std::uint32_t> found, wanted;
            tree.find(point, margin, found);
            std::ranges::sort(found);
            for (std::uint32_t i = 0; i < count; ++i) {
                const runtime::Float3 d = point - spheres[i].center_ws;
                const float reach = spheres[i].radius + margin;
                if (dot(d, d) < reach * reach) wanted.push_back(i);
            }
            EXPECT_EQ(found, wanted) << count << ' ' << n;
            touches += wanted.size();
        }
    }
    EXPECT_GT(touches, 1000u);
}

TEST(SphereTree, OfNoSpheresAndOfEqualOnesIsSound) {
    std::vector<std::uint32_t> found;
    SphereTree({}).find({}, 1.0f, found);
    EXPECT_TRUE(found.empty());
    const std::vector<runtime::Sphere> equal(40, runtime::Sphere{{1.0f, 0.0f, 0.0f}, 0.1f});
    SphereTree(equal).find({1.05f, 0.0f, 0.0f}, 0.0f, found);
    EXPECT_EQ(found.size(), 40u);
    const std::vector<runtime::Sphere> none(3, runtime::Sphere{{}, 0.0f});
    EXPECT_EQ(SphereTree(none).nodeCount(), 0u);
}

}  // namespace
}  // namespace hairloom
