// SPDX-License-Identifier: GPL-3.0-or-later
// The runtime asset: what it carries and how exactly, and how large it is.

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "core/base/parallel.h"
#include "core/groom/file/fields.h"
#include "core/interpolation/follow_hairs.h"
#include "hairloom/body_bytes.h"
#include "hairloom/engine.h"
#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_bytes.h"
#include "tests/exporters/asset_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

namespace format = runtime::asset;
using runtime::AssetError;
using testing::ElementsAre;
using testing::HasSubstr;

class RuntimeAsset : public AssetTest {};

/// Values that are none of the defaults, as far as the fields hold them.
template <class S>
S otherThanDefault() {
    S settings;
    for (const auto& field : fieldsOf(settings)) {
        for (std::uint32_t c = 0; c < field.components(); ++c) {
            if (field.kind == FieldKind::Seed)
                runtime::member<std::uint64_t>(settings, field) = 0xfedcba9876543210u;
            else if (!setFieldValue(
                         settings, field,
                         field.isWhole() ? field.get(settings, c) + 1 : 0.25 * field.min + 0.75 * field.max,
                         c))
                setFieldValue(settings, field, field.min, c);
        }
    }
    return settings;
}

template <class S>
void expectSame(const S& a, const S& b) {
    for (const auto& field : fieldsOf(a)) {
        for (std::uint32_t c = 0; c < field.components(); ++c)
            EXPECT_EQ(field.get(a, c), field.get(b, c)) << field.name;
    }
}

TEST_F(RuntimeAsset, PointsAreWithinTheErrorThatIsStated) {
    for (const float scale : {0.001f, 1.0f, 20.0f}) {
        Groom groom = helices({2, 3, 17, 64, 512});
        for (Vec3f& p : groom.pointAttributes.edit<Vec3f>(attribute::kPosition)) p *= scale;
        ExportReport report;
        const auto bytes = written(groom, &report);
        const auto opened = runtime::Asset::open(bytes);
        ASSERT_TRUE(opened.asset) << opened.error.words;
        EXPECT_FALSE(opened.asset->check());
        const double stated = opened.asset->greatestError();
        EXPECT_LE(stated, 0.00005);
        const auto strands = opened.asset->strandsAtRest();
        ASSERT_EQ(strands.positions_ss.size(), groom.pointCount());
        double largest = 0;
        for (std::size_t p = 0; p < groom.pointCount(); ++p) {
            const auto& at = strands.positions_ss[p];
            largest = std::max(largest, double{(Vec3f(at.x, at.y, at.z) - groom.positions()[p]).norm()});
        }
        EXPECT_LE(largest, stated + 4e-6 * double{scale}) << "rounding to floats is on top";
        EXPECT_NEAR(report.maxErrorMm.value(), largest * 1e3, 1e-6);
    }
}

TEST_F(RuntimeAsset, StraightHairStaysStraightForTheEngine) {
    const auto bytes = written(dome(6, 1, 24, 0.35f));
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    const auto strands = opened.asset->strandsAtRest();
    runtime::SimulationSettings settings;
    settings.restGravity = 0;  // what holds shape against gravity turns straight hair, too
    const auto made = runtime::Engine::make({strands.offsets, strands.positions_ss}, settings);
    ASSERT_TRUE(made.engine) << made.error;
    EXPECT_EQ(made.engine->plan().reason(runtime::Effect::torsion), runtime::Reason::straightHair);
}

