// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/groom/file/fields.h"
#include "core/groom/file/json_diff.h"
#include "core/groom/file/json_words.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_diff.h"
#include "core/groom/groom_hash.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Json = nlohmann::ordered_json;

GroomComparison compared(const Groom& before, const Groom& after, ComparedParts parts = ComparedParts::all) {
    return compare({before, "a.hairloom"}, {after, "a.hairloom"}, parts);
}
std::vector<std::string> words(const Groom& before, const Groom& after) {
    std::vector<std::string> all;
    for (const GroomDifference& one : compared(before, after).differences) all.push_back(inWords(one));
    return all;
}

/// Its strands in this order; the others go.
Groom withStrands(const Groom& groom, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> offsets{0}, ids;
    std::vector<Vec3f> positions;
    for (const std::uint32_t s : order) {
        const auto points = groom.strand(s);
        positions.insert(positions.end(), points.begin(), points.end());
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        ids.push_back(groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId)[s]);
    }
    Groom some = makeGroom(std::move(offsets), std::move(positions));
    some.strandAttributes.set(attribute::kStrandId, std::move(ids));
    return some;
}
Groom bareHair(std::size_t strands) {
    std::vector<std::uint32_t> all(strands);
    std::iota(all.begin(), all.end(), 0u);
    return withStrands(straightHair(sphereScalp(0.09f, 2), strands, 5, 0.1f), all);
}

TEST(GroomDiff, EqualGroomsHaveNone) {
    const TemporaryFolder folder;
    const Groom groom = fullGroom();
    EXPECT_THAT(words(groom, groom), IsEmpty());
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    const auto loaded = readProjectFile(folder / "a.hairloom");
    ASSERT_TRUE(loaded);
    EXPECT_THAT(compare({groom, folder / "a.hairloom"}, {*loaded, folder / "a.hairloom"}).differences,
                IsEmpty());
    EXPECT_THAT(words(Groom(), Groom()), IsEmpty());
}

/// Another value that the field takes.
template <class S>
S withAnother(const S& settings, const Field<S>& field) {
    S other = settings;
    if (field.kind == FieldKind::Ramp) {
        const runtime::Ramp::Key keys[] = {{0, static_cast<float>(field.min)},
                                           {1, static_cast<float>(field.max)}};
        runtime::member<runtime::Ramp>(other, field) = runtime::Ramp::of(keys);
        return other;
    }
    const double now = field.get(settings, 0);
    const double top = std::min(field.max, 1e6);
    field.set(other, now == top ? field.min : top, 0);
    return other;
}

template <class S>
void tellsEach(const std::string& section, S Groom::*settings) {
    const Groom before = fullGroom();
    for (const Field<S>& field : fieldsOf(S{})) {
        Groom after = before;
        after.*settings = withAnother(before.*settings, field);
        const auto all = compared(before, after).differences;
        ASSERT_EQ(all.size(), 1u) << section << "." << field.name;
        EXPECT_EQ(all[0].where, section + "." + field.name);
        EXPECT_EQ(all[0].what, "changed");
        EXPECT_EQ(all[0].unit, field.unit);
        EXPECT_NE(all[0].before, all[0].after);
    }
}
TEST(GroomDiff, TellsEverySettingByItsName) {
    tellsEach("simulation", &Groom::simulation);
    tellsEach("material", &Groom::material);
    tellsEach("shadows", &Groom::shadows);
    tellsEach("interpolation", &Groom::interpolation);
    tellsEach("placement", &Groom::placement);
}

