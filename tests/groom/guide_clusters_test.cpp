// SPDX-License-Identifier: GPL-3.0-or-later
// Guides by clustering.
#include "core/operations/guide_clusters.h"

#include <gmock/gmock.h>

#include <set>

#include "core/base/parallel.h"
#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

/// Ten bundles of strands that lean each its way, a little apart.
Groom bundles() {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> points;
    Random random(5, 0);
    for (int s = 0; s < 400; ++s) {
        const float bundle = static_cast<float>(s % 10);
        const Vec3f root(0.05f * bundle + 0.002f * random.uniform(), 0, 0.002f * random.uniform());
        const Vec3f lean(std::sin(2 * bundle), 1, std::cos(2 * bundle));
        for (int i = 0; i < 12; ++i)
            points.push_back(root + 0.01f * static_cast<float>(i) * lean +
                             0.0005f * random.uniform() * Vec3f::UnitX());
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    return makeGroom(std::move(offsets), std::move(points));
}

std::vector<std::uint32_t> all(const Groom& groom) {
    return strandsToEdit(groom, {});
}

TEST(GuideClusters, OneGuideForEachBundle) {
    const Groom groom = bundles();
    GuidesSettings settings;
    settings.count = 10;
    const GuideClusters clusters = clusterGuides(groom, all(groom), settings);
    ASSERT_EQ(clusters.guides.size(), 10u);
    std::set<std::uint32_t> found;
    for (const std::uint32_t guide : clusters.guides) found.insert(guide % 10);
    EXPECT_EQ(found.size(), 10u);
    for (std::uint32_t s = 0; s < 400; ++s) EXPECT_EQ(clusters.guideOf[s] % 10, s % 10);
    EXPECT_LT(clusters.maxMm, 1);
    EXPECT_GT(clusters.meanMm, 0.05);
}

TEST(GuideClusters, MoreGuidesAreNearerAndAllAreExact) {
    const Groom groom = bundles();
    double last = 1e9;
    for (const std::uint32_t count : {2u, 5u, 10u, 400u}) {
        GuidesSettings settings;
        settings.count = count;
        const GuideClusters clusters = clusterGuides(groom, all(groom), settings);
        EXPECT_LT(clusters.meanMm, last) << count;
        last = clusters.meanMm;
    }
    EXPECT_EQ(last, 0) << "each its own guide";
    EXPECT_TRUE(clusterGuides(groom, {}, {}).guides.empty());
}

TEST(GuideClusters, TheSameForAnyNumberOfThreads) {
    const Groom groom = bundles();
    GuidesSettings settings;
    settings.count = 37;
    setThreadCount(1);
    const GuideClusters one = clusterGuides(groom, all(groom), settings);
    setThreadCount(5);
    const GuideClusters five = clusterGuides(groom, all(groom), settings);
    setThreadCount(0);
    EXPECT_EQ(one.guides, five.guides);
    EXPECT_EQ(one.guideOf, five.guideOf);
    EXPECT_EQ(one.meanMm, five.meanMm);
}

TEST(GuideClusters, GuidesStayAloneOrAreMarked) {
    const Groom before = straightHair(sphereScalp(), 300, 8, 0.1f);
    GuidesSettings settings;
    settings.count = 30;
    Groom alone = before;
    EXPECT_EQ(chooseGuides(alone, settings).value(), 30u);
    EXPECT_EQ(alone.strandCount(), 30u);
    EXPECT_EQ(alone.guideCount(), 30u);
    EXPECT_EQ(alone.interpolation.followPerGuide, 10u);
    EXPECT_FALSE(hasErrors(validate(alone)));
    settings.alone = false;
    Groom marked = before;
    EXPECT_EQ(chooseGuides(marked, settings).value(), 30u);
    EXPECT_EQ(marked.strandCount(), 300u);
    EXPECT_EQ(marked.guideCount(), 30u);
    settings.count = 0;
    EXPECT_FALSE(chooseGuides(marked, settings));
}

}  // namespace
}  // namespace hairloom
