// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/time_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/groom/file/fields.h"
#include "core/groom/groom.h"
#include "core/groom/poses.h"

namespace hairloom {
namespace {

using runtime::FieldInfo;
using runtime::SimulationSettings;

constexpr std::string_view kSimulation = "simulation.", kMaterial = "material.";
constexpr double kLongest = static_cast<double>(kLatestKey);

// clang-format off
constexpr Field<ClipStrip> kClipFields[] = {
    field<&ClipStrip::start>("start", "s", 0, kLongest, "time at which the clip begins"),
    field<&ClipStrip::first>("first", "s", 0, kLongest, "time of the clip that plays first"),
    field<&ClipStrip::last>("last", "s", 0, kLongest, "time of the clip that plays last: 0 is its end"),
    field<&ClipStrip::speed>("speed", "", 0, 100, "speed of the clip: 1 as it was made, 0 holds its first frame"),
    boolField<&ClipStrip::loop>("loop", "repeats the clip until the next one"),
    field<&ClipStrip::blend>("blend", "s", 0, kLongest, "time over which it takes over from the clip before"),
};
constexpr Field<TimeLine> kLineFields[] = {
    field<&TimeLine::framesPerSecond>("framesPerSecond", "1/s", 1, 240, "frame rate: frames are simulated and shown this often"),
    field<&TimeLine::start>("start", "s", 0, kLongest, "time at which playing starts"),
    field<&TimeLine::end>("end", "s", 0, kLongest, "time at which playing ends"),
    field<&TimeLine::preRoll>("preRoll", "", 0, 100'000, "frames on the first pose before the start: they settle the hair"),
    boolField<&TimeLine::loop>("loop", "starts again behind the end, while the hair keeps moving"),
};
// clang-format on

/// Gathers problems below a place.
class Problems {
  public:
    void add(std::string where, std::string what, std::string expected) {
        found_.push_back({std::move(where), std::move(what), std::move(expected)});
    }
    template <class S>
    void addFields(const std::string& where, const S& settings) {
        for (const runtime::FieldProblem& problem : runtime::problemsIn(settings))
            add(where + problem.where(), fmt::format("is {}", problem.value),
                "expected " + rangeText(problem.field->min, problem.field->max, problem.field->unit));
    }
    template <class Key>
    void addTimes(const std::string& where, const std::vector<Key>& keys) {
        for (std::size_t k = 0; k < keys.size(); ++k) {
            const float time = keys[k].time;
            const std::string place = fmt::format("{}/{}/t", where, k);
            if (!(time >= 0 && time <= kLatestKey))
                add(place, fmt::format("is {} s", time), "expected " + rangeText(0, kLongest, "s"));
            else if (k > 0 && !(time > keys[k - 1].time))
                add(place,
                    fmt::format("is {} s, not later than the key before it at {} s", time, keys[k - 1].time),
                    "expected each key after the one before");
        }
    }
    std::vector<TimeLineProblem> take() { return std::move(found_); }

  private:
    std::vector<TimeLineProblem> found_;
};

void checkHead(const std::vector<HeadKey>& keys, Problems& problems) {
    problems.addTimes("head", keys);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const std::string where = fmt::format("head/{}/", k);
        const HeadKey& key = keys[k];
        // The greatest of numbers says nothing where one is none.
        if (!key.translation.allFinite() || key.translation.cwiseAbs().maxCoeff() > kFarthestKey)
            problems.add(where + "translate", "is too far or not finite",
                         "expected " + rangeText(-kFarthestKey, kFarthestKey, "m"));
        if (!(key.axis.norm() >= kShortestAxis) || !key.axis.allFinite())
            problems.add(where + "axis", "has no direction", "expected a vector of at least 1e-6");
        if (!(std::abs(key.degrees) <= kMostKeyedDegrees))
            problems.add(where + "degrees", fmt::format("is {}", key.degrees),
                         "expected " + rangeText(-kLongest, kLongest, "degrees"));
    }
}

void checkWind(const std::vector<WindKey>& keys, Problems& problems) {
    problems.addTimes("wind", keys);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (keys[k].velocity.allFinite() && keys[k].velocity.norm() <= kFastestKeyedWind) continue;
        problems.add(fmt::format("wind/{}/velocity", k), "is too fast",
                     fmt::format("expected at most {} m/s", kFastestKeyedWind));
    }
}

void checkTrack(const SettingTrack& track, const std::string& where, Problems& problems) {
    const FieldInfo* const field = findKeyable(track.name);
    if (field == nullptr) {
        problems.add(where + "name", fmt::format("is \"{}\", which cannot be keyed", track.name),
                     fmt::format("expected one of {}", fmt::join(keyableNames(), ", ")));
        return;
    }
    if (track.keys.empty()) problems.add(where + "keys", "is empty", "expected at least one key");
    problems.addTimes(where + "keys", track.keys);
    for (std::size_t k = 0; k < track.keys.size(); ++k) {
        const std::string place = fmt::format("{}keys/{}/", where, k);
        const SettingKey& key = track.keys[k];
        for (std::uint32_t c = 0; c < field->components(); ++c) {
            if (!field->holds(key.value[c]))
                problems.add(place + "value", fmt::format("is {}", key.value[c]),
                             "expected " + rangeText(field->min, field->max, field->unit));
        }
        if (field->isWhole() && key.interpolation != KeyInterpolation::step)
            problems.add(
                place + "interpolate",
                fmt::format("is \"{}\"", kKeyInterpolations[static_cast<int>(key.interpolation)]),
                fmt::format("expected \"step\", since {} has nothing between its values", field->name));
    }
}

void checkClips(const TimeLine& line, Problems& problems) {
    for (std::size_t i = 0; i < line.clips.size(); ++i) {
        const ClipStrip& strip = line.clips[i];
        const std::string where = fmt::format("clips/{}/", i);
        if (strip.name.empty()) problems.add(where + "name", "is empty", "expected the name of a clip");
        problems.addFields(where, strip);
        if (strip.last != 0 && !(strip.last > strip.first))
            problems.add(where + "last", fmt::format("is {} s", strip.last),
                         fmt::format("expected more than first, {} s, or 0", strip.first));
        if (i == 0) {
            if (strip.blend > 0)
                problems.add(where + "blend", fmt::format("is {} s", strip.blend),
                             "expected 0, since no clip comes before");
            continue;
        }
        const ClipStrip& before = line.clips[i - 1];
        if (!(strip.start > before.start))
            problems.add(
                where + "start",
                fmt::format("is {} s, not later than the clip before it at {} s", strip.start, before.start),
                "expected each clip after the one before");
        else if (before.start + before.blend > strip.start)
            problems.add(
                fmt::format("clips/{}/blend", i - 1), fmt::format("is {} s", before.blend),
                fmt::format("expected at most {} s, until the next clip starts", strip.start - before.start));
    }
}

}  // namespace

