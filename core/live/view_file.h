// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// View files (--view): camera, lights and looks of a picture.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/groom/material.h"
#include "core/render/camera.h"
#include "core/render/environment.h"
#include "core/render/fibre_material.h"
#include "core/render/light.h"
#include "core/render/options.h"
#include "core/shading/melanin.h"

namespace hairloom {

/// How a view sees light in fibres; what it does not say comes from the groom.
struct FibreView {
    std::optional<render::ShadingModel> model;
    render::Scattering scattering = render::Scattering::volume;  ///< the caller's, not the groom's
    std::optional<double> ior;
    std::optional<Vec3d> absorption;  ///< RGB per fibre radius
    std::optional<shading::Melanin> melanin;
    std::optional<Vec3d> colour;                       ///< linear RGB of much hair
    std::optional<std::array<double, 3>> width, tilt;  ///< of R, TT, TRT in radians of θ_h
    std::optional<double> azimuthalRoughness;
    std::optional<double> axisRatio;
    std::optional<double> causticWidth;  ///< radians
    std::optional<double> causticFade, causticIntensity;
    std::optional<AzimuthalSolver> azimuthalSolver;

    bool saysColour() const { return absorption || melanin || colour; }
};

/// What a view file (--view) says; docs/cli.md lists its members.
struct ViewFile {
    std::optional<render::Camera> camera;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> size;
    bool hasLights = false;  ///< then there is no light besides what follows
    std::vector<render::Light> lights;
    render::Environment environment;
    std::optional<Vec3f> background;  ///< linear RGB
    std::optional<Vec3f> headAlbedo;
    std::optional<float> rootRadius;  ///< metres
    std::optional<float> tipScale;
    // As render::RenderOptions has them.
    std::optional<render::Shadows> shadows;
    std::optional<std::uint32_t> shadowResolution;  ///< pixels
    std::optional<render::ShadowFilter> shadowFilter;
    std::optional<std::uint32_t> shadowLayers, shadowSlices, shadowNodes;
    std::optional<render::LayerEnds> layerEnds;
    std::optional<float> layerGrowth;
    std::optional<std::uint32_t> subdivisions;  ///< likewise
    std::optional<float> headAbsorption;        ///< 1/m, as render::RenderOptions
    std::optional<float> shadowBlur;            ///< pixels, likewise
    FibreView fibre;
    std::string look;  ///< name of a look that the groom's material gets; empty: its own
};
/// Images that it names are read, too: they lie in its own folder and below it, or in `imageFolders`.
/// Errors: what is wrong in the file, or in such an image.
Result<ViewFile> readViewFile(const std::string& path,
                              const std::vector<std::filesystem::path>& imageFolders = {});
/// The same of a text that was read from `path`.
Result<ViewFile> parseViewFile(const std::string& path, std::string_view text,
                               const std::vector<std::filesystem::path>& imageFolders = {});

}  // namespace hairloom
