// SPDX-License-Identifier: GPL-3.0-or-later
// The runtime asset .hairrt (docs/formats/runtime.md): what hairloom's library for games plays.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/groom/file/fields.h"
#include "core/groom/point_width.h"
#include "core/groom/strand_subset.h"
#include "core/interpolation/follow_hairs.h"
#include "exporters/asset_clip.h"
#include "exporters/asset_extras.h"
#include "exporters/asset_poses.h"
#include "exporters/asset_scalp.h"
#include "exporters/prepared_strands.h"
#include "hairloom/asset.h"
#include "hairloom/follow_recipe.h"

namespace hairloom {
namespace {

/// Half the diameters where they are not what the material says; else empty.
std::vector<std::uint16_t> ownRadii(const Groom& groom, const PreparedStrands& strands) {
    std::vector<std::uint16_t> radii;
    bool own = false;
    for (std::size_t s = 0; s < strands.strandCount(); ++s) {
        const std::uint32_t first = strands.offsets[s], last = strands.offsets[s + 1] - 1;
        for (std::uint32_t p = first; p <= last; ++p) {
            const float radius = 0.5f * strands.thickness[p] / asset::kRadiusStep;
            const float t = static_cast<float>(p - first) / static_cast<float>(last - first);
            const float usual = groom.material.rootRadius * (1.0f + t * (groom.material.tipScale - 1.0f)) /
                                asset::kRadiusStep;
            own = own || std::abs(radius - usual) > 1.0f;
            radii.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(radius, 0.0f, 65535.0f))));
        }
    }
    return own ? radii : std::vector<std::uint16_t>();
}

/// How follow hairs come from the strands that are written.
struct FollowSections {
    std::optional<FollowBindings> bindings;
    std::vector<asset::Guide> guides;
    std::vector<std::uint16_t> hairs;  ///< of each guide, where they have not all as many
    std::vector<asset::GuideTriangle> triangles;
    std::vector<std::int8_t> shifts;
    std::vector<asset::FarRootShift> farShifts;
    asset::Recipe recipe{};
};

/// Farther from where the runtime's direction leads, a root has its own shift: at the border of the scalp,
/// say.
constexpr float kFarRoot = 0.00025f;

/// Of each hair's root along the one direction that the runtime knows; the step between two of them.
float addShifts(const FollowBindings& bindings, FollowSections& sections) {
    std::vector<runtime::RootPlane> planes;
    for (const Mat3f& frame : bindings.rootFrames) {
        const auto column = [&](int c) { return runtime::Float3{frame(0, c), frame(1, c), frame(2, c)}; };
        planes.push_back({column(0), column(1), column(2)});
    }
    std::vector<float> along;
    float largest = 0;
    for (std::size_t hair = 0; hair < bindings.hairCount(); ++hair) {
        const Vec3f &root = bindings.rootWeights[hair], &given = bindings.rootShifts[hair];
        const runtime::Float3 shift{given.x(), given.y(), given.z()};
        const runtime::Float3 direction =
            runtime::shiftDirection(planes, bindings.guides[hair], {root.x(), root.y(), root.z()});
        along.push_back(runtime::dot(direction, shift));
        if (runtime::length(shift - direction * along.back()) > kFarRoot) {
            const auto steps = [](float metres) {
                return static_cast<std::int16_t>(
                    std::lround(std::clamp(metres / asset::kFarShiftStep, -32767.0f, 32767.0f)));
            };
            sections.farShifts.push_back(
                {static_cast<std::uint32_t>(hair), {steps(shift.x), steps(shift.y), steps(shift.z)}, 0});
            along.back() = 0;
        }
        largest = std::max(largest, std::abs(along.back()));
    }
    const float step = largest / 127.0f;
    if (!(step > 0)) return 0;
    for (const float distance : along)
        sections.shifts.push_back(static_cast<std::int8_t>(std::lround(distance / step)));
    return step;
}

