// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "cli/backend.h"
#include "cli/body_notes.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/live_shots.h"
#include "cli/motions.h"
#include "cli/outputs.h"
#include "cli/plan_report.h"
#include "cli/progress.h"
#include "cli/vectors.h"
#include "core/base/content_kind.h"
#include "core/base/output_batch.h"
#include "core/documents/sample.h"
#include "core/documents/sample_material.h"
#include "core/live/film.h"
#include "core/live/groom_scene.h"
#include "core/live/moving_picture.h"
#include "core/live/view_file.h"
#include "core/render/aov.h"
#include "core/render/png.h"
#include "core/simulation/frame_record.h"
#include "core/software/device.h"
#include "importers/child_process.h"

namespace hairloom::cli {
namespace {

struct RenderJobOptions {
    std::string input;
    std::string size;
    std::string camera = "three-quarter";
    std::string view;
    std::string material;
    std::string shading;
    std::string scatter = "dual";
    std::string shadow = "dom";
    std::uint32_t shadowLights = render::RenderOptions().shadowLights;
    std::string antiAliasing = "auto";
    std::string ribbons = "auto";
    std::string transparency = "auto";
    float detail = 0;
    std::optional<float> headAbsorption;
    std::optional<float> shadowBlur;
    std::string record;
    std::string motion;
    std::string character;
    std::string wind;
    std::string engine;
    std::vector<std::string> hiddenGroups;
    std::uint64_t frame = 0;
    std::vector<std::uint64_t> frames;  ///< first, last, step
    std::uint32_t turntable = 0;
    std::uint32_t device = 0;
    bool chooseDevice = false;
    std::string backend = "any";
    float exposure = 1;
    std::uint32_t passes = 8;
    bool temporal = false;
    std::string exr;
    std::vector<std::string> aovs;
    std::vector<std::string> imageFolders;
    std::string animation;
    std::string strip;
    std::uint32_t milliseconds = 40;
    std::string output;

    bool sequence() const { return !frames.empty() || turntable > 0; }
};

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
                                                      {"opacity", render::Shadows::opacityMaps}};
const std::map<std::string, render::Ribbons> kRibbons{{"auto", render::Ribbons::automatic},
                                                      {"strip", render::Ribbons::strip},
                                                      {"tess", render::Ribbons::tessellated},
                                                      {"compute", render::Ribbons::compute}};
const std::map<std::string, render::Transparency> kTransparency{
    {"auto", render::Transparency::automatic},
    {"sorted", render::Transparency::sorted},
    {"stochastic", render::Transparency::stochastic},
    {"a2c", render::Transparency::alphaToCoverage},
    {"weighted", render::Transparency::weighted}};

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
    picture.shadows = kShadows.at(options.shadow);
    picture.shadowLights = options.shadowLights;
    picture.headAbsorption = options.headAbsorption.value_or(view.headAbsorption.value_or(0));
    picture.shadowBlur = options.shadowBlur.value_or(view.shadowBlur.value_or(0));
    picture.ribbons = kRibbons.at(options.ribbons);
    picture.transparency = kTransparency.at(options.transparency);
    picture.detail = options.detail;
    picture.exposure = options.exposure;
    picture.surface = !options.aovs.empty();
    return picture;
}

Result<GroomScene> loadScene(const RenderJobOptions& options, const Groom& groom, std::uint64_t number,
                             const ViewFile& view) {
    auto scene = GroomScene::make(groom, view, options.hiddenGroups);
    if (!scene || options.record.empty()) return scene;
    const auto frame = readFrame(options.record, groom, number);
    if (!frame) return tl::unexpected(frame.error());
    std::vector<Vec3f> velocities;
    if (number > 0) {
        const auto before = readFrame(options.record, groom, number - 1);
        if (!before) return tl::unexpected(before.error());
        for (std::size_t p = 0; p < frame->positions_ws.size(); ++p) {
            velocities.push_back((frame->positions_ws[p] - before->positions_ws[p]) * frame->framesPerSecond);
        }
    }
    scene->pose(frame->positions_ws, velocities, frame->pose);
    return scene;
}

