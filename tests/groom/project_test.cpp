// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>
#include <deque>

#include "core/base/file.h"
#include "core/groom/file/archive.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/project_sections.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::string loadError(const std::filesystem::path& path) {
    const auto loaded = readProjectFile(path);
    return loaded ? "it was loaded" : loaded.error().message();
}

TEST(Project, SavesAndLoadsEverything) {
    const TemporaryFolder folder;
    const Groom groom = fullGroom();
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    const auto loaded = readProjectFile(folder / "a.hairloom");
    ASSERT_TRUE(loaded) << loaded.error().message();
    EXPECT_TRUE(sameContent(*loaded, groom));
    EXPECT_EQ(loaded->layers[1].name, "Fringe \"β\"");
    EXPECT_EQ(loaded->interpolation.seed, 0xfedcba9876543210ull);
    EXPECT_TRUE(loaded->simulation == groom.simulation);
    EXPECT_THAT(validate(*loaded), testing::IsEmpty());
    EXPECT_EQ(loaded->scalp->connectivity().n_faces(), groom.scalp->triangleCount());
    ASSERT_TRUE(saveProject(*loaded, folder / "b.hairloom"));
    EXPECT_EQ(readFile(folder / "a.hairloom").value(), readFile(folder / "b.hairloom").value());
}

TEST(Project, KeepsAnEmptyGroomAndOneWithoutScalp) {
    const TemporaryFolder folder;
    Groom bare = makeGroom({0, 2}, {Vec3f(0, 0, 0), Vec3f(0, 0.1f, 0)});
    for (const Groom& groom : {Groom(), bare}) {
        ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
        const auto loaded = readProjectFile(folder / "a.hairloom");
        ASSERT_TRUE(loaded) << loaded.error().message();
        EXPECT_TRUE(sameContent(*loaded, groom));
    }
}

TEST(Project, SavesFlawedValuesButNoFileThatCouldNotBeLoaded) {
    const TemporaryFolder folder;
    Groom groom = fullGroom();
    groom.pointAttributes.edit<Vec3f>(attribute::kPosition)[3].x() = std::numeric_limits<float>::infinity();
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    EXPECT_TRUE(sameContent(*readProjectFile(folder / "a.hairloom"), groom));
    const auto before = readFile(folder / "a.hairloom").value();
    groom.material.shininess = 0;
    const auto refused = saveProject(groom, folder / "a.hairloom");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("shininess is 0; expected 1 to 1000"));
    EXPECT_EQ(readFile(folder / "a.hairloom").value(), before) << "the old file stands";
}

/// A project as older versions wrote it: what is in `head` and the arrays of now.
class OlderProject {
  public:
    OlderProject() {
        EXPECT_TRUE(saveProject(fullGroom(), path_));
        now_ = ArchiveReader::open("a", readFile(path_).value(), section::kKind, kProjectVersion);
        EXPECT_TRUE(now_);
        head = now_->head();
        for (const char* member :
             {"kind", "version", "arrays", "operators", "card_edits", "poses", "time_line"})
            head.erase(member);
    }
    Result<Groom> load(std::uint32_t version, std::string_view without = {}) {
        ArchiveWriter writer{std::string(section::kKind), version};
        std::deque<AttributeData> arrays;  // the writer looks at them until it finishes
        for (const std::string& name : now_->names()) {
            if (name != without) writer.add(name, arrays.emplace_back(now_->readAny(name).value()));
        }
        EXPECT_TRUE(writeFileAtomically(path_, writer.finish(head).value()));
        return readProjectFile(path_);
    }

    nlohmann::ordered_json head;

  private:
    const TemporaryFolder folder_;
    const std::filesystem::path path_ = folder_ / "a.hairloom";
    Result<ArchiveReader> now_ = fail("not opened yet");
};

/// fullGroom() as those versions knew it.
Groom groomOfBefore() {
    Groom groom = fullGroom();
    groom.cardEdits.clear();
    groom.timeLine.reset();
    return groom;
}

TEST(Project, ReadsVersion1WithoutDensityAndPlacement) {
    OlderProject project;
    project.head.erase("placement");
    const auto loaded = project.load(1, section::kScalpDensity);
    ASSERT_TRUE(loaded) << loaded.error().message();
    Groom expected = groomOfBefore();
    expected.placement = {};
    expected.scalpDensity.clear();
    EXPECT_TRUE(sameContent(*loaded, expected));
}

