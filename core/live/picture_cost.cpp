// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/picture_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <memory>

#include "core/cost/scene_run.h"
#include "core/gpu/frames_under_way.h"
#include "core/live/hair_look.h"
#include "core/render/flip.h"
#include "core/render/picture.h"
#include "core/render/renderer.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kWarmUp = 8;  ///< frames, until a GPU is at speed
constexpr std::size_t kUnderWay = 2;  ///< frames

/// All that a picture is drawn from and that a setting may change.
struct Settings {
    render::RenderOptions picture;
    render::Scattering scattering = render::Scattering::volume;
    std::uint32_t followPerGuide = 0;

    bool operator==(const Settings&) const = default;
};

struct Candidate {
    std::string setting, value;
    Settings settings;
};

/// Settings in the order of the Look panel.
class Candidates {
  public:
    Candidates(const Settings& now, std::uint32_t mostSamples, bool scatters) : now_(now) {
        for (std::uint32_t samples = 1; samples <= mostSamples; samples *= 2)
            add("samples", fmt::to_string(samples), [&](Settings& s) { s.picture.samples = samples; });
        using render::PostFilter, render::Ribbons, render::Shadows, render::Transparency;
        choices<PostFilter>(
            "filter", &render::RenderOptions::filter,
            {{"none", PostFilter::none}, {"fxaa", PostFilter::fxaa}, {"fxaaHigh", PostFilter::fxaaHigh}});
        addTransparency();
        choices<Ribbons>("ribbons", &render::RenderOptions::ribbons,
                         {{"automatic", Ribbons::automatic},
                          {"strip", Ribbons::strip},
                          {"tessellated", Ribbons::tessellated},
                          {"compute", Ribbons::compute}});
        numbers("subdivisions", {1, 2, 4}, &render::RenderOptions::subdivisions);
        choices<Shadows>("shadows", &render::RenderOptions::shadows,
                         {{"none", Shadows::none},
                          {"absorption", Shadows::absorption},
                          {"opacityMaps", Shadows::opacityMaps},
                          {"deepOpacity", Shadows::deepOpacity},
                          {"adaptive", Shadows::adaptive}});
        if (now.picture.shadows != Shadows::none) {
            using render::ShadowFilter;
            numbers("shadowResolution", {256, 512, 1024, 2048}, &render::RenderOptions::shadowResolution);
            choices<ShadowFilter>(
                "shadowFilter", &render::RenderOptions::shadowFilter,
                {{"off", ShadowFilter::off}, {"3x3", ShadowFilter::three}, {"5x5", ShadowFilter::five}});
        }
        if (now.picture.shadows == Shadows::deepOpacity) {
            using render::LayerEnds;
            numbers("shadowLayers", {3, 7, 11}, &render::RenderOptions::shadowLayers);
            choices<LayerEnds>("layerEnds", &render::RenderOptions::layerEnds,
                               {{"early", LayerEnds::early},
                                {"linear", LayerEnds::linear},
                                {"growing", LayerEnds::growing}});
        }
        if (now.picture.shadows == Shadows::opacityMaps) {
            numbers("shadowSlices", {4, 8, 16}, &render::RenderOptions::shadowSlices);
        }
        if (now.picture.shadows == Shadows::adaptive) {
            numbers("shadowNodes", {4, 8, 16}, &render::RenderOptions::shadowNodes);
        }
        if (scatters) {
            add("scattering", "single", [](Settings& s) { s.scattering = render::Scattering::single; });
            add("scattering", "dual", [](Settings& s) { s.scattering = render::Scattering::dual; });
            add("scattering", "volume", [](Settings& s) { s.scattering = render::Scattering::volume; });
        }
        if (now.followPerGuide > 0) addFollowHairs();
    }
    const std::vector<Candidate>& list() const { return list_; }

