// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/groom_scene.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <filesystem>

#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/geometry/selection.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/move_strands.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "core/interpolation/follow_hairs.h"
#include "core/live/hair_look.h"
#include "core/live/root_rotations.h"
#include "core/simulation/body_push.h"
#include "core/simulation/simulation.h"
#include "importers/foreign_reader.h"

namespace hairloom {
namespace {

constexpr double kMaxCoordinate = 1e6;  // metres

render::Camera readCamera(JsonReader reader) {
    render::Camera camera;
    camera.eye_ws = reader.vector("eye", -kMaxCoordinate, kMaxCoordinate, "m");
    camera.target_ws = reader.vector("target", -kMaxCoordinate, kMaxCoordinate, "m");
    if (reader.has("up")) camera.up_ws = reader.vector("up", -1, 1);
    if (reader.has("orthographic_height")) {
        camera.orthographicHeight =
            static_cast<float>(reader.number("orthographic_height", 1e-4, kMaxCoordinate, "m"));
    } else {
        camera.verticalFov = static_cast<float>(reader.number("fov_y_deg", 1, 150, "degrees"));
    }
    reader.finish();
    return camera;
}

constexpr double kAnyRadiance = 1e6;

/// A view that came from elsewhere opens no other picture of this machine.
Status checkLiesBeside(const std::filesystem::path& image,
                       const std::vector<std::filesystem::path>& folders) {
    std::error_code code;
    const auto asked = std::filesystem::weakly_canonical(image, code);
    for (const std::filesystem::path& folder : folders) {
        const auto at = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, code);
        if (!code && std::ranges::mismatch(at, asked).in1 == at.end()) return {};
    }
    return failIn(image.string(), {}, "is an image outside the folder of the view that names it",
                  "put it beside the view, or name its folder with --images");
}

Result<render::Environment> readEnvironment(JsonReader& reader,
                                            const std::vector<std::filesystem::path>& folders) {
    if (reader.has("radiance")) {
        const Vec3f radiance = reader.vector("radiance", 0, kAnyRadiance);
        return render::Environment::gradient(radiance, radiance);
    }
    if (reader.has("image")) {
        const std::filesystem::path image = folders.front() / reader.string("image");
        const double scale = reader.has("scale") ? reader.number("scale", 0, kAnyRadiance) : 1;
        if (!reader.ok()) return render::Environment();
        if (auto status = checkLiesBeside(image, folders); !status) return tl::unexpected(status.error());
        const auto pixels = readPicture(image, {PictureKind::Png, PictureKind::Exr, PictureKind::Jpeg});
        if (!pixels) return tl::unexpected(pixels.error());
        return render::Environment::fromImage(*pixels, static_cast<float>(scale));
    }
    const Vec3f sky = reader.vector("sky", 0, kAnyRadiance);
    return render::Environment::gradient(sky, reader.vector("ground", 0, kAnyRadiance));
}

void readArea(JsonReader& reader, render::LightKind kind, render::Light& light) {
    light.kind = kind;
    light.position_ws = reader.vector("position", -kMaxCoordinate, kMaxCoordinate, "m");
    const Vec3f facing = reader.vector("facing", -kMaxCoordinate, kMaxCoordinate);
    light.radiance = reader.vector("radiance", 0, kAnyRadiance);
    Vec3f up = reader.has("up") ? reader.vector("up", -1, 1) : Vec3f(Vec3f::UnitY());
    float halfWidth = 0, halfHeight = 0;
    if (kind == render::LightKind::disc) {
        halfWidth = halfHeight = static_cast<float>(reader.number("radius", 1e-4, kMaxCoordinate, "m"));
    } else {
        halfWidth = 0.5f * static_cast<float>(reader.number("width", 1e-4, kMaxCoordinate, "m"));
        halfHeight = 0.5f * static_cast<float>(reader.number("height", 1e-4, kMaxCoordinate, "m"));
    }
    if (!reader.ok()) return;
    if (!(facing.norm() > 0)) {
        reader.complain("facing", "is not a direction", "expected the direction in which the light points");
        return;
    }
    if (!(facing.cross(up).norm() > 1e-4f * facing.norm())) up = Vec3f::UnitX();
    const Vec3f across = up.cross(facing).normalized();
    light.halfAcross_ws = halfWidth * across;
    light.halfUp_ws = halfHeight * facing.normalized().cross(across);
}

Status readLight(JsonReader& reader, const std::vector<std::filesystem::path>& folders, ViewFile& view) {
    static constexpr std::array<std::string_view, 5> kKinds{"directional", "point", "environment",
                                                            "rectangle", "disc"};
    render::Light light;
    const std::size_t kind = reader.choice("type", kKinds);
    if (kind == 2) {
        const auto environment = readEnvironment(reader, folders);
        if (!environment) return tl::unexpected(environment.error());
        view.environment.add(*environment);
        reader.finish();
        return {};
    }
    if (kind > 2) {
        readArea(reader, kind == 3 ? render::LightKind::rectangle : render::LightKind::disc, light);
    } else if (kind == 1) {
        light.kind = render::LightKind::point;
        light.position_ws = reader.vector("position", -kMaxCoordinate, kMaxCoordinate, "m");
        light.intensity = reader.vector("intensity", 0, kAnyRadiance);
    } else {
        light.toLight_ws = reader.vector("to_light", -kMaxCoordinate, kMaxCoordinate);
        light.irradiance = reader.vector("irradiance", 0, kAnyRadiance);
    }
    if (reader.has("shadow")) light.castsShadow = reader.boolean("shadow");
    reader.finish();
    view.lights.push_back(light);
    return {};
}

std::array<double, 3> readAngles(JsonReader& reader, const char* name, double minimum, double maximum) {
    const Vec3f degrees = reader.vector(name, minimum, maximum, "degrees");
    std::array<double, 3> angles{};
    for (int i = 0; i < 3; ++i) {
        angles[static_cast<std::size_t>(i)] = static_cast<double>(degrees[i]) * shading::kDegree;
    }
    return angles;
}

void readHair(JsonReader reader, ViewFile& view) {
    if (reader.has("radius_m")) {
        view.rootRadius = static_cast<float>(reader.number("radius_m", 1e-6, 0.01, "m"));
    }
    if (reader.has("tip_scale")) view.tipScale = static_cast<float>(reader.number("tip_scale", 0, 1));
    FibreView& fibre = view.fibre;
    if (reader.has("ior")) fibre.ior = reader.number("ior", 1, 2.5);
    if (reader.has("sigma_a_per_radius")) {
        fibre.absorption = reader.vector("sigma_a_per_radius", 0, 1000).cast<double>();
    }
    if (reader.has("eumelanin") || reader.has("pheomelanin")) {
        fibre.melanin = shading::Melanin{0, 0};
        if (reader.has("eumelanin")) fibre.melanin->eumelanin = reader.number("eumelanin", 0, 8);
        if (reader.has("pheomelanin")) fibre.melanin->pheomelanin = reader.number("pheomelanin", 0, 8);
    }
    if (reader.has("colour")) fibre.colour = reader.vector("colour", 0, 1).cast<double>();
    if (reader.has("beta_deg")) fibre.width = readAngles(reader, "beta_deg", 0.5, 60);
    if (reader.has("alpha_deg")) fibre.tilt = readAngles(reader, "alpha_deg", -30, 30);
    if (reader.has("azimuthal_roughness")) {
        fibre.azimuthalRoughness = reader.number("azimuthal_roughness", 0, 1);
    }
    if (reader.has("axis_ratio")) fibre.axisRatio = reader.number("axis_ratio", 0.5, 2);
    reader.finish();
}

/// Skin, and where hair grows half its colour: roots too fine to be drawn one by one shade the skin between
/// them. A view's albedo is that of the whole head.
std::vector<Vec3f> headColours(const Groom& groom, const std::optional<Vec3f>& asked) {
    const Vec3f skin = asked.value_or(render::RenderMesh().albedo);
    std::vector<Vec3f> albedo(groom.scalp->triangleCount(), skin);
    if (groom.strandCount() == 0 || asked) return albedo;
    for (const std::uint32_t triangle : groom.scalpSelection) {
        albedo[triangle] = 0.5f * skin + 0.5f * groom.material.rootColour;
    }
    return albedo;
}

/// The same strands are in streaks and dyed, as strands and not the material say.
bool hasSameStreaksAndDye(const HairMaterial& a, const HairMaterial& b) {
    return a.streakShare == b.streakShare && a.streakWidth == b.streakWidth &&
           a.streakSoftness == b.streakSoftness && a.streakSeed == b.streakSeed &&
           a.dyeStrength == b.dyeStrength;
}

}  // namespace