Result<FollowSections> followSections(const Groom& groom, const PreparedStrands& strands) {
    FollowSections sections;
    const InterpolationSettings& settings = groom.interpolation;
    if (settings.followPerGuide == 0) return sections;
    auto bound = bindFollowHairs(groom, settings);
    if (!bound) return tl::unexpected(bound.error());
    std::vector<std::uint32_t> written(groom.strandCount(), 0xffffffffu);
    for (std::uint32_t s = 0; s < strands.strandCount(); ++s) written[strands.sources[s]] = s;
    const FollowBindings& bindings = *bound;
    for (std::size_t g = 0; g < bindings.guideCount(); ++g) {
        const std::uint32_t strand = written[bindings.guideStrands[g]];
        if (strand == 0xffffffffu)
            return fail(fmt::format("guide strand {} has no length", bindings.guideStrands[g]),
                        "expected guides that can be simulated: remove it, or draw it again");
        const Mat3f& frame = bindings.rootFrames[g];
        sections.guides.push_back({strand,
                                   bindings.ids[g],
                                   {frame(0, 2), frame(1, 2), frame(2, 2)},
                                   {frame(0, 0), frame(1, 0), frame(2, 0)}});
    }
    for (std::size_t t = 0; t < bindings.triangles.size(); ++t)
        sections.triangles.push_back({bindings.triangles[t], bindings.areas[t]});
    const std::uint32_t most = *std::ranges::max_element(bindings.hairs);
    if (most == 0) return fail("the densities of all layers leave no hair", "expected one above 0");
    if (std::ranges::any_of(bindings.hairs, [&](std::uint32_t hairs) { return hairs != most; })) {
        for (const std::uint32_t hairs : bindings.hairs)
            sections.hairs.push_back(static_cast<std::uint16_t>(hairs));
    }
    const PartingSettings parting;
    std::uint32_t points = 0;
    for (const asset::Guide& guide : sections.guides)
        points = std::max(points, strands.offsets[guide.strand + 1] - strands.offsets[guide.strand]);
    const float step = addShifts(bindings, sections);
    sections.recipe = {settings.seed,
                       most,
                       points,
                       settings.wispRadiusRoot,
                       settings.wispRadiusTip,
                       settings.blend,
                       step,
                       parting.beginAngleDegrees,
                       parting.endAngleDegrees,
                       parting.beginSpread,
                       parting.endSpread};
    sections.bindings = std::move(*bound);
    return sections;
}

/// The follow hair that is farthest from the one that pictures show.
struct FarthestHair {
    double metres = 0;
    std::size_t hair = 0, point = 0, points = 0;
    bool resampled = false;  ///< then ends alone are compared
};

/// More is told as a warning.
constexpr double kFarHair = 5e-4;

Result<FarthestHair> followError(const Groom& groom, const FollowBindings& bindings,
                                 const runtime::Asset& asset) {
    const auto shown = bakeFollowHairs(groom, bindings);
    if (!shown) return tl::unexpected(shown.error());
    const auto strands = asset.strandsAtRest();
    runtime::Host host;
    host.parallelFor = parallelFor;
    auto played = asset.followHairs(strands, host);
    if (!played.hairs) return tl::unexpected(errorOfWords(played.error));
    const std::size_t points = played.hairs->pointsPerHair(), shownPoints = bindings.pointsPerHair;
    std::vector<Vec3f> positions(played.hairs->hairCount() * points);
    runtime::GuideMotion motion;
    motion.positions_ws = strands.positions_ss;
    played.hairs->evaluate(motion, {reinterpret_cast<runtime::Float3*>(positions.data()), positions.size()},
                           host);
    FarthestHair farthest{.points = points, .resampled = points != shownPoints};
    for (std::size_t hair = 0; hair < bindings.hairCount(); ++hair) {
        const auto compare = [&](std::size_t p, std::size_t shownPoint) {
            const Vec3f apart = positions[hair * points + p] - shown->strand(hair)[shownPoint];
            const double metres{apart.norm()};
            if (metres > farthest.metres) farthest.metres = metres, farthest.hair = hair, farthest.point = p;
        };
        compare(0, 0);
        compare(points - 1, shownPoints - 1);
        for (std::size_t p = 1; p < points && points == shownPoints; ++p) compare(p, p);
    }
    return farthest;
}

