// SPDX-License-Identifier: GPL-3.0-or-later
// What drawing hair costs on a device, with what is changed one at a time.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <tuple>

#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/cost/head_scene.h"
#include "core/gpu/device.h"
#include "core/live/groom_scene.h"
#include "core/render/renderer.h"
#include "core/software/device.h"

namespace hairloom::benchmarks {
namespace {

constexpr int kWarmUp = 3;  ///< frames at least
/// Seconds at least, on a GPU: it slows down while a scene is made, and needs as long to be at its speed
/// again.
constexpr double kWarmUpOnGpu = 0.4;

/// One way of drawing one scene. Each frame has other positions, so that every pass runs.
struct RenderCase {
    std::string name;
    const Sample* sample = nullptr;  ///< else a made-up head
    std::uint32_t hairs = 0;
    render::FibreMaterial shading;  ///< that of Marschner, single scattering, unless the name says otherwise
    render::RenderOptions options;
    bool sky = false;   ///< light from around as well
    Measurement frame;  ///< all passes on the device, ms; wall time where it has no clock
    Measurement wall;   ///< from recording to the end on the device, ms, with the upload of positions
    std::vector<Measurement> passes;  ///< ms
    /// Of a frame's passes, where they are counted.
    std::vector<std::pair<std::string, gpu::PassCounts>> counts;
    std::uint64_t meshTriangles = 0;
    std::uint64_t targetBytes = 0;
    bool software = false;        ///< by the software renderer
    std::optional<double> limit;  ///< ms that the frame may take, where that is laid down for this device

    /// What is measured is the same, whatever its name.
    bool isLike(const RenderCase& other) const {
        return sample == other.sample && hairs == other.hairs && shading == other.shading &&
               options == other.options && sky == other.sky && software == other.software;
    }
    void takeTimes(const RenderCase& other) {
        frame = other.frame, wall = other.wall, passes = other.passes;
        targetBytes = other.targetBytes;
    }
    bool met() const { return !limit || frame.median() <= *limit; }
};

struct RenderBench {
    gpu::DeviceInfo device;
    std::vector<RenderCase> cases;
    std::vector<std::string> notes;  ///< what could not be measured, and why
};

inline constexpr std::uint32_t kBenchSegments = 18;

/// A scene whose strands are in one place in one frame, in another in the next.
struct Subject {
    virtual ~Subject() = default;
    virtual render::RenderScene scene() const = 0;

    std::vector<Vec3f> hair;
    std::vector<Vec3f> moved;  ///< the same, blown aside
};

/// `along` from 0 at the root to 1.
Vec3f blownAside(const Vec3f& p, float along) {
    return p + Vec3f(0.03f, 0.01f, 0.015f) * (along * along);
}

/// A head, and hair combed down from its crown.
struct CombedHead : Subject {
    scenes::HeadSkin head{48, 96};
    std::vector<std::uint32_t> offsets{0};

    explicit CombedHead(std::uint32_t hairs) {
        Random random(7);
        for (std::uint32_t i = 0; i < hairs; ++i) {
            const float around = random.uniform(0, 2 * kPi);
            const float down = std::acos(1 - random.uniform() * 0.75f);
            const float lift = random.uniform(1.01f, 1.12f);
            const float wave = random.uniform(0, 2 * kPi);
            for (std::uint32_t k = 0; k <= kBenchSegments; ++k) {
                const float along = static_cast<float>(k) / kBenchSegments;
                const float grown = 1 + (lift - 1) * std::min(1.0f, 4 * along);
                const float side = around + 0.03f * std::sin(9 * along + wave);
                hair.push_back(scenes::onHead(grown, down + 1.3f * along, side));
                moved.push_back(blownAside(hair.back(), along));
            }
            offsets.push_back(static_cast<std::uint32_t>(hair.size()));
        }
    }