TEST(Project, ReadsTheStiffnessAtTheTipOfVersion3AsAStraightCurve) {
    OlderProject project;
    project.head["simulation"]["angularTipShare"] = 0.35;
    const auto both = project.load(3);
    ASSERT_FALSE(both);
    EXPECT_THAT(both.error().message(),
                HasSubstr("/simulation/angularTipShare cannot be used together with angularCurve"));
    project.head["simulation"].erase("angularCurve");
    const auto loaded = project.load(3);
    ASSERT_TRUE(loaded) << loaded.error().message();
    Groom expected = groomOfBefore();
    expected.simulation.angularCurve = runtime::Ramp::straight(1, 0.35f);
    EXPECT_TRUE(sameContent(*loaded, expected));
}

/// The member gets its former name and the value given for it.
void nameAsBefore(nlohmann::ordered_json& section, const char* name, const char* former,
                  const nlohmann::ordered_json& value) {
    ASSERT_EQ(section.erase(name), 1u);
    section[former] = value;
}

TEST(Project, ReadsTheNamesOfVersion4) {
    Groom expected = groomOfBefore();
    expected.simulation.collisionRadiusRoot = 0.001f;
    expected.simulation.collisionRadiusTip = 0.003f;
    expected.simulation.angularMethod = runtime::AngularMethod::smallAngle;
    expected.material.colourSource = ColourSource::colours;
    expected.material.streakColourSource = ColourSource::melanin;
    expected.placement.placement = PlacementMethod::random;
    OlderProject project;
    nameAsBefore(project.head["simulation"], "collisionRadiusRoot", "pearlRadiusRoot", 0.001);
    nameAsBefore(project.head["simulation"], "collisionRadiusTip", "pearlRadiusTip", 0.003);
    nameAsBefore(project.head["simulation"], "angularMethod", "angularMethod", "cheap");
    nameAsBefore(project.head["material"], "colourSource", "dyed", true);
    nameAsBefore(project.head["material"], "streakColourSource", "streakDyed", false);
    nameAsBefore(project.head["placement"], "placement", "darts", false);
    const auto loaded = project.load(4);
    ASSERT_TRUE(loaded) << loaded.error().message();
    EXPECT_TRUE(sameContent(*loaded, expected));

    project.head["placement"]["darts"] = true;
    expected.placement.placement = PlacementMethod::poissonDisk;
    EXPECT_TRUE(sameContent(project.load(4).value(), expected));
    project.head["placement"]["placement"] = "random";
    const auto both = project.load(4);
    ASSERT_FALSE(both);
    EXPECT_THAT(both.error().message(), HasSubstr("/placement/darts cannot be used together with placement"));
    project.head["placement"].erase("placement");
    project.head["simulation"]["pearlRadiusTip"] = -1;
    const auto outside = project.load(4);
    ASSERT_FALSE(outside);
    EXPECT_THAT(outside.error().message(), HasSubstr("/simulation/pearlRadiusTip is -1"));
    project.head["simulation"].erase("pearlRadiusTip");
    project.head["simulation"]["pearlRadiusMiddle"] = 0;
    const auto unknown = project.load(4);
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message(), HasSubstr("/simulation/pearlRadiusMiddle is not known"));
}

TEST(Project, TruncatedAnywhereIsRefused) {
    const TemporaryFolder folder;
    const auto path = folder / "a.hairloom";
    ASSERT_TRUE(saveProject(fullGroom(), path));
    const auto whole = readFile(path).value();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const auto archive =
            ArchiveReader::open("a", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)},
                                section::kKind, kProjectVersion);
        ASSERT_FALSE(archive) << length << " of " << whole.size() << " bytes";
    }
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{7}, std::size_t{31}, whole.size() / 2, whole.size() - 1}) {
        ASSERT_TRUE(writeFileAtomically(path, std::span(whole).first(length), Replacing::Anything));
        EXPECT_FALSE(readProjectFile(path));
    }
    auto longer = whole;
    longer.push_back(std::byte{0});
    ASSERT_TRUE(writeFileAtomically(path, longer, Replacing::Anything));
    EXPECT_THAT(loadError(path), HasSubstr("follow the last array"));
}

