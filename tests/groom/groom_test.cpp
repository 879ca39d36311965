// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "core/groom/file/fields.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

TEST(CowArray, SharesUntilWrittenAndRenewsItsVersion) {
    CowArray<float> a(std::vector<float>{1, 2, 3});
    CowArray<float> b = a;
    EXPECT_TRUE(a.sharesWith(b));
    EXPECT_EQ(a.version(), b.version());
    b.edit()[1] = 7;
    EXPECT_FALSE(a.sharesWith(b));
    EXPECT_EQ(a[1], 2);
    EXPECT_EQ(b[1], 7);
    EXPECT_GT(b.version(), a.version());
    const float* place = b.view().data();
    const Version before = b.version();
    b.edit()[0] = 9;
    EXPECT_EQ(b.view().data(), place) << "an unshared array is written in place";
    EXPECT_NE(b.version(), before);
}

TEST(AttributeSet, NamesTypesOfAllArrays) {
    for (const char* name : {"float", "float2", "float3", "float4", "int32", "uint32", "uint8"}) {
        const auto data = emptyOfType(name);
        ASSERT_TRUE(data);
        EXPECT_EQ(typeName(*data), name);
        EXPECT_EQ(sizeOf(*data), 0u);
    }
    const auto unknown = emptyOfType("double");
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message(), testing::HasSubstr("'double' is not an attribute type"));
    EXPECT_THAT(unknown.error().message(), testing::HasSubstr("uint8"));
}

TEST(AttributeSet, GivesValuesOnlyAsTheirType) {
    AttributeSet set;
    set.set("a", std::vector<float>{1, 2});
    EXPECT_EQ(set.view<float>("a").size(), 2u);
    EXPECT_TRUE(set.view<Vec3f>("a").empty());
    EXPECT_TRUE(set.view<float>("b").empty());
    const Version before = set.version("a");
    set.edit<float>("a").push_back(3);
    EXPECT_NE(set.version("a"), before);
    set.erase("a");
    EXPECT_FALSE(set.has("a"));
    EXPECT_EQ(set.version("a"), 0u);
}

TEST(Groom, CopiesShareArrays) {
    const Groom a = fullGroom();
    Groom b = a;
    EXPECT_EQ(a.positions().data(), b.positions().data());
    b.pointAttributes.edit<Vec3f>(attribute::kPosition)[3].x() += 1;
    EXPECT_NE(a.positions().data(), b.positions().data());
    EXPECT_EQ(a.offsets.view().data(), b.offsets.view().data());
    EXPECT_TRUE(sameContent(a, fullGroom()));
    EXPECT_FALSE(sameContent(a, b));
}

TEST(Groom, CountsBoundsAndBindings) {
    const Groom groom = fullGroom();
    EXPECT_EQ(groom.strandCount(), 5u);
    EXPECT_EQ(groom.pointCount(), 20u);
    EXPECT_EQ(groom.guideCount(), 2u);
    EXPECT_EQ(Groom().guideCount(), 0u);
    EXPECT_EQ(groom.rootBindings().size(), 5u);
    EXPECT_TRUE(Groom().rootBindings().empty());
    for (const Vec3f& p : groom.positions()) EXPECT_TRUE(groom.bounds().contains(p));
}

TEST(GroomHash, SeesEveryPart) {
    const std::uint64_t plain = contentHash(fullGroom());
    const std::vector<std::function<void(Groom&)>> edits = {
        [](Groom& g) { g.strandAttributes.erase("signed"); },
        [](Groom& g) { g.strandAttributes.edit<std::int32_t>("signed")[2] = 8; },
        [](Groom& g) { g.layers[1].locked = false; },
        [](Groom& g) { g.layers[0].name += "x"; },
        [](Groom& g) { g.layers[0].density = 0.5f; },
        [](Groom& g) { g.layers[0].material = g.material; },
        [](Groom& g) { g.layers[1].material->specular += 0.1f; },
        [](Groom& g) { g.material.shadingModel = ShadingModel::kajiya; },
        [](Groom& g) { g.groupNames[0] = "other"; },
        [](Groom& g) { g.spheres[1].centre.z() = 1; },
        [](Groom& g) { g.spheres[0].bone = "Neck"; },
        [](Groom& g) { g.material.scaleTiltDegrees += 1; },
        [](Groom& g) { g.simulation.windSpeed = 3; },
        [](Groom& g) { g.simulation.angularCurve = {}; },
        [](Groom& g) { g.interpolation.seed ^= 1; },
        [](Groom& g) { g.scalp.reset(); },
        [](Groom& g) { g.scalpSelection.pop_back(); },
        [](Groom& g) { g.triangulation.triangles[1][0] = 0; },
        [](Groom& g) { g.triangulation.coincident[0].sameAs = 1; },
        [](Groom& g) { g.triangulation.alone.clear(); },
        [](Groom& g) { g.scalpExpression += " "; },
        [](Groom& g) { g.characterFile.clear(); },
        [](Groom& g) { g.characterMetresPerUnit = 0.1f; },
    };
    for (std::size_t i = 0; i < edits.size(); ++i) {
        Groom groom = fullGroom();
        edits[i](groom);
        EXPECT_NE(contentHash(groom), plain) << "edit " << i;
    }
}

template <class S>
void expectDefaultsInRange() {
    EXPECT_THAT(fieldsOutOfRange(S()), testing::IsEmpty());
    for (const Field<S>& field : fieldsOf(S())) {
        EXPECT_LT(field.min, field.max) << field.name;
        EXPECT_GT(std::string_view(field.meaning).size(), 8u) << field.name;
    }
}

TEST(Fields, DefaultsLieInRange) {
    expectDefaultsInRange<HairMaterial>();
    expectDefaultsInRange<InterpolationSettings>();
    HairMaterial material;
    material.tipColour.y() = 3;
    ASSERT_EQ(fieldsOutOfRange(material).size(), 1u);
    EXPECT_EQ(fieldsOutOfRange(material)[0], "tipColour.y is 3; expected 0 to 1");
}

TEST(BindToScalp, FindsTheFacesThatStrandsGrewOn) {
    const auto scalp = sphereScalp();
    const Groom grown = straightHair(scalp, 200, 4, 0.1f);
    Groom loose = makeGroom({grown.offsets.view().begin(), grown.offsets.view().end()},
                            {grown.positions().begin(), grown.positions().end()});
    const auto distances = bindToScalp(loose, scalp, grown.scalpSelection);
    ASSERT_EQ(distances.size(), 200u);
    const auto roots = loose.rootBindings();
    for (std::size_t s = 0; s < distances.size(); ++s) {
        EXPECT_LT(distances[s], 1e-5f);
        EXPECT_LT((scalp->pointAt(roots[s].triangle, roots[s].barycentric) - grown.strand(s)[0]).norm(),
                  1e-5f);
    }
    EXPECT_THAT(validate(loose), testing::IsEmpty());
}

TEST(BindToScalp, ReportsDistanceOfRootsOffTheScalp) {
    const auto scalp = sphereScalp();
    const Vec3f above(0, 1.6f + 0.09f + 0.25f, 0);
    Groom groom = makeGroom({0, 2}, {above, above + Vec3f(0, 0.1f, 0)});
    EXPECT_NEAR(bindToScalp(groom, scalp, {})[0], 0.25f, 1e-4f);
    EXPECT_EQ(groom.strand(0)[0], above) << "binding moves no strand";
}

}  // namespace
}  // namespace hairloom