Result<ViewFile> readViewFile(const std::string& path,
                              const std::vector<std::filesystem::path>& imageFolders) {
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto document = parseJson(path, *text);
    if (!document) return tl::unexpected(document.error());
    JsonReader reader(*document, path);
    ViewFile view;
    if (reader.has("camera")) view.camera = readCamera(reader.object("camera"));
    if (reader.has("size")) {
        const auto& size = (*document)["size"];
        const bool pair = size.is_array() && size.size() == 2 && size[0].is_number_unsigned() &&
                          size[1].is_number_unsigned();
        if (!pair) {
            reader.complain("size", "is not a size", "expected [width, height] in pixels");
        } else {
            view.size = {size[0].get<std::uint32_t>(), size[1].get<std::uint32_t>()};
        }
    }
    if (reader.has("lights")) {
        view.hasLights = true;
        std::vector<std::filesystem::path> folders{std::filesystem::path(path).parent_path()};
        folders.insert(folders.end(), imageFolders.begin(), imageFolders.end());
        for (JsonReader& light : reader.objects("lights")) {
            if (auto status = readLight(light, folders, view); !status) return tl::unexpected(status.error());
        }
    }
    if (reader.has("background")) view.background = reader.vector("background", 0, kAnyRadiance);
    if (reader.has("head_albedo")) view.headAlbedo = reader.vector("head_albedo", 0, 1);
    if (reader.has("head_absorption_per_m")) {
        view.headAbsorption = static_cast<float>(reader.number(
            "head_absorption_per_m", 0, static_cast<double>(render::kMaxHeadAbsorption), "1/m"));
    }
    if (reader.has("shadow_blur_px")) {
        view.shadowBlur = static_cast<float>(
            reader.number("shadow_blur_px", 0, static_cast<double>(render::kMaxShadowBlur), "pixels"));
    }
    if (reader.has("hair")) readHair(reader.object("hair"), view);
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return view;
}