std::span<const Field<ClipStrip>> fieldsOf(const ClipStrip&) {
    return kClipFields;
}
std::span<const Field<TimeLine>> fieldsOf(const TimeLine&) {
    return kLineFields;
}

std::uint64_t TimeLine::frameCount() const {
    const double frames = std::round(static_cast<double>(end - start) * static_cast<double>(framesPerSecond));
    return static_cast<std::uint64_t>(std::max(frames, 1.0));
}

float TimeLine::timeAt(float seconds) const {
    const float length = end - start;
    if (!loop || seconds <= length) return start + seconds;
    // The last frame is at the end, as without a loop.
    const float rest = std::fmod(seconds, length);
    return start + (rest > 0 ? rest : length);
}

const TimeLine& timeLineOf(const Groom& groom) {
    static const TimeLine empty;
    return groom.timeLine ? *groom.timeLine : empty;
}

const FieldInfo* findKeyable(std::string_view name) {
    const FieldInfo* field = nullptr;
    if (name.starts_with(kSimulation))
        field = runtime::findField<SimulationSettings>(name.substr(kSimulation.size()));
    else if (name.starts_with(kMaterial))
        field = runtime::findField<HairMaterial>(name.substr(kMaterial.size()));
    else if (name.starts_with(kPosePrefix) && checkPoseName(name.substr(kPosePrefix.size())))
        field = runtime::findField<GroomPose>("amount");
    // These choose the engine, or have it count all of the hair anew. Of the material they choose what draws
    // it, or which strands look otherwise.
    constexpr std::array<std::string_view, 17> kChosenBefore{"simulation.strandModel",
                                                             "simulation.hairHair",
                                                             "simulation.hairHairCell",
                                                             "simulation.windShelter",
                                                             "simulation.collisionSegments",
                                                             "simulation.latticeNodes",
                                                             "simulation.latticeRootFrequency",
                                                             "simulation.latticeTipFrequency",
                                                             "simulation.latticeCouplingFrequency",
                                                             "material.shadingModel",
                                                             "material.tubes",
                                                             "material.streakShare",
                                                             "material.streakWidth",
                                                             "material.streakSoftness",
                                                             "material.greyShare",
                                                             "material.dyeStrength",
                                                             "material.dyeRegrowth"};
    const bool cannot = field == nullptr || field->kind == FieldKind::Ramp ||
                        field->kind == FieldKind::Seed || std::ranges::count(kChosenBefore, name) > 0;
    return cannot ? nullptr : field;
}

std::vector<std::string> keyableNames() {
    std::vector<std::string> names;
    const auto add = [&](std::string_view section, const auto& fields) {
        for (const FieldInfo& field : fields) {
            std::string name = std::string(section) + field.name;
            if (findKeyable(name) != nullptr) names.push_back(std::move(name));
        }
    };
    add(kSimulation, fieldsOf(SimulationSettings()));
    add(kMaterial, fieldsOf(HairMaterial()));
    return names;
}

std::vector<std::string> keyableNames(const Groom& groom) {
    std::vector<std::string> names = keyableNames();
    const auto behind =
        std::ranges::find_if(names, [](const std::string& name) { return !name.starts_with(kSimulation); });
    std::vector<std::string> poses;
    for (const GroomPose& pose : groom.poses) poses.push_back(poseAttribute(pose.name));
    names.insert(behind, poses.begin(), poses.end());
    return names;
}

