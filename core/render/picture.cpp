// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/profiler.h"
#include "core/gpu/frames_under_way.h"
#include "core/render/renderer.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {
namespace {

constexpr std::size_t kFramesInFlight = 3;

class PassSums {
  public:
    void add(const std::vector<gpu::PassTime>& times) {
        for (const gpu::PassTime& time : times) {
            const auto same = std::ranges::find(sums_, time.name, &gpu::PassTime::name);
            if (same == sums_.end()) {
                sums_.push_back(time);
            } else {
                same->milliseconds += time.milliseconds;
                if (same->counts && time.counts) *same->counts += *time.counts;
            }
        }
    }
    std::vector<gpu::PassTime> take() { return std::move(sums_); }

  private:
    std::vector<gpu::PassTime> sums_;
};

/// All frames of the average, and with the last one the picture into `target`.
Status drawAll(gpu::Device& device, Renderer& renderer, const RenderOptions& options,
               const gpu::TexturePtr& target, PassSums& sums) {
    gpu::FramesUnderWay running(kFramesInFlight, [&](const auto& times) { sums.add(times); });
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        const bool last = i + 1 == options.frames;
        auto list = device.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (auto status = renderer.record(**list, options, last ? target : nullptr); !status) return status;
        auto submission = device.submit(std::move(*list));
        if (!submission) return tl::unexpected(submission.error());
        if (auto status = running.add(std::move(*submission)); !status) return status;
    }
    return running.finish();
}

Result<gpu::TexturePtr> makeTarget(gpu::Device& device, const RenderOptions& options) {
    gpu::TextureDesc desc;
    desc.name = "picture";
    desc.width = options.width;
    desc.height = options.height;
    desc.usage = gpu::Usage::RenderTarget;
    return device.createTexture(desc);
}

/// Says in the plan how much hair the lists of adaptive shadow maps had no place for.
Status sayWhatListsLeft(gpu::Device& device, const Renderer& renderer, Picture& picture) {
    if (renderer.fragmentCounts() == nullptr) return {};
    std::vector<std::uint32_t> counts(picture.plan.buffer(BufferId::fragmentCounts).elements);
    if (auto status =
            device.readBuffer(renderer.fragmentCounts(), 0, std::as_writable_bytes(std::span(counts)));
        !status)
        return status;
    const auto most = static_cast<std::uint32_t>(picture.plan.buffer(BufferId::lightFragments).elements /
                                                 HAIRLOOM_LISTED_WORDS);
    std::uint32_t found = 0, left = 0;
    for (std::size_t i = 0; i < counts.size(); i += 2) {
        found = std::max(found, counts[i]);
        left = std::max(left, counts[i] - std::min(counts[i], counts[i + 1]));
    }
    if (found <= most && left > 0) {
        picture.plan.passes[static_cast<std::size_t>(Pass::opacity)].why += fmt::format(
            "; some texels have more hair than the {} pieces that a list holds, so a random part of it "
            "counts as all ({} of {} pieces are left out)",
            HAIRLOOM_LISTED_OF_TEXEL, left, found);
    }
    if (found > most) {
        picture.plan.passes[static_cast<std::size_t>(Pass::opacity)].why += fmt::format(
            "; {} pieces of hair in texels are more than the {} that lists hold, so a random "
            "{:.0f} % count as all",
            found, most, 98.0 * most / found);
    }
    return {};
}

}  // namespace

Result<Picture> renderPicture(gpu::Device& device, const RenderScene& scene, const RenderOptions& options) {
    if (auto status = check(options, device.info()); !status) return tl::unexpected(status.error());
    Renderer renderer(device);
    if (auto status = renderer.setScene(scene); !status) return tl::unexpected(status.error());
    return renderPicture(device, renderer, options);
}

Result<Picture> renderPicture(gpu::Device& device, const RenderScene& past, const RenderScene& scene,
                              const RenderOptions& options) {
    if (auto status = check(options, device.info()); !status) return tl::unexpected(status.error());
    RenderScene before = scene;
    before.meshes = past.meshes;
    before.strands = past.strands;
    before.camera = past.camera;
    Renderer renderer(device);
    Status status = renderer.setScene(before);
    if (!status) return tl::unexpected(status.error());
    auto list = device.createCommandList();
    if (!list) return tl::unexpected(list.error());
    status = renderer.recordPast(**list, options);
    if (status) {
        if (auto submission = device.submit(std::move(*list)); !submission)
            return tl::unexpected(submission.error());
        status = renderer.setCamera(scene.camera);
    }
    for (std::size_t i = 0; status && i < scene.meshes.size(); ++i)
        status = renderer.setMeshPositions(i, scene.meshes[i].positions_ws, scene.meshes[i].normals_ws);
    for (std::size_t i = 0; status && i < scene.strands.size(); ++i)
        status = renderer.setStrandPositions(i, scene.strands[i].positions_ws);
    if (!status) return tl::unexpected(status.error());
    return renderPicture(device, renderer, options);
}

Result<Picture> renderPicture(gpu::Device& device, Renderer& renderer, const RenderOptions& options) {
    HAIRLOOM_PROFILE("render picture");
    const auto failed = [](const Error& error) { return tl::unexpected(error); };
    renderer.restart();
    const auto target = makeTarget(device, options);
    if (!target) return failed(target.error());
    PassSums sums;
    // A device has a view as a table. Without a filter after it the picture does better.
    const bool exact = options.toDisplay != nullptr && options.filter == PostFilter::none;
    RenderOptions drawn = options;
    if (exact) drawn.toDisplay = nullptr;
    if (auto status = drawAll(device, renderer, drawn, *target, sums); !status) return failed(status.error());

    const std::size_t values = std::size_t{4} * options.width * options.height;
    Picture picture;
    picture.linear = {options.width, options.height, std::vector<float>(values)};
    const auto linear = std::as_writable_bytes(std::span(picture.linear.rgba));
    if (auto status = device.readBuffer(renderer.linearSum(), 0, linear); !status)
        return failed(status.error());
    const float share = 1 / static_cast<float>(options.frames);
    for (float& value : picture.linear.rgba) value *= share;
    static_assert(sizeof(SurfacePixel) == sizeof(shaders::SurfacePixel));
    if (renderer.surface() != nullptr) {
        picture.surface.resize(values / 4);
        const auto surface = std::as_writable_bytes(std::span(picture.surface));
        if (auto status = device.readBuffer(renderer.surface(), 0, surface); !status)
            return failed(status.error());
    }
    if (exact) {
        picture.image = showBy(*options.toDisplay, picture.linear, options.exposure);
    } else {
        picture.image = {options.width, options.height, std::vector<std::uint8_t>(values)};
        const auto shown = std::as_writable_bytes(std::span(picture.image.rgba));
        if (auto status = device.readTexture(*target, shown); !status) return failed(status.error());
    }
    picture.passes = sums.take();
    picture.plan = renderer.plan();
    if (auto status = sayWhatListsLeft(device, renderer, picture); !status) return failed(status.error());
    picture.device = device.info().name;
    picture.triangles = renderer.triangles();
    picture.strands = renderer.strands();
    picture.curvePoints = renderer.curvePoints();
    return picture;
}

}  // namespace hairloom::render
