// SPDX-License-Identifier: GPL-3.0-or-later
// Operators at their defaults, and a full head of hair, on heads of any size: the bust in metres, tenfold and
// a tenth.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/documents/head_import.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/interpolation/follow_hairs.h"
#include "core/operations/found_vectors.h"
#include "core/operations/full_head.h"
#include "core/operations/head_places.h"
#include "core/operations/script.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

constexpr float kLength = 0.25f;  ///< metres on a person

/// 400 strands on the whole scalp of the sample, `scale` times as large as it is.
Groom bareHead(float scale) {
    const auto path = (sourceDir() / "samples/bust/bust.obj").string();
    HeadImportOptions options;
    options.metresPerUnit = scale;
    auto head = importHead(path, options);
    EXPECT_TRUE(head) << head.error().message();
    const auto mesh = std::make_shared<const ScalpMesh>(std::move(head->scene.mesh));
    auto faces = selectFaces(*mesh, "material:scalp");
    EXPECT_TRUE(faces) << faces.error().message();
    // Places on triangles, the same on all: rounding would place some elsewhere on each.
    static const std::vector<SurfacePoint> kRoots = [&] {
        PlacementRequest request;
        request.count = 400;
        request.seed = 1;
        const auto placed = placeDarts(*mesh, *faces, request);
        EXPECT_TRUE(placed) << placed.error().message();
        return placed->roots;
    }();
    auto groom = growStraight(mesh, std::move(*faces), kRoots, kLength * scale, 16);
    EXPECT_TRUE(groom) << groom.error().message();
    return std::move(*groom);
}

Groom shaped(Groom groom, const std::string& operations) {
    const auto script =
        parseScript("s.json", R"({"hairloom_script": 1, "operations": [)" + operations + "]}");
    EXPECT_TRUE(script) << script.error().message();
    const auto done = runScript(*script, groom);
    EXPECT_TRUE(done) << done.error().message();
    return groom;
}

/// A parting from the hairline to the crown.
std::string parting(float scale) {
    std::string curve;
    for (const Vec3f& at :
         {Vec3f(0.01f, 1.745f, 0.075f), Vec3f(0.01f, 1.765f, 0.05f), Vec3f(0.01f, 1.775f, 0.02f)})
        curve += fmt::format("{}[{},{},{}]", curve.empty() ? "" : ",", scale * at.x(), scale * at.y(),
                             scale * at.z());
    return R"({"op": "part", "curve": [)" + curve + "]}";
}

/// Of a picture from above, 2 mm a pixel on a person's head: the largest patch of scalp of which hair covers
/// less than a fifth, cm² on a person's head. A pixel is scalp where the skin seen there carries hair.
double largestBarePatch(const Groom& groom, float scale) {
    constexpr int kSide = 160;
    constexpr double kPixel = 0.002, kCovered = 0.2;
    std::vector<double> cover(kSide * kSide, 0);
    std::vector<char> isScalp(kSide * kSide, 0);
    const auto cellAt = [&](const Vec3f& at) {
        const int x = static_cast<int>(std::floor(double{at.x()} / scale / kPixel)) + kSide / 2;
        const int y = static_cast<int>(std::floor(double{at.z()} / scale / kPixel)) + kSide / 2;
        return x >= 0 && y >= 0 && x < kSide && y < kSide ? y * kSide + x : -1;
    };
    for (const std::uint32_t face : groom.scalpSelection) {
        const Triangle& corners = groom.scalp->triangles()[face];
        const auto at = [&](int c) { return groom.scalp->positions()[corners[c]]; };
        const Vec3f normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
        if (normal.y() < 0.5f) continue;  // seen too flat from above
        constexpr int kSteps = 8;
        const auto share = [](int step) { return static_cast<float>(step) / kSteps; };
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; i + j <= kSteps; ++j) {
                const Vec3f place = at(0) + (at(1) - at(0)) * share(i) + (at(2) - at(0)) * share(j);
                if (const int cell = cellAt(place); cell >= 0) isScalp[static_cast<std::size_t>(cell)] = 1;
            }
        }
    }
    const auto bindings = bindFollowHairs(groom, groom.interpolation);
    EXPECT_TRUE(bindings) << bindings.error().message();
    const auto hairs = bakeFollowHairs(groom, *bindings);
    EXPECT_TRUE(hairs) << hairs.error().message();
    const double width = 2 * double{groom.material.rootRadius} / scale;
    for (std::size_t s = 0; s < hairs->strandCount(); ++s) {
        const auto points = hairs->strand(s);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            constexpr int kPieces = 16;
            const Vec3f along = points[i + 1] - points[i];
            const double seen = std::hypot(double{along.x()}, double{along.z()}) / scale / kPieces;
            for (int piece = 0; piece < kPieces; ++piece) {
                const int cell = cellAt(points[i] + along * ((static_cast<float>(piece) + 0.5f) / kPieces));
                if (cell >= 0) cover[static_cast<std::size_t>(cell)] += seen * width / (kPixel * kPixel);
            }
        }
    }
    std::size_t largest = 0;
    std::vector<int> open;
    const auto take = [&](int cell) {
        char& scalp = isScalp[static_cast<std::size_t>(cell)];
        if (!scalp || 1 - std::exp(-cover[static_cast<std::size_t>(cell)]) >= kCovered) return;
        scalp = 0;
        open.push_back(cell);
    };
    for (int begin = 0; begin < kSide * kSide; ++begin) {
        take(begin);
        std::size_t size = 0;
        while (!open.empty()) {
            const int cell = open.back();
            open.pop_back();
            ++size;
            for (const int step : {1, -1, kSide, -kSide})
                if (cell + step >= 0 && cell + step < kSide * kSide) take(cell + step);
        }
        largest = std::max(largest, size);
    }
    return 1e4 * kPixel * kPixel * static_cast<double>(largest);
}

