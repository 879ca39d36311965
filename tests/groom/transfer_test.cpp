// SPDX-License-Identifier: GPL-3.0-or-later
// Hair on another head: spheres of which the right outcome is known.
#include "core/operations/transfer.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "core/operations/flow.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

const Vec3f kCentre(0, 1.6f, 0);

Groom combedHair() {
    Groom groom = straightHair(sphereScalp(0.09f, 4, kCentre), 200, 12, 0.1f);
    FlowSettings laid;
    laid.crown = Vec3f(0, 1.69f, 0);
    EXPECT_TRUE(flow(groom, laid));
    groom.spheres.push_back({"head", kCentre, 0.085f, {}});
    return groom;
}

void expectSound(const Groom& groom) {
    for (const Finding& finding : validate(groom))
        EXPECT_NE(finding.severity, Severity::Error) << finding.what;
}

TEST(Transfer, ToALargerHeadElsewhereIsTheSameHairLarger) {
    const Groom before = combedHair();
    Groom after = before;
    const Vec3f there(0.3f, 1.1f, -0.2f);
    // Fewer triangles than the old head, so that no root has its triangle there.
    const auto transfer = transferTo(after, sphereScalp(0.135f, 3, there));
    ASSERT_TRUE(transfer) << transfer.error().message();
    EXPECT_FALSE(transfer->sameMesh);
    EXPECT_NEAR(transfer->fit.scale, 1.5f, 0.02f);
    EXPECT_LT(*std::ranges::max_element(transfer->distances), 0.003f);
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        EXPECT_NEAR(polylineLength(after.strand(s)), 1.5f * polylineLength(before.strand(s)), 0.004f);
        const Vec3f expected = there + 1.5f * (before.strand(s).back() - kCentre);
        EXPECT_LT((after.strand(s).back() - expected).norm(), 0.02f) << s;
    }
    EXPECT_LT((after.spheres[0].centre - there).norm(), 0.004f);
    EXPECT_NEAR(after.spheres[0].radius, 0.1275f, 0.003f);
    const auto share = [](const Groom& groom) {
        return static_cast<double>(groom.scalpSelection.size()) /
               static_cast<double>(groom.scalp->triangleCount());
    };
    EXPECT_NEAR(share(after), share(before), 0.1);
    expectSound(after);
}

TEST(Transfer, TellsItsShareAndStopsWhereverItIs) {
    const Groom before = combedHair();
    const auto head = sphereScalp(0.135f, 3, kCentre);
    std::vector<double> shares;
    Groom whole = before;
    ASSERT_TRUE(transferTo(whole, head, {[&](double share) { shares.push_back(share); }}));
    ASSERT_GE(shares.size(), 4u);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_EQ(shares.front(), 0);
    EXPECT_EQ(shares.back(), 1);
    // At each of them somebody may stop it.
    for (const double at : shares) {
        std::atomic<bool> stop = false;
        Groom groom = before;
        const auto stopped = transferTo(groom, head, {[&](double share) { stop = share >= at; }, &stop});
        if (at == 1) {
            EXPECT_TRUE(stopped) << "it is done";
            continue;
        }
        ASSERT_FALSE(stopped) << at;
        EXPECT_THAT(stopped.error().message(), HasSubstr("stopped"));
        EXPECT_EQ(contentHash(groom), contentHash(before));
        EXPECT_EQ(groom.scalp, before.scalp);
    }
}

TEST(Transfer, OnTheSameMeshRootsKeepTheirTriangles) {
    const Groom before = combedHair();
    std::vector<Vec3f> taller(before.scalp->positions().begin(), before.scalp->positions().end());
    for (Vec3f& vertex : taller) vertex.y() = 1.6f + 1.3f * (vertex.y() - 1.6f);
    Groom after = before;
    const auto transfer =
        transferTo(after, std::make_shared<const ScalpMesh>(before.scalp->moved(std::move(taller))));
    ASSERT_TRUE(transfer) << transfer.error().message();
    EXPECT_TRUE(transfer->sameMesh);
    EXPECT_EQ(after.scalpSelection, before.scalpSelection);
    const auto from = before.rootBindings(), to = after.rootBindings();
    for (std::size_t s = 0; s < from.size(); ++s) {
        EXPECT_EQ(from[s].triangle, to[s].triangle);
        const Vec3f root = after.scalp->pointAt(to[s].triangle, to[s].barycentric);
        EXPECT_LT((after.strand(s)[0] - root).norm(), 1e-6f);
    }
    expectSound(after);
}

TEST(Transfer, ToItsOwnHeadChangesAlmostNothing) {
    const Groom before = combedHair();
    Groom after = before;
    ASSERT_TRUE(transferTo(after, before.scalp));
    for (std::size_t p = 0; p < before.pointCount(); ++p)
        EXPECT_LT((before.positions()[p] - after.positions()[p]).norm(), 0.001f);
}

TEST(Transfer, SameBitsForAnyNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const std::size_t threads : {1u, 5u}) {
        setThreadCount(threads);
        Groom groom = combedHair();
        ASSERT_TRUE(transferTo(groom, sphereScalp(0.11f, 3, Vec3f(0, 1.5f, 0))));
        hashes.push_back(contentHash(groom));
    }
    setThreadCount(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Transfer, OperatorsAreBakedAndHairWithoutAHeadIsRefused) {
    Groom groom = combedHair();
    groom.pointAttributes.set(attribute::kBasePosition,
                              groom.pointAttributes.all().find(attribute::kPosition)->second);
    groom.operators = {newOperator("smooth")};
    const auto transfer = transferTo(groom, sphereScalp(0.09f, 3, kCentre));
    ASSERT_TRUE(transfer);
    EXPECT_TRUE(transfer->baked);
    EXPECT_TRUE(groom.operators.empty());
    EXPECT_FALSE(groom.pointAttributes.has(attribute::kBasePosition));
    expectSound(groom);
    Groom loose = makeGroom({0, 2}, {Vec3f(0, 0, 0), Vec3f(0, 1, 0)});
    const auto refused = transferTo(loose, sphereScalp(0.09f, 3, kCentre));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("not bound"));
}

}  // namespace
}  // namespace hairloom