TEST_F(RuntimeAsset, CarriesEverySettingAndSphere) {
    Groom groom = helices({4, 9});
    groom.simulation = otherThanDefault<runtime::SimulationSettings>();
    const runtime::Ramp::Key keys[] = {{0, 0.5f}, {0.25f, 1}, {1, 0.125f}};
    groom.simulation.angularCurve = runtime::Ramp::of(keys);
    ASSERT_TRUE(validate(groom.simulation).empty());
    groom.material = otherThanDefault<HairMaterial>();
    groom.interpolation = otherThanDefault<InterpolationSettings>();
    groom.interpolation.followPerGuide = 3;
    groom.spheres = {{"left", Vec3f(1, 2, 3), 0.25f, "", 1},
                     {"right", Vec3f(-1, 2, 3), 0.5f, "no such bone"}};
    ExportReport report;
    const auto bytes = written(groom, &report);
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    EXPECT_EQ(opened.asset->wispMotion().spread, groom.interpolation.wispSpread);
    EXPECT_EQ(opened.asset->wispMotion().limit, groom.interpolation.wispSpreadLimit);
    const auto back = importStrands(folder / "a.hairrt");
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_TRUE(back->hasSettings);
    EXPECT_EQ(back->groom.simulation, groom.simulation);
    expectSame(back->groom.material, groom.material);
    expectSame(back->groom.interpolation, groom.interpolation);
    ASSERT_EQ(back->groom.spheres.size(), 2u);
    EXPECT_EQ(back->groom.spheres[0].name, "left");
    EXPECT_EQ(back->groom.spheres[0].centre, Vec3f(1, 2, 3));
    EXPECT_EQ(back->groom.spheres[0].joined, 1);
    EXPECT_EQ(back->groom.spheres[1].joined, -1);
    EXPECT_EQ(back->groom.spheres[1].bone, "") << "a bone that the head does not have";
    const auto warned =
        std::ranges::find_if(report.findings, [](const Finding& f) { return f.where == "sphere 'right'"; });
    EXPECT_NE(warned, report.findings.end());
    for (const LeftBehind& left : report.leftBehind)
        EXPECT_THAT(left.what, HasSubstr("attribute")) << left.what;
}

TEST_F(RuntimeAsset, FollowHairsAreThoseOfPictures) {
    Groom groom = wholeGroom();
    groom.interpolation.drawGuides = true;
    ExportReport report;
    const auto bytes = written(groom, &report);
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    const auto strands = opened.asset->strandsAtRest();
    auto made = opened.asset->followHairs(strands);
    ASSERT_TRUE(made.hairs) << made.error;
    const auto shown = bakeFollowHairs(groom, bindFollowHairs(groom, groom.interpolation).value()).value();
    std::vector<runtime::Float3> hairs(shown.pointCount());
    ASSERT_EQ(made.hairs->hairCount(), shown.strandCount());
    runtime::GuideMotion motion;
    motion.positions_ws = strands.positions_ss;
    ASSERT_TRUE(made.hairs->evaluate(motion, hairs));
    for (std::size_t p = 0; p < hairs.size(); ++p)
        ASSERT_LT((Vec3f(hairs[p].x, hairs[p].y, hairs[p].z) - shown.positions()[p]).norm(), 0.0003f) << p;
    const auto compared =
        std::ranges::find(report.attributes, "follow hairs at rest", &ComparedAttribute::name);
    ASSERT_NE(compared, report.attributes.end());
    EXPECT_GT(compared->maxError, 0.0);
}

TEST_F(RuntimeAsset, ResampledStrandsSayHowFarTheirHairsAreOff) {
    StrandExportOptions options;
    options.pointsPerStrand = 5;
    const auto report = strandWriter("runtime").write(wholeGroom(), folder / "a.hairrt", options);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->points, 5 * report->strands);
    const auto compared =
        std::ranges::find(report->attributes, "follow hairs at rest", &ComparedAttribute::name);
    ASSERT_NE(compared, report->attributes.end());
    EXPECT_GT(compared->maxError, 0.0);
    EXPECT_LT(compared->maxError, 0.0003);
}

