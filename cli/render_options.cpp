// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "cli/backend.h"
#include "cli/colour_options.h"
#include "cli/error_report.h"
#include "cli/vectors.h"
#include "core/documents/look_presets.h"
#include "core/live/picture_shadows.h"
#include "core/live/shown.h"
#include "core/render/aov.h"

namespace hairloom::cli {
namespace {

struct AntiAliasing {
    std::uint32_t samples;
    render::PostFilter filter = render::PostFilter::none;
    bool once = false;  ///< a post filter stands instead of averaging
};
const std::map<std::string, AntiAliasing> kAntiAliasing{{"auto", {0}},
                                                        {"none", {1}},
                                                        {"fxaa", {1, render::PostFilter::fxaa, true}},
                                                        {"fxaa-hq", {1, render::PostFilter::fxaaHigh, true}},
                                                        {"msaa2", {2}},
                                                        {"msaa4", {4}},
                                                        {"msaa8", {8}}};
const std::map<std::string, render::Shadows> kShadows{{"none", render::Shadows::none},
                                                      {"dom", render::Shadows::deepOpacity},
                                                      {"absorption", render::Shadows::absorption},
                                                      {"opacity", render::Shadows::opacityMaps},
                                                      {"adaptive", render::Shadows::adaptive}};
const std::map<std::string, render::ShadowFilter> kShadowFilters{{"off", render::ShadowFilter::off},
                                                                 {"3x3", render::ShadowFilter::three},
                                                                 {"5x5", render::ShadowFilter::five}};
const std::map<std::string, render::LayerEnds> kLayerEnds{{"early", render::LayerEnds::early},
                                                          {"linear", render::LayerEnds::linear},
                                                          {"growing", render::LayerEnds::growing}};
const std::map<std::string, render::Ribbons> kRibbons{{"auto", render::Ribbons::automatic},
                                                      {"strip", render::Ribbons::strip},
                                                      {"tess", render::Ribbons::tessellated},
                                                      {"compute", render::Ribbons::compute}};
const std::map<std::string, render::Transparency> kTransparency{
    {"auto", render::Transparency::automatic},
    {"sorted", render::Transparency::sorted},
    {"stochastic", render::Transparency::stochastic},
    {"weighted", render::Transparency::weighted}};

std::vector<std::string> shownNames() {
    std::vector<std::string> names;
    for (const ShownKind& kind : shownKinds()) names.emplace_back(kind.name);
    return names;
}

std::string showHelp() {
    std::string help =
        "Write a chart of the shading model in place of an image of the hair, of the groom's material or, "
        "without a groom, of the default one.";
    for (const ShownKind& kind : shownKinds()) help += fmt::format(" {}: {}.", kind.name, kind.meaning);
    return help;
}

}  // namespace

Result<render::RenderOptions> pictureOptions(const RenderJobOptions& options, const ViewFile& view) {
    render::RenderOptions picture;
    std::pair<std::uint32_t, std::uint32_t> size = view.size.value_or(std::pair(1024u, 1024u));
    if (!options.size.empty()) size = orWrongUsage(parseSize(options.size));
    std::tie(picture.width, picture.height) = size;
    const AntiAliasing& aa = kAntiAliasing.at(options.antiAliasing);
    picture.samples = aa.samples;
    picture.filter = aa.filter;
    picture.temporal = options.temporal;
    picture.frames = aa.once || options.temporal ? 1 : options.passes;
    picture.shadowLights = options.shadowLights;
    picture.subdivisions = options.subdivisions.value_or(view.subdivisions.value_or(picture.subdivisions));
    picture.ribbons = kRibbons.at(options.ribbons);
    picture.transparency = kTransparency.at(options.transparency);
    picture.detail = options.detail;
    picture.exposure = options.exposure;
    picture.surface = !options.aovs.empty();
    return picture;
}

void takeShadows(const RenderJobOptions& options, const ShadowSettings& project, const ViewFile& view,
                 render::RenderOptions& picture) {
    hairloom::takeShadows(project, view, picture);
    if (!options.shadow.empty()) picture.shadows = kShadows.at(options.shadow);
    if (!options.shadowFilter.empty()) picture.shadowFilter = kShadowFilters.at(options.shadowFilter);
    if (!options.layerEnds.empty()) picture.layerEnds = kLayerEnds.at(options.layerEnds);
    picture.shadowResolution = options.shadowResolution.value_or(picture.shadowResolution);
    picture.shadowLayers = options.shadowLayers.value_or(picture.shadowLayers);
    picture.shadowSlices = options.shadowSlices.value_or(picture.shadowSlices);
    picture.shadowNodes = options.shadowNodes.value_or(picture.shadowNodes);
    picture.layerGrowth = options.layerGrowth.value_or(picture.layerGrowth);
    picture.headAbsorption = options.headAbsorption.value_or(picture.headAbsorption);
    picture.shadowBlur = options.shadowBlur.value_or(picture.shadowBlur);
}

Result<std::vector<Shot>> shotsOf(const RenderJobOptions& options) {
    constexpr std::uint64_t kMaxShots = 10'000;
    if (options.turntable > 0) {
        std::vector<Shot> shots;
        for (std::uint32_t i = 0; i < options.turntable; ++i) {
            shots.push_back(
                {options.frame, 360 * static_cast<float>(i) / static_cast<float>(options.turntable)});
        }
        return shots;
    }
    if (options.frames.empty()) return std::vector<Shot>{{options.frame, options.turn}};
    if (options.frames.size() > 3 || options.frames.size() < 2) {
        throw WrongUsage("--frames needs FIRST,LAST and an optional STEP", "FIRST,LAST[,STEP]");
    }
    const std::uint64_t step = options.frames.size() == 3 ? options.frames[2] : 1;
    if (step == 0 || options.frames[1] < options.frames[0] ||
        (options.frames[1] - options.frames[0]) / step >= kMaxShots) {
        throw WrongUsage("--frames runs backwards, has step 0 or has more than 10000 frames",
                         "FIRST,LAST[,STEP]");
    }
    const std::uint64_t around = options.handles * step;
    if (around > options.frames[0])
        throw WrongUsage(fmt::format("--handles {} before frame {} begins before the first frame",
                                     options.handles, options.frames[0]),
                         fmt::format("expected --frames from {} on", around));
    const std::uint64_t last = options.frames[0] + (options.frames[1] - options.frames[0]) / step * step;
    if ((last - options.frames[0] + 2 * around) / step >= kMaxShots)
        throw WrongUsage("--frames with their --handles are more than 10000", "fewer handles");
    std::vector<Shot> shots;
    for (std::uint64_t f = options.frames[0] - around; f <= last + around; f += step)
        shots.push_back({f, options.turn});
    return shots;
}

std::shared_ptr<RenderJobOptions> addRenderOptions(CLI::App& job) {
    auto options = std::make_shared<RenderJobOptions>();
    auto* groom = job.add_option("groom", options->input, "Project or hair file. --show does without");
    job.add_option("--size", options->size,
                   "Image size WxH in pixels (default: that of the view, or 1024x1024, of charts 1280x860)");
    job.add_option("--camera", options->camera, "Camera position")
        ->check(CLI::IsMember({"front", "back", "left", "right", "three-quarter", "top", "bottom"}));
    auto* view = job.add_option("--view", options->view, "JSON file with camera, lights, head and hair");
    job.add_option("--images", options->imageFolders,
                   "Folders with images for the view, in addition to its own, separated by commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->needs(view);
    job.add_option("--hide", options->hiddenGroups,
                   "Groups of the head mesh to hide: NAME or PREFIX*, separated by commas")
        ->delimiter(',')
        ->allow_extra_args(false);
    job.add_option("--material", options->material,
                   "Sample material (fire, tentacles, …) or JSON file of material fields to apply");
    job.add_option(
           "--look", options->look,
           "Look of the Look panel to apply (default: the view's). --material and --shading override it")
        ->check(CLI::IsMember(lookNames()));
    job.add_option("--shading", options->shading, "Shading model (default: the project's)")
        ->check(CLI::IsMember(namesOf(kShadingModels)));
    auto* show = job.add_option("--show", options->show, showHelp())->check(CLI::IsMember(shownNames()));
    job.add_option("--inclination", options->inclination,
                   "With --show: inclination of the light against the plane across the fibre, in degrees")
        ->check(CLI::Range(-85.0, 85.0))
        ->needs(show);
    job.add_option(
           "--scatter", options->scatter,
           "Light scattered by other hairs: single ignores it, dual adds it as in an even layer, volume "
           "follows it from hair to hair and skin. Not for kajiya")
        ->check(CLI::IsMember(namesOf(kScatterings)));
    job.add_option("--shadow", options->shadow,
                   "Hair shadows: deep opacity maps, absorption by depth, opacity maps at fixed depths, "
                   "adaptive maps "
                   "with nodes where light changes most, or none (default: the view's, or the project's)")
        ->check(CLI::IsMember(namesOf(kShadows)));
    job.add_option("--shadow-lights", options->shadowLights,
                   "Maximum number of lights with shadow maps. Area lights and bright parts of images are "
                   "split into this many")
        ->check(CLI::Range(std::size_t{1}, render::kMaxLights));
    job.add_option("--shadow-resolution", options->shadowResolution,
                   "Width and height of each shadow map in pixels (default: the view's, or the project's)")
        ->check(CLI::Range(render::kMinShadowResolution, render::kMaxShadowResolution));
    job.add_option(
           "--shadow-filter", options->shadowFilter,
           "Texels of shadow maps that are averaged at each point of the hair (default: the view's, or "
           "the project's)")
        ->check(CLI::IsMember(namesOf(kShadowFilters)));
    job.add_option("--shadow-layers", options->shadowLayers,
                   "Layers of deep opacity maps (default: the view's, or the project's)")
        ->check(CLI::Range(render::kMinShadowLayers, render::kMaxShadowLayers));
    job.add_option(
           "--layer-ends", options->layerEnds,
           "Where layers end: early, most of them where hair begins, linear, evenly, or growing, each "
           "--layer-growth times as wide as the one before (default: the view's, or the project's)")
        ->check(CLI::IsMember(namesOf(kLayerEnds)));
    job.add_option("--layer-growth", options->layerGrowth,
                   "Ratio of the widths of layers that grow (default: the view's, or the project's)")
        ->check(CLI::Range(1.0f, render::kMaxLayerGrowth));
    job.add_option("--shadow-slices", options->shadowSlices,
                   "Slices of opacity maps, evenly spaced (default: the view's, or the project's)")
        ->check(CLI::Range(std::uint32_t{1}, render::kMaxShadowSlices));
    job.add_option("--shadow-nodes", options->shadowNodes,
                   "Nodes of each texel's curve in adaptive maps (default: the view's, or the project's)")
        ->check(CLI::Range(render::kMinShadowNodes, render::kMaxShadowNodes));
    job.add_option("--subdivisions", options->subdivisions,
                   "Curve segments per segment of a strand (default: the view's, or 2)")
        ->check(CLI::Range(std::uint32_t{1}, render::kMaxSubdivisions));
    job.add_option("--head-absorption", options->headAbsorption,
                   "Fades light on hair behind the head with depth, per metre. 0 blocks it (default: the "
                   "view's, or the "
                   "project's)")
        ->check(CLI::Range(0.0f, render::kMaxHeadAbsorption));
    job.add_option(
           "--shadow-blur", options->shadowBlur,
           "Screen-space shadow blur in pixels, which draws everything twice. 0 turns it off (default: the "
           "view's, or the project's)")
        ->check(CLI::Range(0.0f, render::kMaxShadowBlur));
    job.add_option("--aa", options->antiAliasing,
                   "Samples per pixel and frame, or FXAA. auto uses as many as the device has, up to 8")
        ->check(CLI::IsMember(namesOf(kAntiAliasing)));
    job.add_option("--ribbons", options->ribbons,
                   "How to draw hairs: as strips, as tessellated patches, or rasterised by compute kernels. "
                   "auto uses kernels on a GPU, and strips without a GPU or with weighted transparency")
        ->check(CLI::IsMember(namesOf(kRibbons)));
    job.add_option(
           "--transparency", options->transparency,
           "Transparency of hair thinner than a sample: sorted blends the nearest of a pixel, stochastic "
           "covers a random part of the samples, weighted blends in any order. auto uses "
           "stochastic for averaged frames, sorted for single frames on a GPU, and weighted otherwise")
        ->check(CLI::IsMember(namesOf(kTransparency)));
    job.add_option("--detail", options->detail,
                   "Skip hairs thinner than this part of a pixel and widen the others. 0 draws all")
        ->check(CLI::Range(0.0, 100.0));
    job.add_option("--exposure", options->exposure, "Exposure: multiplies light before the tone curve")
        ->check(CLI::Range(1e-3, 1e3));
    addColourOptions(job, options->colours);
    auto* passes = job.add_option("--passes", options->passes,
                                  "Number of frames to average, each with a sub-pixel offset")
                       ->check(CLI::Range(1, 1024));
    auto* record = job.add_option("--record", options->record, "Frames that simulate --record wrote");
    auto* motion = job.add_option("--motion", options->motion,
                                  "Simulate the hair while rendering, with this head motion: none, spin, "
                                  "nod, clip:NAME, a keyframe file F.json, or timeline: the project's clips, "
                                  "keys, frame rate and pre-roll")
                       ->excludes(record);
    job.add_flag("--temporal", options->temporal,
                 "Temporal anti-aliasing: draws each frame of the simulation once and accumulates earlier "
                 "frames, as the window does")
        ->needs(motion)
        ->excludes(passes);
    job.add_option("--character", options->character,
                   "File with skeleton and clips, if other than the scalp's file")
        ->needs(motion);
    job.add_option("--wind", options->wind, "Wind velocity X,Y,Z in m/s, instead of the groom's own")
        ->needs(motion);
    job.add_option(
           "--engine", options->engine,
           "Device that simulates and draws. auto draws on the best GPU, or with the software renderer if "
           "there "
           "is none, and simulates where it was measured to be faster. cpu and gpu simulate there. gpu draws "
           "with the graphics API only, images without --motion, too. software draws and simulates without a "
           "graphics API")
        ->check(CLI::IsMember({"auto", "cpu", "gpu", "software"}));
    auto* frame = job.add_option(
        "--frame", options->frame,
        "Frame of the record, counted from 0, or of the simulation in 1/60 s, or at the time line's "
        "frame rate. Needs --record or --motion");
    auto* frames =
        job.add_option("--frames", options->frames,
                       "Frames FIRST,LAST[,STEP] to render, one image each. Needs --record or --motion")
            ->check(CLI::Range(0, 1'000'000'000))
            ->delimiter(',')
            ->excludes(frame);
    for (CLI::Option* const option : {record, motion, frames}) show->excludes(option);
    job.add_option("--handles", options->handles,
                   "Number of frames to render before and behind --frames as well")
        ->check(CLI::Range(0, 1000))
        ->needs(frames);
    auto* start =
        job.add_option("--start", options->start,
                       "Number of the image of FIRST, as 1001 (default: images are numbered from 0)")
            ->check(CLI::Range(0, 1'000'000))
            ->needs(frames);
    auto* turn =
        job.add_option("--turn", options->turn,
                       "Degrees by which the camera is turned around the hair: one image of a turntable");
    auto* turntable = job.add_option("--turntable", options->turntable,
                                     "Number of images for one turn of the camera around the hair")
                          ->check(CLI::Range(1, 10'000))
                          ->excludes(frames)
                          ->excludes(turn);
    auto* animation =
        job.add_option("--animation", options->animation,
                       "Animated PNG for all images, WebP if the name ends in .webp, or video if it "
                       "ends in .mp4");
    job.add_option("--burn-in", options->burnIn,
                   "Text to write into the images, a line each, separated by commas: frame, take, settings, "
                   "error (with "
                   "--against), or any other text. OpenEXR files have none")
        ->delimiter(',')
        ->allow_extra_args(false);
    job.add_option("--against", options->against,
                   "Record of the same groom and frames that errors are measured from")
        ->needs(record);
    auto* strip = job.add_option("--strip", options->strip, "PNG with all images side by side");
    job.add_option("--columns", options->columns,
                   "Images in a row of the strip, for a contact sheet (default: all)")
        ->check(CLI::Range(1, 10'000))
        ->needs(strip);
    job.add_option("--milliseconds", options->milliseconds,
                   "Duration of each frame of the animation, in milliseconds")
        ->check(CLI::Range(1, 65'535));
    auto* exr = job.add_option("--exr", options->exr,
                               "OpenEXR file for linear light, before exposure and tone curve, in the "
                               "config's scene-linear space, else Rec. 709");
    for (CLI::Option* const option : {turn, turntable, animation, strip, exr}) show->excludes(option);
    job.add_option("--aov", options->aovs,
                   "Extra layers in the OpenEXR, for the nearest surface in each pixel: depth, hair id, "
                   "velocity since the last frame, albedo")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(std::vector<std::string>(render::kAovNames.begin(), render::kAovNames.end())))
        ->needs(exr);
    auto* device = job.add_option("--device", options->device, "GPU to use, by its index in `devices`");
    job.add_option("--backend", options->backend, "Graphics API. Direct3D 11 is only on Windows")
        ->check(CLI::IsMember({"any", "vulkan", "d3d11"}));
    job.add_option("-o,--output", options->output, "PNG to write. Several images are numbered")->required();
    job.final_callback([options, groom, device, frame, frames, start] {
        if (options->input.empty() && options->show.empty()) throw CLI::RequiredError(groom->get_name());
        if (start->count() > 0 && *options->start < options->handles)
            throw CLI::ValidationError("--start", fmt::format("{} leaves no numbers for {} handles",
                                                              *options->start, options->handles));
        options->chooseDevice = device->count() > 0;
        if (std::ranges::find(options->burnIn, "error") != options->burnIn.end() && options->against.empty())
            throw CLI::RequiresError("--burn-in error", "--against");
        const bool moves = !options->record.empty() || !options->motion.empty();
        for (const CLI::Option* option : {frame, frames}) {
            if (option->count() > 0 && !moves)
                throw CLI::RequiresError(option->get_name(),
                                         "--record or --motion, because hair rests without them. "
                                         "--motion timeline plays the project's motion");
        }
        if (options->engine == "software" && (options->chooseDevice || options->backend != "any"))
            throw CLI::ExcludesError("--engine software", options->chooseDevice ? "--device" : "--backend");
    });
    return options;
}

}  // namespace hairloom::cli