    render::RenderScene scene() const override {
        render::RenderScene scene;
        render::RenderMesh mesh;
        mesh.positions_ws = head.points;
        mesh.indices = head.indices;
        scene.meshes = {mesh};
        render::RenderStrands strands;
        strands.offsets = offsets;
        strands.positions_ws = hair;
        scene.strands = {strands};
        return scene;
    }
};

/// A sample hairstyle as the editor draws it, follow hairs and all.
class SampleHead : public Subject {
  public:
    static Result<std::unique_ptr<SampleHead>> make(const Groom& groom) {
        auto scene = GroomScene::make(groom, {}, {});
        if (!scene) return tl::unexpected(scene.error());
        return std::unique_ptr<SampleHead>(new SampleHead(std::move(*scene)));
    }
    render::RenderScene scene() const override { return scene_.scene(); }
    std::uint32_t hairs() const { return hairs_; }

  private:
    explicit SampleHead(GroomScene scene) : scene_(std::move(scene)) {
        const render::RenderScene drawn = scene_.scene();
        const render::RenderStrands& strands = drawn.strands.front();
        hair.assign(strands.positions_ws.begin(), strands.positions_ws.end());
        hairs_ = static_cast<std::uint32_t>(strands.offsets.size() - 1);
        for (std::uint32_t s = 0; s < hairs_; ++s) {
            const std::uint32_t first = strands.offsets[s], last = strands.offsets[s + 1] - 1;
            for (std::uint32_t p = first; p <= last; ++p) {
                const float along = static_cast<float>(p - first) / static_cast<float>(last - first);
                moved.push_back(blownAside(hair[p], along));
            }
        }
    }

    GroomScene scene_;
    std::uint32_t hairs_ = 0;
};

Measurement& passOf(RenderCase& which, const std::string& name) {
    const auto found = std::ranges::find(which.passes, name, &Measurement::name);
    if (found != which.passes.end()) return *found;
    which.passes.push_back({name, "ms", {}});
    return which.passes.back();
}

class RenderMeasuring {
  public:
    RenderMeasuring(gpu::Device& device, int repetitions) : device_(device), repetitions_(repetitions) {}

    Status run(RenderCase& which) {
        if (auto status = take(which); !status) return status;
        render::RenderScene scene = hair_->scene();
        scene.strands[0].material.fibre = which.shading;
        const float aspect =
            static_cast<float>(which.options.width) / static_cast<float>(which.options.height);
        scene.camera = render::frame(render::View::ThreeQuarter, render::boundsOf(scene), aspect);
        scene.lights = render::studioLights(scene.camera);
        // The thesis has one light, and so has the target.
        scene.lights.resize(1);
        if (!which.sky) scene.environment = {};
        gpu::TextureDesc desc;
        desc.name = "bench";
        desc.width = which.options.width;
        desc.height = which.options.height;
        desc.usage = gpu::Usage::RenderTarget;
        const auto target = device_.createTexture(desc);
        if (!target) return tl::unexpected(target.error());
        render::Renderer renderer(device_);
        if (auto status = renderer.setScene(scene); !status) return status;
        which.frame = {"frame", "ms", {}};
        which.wall = {"wall", "ms", {}};
        const bool warms = device_.info().type != gpu::DeviceType::Cpu && !software::isSoftware(device_);
        const double warmUp = warms ? kWarmUpOnGpu : 0;
        const Stopwatch watch;
        for (int i = 0; i < kWarmUp || watch.seconds() < warmUp; ++i) {
            if (auto status = frame(which, renderer, *target, i, false); !status) return status;
        }
        for (int i = 0; i < repetitions_; ++i) {
            if (auto status = frame(which, renderer, *target, i, true); !status) return status;
        }
        which.targetBytes = renderer.plan().bytes();
        which.meshTriangles = renderer.triangles();
        return {};
    }

