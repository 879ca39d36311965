// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that is led to the shape of other hair, against shapes worked out here.
#include "core/documents/hair_blend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "core/documents/hair_import.h"
#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/geometry/curve.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_hash.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

const Vec3f kCentre(0, 1.6f, 0);

Groom hair(std::size_t strands = 200, std::uint64_t seed = 5, std::uint32_t points = 12,
           float length = 0.12f) {
    return straightHair(sphereScalp(), strands, points, length, seed);
}

/// Bent towards +X by up to 60° at the tip, at their lengths.
Groom bentHair(Groom groom) {
    auto& points = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        Vec3f before = points[groom.offsets[s]];
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p) {
            const Vec3f segment = points[p] - before;
            before = points[p];
            const float share = static_cast<float>(p - groom.offsets[s]) / 11;
            const Vec3f bent = (segment.normalized() + 1.2f * share * Vec3f::UnitX()).normalized();
            points[p] = points[p - 1] + bent * segment.norm();
        }
    }
    return groom;
}

class HairBlendTest : public testing::Test {
  protected:
    std::string saved(const Groom& groom, const char* name = "other.hairloom") {
        const std::string path = (folder_ / name).string();
        EXPECT_TRUE(saveProject(groom, path));
        return path;
    }
    TemporaryFolder folder_;
};

TEST_F(HairBlendTest, SameRootsTakeTheVeryShape) {
    const Groom straight = hair(), bent = bentHair(straight);
    const auto shape = shapeOfOther(straight, bent, 0.02f);
    ASSERT_TRUE(shape) << shape.error().message();
    EXPECT_EQ(shape->matched, straight.strandCount());
    EXPECT_EQ(shape->farthest, 0);
    for (std::size_t p = 0; p < straight.pointCount(); ++p)
        EXPECT_LT((shape->points[p] - bent.positions()[p]).norm(), 1e-6f);
}

TEST_F(HairBlendTest, TheWeightIsTheShareOfTheWay) {
    const Groom straight = hair(), bent = bentHair(straight);
    const std::string file = saved(bent);
    editing::Document document(straight);
    for (const float weight : {0.0f, 0.5f, 1.0f}) {
        BlendSettings settings;
        settings.weight = weight;
        auto blend = blendWithFile(document.model(), file, settings);
        ASSERT_TRUE(blend) << blend.error().message();
        document.perform(std::move(blend->command));
        const Groom& groom = document.groom();
        ASSERT_EQ(groom.operators.size(), 1u);
        for (std::size_t s = 0; s < groom.strandCount(); ++s) {
            EXPECT_EQ(groom.strand(s)[0], straight.strand(s)[0]);
            EXPECT_NEAR(polylineLength(groom.strand(s)), 0.12f, 1e-5f);
            const auto angle = [&](const Groom& of) {
                const Vec3f last = of.strand(s)[11] - of.strand(s)[10];
                const Vec3f first = straight.strand(s)[11] - straight.strand(s)[10];
                return std::acos(std::min(1.0f, last.normalized().dot(first.normalized())));
            };
            EXPECT_NEAR(angle(groom), weight * angle(bent), 0.06f) << weight;
        }
        ASSERT_TRUE(document.undo());
        EXPECT_EQ(contentHash(document.groom()), contentHash(straight));
    }
}

TEST_F(HairBlendTest, HairBetweenOtherRootsTakesTheirMeanAndTheirLength) {
    // On a sphere, straight hair out of the skin is so anywhere; that of other length passes that on.
    const Groom few = hair(150, 5), many = hair(2000, 77, 7, 0.06f);
    const auto shape = shapeOfOther(few, many, 0.02f);
    ASSERT_TRUE(shape) << shape.error().message();
    EXPECT_EQ(shape->matched, few.strandCount());
    EXPECT_GT(shape->farthest, 1e-4f);
    for (std::size_t s = 0; s < few.strandCount(); ++s) {
        const auto points = std::span(shape->points).subspan(few.offsets[s], 12);
        EXPECT_NEAR(polylineLength(points), 0.06f, 1e-4f);
        EXPECT_GT((points[11] - points[0]).normalized().dot((points[0] - kCentre).normalized()), 0.995f);
    }
}

