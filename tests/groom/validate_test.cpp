// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/validate.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Broken {
    const char* name;
    std::function<void(Groom&)> breakIt;
    Severity severity;
    const char* what;   ///< part of the finding
    const char* where;  ///< part of the place
};

void PrintTo(const Broken& printed, std::ostream* out) {
    *out << printed.name;
}

std::vector<Vec3f>& positions(Groom& g) {
    return g.pointAttributes.edit<Vec3f>(attribute::kPosition);
}

std::vector<Broken> brokenGrooms() {
    const Severity error = Severity::Error;
    const Severity warning = Severity::Warning;
    return {
        {"NoOffsets", [](Groom& g) { g.offsets.edit().clear(); }, error, "no offsets", "offsets"},
        {"FirstOffset", [](Groom& g) { g.offsets.edit()[0] = 1; }, error, "begin with 1", "offset 0"},
        {"DescendingOffsets", [](Groom& g) { g.offsets.edit()[2] = 1; }, error, "descend", "strand 1"},
        {"NoPositions", [](Groom& g) { g.pointAttributes.erase(attribute::kPosition); }, error,
         "no positions", "position"},
        {"ShortArray", [](Groom& g) { g.pointAttributes.edit<float>(attribute::kRadius).pop_back(); }, error,
         "one value for each of the 20 points", "'radius' (19 values)"},
        {"WrongType", [](Groom& g) { g.strandAttributes.set(attribute::kGuide, std::vector<float>(5)); },
         error, "wrong type", "'guide' is float, expected uint8"},
        {"OnePoint", [](Groom& g) { g.offsets.edit()[1] = 1; }, error, "fewer than 2", "strand 0"},
        {"GroupIndex", [](Groom& g) { g.groupNames.pop_back(); }, error, "1 groups", "strand 1 and 2 more"},
        {"LayerIndex", [](Groom& g) { g.layers.pop_back(); }, error, "1 layers", "strand 1 and 1 more"},
        {"LayerDensity", [](Groom& g) { g.layers[0].density = -1; }, error, "density is -1", "layer Top"},
        {"LayerMaterial", [](Groom& g) { g.layers[1].material->specular = 9; }, error, "specular is 9",
         "layer"},
        {"NoLayer", [](Groom& g) { g.layers.clear(); }, error, "no layers", "layers"},
        {"RootTriangle",
         [](Groom& g) { g.strandAttributes.edit<std::uint32_t>(attribute::kRootTriangle)[3] = 99; }, error,
         "triangles of the scalp", "strand 3"},
        {"SelectionOrder", [](Groom& g) { std::swap(g.scalpSelection[0], g.scalpSelection[1]); }, error,
         "does not ascend", "selected triangle 1"},
        {"SelectionRange", [](Groom& g) { g.scalpSelection.back() = 32; }, error, "32 triangles",
         "selected triangle"},
        {"RootTriangulation", [](Groom& g) { g.triangulation.triangles[1][2] = 5; }, error, "triangulation",
         "root triangle 1"},
        {"RootAlone", [](Groom& g) { g.triangulation.alone[0] = 5; }, error, "triangulation", "root alone 0"},
        {"CoincidentRoot", [](Groom& g) { g.triangulation.coincident[0].root = 5; }, error, "triangulation",
         "coincident root 0"},
        {"NotFinite", [](Groom& g) { positions(g)[7].y() = kNaN; }, error, "position is not finite",
         "point 7"},
        {"NoLength", [](Groom& g) { positions(g)[6] = positions(g)[5]; }, error, "no length",
         "strand 1, point 2"},
        {"NegativeRadius", [](Groom& g) { g.pointAttributes.edit<float>(attribute::kRadius)[2] = -1; }, error,
         "radius is negative", "point 2"},
        {"ThickHair", [](Groom& g) { g.pointAttributes.edit<float>(attribute::kRadius)[4] = 0.04f; }, warning,
         "radius is above", "point 4"},
        {"Huge",
         [](Groom& g) {
             for (Vec3f& p : positions(g)) p *= 100;
         },
         warning, "from corner to corner", "bounds"},
        {"Flag", [](Groom& g) { g.strandAttributes.edit<std::uint8_t>(attribute::kFrozen)[4] = 2; }, warning,
         "frozen is neither", "strand 4"},
        {"Dye",
         [](Groom& g) {
             g.strandAttributes.set(attribute::kDye, std::vector<float>(g.strandCount(), 0.5f));
             g.strandAttributes.edit<float>(attribute::kDye)[3] = 1.5f;
         },
         error, "dye mask", "strand 3"},
        {"Stiffness",
         [](Groom& g) {
             g.strandAttributes.set(attribute::kStiffness, std::vector<float>(g.strandCount(), 1000.0f));
             g.strandAttributes.edit<float>(attribute::kStiffness)[3] = 1001;
         },
         error, "stiffness of strands is not from 0 to 1000", "strand 3"},
        {"RepeatedId",
         [](Groom& g) { g.strandAttributes.edit<std::uint32_t>(attribute::kStrandId)[4] = 101; }, error,
         "same id", "id 101"},
        {"OutsideSelection", [](Groom& g) { g.scalpSelection = {31}; }, warning,
         "outside the scalp selection", "strand 0"},
        {"Barycentric",
         [](Groom& g) { g.strandAttributes.edit<Vec3f>(attribute::kRootBarycentric)[2] = Vec3f(1, 1, -1); },
         error, "barycentrics", "strand 2"},
        {"RootInTheAir", [](Groom& g) { positions(g)[4] += Vec3f(0, 0.01f, 0); }, warning,
         "away from its binding", "strand 1"},
        {"Unbound", [](Groom& g) { g.strandAttributes.erase(attribute::kRootTriangle); }, warning,
         "not bound", "strands"},
        {"SphereRadius", [](Groom& g) { g.spheres[1].radius = 0; }, error, "collision sphere", "'neck'"},
        {"SphereCentre", [](Groom& g) { g.spheres[0].centre.x() = kNaN; }, error, "collision sphere",
         "'head'"},
        {"Material", [](Groom& g) { g.material.specular = 7; }, error, "specular is 7; expected 0 to 2",
         "material"},
        {"Shadows", [](Groom& g) { g.shadows.layers = 12; }, error, "layers is 12; expected 3 to 11",
         "shadows"},
        {"Interpolation", [](Groom& g) { g.interpolation.followPerGuide = 5000; }, error, "followPerGuide",
         "interpolation"},
        {"Simulation", [](Groom& g) { g.simulation.substeps = 0; }, error, "substeps", "simulation"},
    };
}

