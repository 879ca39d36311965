// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/keying.h"

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/groom/poses.h"
#include "core/simulation/time_line_motion.h"
#include "editor/document/words.h"

namespace hairloom::editor {
namespace {

using Of = KeyTrack::Of;

/// Of the head's keys alone, at that time.
Eigen::Isometry3d headAt(const TimeLine& line, float time, const Groom& groom) {
    if (line.head.empty()) return Eigen::Isometry3d::Identity();
    TimeLine keys;
    keys.loop = false;
    keys.head = line.head;
    const auto motion = makeTimeLineMotion(std::move(keys), nullptr, groom);
    if (!motion) return Eigen::Isometry3d::Identity();
    const HeadPose pose = (*motion)->poseAt(time);
    return Eigen::Translation3d(pose.origin_ws) * pose.head_ws.cast<double>();
}

HeadKey keyOf(const Eigen::Isometry3d& head, float time) {
    const Eigen::AngleAxisd turn(head.linear());
    HeadKey key;
    key.time = time;
    key.translation = head.translation();
    key.axis = turn.axis().cast<float>();
    key.degrees = degrees(static_cast<float>(turn.angle()));
    return key;
}

/// With all the turns of keys about one axis.
HeadKey headKeyAt(const TimeLine& line, float time, const Groom& groom) {
    HeadKey key = keyOf(headAt(line, time, groom), time);
    const auto [from, share] = betweenKeys(line.head, time);
    const HeadKey& before = line.head[from];
    const HeadKey& after = share > 0 ? line.head[from + 1] : before;
    if (before.axis.normalized() != after.axis.normalized()) return key;
    key.axis = before.axis;
    key.degrees = before.degrees + share * (after.degrees - before.degrees);
    return key;
}

Vec3f meanWind(const runtime::SimulationSettings& settings) {
    const Vec3f direction(settings.windDirection.x, settings.windDirection.y, settings.windDirection.z);
    return direction.norm() > 0 ? Vec3f(direction.normalized() * settings.windSpeed) : Vec3f::Zero();
}

/// Of its keys, which are there.
Vec3f windAt(const TimeLine& line, float time) {
    const auto [w, share] = betweenKeys(line.wind, time);
    const Vec3f& from = line.wind[w].velocity;
    return share > 0 ? Vec3f(from + (line.wind[w + 1].velocity - from) * share) : from;
}

}  // namespace

QString labelOf(const KeyTrack& track) {
    switch (track.of) {
        case Of::clips:
            return "Clips";
        case Of::head:
            return "Head";
        case Of::wind:
            return "Wind";
        case Of::setting:
            break;
    }
    // A pose is called as its artist calls it.
    if (track.name.starts_with(kPosePrefix))
        return QString::fromStdString(track.name.substr(kPosePrefix.size()));
    return labelOf(QString::fromStdString(track.name).section('.', 1));
}

Keying::Keying(QtDocument& document, Player& player, Messages& messages, QObject* parent)
    : QObject(parent), document_(document), player_(player), messages_(messages) {
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (!contains(parts, editing::Part::TimeLine)) return;
        Q_EMIT lineChanged();
        Q_EMIT changed();
    });
    connect(&document_, &QtDocument::replaced, this, [this] {
        Q_EMIT replaced();
        Q_EMIT changed();
    });
    connect(&player_, &Player::playHeadMoved, this, &Keying::changed);
    connect(&player_, &Player::stateChanged, this, &Keying::changed);
}

bool Keying::change(TimeLine to, const QString& name, quint64 mergeKey) {
    bool done = true;
    const auto make = [&](const editing::Model& model) -> std::unique_ptr<editing::Command> {
        auto made = editing::setTimeLine(model, to, name.toStdString());
        if (made) return std::move(*made);
        done = false;
        messages_.warn(errorText(made.error()));
        return nullptr;
    };
    document_.performMerged(mergeKey == 0 ? QtDocument::nextMergeKey() : mergeKey, make);
    return done;
}

void Keying::keySetting(const std::string& name) {
    if (findKeyable(name) == nullptr) return;
    TimeLine to = line();
    hairloom::keySetting(to, name, player_.lineTime(), authoredValue(document_.groom(), name));
    change(std::move(to), "Key " + labelOf(KeyTrack{Of::setting, name}));
}

void Keying::removeSetting(const std::string& name) {
    TimeLine to = line();
    std::erase_if(to.settings, [&](const SettingTrack& track) { return track.name == name; });
    change(std::move(to), "Remove keys of " + labelOf(KeyTrack{Of::setting, name}));
}

void Keying::keyHead() {
    TimeLine to = line();
    const float time = player_.lineTime();
    const Eigen::Isometry3d byHand = player_.headOffset().cast<double>();
    if (byHand.isApprox(Eigen::Isometry3d::Identity()) && !to.head.empty())
        hairloom::keyHead(to, headKeyAt(line(), time, document_.groom()));
    else
        hairloom::keyHead(to, keyOf(byHand * headAt(line(), time, document_.groom()), time));
    // What the hand did is in the key now.
    if (change(std::move(to), "Key head")) player_.setHeadOffset(Eigen::Isometry3f::Identity());
}

void Keying::keyWind() {
    TimeLine to = line();
    hairloom::keyWind(to, player_.lineTime(), meanWind(document_.groom().simulation));
    change(std::move(to), "Key wind");
}

void Keying::addClip(const QString& clip) {
    TimeLine to = line();
    ClipStrip strip;
    strip.name = clip.toStdString();
    strip.start = player_.lineTime();
    hairloom::addClip(to, std::move(strip));
    change(std::move(to), "Add clip");
}

void Keying::insertKey(const KeyTrack& track, float time) {
    TimeLine to = line();
    if (findKey(to, track, time)) return;
    switch (track.of) {
        case Of::clips:
            return;
        case Of::head:
            hairloom::keyHead(to, headKeyAt(line(), time, document_.groom()));
            break;
        case Of::wind:
            hairloom::keyWind(to, time, windAt(line(), time));
            break;
        case Of::setting:
            for (const SettingTrack& keyed : line().settings) {
                if (keyed.name == track.name)
                    hairloom::keySetting(to, track.name, time, valueAt(keyed, time));
            }
    }
    change(std::move(to), "Insert key");
}

bool Keying::hasKeyHere(const KeyTrack& track) const {
    return findKey(line(), track, player_.lineTime()).has_value();
}

}  // namespace hairloom::editor