  private:
    template <class Change>
    void add(const char* setting, std::string value, const Change& change) {
        Candidate candidate{setting, std::move(value), now_};
        change(candidate.settings);
        list_.push_back(std::move(candidate));
    }
    template <class T>
    void choices(const char* setting, T render::RenderOptions::*member,
                 const std::vector<std::pair<const char*, T>>& values) {
        for (const auto& choice : values)
            add(setting, choice.first, [&](Settings& s) { s.picture.*member = choice.second; });
    }
    void numbers(const char* setting, std::vector<std::uint32_t> values,
                 std::uint32_t render::RenderOptions::*member) {
        values.push_back(now_.picture.*member);
        std::ranges::sort(values);
        values.erase(std::unique(values.begin(), values.end()), values.end());
        for (const std::uint32_t value : values)
            add(setting, fmt::to_string(value), [&](Settings& s) { s.picture.*member = value; });
    }
    void addTransparency() {
        using render::Transparency;
        choices<Transparency>("transparency", &render::RenderOptions::transparency,
                              {{"automatic", Transparency::automatic},
                               {"weighted", Transparency::weighted},
                               {"stochastic", Transparency::stochastic},
                               {"sorted", Transparency::sorted}});
        for (Candidate& candidate : list_) {  // ribbons that can blend so
            render::RenderOptions& picture = candidate.settings.picture;
            const bool byKernels = picture.ribbons == render::Ribbons::compute;
            if (candidate.settings != now_ && picture.ribbons != render::Ribbons::automatic &&
                (byKernels ? picture.transparency == Transparency::weighted
                           : picture.transparency == Transparency::sorted))
                picture.ribbons = render::Ribbons::automatic;
        }
    }
    void addFollowHairs() {
        std::uint32_t before = 0;
        for (const std::uint32_t part : {4u, 2u, 1u}) {
            const std::uint32_t count = std::max(1u, now_.followPerGuide / part);
            if (count == before) continue;
            add("followPerGuide", fmt::to_string(count), [&](Settings& s) { s.followPerGuide = count; });
            before = count;
        }
    }

    const Settings& now_;
    std::vector<Candidate> list_;
};

/// Sum of light over the pixels that show hair in the right picture.
double hairLight(const render::LinearImage& image, std::span<const render::SurfacePixel> surface) {
    double sum = 0;
    for (std::size_t p = 0; p < surface.size(); ++p) {
        if (!surface[p].hasStrand()) continue;
        constexpr std::array kLuminance{0.2126, 0.7152, 0.0722};
        for (std::size_t c = 0; c < 3; ++c) sum += kLuminance[c] * static_cast<double>(image.rgba[4 * p + c]);
    }
    return sum;
}

std::size_t hairsPerStrand(const Groom& groom) {
    return std::max<std::size_t>(groom.interpolation.followPerGuide, 1);
}

Groom thinned(const Groom& groom, std::size_t mostHairs) {
    const std::size_t strands = std::max<std::size_t>(mostHairs / hairsPerStrand(groom), 1);
    if (mostHairs == 0 || strands >= groom.strandCount()) return groom;
    return sampleStrands(groom, strands, 1).groom;
}

class Measuring {
  public:
    Measuring(gpu::Device& device, const Groom& groom, const PictureCostOptions& options)
        : device_(device), groom_(thinned(groom, options.mostHairs)), options_(options), view_(options.view) {
        cost_.allHairs = groom.strandCount() * hairsPerStrand(groom);
    }

