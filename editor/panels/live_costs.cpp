// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/live_costs.h"

#include <algorithm>

namespace hairloom::editor {
namespace {

constexpr std::uint64_t kFrames = 30;

}  // namespace

void LiveCosts::add(const PlayedFrame& frame) {
    const SimulationStats& stats = frame.stats;
    if (stats.frames < last_) restart();
    last_ = stats.frames;
    // A device tells the means of its last frames, the CPU those since the start.
    const std::uint64_t frames = frame.pose->onDevice ? 1 : stats.frames;
    const auto count = static_cast<double>(frames);
    Sums sums{frames, stats.millisecondsPerFrame * count, {}};
    for (const EffectReport& effect : stats.effects)
        sums.effects[effect.name] = effect.milliseconds.value_or(0) * count;
    if (frame.pose->onDevice) return show(sums);
    const bool isFirst = from_.frames == 0;
    const std::uint64_t since = frames - std::min(frames, from_.frames);
    if (since == 0 || (since < kFrames && !isFirst)) return;
    Sums spent{since, sums.frame - from_.frame, sums.effects};
    for (auto& [effect, milliseconds] : spent.effects) {
        const auto before = from_.effects.find(effect);
        if (before != from_.effects.end()) milliseconds = std::max(milliseconds - before->second, 0.0);
    }
    show(spent);
    if (since >= kFrames) from_ = std::move(sums);
}

void LiveCosts::show(const Sums& spent) {
    frame_ = std::max(spent.frame / static_cast<double>(spent.frames), 0.0);
    double all = 0;
    for (const auto& [effect, milliseconds] : spent.effects) all += milliseconds;
    shares_.clear();
    for (const auto& [effect, milliseconds] : spent.effects)
        shares_[effect] = all > 0 ? milliseconds / all : 0;
}

double LiveCosts::millisecondsOf(const std::string& effect) const {
    const auto share = shares_.find(effect);
    return share == shares_.end() ? 0 : share->second * frame_;
}

}  // namespace hairloom::editor