class AnyHead : public testing::TestWithParam<float> {};

TEST_P(AnyHead, HasItsScale) {
    EXPECT_FLOAT_EQ(headScale(bareHead(GetParam())), GetParam());
}

TEST_P(AnyHead, FlowAndPartAtTheirDefaultsLayTheSameHairThere) {
    const float scale = GetParam();
    const Groom person = shaped(bareHead(1), R"({"op": "flow"}, )" + parting(1));
    const Groom other = shaped(bareHead(scale), R"({"op": "flow"}, )" + parting(scale));
    ASSERT_EQ(other.pointCount(), person.pointCount());
    std::vector<float> apart;
    for (std::size_t p = 0; p < person.pointCount(); ++p)
        apart.push_back((other.positions()[p] / scale - person.positions()[p]).norm());
    // A strand that meets the skin just so may slip off it to another side.
    std::ranges::sort(apart);
    EXPECT_LT(apart[apart.size() * 95 / 100], 0.002f) << "19 of 20 within 2 mm of a person's head";
}

TEST_P(AnyHead, AFullHeadLeavesNoPatchOfSkinAtTheCrownAndBesideAParting) {
    const float scale = GetParam();
    Groom groom = shaped(bareHead(scale), R"({"op": "flow"}, )" + parting(scale));
    groom.interpolation.followPerGuide = 40;
    groom.interpolation.blend = 1;
    const double thin = largestBarePatch(groom, scale);
    ASSERT_TRUE(fillHead(groom));
    const double full = largestBarePatch(groom, scale);
    std::printf("%g: %.1f cm² bare of 40 hairs a guide, %.1f of %u\n", static_cast<double>(scale), thin, full,
                groom.interpolation.followPerGuide);
    // Hairs of a person's thickness are a tenth of a hair wide on a giant, and ropes on a doll.
    if (scale >= 1) {
        EXPECT_GT(thin, 20) << "27 hairs on a cm² do not cover";
    }
    EXPECT_LT(full, 2);
    EXPECT_NEAR(groom.interpolation.followPerGuide, 244, 5) << "160 on each of 611 cm², between 400 guides";
}

INSTANTIATE_TEST_SUITE_P(Sizes, AnyHead, testing::Values(1.0f, 0.1f, 10.0f));

TEST(HeadScale, IsOneForChildrenAndGrownUps) {
    for (const float radius : {0.07f, 0.08f, 0.1f, 0.115f})
        EXPECT_EQ(headScale(straightHair(sphereScalp(radius), 3, 4, 0.1f)), 1) << radius;
    EXPECT_EQ(headScale(Groom()), 1) << "without a head";
}

/// What a script leaves out, and what the window adds, is the same. What it names stays.
TEST(HeadScale, FitsLengthsThatNobodyNamed) {
    Groom giant = straightHair(sphereScalp(0.9f), 20, 12, 2.0f);
    ASSERT_EQ(headScale(giant), 10);
    giant.operators = {newOperator("flow", 10)};
    Groom scripted = shaped(giant, R"({"op": "flow"}, {"op": "curl", "radius": 0.02})");
    ASSERT_EQ(scripted.operators.size(), 3u);
    EXPECT_EQ(scripted.operators[1].settings, scripted.operators[0].settings);
    const auto valueOf = [](const Operator& one, const char* name) {
        const auto& fields = findStackOperator(one.op)->fields;
        const auto row =
            std::ranges::find(fields, std::string_view(name), [](const FieldRow& r) { return r.info.name; });
        return settingOf(one, row->info, 0);
    };
    const Operator person = newOperator("curl");
    EXPECT_NEAR(valueOf(scripted.operators[0], "liftTip"), 0.16, 1e-6);
    EXPECT_NEAR(valueOf(scripted.operators[2], "radius"), 0.02, 1e-6) << "named";
    EXPECT_NEAR(valueOf(scripted.operators[2], "start"), 10 * valueOf(person, "start"), 1e-6);
    EXPECT_NEAR(valueOf(scripted.operators[2], "frequency"), valueOf(person, "frequency") / 10, 1e-6);
    EXPECT_EQ(newOperator("curl", 1).settings, person.settings);
}

/// Farthest that a point lies elsewhere, metres.
float farthest(const Groom& a, const Groom& b) {
    float most = a.pointCount() == b.pointCount() ? 0 : 1;
    for (std::size_t i = 0; most < 1 && i < a.pointCount(); ++i)
        most = std::max(most, (a.positions()[i] - b.positions()[i]).norm());
    return most;
}