TEST_F(RuntimeAsset, CarriesLayersTheirDensityAndMaterials) {
    Groom groom = wholeGroom();
    HairMaterial ofFringe = otherThanDefault<HairMaterial>();
    ofFringe.rootRadius = 0.0002f;
    groom.layers = {{"Base", true, false, 1, {}}, {"Fringe \"β\"", true, false, 1.5f, ofFringe}};
    std::vector<std::uint32_t> layers(groom.strandCount(), 0);
    layers[1] = layers[2] = 1;
    groom.strandAttributes.set(attribute::kLayer, layers);
    ExportReport report;
    const auto bytes = written(groom, &report);
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    ASSERT_FALSE(opened.asset->check());
    const auto shown = bakeFollowHairs(groom, bindFollowHairs(groom, groom.interpolation).value()).value();
    EXPECT_EQ(shown.strandCount(), 6 * groom.strandCount() + 2 * 3);
    EXPECT_EQ(opened.asset->hairCount(), shown.strandCount());
    const auto compared =
        std::ranges::find(report.attributes, "follow hairs at rest", &ComparedAttribute::name);
    ASSERT_NE(compared, report.attributes.end());
    EXPECT_LT(compared->maxError, 0.0003);
    const auto back = importStrands(folder / "a.hairrt");
    ASSERT_TRUE(back) << back.error().message();
    ASSERT_EQ(back->groom.layers.size(), 2u);
    EXPECT_EQ(back->groom.layers[1].name, "Fringe \"β\"");
    EXPECT_EQ(back->groom.layers[1].density, 1.5f);
    EXPECT_FALSE(back->groom.layers[0].material);
    ASSERT_TRUE(back->groom.layers[1].material);
    expectSame(*back->groom.layers[1].material, ofFringe);
    const auto ofStrands = back->groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    EXPECT_TRUE(std::ranges::equal(ofStrands, layers));
    for (const LeftBehind& left : report.leftBehind)
        EXPECT_THAT(left.what, testing::Not(HasSubstr("layers")));
    // A game asks for them.
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    std::uint32_t count = 0;
    std::vector<std::uint32_t> ofGuides(layers.size(), 9);
    ASSERT_EQ(hl_asset_layers(asset.get(), &count, ofGuides.data(), ofGuides.size(), nullptr), HL_OK);
    EXPECT_EQ(count, 2u);
    EXPECT_EQ(ofGuides, layers);
    EXPECT_EQ(hl_asset_layers(asset.get(), &count, ofGuides.data(), 1, nullptr), HL_WRONG_SIZE);
    hl_layer fringe{};
    ASSERT_EQ(hl_asset_layer(asset.get(), 1, &fringe, nullptr), HL_OK);
    EXPECT_EQ(std::string(fringe.name, fringe.name_bytes), "Fringe \"β\"");
    EXPECT_EQ(fringe.density, 1.5f);
    EXPECT_EQ(fringe.own_material, 1u);
    EXPECT_FLOAT_EQ(static_cast<float>(asset.number("layer2.rootRadius", 0)), ofFringe.rootRadius);
    EXPECT_EQ(hl_asset_layer(asset.get(), 2, &fringe, nullptr), HL_BAD_VALUE);
    // Thickness of the layer's material stands in the points.
    const float thick = ofFringe.rootRadius;
    const auto radii = back->groom.pointAttributes.view<float>(attribute::kRadius);
    ASSERT_FALSE(radii.empty());
    EXPECT_NEAR(radii[groom.offsets[1]], thick, 0x1p-24f);
    EXPECT_NEAR(radii[groom.offsets[0]], groom.material.rootRadius, 0x1p-24f);
}

