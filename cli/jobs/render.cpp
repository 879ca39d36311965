// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/vectors.h"
#include "core/render/png.h"
#include "core/simulation/frame_record.h"
#include "workspace/groom_scene.h"

namespace hairloom::cli {
namespace {

struct RenderJobOptions {
    std::string input;
    std::string size;
    std::string camera = "three-quarter";
    std::string view;
    std::string shading = "kajiya";
    std::string shadow = "dom";
    std::string antiAliasing = "auto";
    std::string record;
    std::vector<std::string> hiddenGroups;
    std::uint64_t frame = 0;
    std::uint32_t device = 0;
    bool chooseDevice = false;
    float exposure = 1;
    std::uint32_t passes = 8;
    std::string output;
};

const std::map<std::string, std::uint32_t> kSamples{
    {"auto", 0}, {"none", 1}, {"msaa2", 2}, {"msaa4", 4}, {"msaa8", 8}};

Result<render::RenderOptions> pictureOptions(const RenderJobOptions& options, const ViewFile& view) {
    render::RenderOptions picture;
    std::pair<std::uint32_t, std::uint32_t> size = view.size.value_or(std::pair(1024u, 1024u));
    if (!options.size.empty()) {
        const auto parsed = parseSize(options.size);
        if (!parsed) return tl::unexpected(parsed.error());
        size = *parsed;
    }
    std::tie(picture.width, picture.height) = size;
    picture.samples = kSamples.at(options.antiAliasing);
    picture.shadows = options.shadow == "dom";
    picture.exposure = options.exposure;
    picture.frames = options.passes;
    return picture;
}

Result<GroomScene> loadScene(const RenderJobOptions& options, const ViewFile& view) {
    const auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (options.record.empty()) return GroomScene::make(*groom, nullptr, nullptr, view, options.hiddenGroups);
    const auto frame = readFrame(options.record, *groom, options.frame);
    if (!frame) return tl::unexpected(frame.error());
    return GroomScene::make(*groom, &frame->positions_ws, &frame->pose, view, options.hiddenGroups);
}

Result<Report> renderToFile(const RenderJobOptions& options) {
    ViewFile view;
    if (!options.view.empty()) {
        auto read = readViewFile(options.view);
        if (!read) return tl::unexpected(read.error());
        view = std::move(*read);
    }
    const auto pictureAs = pictureOptions(options, view);
    if (!pictureAs) return tl::unexpected(pictureAs.error());
    const auto groomScene = loadScene(options, view);
    if (!groomScene) return tl::unexpected(groomScene.error());
    render::RenderScene scene = groomScene->scene();
    const auto named = render::parseView(options.camera);
    if (!named) return tl::unexpected(named.error());
    const float aspect = static_cast<float>(pictureAs->width) / static_cast<float>(pictureAs->height);
    scene.camera = view.camera.value_or(render::frame(*named, groomScene->subject(), aspect));
    scene.lights = view.lights.empty() ? render::studioLights(scene.camera) : view.lights;

    gpu::DeviceOptions deviceOptions;
    if (options.chooseDevice) deviceOptions.index = options.device;
    const auto device = gpu::createDevice(deviceOptions);
    if (!device) return tl::unexpected(device.error());
    const auto picture = render::renderPicture(**device, scene, *pictureAs);
    if (!picture) return tl::unexpected(picture.error());
    if (auto written = render::writePng(options.output, picture->image); !written) {
        return tl::unexpected(written.error());
    }

    Report passes = Report::array();
    for (const gpu::PassTime& pass : picture->passes) {
        passes.push_back(Report{{"name", pass.name}, {"ms", pass.milliseconds}});
    }
    return Report{{"device", picture->device},       {"hairs", picture->strands},
                  {"triangles", picture->triangles}, {"curve_points", picture->curvePoints},
                  {"passes", std::move(passes)},     {"output", options.output}};
}

}  // namespace

void addRenderJob(Jobs& jobs) {
    const auto options = std::make_shared<RenderJobOptions>();
    CLI::App& job = jobs.add("render", "Make a picture without a window",
                             "hair.hairloom -o hair.png --size 1024x1024 --camera three-quarter",
                             [options] { return renderToFile(*options); });
    job.add_option("groom", options->input, "Project or hair file")->required();
    job.add_option("--size", options->size, "Pixels WxH; 1024x1024 where neither this nor the view says");
    job.add_option("--camera", options->camera, "From where")
        ->check(CLI::IsMember({"front", "back", "left", "right", "three-quarter"}));
    job.add_option("--view", options->view, "JSON file with camera, lights, head and hair");
    job.add_option(
           "--hide", options->hiddenGroups,
           "Groups of the head mesh to leave out of the picture, NAME or BEGINNING*, with commas between")
        ->delimiter(',')
        ->allow_extra_args(false);
    job.add_option("--shading", options->shading, "Shading model")->check(CLI::IsMember({"kajiya"}));
    job.add_option("--shadow", options->shadow, "Shadows of hair: none, or deep opacity maps")
        ->check(CLI::IsMember({"none", "dom"}));
    job.add_option("--aa", options->antiAliasing,
                   "Samples a pixel and frame; auto: the most the device has, up to 8")
        ->check(CLI::IsMember({"auto", "none", "msaa2", "msaa4", "msaa8"}));
    job.add_option("--exposure", options->exposure, "Factor on the light before the tone curve")
        ->check(CLI::Range(1e-3, 1e3));
    job.add_option("--passes", options->passes,
                   "Times the picture is drawn, each moved by part of a pixel, and averaged")
        ->check(CLI::Range(1, 1024));
    auto* record = job.add_option("--record", options->record, "Frames that simulate --record wrote");
    job.add_option("--frame", options->frame, "Frame of the record, from 0")->needs(record);
    auto* device = job.add_option("--device", options->device, "GPU to use, by its index in `devices`");
    job.add_option("-o,--output", options->output, "PNG to write")->required();
    job.final_callback([options, device] { options->chooseDevice = device->count() > 0; });
}

}  // namespace hairloom::cli