  private:
    /// Keeps the hair of the case before where it is the same.
    Status take(RenderCase& which) {
        if (which.sample != nullptr) {
            auto made = SampleHead::make(which.sample->groom);
            if (!made) return tl::unexpected(made.error());
            which.hairs = (*made)->hairs();
            hair_ = std::move(*made);
            hairs_ = 0;
        } else if (hair_ == nullptr || hairs_ != which.hairs) {
            hair_ = std::make_unique<CombedHead>(which.hairs);
            hairs_ = which.hairs;
        }
        return {};
    }

    Status frame(RenderCase& which, render::Renderer& renderer, const gpu::TexturePtr& target, int number,
                 bool counts) {
        const Stopwatch watch;
        auto status = renderer.setStrandPositions(0, number % 2 == 0 ? hair_->hair : hair_->moved);
        if (!status) return status;
        auto list = device_.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (status = renderer.record(**list, which.options, target); !status) return status;
        const auto submission = device_.submit(std::move(*list));
        if (!submission) return tl::unexpected(submission.error());
        const auto times = (*submission)->passTimes();
        if (!times) return tl::unexpected(times.error());
        if (!counts) return {};
        double sum = 0;
        for (const gpu::PassTime& time : *times) {
            passOf(which, time.name).values.push_back(time.milliseconds);
            if (time.counts) which.counts.emplace_back(time.name, *time.counts);
            sum += time.milliseconds;
        }
        which.wall.values.push_back(1e3 * watch.seconds());
        which.frame.values.push_back(device_.info().timestampPeriodNs > 0 ? sum : which.wall.values.back());
        return {};
    }