TEST(GroomDiff, TellsEveryArray) {
    const Groom before = fullGroom();
    const auto change = [](const AttributeData& data) {
        AttributeData other = data;
        std::visit(
            [](auto& array) {
                auto& values = array.edit();
                auto bytes = std::as_writable_bytes(std::span(values));
                bytes[bytes.size() - 1] ^= std::byte{1};
            },
            other);
        return other;
    };
    for (const auto& [name, data] : before.strandAttributes.all()) {
        Groom after = before;
        after.strandAttributes.set(name, change(data));
        std::vector<std::string> wheres;
        for (const GroomDifference& one : compared(before, after).differences) wheres.push_back(one.where);
        // Another id is another strand.
        const bool isId = name == attribute::kStrandId;
        EXPECT_EQ(wheres, isId ? std::vector<std::string>({"strands", "strands"})
                               : std::vector<std::string>({"strands." + name}));
    }
    for (const auto& [name, data] : before.pointAttributes.all()) {
        Groom after = before;
        after.pointAttributes.set(name, change(data));
        EXPECT_THAT(compared(before, after).differences,
                    ElementsAre(testing::Field(&GroomDifference::where,
                                               name == attribute::kPosition ? "strands" : "points." + name)))
            << name;
    }
    Groom after = before;
    after.pointAttributes.edit<float>(attribute::kRadius)[3] = 6e-5f;
    after.strandAttributes.erase(attribute::kFrozen);
    after.strandAttributes.set("new", std::vector<float>(5));
    after.strandAttributes.set("signed", std::vector<float>(5));
    after.scalpDensity[7] = 0.5f;
    after.scalpSelection.pop_back();
    after.triangulation.triangles.pop_back();
    after.scalp = sphereScalp(0.092f, 1);
    EXPECT_THAT(words(before, after),
                ElementsAre("points.radius: 1 of 20 points changed, by up to 0.02 mm",
                            "strands.frozen: removed", "strands.signed: another type (\"int32\" → \"float\")",
                            "strands.new: added", "scalp.density: 1 of 18 values changed, by up to 0.25",
                            "scalp.positions: all 18 values changed, by up to 2 mm",
                            "scalp_selection: another number of values (16 → 15)",
                            "triangulation.triangles: another number of values (6 → 3)"));
    after = before;
    after.scalp = nullptr;
    after.scalpDensity.clear();
    EXPECT_THAT(words(before, after), ElementsAre("scalp: removed"));
}

TEST(GroomDiff, WhatTheHashTellsApartItTellsApart) {
    Groom before = fullGroom();
    before.scalpDensity[0] = 0;
    Groom after = before;
    after.scalpDensity[0] = -0.0f;
    ASSERT_FALSE(sameContent(before, after));
    EXPECT_THAT(words(before, after), ElementsAre("scalp.density: 1 of 18 values changed"));
    after = before;
    after.simulation.gravity.x = std::nextafter(before.simulation.gravity.x, 1.0f);
    ASSERT_FALSE(sameContent(before, after));
    EXPECT_THAT(words(before, after),
                ElementsAre("simulation.gravity: [0.1,-9.7,0.3] → [0.10000001,-9.7,0.3] m/s²"));
    after = before;
    after.pointAttributes.edit<Vec3f>(attribute::kPosition)[3].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(words(before, after), ElementsAre("strands: 1 of 5 strands moved"));
    EXPECT_THAT(words(after, after), IsEmpty());
}

TEST(GroomDiff, MatchesStrandsByTheirIds) {
    const Groom before = bareHair(300);
    std::vector<std::uint32_t> order(300);
    std::iota(order.begin(), order.end(), 0u);
    std::reverse(order.begin(), order.end());
    order.erase(order.begin() + 100, order.begin() + 110);
    Groom after = withStrands(before, order);
    auto& points = after.pointAttributes.edit<Vec3f>(attribute::kPosition);
    points[4].z() += 0.004125f;  // a tip
    points[5].x() += 0.001f;     // a root
    const auto all = compared(before, after);
    EXPECT_EQ(all.match, StrandMatch::ids);
    EXPECT_THAT(words(before, after),
                ElementsAre("strands: 10 strands removed (300 → 290)",
                            "strands: 2 of 290 strands moved, by up to 4.125 mm",
                            "strands: 1 of 290 strands have a root elsewhere, by up to 1 mm",
                            "strands: are in another order"));
    EXPECT_EQ(all.differences[1].count, 2u);
    EXPECT_EQ(all.differences[1].of, 290u);
    EXPECT_NEAR(all.differences[1].largest.value(), 4.125, 1e-4);
    EXPECT_THAT(words(after, before), testing::Contains("strands: 10 strands added (290 → 300)"));
}