/// One picture of a sequence.
struct Shot {
    std::uint64_t frame = 0;
    float turn = 0;  ///< degrees around the upright axis through the camera's target
};

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
    if (options.frames.empty()) return std::vector<Shot>{{options.frame, 0}};
    if (options.frames.size() > 3 || options.frames.size() < 2) {
        throw WrongUsage("--frames needs FIRST,LAST and an optional STEP", "FIRST,LAST[,STEP]");
    }
    const std::uint64_t step = options.frames.size() == 3 ? options.frames[2] : 1;
    if (step == 0 || options.frames[1] < options.frames[0] ||
        (options.frames[1] - options.frames[0]) / step >= kMaxShots) {
        throw WrongUsage("--frames runs backwards, has step 0 or has more than 10000 frames",
                         "FIRST,LAST[,STEP]");
    }
    std::vector<Shot> shots;
    for (std::uint64_t f = options.frames[0]; f <= options.frames[1]; f += step) shots.push_back({f, 0});
    return shots;
}

/// Side by side, all of the first's size.
render::Image sideBySide(const std::vector<render::Image>& images) {
    render::Image strip{0, images[0].height, {}};
    for (const render::Image& image : images) strip.width += image.width;
    for (std::uint32_t y = 0; y < strip.height; ++y) {
        for (const render::Image& image : images) {
            const auto row = image.rgba.begin() + std::ptrdiff_t{4} * y * image.width;
            strip.rgba.insert(strip.rgba.end(), row, row + std::ptrdiff_t{4} * image.width);
        }
    }
    return strip;
}

Report reportOf(const render::Picture& picture, const RenderJobOptions& options) {
    Report passes = Report::array();
    for (const gpu::PassTime& pass : picture.passes) {
        passes.push_back(Report{{"name", pass.name}, {"ms", pass.milliseconds}});
    }
    return Report{{"device", picture.device},       {"hairs", picture.strands},
                  {"triangles", picture.triangles}, {"curve_points", picture.curvePoints},
                  {"passes", std::move(passes)},    {"plan", planReport(picture.plan)},
                  {"output", options.output}};
}

/// Pictures after one another, with the camera and lights of the first.
class Photographer {
  public:
    /// `live`: moves the hair; null: it rests, or a record has moved it.
    Photographer(const RenderJobOptions& options, gpu::Device& device, const Groom& groom,
                 const ViewFile& view, const render::RenderOptions& how, LiveShots* live)
        : options_(options), device_(device), groom_(groom), view_(view), how_(how), live_(live) {}

    Result<render::Picture> take(const Shot& shot) {
        if (!live_ && (!scene_ || shot.frame != frame_)) {
            auto loaded = loadScene(options_, groom_, shot.frame, view_);
            if (!loaded) return tl::unexpected(loaded.error());
            scene_ = std::move(*loaded);
            frame_ = shot.frame;
        }
        const GroomScene& shown = live_ ? live_->scene() : *scene_;
        render::RenderScene scene = shown.scene();
        if (!camera_) {
            const auto named = render::parseView(options_.camera);
            if (!named) return tl::unexpected(named.error());
            const float aspect = static_cast<float>(how_.width) / static_cast<float>(how_.height);
            camera_ = view_.camera.value_or(render::frame(*named, shown.subject(), aspect));
            lights_ = view_.hasLights ? view_.lights : render::studioLights(*camera_);
        }
        scene.camera = *camera_;
        scene.camera = turned(scene.camera, shot.turn);
        scene.lights = lights_;
        if (view_.hasLights) {
            scene.environment = view_.environment;
            scene.background = Vec3f::Zero();
        }
        scene.background = view_.background.value_or(scene.background);
        if (live_) return live_->take(shot.frame, scene, how_);
        if (how_.surface && !options_.record.empty() && shot.frame > 0) return takeMoving(scene);
        return render::renderPicture(device_, scene, how_);
    }