TEST(Project, AByteChangedAnywhereIsRefused) {
    const TemporaryFolder folder;
    const auto path = folder / "a.hairloom";
    ASSERT_TRUE(saveProject(fullGroom(), path));
    auto bytes = readFile(path).value();
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (const auto flip : {std::byte{0x01}, std::byte{0xff}}) {
            bytes[i] ^= flip;
            ASSERT_FALSE(ArchiveReader::open("a", bytes, section::kKind, kProjectVersion)) << "byte " << i;
            bytes[i] ^= flip;
        }
    }
    EXPECT_TRUE(ArchiveReader::open("a", bytes, section::kKind, kProjectVersion));
}

TEST(Project, NamesThePlaceOfDamage) {
    const TemporaryFolder folder;
    const auto path = folder / "a.hairloom";
    ASSERT_TRUE(saveProject(fullGroom(), path));
    auto bytes = readFile(path).value();
    const auto text = std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const float x = fullGroom().positions()[0].x();
    const std::size_t place = text.find(std::string_view(reinterpret_cast<const char*>(&x), 4), 2048);
    ASSERT_NE(place, std::string_view::npos);
    bytes[place + 5] ^= std::byte{4};
    ASSERT_TRUE(writeFileAtomically(path, bytes, Replacing::Anything));
    EXPECT_THAT(loadError(path),
                HasSubstr(fmt::format("@{}: array '", place / kArchiveAlignment * kArchiveAlignment)));
    EXPECT_THAT(loadError(path), HasSubstr("does not match its checksum"));
    ASSERT_TRUE(writeFileAtomically(path, std::as_bytes(std::span(std::string_view("v 0 0 0\n"))),
                                    Replacing::Anything));
    EXPECT_THAT(loadError(path), HasSubstr("is not a Hairloom file"));
}

/// A project whose parts a test bends before it is sealed with right checksums, as a hostile program would
/// write it.
struct Forger {
    Json head;
    std::map<std::string, AttributeData> arrays;
    std::string kind = "project";
    std::uint32_t version = kProjectVersion;

    explicit Forger(const TemporaryFolder& folder) : path(folder / "forged.hairloom") {
        EXPECT_TRUE(saveProject(fullGroom(), path));
        const auto archive = ArchiveReader::open("a", readFile(path).value(), kind, version).value();
        head = Json::parse(archive.head().dump());
        for (const auto& [name, entry] : head["arrays"].items()) arrays[name] = archive.readAny(name).value();
        for (const char* added : {"arrays", "kind", "version"}) head.erase(added);
    }
    std::vector<std::byte> sealed() const {
        ArchiveWriter writer(kind, version);
        for (const auto& [name, data] : arrays) writer.add(name, data);
        return writer.finish(head).value();
    }
    std::string error() const {
        EXPECT_TRUE(writeFileAtomically(path, sealed()));
        return loadError(path);
    }
    std::filesystem::path path;
};

TEST(Project, OfBeforeThereWereMaterialsOfLayersIsReadAsItWasMeant) {
    const TemporaryFolder folder;
    Forger older(folder);
    older.head["material"].erase("shadingModel");
    for (Json& layer : older.head["layers"]) {
        layer.erase("density");
        layer.erase("material");
    }
    ASSERT_EQ(older.error(), "it was loaded");
    const auto loaded = readProjectFile(older.path);
    EXPECT_EQ(loaded->material.shadingModel, ShadingModel::kajiya);
    for (const Layer& layer : loaded->layers) {
        EXPECT_EQ(layer.density, 1);
        EXPECT_FALSE(layer.material);
    }
    EXPECT_EQ(&loaded->materialOf(1), &loaded->material);
}

TEST(HostileProject, UnchangedItLoads) {
    const TemporaryFolder folder;
    EXPECT_EQ(Forger(folder).error(), "it was loaded");
}

TEST(HostileProject, VersionsAndKindsAreNamed) {
    const TemporaryFolder folder;
    Forger newer(folder);
    newer.version = kProjectVersion + 2;
    EXPECT_THAT(newer.error(), HasSubstr("project is version 14, but this program reads versions up to 12"));
    Forger other(folder);
    other.kind = "cache";
    EXPECT_THAT(other.error(), HasSubstr("/kind is 'cache'; expected 'project'"));
    auto bytes = Forger(folder).sealed();
    bytes[8] = std::byte{9};
    ASSERT_TRUE(writeFileAtomically(other.path, bytes, Replacing::Anything));
    EXPECT_THAT(loadError(other.path),
                HasSubstr("container is version 9, but this program reads versions up to 1"));
}

