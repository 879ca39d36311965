// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "core/base/profiler.h"
#include "core/render/picture_internal.h"
#include "core/render/tone_map.h"

namespace hairloom::render {
namespace {

// Frames that may wait on the device at once; each keeps its command memory.
constexpr std::size_t kFramesInFlight = 3;

Status checkOptions(const RenderOptions& o, const gpu::DeviceInfo& device) {
    const std::uint64_t pixels = std::uint64_t{o.width} * o.height;
    const std::uint32_t limit = device.maxTextureSize;
    if (pixels == 0 || o.width > limit || o.height > limit || pixels > kMaxPixels) {
        return fail(fmt::format("a picture of {}x{} pixels", o.width, o.height),
                    fmt::format("1 to {} along a side and at most {} in all", limit, kMaxPixels));
    }
    if (o.frames < 1 || o.frames > 1024) return fail(fmt::format("{} frames", o.frames), "1 to 1024");
    if (o.subdivisions < 1 || o.subdivisions > 64) {
        return fail(fmt::format("{} subdivisions", o.subdivisions), "1 to 64");
    }
    if (o.shadowResolution < 64 || o.shadowResolution > 4096 || o.shadowResolution * kMaxLights > limit) {
        return fail(fmt::format("a shadow map of {} pixels", o.shadowResolution), "64 to 4096");
    }
    if (!(o.exposure > 0) || !(o.exposure < 1e6f)) return fail("an exposure that is not positive");
    return {};
}

Result<std::uint32_t> chooseSamples(const RenderOptions& options, const gpu::DeviceInfo& device) {
    if (options.samples == 0) return std::min(device.maxSamples(), 8u);
    if (std::ranges::find(device.sampleCounts, options.samples) == device.sampleCounts.end() ||
        options.samples > 8) {
        std::string counts;
        for (const std::uint32_t n : device.sampleCounts)
            counts += (counts.empty() ? "" : ", ") + std::to_string(n);
        return fail(fmt::format("{} samples a pixel on {}", options.samples, device.name),
                    "one of " + counts);
    }
    return options.samples;
}

class PassSums {
  public:
    Status add(gpu::Submission& submission) {
        const auto times = submission.passTimes();
        if (!times) return tl::unexpected(times.error());
        for (const gpu::PassTime& time : *times) {
            const auto same = std::ranges::find(sums_, time.name, &gpu::PassTime::name);
            if (same == sums_.end()) {
                sums_.push_back(time);
            } else {
                same->milliseconds += time.milliseconds;
            }
        }
        return {};
    }
    std::vector<gpu::PassTime> take() { return std::move(sums_); }

  private:
    std::vector<gpu::PassTime> sums_;
};

Result<gpu::SubmissionPtr> submit(gpu::Device& device, const std::function<void(gpu::CommandList&)>& record) {
    auto list = device.createCommandList();
    if (!list) return tl::unexpected(list.error());
    record(**list);
    return device.submit(std::move(*list));
}

Status drawAll(Frame& frame, PassSums& sums) {
    std::deque<gpu::SubmissionPtr> running;
    const auto push = [&](Result<gpu::SubmissionPtr> submission, std::size_t keep) -> Status {
        if (!submission) return tl::unexpected(submission.error());
        running.push_back(std::move(*submission));
        while (running.size() > keep) {
            if (auto status = sums.add(*running.front()); !status) return status;
            running.pop_front();
        }
        return {};
    };
    auto first = submit(frame.device, [&](gpu::CommandList& list) { recordPreparation(list, frame); });
    if (auto status = push(std::move(first), kFramesInFlight); !status) return status;
    for (std::uint32_t i = 0; i < frame.options.frames; ++i) {
        auto next = submit(frame.device, [&](gpu::CommandList& list) { recordFrame(list, frame, i); });
        const std::size_t keep = i + 1 == frame.options.frames ? 0 : kFramesInFlight;
        if (auto status = push(std::move(next), keep); !status) return status;
    }
    return {};
}

}  // namespace

Result<Picture> renderPicture(gpu::Device& device, const RenderScene& scene, const RenderOptions& options) {
    HAIRLOOM_PROFILE("render picture");
    const auto failed = [](const Error& error) { return tl::unexpected(error); };
    if (auto status = checkOptions(options, device.info()); !status) return failed(status.error());
    if (auto status = checkScene(scene); !status) return failed(status.error());
    const auto samples = chooseSamples(options, device.info());
    if (!samples) return failed(samples.error());
    auto data = uploadScene(device, scene, options.subdivisions);
    if (!data) return failed(data.error());
    auto pipelines = createPipelines(device, *samples);
    if (!pipelines) return failed(pipelines.error());
    auto targets = createTargets(device, options, *samples);
    if (!targets) return failed(targets.error());
    Frame frame{
        device, scene, options, *samples, std::move(*data), std::move(*pipelines), std::move(*targets),
        {},     {}};
    setUpLights(frame);
    PassSums sums;
    if (auto status = drawAll(frame, sums); !status) return failed(status.error());

    Picture picture;
    picture.linear = {options.width, options.height,
                      std::vector<float>(std::size_t{4} * options.width * options.height)};
    const auto bytes = std::as_writable_bytes(std::span(picture.linear.rgba));
    if (auto status = device.readTexture(frame.targets.sum, bytes); !status) return failed(status.error());
    const float share = 1 / static_cast<float>(options.frames);
    for (float& value : picture.linear.rgba) value *= share;
    picture.image = toneMap(picture.linear, options.exposure);
    picture.passes = sums.take();
    picture.device = device.info().name;
    picture.triangles = frame.data.triangles;
    picture.strands = frame.data.strands;
    picture.curvePoints = frame.data.curvePoints;
    return picture;
}

}  // namespace hairloom::render