/// What a hair that is far off is off by, and what to do.
Finding farHairFinding(const FarthestHair& far) {
    const char *why =
                   "its guides' points are quantised, and how it is shared among guides that part depends "
                   "on them",
               *fix = "lower interpolation.blend, or look at this hair in the game";
    if (far.resampled) {
        why = "strands were resampled", fix = "export without --points";
    } else if (far.point == 0) {
        why = "its root lies farther from where its guides lead than the asset can say";
        fix = "place guides closer together there";
    }
    const std::string place = far.point == 0                ? "root"
                              : far.point + 1 == far.points ? "tip"
                                                            : fmt::format("point {}", far.point);
    return {Severity::Warning,
            fmt::format("hair {} is {:.2g} mm from that of rendered images at its {}: {}", far.hair,
                        far.metres * 1e3, place, why),
            "follow hairs", fix};
}

Status checkOptions(const StrandExportOptions& options) {
    if (options.metresPerUnit != 1.0f || options.up != UpAxis::Y)
        return fail("a runtime asset with another unit or axis was requested",
                    "expected neither --output-unit nor --up: it is in metres, Y up");
    if (options.clip && options.pointsPerStrand > 0)
        return fail("a clip was requested of strands with other points than the groom's",
                    "expected no --points");
    return {};
}

Status checkPoints(const PreparedStrands& strands) {
    for (std::size_t s = 0; s < strands.strandCount(); ++s) {
        const std::uint32_t points = strands.offsets[s + 1] - strands.offsets[s];
        if (points > runtime::kMaxPoints)
            return fail(fmt::format("strand {} has {} points", strands.sources[s], points),
                        fmt::format("expected {} or fewer: export with --points", runtime::kMaxPoints));
    }
    return {};
}

Finding clipFinding(const AssetClip& clip, std::size_t points, double error) {
    const double frames = clip.record.frames;
    const auto bytes = static_cast<double>(clip.frames.size() + clip.places.size() * sizeof(std::uint32_t));
    return {Severity::Info,
            fmt::format("the clip's {} frames take {:.2f} bytes a point, at most {:.2g} mm from the take",
                        clip.record.frames, bytes / (frames * static_cast<double>(points)), error * 1e3),
            "clip", ""};
}

Finding posesFinding(const AssetPoses& poses, double error) {
    const auto bytes =
        static_cast<double>(poses.directions.size() * sizeof(asset::PoseDirection) + poses.weights.size());
    return {Severity::Info,
            fmt::format("{} poses take {:.2f} MB, at most {:.2g} mm from their shape. The game sets their "
                        "amounts: keys of them are not in the asset",
                        poses.records.size(), bytes * 1e-6, error * 1e3),
            "poses", ""};
}

Finding gridFinding(const runtime::Asset& asset) {
    return {
        Severity::Info,
        fmt::format("points are quantised, at most {:.2g} mm from their place", asset.greatestError() * 1e3),
        "points", ""};
}

/// What follows from bytes that are already the file's: the content as the runtime takes it.
Status addFindings(const Groom& groom, const FollowSections& follow, const runtime::Asset& asset,
                   ExportReport& report) {
    report.findings.push_back(gridFinding(asset));
    if (!follow.bindings) return {};
    const auto error = followError(groom, *follow.bindings, asset);
    if (!error) return tl::unexpected(error.error());
    report.attributes.push_back({"follow hairs at rest", error->metres});
    if (error->metres > kFarHair) report.findings.push_back(farHairFinding(*error));
    report.findings.push_back({Severity::Info,
                               fmt::format("{} follow hairs are generated when the asset is loaded, at most "
                                           "{:.2g} mm from those of rendered images",
                                           asset.hairCount(), error->metres * 1e3),
                               "follow hairs", ""});
    if (!widthChanges(groom).empty()) {
        report.findings.push_back({Severity::Warning,
                                   "painted widths are those of the guides: follow hairs that the runtime "
                                   "generates have the material's",
                                   "width", "export the follow hairs themselves"});
    }
    return {};
}

void addLayers(const Groom& groom, const PreparedStrands& strands, AssetBuilder& builder) {
    const bool plain = groom.layers.size() == 1 && groom.layers[0].density == 1 && !groom.layers[0].material;
    if (groom.layers.empty() || plain) return;
    std::vector<asset::Layer> layers;
    for (const Layer& layer : groom.layers) {
        layers.push_back({builder.text(layer.name), layer.density, layer.material ? 1u : 0u});
        if (layer.material) builder.addSettings(fmt::format("layer{}", layers.size()), *layer.material);
    }
    const std::vector<std::uint32_t> all = layersOfStrands(groom);
    std::vector<std::uint16_t> ofStrands;
    for (const std::uint32_t source : strands.sources)
        ofStrands.push_back(static_cast<std::uint16_t>(all[source]));
    builder.add<asset::Layer>(asset::kLayers, layers);
    builder.add<std::uint16_t>(asset::kStrandLayers, ofStrands);
}