  private:
    /// With what has moved since the frame before.
    Result<render::Picture> takeMoving(const render::RenderScene& scene) {
        const auto before = loadScene(options_, groom_, frame_ - 1, view_);
        if (!before) return tl::unexpected(before.error());
        render::RenderScene past = before->scene();
        past.camera = scene.camera;
        return render::renderPicture(device_, past, scene, how_);
    }

    const RenderJobOptions& options_;
    gpu::Device& device_;
    const Groom& groom_;
    const ViewFile& view_;
    const render::RenderOptions& how_;
    LiveShots* live_;
    std::optional<GroomScene> scene_;
    std::uint64_t frame_ = 0;
    std::optional<render::Camera> camera_;
    std::vector<render::Light> lights_;
};

Status writePictures(const RenderJobOptions& options, const render::Picture& picture, std::size_t number) {
    const bool many = options.sequence();
    const auto name = [&](const std::string& path) {
        return many ? numbered(path, number) : std::filesystem::path(path);
    };
    if (auto written = render::writePng(name(options.output), picture.image); !written) return written;
    if (options.exr.empty()) return {};
    const auto layers = render::aovLayers(options.aovs, picture.surface);
    if (!layers) return tl::unexpected(layers.error());
    return render::writeExr(name(options.exr), picture.linear, *layers);
}

/// Hair that moves while pictures of it are taken.
struct Playing {
    std::unique_ptr<HeadMotion> motion;
    std::unique_ptr<LiveShots> shots;  ///< null where nothing was asked to move
    EngineChoice engine;
};

Result<Playing> play(const RenderJobOptions& options, GpuBackend& gpu, Groom& groom, const ViewFile& view) {
    Playing playing;
    if (options.motion.empty()) return playing;
    if (auto set = setWind(groom, options.wind); !set) return tl::unexpected(set.error());
    auto motion = makeMotion(options.motion, options.character, groom);
    if (!motion) return tl::unexpected(motion.error());
    playing.motion = std::move(*motion);
    const auto wish = options.engine == "gpu"   ? EngineWish::gpu
                      : options.engine == "cpu" ? EngineWish::cpu
                                                : EngineWish::automatic;
    if (software::isSoftware(gpu.device())) {
        const bool asked = wish == EngineWish::cpu;
        playing.engine = {EngineKind::cpu, asked ? "you asked for it" : "the software renderer draws"};
    } else {
        playing.engine = chooseEngine(wish, &gpu.device(), gpu.kernels(), groom, EngineMemory::ofUser());
    }
    if (wish == EngineWish::gpu && playing.engine.kind != EngineKind::gpu) return fail(playing.engine.why);
    auto scene = GroomScene::make(groom, view, options.hiddenGroups);
    if (!scene) return tl::unexpected(scene.error());
    auto made =
        LiveShots::make(gpu.device(), gpu.kernels(), std::move(*scene), *playing.motion, playing.engine.kind);
    if (!made) return tl::unexpected(made.error());
    playing.shots = std::move(*made);
    return playing;
}

bool hasTubes(const Groom& groom) {
    const auto tubes = [](const HairMaterial& material) { return material.tubes; };
    return tubes(groom.material) || std::ranges::any_of(groom.layers, [&](const Layer& layer) {
               return layer.material && tubes(*layer.material);
           });
}

/// What was asked for, else the best GPU, else the software renderer.
Result<DrawingDevice> deviceOf(const RenderJobOptions& options, const Groom& groom) {
    const bool byPasses = options.ribbons == "strip" || options.ribbons == "tess" ||
                          options.transparency == "weighted" || hasTubes(groom);
    if (options.engine == "software") {
        if (byPasses)
            return fail(
                "the software renderer draws neither strips, tessellated ribbons, weighted transparency nor "
                "tubes",
                "--engine auto, which draws them with a graphics API");
        return DrawingDevice{std::make_unique<GpuBackend>(software::makeDevice()), {}};
    }
    if (options.chooseDevice || options.backend != "any" || options.engine == "gpu") {
        std::optional<gpu::Backend> backend;
        if (options.backend != "any") backend = kGpuBackends.at(options.backend);
        auto made =
            GpuBackend::make(backend, options.chooseDevice ? std::optional(options.device) : std::nullopt);
        if (!made) return tl::unexpected(made.error());
        return DrawingDevice{std::move(*made), {}};
    }
    return chooseDrawingDevice(byPasses);
}

