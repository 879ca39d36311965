// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/view_file.h"

#include <algorithm>
#include <string_view>

#include "core/base/file.h"
#include "core/groom/file/json_reader.h"
#include "core/render/options.h"
#include "core/shading/marschner.h"
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
    if (reader.has("caustic_width_deg"))
        fibre.causticWidth = reader.number("caustic_width_deg", 0, 60, "degrees") * shading::kDegree;
    if (reader.has("caustic_fade")) fibre.causticFade = reader.number("caustic_fade", 0, 1);
    if (reader.has("caustic_intensity")) fibre.causticIntensity = reader.number("caustic_intensity", 0, 10);
    if (reader.has("azimuthal_solver")) {
        constexpr std::string_view kSolvers[] = {"exact", "cubic"};
        fibre.azimuthalSolver = static_cast<AzimuthalSolver>(reader.choice("azimuthal_solver", kSolvers));
    }
    reader.finish();
}

}  // namespace

Result<ViewFile> readViewFile(const std::string& path,
                              const std::vector<std::filesystem::path>& imageFolders) {
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    return parseViewFile(path, *text, imageFolders);
}

Result<ViewFile> parseViewFile(const std::string& path, std::string_view text,
                               const std::vector<std::filesystem::path>& imageFolders) {
    const auto document = parseJson(path, text);
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
    if (reader.has("shadow_resolution")) {
        view.shadowResolution = static_cast<std::uint32_t>(
            reader.count("shadow_resolution", render::kMinShadowResolution, render::kMaxShadowResolution));
    }
    if (reader.has("shadow_filter")) {
        constexpr std::string_view kFilters[] = {"off", "3x3", "5x5"};
        view.shadowFilter = static_cast<render::ShadowFilter>(reader.choice("shadow_filter", kFilters));
    }
    if (reader.has("shadow")) {
        constexpr std::string_view kKinds[] = {"none", "dom", "absorption", "opacity", "adaptive"};
        view.shadows = static_cast<render::Shadows>(reader.choice("shadow", kKinds));
    }
    if (reader.has("shadow_layers"))
        view.shadowLayers = static_cast<std::uint32_t>(
            reader.count("shadow_layers", render::kMinShadowLayers, render::kMaxShadowLayers));
    if (reader.has("layer_ends")) {
        constexpr std::string_view kEnds[] = {"early", "linear", "growing"};
        view.layerEnds = static_cast<render::LayerEnds>(reader.choice("layer_ends", kEnds));
    }
    if (reader.has("layer_growth"))
        view.layerGrowth = static_cast<float>(
            reader.number("layer_growth", 1, static_cast<double>(render::kMaxLayerGrowth)));
    if (reader.has("shadow_slices"))
        view.shadowSlices =
            static_cast<std::uint32_t>(reader.count("shadow_slices", 1, render::kMaxShadowSlices));
    if (reader.has("shadow_nodes"))
        view.shadowNodes = static_cast<std::uint32_t>(
            reader.count("shadow_nodes", render::kMinShadowNodes, render::kMaxShadowNodes));
    if (reader.has("look")) view.look = reader.string("look");
    if (reader.has("subdivisions"))
        view.subdivisions =
            static_cast<std::uint32_t>(reader.count("subdivisions", 1, render::kMaxSubdivisions));
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

}  // namespace hairloom