/// What an asset may have beside hair that can be simulated; null: none.
struct AssetParts {
    MeasuredLevels levels{};
    std::string clipName{};
    const AssetClip* clip = nullptr;
    const HairLooks* looks = nullptr;
    const AssetPoses* poses = nullptr;
};

void addPoses(const AssetPoses& poses, AssetBuilder& builder) {
    std::vector<asset::Pose> records = poses.records;
    for (std::size_t k = 0; k < records.size(); ++k) records[k].name = builder.text(poses.names[k]);
    builder.add<asset::Pose>(asset::kPoses, records);
    builder.add<asset::PoseDirection>(asset::kPoseDirections, poses.directions);
    builder.add<std::uint8_t>(asset::kPoseWeights, poses.weights);
}

Result<std::vector<std::byte>> buildAsset(const Groom& groom, PreparedStrands& strands,
                                          const FollowSections& follow,
                                          const std::optional<SafeLimits>& safeLimits,
                                          const AssetParts& parts,
                                          std::vector<std::uint32_t>* scalpVertices = nullptr) {
    const auto encoded = encodeStrands(strands.offsets, strands.positions);
    if (!encoded) return tl::unexpected(encoded.error());
    AssetBuilder builder;
    builder.add<asset::Strand>(asset::kStrands, encoded->strands);
    builder.add<std::byte>(asset::kResiduals, encoded->residuals);
    const AssetScalp scalp = collectScalp(groom, strands.sources, builder);
    builder.add<asset::Root>(asset::kRoots, scalp.roots);
    builder.add<asset::ScalpVertex>(asset::kScalpVertices, scalp.vertices);
    if (scalpVertices) *scalpVertices = scalp.sources;
    builder.add<asset::ScalpTriangle>(asset::kScalpTriangles, scalp.triangles);
    builder.add<asset::Bone>(asset::kBones, scalp.bones);
    builder.add<asset::Sphere>(asset::kSpheres, scalp.spheres);
    builder.add<std::uint8_t>(asset::kBody, scalp.body);
    strands.findings.insert(strands.findings.end(), scalp.findings.begin(), scalp.findings.end());
    if (follow.bindings) {
        builder.add<asset::Recipe>(asset::kRecipe, std::span(&follow.recipe, 1));
        builder.add<asset::Guide>(asset::kGuides, follow.guides);
        builder.add<std::uint16_t>(asset::kGuideHairs, follow.hairs, asset::kRequired);
        builder.add<asset::GuideTriangle>(asset::kGuideTriangles, follow.triangles);
        builder.add<std::int8_t>(asset::kRootShifts, follow.shifts);
        builder.add<asset::FarRootShift>(asset::kFarRootShifts, follow.farShifts);
    }
    builder.add<std::uint16_t>(asset::kRadii, ownRadii(groom, strands));
    addLayers(groom, strands, builder);
    addAttributes(groom, strands, builder);
    builder.add<asset::MeasuredLevel>(asset::kLevelErrors, parts.levels.paths);
    builder.add<asset::MeasuredLevel>(asset::kSeenErrors, parts.levels.seen);
    if (parts.clip) {
        asset::Clip record = parts.clip->record;
        record.name = builder.text(parts.clipName);
        builder.add<asset::Clip>(asset::kClip, std::span(&record, 1));
        builder.add<std::uint32_t>(asset::kClipPlaces, parts.clip->places);
        builder.add<std::byte>(asset::kClipFrames, parts.clip->frames);
    }
    if (parts.looks) {
        builder.add<asset::Material>(asset::kMaterials, parts.looks->materials);
        builder.add<std::uint16_t>(asset::kFibreTables, parts.looks->tables);
        if (follow.bindings) builder.add<asset::HairLook>(asset::kHairLooks, parts.looks->hairs);
    }
    if (parts.poses) addPoses(*parts.poses, builder);
    builder.addSettings("simulation", groom.simulation);
    builder.addSettings("material", groom.material);
    builder.addSettings("interpolation", groom.interpolation);
    if (safeLimits) builder.addSettings("certificate", *safeLimits);
    Box3f bounds;
    for (const Vec3f& position : strands.positions) bounds.extend(position);
    return builder.finish(bounds, static_cast<std::uint32_t>(strands.positions.size()));
}

