// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "importers/mesh_reader/tinygltf.h"

namespace hairloom {
namespace {

constexpr std::size_t kMaxPieces = 64;

using Value = std::array<float, 4>;

/// Keys of one sampler: values of `components` numbers, three of them a key where it is cubic.
struct Keys {
    std::vector<float> times, values;
    std::size_t components = 3;
    std::size_t stride = 3, first = 0;  ///< numbers of an element, and where the value is among them
    bool isCubic = false, isStep = false;

    /// 0: the tangent before the key, 1: the value, 2: the tangent behind it.
    Value at(std::size_t key, std::size_t part) const {
        Value value{};
        const std::size_t element = isCubic ? key * 3 + part : key;
        for (std::size_t c = 0; c < components; ++c) value[c] = values[element * stride + first + c];
        return value;
    }
};

/// A rotation has unit length between keys, too.
Value unit(Value value, std::size_t components) {
    if (components != 4) return value;
    float length = 0;
    for (const float c : value) length += c * c;
    length = std::sqrt(length);
    if (length > 0) {
        for (float& c : value) c /= length;
    }
    return value;
}

/// glTF 2.0, appendix C.5: a cubic Hermite spline whose tangents are per second.
Value cubic(const Keys& keys, std::size_t key, float t) {
    const float seconds = keys.times[key + 1] - keys.times[key];
    const Value from = keys.at(key, 1), out = keys.at(key, 2), in = keys.at(key + 1, 0),
                to = keys.at(key + 1, 1);
    const float t2 = t * t, t3 = t2 * t;
    Value value{};
    for (std::size_t c = 0; c < keys.components; ++c) {
        value[c] = (2 * t3 - 3 * t2 + 1) * from[c] + seconds * (t3 - 2 * t2 + t) * out[c] +
                   (3 * t2 - 2 * t3) * to[c] + seconds * (t3 - t2) * in[c];
    }
    return unit(value, keys.components);
}

/// How far the middle of straight pieces is from the spline, the farthest of all pieces.
float unevenness(const Keys& keys, std::size_t key, std::size_t pieces) {
    float worst = 0;
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        const float step = 1.0f / static_cast<float>(pieces), t = static_cast<float>(piece) * step;
        const Value a = cubic(keys, key, t), b = cubic(keys, key, t + step),
                    middle = cubic(keys, key, t + 0.5f * step);
        Value straight{};
        for (std::size_t c = 0; c < keys.components; ++c) straight[c] = 0.5f * (a[c] + b[c]);
        straight = unit(straight, keys.components);
        for (std::size_t c = 0; c < keys.components; ++c)
            worst = std::max(worst, std::abs(straight[c] - middle[c]));
    }
    return worst;
}

template <class T>
void add(Track<T>& track, float time, const Value& value) {
    if (!std::isfinite(time) || (!track.times.empty() && time <= track.times.back())) return;
    track.times.push_back(time);
    if constexpr (std::is_same_v<T, Quatf>) {
        Quatf rotation(value[3], value[0], value[1], value[2]);
        if (rotation.norm() > 0) rotation.normalize();
        track.values.push_back(rotation);
    } else if constexpr (std::is_same_v<T, float>) {
        track.values.push_back(value[0]);
    } else {
        track.values.emplace_back(value[0], value[1], value[2]);
    }
}

template <class T>
Track<T> toTrack(const Keys& keys) {
    Track<T> track;
    for (std::size_t key = 0; key < keys.times.size(); ++key) {
        const float time = keys.times[key];
        if (key > 0 && keys.isStep)
            add(track, std::nextafter(time, -std::numeric_limits<float>::infinity()), keys.at(key - 1, 0));
        add(track, time, keys.at(key, keys.isCubic ? 1 : 0));
        if (!keys.isCubic || key + 1 == keys.times.size() || !(keys.times[key + 1] > time)) continue;
        std::size_t pieces = 1;
        while (pieces < kMaxPieces && unevenness(keys, key, pieces) > kCubicTolerance) pieces *= 2;
        for (std::size_t piece = 1; piece < pieces; ++piece) {
            const float t = static_cast<float>(piece) / static_cast<float>(pieces);
            add(track, time + t * (keys.times[key + 1] - time), cubic(keys, key, t));
        }
    }
    return track;
}

/// Elements of `stride` numbers, which are `perValue` to a value of the accessor.
Result<Keys> keysOf(const GltfFile& file, const tinygltf::Animation& animation,
                    const tinygltf::AnimationChannel& source, std::size_t stride, std::uint32_t perValue) {
    if (source.sampler < 0 || static_cast<std::size_t>(source.sampler) >= animation.samplers.size())
        return fail(fmt::format("a channel refers to sampler {}", source.sampler),
                    fmt::format("there are {}", animation.samplers.size()));
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(source.sampler)];
    Keys keys;
    keys.stride = stride;
    keys.isCubic = sampler.interpolation == "CUBICSPLINE";
    keys.isStep = sampler.interpolation == "STEP";
    if (!keys.isCubic && !keys.isStep && !sampler.interpolation.empty() && sampler.interpolation != "LINEAR")
        return fail(fmt::format("the interpolation of keys is '{}'", sampler.interpolation),
                    "expected LINEAR, STEP or CUBICSPLINE");
    auto times = file.numbers(sampler.input, 1, "times of keys");
    if (!times) return tl::unexpected(times.error());
    auto values = file.numbers(sampler.output, perValue, "values of keys");
    if (!values) return tl::unexpected(values.error());
    const std::size_t wanted = times->size() * keys.stride * (keys.isCubic ? 3 : 1);
    if (values->size() != wanted)
        return fail(fmt::format("{} times of keys with {} numbers", times->size(), values->size()),
                    fmt::format("expected {}", wanted));
    keys.times = std::move(*times);
    keys.values = std::move(*values);
    return keys;
}

bool areFinite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

}  // namespace

Status readKeys(const GltfFile& file, const tinygltf::Animation& animation,
                const tinygltf::AnimationChannel& source, Channel& channel) {
    const bool isRotation = source.target_path == "rotation";
    if (!isRotation && source.target_path != "translation" && source.target_path != "scale") return {};
    const std::uint32_t components = isRotation ? 4 : 3;
    auto keys = keysOf(file, animation, source, components, components);
    if (!keys) return tl::unexpected(keys.error());
    keys->components = components;
    if (isRotation) channel.rotation = toTrack<Quatf>(*keys);
    if (source.target_path == "translation") channel.translation = toTrack<Vec3f>(*keys);
    if (source.target_path == "scale") channel.scale = toTrack<Vec3f>(*keys);
    return {};
}

Result<std::vector<Track<float>>> readWeights(const GltfFile& file, const tinygltf::Animation& animation,
                                              const tinygltf::AnimationChannel& source,
                                              const std::vector<bool>& wanted) {
    auto keys = keysOf(file, animation, source, wanted.size(), 1);
    if (!keys) return tl::unexpected(keys.error());
    if (!areFinite(keys->values)) return fail("weights of keys are not finite");
    keys->components = 1;
    std::vector<Track<float>> tracks(wanted.size());
    for (std::size_t target = 0; target < wanted.size(); ++target) {
        keys->first = target;
        if (!wanted[target]) continue;
        tracks[target] = toTrack<float>(*keys);
        // Between finite keys a cubic of huge tangents may not be finite.
        if (!areFinite(tracks[target].values)) return fail("weights between keys are not finite");
    }
    return tracks;
}

}  // namespace hairloom