Vec3d valueAt(const SettingTrack& track, float time) {
    const auto [from, share] = betweenKeys(track.keys, time);
    const Vec3d& value = track.keys[from].value;
    if (share == 0) return value;
    return value + static_cast<double>(share) * (track.keys[from + 1].value - value);
}

namespace {

/// Whether a track is of that section.
auto isOf(std::string_view section) {
    return [section](const SettingTrack& track) { return track.name.starts_with(section); };
}

/// What the tracks of a section key of `settings`.
template <class S>
void takeKeys(const TimeLine& line, std::string_view section, float time, S& settings) {
    for (const SettingTrack& track : line.settings) {
        if (!track.name.starts_with(section) || track.keys.empty()) continue;
        // The section says whose field it is.
        const auto* const field = static_cast<const runtime::Field<S>*>(findKeyable(track.name));
        if (field == nullptr) continue;
        const Vec3d value = valueAt(track, time);
        for (std::uint32_t c = 0; c < field->components(); ++c)
            runtime::setFieldValue(settings, *field, value[c], c);
    }
}

template <class S>
Vec3d valueOf(const S& settings, std::string_view name) {
    Vec3d value = Vec3d::Zero();
    if (const auto* const field = runtime::findField<S>(name)) {
        for (std::uint32_t c = 0; c < field->components(); ++c)
            value[c] = runtime::fieldValue(settings, *field, c);
    }
    return value;
}

Vec3d amountOf(const Groom& groom, std::string_view pose) {
    const auto found = findPose(groom, pose);
    return {found ? static_cast<double>(groom.poses[*found].amount) : 0, 0, 0};
}

}  // namespace

SimulationSettings settingsAt(const TimeLine& line, float time, const SimulationSettings& authored) {
    SimulationSettings settings = authored;
    takeKeys(line, kSimulation, time, settings);
    return settings;
}

HairMaterial materialAt(const TimeLine& line, float time, const HairMaterial& authored) {
    HairMaterial material = authored;
    takeKeys(line, kMaterial, time, material);
    return material;
}

std::vector<float> poseAmountsAt(const TimeLine& line, float time, std::span<const GroomPose> authored) {
    std::vector<float> amounts;
    for (const GroomPose& pose : authored) {
        const auto track = std::ranges::find(line.settings, poseAttribute(pose.name), &SettingTrack::name);
        const bool isKeyed = track != line.settings.end() && !track->keys.empty();
        amounts.push_back(isKeyed ? static_cast<float>(valueAt(*track, time)[0]) : pose.amount);
    }
    return amounts;
}

bool keysSimulation(const TimeLine& line) {
    return std::ranges::any_of(line.settings, isOf(kSimulation));
}

bool keysMaterial(const TimeLine& line) {
    return std::ranges::any_of(line.settings, isOf(kMaterial));
}

bool movesAlike(const TimeLine& one, const TimeLine& other) {
    TimeLine a = one, b = other;
    for (TimeLine* line : {&a, &b}) std::erase_if(line->settings, isOf(kMaterial));
    return a == b;
}

Vec3d authoredValue(const Groom& groom, std::string_view name) {
    return name.starts_with(kMaterial)     ? valueOf(groom.material, name.substr(kMaterial.size()))
           : name.starts_with(kPosePrefix) ? amountOf(groom, name.substr(kPosePrefix.size()))
           : name.starts_with(kSimulation) ? valueOf(groom.simulation, name.substr(kSimulation.size()))
                                           : Vec3d(Vec3d::Zero());
}

std::vector<TimeLineProblem> problemsOf(const TimeLine& line) {
    Problems problems;
    problems.addFields({}, line);
    if (!(line.end > line.start))
        problems.add("end", fmt::format("is {} s", line.end),
                     fmt::format("expected more than start, {} s", line.start));
    else if (static_cast<double>(line.end - line.start) * static_cast<double>(line.framesPerSecond) > 1e6)
        problems.add("end", fmt::format("is {} s", line.end),
                     "expected at most 1000000 frames from start to end");
    std::size_t keys = line.clips.size() + line.head.size() + line.wind.size() + line.settings.size();
    for (const SettingTrack& track : line.settings) keys += track.keys.size();
    if (keys > kMaxKeys) {
        problems.add("keys", fmt::format("are {}", keys), fmt::format("expected at most {}", kMaxKeys));
        return problems.take();
    }
    checkClips(line, problems);
    checkHead(line.head, problems);
    checkWind(line.wind, problems);
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < line.settings.size(); ++i) {
        checkTrack(line.settings[i], fmt::format("settings/{}/", i), problems);
        if (!names.insert(line.settings[i].name).second)
            problems.add(fmt::format("settings/{}/name", i),
                         fmt::format("is \"{}\" again", line.settings[i].name), "expected each setting once");
    }
    return problems.take();
}

}  // namespace hairloom
