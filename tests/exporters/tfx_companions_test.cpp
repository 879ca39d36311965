// SPDX-License-Identifier: GPL-3.0-or-later
// What lies beside a .tfx, held against the skin that it comes from, read as AMD's loaders read it.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "importers/strand_file.h"
#include "importers/strands.h"
#include "tests/exporters/asset_samples.h"
#include "tests/exporters/character_sample.h"

namespace hairloom::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

class TfxCompanions : public AssetTest {
  protected:
    Result<ExportReport> write(const Groom& groom, const std::string& name = "a.tfx",
                               const StrandExportOptions& options = {}) const {
        return strandWriter("tfx").write(groom, folder / name, options);
    }
};

/// The blend of the skin at a root, by name of the bone.
std::map<std::string, float> skinAt(const Character& made, std::size_t strand) {
    const SurfacePoint root = made.groom.rootBindings()[strand];
    std::map<std::string, float> sums;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = made.actor->mesh().triangles()[root.triangle][corner];
        for (std::size_t i = 0; i < kBonesOfVertex; ++i) {
            const auto bone = made.actor->skin().bones[vertex][i];
            const float weight =
                made.actor->skin().weights[vertex][i] * root.barycentric[static_cast<int>(corner)];
            if (weight > 0) sums[made.actor->skeleton().bones()[bone].name] += weight;
        }
    }
    return sums;
}

TEST_F(TfxCompanions, BonesAreTheSkinAtTheRoots) {
    const Character made = character();
    const auto report = write(made.groom);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_THAT(report->companions, ElementsAre("a.tfxbone", "a.tfxmesh"));
    std::ifstream file(folder / "a.tfxbone", std::ios::binary);
    const auto next = [&] {
        std::int32_t value = -1;
        file.read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    };
    std::vector<std::string> names(static_cast<std::size_t>(next()));
    for (std::string& name : names) {
        next();
        char letters[128] = {};
        const std::int32_t length = next();
        ASSERT_LE(length, 128);
        file.read(letters, length);
        EXPECT_EQ(letters[length - 1], 0);
        name = letters;
    }
    ASSERT_EQ(next(), static_cast<std::int32_t>(made.groom.strandCount()));
    for (std::size_t strand = 0; strand < made.groom.strandCount(); ++strand) {
        EXPECT_EQ(next(), static_cast<std::int32_t>(strand));
        const auto wanted = skinAt(made, strand);
        float sum = 0, before = 2;
        for (int i = 0; i < 4; ++i) {
            const std::int32_t bone = next();
            float weight = -1;
            file.read(reinterpret_cast<char*>(&weight), sizeof weight);
            ASSERT_LT(static_cast<std::size_t>(bone), names.size());
            EXPECT_LE(weight, before) << "the heaviest is first; loaders want that one not to be 0";
            before = weight;
            sum += weight;
            if (weight <= 0) continue;
            EXPECT_NEAR(weight, wanted.at(names[static_cast<std::size_t>(bone)]), 1e-5f);
        }
        EXPECT_NEAR(sum, 1, 1e-5f);
    }
    EXPECT_EQ(file.peek(), std::char_traits<char>::eof());
}

TEST_F(TfxCompanions, TheMeshIsTheHeadInTheUnitOfTheStrands) {
    const Character made = character();
    StrandExportOptions unreal;
    unreal.metresPerUnit = 0.01f;
    unreal.up = UpAxis::Z;
    ASSERT_TRUE(write(made.groom, "a.tfx", unreal));
    std::ifstream file(folder / "a.tfxmesh");
    std::string line, word;
    std::getline(file, line);
    EXPECT_TRUE(line.starts_with('#'));
    std::size_t count = 0, index = 0;
    file >> word >> count;
    EXPECT_EQ(word, "numOfBones");
    ASSERT_EQ(count, made.actor->skeleton().bones().size());
    for (std::size_t bone = 0; bone < count; ++bone) {
        file >> index >> word;
        EXPECT_EQ(word, made.actor->skeleton().bones()[bone].name);
    }
    file >> word >> count;
    EXPECT_EQ(word, "numOfVertices");
    ASSERT_EQ(count, made.actor->mesh().vertexCount());
    for (std::size_t v = 0; v < count; ++v) {
        Vec3f p, n;
        std::array<float, 4> bones{}, weights{};
        file >> index >> p.x() >> p.y() >> p.z() >> n.x() >> n.y() >> n.z();
        for (float& bone : bones) file >> bone;
        for (float& weight : weights) file >> weight;
        ASSERT_EQ(index, v);
        const Vec3f rest = made.actor->mesh().positions()[v], normal = made.actor->mesh().normals()[v];
        EXPECT_LT((p - 100 * Vec3f(rest.x(), -rest.z(), rest.y())).norm(), 1e-3f);
        EXPECT_LT((n - Vec3f(normal.x(), -normal.z(), normal.y())).norm(), 1e-5f);
        EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1, 1e-5f);
    }
    file >> word >> count;
    EXPECT_EQ(word, "numOfTriangles");
    ASSERT_EQ(count, made.actor->mesh().triangleCount());
    for (std::size_t t = 0; t < count; ++t) {
        Triangle corners{};
        file >> index >> corners[0] >> corners[1] >> corners[2];
        ASSERT_EQ(corners, made.actor->mesh().triangles()[t]);
    }
    EXPECT_TRUE(file.good());
}

