// SPDX-License-Identifier: GPL-3.0-or-later
// Clips of a USD stage: animations of its skeletons, and transforms that change.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "importers/scene_parts.h"
#include "importers/transform_keys.h"
#include "importers/usd_bones.h"

namespace hairloom {
namespace {

constexpr std::size_t kMaxKeys = std::size_t{1} << 26u;  ///< of all clips
class Builder {
  public:
    Builder(const UsdStage& stage, const UsdRange& range, const Eigen::Affine3d& turn, RawScene& scene)
        : stage_(stage), range_(range), turn_(turn), scene_(scene) {}

    Status run(std::span<const UsdMovingPrim> moving, std::span<const UsdSkeletonBones> skeletons,
               Clip clip) {
        for (const UsdMovingPrim& prim : moving) {
            if (auto status = addMoving(prim, clip); !status) return status;
        }
        std::set<const UsdPrim*> played;
        for (const UsdSkeletonBones& skeleton : skeletons) {
            const UsdPrim* const animation = animationOf(skeleton);
            if (animation == nullptr) continue;
            if (clip.name.empty()) clip.name = animation->name;
            if (played.insert(animation).second && played.size() > 1) clip.name = "animation";
            addAnimation(*animation, skeleton, range_, clip);
        }
        if (clip.name.empty()) clip.name = "animation";
        finish(std::move(clip), range_.isAuthored);
        addOthers(stage_.root, skeletons, played);
        if (keys_ > kMaxKeys)
            return fail("its clips have more keys than are read",
                        fmt::format("expected at most {}", kMaxKeys));
        if (lost_ > 0)
            scene_.warnings.push_back(fmt::format(
                "{} keys are no numbers or do not fit the joints of their animation; they were left out",
                lost_));
        if (isSheared_)
            scene_.warnings.emplace_back("transforms that shear in time were taken without shear");
        if (!lostShapes_.empty())
            scene_.warnings.push_back("blend shapes stay at 0: " + firstOf(lostShapes_));
        if (inBetweens_ > 0)
            scene_.warnings.push_back(
                fmt::format("in-between shapes of {} blend shapes were left out", inBetweens_));
        return {};
    }

  private:
    void finish(Clip&& clip, bool isAuthored) {
        if (clip.channels.empty() && clip.morphs.empty()) return;
        std::size_t moving = clip.morphs.size();
        for (const Channel& channel : clip.channels) {
            clip.duration = std::max(clip.duration, lastTime(channel));
            moving += channel.translation.times.size() > 1 || channel.rotation.times.size() > 1 ||
                      channel.scale.times.size() > 1;
        }
        if (isAuthored && moving > 0) clip.duration = range_.seconds(range_.end);
        const auto isTaken = [&](const std::string& name) {
            return std::ranges::find(scene_.clips, name, &Clip::name) != scene_.clips.end();
        };
        const std::string name = clip.name;
        for (int number = 2; isTaken(clip.name); ++number) clip.name = fmt::format("{} {}", name, number);
        scene_.clips.push_back(std::move(clip));
    }

    /// Animations that are bound to no skeleton are clips, too, of those whose joints they name.
    void addOthers(const UsdPrim& prim, std::span<const UsdSkeletonBones> skeletons,
                   const std::set<const UsdPrim*>& played) {
        const bool isShown = (!prim.active || *prim.active) && prim.specifier != UsdPrim::Specifier::Class;
        if (!isShown || keys_ > kMaxKeys) return;
        if (prim.type == "SkelAnimation" && !played.contains(&prim)) {
            Clip clip;
            clip.name = prim.name;
            UsdRange range = range_;
            double first = std::numeric_limits<double>::infinity();
            for (const char* name : {"translations", "rotations", "scales", "blendShapeWeights"}) {
                const UsdAttribute* const values = prim.find(name);
                if (values == nullptr || values->samples.empty()) continue;
                first = std::min(first, values->samples.begin()->first);
            }
            if (std::isfinite(first)) range.start = first;
            for (const UsdSkeletonBones& skeleton : skeletons) addAnimation(prim, skeleton, range, clip);
            finish(std::move(clip), false);
        }
        for (const UsdPrim& child : prim.children) addOthers(child, skeletons, played);
    }

    /// What the skeleton or the nearest prim above it says moves it.
    const UsdPrim* animationOf(const UsdSkeletonBones& skeleton) {
        const auto path = targetOf(skeleton.levels, "skel:animationSource");
        if (!path) return nullptr;
        const std::vector<const UsdPrim*> prims = primsTo(stage_.root, *path);
        const bool isThere = !prims.empty() && prims.back()->type == "SkelAnimation";
        const bool isActive =
            std::ranges::all_of(prims, [](const UsdPrim* prim) { return !prim->active || *prim->active; });
        if (isThere && isActive) return prims.back();
        scene_.warnings.push_back(fmt::format("the skeleton {} has the animation {}, which there is not",
                                              skeleton.prim->name, *path));
        return nullptr;
    }

