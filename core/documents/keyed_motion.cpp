// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/keyed_motion.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/file.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {
namespace {

constexpr double kAnyTime = 1e6;        // seconds
constexpr double kMaxCoordinate = 1e6;  // metres
/// Metres between origins of poses: near the world's there is no other.
constexpr double kOriginGrid = 64;
constexpr double kAnyTurn = 1e6;       // degrees
constexpr double kFastestWind = 1000;  // m/s, as the engine takes

struct Key {
    float time;
    Vec3d translation;
    Vec3f axis;
    float radians;
};
struct WindKey {
    float time;
    Vec3f velocity;
};

/// The key before `time` and how far it is to the next one; the first and the last hold.
template <class K>
std::pair<std::size_t, float> between(const std::vector<K>& keys, float time) {
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time, [](float t, const K& key) { return t < key.time; });
    if (next == keys.begin()) return {0, 0.0f};
    const auto before = static_cast<std::size_t>(next - keys.begin()) - 1;
    if (next == keys.end()) return {before, 0.0f};
    return {before, (time - keys[before].time) / (next->time - keys[before].time)};
}

class KeyedMotion : public HeadMotion {
  public:
    KeyedMotion(std::vector<Key> keys, std::vector<WindKey> wind, bool linear)
        : keys_(std::move(keys)), wind_(std::move(wind)), linear_(linear) {}

    HeadPose poseAt(float time) const override {
        HeadPose pose;
        const auto [k, share] = between(keys_, time);
        const Key& from = keys_[k];
        Vec3d translation = from.translation;
        Quatf rotation = rotationOf(from);
        if (linear_ && share > 0) {
            const Key& to = keys_[k + 1];
            translation += (to.translation - from.translation) * static_cast<double>(share);
            // About one axis a turn keeps all its degrees, above 180 too; else the shorter way.
            rotation =
                from.axis == to.axis
                    ? Quatf(Eigen::AngleAxisf(from.radians + (to.radians - from.radians) * share, from.axis))
                    : rotation.slerp(share, rotationOf(to));
        }
        pose.origin_ws = (translation / kOriginGrid).array().round() * kOriginGrid;
        pose.head_ws = Eigen::Translation3f((translation - pose.origin_ws).cast<float>()) * rotation;
        if (!wind_.empty()) {
            const auto [w, windShare] = between(wind_, time);
            pose.wind_ws = wind_[w].velocity;
            if (linear_ && windShare > 0)
                *pose.wind_ws += (wind_[w + 1].velocity - wind_[w].velocity) * windShare;
        }
        return pose;
    }

  private:
    static Quatf rotationOf(const Key& key) { return Quatf(Eigen::AngleAxisf(key.radians, key.axis)); }

    std::vector<Key> keys_;
    std::vector<WindKey> wind_;
    bool linear_;
};

template <class K>
void expectAscending(JsonReader& reader, std::string_view member, const std::vector<K>& keys) {
    for (std::size_t k = 1; k < keys.size(); ++k) {
        if (!(keys[k].time > keys[k - 1].time))
            reader.complain(member, "is not later than the key before it", "each key after the one before");
    }
}

Key readKey(JsonReader reader) {
    Key key{static_cast<float>(reader.number("t", 0, kAnyTime, "s")), Vec3d::Zero(), Vec3f::UnitY(), 0};
    if (reader.has("translate"))
        key.translation = reader.exactVector("translate", -kMaxCoordinate, kMaxCoordinate, "m");
    if (reader.has("degrees"))
        key.radians = radians(static_cast<float>(reader.number("degrees", -kAnyTurn, kAnyTurn, "degrees")));
    if (reader.has("axis")) {
        const Vec3f axis = reader.vector("axis", -kMaxCoordinate, kMaxCoordinate);
        if (!(axis.norm() > 0) && reader.ok())
            reader.complain("axis", "has no direction", "a vector that is not zero");
        key.axis = axis.norm() > 0 ? Vec3f(axis.normalized()) : Vec3f(Vec3f::UnitY());
    }
    reader.finish();
    return key;
}

}  // namespace

Result<std::unique_ptr<HeadMotion>> readKeyedMotion(const std::string& file) {
    const auto text = readTextFile(file, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto document = parseJson(file, *text);
    if (!document) return tl::unexpected(document.error());
    JsonReader reader(*document, file);
    std::vector<Key> keys;
    std::vector<WindKey> wind;
    bool linear = true;
    for (JsonReader& key : reader.objects("keys")) keys.push_back(readKey(key));
    if (keys.empty() && reader.ok()) reader.complain("keys", "is empty", "at least one key");
    expectAscending(reader, "keys", keys);
    if (reader.has("interpolate")) {
        constexpr std::array<std::string_view, 2> kKinds{"linear", "step"};
        linear = reader.choice("interpolate", kKinds) == 0;
    }
    if (reader.has("wind")) {
        for (JsonReader& key : reader.objects("wind")) {
            wind.push_back({static_cast<float>(key.number("t", 0, kAnyTime, "s")),
                            key.vector("velocity", -kFastestWind, kFastestWind, "m/s")});
            if (wind.back().velocity.norm() > static_cast<float>(kFastestWind))
                key.complain("velocity", "is too fast", "at most 1000 m/s");
            key.finish();
        }
        expectAscending(reader, "wind", wind);
    }
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return std::make_unique<KeyedMotion>(std::move(keys), std::move(wind), linear);
}

}  // namespace hairloom
