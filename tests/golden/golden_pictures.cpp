// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/golden/golden_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/documents/sample.h"
#include "core/documents/sample_material.h"
#include "core/render/png.h"
#include "core/render/tone_map.h"
#include "tests/support/source_dir.h"

namespace hairloom::golden {
namespace {

using render::PostFilter;
using render::ShadingModel;
using render::Shadows;

/// Quick to draw: few hairs, one frame, and without chance, which other devices may throw otherwise.
render::RenderOptions quick() {
    render::RenderOptions options;
    options.width = options.height = kSize;
    options.samples = 4;
    options.frames = 1;
    options.transparency = render::Transparency::weighted;
    options.ribbons = render::Ribbons::strip;  // on all devices
    options.subdivisions = 1;
    options.shadowResolution = 256;
    options.exposure = 1.6f;
    return options;
}

/// Strands 0, n, 2n … on the same head.
Groom thinnedOut(const Groom& groom, std::size_t n) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::size_t s = 0; s < groom.strandCount(); s += n) {
        const auto strand = groom.strand(s);
        positions.insert(positions.end(), strand.begin(), strand.end());
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom thin = makeGroom(std::move(offsets), std::move(positions));
    thin.scalp = groom.scalp;
    thin.scalpSelection = groom.scalpSelection;
    thin.material = groom.material;
    thin.interpolation = groom.interpolation;
    return thin;
}

template <class Change>
Case varied(const std::string& name, const Change& change) {
    Case which;
    which.name = name;
    which.sample = "shoulder";
    which.model = ShadingModel::marschner;
    which.options = quick();
    change(which);
    return which;
}

}  // namespace

std::vector<Case> cases() {
    std::vector<Case> list;
    for (const char* const sample : {"long", "short", "shoulder"}) {
        for (const auto& [name, model] :
             {std::pair{"kajiya", ShadingModel::kajiya}, std::pair{"marschner", ShadingModel::marschner},
              std::pair{"sadeghi", ShadingModel::sadeghi}}) {
            Case which;
            which.name = std::string(sample) + "-" + name;
            which.sample = sample;
            which.model = model;
            which.options = quick();
            list.push_back(which);
        }
    }
    const auto add = [&](const std::string& name, const auto& change) {
        list.push_back(varied("shoulder-" + name, change));
    };
    add("single", [](Case& c) { c.scattering = render::Scattering::single; });
    add("volume", [](Case& c) { c.scattering = render::Scattering::volume; });
    add("no-shadows", [](Case& c) { c.options.shadows = Shadows::none; });
    add("absorption", [](Case& c) { c.options.shadows = Shadows::absorption; });
    add("opacity-maps", [](Case& c) { c.options.shadows = Shadows::opacityMaps; });
    const auto stochastic = [](Case& c) { c.options.transparency = render::Transparency::stochastic; };
    add("averaged", [&](Case& c) {
        stochastic(c);
        c.options.frames = 8;
    });
    add("kernels", [&](Case& c) {
        stochastic(c);
        c.options.frames = 8;
        c.options.ribbons = render::Ribbons::compute;
    });
    add("no-aa", [](Case& c) { c.options.samples = 1; });
    add("fxaa-hq", [](Case& c) {
        c.options.samples = 1;
        c.options.filter = PostFilter::fxaaHigh;
    });
    add("streaked", [](Case& c) { c.material = "streaked"; });
    add("streaked-sadeghi", [](Case& c) {
        c.material = "streaked";
        c.model = ShadingModel::sadeghi;
    });
    add("fire", [](Case& c) {
        c.material = "fire";
        c.model = ShadingModel::kajiya;
    });
    add("tentacles", [](Case& c) {
        c.material = "tentacles";
        c.everyStrand = 40;
        c.model = ShadingModel::kajiya;
    });
    return list;
}

Result<render::Image> Painter::draw(const Case& which) {
    const std::filesystem::path samples = sourceDir() / "samples";
    if (sample_ != which.sample) {
        auto made = makeSample(samples, which.sample);
        if (!made) return tl::unexpected(made.error());
        groom_ = std::move(*made);
        sample_ = which.sample;
    }
    Groom groom = which.everyStrand > 1 ? thinnedOut(groom_, which.everyStrand) : groom_;
    if (!which.material.empty()) {
        if (auto status = applyMaterial(samples, which.material, groom); !status)
            return tl::unexpected(status.error());
    }
    // Fewer and thicker hairs cover as much.
    const std::uint32_t follow = std::min(groom.interpolation.followPerGuide, 1u);
    if (follow > 0) {
        groom.material.rootRadius *= std::min(3.0f, static_cast<float>(groom.interpolation.followPerGuide));
        groom.interpolation.followPerGuide = follow;
    }
    ViewFile view;
    view.fibre.model = which.model;
    view.fibre.scattering = which.scattering;
    const auto scene = GroomScene::make(groom, view, {});
    if (!scene) return tl::unexpected(scene.error());
    render::RenderScene shown = scene->scene();
    shown.camera = render::frame(render::View::ThreeQuarter, scene->subject(), 1);
    shown.lights = render::studioLights(shown.camera);
    auto picture = render::renderPicture(*device_, shown, which.options);
    if (!picture) return tl::unexpected(picture.error());
    return std::move(picture->image);
}

std::filesystem::path pathOf(const Case& which) {
    return sourceDir() / "tests/golden/pictures" / (which.name + ".png");
}

Result<render::Image> acceptedPicture(const Case& which) {
    const auto linear = render::readPng(pathOf(which));
    if (!linear) return tl::unexpected(linear.error());
    render::Image image{linear->width, linear->height, std::vector<std::uint8_t>(linear->rgba.size())};
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        const float value = i % 4 == 3 ? linear->rgba[i] : render::encodeSrgb(linear->rgba[i]);
        image.rgba[i] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
    return image;
}

}  // namespace hairloom::golden