    Result<PictureCost> measure() {
        Settings now{options_.picture, view_.fibre.scattering, groom_.interpolation.followPerGuide};
        now.picture.surface = false;
        const auto samples = render::chooseSamples(now.picture, device_.info());
        if (!samples) return tl::unexpected(samples.error());
        now.picture.samples = *samples;
        const bool scatters = shadingModel(groom_.material, view_.fibre) != render::ShadingModel::kajiya;
        const Candidates candidates(now, mostSamples(), scatters);
        total_ = 2 + candidates.list().size();
        auto exact = draw(exactSettings(now));
        if (!exact) return tl::unexpected(exact.error());
        exact_ = std::move(*exact);
        exactLight_ = hairLight(exact_.linear, exact_.surface);
        step();
        auto asItIs = run(now);
        if (!asItIs) return tl::unexpected(asItIs.error());
        step();
        cost_.device = exact_.device;
        cost_.width = now.picture.width, cost_.height = now.picture.height;
        cost_.frames = now.picture.frames;
        cost_.hairs = exact_.strands;
        for (const Candidate& candidate : candidates.list()) {
            step();
            if (const Status can = canDraw(candidate.settings.picture); !can) {
                cost_.notes.push_back(fmt::format("Without {} {}: {}.", candidate.setting, candidate.value,
                                                  can.error().message()));
                continue;
            }
            const bool isNow = candidate.settings == now;
            auto one = isNow ? asItIs : run(candidate.settings);
            if (!one) return tl::unexpected(one.error());
            one->setting = candidate.setting;
            one->value = candidate.value;
            one->now = isNow;
            cost_.runs.push_back(std::move(*one));
        }
        return std::move(cost_);
    }

  private:
    std::uint32_t mostSamples() const {
        render::RenderOptions most;
        most.samples = 0;
        return render::chooseSamples(most, device_.info()).value_or(1);
    }
    Status canDraw(const render::RenderOptions& picture) const {
        if (auto samples = render::chooseSamples(picture, device_.info()); !samples)
            return tl::unexpected(samples.error());
        return render::check(picture, device_.info());
    }
    Settings exactSettings(const Settings& now) const {
        Settings exact = now;
        render::RenderOptions& picture = exact.picture;
        constexpr std::uint32_t kFineMap = 2048, kRound = 4;
        picture.samples = mostSamples();
        picture.frames = options_.exactFrames;
        picture.filter = render::PostFilter::none;
        picture.transparency = render::Transparency::stochastic;
        picture.ribbons = render::Ribbons::automatic;
        picture.subdivisions = std::max(picture.subdivisions, kRound);
        picture.shadows = render::Shadows::deepOpacity;
        picture.shadowResolution = std::max(picture.shadowResolution, kFineMap);
        picture.shadowBlur = 0;
        picture.detail = 0;
        picture.surface = true;
        exact.scattering = render::Scattering::volume;
        return exact;
    }

    void step() {
        ++done_;
        if (options_.progress) options_.progress(done_, total_);
    }

    /// Hair and what draws it: pipelines are compiled once for each, not for each picture.
    struct Shown {
        Shown(GroomScene made, gpu::Device& device) : scene(std::move(made)), renderer(device) {}
        GroomScene scene;
        render::Renderer renderer;
    };

    /// With so many follow hairs and that scattering, made once for each.
    Result<Shown*> shownFor(const Settings& settings) {
        auto& shown = shown_[{settings.followPerGuide, settings.scattering}];
        if (shown) return shown.get();
        Groom groom = groom_;
        groom.interpolation.followPerGuide = settings.followPerGuide;
        ViewFile view = view_;
        view.fibre.scattering = settings.scattering;
        auto made = GroomScene::make(groom, view, {});
        if (!made) return tl::unexpected(made.error());
        shown = std::make_unique<Shown>(std::move(*made), device_);
        render::RenderScene scene = shown->scene.scene();
        const float aspect =
            static_cast<float>(settings.picture.width) / static_cast<float>(settings.picture.height);
        if (!view_.camera)
            view_.camera = render::frame(render::View::ThreeQuarter, shown->scene.subject(), aspect);
        scene.camera = *view_.camera;
        lights_ = view_.hasLights ? view_.lights : render::studioLights(scene.camera);
        scene.lights = lights_;
        if (view_.hasLights) scene.environment = view_.environment;
        scene.background = view_.background.value_or(scene.background);
        if (auto set = shown->renderer.setScene(scene); !set) return tl::unexpected(set.error());
        return shown.get();
    }

