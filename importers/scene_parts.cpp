// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/scene_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {

void fillFromRest(Channel& channel, const Eigen::Affine3f& rest) {
    if (channel.translation.times.empty()) channel.translation = {{0.0f}, {rest.translation()}};
    if (channel.rotation.times.empty() || channel.scale.times.empty()) {
        Mat3f rotation, scale;
        rest.computeRotationScaling(&rotation, &scale);
        if (channel.rotation.times.empty()) channel.rotation = {{0.0f}, {Quatf(rotation)}};
        if (channel.scale.times.empty()) channel.scale = {{0.0f}, {scale.diagonal()}};
    }
}

float lastTime(const Channel& channel) {
    float last = 0;
    const auto take = [&](const auto& track) {
        if (!track.times.empty()) last = std::max(last, track.times.back());
    };
    take(channel.translation);
    take(channel.rotation);
    take(channel.scale);
    return last;
}

std::uint32_t indexOf(const std::string& name, std::unordered_map<std::string, std::uint32_t>& indices,
                      std::vector<std::string>& names) {
    const auto [entry, added] = indices.try_emplace(name, static_cast<std::uint32_t>(names.size()));
    if (added) names.push_back(name);
    return entry->second;
}

std::string firstOf(const std::vector<std::string>& texts) {
    constexpr std::size_t kShown = 3;
    std::string list;
    for (std::size_t i = 0; i < std::min(texts.size(), kShown); ++i)
        list += (list.empty() ? "" : "; ") + texts[i];
    if (texts.size() > kShown) list += fmt::format("; and {} more", texts.size() - kShown);
    return list;
}

}  // namespace hairloom