Result<Report> renderToFile(const RenderJobOptions& options) {
    ViewFile view;
    if (!options.view.empty()) {
        auto read = readViewFile(options.view, {options.imageFolders.begin(), options.imageFolders.end()});
        if (!read) return tl::unexpected(read.error());
        view = std::move(*read);
    }
    if (!options.shading.empty()) view.fibre.model = kShadingModels.at(options.shading);
    view.fibre.scattering = options.scatter == "dual" ? render::Scattering::dual : render::Scattering::single;
    auto how = pictureOptions(options, view);
    if (!how) return tl::unexpected(how.error());
    const auto shots = shotsOf(options);
    if (!shots) return tl::unexpected(shots.error());
    auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (!options.material.empty()) {
        const auto status = applyMaterial(findSamples(programFolder()), options.material, *groom);
        if (!status) return tl::unexpected(status.error());
    }
    const auto device = deviceOf(options, *groom);
    if (!device) return tl::unexpected(device.error());
    gpu::Device& draws = device->backend->device();
    if (software::isSoftware(draws)) takeWaysOfSoftware(*how);

    const auto playing = play(options, *device->backend, *groom, view);
    if (!playing) return tl::unexpected(playing.error());
    Photographer photographer(options, draws, *groom, view, *how, playing->shots.get());
    std::vector<std::string> notes;
    if (playing->shots) notes = bodyNotes(*groom, playing->motion->poseAt(0), true);
    if (!options.record.empty()) {
        const auto first = readFrame(options.record, *groom, 0);
        if (!first) return tl::unexpected(first.error());
        notes = recordNotes(*groom, first->pose);
    }
    if (!device->note.empty()) notes.push_back(device->note);
    std::vector<render::Image> images;
    Report report;
    std::optional<Progress> progress;
    if (shots->size() > 1) progress.emplace("drawing", shots->size());
    for (std::size_t i = 0; i < shots->size(); ++i) {
        const auto picture = photographer.take((*shots)[i]);
        if (!picture) return tl::unexpected(picture.error());
        if (auto written = writePictures(options, *picture, i); !written)
            return tl::unexpected(written.error());
        if (i == 0) report = reportOf(*picture, options);
        if (i == 0 && playing->shots) {
            report["engine"] = engineName(playing->engine.kind);
            report["why"] = playing->engine.why;
        }
        if (!options.animation.empty() || !options.strip.empty()) images.push_back(picture->image);
        if (progress) progress->done(i + 1);
    }
    progress.reset();
    reportNotes(notes, report);
    if (options.sequence()) report["pictures"] = shots->size();
    if (!options.animation.empty()) {
        auto written = writeAnimation(options.animation, images, options.milliseconds);
        if (!written) return tl::unexpected(written.error());
    }
    if (!options.strip.empty()) {
        if (auto written = render::writePng(options.strip, sideBySide(images)); !written) {
            return tl::unexpected(written.error());
        }
    }
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<RenderJobOptions>();
    job.add_option("groom", options->input, "Project or hair file")->required();
    job.add_option("--size", options->size,
                   "Image size WxH in pixels (default: that of the view, or 1024x1024)");
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
    job.add_option("--shading", options->shading, "Shading model (default: the project's)")
        ->check(CLI::IsMember(namesOf(kShadingModels)));
    job.add_option("--scatter", options->scatter,
                   "Light scattered by other hairs: single ignores it, dual adds it. Not for kajiya")
        ->check(CLI::IsMember({"single", "dual"}));
    job.add_option(
           "--shadow", options->shadow,
           "Hair shadows: deep opacity maps, absorption by depth, opacity maps at fixed depths, or none")
        ->check(CLI::IsMember(namesOf(kShadows)));
    job.add_option("--shadow-lights", options->shadowLights,
                   "Maximum number of lights with shadow maps. Area lights and bright parts of images are "
                   "split into this many")
        ->check(CLI::Range(std::size_t{1}, render::kMaxLights));
    job.add_option("--head-absorption", options->headAbsorption,
                   "Fades light on hair behind the head with depth, per metre. 0 blocks it")
        ->check(CLI::Range(0.0f, render::kMaxHeadAbsorption));
    job.add_option("--shadow-blur", options->shadowBlur,
                   "Screen-space shadow blur in pixels, which draws everything twice. 0 turns it off")
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
           "covers a random part of the samples, fixed a fixed part, weighted blends in any order. auto uses "
           "stochastic for averaged frames, sorted for single frames on a GPU, and weighted otherwise")
        ->check(CLI::IsMember(namesOf(kTransparency)));
    job.add_option("--detail", options->detail,
                   "Skip hairs thinner than this part of a pixel and widen the others. 0 draws all")
        ->check(CLI::Range(0.0, 100.0));
    job.add_option("--exposure", options->exposure, "Exposure: multiplies light before the tone curve")
        ->check(CLI::Range(1e-3, 1e3));
    auto* passes = job.add_option("--passes", options->passes,
                                  "Number of frames to average, each with a sub-pixel offset")
                       ->check(CLI::Range(1, 1024));
    auto* record = job.add_option("--record", options->record, "Frames that simulate --record wrote");
    auto* motion = job.add_option("--motion", options->motion,
                                  "Simulate the hair while rendering, with this head motion: none, spin, "
                                  "nod, clip:NAME or a keyframe file F.json")
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
           "with the graphics API only. software draws and simulates without a graphics API")
        ->check(CLI::IsMember({"auto", "cpu", "gpu", "software"}));
    auto* frame = job.add_option("--frame", options->frame,
                                 "Frame of the record, counted from 0, or of the simulation in 1/60 s");
    auto* frames =
        job.add_option("--frames", options->frames, "Frames FIRST,LAST[,STEP] to render, one image each")
            ->delimiter(',')
            ->excludes(frame);
    job.add_option("--turntable", options->turntable,
                   "Number of images for one turn of the camera around the hair")
        ->check(CLI::Range(1, 10'000))
        ->excludes(frames);
    job.add_option("--animation", options->animation,
                   "Animated PNG for all images, or WebP if the name ends in .webp");
    job.add_option("--strip", options->strip, "PNG with all images side by side");
    job.add_option("--milliseconds", options->milliseconds, "Frames per second of the animation")
        ->check(CLI::Range(1, 65'535));
    auto* exr = job.add_option("--exr", options->exr,
                               "OpenEXR file for linear light, before exposure and tone curve");
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
    job.final_callback([options, device, frame, frames] {
        options->chooseDevice = device->count() > 0;
        const bool moves = !options->record.empty() || !options->motion.empty();
        for (const CLI::Option* option : {frame, frames}) {
            if (option->count() > 0 && !moves)
                throw CLI::RequiresError(option->get_name(), "--record or --motion");
        }
        if ((options->engine == "cpu" || options->engine == "gpu") && options->motion.empty())
            throw CLI::RequiresError("--engine " + options->engine, "--motion");
        if (options->engine == "software" && (options->chooseDevice || options->backend != "any"))
            throw CLI::ExcludesError("--engine software", options->chooseDevice ? "--device" : "--backend");
    });
    return [options](const std::string&) {
        if (!options->motion.empty()) checkMotion(options->motion);
        const auto shots = shotsOf(*options);
        if (!shots) return Result<Report>(tl::unexpected(shots.error()));
        const std::size_t files = options->sequence() ? shots->size() : 0;
        return withOutputs({{options->output, content::kPng, files},
                            {options->exr, {}, files},
                            {options->animation},
                            {options->strip, content::kPng}},
                           [&] { return renderToFile(*options); });
    };
}

}  // namespace

Job renderJob() {
    return {"render", "Render an image without a window",
            "hair.hairloom -o hair.png --size 1024x1024 --camera three-quarter", declare};
}

}  // namespace hairloom::cli