Result<GroomScene> GroomScene::make(const Groom& groom, const ViewFile& view,
                                    const std::vector<std::string>& hiddenGroups) {
    GroomScene scene;
    scene.rest_ = scene.posed_ = groom;
    scene.materials_ = strandMaterials(groom, view);
    // The view's radius goes before the points' own.
    if (view.rootRadius || view.tipScale) {
        scene.rest_.pointAttributes.erase(attribute::kRadius);
        scene.posed_.pointAttributes.erase(attribute::kRadius);
    }
    scene.matte_ = view.headAlbedo.has_value();
    if (!groom.scalp && !hiddenGroups.empty()) return fail("there is no head to hide groups of");
    if (groom.scalp) {
        const auto hidden = facesOfGroups(*groom.scalp, hiddenGroups);
        if (!hidden) return tl::unexpected(hidden.error());
        const auto colours = headColours(groom, view.headAlbedo);
        for (const std::uint32_t face : invertSelection(*groom.scalp, *hidden)) {
            const Triangle& triangle = groom.scalp->triangles()[face];
            scene.indices_.insert(scene.indices_.end(), triangle.begin(), triangle.end());
            scene.triangleAlbedo_.push_back(colours[face]);
        }
    }
    if (groom.interpolation.followPerGuide == 0 || groom.strandCount() == 0) {
        scene.push_ = makeBodyPush(groom, groom.offsets.view(), groom.positions());
        scene.materials_.ofStrands = materialsOfStrands(groom);
        if (scene.materials_.hasLook()) scene.weights_ = weightsOfStrands(groom);
        scene.takeWidths();
        scene.clumping_ = render::measureClumping(scene.scene().strands);
        return scene;
    }

    auto bindings = bindFollowHairs(groom, groom.interpolation);
    if (!bindings) return tl::unexpected(bindings.error());
    for (std::size_t hair = 0; hair <= bindings->hairCount(); ++hair) {
        scene.hairOffsets_.push_back(static_cast<std::uint32_t>(hair * bindings->pointsPerHair));
    }
    scene.follow_.emplace(groom, *bindings);
    auto made = runtime::FollowHairs::make(scene.follow_->view());
    if (!made.hairs) return fail(made.error);
    scene.followHairs_ = std::move(made.hairs);
    scene.bindings_ = std::move(*bindings);
    scene.materials_.ofStrands = materialsOfFollowHairs(groom, *scene.bindings_);
    if (scene.materials_.hasLook()) {
        auto weights = weightsOfFollowHairs(groom, *scene.bindings_);
        if (!weights) return tl::unexpected(weights.error());
        scene.weights_ = std::move(*weights);
    }
    scene.makeFollowHairs({}, {});
    scene.takeWidths();
    scene.push_ = makeBodyPush(groom, scene.hairOffsets_, scene.hairPositions_ws_);
    scene.clumping_ = render::measureClumping(scene.scene().strands);
    return scene;
}