TEST_F(HairBlendTest, MasksLimitItAndStayEditable) {
    const Groom bent = bentHair(hair());
    Groom straight = hair();
    std::vector<float> painted(straight.strandCount(), 0);
    for (std::size_t s = 0; s < painted.size(); s += 2) painted[s] = 1;
    straight.strandAttributes.set(maskAttribute(2), painted);
    BlendSettings settings;
    settings.weight = 1;
    settings.mask.map = MaskMap::mask2;
    editing::Document document(straight);
    auto blend = blendWithFile(document.model(), saved(bent), settings);
    ASSERT_TRUE(blend) << blend.error().message();
    document.perform(std::move(blend->command));
    for (std::size_t s = 0; s < painted.size(); ++s) {
        const Groom& wanted = painted[s] > 0 ? bent : straight;
        EXPECT_LT((document.groom().strand(s)[11] - wanted.strand(s)[11]).norm(), 1e-5f);
    }
    EXPECT_EQ(maskOf(document.groom().operators[0]).map, MaskMap::mask2);
}

TEST_F(HairBlendTest, GoesOnTopOfOperatorsAndComesFromScripts) {
    const std::string file = saved(bentHair(hair()));
    editing::Document document(hair());
    auto curl = editing::addOperator(document.model(), 0, newOperator("curl"));
    ASSERT_TRUE(curl);
    document.perform(std::move(*curl));
    const std::uint64_t before = contentHash(document.groom());
    std::uint64_t after = 0;
    for (const std::size_t threads : {1u, 3u}) {
        setThreadCount(threads);
        auto blend = blendWithFile(document.model(), file, {});
        setThreadCount(0);
        ASSERT_TRUE(blend) << blend.error().message();
        document.perform(std::move(blend->command));
        EXPECT_TRUE(after == 0 || after == contentHash(document.groom()));
        after = contentHash(document.groom());
        if (threads == 1) document.undo();
    }
    ASSERT_EQ(document.groom().operators.size(), 2u);
    EXPECT_EQ(document.groom().operators[0].op, "curl");
    EXPECT_EQ(document.groom().operators[1].op, kSculpt);
    EXPECT_EQ(document.groom().operators[1].weight, 0.5f);
    const auto script = parseDocumentScript("s.json", document.script().value());
    ASSERT_TRUE(script) << script.error().message();
    Groom replayed = hair();
    ASSERT_TRUE(runScript(*script, replayed));
    EXPECT_EQ(contentHash(replayed), after);
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(contentHash(document.groom()), before);
}

TEST_F(HairBlendTest, SaysWhatCannotBe) {
    const Groom groom = hair();
    const editing::Model model{groom, {}};
    Groom elsewhere = groom;
    for (Vec3f& point : elsewhere.pointAttributes.edit<Vec3f>(attribute::kPosition)) point.x() += 1;
    const auto far = blendWithFile(model, saved(elsewhere), {});
    ASSERT_FALSE(far);
    EXPECT_THAT(far.error().message(), HasSubstr("other.hairloom"));
    EXPECT_THAT(far.error().message(), HasSubstr("20 mm"));
    EXPECT_THAT(far.error().message(), HasSubstr("transfer"));
    Groom bald;
    bald.scalp = groom.scalp;
    EXPECT_THAT(blendWithFile(model, saved(bald), {}).error().message(), HasSubstr("no hair"));
    EXPECT_THAT(blendWithFile({bald, {}}, saved(groom), {}).error().message(), HasSubstr("no hair"));
    EXPECT_THAT(blendWithFile(model, (folder_ / "none.abc").string(), {}).error().message(),
                HasSubstr("none.abc"));
    BlendSettings wild;
    wild.weight = 3;
    EXPECT_THAT(blendWithFile(model, saved(groom), wild).error().message(), HasSubstr("weight"));
    wild = {};
    wild.mask.formula = "1/(";
    EXPECT_FALSE(blendWithFile(model, saved(groom), wild));
    // Hair with the same shape changes nothing, and strands out of reach stay.
    Groom half = bentHair(groom);
    for (std::size_t s = 0; s < groom.strandCount(); s += 2) {
        for (std::uint32_t p = half.offsets[s]; p < half.offsets[s + 1]; ++p)
            half.pointAttributes.edit<Vec3f>(attribute::kPosition)[p].x() += 1;
    }
    const auto some = shapeOfOther(groom, half, 0.0002f);
    ASSERT_TRUE(some);
    EXPECT_EQ(some->matched, groom.strandCount() / 2);
    EXPECT_EQ(some->points[groom.offsets[2] + 5], groom.strand(2)[5]);
}

}  // namespace
}  // namespace hairloom
