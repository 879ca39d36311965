// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/backend.h"
#include "cli/body_notes.h"
#include "cli/burn_in.h"
#include "cli/colour_options.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/live_shots.h"
#include "cli/motions.h"
#include "cli/outputs.h"
#include "cli/plan_report.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/show_job.h"
#include "core/base/content_kind.h"
#include "core/base/output_batch.h"
#include "core/documents/look_presets.h"
#include "core/documents/sample.h"
#include "core/documents/sample_material.h"
#include "core/documents/takes.h"
#include "core/groom/time_line.h"
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

/// With the material that the time line keys in this frame of a take of it.
Result<Groom> lookOfFrame(const RenderJobOptions& options, Groom groom, std::uint64_t number) {
    const TimeLine& line = timeLineOf(groom);
    if (options.record.empty() || !keysMaterial(line) || !isTake(options.record)) return groom;
    const auto take = TakeReader::open(options.record);
    if (!take) return tl::unexpected(take.error());
    if (const auto seconds = timeLineSeconds(take->info(), number))
        groom.material = materialAt(line, line.timeAt(*seconds), groom.material);
    return groom;
}

Result<GroomScene> loadScene(const RenderJobOptions& options, const Groom& authored, std::uint64_t number,
                             const ViewFile& view) {
    const auto looks = lookOfFrame(options, authored, number);
    if (!looks) return tl::unexpected(looks.error());
    const Groom& groom = *looks;
    // How hair is clumped is of its authored thickness, as where it plays.
    auto scene = GroomScene::make(authored, view, options.hiddenGroups);
    if (!scene || options.record.empty()) return scene;
    scene->setMaterials(groom, view);
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

/// Row by row, all of the first's size. What is left of the last row is transparent.
render::Image sheetOf(const std::vector<render::Image>& images, std::size_t columns) {
    const std::uint32_t width = images[0].width, height = images[0].height;
    const std::size_t rows = (images.size() + columns - 1) / columns;
    render::Image sheet{
        static_cast<std::uint32_t>(columns) * width, static_cast<std::uint32_t>(rows) * height, {}};
    sheet.rgba.resize(std::size_t{4} * sheet.width * sheet.height);
    for (std::size_t i = 0; i < images.size(); ++i) {
        for (std::size_t y = 0; y < height; ++y) {
            const auto row = images[i].rgba.begin() + static_cast<std::ptrdiff_t>(4 * y * width);
            const std::size_t place = ((i / columns * height + y) * columns + i % columns) * width;
            std::copy_n(row, std::size_t{4} * width,
                        sheet.rgba.begin() + static_cast<std::ptrdiff_t>(4 * place));
        }
    }
    return sheet;
}

Report pictureReport(const render::Picture& picture, const RenderJobOptions& options) {
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

Status writePictures(const RenderJobOptions& options, const std::optional<colour::Colours>& colours,
                     render::Picture picture, std::size_t number) {
    const bool many = options.sequence();
    const auto name = [&](const std::string& path) {
        return many ? numbered(path, number) : std::filesystem::path(path);
    };
    if (!options.output.empty()) {
        if (auto written = render::writePng(name(options.output), picture.image); !written) return written;
    }
    if (options.exr.empty()) return {};
    render::LinearSpace space;
    if (colours) {
        const colour::WorkingSpace& working = colours->config.working();
        space = working.linear;
        render::convert(picture.linear.rgba, *working.fromRec709);
        for (render::SurfacePixel& pixel : picture.surface) working.fromRec709->apply(pixel.albedo);
    }
    const auto layers = render::aovLayers(options.aovs, picture.surface);
    if (!layers) return tl::unexpected(layers.error());
    return render::writeExr(name(options.exr), picture.linear, *layers, space);
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
    if (wish == EngineWish::gpu && playing.engine.kind != EngineKind::gpu)
        return fail(playing.engine.why, "expected a groom that the engine can run on a GPU, or --engine cpu");
    const runtime::SimulationSettings authored = groom.simulation;
    groom.simulation = KeyedSettings(*playing.motion, authored).first();
    auto scene = GroomScene::make(groom, view, options.hiddenGroups);
    if (!scene) return tl::unexpected(scene.error());
    auto made = LiveShots::make(gpu.device(), gpu.kernels(), std::move(*scene), *playing.motion, authored,
                                options.motion == kTimeLineMotion ? paceOf(timeLineOf(groom)) : FramePace(),
                                playing.engine.kind, view,
                                options.motion == kTimeLineMotion ? groom.timeLine : nullptr);
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

/// What draws; where hair moves, what simulates it.
void reportEngine(const RenderJobOptions& options, const DrawingDevice& device, const Playing& playing,
                  Report& report) {
    if (playing.shots) {
        report["engine"] = engineName(playing.engine.kind);
        report["why"] = playing.engine.why;
        return;
    }
    const bool byProcessor = software::isSoftware(device.backend->device());
    report["engine"] = byProcessor ? "software" : "gpu";
    report["why"] = !device.note.empty() ? device.note
                    : options.engine == (byProcessor ? "software" : "gpu")
                        ? "you asked for it"
                        : "this machine has a device that draws";
}

}  // namespace

Result<Report> renderToFile(const RenderJobOptions& options) {
    ViewFile view;
    if (!options.view.empty()) {
        auto read = readViewFile(options.view, {options.imageFolders.begin(), options.imageFolders.end()});
        if (!read) return tl::unexpected(read.error());
        view = std::move(*read);
    }
    if (!options.shading.empty()) view.fibre.model = kShadingModels.at(options.shading);
    view.fibre.scattering = kScatterings.at(options.scatter);
    auto how = pictureOptions(options, view);
    if (!how) return tl::unexpected(how.error());
    const auto colours = colour::chooseColours(options.colours);
    if (!colours) return tl::unexpected(colours.error());
    if (*colours) how->toDisplay = (*colours)->toDisplay;
    const auto shots = shotsOf(options);
    if (!shots) return tl::unexpected(shots.error());
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    takeShadows(options, groom->shadows, view, *how);
    if (const LookPreset* look = findLook(options.look)) {
        applyLook(*look, *groom);
    } else if (auto status = applyLookOfView(options.view, view.look, *groom); !status) {
        return tl::unexpected(status.error());
    }
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
    if (*colours && !(*colours)->config.working().note.empty())
        notes.push_back((*colours)->config.working().note);
    BurnIn burnIn(options, *groom);
    std::vector<render::Image> images;  // of the strip
    std::optional<AnimationFile> animation;
    if (!options.animation.empty()) {
        constexpr double kSecond = 1000;
        auto opened = AnimationFile::open(options.animation, how->width, how->height,
                                          options.framesPerSecond.value_or(kSecond / options.milliseconds));
        if (!opened) return tl::unexpected(opened.error());
        animation = std::move(*opened);
    }
    Report report;
    std::optional<Progress> progress;
    if (shots->size() > 1) progress.emplace("drawing", shots->size());
    for (std::size_t i = 0; i < shots->size(); ++i) {
        auto picture = photographer.take((*shots)[i]);
        if (!picture) return tl::unexpected(picture.error());
        if (i == 0) report = pictureReport(*picture, options);
        if (i == 0 && *colours) report["color"] = colourReport(**colours);
        if (i == 0) reportEngine(options, *device, *playing, report);
        if (auto status = burnIn.draw((*shots)[i], i, picture->image); !status)
            return tl::unexpected(status.error());
        if (!options.strip.empty()) images.push_back(picture->image);
        if (animation) {
            if (auto added = animation->add(picture->image); !added) return tl::unexpected(added.error());
        }
        if (auto written = writePictures(options, *colours, std::move(*picture), options.firstNumber() + i);
            !written)
            return tl::unexpected(written.error());
        if (progress) progress->done(i + 1);
    }
    progress.reset();
    reportNotes(notes, report);
    burnIn.report(report);
    if (options.sequence()) report["pictures"] = shots->size();
    if (animation) {
        if (auto written = animation->finish(); !written) return tl::unexpected(written.error());
    }
    if (!options.strip.empty()) {
        const std::size_t columns =
            options.columns > 0 ? std::min<std::size_t>(options.columns, images.size()) : images.size();
        if (auto written = render::writePng(options.strip, sheetOf(images, columns)); !written)
            return tl::unexpected(written.error());
    }
    return report;
}

namespace {

JobRun declare(CLI::App& job) {
    const auto options = addRenderOptions(job);
    return [options](const std::string&) {
        if (!options->show.empty())
            return withOutputs({{options->output, content::kPng}}, [&] { return showToFile(*options); });
        if (!options->motion.empty()) checkMotion(options->motion);
        const auto shots = shotsOf(*options);
        if (!shots) return Result<Report>(tl::unexpected(shots.error()));
        const std::size_t files = options->sequence() ? shots->size() : 0;
        const std::size_t first = options->firstNumber();
        return withOutputs({{options->output, content::kPng, files, first},
                            {options->exr, {}, files, first},
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