    gpu::Device& device_;
    int repetitions_;
    std::unique_ptr<Subject> hair_;
    std::uint32_t hairs_ = 0;  ///< of a made-up head; 0 for a sample
};

class CaseList {
  public:
    CaseList(const Options& wanted, const std::vector<Sample>& samples, const gpu::DeviceInfo& device,
             RenderBench& bench)
        : samples_(samples), device_(device), bench_(bench), gpu_(device.type != gpu::DeviceType::Cpu) {
        counts_ = wanted.hairs;
        if (counts_.empty()) {
            counts_ = gpu_ ? std::vector<std::uint32_t>{3'100, 9'300, 18'300, 100'000}
                           : std::vector<std::uint32_t>{3'100};
        }
        size_ = wanted.size.value_or(gpu_ ? std::pair(1920u, 1080u) : std::pair(320u, 180u));
        // What Section 6.4 of the thesis measured anti-aliasing at.
        thesisSize_ = wanted.size.value_or(gpu_ ? std::pair(1706u, 979u) : std::pair(320u, 180u));
        middle_ = wanted.hairs.empty() ? (gpu_ ? 18'300u : 3'100u) : counts_.front();
    }

    void add() {
        for (const Sample& sample : samples_) {
            add(sample.name, 0, size_, [](auto&) {});
            bench_.cases.back().sample = &sample;
        }
        for (const std::uint32_t hairs : counts_) {
            const bool limited = gpu_ && hairs == 100'000 && size_ == std::pair(1920u, 1080u);
            add(
                fmt::format("{} hairs", hairs), hairs, size_, [](render::RenderOptions&) {},
                limited ? std::optional(12.0) : std::nullopt);
        }
        const bool limited = gpu_ && middle_ == 18'300 && thesisSize_ == std::pair(1706u, 979u);
        add(
            "the thesis' setting", middle_, thesisSize_, [](render::RenderOptions&) {},
            limited ? std::optional(3.0) : std::nullopt);
        addShading();
        addAntiAliasing();
        vary("shadows: none", [](auto& o) { o.shadows = render::Shadows::none; });
        vary("shadows: absorption", [](auto& o) { o.shadows = render::Shadows::absorption; });
        vary("shadows: opacity maps", [](auto& o) { o.shadows = render::Shadows::opacityMaps; });
        vary("shadows: deep opacity maps", [](auto&) {});
        vary("shadows: adaptive, 8 nodes", [](auto& o) { o.shadows = render::Shadows::adaptive; });
        vary("ribbons: compute", [](auto& o) { o.ribbons = render::Ribbons::compute; });
        vary("ribbons: strip", [](auto& o) { o.ribbons = render::Ribbons::strip; });
        if (device_.tessellation) {
            vary("ribbons: tessellated", [](auto& o) { o.ribbons = render::Ribbons::tessellated; });
        } else {
            bench_.notes.emplace_back("tessellated ribbons: the device has no tessellation");
        }
        vary("transparency: stochastic", [](auto&) {});
        vary("transparency: sorted", [](auto& o) { o.transparency = render::Transparency::sorted; });
        vary("transparency: weighted", [](auto& o) { o.transparency = render::Transparency::weighted; });
        vary("detail: half a pixel", [](auto& o) { o.detail = 0.5f; });
        for (const std::uint32_t hairs : counts_) {
            add(fmt::format("{} hairs, light from around", hairs), hairs, size_, [](auto&) {});
            bench_.cases.back().sky = true;
        }
        // The same size as the row of so many hairs, and blended as it does by default.
        add(fmt::format("{} hairs, software renderer", counts_.front()), counts_.front(), size_,
            [](auto& o) { o.transparency = render::Transparency::sorted; });
        bench_.cases.back().software = true;
    }

  private:
    template <class Change>
    void add(const std::string& name, std::uint32_t hairs, std::pair<std::uint32_t, std::uint32_t> size,
             Change change, std::optional<double> limit = {}) {
        RenderCase which;
        which.name = name;
        which.hairs = hairs;
        which.limit = limit;
        which.shading = marschner(render::Scattering::single);
        std::tie(which.options.width, which.options.height) = size;
        which.options.frames = 1;
        which.options.samples =
            std::ranges::find(device_.sampleCounts, 4u) != device_.sampleCounts.end() ? 4 : 1;
        change(which.options);
        bench_.cases.push_back(std::move(which));
    }
    static render::FibreMaterial marschner(render::Scattering scattering) {
        render::FibreMaterial material;
        material.model = render::ShadingModel::marschner;
        material.scattering = scattering;
        return material;
    }
    void shade(const std::string& name, const render::FibreMaterial& material) {
        vary(name, [](render::RenderOptions&) {});
        bench_.cases.back().shading = material;
    }
    void addShading() {
        render::FibreMaterial sadeghi;
        sadeghi.model = render::ShadingModel::sadeghi;
        sadeghi.scattering = render::Scattering::single;
        shade("shading: Kajiya-Kay", {});
        shade("shading: Marschner", marschner(render::Scattering::single));
        shade("shading: Marschner, dual scattering", marschner(render::Scattering::dual));
        shade("shading: Marschner, light in a volume", marschner(render::Scattering::volume));
        shade("shading: Sadeghi", sadeghi);
        sadeghi.scattering = render::Scattering::dual;
        shade("shading: Sadeghi, dual scattering", sadeghi);
    }
    template <class Change>
    void vary(const std::string& name, Change change) {
        add(name, middle_, thesisSize_, change);
    }
    void addAntiAliasing() {
        const auto once = [](render::PostFilter filter) {
            return [filter](render::RenderOptions& o) {
                o.samples = 1;
                o.filter = filter;
            };
        };
        vary("anti-aliasing: none", once(render::PostFilter::none));
        vary("anti-aliasing: FXAA", once(render::PostFilter::fxaa));
        vary("anti-aliasing: FXAA, long search", once(render::PostFilter::fxaaHigh));
        for (const std::uint32_t samples : {2u, 4u, 8u}) {
            if (std::ranges::find(device_.sampleCounts, samples) == device_.sampleCounts.end()) {
                bench_.notes.push_back(fmt::format("MSAA {}: the device has no such targets", samples));
                continue;
            }
            vary(fmt::format("anti-aliasing: MSAA {}", samples), [samples](auto& o) { o.samples = samples; });
        }
    }

    const std::vector<Sample>& samples_;
    const gpu::DeviceInfo& device_;
    RenderBench& bench_;
    bool gpu_;
    std::vector<std::uint32_t> counts_;
    std::pair<std::uint32_t, std::uint32_t> size_, thesisSize_;
    std::uint32_t middle_ = 0;
};

/// What drawing takes when the geometry of hair is made once, as here and with stream-out (thesis, Section
/// 6.6.1), and when each pass that draws hair makes it: computed from the passes of one case.
struct Geometry {
    std::string passes;
    double once = 0, each = 0;  ///< ms
};

/// Those that read the curves of hair.
constexpr std::array kDrawHair{render::Pass::firstHair, render::Pass::opacity, render::Pass::shade,
                               render::Pass::nearest, render::Pass::draw};

/// For one, two, … of the passes that draw hair. Empty where the case has no times.
std::vector<Geometry> geometryOf(const RenderCase& which) {
    const auto timeOf = [&](render::Pass pass) {
        const auto found = std::ranges::find(which.passes, render::passName(pass), &Measurement::name);
        return found == which.passes.end() ? 0.0 : found->median();
    };
    const double curves = timeOf(render::Pass::curves);
    if (!(curves > 0)) return {};
    std::vector<Geometry> rows;
    Geometry row;
    for (const Measurement& pass : which.passes) {
        const bool drawsHair = std::ranges::any_of(
            kDrawHair, [&](render::Pass one) { return pass.name == render::passName(one); });
        if (!drawsHair) continue;
        row.passes += (row.passes.empty() ? "" : ", ") + pass.name;
        row.once += pass.median();
        const auto count = static_cast<double>(rows.size() + 1);
        rows.push_back({row.passes, row.once + curves, row.once + count * curves});
    }
    return rows;
}

/// One frame of each kind of ribbon that a device's own stages draw, on a device that counts what they do:
/// apart, since counting takes time.
Status countStages(gpu::DeviceOptions wanted, RenderBench& bench) {
    if (!bench.device.statistics) {
        bench.notes.emplace_back("vertices: the device has no pipeline statistics");
        return {};
    }
    wanted.statistics = true;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    RenderMeasuring counting(**device, 1);
    for (RenderCase& which : bench.cases) {
        if (!which.name.starts_with("ribbons: ") || which.options.ribbons == render::Ribbons::compute)
            continue;
        RenderCase counted = which;
        if (auto status = counting.run(counted); !status) return status;
        which.counts = std::move(counted.counts);
        which.meshTriangles = counted.meshTriangles;
    }
    return {};
}

/// What a case's hair takes in the pass that draws it; nothing where it was not counted.
std::optional<gpu::PassCounts> hairCounts(const RenderCase& which) {
    const auto found = std::ranges::find(which.counts, std::string(render::passName(render::Pass::draw)),
                                         &std::pair<std::string, gpu::PassCounts>::first);
    if (found == which.counts.end()) return std::nullopt;
    gpu::PassCounts counts = found->second;
    // Devices may clip before they count.
    counts.primitives -= std::min(counts.primitives, which.meshTriangles);
    counts.vertices -= std::min(counts.vertices, 3 * which.meshTriangles);
    counts.vertexRuns -= std::min(counts.vertexRuns, 3 * which.meshTriangles);
    return counts;
}

/// Vertices by the thesis' 3f + 1 (Section 6.2) for patches cut f times along: by Euler's formula each then
/// has 4f − 2 triangles, which gives f.
std::uint64_t thesisVertices(const gpu::PassCounts& counts) {
    return 3 * ((counts.primitives + 2 * counts.patches) / 4) + counts.patches;
}

std::string inWords(const Measurement& m) {
    const auto [minimum, maximum] = std::ranges::minmax(m.values);
    return fmt::format("{:.3g} ({:.3g}…{:.3g})", m.median(), minimum, maximum);
}

/// Leaves the rows that are asked for.
Status keepOnly(const std::vector<std::string>& only, RenderBench& bench) {
    if (only.empty()) return {};
    std::erase_if(bench.cases, [&](const RenderCase& which) {
        return std::ranges::none_of(
            only, [&](const std::string& part) { return which.name.find(part) != std::string::npos; });
    });
    if (!bench.cases.empty()) return {};
    return fail(fmt::format("no row has '{}' in its name", fmt::join(only, "' or '")),
                "expected parts of the names that `bench render` writes, as FXAA or shadows");
}

Result<RenderBench> measureAll(const Options& options) {
    constexpr int kUsualRepetitions = 20;
    gpu::DeviceOptions wanted;
    wanted.index = options.device;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    const auto hairstyles = wantedHair(options);
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    RenderBench bench;
    bench.device = (*device)->info();
    if (bench.device.timestampPeriodNs <= 0) {
        bench.notes.emplace_back("the device has no clock: frames are wall times, passes are 0");
    }
    CaseList(options, *hairstyles, bench.device, bench).add();
    if (auto kept = keepOnly(options.only, bench); !kept) return tl::unexpected(kept.error());
    const int repetitions = options.repetitions.value_or(kUsualRepetitions);
    RenderMeasuring measuring(**device, repetitions);
    const std::unique_ptr<gpu::Device> processor = software::makeDevice();
    RenderMeasuring inSoftware(*processor, repetitions);
    for (std::size_t i = 0; i < bench.cases.size(); ++i) {
        RenderCase& which = bench.cases[i];
        const auto done = bench.cases.begin() + static_cast<std::ptrdiff_t>(i);
        // One setting has one number.
        const auto like =
            std::find_if(bench.cases.begin(), done, [&](const RenderCase& c) { return c.isLike(which); });
        if (like != done) {
            which.takeTimes(*like);
        } else if (auto status = (which.software ? inSoftware : measuring).run(which); !status) {
            return tl::unexpected(status.error());
        }
        if (options.progress) options.progress("drawing", i + 1, bench.cases.size());
    }
    if (auto status = countStages(wanted, bench); !status) return tl::unexpected(status.error());
    return bench;
}

Report reportOf(const RenderBench& bench) {
    Report rows = Report::array(), geometry = Report::array(), stages = Report::array();
    for (const RenderCase& which : bench.cases) {
        const auto row = [&](const Measurement& measurement, const std::string& what) {
            Report report = rowOf(measurement);
            report["name"] = which.name + (what.empty() ? "" : ", " + what);
            return report;
        };
        Report whole = row(which.frame, "");
        whole["hairs"] = which.hairs;
        whole["size"] = fmt::format("{}x{}", which.options.width, which.options.height);
        whole["target_bytes"] = which.targetBytes;
        if (which.limit) {
            whole["at_most"] = *which.limit;
            whole["met"] = which.met();
        }
        rows.push_back(std::move(whole));
        rows.push_back(row(which.wall, "wall"));
        for (const Measurement& pass : which.passes) rows.push_back(row(pass, pass.name));
        if (const auto counts = hairCounts(which)) {
            Report stage{{"name", which.name},
                         {"vertices", counts->vertices},
                         {"vertex_runs", counts->vertexRuns},
                         {"patches", counts->patches},
                         {"evaluations", counts->evaluations},
                         {"primitives", counts->primitives},
                         {"fragments", counts->fragments}};
            if (counts->patches > 0) stage["evaluations_by_formula"] = thesisVertices(*counts);
            stages.push_back(std::move(stage));
        }
        for (const Geometry& made : geometryOf(which))
            geometry.push_back({{"name", which.name},
                                {"passes", made.passes},
                                {"once_ms", made.once},
                                {"each_ms", made.each}});
    }
    return Report{{"name", "render"},
                  {"device", bench.device.name},
                  {"driver", bench.device.driver},
                  {"segments", kBenchSegments},
                  {"notes", bench.notes},
                  {"rows", std::move(rows)},
                  {"geometry", std::move(geometry)},
                  {"stages", std::move(stages)}};
}

std::string markdownOf(const RenderBench& bench, const std::string& command) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "# Drawing, measured\n\nWritten by `{}`.\ndocs/rendering.md says what is measured. Milliseconds of a "
        "frame on the device in which all hair has moved: medians of {} frames, in brackets the least and "
        "the greatest. Each hair has {} segments.\n\nDevice: {}, driver {}.\n",
        command, bench.cases.empty() ? 0 : bench.cases.front().frame.values.size(), kBenchSegments,
        bench.device.name, bench.device.driver);
    for (const std::string& note : bench.notes) fmt::format_to(out, "\nNote: {}.\n", note);
    fmt::format_to(out,
                   "\n| case | hairs | pixels | samples | frame | wall | memory, MiB | wanted |\n"
                   "|---|---|---|---|---|---|---|---|\n");
    for (const RenderCase& c : bench.cases) {
        const std::string wanted =
            c.limit ? fmt::format("at most {:g} ms: {}", *c.limit, c.met() ? "met" : "**not met**") : "";
        fmt::format_to(out, "| {} | {} | {}x{} | {} | {} | {} | {:.1f} | {} |\n", c.name, c.hairs,
                       c.options.width, c.options.height, c.options.samples, inWords(c.frame),
                       inWords(c.wall), static_cast<double>(c.targetBytes) / (1u << 20u), wanted);
    }
    fmt::format_to(out,
                   "\n## Geometry, made once or in each pass\n\n| case | passes that draw hair | made "
                   "once, ms | made in each, ms (computed) | gain |\n|---|---|---|---|---|\n");
    for (const RenderCase& c : bench.cases) {
        for (const Geometry& row : geometryOf(c))
            fmt::format_to(out, "| {} | {} | {:.3g} | {:.3g} | {:.1f} % |\n", c.name, row.passes, row.once,
                           row.each, 100 * (1 - row.once / row.each));
    }
    if (std::ranges::any_of(bench.cases, [](const RenderCase& c) { return hairCounts(c).has_value(); })) {
        fmt::format_to(
            out,
            "\n## Stages, counted\n\nPipeline statistics of the pass that draws hair, without the "
            "head's vertices and triangles. A patch that is cut f times has 3f + 1 vertices "
            "(thesis, 6.2) and 4f − 2 triangles.\n\n"
            "| case | vertices | vertex shader | patches | domain shader | by 3f + 1 | triangles | "
            "fragments, with the head's |\n|---|---|---|---|---|---|---|---|\n");
        for (const RenderCase& c : bench.cases) {
            const auto counts = hairCounts(c);
            if (!counts) continue;
            fmt::format_to(out, "| {} | {} | {} | {} | {} | {} | {} | {} |\n", c.name, counts->vertices,
                           counts->vertexRuns, counts->patches, counts->evaluations,
                           counts->patches > 0 ? fmt::to_string(thesisVertices(*counts)) : "–",
                           counts->primitives, counts->fragments);
        }
    }
    fmt::format_to(out, "\n## Passes\n\n| case | pass | ms |\n|---|---|---|\n");
    for (const RenderCase& c : bench.cases) {
        for (const Measurement& pass : c.passes) {
            fmt::format_to(out, "| {} | {} | {} |\n", c.name, pass.name, inWords(pass));
        }
    }
    return text;
}

Result<Outcome> runRender(const Options& options) {
    const auto bench = measureAll(options);
    if (!bench) return tl::unexpected(bench.error());
    return Outcome{reportOf(*bench), markdownOf(*bench, options.commandLine), {}};
}

}  // namespace

Benchmark renderBenchmark() {
    return {"render",
            "drawing hair",
            {"--hairs", "--grooms", "--only", "--size", "--device", "--markdown"},
            runRender};
}

}  // namespace hairloom::benchmarks
