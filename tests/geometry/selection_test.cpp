// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/base/file.h"
#include "tests/geometry/test_meshes.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

const ScalpMesh& sphere() {
    static const ScalpMesh kMesh = test::meshOf(test::icosphereSoup(3, 1));
    return kMesh;
}

FaceSet selected(const ScalpMesh& mesh, std::string_view expression) {
    const Result<FaceSet> faces = selectFaces(mesh, expression);
    EXPECT_TRUE(faces) << expression;
    return faces ? *faces : FaceSet{};
}

std::string refusal(const ScalpMesh& mesh, std::string_view expression) {
    const Result<FaceSet> faces = selectFaces(mesh, expression);
    EXPECT_FALSE(faces) << expression;
    return faces ? std::string() : faces.error().message();
}

TEST(Selection, CapHoldsExactlyTheFacesThatLeanSoFar) {
    const FaceSet cap = selected(sphere(), "cap:60");
    for (std::uint32_t t = 0; t < sphere().triangleCount(); ++t) {
        const float y = sphere().triangleNormal(t).y();
        if (std::abs(y - 0.5f) < 1e-4f) continue;
        EXPECT_EQ(std::binary_search(cap.begin(), cap.end(), t), y > 0.5f);
    }
    // A cap of 60° is a quarter of the sphere.
    EXPECT_NEAR(selectionArea(sphere(), cap) / selectionArea(sphere(), test::allFaces(sphere())), 0.25, 0.02);
    EXPECT_EQ(selected(sphere(), "cap:180").size(), sphere().triangleCount());
}

TEST(Selection, TermsApplyFromLeftToRight) {
    PolygonSoup soup = test::icosphereSoup(3, 1);
    test::append(soup, test::icosphereSoup(3, 1), {3, 2, 0});
    soup.groupNames = {"low", "high", "low"};
    for (std::size_t f = 0; f < 2560; ++f) soup.faceGroups.push_back(f < 1280 ? (f % 2 == 0 ? 0 : 2) : 1);
    const ScalpMesh mesh = test::meshOf(soup);
    // The height is that of the group alone when the group comes first: y from −1 to 1.
    const FaceSet groupFirst = selected(mesh, "group:low,above:0.75");
    EXPECT_FALSE(groupFirst.empty());
    for (const std::uint32_t t : groupFirst)
        EXPECT_GE(mesh.pointAt(t, Vec3f::Constant(1.0f / 3)).y(), 0.5f - 1e-5f);
    EXPECT_NEAR(selectionArea(mesh, groupFirst), 2 * kPi * 0.5, 0.2);
    EXPECT_THAT(refusal(mesh, "above:0.75,group:low"), HasSubstr("is empty after"));
    EXPECT_EQ(selected(mesh, "group:low").size(), 1280u);  // both parts of that name
    EXPECT_EQ(selected(mesh, "group:low,invert"), selected(mesh, "group:high"));
    const auto ofGroups = [&](std::vector<std::string> names) { return facesOfGroups(mesh, names); };
    EXPECT_EQ(*ofGroups({"low"}), selected(mesh, "group:low"));
    EXPECT_EQ(*ofGroups({"hi*"}), selected(mesh, "group:high"));
    EXPECT_EQ(*ofGroups({"high", "l*"}), selected(mesh, "all"));
    EXPECT_EQ(*ofGroups({"*"}), selected(mesh, "all"));
    EXPECT_TRUE(ofGroups({})->empty());
    for (const char* unknown : {"lo", "x*", "*w", ""}) {
        const Result<FaceSet> none = ofGroups({"low", unknown});
        ASSERT_FALSE(none) << unknown;
        EXPECT_THAT(none.error().message(), HasSubstr("one of: high, low"));
    }
    EXPECT_EQ(selected(mesh, "all , connected").size(), 1280u);
}

TEST(Selection, GrowAndShrinkGoByEdges) {
    const ScalpMesh mesh = test::meshOf(test::icosphereSoup(2, 1));
    const FaceSet one{7};
    const FaceSet grown = growSelection(mesh, one, 1);
    EXPECT_EQ(grown.size(), 4u);
    EXPECT_EQ(shrinkSelection(mesh, grown, 1), one);
    EXPECT_EQ(growSelection(mesh, one, 1000).size(), mesh.triangleCount());
    EXPECT_EQ(growSelection(mesh, one, 0), one);
    EXPECT_EQ(invertSelection(mesh, one).size(), mesh.triangleCount() - 1);
}

TEST(Selection, PiecesAreSortedByArea) {
    PolygonSoup soup = test::gridSoup(2, 1);
    test::append(soup, test::gridSoup(2, 3), {5, 0, 0});
    test::append(soup, test::gridSoup(2, 2), {10, 0, 0});
    const ScalpMesh mesh = test::meshOf(soup);
    const std::vector<FaceSet> pieces = connectedPieces(mesh, test::allFaces(mesh));
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_NEAR(selectionArea(mesh, pieces[0]), 9, 1e-4);
    EXPECT_NEAR(selectionArea(mesh, pieces[1]), 4, 1e-4);
    EXPECT_NEAR(selectionArea(mesh, pieces[2]), 1, 1e-4);
}

TEST(Selection, FaceListsNameFacesOfTheFile) {
    const ScalpMesh mesh = test::meshOf(test::gridSoup(4, 1));
    const TemporaryFolder folder;
    const std::string path = (folder / "faces.txt").string();
    ASSERT_TRUE(writeFileAtomically(path, std::string_view("3\r\n\n 0 \n3\n")));
    const FaceSet faces = selected(mesh, "faces:" + path);
    EXPECT_EQ(faces.size(), 4u);  // two quads
    for (const std::uint32_t t : faces) EXPECT_TRUE(mesh.sourceFaces()[t] == 0 || mesh.sourceFaces()[t] == 3);
    ASSERT_TRUE(writeFileAtomically(path, std::string_view("3\nx\n")));
    EXPECT_THAT(refusal(mesh, "faces:" + path), HasSubstr(path + ":2"));
    ASSERT_TRUE(writeFileAtomically(path, std::string_view("16\n")));
    EXPECT_THAT(refusal(mesh, "faces:" + path), HasSubstr("face 16"));
    std::filesystem::remove(path);
    EXPECT_THAT(refusal(mesh, "faces:" + path), HasSubstr(path));
}

TEST(Selection, ErrorsNameTheTerm) {
    PolygonSoup soup = test::gridSoup(2, 1);
    soup.groupNames = {"scalp"};
    const ScalpMesh mesh = test::meshOf(soup);
    EXPECT_THAT(refusal(mesh, "all,crown"), HasSubstr("crown"));
    EXPECT_THAT(refusal(mesh, "group:face"), HasSubstr("scalp"));
    EXPECT_THAT(refusal(mesh, ""), HasSubstr("unknown"));
    EXPECT_THAT(refusal(mesh, "all,"), HasSubstr("unknown"));
    EXPECT_THAT(refusal(mesh, "all:3"), HasSubstr("all:3"));
    for (const char* term : {"cap:181", "cap:-1", "cap:nan", "cap:", "cap:9x", "above:1.1", "grow:-1",
                             "grow:1.5", "shrink:x", "grow:1e99"})
        EXPECT_THAT(refusal(mesh, term), HasSubstr(term));
    EXPECT_THAT(refusal(mesh, "all,invert,cap:20"), HasSubstr("after 'invert'"));
}

}  // namespace
}  // namespace hairloom