TEST(HostileProject, HeadsAreReadStrictly) {
    const std::vector<std::pair<std::function<void(Json&)>, std::string>> cases = {
        {[](Json& h) { h.erase("layers"); }, "/layers is missing"},
        {[](Json& h) { h["layers"] = Json::array(); }, "/layers is empty"},
        {[](Json& h) { h["layers"][1]["name"] = 3; }, "/layers/1/name is 3"},
        {[](Json& h) { h["layers"][0]["colour"] = 3; }, "/layers/0/colour is not known"},
        {[](Json& h) { h["layers"][1]["density"] = 4.5; },
         "/layers/1/density is 4.5; expected a number from 0 to 4"},
        {[](Json& h) { h["layers"][1]["material"] = 2; }, "/layers/1/material"},
        {[](Json& h) { h["layers"][1]["material"]["specular"] = 7; }, "/layers/1/material/specular is 7"},
        {[](Json& h) { h["material"]["shadingModel"] = "phong"; }, "/material/shadingModel is \"phong\""},
        {[](Json& h) { h["future"] = 1; }, "/future is not known to this program"},
        {[](Json& h) { h["material"]["specular"] = 7; },
         "/material/specular is 7; expected a number from 0 to 2"},
        {[](Json& h) { h["material"]["glitter"] = 1; }, "/material/glitter is not known"},
        {[](Json& h) {
             h["material"]["rootColour"] = {0, 1};
         },
         "/material/rootColour is not a vector"},
        {[](Json& h) { h["simulation"]["integrator"] = "sideways"; },
         "/simulation/integrator is \"sideways\""},
        {[](Json& h) { h["simulation"]["substeps"] = 1.5; }, "/simulation/substeps is 1.5"},
        {[](Json& h) {
             h["simulation"]["angularCurve"] = {1, 2};
         },
         "/simulation/angularCurve is not a list"},
        {[](Json& h) {
             h["simulation"]["angularCurve"] = {{0, 1}, {0.5, 1}};
         },
         "/simulation/angularCurve has key 1 at 0.5"},
        {[](Json& h) { h["simulation"]["angularCurve"] = Json::array(); },
         "/simulation/angularCurve has 0 keys"},
        {[](Json& h) { h["spheres"][1]["radius"] = 0; }, "/spheres/1/radius is 0"},
        {[](Json& h) { h["spheres"][0]["centre"] = "here"; }, "/spheres/0/centre"},
        {[](Json& h) { h["interpolation"]["seed"] = -1; }, "/interpolation/seed is -1"},
        {[](Json& h) { h.erase("placement"); }, "/placement is missing"},
        {[](Json& h) { h["placement"]["points"] = 1; }, "/placement/points is 1"},
        {[](Json& h) { h.erase("card_edits"); }, "/card_edits is missing"},
        {[](Json& h) { h.erase("poses"); }, "/poses is missing"},
        {[](Json& h) {
             h["poses"] = {{{"name", "a/b"}}};
         },
         "/poses/0/name 'a/b' is no name of a pose"},
        {[](Json& h) {
             h["poses"] = {{{"name", "Wet"}}, {{"name", "Wet"}}};
         },
         "/poses/1/name is \"Wet\" again"},
        {[](Json& h) {
             h["poses"] = {{{"name", "Wet"}, {"amount", 1.5}}};
         },
         "/poses/0/amount is 1.5"},
        {[](Json& h) {
             h["poses"] = {{{"name", "Wet"}, {"weight", 1}}};
         },
         "/poses/0/weight is not known"},
        {[](Json& h) { h.erase("time_line"); }, "/time_line is missing"},
        {[](Json& h) { h["time_line"]["clips"][1]["blend"] = 7e6; }, "/time_line/clips/1/blend is 7000000"},
        {[](Json& h) { h["time_line"]["head"][1]["t"] = 0; }, "/time_line/head/1/t is 0 s, not later"},
        {[](Json& h) { h["time_line"]["end"] = 0.25; }, "/time_line/end is 0.25 s; expected more than start"},
        {[](Json& h) { h["time_line"]["settings"][0]["keys"] = Json::array(); },
         "/time_line/settings/0/keys is empty"},
        {[](Json& h) { h["time_line"]["settings"][1]["name"] = "simulation.gravity"; },
         "/time_line/settings/1/keys/0/value is not a vector"},
        {[](Json& h) { h["card_edits"][0]["level"] = 0; }, "/card_edits/0/level is 0"},
        {[](Json& h) {
             h["card_edits"][0]["roots"] = {1, 2};
         },
         "/card_edits/0/roots has 2 numbers"},
        {[](Json& h) { h["card_edits"][0]["roots"] = Json::array(); }, "/card_edits/0/roots has 0 numbers"},
        {[](Json& h) { h["card_edits"][0]["width"] = 5; }, "/card_edits/0/width is 5"},
        {[](Json& h) { h["card_edits"][1]["strip"].erase(8); }, "/card_edits/1/strip has 224 numbers"},
        {[](Json& h) { h["card_edits"][1]["strip"][6] = 0; },
         "/card_edits/1/strip has 225 numbers, or one out of"},
        {[](Json& h) { h["card_edits"][1]["glue"] = 1; }, "/card_edits/1/glue is not known"},
        {[](Json& h) { h["strands"] = 4; }, "has 5 values; expected 4"},
        {[](Json& h) { h["points"] = 4294967296u * 9ull; }, "/points is 38654705664"},
        {[](Json& h) { h["groups"] = {"front"}; }, "1 groups"},
        {[](Json& h) { h["scalp"]["groups"] = {"a"}; }, "is of group 1"},
        {[](Json& h) { h.erase("scalp"); }, "'scalp/corner_uvs' is not known"},
    };
    const TemporaryFolder folder;
    for (const auto& [bend, expected] : cases) {
        Forger forger(folder);
        bend(forger.head);
        EXPECT_THAT(forger.error(), HasSubstr(expected));
    }
}

