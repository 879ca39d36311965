// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/lazy_shading.h"

#include <algorithm>
#include <utility>

namespace hairloom::software {
namespace {

constexpr std::size_t kPointsShadedAtOnce = 256;
constexpr std::uint32_t kSkyThreads = HAIRLOOM_SKY_THREADS_OF_STRAND;

}  // namespace

LazySky::LazySky(DeferredDispatch work, std::uint32_t strands)
    : work_(std::move(work)), done_(std::size_t{strands} * kSkyThreads, 0) {}

void LazySky::run(std::span<const std::uint32_t> threads) {
    parallelUntil(work_.stop, threads.size(), kPointsShadedAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<uint3> ids;
        for (std::size_t i = begin; i < end; ++i)
            ids.emplace_back(threads[i] / kSkyThreads, threads[i] % kSkyThreads, 0u);
        work_.kernel->runThreads(work_.registers, ids);
    });
    if (!isAsked(work_.stop)) return;
    for (const std::uint32_t thread : threads) done_[thread] = 0;
}

void LazySky::ensure(std::span<const std::uint32_t> points, std::span<const shaders::CurvePoint> curve,
                     std::span<const shaders::StrandHeader> strands, std::uint32_t subdivisions) {
    std::vector<std::uint32_t> threads;
    const auto want = [&](std::uint32_t strand, std::uint32_t given) {
        const std::uint32_t thread = strand * kSkyThreads + given % kSkyThreads;
        if (done_[thread] != 0) return;
        done_[thread] = 1;
        threads.push_back(thread);
    };
    for (const std::uint32_t point : points) {
        const std::uint32_t strand = curve[point].strand;
        const shaders::StrandHeader& header = strands[strand];
        const std::uint32_t along = point - header.segmentsBefore * subdivisions - strand;
        const std::uint32_t given = std::min(along / subdivisions, header.pointCount - 2);
        want(strand, given);
        want(strand, given + 1);
    }
    run(threads);
}

void LazySky::ensureAll() {
    std::vector<std::uint32_t> threads;
    for (std::uint32_t i = 0; i < done_.size(); ++i) {
        if (std::exchange(done_[i], std::uint8_t{1}) == 0) threads.push_back(i);
    }
    run(threads);
}

LazyShading::LazyShading(DeferredDispatch work, std::shared_ptr<LazySky> sky,
                         std::shared_ptr<LazyShading> before)
    : work_(std::move(work)), sky_(std::move(sky)), before_(std::move(before)) {
    done_.assign(constants().count, 0);
}

void LazyShading::run(std::span<const std::uint32_t> points) {
    if (sky_ != nullptr) {
        const std::span curve(reinterpret_cast<const shaders::CurvePoint*>(work_.registers.read[0]),
                              done_.size());
        const auto* strands = reinterpret_cast<const shaders::StrandHeader*>(work_.registers.read[1]);
        const std::size_t strandCount = curve.empty() ? 0 : std::size_t{curve.back().strand} + 1;
        sky_->ensure(points, curve, {strands, strandCount}, constants().subdivisions);
    }
    const std::uint32_t row = constants().rowThreads;
    parallelUntil(work_.stop, points.size(), kPointsShadedAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<uint3> ids;
        for (std::size_t i = begin; i < end; ++i) ids.emplace_back(points[i] % row, points[i] / row, 0u);
        work_.kernel->runThreads(work_.registers, ids);
    });
    if (!isAsked(work_.stop)) return;
    for (const std::uint32_t point : points) done_[point] = 0;
}

void LazyShading::ensure(std::span<const std::uint8_t> wanted) {
    if (before_ != nullptr) before_->ensure(wanted);
    std::vector<std::uint32_t> points;
    for (std::uint32_t i = 0; i < std::min(wanted.size(), done_.size()); ++i) {
        if (wanted[i] != 0 && std::exchange(done_[i], std::uint8_t{1}) == 0) points.push_back(i);
    }
    run(points);
}

void LazyShading::ensureAll() {
    const std::vector<std::uint8_t> all(done_.size(), 1);
    ensure(all);
}

}  // namespace hairloom::software