TEST_F(RuntimeAsset, AHairstyleOfOneLayerHasItsDensityAndMaterial) {
    Groom groom = wholeGroom();
    std::uint32_t count = 0;
    hl_layer layer{};
    const auto open = [&](game::Asset& asset, const auto& bytes) {
        return asset.open(bytes.data(), bytes.size()) &&
               hl_asset_layers(asset.get(), &count, nullptr, 0, nullptr) == HL_OK &&
               hl_asset_layer(asset.get(), 0, &layer, nullptr) == HL_OK;
    };
    game::Asset plain, own;
    const auto ofPlain = written(groom);
    ASSERT_TRUE(open(plain, ofPlain));
    EXPECT_EQ(count, 1u);
    EXPECT_EQ(layer.name_bytes, 0u);
    EXPECT_EQ(layer.density, 1.0f);
    EXPECT_EQ(layer.own_material, 0u);
    HairMaterial thick = groom.material;
    thick.rootRadius = 0.0003f;
    groom.layers = {{"Base", true, false, 0.5f, thick}};
    const auto ofOwn = written(groom);
    ASSERT_TRUE(open(own, ofOwn));
    EXPECT_EQ(count, 1u);
    EXPECT_EQ(std::string(layer.name, layer.name_bytes), "Base");
    EXPECT_EQ(layer.density, 0.5f);
    EXPECT_EQ(layer.own_material, 1u);
    EXPECT_LT(own.describe().hairs, plain.describe().hairs);
    // Thickness is read from the instance, too.
    game::Instance hair;
    ASSERT_TRUE(hair.make(own, HL_HAIRS));
    std::vector<float> radii(std::size_t{hair.describe().hairs} * hair.describe().points_per_hair);
    ASSERT_EQ(
        hl_instance_read_hairs(hair.get(), game::kNothing, game::kNothing, game::tight(radii, 1), nullptr),
        HL_OK);
    EXPECT_FLOAT_EQ(radii.front(), thick.rootRadius);
}