TEST(HostileProject, ArraysAreReadStrictly) {
    using Arrays = std::map<std::string, AttributeData>;
    const auto numbers = [](Arrays& a, const char* name) -> std::vector<std::uint32_t>& {
        return std::get<CowArray<std::uint32_t>>(a.at(name)).edit();
    };
    const std::vector<std::pair<std::function<void(Arrays&)>, std::string>> cases = {
        {[](Arrays& a) { a.erase("offsets"); }, "array 'offsets' is missing"},
        {[](Arrays& a) { a["unknown"] = a["offsets"]; }, "array 'unknown' is not known"},
        {[](Arrays& a) { a["offsets"] = CowArray<float>(std::vector<float>(6)); },
         "'offsets' is of type float; expected uint32"},
        {[&](Arrays& a) { numbers(a, "offsets")[2] = 4000000000u; }, "offsets descend"},
        {[&](Arrays& a) { numbers(a, "offsets").back() = 4000000000u; },
         "describes 5 strands of 4000000000 points"},
        {[&](Arrays& a) { numbers(a, "strand/group").pop_back(); },
         "'strand/group' has 4 values; expected 5"},
        {[&](Arrays& a) { numbers(a, "strand/root_triangle")[0] = 32; }, "triangles of the scalp"},
        {[&](Arrays& a) { numbers(a, "triangulation/triangles").pop_back(); },
         "has 5 values; expected a multiple of 3"},
        {[&](Arrays& a) { numbers(a, "triangulation/triangles")[0] = 77; },
         "refers to strands that do not exist"},
        {[&](Arrays& a) { numbers(a, "scalp/triangles")[4] = 77; }, "has corner"},
        {[&](Arrays& a) { numbers(a, "scalp/triangles")[0] = numbers(a, "scalp/triangles")[1]; },
         "three different vertices"},
        {[&](Arrays& a) { numbers(a, "scalp/source_faces").pop_back(); }, "31 source faces; expected 32"},
        {[&](Arrays& a) { numbers(a, "scalp_selection")[0] = 31; }, "does not ascend"},
        {[](Arrays& a) { std::get<CowArray<Vec3f>>(a.at("scalp/positions")).edit()[0].x() = NAN; },
         "not finite"},
        {[](Arrays& a) { a.erase("point/position"); }, "no positions"},
        {[](Arrays& a) { a.erase("scalp/density"); }, "array 'scalp/density' is missing"},
        {[](Arrays& a) { std::get<CowArray<float>>(a.at("scalp/density")).edit().pop_back(); },
         "the density map has 17 values for 18 vertices"},
    };
    const TemporaryFolder folder;
    for (const auto& [bend, expected] : cases) {
        Forger forger(folder);
        bend(forger.arrays);
        EXPECT_THAT(forger.error(), HasSubstr(expected));
    }
}

}  // namespace
}  // namespace hairloom