Result<ExportReport> writeRuntime(const Groom& groom, const std::filesystem::path& path,
                                  const StrandExportOptions& options) {
    const auto here = [&](const Error& error) { return tl::unexpected(inFile(error, path.string())); };
    if (auto status = checkOptions(options); !status) return here(status.error());
    auto strands = prepareStrands(groom, options, options.pointsPerStrand);
    if (!strands) return here(strands.error());
    if (auto status = checkPoints(*strands); !status) return here(status.error());
    const auto follow = followSections(groom, *strands);
    if (!follow) return here(follow.error());
    // Levels are measured on the asset without them; findings are told once.
    PreparedStrands unmeasured = *strands;
    std::vector<std::uint32_t> scalpVertices;
    const auto plain = buildAsset(groom, unmeasured, *follow, options.safeLimits, {}, &scalpVertices);
    if (!plain) return here(plain.error());
    std::optional<AssetClip> encoded;
    if (options.clip) {
        auto made = encodeClip(*options.clip, *strands, groom, *runtime::Asset::open(*plain).asset,
                               scalpVertices, options.watch.part(0, 0.3));
        if (!made) return here(made.error());
        encoded = std::move(*made);
    }
    const AssetPoses poses = encodePoses(groom, *strands);
    const auto bytes = buildAsset(groom, *strands, *follow, options.safeLimits,
                                  {measureLevels(*plain), options.clip ? options.clip->name : std::string(),
                                   encoded ? &*encoded : nullptr, options.looks.get(), &poses});
    if (!bytes) return here(bytes.error());
    strands->holdsPoses = true;
    std::vector<Finding> ofPoses = poses.findings;
    double posesError = 0;
    if (const auto file = runtime::Asset::open(*bytes); file.asset && !poses.records.empty()) {
        posesError = poseError(groom, *strands, *file.asset);
        ofPoses.push_back(posesFinding(poses, posesError));
    }
    Finding ofClip;
    double clipError = 0;
    if (encoded) {
        const auto error = playedClipError(*options.clip, *strands, groom, *bytes, scalpVertices,
                                           options.watch.part(0.3, 0.5));
        if (!error) return here(error.error());
        clipError = *error;
        const double stated{encoded->record.largestError};
        if (!(clipError <= stated))
            return failIn(path.string(), {},
                          fmt::format("the clip is {:.3g} mm off when it is played", clipError * 1e3),
                          fmt::format("expected at most the {:.3g} mm of its frames", stated * 1e3));
        ofClip = clipFinding(*encoded, strands->positions.size(), clipError);
    }
    auto report = writeAndCompare(groom, std::move(*strands), options, path, *bytes);
    if (!report) return report;
    const auto opened = runtime::Asset::open(*bytes);
    if (!opened.asset) return failIn(path.string(), Byte{opened.error.byte}, opened.error.words);
    if (auto status = addFindings(groom, *follow, *opened.asset, *report); !status)
        return here(status.error());
    if (options.looks)
        report->findings.insert(report->findings.end(), options.looks->findings.begin(),
                                options.looks->findings.end());
    if (!poses.records.empty()) report->attributes.push_back({"poses", posesError});
    report->findings.insert(report->findings.end(), ofPoses.begin(), ofPoses.end());
    if (encoded) {
        report->frames = static_cast<std::size_t>(options.clip->frames);
        report->attributes.push_back({"clip", clipError});
        report->findings.push_back(std::move(ofClip));
    }
    return report;
}

}  // namespace

HairWriter runtimeWriter() {
    return {
        "runtime",
        "Hairloom runtime asset .hairrt",
        "root bindings, the head's bones, spheres, the skin collider, settings, layers, poses, materials, "
        "tables of "
        "Marschner's shading, attributes of strands "
        "and how "
        "follow hairs come from guides",
        "512 points per strand",
        {{"game", "Game by Hairloom's runtime", ".hairrt in metres, Y up, for the library in runtime/", {}}},
        writeRuntime,
        "hairrt",
        true,
        false,
        false,
        false,
        true,
        false,
        true};
}

}  // namespace hairloom