TEST_F(RuntimeAsset, DensitiesThatLeaveNoHairAreRefused) {
    Groom groom = wholeGroom();
    groom.layers = {{"Base", true, false, 0, {}}};
    const auto refused = strandWriter("runtime").write(groom, folder / "none.hairrt", {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("leave no hair; expected one above 0"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none.hairrt"));
}

TEST_F(RuntimeAsset, LayersThatAreNotThereAreRefused) {
    Groom groom = wholeGroom();
    groom.layers = {{"Base", true, false, 1, {}}, {"Fringe", true, false, 0.5f, {}}};
    std::vector<std::uint32_t> layers(groom.strandCount(), 0);
    layers[1] = 1;
    groom.strandAttributes.set(attribute::kLayer, layers);
    const auto bytes = written(groom);
    const auto damaged = [&](std::string_view kind, std::size_t byte, std::uint16_t value) {
        auto changed = bytes;
        const auto opened = runtime::Asset::open(changed);
        for (const auto& section : opened.asset->sections()) {
            if (section.kind == kind)
                std::memcpy(changed.data() + section.offset + byte, &value, sizeof value);
        }
        const auto again = runtime::Asset::open(changed);
        const auto problem = again.asset->checkContent();
        return problem ? problem->words : "";
    };
    EXPECT_EQ(damaged("SLYR", 0, 1), "");
    EXPECT_THAT(damaged("SLYR", 2, 2), HasSubstr("layer 2 of 2"));
    EXPECT_THAT(damaged("GHRS", 2, 7), HasSubstr("more hairs of a guide"));
    EXPECT_THAT(damaged("LAYR", 2, 0xffff), HasSubstr("layer without name"));
}

TEST_F(RuntimeAsset, SomeStrandsAloneMayBeGuides) {
    Groom groom = wholeGroom();
    std::vector<std::uint8_t> guides(groom.strandCount(), 0);
    guides[1] = guides[4] = guides[7] = guides[9] = 1;
    groom.strandAttributes.set(attribute::kGuide, guides);
    const auto bytes = written(groom);
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    EXPECT_EQ(opened.asset->hairCount(), 24u);
    EXPECT_TRUE(opened.asset->followHairs(opened.asset->strandsAtRest()).hairs);
    EXPECT_EQ(importStrands(folder / "a.hairrt")->groom.guideCount(), 4u);
}

TEST_F(RuntimeAsset, StaysWithinItsSizes) {
    Groom sparse = dome(12, 1, 24, 0.25f);
    ASSERT_GE(sparse.strandCount(), 288u);
    sparse.interpolation.followPerGuide = 104;
    ExportReport report;
    written(sparse, &report);
    EXPECT_LE(report.bytes, 150'000u);
    written(dome(50, 1, 16, 0.3f, 20), &report);
    EXPECT_EQ(report.strands, 100'000u);
    EXPECT_LE(report.bytes, 10'000'000u);
}

TEST_F(RuntimeAsset, ShortAndLonelyStrandsGoThrough) {
    for (const auto& counts : {std::vector<std::uint32_t>{2}, {3}, {2, 2}, {512}}) {
        Groom groom = helices(counts);
        groom.interpolation.followPerGuide = counts.size() == 2 ? 5 : 0;
        const auto bytes = written(groom);
        const auto opened = runtime::Asset::open(bytes);
        ASSERT_TRUE(opened.asset);
        EXPECT_FALSE(opened.asset->check());
        EXPECT_GT(useAll(*opened.asset), 0u);
    }
    const auto refused = [&](const Groom& groom) {
        const auto report = strandWriter("runtime").write(groom, folder / "none.hairrt", {});
        return report ? std::string("written") : report.error().message();
    };
    EXPECT_THAT(refused(Groom()), HasSubstr("no usable strand"));
    EXPECT_THAT(refused(makeGroom({0, 1}, {Vec3f(0, 0, 0)})), HasSubstr("no usable strand"));
    EXPECT_THAT(refused(helices({513})), HasSubstr("512 or fewer: export with --points"));
    EXPECT_THAT(refused(makeGroom({0, 2}, {Vec3f(0, 0, 0), Vec3f(0, 1e8f, 0)})), HasSubstr("32 km"));
    Groom lame = makeGroom({0, 2, 4}, {Vec3f(0, 0, 0), Vec3f(0, 1, 0), Vec3f(1, 0, 0), Vec3f(1, 0, 0)});
    lame.interpolation.followPerGuide = 2;
    EXPECT_THAT(refused(lame), HasSubstr("guide strand 1 has no length"));
    StrandExportOptions inches;
    inches.metresPerUnit = 0.0254f;
    EXPECT_FALSE(strandWriter("runtime").write(helices({4}), folder / "none.hairrt", inches));
    EXPECT_FALSE(std::filesystem::exists(folder / "none.hairrt"));
}

TEST_F(RuntimeAsset, WritesTheSameBytesTwice) {
    const Groom groom = wholeGroom();
    EXPECT_EQ(written(groom), written(groom));
}

TEST_F(RuntimeAsset, NewerFilesAreRefusedAndNewSectionsSkipped) {
    const auto bytes = written(helices({5, 6}));
    AssetBytes copy(bytes);
    copy.header().minor = 9;
    copy.seal();
    EXPECT_TRUE(runtime::Asset::open(copy.span()).asset);
    for (format::Section& section : copy.table()) {
        if (std::string_view(section.kind.data(), 4) == format::kSettings)
            section.kind = {'N', 'E', 'W', '!'};
    }
    copy.seal();
    const auto skipped = runtime::Asset::open(copy.span());
    ASSERT_TRUE(skipped.asset);
    EXPECT_FALSE(skipped.asset->check());
    EXPECT_EQ(skipped.asset->simulation(), runtime::SimulationSettings());
    for (format::Section& section : copy.table()) {
        if (section.kind[0] == 'N') section.flags = format::kRequired;
    }
    copy.seal();
    EXPECT_EQ(runtime::Asset::open(copy.span()).error.kind, AssetError::Kind::newer);
    copy.header().major = 2;
    copy.seal();
    const auto newer = runtime::Asset::open(copy.span());
    EXPECT_EQ(newer.error.kind, AssetError::Kind::newer);
    EXPECT_EQ(newer.error.byte, 8u);
    EXPECT_THAT(newer.error.words, HasSubstr("version 2"));
}

/// A file of version 1.0 as it was first written: what reads it now reads what stood there then.
TEST_F(RuntimeAsset, FilesOfTheFirstVersionAreStillRead) {
    const auto path = sourceDir() / "tests/exporters/files/version_1.hairrt";
    const auto bytes = readFile(path).value();
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset) << opened.error.words;
    ASSERT_FALSE(opened.asset->check());
    const auto strands = opened.asset->strandsAtRest();
    ASSERT_EQ(strands.positions_ss.size(), 192u);
    EXPECT_EQ(opened.asset->strandCount(), 24u);
    EXPECT_EQ(opened.asset->hairCount(), 120u);
    EXPECT_EQ(opened.asset->bones.size(), 3u);
    EXPECT_EQ(opened.asset->spheres.size(), 12u);
    EXPECT_FLOAT_EQ(opened.asset->simulation().windSpeed, 2.5f);
    EXPECT_FLOAT_EQ(opened.asset->simulation().dampingTime, 0.4f);
    EXPECT_FLOAT_EQ(static_cast<float>(opened.asset->numberOf("material.eumelanin", 0)), 0.75f);
    EXPECT_EQ(format::checksum(std::as_bytes(std::span(strands.positions_ss))), 0xf1169f99u);
    const auto hairs = opened.asset->followHairs(strands);
    ASSERT_TRUE(hairs.hairs) << hairs.error;
}

/// Hairs of files from before version 1.2 may cross borders of layers, as they did.
TEST_F(RuntimeAsset, HairsOfOlderFilesAreDrawnAsBefore) {
    Groom groom = wholeGroom();
    const auto weightsOf = [](std::span<const std::byte> bytes) {
        const auto opened = runtime::Asset::open(bytes);
        EXPECT_TRUE(opened.asset);
        return opened.asset->drawnHairs(opened.asset->strandsAtRest()).weights;
    };
    const runtime::Vector<runtime::Float3> ofOneLayer = weightsOf(written(groom));
    groom.layers.resize(2);
    groom.layers[1].name = "Beard";
    std::vector<std::uint32_t> layers(groom.strandCount());
    for (std::uint32_t strand = 0; strand < layers.size(); ++strand) layers[strand] = strand % 2;
    groom.strandAttributes.set(attribute::kLayer, layers);
    AssetBytes copy(written(groom));
    EXPECT_NE(weightsOf(copy.span()), ofOneLayer);
    copy.header().minor = 1;
    copy.seal();
    EXPECT_EQ(weightsOf(copy.span()), ofOneLayer);
}

/// The same of version 1.1, which brought the skin that hair collides with.
TEST_F(RuntimeAsset, FilesOfTheFirstVersionWithSkinAreStillRead) {
    const auto bytes = readFile(sourceDir() / "tests/exporters/files/version_1_1.hairrt").value();
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset) << opened.error.words;
    ASSERT_FALSE(opened.asset->check());
    EXPECT_EQ(opened.asset->minor(), 1u);
    EXPECT_EQ(opened.asset->strandCount(), 24u);
    const auto skin = opened.asset->readBody();
    ASSERT_TRUE(skin.field) << skin.error;
    EXPECT_THAT(skin.field->bones, ElementsAre("head"));
    EXPECT_EQ(opened.asset->bonesOf(*skin.field).size(), 1u);
    const std::vector<std::uint8_t> packed = runtime::packBody(*skin.field);
    EXPECT_EQ(format::checksum(std::as_bytes(std::span(packed))), format::checksum(opened.asset->body()));
}

TEST_F(RuntimeAsset, ChecksumsAreThoseOfZlib) {
    const std::string_view text = "123456789";
    EXPECT_EQ(format::checksum(std::as_bytes(std::span(text))), 0xcbf43926u);
}

}  // namespace
}  // namespace hairloom::test