void GroomScene::pose(std::span<const Vec3f> positions_ws, std::span<const Vec3f> velocities_ws,
                      const HeadPose& pose) {
    posed_ = posedGroom(rest_, positions_ws, pose);
    if (bindings_) return makeFollowHairs(velocities_ws, pose);
    if (!push_) return;
    std::vector<Vec3f> drawn(positions_ws.begin(), positions_ws.end());
    pushOutOfBody(*push_, rest_, pose, drawn);
    posed_.pointAttributes.set(attribute::kPosition, std::move(drawn));
}

void GroomScene::moveStrands(std::span<const std::uint32_t> strands, std::span<const Vec3f> points_ws) {
    assert(!bindings_);
    hairloom::moveStrands(posed_, strands, points_ws);
}

bool GroomScene::setMaterials(const Groom& groom, const ViewFile& view) {
    const HairMaterial &authored = groom.material, &before = rest_.material;
    if (authored.rootColour != before.rootColour || !hasSameStreaksAndDye(authored, before)) return false;
    const bool sameOwners =
        std::ranges::equal(groom.layers, rest_.layers, [](const Layer& a, const Layer& b) {
            return a.material.has_value() == b.material.has_value() &&
                   (!a.material || hasSameStreaksAndDye(*a.material, *b.material));
        });
    if (!sameOwners) return false;
    rest_.material = authored;
    rest_.layers = groom.layers;
    StrandMaterials now = strandMaterials(rest_, view);
    now.ofStrands = std::move(materials_.ofStrands);
    materials_ = std::move(now);
    makeRadii();
    return true;
}

bool GroomScene::setDye(const Groom& groom) {
    if (weights_.pointDyes.empty() || !groom.pointAttributes.has(attribute::kPointDye)) return false;
    rest_.pointAttributes.set(attribute::kPointDye,
                              groom.pointAttributes.all().find(attribute::kPointDye)->second);
    weights_.pointDyes = bindings_ ? pointDyesOfFollowHairs(rest_, *bindings_) : pointDyes(rest_);
    return true;
}

bool GroomScene::setWidths(const Groom& groom) {
    if (widthChanges_.empty() || !groom.pointAttributes.has(attribute::kWidthChange)) return false;
    rest_.pointAttributes.set(attribute::kWidthChange,
                              groom.pointAttributes.all().find(attribute::kWidthChange)->second);
    takeWidths();
    return hasPaintedWidths();
}