class BrokenGroom : public testing::TestWithParam<Broken> {};

TEST_P(BrokenGroom, IsReportedWithItsLocation) {
    Groom groom = fullGroom();
    GetParam().breakIt(groom);
    const auto findings = validate(groom);
    const bool found = std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
        return finding.severity == GetParam().severity &&
               finding.what.find(GetParam().what) != std::string::npos &&
               finding.where.find(GetParam().where) != std::string::npos && !finding.fix.empty();
    });
    std::string all;
    for (const Finding& f : findings)
        all += std::string(severityName(f.severity)) + ": " + f.what + " (" + f.where + ")\n";
    EXPECT_TRUE(found) << "found only:\n" << all;
    EXPECT_EQ(hasErrors(findings), GetParam().severity == Severity::Error) << all;
}

INSTANTIATE_TEST_SUITE_P(Validate, BrokenGroom, testing::ValuesIn(brokenGrooms()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Validate, FindsNothingInASoundGroom) {
    EXPECT_THAT(validate(fullGroom()), testing::IsEmpty());
    EXPECT_TRUE(checkStructure(fullGroom()));
}

TEST(Validate, AnEmptyGroomIsNoError) {
    const auto findings = validate(Groom());
    EXPECT_FALSE(hasErrors(findings));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].severity, Severity::Info);
}

}  // namespace
}  // namespace hairloom