TEST(GroomDiff, MatchesStrandsWithoutIdsByOrderOrRoots) {
    Groom before = bareHair(20);
    before.strandAttributes.erase(attribute::kStrandId);
    Groom after = before;
    after.pointAttributes.edit<Vec3f>(attribute::kPosition)[99].y() += 0.01f;
    EXPECT_EQ(compared(before, after).match, StrandMatch::order);
    EXPECT_THAT(words(before, after), ElementsAre("strands: 1 of 20 strands moved, by up to 10 mm"));

    after = withStrands(bareHair(20), {0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19});
    after.strandAttributes.erase(attribute::kStrandId);
    EXPECT_EQ(compared(before, after).match, StrandMatch::roots);
    EXPECT_THAT(words(before, after), ElementsAre("strands: 1 strand removed (20 → 19)"));

    // Two on one root: only their order is left.
    auto& points = after.pointAttributes.edit<Vec3f>(attribute::kPosition);
    points[5] = points[0];
    EXPECT_EQ(compared(before, after).match, StrandMatch::order);

    // Ids that repeat name nothing, and are compared as other attributes.
    before.strandAttributes.set(attribute::kStrandId, std::vector<std::uint32_t>(20, 7));
    after = before;
    after.strandAttributes.edit<std::uint32_t>(attribute::kStrandId)[3] = 8;
    EXPECT_THAT(words(before, after), ElementsAre("strands.id: 1 of 20 strands changed"));
}

TEST(GroomDiff, TellsAnotherNumberOfPoints) {
    const Groom before = makeGroom({0, 2, 4}, std::vector<Vec3f>(4, Vec3f(0, 1, 0)));
    const Groom after = makeGroom({0, 3, 5}, std::vector<Vec3f>(5, Vec3f(0, 1, 0)));
    EXPECT_THAT(words(before, after),
                ElementsAre("strands: 1 of 2 strands have another number of points (4 → 5)"));
}

TEST(GroomDiff, HairAloneLeavesSettingsOut) {
    const Groom before = fullGroom();
    Groom after = before;
    after.simulation.substeps = 3;
    after.scalp = nullptr;
    after.strandAttributes.erase(attribute::kGroup);
    const auto all = compared(before, after, ComparedParts::hair).differences;
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(inWords(all[0]), "strands.group: removed");
}

TEST(GroomDiff, NamesLayersSpheresAndOperators) {
    const Groom before = fullGroom();
    Groom after = before;
    after.layers.insert(after.layers.begin(), Layer{"Back", true, false, 1, {}});
    after.layers[2].density = 0.5f;
    after.layers[2].material->rootRadius = 5e-5f;
    after.spheres[1].radius = 0.065f;
    after.groupNames.emplace_back("nape");
    EXPECT_THAT(
        words(before, after),
        ElementsAre("strands.layer: all 5 strands changed", "layers[Fringe \"β\"].density: 0.3 → 0.5",
                    testing::MatchesRegex("layers\\[Fringe .*\\]\\.material\\.rootRadius: .* → 5e-05 m"),
                    testing::StartsWith("layers[Back]: added {\"name\":\"Back\""),
                    "groups: [\"front\",\"back\"] → [\"front\",\"back\",\"nape\"]",
                    "spheres[neck].radius: 0.06 → 0.065"));
    // Strands stay on their layers and in their groups, which have other numbers now.
    auto& layer = after.strandAttributes.edit<std::uint32_t>(attribute::kLayer);
    for (std::uint32_t& index : layer) ++index;
    std::ranges::reverse(after.groupNames);
    for (std::uint32_t& index : after.strandAttributes.edit<std::uint32_t>(attribute::kGroup))
        index = 2 - index;
    EXPECT_THAT(words(before, after), testing::Not(testing::Contains(testing::StartsWith("strands"))));
    layer[3] = 1;
    EXPECT_THAT(words(before, after), testing::Contains("strands.layer: 1 of 5 strands changed"));
    after = before;
    std::swap(after.layers[0], after.layers[1]);
    for (std::uint32_t& index : after.strandAttributes.edit<std::uint32_t>(attribute::kLayer))
        index = 1 - index;
    EXPECT_THAT(
        words(before, after),
        ElementsAre("layers: reordered ([\"Top\",\"Fringe \\\"β\\\"\"] → [\"Fringe \\\"β\\\"\",\"Top\"])"));
    after = before;
    after.layers[0].name = "Crown";
    EXPECT_THAT(words(before, after), ElementsAre("layers[Crown].name: \"Top\" → \"Crown\""));
}