    /// Numbers of one joint at each sample of an attribute, or at once where it does not change.
    template <class T, class Make>
    void addTrack(const UsdPrim& animation, std::string_view name, std::size_t joint, std::size_t joints,
                  std::uint32_t components, const UsdRange& range, Track<T>& track, const Make& make) {
        const UsdAttribute* const attribute = animation.find(name);
        if (attribute == nullptr) return;
        const auto take = [&](float seconds, const UsdValue& value) {
            if (value.isBlock) return;
            if (value.numbers.size() != joints * components) {
                ++lost_;
                return;
            }
            std::array<double, 4> numbers{};
            for (std::size_t c = 0; c < components; ++c) numbers[c] = value.numbers[joint * components + c];
            const std::optional<T> key = make(numbers);
            // Where values jump, the key before is as near as numbers allow.
            const float before = std::nextafter(seconds, -HUGE_VALF);
            const std::size_t keys = track.times.size();
            if (keys > 0 && track.times.back() == seconds && (keys == 1 || track.times[keys - 2] < before))
                track.times.back() = before;
            const bool isLater = track.times.empty() || seconds > track.times.back();
            if (!key || !std::isfinite(seconds)) {
                ++lost_;
            } else if (isLater) {
                track.times.push_back(seconds);
                track.values.push_back(*key);
                ++keys_;
            }
        };
        if (attribute->samples.empty()) {
            if (attribute->value.isThere()) take(0, attribute->value);
            return;
        }
        for (const auto& [code, value] : attribute->samples) take(range.seconds(code), value);
    }

    void addAnimation(const UsdPrim& animation, const UsdSkeletonBones& skeleton, const UsdRange& range,
                      Clip& clip) {
        addShapes(animation, skeleton, range, clip);
        const UsdAttribute* const names = animation.find("joints");
        if (names == nullptr) return;
        const std::size_t count = names->value.texts.size();
        const std::vector<std::size_t> joints = jointsNamed(skeleton.joints, names->value.texts);
        std::vector<bool> isDone(skeleton.joints.size(), false);
        for (std::size_t a = 0; a < count && keys_ <= kMaxKeys; ++a) {
            const std::size_t joint = joints[a];
            if (joint == kNoJoint || isDone[joint]) continue;
            isDone[joint] = true;
            Channel channel;
            channel.bone = skeleton.bones[joint];
            addTrack(animation, "translations", a, count, 3, range, channel.translation, vectorOf);
            addTrack(animation, "scales", a, count, 3, range, channel.scale, vectorOf);
            addTrack(animation, "rotations", a, count, 4, range, channel.rotation, rotationOf);
            if (channel.translation.times.empty() && channel.rotation.times.empty() &&
                channel.scale.times.empty())
                continue;
            fillFromRest(channel, skeleton.joints[joint].rest.cast<float>());
            if (skeleton.joints[joint].parent == kNoJoint) put(channel, TransformParts::of(skeleton.base));
            clip.channels.push_back(std::move(channel));
        }
    }

    void addShapes(const UsdPrim& animation, const UsdSkeletonBones& skeleton, const UsdRange& range,
                   Clip& clip) {
        const UsdAttribute* const names = animation.find("blendShapes");
        if (names == nullptr) return;
        const std::vector<std::string>& all = names->value.texts;
        for (const UsdBlendShape& shape : skeleton.shapes) {
            const auto found = std::ranges::find(all, shape.name);
            if (found == all.end() || keys_ > kMaxKeys) continue;
            MorphChannel channel;
            addTrack(animation, "blendShapeWeights", static_cast<std::size_t>(found - all.begin()),
                     all.size(), 1, range, channel.weight, [](const std::array<double, 4>& numbers) {
                         const auto weight = static_cast<float>(numbers[0]);
                         return std::isfinite(weight) ? std::optional(weight) : std::nullopt;
                     });
            if (channel.weight.times.empty()) continue;
            const auto [known, isNew] = targets_.try_emplace(&shape, kNoMorph);
            if (isNew) known->second = morphOf(shape);
            if (known->second == kNoMorph) continue;
            channel.target = known->second;
            clip.duration = std::max(clip.duration, channel.weight.times.back());
            clip.morphs.push_back(std::move(channel));
        }
    }