TEST_F(TfxCompanions, WeightsComeBackAndGoOutAgainWithoutTheCharacter) {
    const Character made = character();
    ASSERT_TRUE(write(made.groom));
    const auto imported = importStrands(folder / "a.tfx");
    ASSERT_TRUE(imported) << imported.error().message();
    for (std::size_t strand = 0; strand < made.groom.strandCount(); ++strand) {
        for (const auto& [bone, weight] : skinAt(made, strand)) {
            const auto values = imported->groom.strandAttributes.view<float>("bone_weight_" + bone);
            ASSERT_EQ(values.size(), made.groom.strandCount()) << bone;
            EXPECT_NEAR(values[strand], weight, 1e-5f);
        }
    }
    // The number of a bone may be another one; names and weights are the same.
    const auto report = write(imported->groom, "b.tfx");
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_THAT(report->companions, ElementsAre("b.tfxbone"));
    EXPECT_THAT(report->attributes, Contains(Field(&ComparedAttribute::name, HasSubstr("bone_weight_"))));
    for (const ComparedAttribute& attribute : report->attributes) EXPECT_LT(attribute.maxError, 1e-6);
}

TEST_F(TfxCompanions, AGroomWithoutBonesHasNone) {
    const auto report = write(helices({8, 8}));
    ASSERT_TRUE(report);
    EXPECT_THAT(report->companions, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(folder / "a.tfxbone"));
}

TEST_F(TfxCompanions, ARootThatNoBoneMovesIsSaid) {
    Groom groom = helices({8, 8});
    groom.strandAttributes.set("bone_weight_head", std::vector<float>{1, 0});
    const auto report = write(groom);
    ASSERT_TRUE(report);
    EXPECT_THAT(report->findings, Contains(Field(&Finding::what, HasSubstr("strand 1"))));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.tfxbone"));
}

TEST_F(TfxCompanions, ADamagedOneIsSaidAndLeftOut) {
    const Character made = character();
    ASSERT_TRUE(write(made.groom));
    const auto whole = readFile(folder / "a.tfxbone").value(), strands = readFile(folder / "a.tfx").value();
    std::size_t refused = 0;
    // As the confined process reads it, without a process for each.
    for (std::size_t at = 0; at < whole.size(); at += at < 64 ? 1 : 97) {
        for (const int value : {0x00, 0x7f, 0xff}) {
            auto bytes = whole;
            bytes[at] = static_cast<std::byte>(value);
            const auto read =
                readStrandFile("a.tfx", strands, {}, {{"tfxbone", {"a.tfxbone", std::move(bytes)}}});
            ASSERT_TRUE(read) << read.error().message();
            EXPECT_EQ(read->offsets.size(), made.groom.strandCount() + 1);
            for (const Finding& finding : read->warnings) {
                if (finding.where != "a.tfxbone") continue;
                ++refused;
                EXPECT_THAT(finding.what, HasSubstr("a.tfxbone"));
            }
        }
    }
    EXPECT_GT(refused, 20u);
    for (const std::size_t size : {std::size_t{0}, std::size_t{3}, whole.size() / 2, whole.size() - 1}) {
        std::filesystem::resize_file(folder / "a.tfxbone", size);
        const auto imported = importStrands(folder / "a.tfx");
        ASSERT_TRUE(imported) << imported.error().message();
        EXPECT_THAT(imported->warnings, Contains(Field(&Finding::where, "a.tfxbone"))) << size;
        EXPECT_FALSE(imported->groom.strandAttributes.has("bone_weight_head"));
    }
}

}  // namespace
}  // namespace hairloom::test