Groom withOperator(Groom groom, const Operator& one) {
    const auto text = nlohmann::json::parse(one.settings);
    auto operation = text;
    operation["op"] = one.op;
    return shaped(std::move(groom), operation.dump());
}

TEST(FoundVectors, CanBeNamedWithoutAChangeToTheHair) {
    const Groom bare = shaped(bareHead(1), R"({"op": "flow", "sweep": [0.3, 0, 0]})");
    constexpr float kAlike = 1e-4f;  // metres: rounding of places that were named
    std::vector<std::string> named;
    for (const StackOperator& known : stackOperators()) {
        if (known.name == kSculpt) continue;
        Operator open = newOperator(known.name);
        // Partings, planes and gradients that do something.
        for (const FieldRow& row : known.fields) {
            const std::string_view name = row.info.name;
            if (name == "parting") setSettingOf(open, row.info, 0.8, 0);
            if (name == "planeNormal" && open.op == "trim") setSettingOf(open, row.info, -1, 1);
            if (name == "gradientDistance") setSettingOf(open, row.info, 0.2, 0);
        }
        Operator placed = open;
        for (const FieldRow& row : known.fields) {
            const auto found = vectorFound(bare, open, row.info);
            if (!found) continue;
            named.push_back(open.op + "." + row.info.name);
            for (std::uint32_t c = 0; c < 3; ++c)
                ASSERT_TRUE(setSettingOf(placed, row.info, double{(*found)[c]}, c)) << named.back();
            EXPECT_FALSE(vectorFound(bare, placed, row.info)) << named.back();
        }
        for (const FieldRow& row : scriptRegionFields()) {
            if (!known.hasRegion || std::string_view(row.info.name) != "point") continue;
            EXPECT_FALSE(vectorFound(bare, open, row.info, SettingsPart::region)) << "it has no plane";
        }
        if (placed == open) continue;
        EXPECT_LT(farthest(withOperator(bare, open), withOperator(bare, placed)), kAlike) << open.op;
    }
    EXPECT_THAT(named, testing::UnorderedElementsAre("flow.crown", "flow.partingPoint", "trim.planePoint",
                                                     "set_length.gradientPoint", "mirror.planePoint",
                                                     "bun.centre", "bun.axis"));
}

TEST(FoundVectors, APlaneOfARegionIsShownAtTheHead) {
    const Groom bare = bareHead(1);
    Operator one = newOperator("curl");
    const auto& fields = scriptRegionFields();
    const auto field = [&](std::string_view name) {
        return std::ranges::find(fields, name, [](const FieldRow& row) { return row.info.name; })->info;
    };
    setSettingOf(one, field("normal"), 2, 0, SettingsPart::region);
    const auto found = vectorFound(bare, one, field("point"), SettingsPart::region);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->x(), 0) << "on the plane through the origin";
    EXPECT_NEAR(found->y(), topOfHead(bare).y(), 0.001f);
    EXPECT_FALSE(vectorFound(bare, one, field("normal"), SettingsPart::region));
    Groom headless = bare;
    headless.scalp = nullptr;
    EXPECT_FALSE(vectorFound(headless, one, field("point"), SettingsPart::region));
}

TEST(FullHead, NewHairFillsItUntilSomebodySaysOtherwise) {
    Groom groom = bareHead(1);
    EXPECT_FALSE(isFilledByItself(groom)) << "a project with strands and no follow hairs keeps them so";
    Groom none = groom;
    none.offsets = {};
    none.strandAttributes = {}, none.pointAttributes = {};
    ASSERT_EQ(none.strandCount(), 0u);
    EXPECT_TRUE(isFilledByItself(none));
    none.interpolation.followPerGuide = 12;
    EXPECT_FALSE(isFilledByItself(none));
    ASSERT_TRUE(fillHead(groom));
    EXPECT_EQ(groom.interpolation.followPerGuide, followHairsToFill(groom, 400));
    EXPECT_EQ(followHairsToFill(groom, 800), (groom.interpolation.followPerGuide + 1) / 2);
    EXPECT_TRUE(isFilledByItself(groom)) << "placed again with other strands it is filled again";
    groom.interpolation.followPerGuide += 1;
    EXPECT_FALSE(isFilledByItself(groom));
}

TEST(FullHead, SaysWhatIsMissing) {
    Groom empty;
    EXPECT_THAT(fillHead(empty).error().message(), testing::HasSubstr("place hair first"));
    Groom loose = straightHair(sphereScalp(), 20, 12, 0.1f);
    loose.scalpSelection = {};
    EXPECT_THAT(fillHead(loose).error().message(), testing::HasSubstr("select the scalp first"));
    Groom kept = straightHair(sphereScalp(), 20, 12, 0.1f);
    kept.material.rootRadius = 0.0001f;
    ASSERT_TRUE(fillHead(kept));
    EXPECT_EQ(kept.material.rootRadius, 0.0001f) << "a thickness that somebody chose";
}

}  // namespace
}  // namespace hairloom