    Result<render::Picture> draw(const Settings& settings) {
        if (options_.cancelled && options_.cancelled())
            return fail("measuring was cancelled", "expected it to run to its end");
        const auto shown = shownFor(settings);
        if (!shown) return tl::unexpected(shown.error());
        return render::renderPicture(device_, (*shown)->renderer, settings.picture);
    }

    /// Frames in which shadows are made anew, as for hair that moves. They follow each other without a pause:
    /// a GPU that is left waiting clocks itself down.
    Result<Quartiles> frameTime(const Settings& settings) {
        const auto shown = shownFor(settings);
        if (!shown) return tl::unexpected(shown.error());
        render::Renderer& renderer = (*shown)->renderer;
        render::RenderOptions options = settings.picture;
        options.frames = 1;
        gpu::TextureDesc desc;
        desc.name = "timed";
        desc.width = options.width;
        desc.height = options.height;
        desc.usage = gpu::Usage::RenderTarget;
        const auto target = device_.createTexture(desc);
        if (!target) return tl::unexpected(target.error());
        const bool software = device_.info().type == gpu::DeviceType::Cpu;
        const std::uint32_t warmUp = software ? 0 : kWarmUp;
        std::vector<double> times;
        gpu::FramesUnderWay underWay(kUnderWay, [&](const std::vector<gpu::PassTime>& passes) {
            double ms = 0;
            for (const gpu::PassTime& pass : passes) ms += pass.milliseconds;
            times.push_back(ms);
        });
        for (std::uint32_t frame = 0; frame < warmUp + options_.repeats; ++frame) {
            if (auto set = renderer.setLights(lights_); !set) return tl::unexpected(set.error());
            auto list = device_.createCommandList();
            if (!list) return tl::unexpected(list.error());
            if (auto status = renderer.record(**list, options, *target); !status)
                return tl::unexpected(status.error());
            auto submission = device_.submit(std::move(*list));
            if (!submission) return tl::unexpected(submission.error());
            if (auto status = underWay.add(std::move(*submission)); !status)
                return tl::unexpected(status.error());
        }
        if (auto status = underWay.finish(); !status) return tl::unexpected(status.error());
        times.erase(times.begin(), times.begin() + warmUp);
        return quartiles(std::move(times));
    }

    Result<PictureCostRun> run(const Settings& settings) {
        const auto picture = draw(settings);
        if (!picture) return tl::unexpected(picture.error());
        const auto time = frameTime(settings);
        if (!time) return tl::unexpected(time.error());
        PictureCostRun run;
        run.milliseconds = *time;
        const auto flip = render::flipDifference(exact_.image, picture->image);
        if (!flip) return tl::unexpected(flip.error());
        run.flip = flip->mean;
        run.light = exactLight_ > 0 ? hairLight(picture->linear, exact_.surface) / exactLight_ : 1;
        return run;
    }

    gpu::Device& device_;
    Groom groom_;
    const PictureCostOptions& options_;
    ViewFile view_;
    std::vector<render::Light> lights_;
    PictureCost cost_;
    render::Picture exact_;
    double exactLight_ = 0;  ///< of its hair
    std::map<std::pair<std::uint32_t, render::Scattering>, std::unique_ptr<Shown>> shown_;
    std::size_t done_ = 0, total_ = 0;
};

}  // namespace

std::size_t mostHairsOn(const gpu::Device& device) {
    constexpr std::size_t kOfSoftware = 2000;
    return device.info().type == gpu::DeviceType::Cpu ? kOfSoftware : 0;
}

Result<PictureCost> measurePictureCost(gpu::Device& device, const Groom& groom,
                                       const PictureCostOptions& options) {
    assert(options.repeats >= 1);
    if (groom.strandCount() == 0) return fail("the groom has no strands", "expected strands to draw");
    return Measuring(device, groom, options).measure();
}

}  // namespace hairloom