TEST(JsonDiff, AlignsListsWithoutNames) {
    const auto op = [](const char* name, int value) { return Json{{"op", name}, {"value", value}}; };
    const Json before{{"operators", {op("clump", 1), op("curl", 2), op("noise", 3)}}};
    const Json after{{"operators", {op("cut", 9), op("clump", 1), op("curl", 5), op("noise", 3)}}};
    const auto all = differences(before, after);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].where, "operators[2 curl].value");
    EXPECT_EQ(all[0].before, 2);
    EXPECT_EQ(all[0].after, 5);
    EXPECT_EQ(all[1].where, "operators[0 cut]");
    EXPECT_EQ(all[1].what, "added");
    EXPECT_EQ(differences(after, before)[0].what, "removed");
    EXPECT_THAT(differences(before, before), IsEmpty());
}

TEST(JsonDiff, TakesNamesThatRepeatLongListsAndOtherKinds) {
    const Json twice{{"spheres", {{{"name", "a"}, {"r", 1}}, {{"name", "a"}, {"r", 2}}}}};
    Json after = twice;
    after["spheres"][1]["r"] = 3;
    ASSERT_EQ(differences(twice, after).size(), 1u);
    EXPECT_EQ(differences(twice, after)[0].where, "spheres[1].r");
    after["spheres"] = 4;
    EXPECT_EQ(differences(twice, after)[0].what, "changed");

    Json many = Json::array(), more = Json::array();
    for (int i = 0; i < 5000; ++i) {
        many.push_back({{"n", i}});
        more.push_back({{"n", i + 10'000}});
    }
    EXPECT_EQ(differences(many, more).size(), 5000u);

    // The same members in another order are the same.
    EXPECT_THAT(differences(Json{{"a", 1}, {"b", 2}}, Json{{"b", 2}, {"a", 1}}), IsEmpty());
}

TEST(JsonWords, AreShortAndWhole) {
    EXPECT_EQ(shortText(withFewDigits(Json{1.23456789, "x"}), 100), "[1.235,\"x\"]");
    EXPECT_EQ(shortText(Json("ββββ"), 4), "\"β…") << "no half characters";
}

TEST(GroomDiff, MillionsOfStrandsTakeNoLongerThanTheirShare) {
    constexpr std::uint32_t kStrands = 1'000'000;
    std::vector<std::uint32_t> offsets(kStrands + 1), ids(kStrands);
    std::vector<Vec3f> positions(2 * kStrands);
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        offsets[s + 1] = 2 * (s + 1);
        ids[s] = s * 2654435761u;  // all different, without order
        positions[2 * s] = Vec3f(static_cast<float>(s), 0, 0);
        positions[2 * s + 1] = Vec3f(static_cast<float>(s), 1, 0);
    }
    Groom before = makeGroom(offsets, positions);
    positions[7].y() = 1.5f;
    Groom after = makeGroom(offsets, positions);
    EXPECT_THAT(words(before, after), ElementsAre("strands: 1 of 1,000,000 strands moved, by up to 500 mm"));
    before.strandAttributes.set(attribute::kStrandId, ids);
    std::ranges::reverse(ids);
    after.strandAttributes.set(attribute::kStrandId, std::move(ids));
    EXPECT_EQ(compared(before, after).differences.size(), 3u);
}

}  // namespace
}  // namespace hairloom