    /// The shape among the scene's morph targets; kNoMorph where it moves nothing, or not this mesh.
    std::uint32_t morphOf(const UsdBlendShape& shape) {
        const auto leave = [&](const std::string& why) {
            lostShapes_.push_back(fmt::format("{} of {} ({})", shape.name, shape.mesh, why));
            return kNoMorph;
        };
        const auto numbersOf = [&](const char* name) {
            const UsdAttribute* const attribute = shape.prim->find(name);
            return attribute == nullptr ? UsdValue() : valueAt(*attribute, range_.start);
        };
        UsdValue offsets = numbersOf("offsets");
        const UsdValue indices = numbersOf("pointIndices");
        const auto isInBetween = [](const UsdAttribute& a) { return a.name.starts_with("inbetweens:"); };
        inBetweens_ += std::ranges::any_of(shape.prim->attributes, isInBetween);
        const std::size_t count = indices.numbers.empty() ? shape.points : indices.numbers.size();
        if (offsets.numbers.size() != 3 * count)
            return leave(fmt::format("{} offsets for {} points", offsets.numbers.size() / 3, count));
        MorphTarget target;
        target.name = shape.name;
        const std::vector<float> numbers = std::move(offsets.numbers).floats();
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t point =
                indices.numbers.empty() ? static_cast<std::int64_t>(i) : indices.numbers.whole(i);
            if (point < 0 || point >= shape.points)
                return leave(fmt::format("moves point {} of {}", point, shape.points));
            const Vec3d offset(double{numbers[3 * i]}, double{numbers[3 * i + 1]},
                               double{numbers[3 * i + 2]});
            if (offset.isZero(0)) continue;
            target.vertices.push_back(shape.first + static_cast<std::uint32_t>(point));
            target.offsets.push_back((shape.toWorld.linear() * offset).cast<float>());
            if (!target.offsets.back().allFinite()) return leave("numbers that are not finite");
        }
        moved_ += target.vertices.size();
        if (moved_ > kMostMorphed)
            return leave(fmt::format("all shapes move more than {} points", kMostMorphed));
        if (target.vertices.empty()) return kNoMorph;
        scene_.morphs.push_back(std::move(target));
        return static_cast<std::uint32_t>(scene_.morphs.size() - 1);
    }

    static std::optional<Vec3f> vectorOf(const std::array<double, 4>& numbers) {
        const Vec3f value = Vec3d(numbers[0], numbers[1], numbers[2]).cast<float>();
        return value.allFinite() ? std::optional(value) : std::nullopt;
    }
    static std::optional<Quatf> rotationOf(const std::array<double, 4>& numbers) {
        const Eigen::Quaterniond value(numbers[0], numbers[1], numbers[2], numbers[3]);
        const double length = value.norm();
        if (!std::isfinite(length) || !(length > 1e-12)) return std::nullopt;
        return value.normalized().cast<float>();
    }

    /// What a topmost joint has before its own transform: a rotation, one factor and a place.
    static void put(Channel& channel, const TransformParts& before) {
        const Quatf turn = before.turn.cast<float>();
        const auto factor = static_cast<float>(before.factors.x());
        for (Vec3f& value : channel.translation.values)
            value = factor * (turn * value) + before.place.cast<float>();
        for (Quatf& value : channel.rotation.values) value = (turn * value).normalized();
        for (Vec3f& value : channel.scale.values) value *= factor;
    }

    Status addMoving(const UsdMovingPrim& prim, Clip& clip) {
        std::set<double> times;
        addTimes(prim.levels, times);
        Channel channel;
        channel.bone = prim.bone;
        const auto at = [&](double code) -> Result<Eigen::Affine3d> {
            auto transform = toFile(prim.levels, code);
            return transform && prim.isTop ? Eigen::Affine3d(turn_ * *transform) : transform;
        };
        const auto isSheared = addTransformKeys(
            times, at, [&](double code) { return range_.seconds(code); }, channel);
        if (!isSheared) return tl::unexpected(isSheared.error());
        isSheared_ = isSheared_ || *isSheared;
        keys_ += 3 * channel.translation.times.size();
        if (!channel.translation.times.empty()) clip.channels.push_back(std::move(channel));
        return {};
    }

    const UsdStage& stage_;
    const UsdRange& range_;
    const Eigen::Affine3d& turn_;
    RawScene& scene_;
    std::size_t keys_ = 0, lost_ = 0;
    bool isSheared_ = false;
    std::map<const UsdBlendShape*, std::uint32_t> targets_;  ///< of the scene
    std::vector<std::string> lostShapes_;
    std::size_t inBetweens_ = 0, moved_ = 0;
};

}  // namespace

Status addUsdClips(const UsdStage& stage, const UsdRange& range, const Eigen::Affine3d& turn,
                   std::span<const UsdMovingPrim> moving, std::span<const UsdSkeletonBones> skeletons,
                   Clip clip, RawScene& scene) {
    return Builder(stage, range, turn, scene).run(moving, skeletons, std::move(clip));
}

}  // namespace hairloom