void GroomScene::takeWidths() {
    const auto changes = widthChanges(rest_);
    widthChanges_ = changes.empty() ? std::vector<float>()
                    : bindings_     ? followHairValues(rest_, *bindings_, changes)
                                    : std::vector<float>(changes.begin(), changes.end());
    makeRadii();
}

void GroomScene::makeRadii() {
    radii_.clear();
    if (widthChanges_.empty() || posed_.strandCount() == 0) return;
    radii_ = paintedRadii(scene().strands.front(), widthChanges_);
}

void GroomScene::makeFollowHairs(std::span<const Vec3f> velocities_ws, const HeadPose& pose) {
    const auto asEngine = [](std::span<const Vec3f> values) {
        static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
        return std::span(reinterpret_cast<const runtime::Float3*>(values.data()), values.size());
    };
    static_assert(sizeof(Quatf) == sizeof(runtime::Quat));
    const std::vector<Quatf> rotations = rootRotations(rest_, posed_, pose);
    hairPositions_ws_.resize(follow_->hairCount() * follow_->pointsPerHair());
    runtime::GuideMotion guides;
    guides.positions_ws = asEngine(posed_.positions());
    guides.velocities_ws = asEngine(velocities_ws);
    guides.rootRotations_ws = {reinterpret_cast<const runtime::Quat*>(rotations.data()), rotations.size()};
    runtime::Host host;
    host.parallelFor = parallelFor;
    followHairs_->evaluate(
        guides, {reinterpret_cast<runtime::Float3*>(hairPositions_ws_.data()), hairPositions_ws_.size()},
        host);
    if (push_) pushOutOfBody(*push_, rest_, pose, hairPositions_ws_);
}

render::RenderScene GroomScene::scene() const {
    render::RenderScene scene;
    if (!indices_.empty()) {
        render::RenderMesh mesh;
        mesh.positions_ws = posed_.scalp->positions();
        mesh.normals_ws = posed_.scalp->normals();
        mesh.indices = indices_;
        mesh.triangleAlbedo = triangleAlbedo_;
        mesh.matte = matte_;
        scene.meshes.push_back(mesh);
    }
    if (posed_.strandCount() == 0) return scene;
    scene.clumping = clumping_;
    render::RenderStrands strands;
    strands.material = materials_.material;
    strands.others = materials_.others;
    strands.materials = materials_.ofStrands;
    if (hairOffsets_.empty()) {
        strands.offsets = posed_.offsets.view();
        strands.positions_ws = posed_.positions();
        strands.radii = posed_.pointAttributes.view<float>(attribute::kRadius);
        strands.colours = posed_.strandAttributes.view<Vec3f>(attribute::kStrandColour);
    } else {
        strands.offsets = hairOffsets_;
        strands.positions_ws = hairPositions_ws_;
    }
    if (!radii_.empty()) strands.radii = radii_, strands.radiiOfAll = true;
    strands.streaks = weights_.streaks;
    strands.dyes = weights_.dyes;
    strands.pointDyes = weights_.pointDyes;
    scene.strands.push_back(strands);
    return scene;
}

Box3f GroomScene::subject() const {
    render::RenderScene hair = scene();
    hair.meshes.clear();
    Box3f box = render::boundsOf(hair);
    Box3f all = box;
    for (const std::uint32_t vertex : indices_) all.extend(posed_.scalp->positions()[vertex]);
    if (box.isEmpty() || !posed_.scalp) return all;
    for (const std::uint32_t triangle : posed_.scalpSelection) {
        for (const std::uint32_t vertex : posed_.scalp->triangles()[triangle]) {
            box.extend(posed_.scalp->positions()[vertex]);
        }
    }
    // Short hair covers the upper half of a head; a picture of it shows the face too.
    constexpr float kHeadHeight = 0.27f;
    box.min().y() = std::min(box.min().y(), box.max().y() - kHeadHeight);
    return box.intersection(all);
}

}  // namespace hairloom
