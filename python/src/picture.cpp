// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "core/documents/look_presets.h"
#include "core/live/groom_scene.h"
#include "core/live/moving_picture.h"
#include "core/live/picture_shadows.h"
#include "core/live/view_file.h"
#include "core/software/device.h"
#include "python/src/arrays.h"
#include "python/src/frame.h"
#include "python/src/groom.h"

namespace hairloom::python {
namespace {

Result<render::Image> draw(const Groom& groom, const render::RenderOptions& asked, const std::string& camera,
                           const std::string& viewFile, const PyFrame* frame) {
    const auto named = render::parseView(camera);
    if (!named) return tl::unexpected(named.error());
    ViewFile view;
    if (!viewFile.empty()) {
        auto read = readViewFile(viewFile);
        if (!read) return tl::unexpected(read.error());
        view = std::move(*read);
    }
    Groom looks = groom;
    if (auto status = applyLookOfView(viewFile, view.look, looks); !status)
        return tl::unexpected(status.error());
    auto shown = GroomScene::make(looks, view, {});
    if (!shown) return tl::unexpected(shown.error());
    if (frame) shown->pose(*frame->positions_ws, *frame->velocities_ws, *frame->pose);
    render::RenderScene scene = shown->scene();
    const float aspect = static_cast<float>(asked.width) / static_cast<float>(asked.height);
    scene.camera = view.camera.value_or(render::frame(*named, shown->subject(), aspect));
    scene.lights = view.hasLights ? view.lights : render::studioLights(scene.camera);
    if (view.hasLights) {
        scene.environment = view.environment;
        scene.background = Vec3f::Zero();
    }
    scene.background = view.background.value_or(scene.background);
    const software::DeviceChoice device = software::chooseDevice();
    render::RenderOptions options = asked;
    takeShadows(groom.shadows, view, options);
    if (software::isSoftware(*device.device)) takeWaysOfSoftware(options);
    auto picture = render::renderPicture(*device.device, scene, options);
    if (!picture) return tl::unexpected(picture.error());
    return std::move(picture->image);
}

}  // namespace

nb::object render(PyGroom& groom, std::pair<std::uint32_t, std::uint32_t> size, const std::string& camera,
                  const std::filesystem::path& view, std::uint32_t passes, bool transparent,
                  const PyFrame* frame) {
    const Use use(groom.inUse, kTheGroom);
    if (size.first == 0 || size.second == 0 || std::uint64_t{size.first} * size.second > render::kMaxPixels)
        raiseArgument("size", fmt::format("is {} × {}", size.first, size.second), "1 to 64 million pixels");
    if (passes < 1 || passes > 1024) raiseArgument("passes", fmt::format("is {}", passes), "1 to 1024");
    if (frame && frame->positions_ws->size() != groom.groom.pointCount())
        raiseArgument("frame", fmt::format("has {} points", frame->positions_ws->size()),
                      fmt::format("a frame of this groom, which has {}", groom.groom.pointCount()));
    render::RenderOptions options;
    options.width = size.first;
    options.height = size.second;
    options.frames = passes;
    options.transparency = render::Transparency::automatic;
    options.exposure = 1;
    options.transparentBackground = transparent;
    render::Image image =
        unwrap(withoutGil([&] { return draw(groom.groom, options, camera, view.string(), frame); }));
    return arrayOf(std::move(image.rgba), {image.height, image.width, std::size_t{4}});
}

}  // namespace hairloom::python
