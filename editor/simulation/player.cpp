// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/player.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "core/documents/motions.h"
#include "core/editing/document.h"
#include "core/simulation/clip_motion.h"
#include "core/simulation/effect_switch.h"
#include "editor/document/words.h"
#include "editor/simulation/live_engine.h"

namespace hairloom::editor {
namespace {

constexpr float kFrameTime = 1.0f / 60.0f;
constexpr int kPlanPreviewMs = 300;
constexpr QLatin1String kClip("clip:");

Result<std::unique_ptr<HeadMotion>> motionOf(const QString& name, const std::shared_ptr<const Actor>& actor,
                                             const Groom& groom) {
    if (!name.startsWith(kClip)) return makeRigidMotion(name.toStdString(), groom);
    if (!actor) return fail("this head has no animation clips");
    return makeClipMotion(actor, name.mid(kClip.size()).toStdString(), groom);
}

/// The settings without the effects that are left out.
runtime::SimulationSettings without(runtime::SimulationSettings settings, const QStringList& leftOut) {
    for (const QString& effect : leftOut) turnEffectOff(settings, effect.toStdString());
    return settings;
}

std::vector<CollisionSphere> without(std::vector<CollisionSphere> spheres, const QStringList& leftOut) {
    if (leftOut.contains(QLatin1String(kCollisionEffect.data(), kCollisionEffect.size()))) spheres.clear();
    return spheres;
}

bool leavesBodyOut(const QStringList& leftOut) {
    return leftOut.contains(QLatin1String(kBodyEffect.data(), kBodyEffect.size()));
}

/// The groom without the effects that are left out.
Groom without(Groom groom, const QStringList& leftOut) {
    groom.simulation = without(groom.simulation, leftOut);
    groom.spheres = without(std::move(groom.spheres), leftOut);
    if (leavesBodyOut(leftOut)) groom.body.reset();
    return groom;
}

void apply(const Eigen::Isometry3f& offset, HeadPose& pose) {
    pose.head_ws = offset * pose.head_ws;
    for (Vec3f& position : pose.scalpPositions_ws) position = offset * position;
    for (Vec3f& centre : pose.sphereCentres_ws) centre = offset * centre;
    for (auto* bones : {&pose.bones_ws, &pose.body_ws}) {
        for (Eigen::Affine3f& bone : *bones) bone = offset * bone;
    }
}

}  // namespace

/// What the interface has asked of the thread and it has not taken up yet.
struct Player::WorkerRequests {
    bool stop = false;
    bool playing = false;
    int steps = 0;
    bool restart = true;     ///< simulation and motion are made anew from `groom`
    bool regroomed = false;  ///< the strands of `groom` stand elsewhere or are others in looks; they go on
    std::shared_ptr<LiveLink> live;
    EngineWish wish = EngineWish::cpu;
    bool wishChanged = false;
    PlayedMethod method;
    std::shared_ptr<const Groom> groom;
    std::shared_ptr<HeadMotion> motion;
    Eigen::Isometry3f offset = Eigen::Isometry3f::Identity();
    std::optional<runtime::SimulationSettings> settings;
    std::optional<std::vector<CollisionSphere>> spheres;
    QStringList leftOut;
    std::shared_ptr<const Groom> planPreview;  ///< whose plan is asked for
    quint64 epoch = 0;
    std::shared_ptr<const PlayedFrame> delivered;  ///< waits for the interface
};

Player::Player(QtDocument& document, QObject* parent)
    : QObject(parent), document_(document), requests_(std::make_unique<WorkerRequests>()) {
    connect(&document_, &QtDocument::changed, this, &Player::documentChanged);
    connect(&document_, &QtDocument::replaced, this, [this] {
        actor_.reset();
        motion_ = "none";
        reset();
        Q_EMIT motionsChanged();
    });
    planPreviewTimer_.setSingleShot(true);
    planPreviewTimer_.setInterval(kPlanPreviewMs);
    connect(&planPreviewTimer_, &QTimer::timeout, this, &Player::requestPlanPreview);
    thread_ = std::thread([this] { run(); });
}

Player::~Player() {
    request([](WorkerRequests& requests) { requests.stop = true; });
    thread_.join();
}

void Player::request(const std::function<void(WorkerRequests&)>& change) {
    {
        const std::lock_guard lock(mutex_);
        change(*requests_);
    }
    wake_.notify_all();
}

void Player::play() {
    if (document_.groom().strandCount() == 0) {
        Q_EMIT failed(tr("There are no strands to simulate yet"));
        return;
    }
    capture();
    playing_ = true;
    request([](WorkerRequests& requests) { requests.playing = true; });
    Q_EMIT stateChanged();
}

void Player::capture() {
    if (captured_) return;
    captured_ = true;
    auto groom = std::make_shared<const Groom>(document_.groom());
    capturedOffsets_.assign(groom->offsets.view().begin(), groom->offsets.view().end());
    auto made = makeMotion(motion_);
    std::shared_ptr<HeadMotion> motion;
    if (made) motion = std::move(*made);
    request([&](WorkerRequests& requests) {
        requests.groom = std::move(groom);
        requests.motion = std::move(motion);
    });
}

void Player::pause() {
    playing_ = false;
    request([](WorkerRequests& requests) { requests.playing = false; });
    Q_EMIT stateChanged();
}

void Player::step() {
    if (playing_) pause();
    if (document_.groom().strandCount() == 0) return;
    capture();
    request([](WorkerRequests& requests) { ++requests.steps; });
}

void Player::reset() {
    playing_ = false;
    frame_.reset();
    ++epoch_;
    captured_ = false;
    request([&](WorkerRequests& requests) {
        requests.playing = false;
        requests.steps = 0;
        requests.restart = true;
        requests.regroomed = false;
        requests.groom.reset();
        requests.motion.reset();
        requests.offset.setIdentity();
        requests.settings.reset();
        requests.spheres.reset();
        requests.epoch = epoch_;
        requests.delivered.reset();
    });
    Q_EMIT frameReady();
    Q_EMIT stateChanged();
    if (planPreviewOutdated_) outdatePlanPreview();
}

Result<std::unique_ptr<HeadMotion>> Player::makeMotion(const QString& name) const {
    return motionOf(name, actor_, document_.groom());
}

Result<std::unique_ptr<HeadMotion>> Player::makeMeasuredMotion() const {
    return makeMotion(motion_ == "none" ? QStringLiteral("nod") : motion_);
}

Status Player::setMotion(const QString& name) {
    const auto made = makeMotion(name);
    if (!made) return tl::unexpected(made.error());
    const bool play = playing_;
    motion_ = name;
    reset();
    if (play) this->play();
    Q_EMIT motionsChanged();
    return {};
}

QStringList Player::motions() const {
    QStringList names{"none", "nod", "spin"};
    if (actor_) {
        for (const Clip& clip : actor_->clips()) names.append(kClip + QString::fromStdString(clip.name));
    }
    return names;
}

void Player::setActor(std::shared_ptr<const Actor> actor) {
    actor_ = std::move(actor);
    Q_EMIT motionsChanged();
}

void Player::setLeftOut(const QStringList& effects) {
    const bool sameBody = leavesBodyOut(leftOut_) == leavesBodyOut(effects);
    leftOut_ = effects;
    const Groom& groom = document_.groom();
    request([&](WorkerRequests& requests) {
        requests.leftOut = effects;
        requests.regroomed = requests.regroomed || !sameBody;
        requests.settings = groom.simulation;
        requests.spheres = groom.spheres;
    });
    outdatePlanPreview();
    Q_EMIT planPreviewChanged();
}

void Player::setPlanPreviewActive(bool watched) {
    planPreviewActive_ = watched;
    if (watched && planPreviewOutdated_) planPreviewTimer_.start();
    if (!watched) planPreviewTimer_.stop();
}

void Player::outdatePlanPreview() {
    planPreviewOutdated_ = true;
    if (planPreviewActive_) planPreviewTimer_.start();
}

std::vector<EffectReport> Player::effects() const {
    return frame_ ? frame_->stats.effects : planPreview_;
}

void Player::requestPlanPreview() {
    // Not amid a stroke, which would pay for parting from the copy.
    if (document_.editing().stroke()) {
        planPreviewTimer_.start();
        return;
    }
    if (frame_) return;
    planPreviewOutdated_ = false;
    if (document_.groom().strandCount() == 0) {
        planPreview_.clear();
        Q_EMIT planPreviewChanged();
        return;
    }
    request([this](WorkerRequests& requests) {
        requests.planPreview = std::make_shared<const Groom>(document_.groom());
    });
}

void Player::computePlanPreview(const Groom& groom, const QStringList& leftOut) {
    const Groom tried = without(groom, leftOut);
    const auto motion = makeRigidMotion("none", tried);
    if (!motion) return;
    const auto made = Simulation::make(tried, (*motion)->poseAt(0), {});
    if (!made) return;
    QMetaObject::invokeMethod(this, [this, effects = made->stats().effects] {
        planPreview_ = effects;
        Q_EMIT planPreviewChanged();
    });
}

void Player::setLive(std::shared_ptr<LiveLink> live) {
    request([&](WorkerRequests& requests) { requests.live = std::move(live); });
}

void Player::setEngine(EngineWish wish) {
    request([&](WorkerRequests& requests) {
        if (wish == requests.wish || !requests.live) return;
        requests.wish = wish;
        requests.wishChanged = true;
    });
}

void Player::setMethod(const PlayedMethod& method) {
    if (method == method_) return;
    method_ = method;
    request([&](WorkerRequests& requests) {
        requests.method = method;
        requests.regroomed = true;
    });
    outdatePlanPreview();
    Q_EMIT planPreviewChanged();
}

void Player::setHeadOffset(const Eigen::Isometry3f& offset) {
    request([&](WorkerRequests& requests) { requests.offset = offset; });
}

void Player::documentChanged(editing::Part parts) {
    const Groom& groom = document_.groom();
    if (contains(parts, editing::Part::Head)) {
        // Another head, or by undo the one before, has its own skeleton and clips.
        motion_ = "none";
        std::shared_ptr<const Actor> actor;
        if (!groom.characterFile.empty()) {
            if (auto loaded = loadActor({}, groom)) actor = std::move(*loaded);
        }
        setActor(std::move(actor));
    }
    if (contains(parts, editing::Part::Physics | editing::kHairParts | editing::Part::Spheres))
        outdatePlanPreview();
    if (contains(parts, editing::kHairParts | editing::kScalpParts)) {
        if (!captured_) return;
        const bool sameStrands = std::ranges::equal(groom.offsets.view(), capturedOffsets_);
        if (playing_ && sameStrands && !contains(parts, editing::kScalpParts)) {
            request([&](WorkerRequests& requests) {
                requests.groom = std::make_shared<const Groom>(groom);
                requests.regroomed = true;
            });
            return;
        }
        const bool play = playing_ && groom.strandCount() > 0;
        reset();
        if (play) this->play();
        return;
    }
    if (!captured_) return;
    std::shared_ptr<HeadMotion> motion;
    if (contains(parts, editing::Part::Spheres)) {
        // Clips carry spheres along by their bones.
        if (auto made = makeMotion(motion_)) motion = std::move(*made);
    }
    request([&](WorkerRequests& requests) {
        // The other methods are made with what they need, and engines with the body.
        const bool sameBody = !requests.groom || requests.groom->body == groom.body;
        if (method_.method != SimulationMethod::strands || !sameBody) {
            requests.groom = std::make_shared<const Groom>(groom);
            requests.regroomed = true;
        }
        if (contains(parts, editing::Part::Physics)) requests.settings = groom.simulation;
        if (!contains(parts, editing::Part::Spheres)) return;
        requests.spheres = groom.spheres;
        if (motion) requests.motion = motion;
    });
}

/// What the thread has of its own.
struct Player::Playing {
    std::unique_ptr<LiveEngine> engine;
    EngineChoice choice;
    bool deviceFailed = false;  ///< until another wish
    std::shared_ptr<const Groom> groom;
    std::shared_ptr<HeadMotion> motion;
    std::shared_ptr<const HairPose> before;
    double time = 0;
};

void Player::refuse(const Error& error) {
    QMetaObject::invokeMethod(this, [this, words = QString::fromStdString(error.message())] {
        pause();
        Q_EMIT failed(words);
    });
}

void Player::setEngineShown(const EngineChoice& choice) {
    QMetaObject::invokeMethod(this, [this, choice] {
        if (engine_ == choice) return;
        engine_ = choice;
        Q_EMIT engineChanged();
    });
}

bool Player::prepare(Playing& playing, const WorkerRequests& taken) {
    if (taken.wishChanged) playing.deviceFailed = false;
    const bool begins = taken.restart || !playing.engine;
    if (!begins && !taken.regroomed && !taken.wishChanged) return true;
    LiveStart start;
    if (begins) {
        playing.engine.reset();
        playing.before.reset();
        playing.time = 0;
    } else {
        start.state = playing.engine->state();
    }
    if (!playing.groom || !playing.motion) return false;
    const auto tried = std::make_shared<const Groom>(without(*playing.groom, taken.leftOut));
    start.groom = tried;
    start.motion = playing.motion;
    start.pose = playing.motion->poseAt(static_cast<float>(playing.time));
    apply(taken.offset, start.pose);

    EngineChoice choice{EngineKind::cpu, "selected in the preferences"};
    if (playing.deviceFailed) {
        choice = playing.choice;
    } else if (const std::string why = taken.method.whyCpu(); !why.empty()) {
        choice.why = why;
    } else if (taken.wish != EngineWish::cpu) {
        choice = taken.live
                     ->post([&](LiveWork* work) {
                         return work ? work->choose(taken.wish, *tried)
                                     : EngineChoice{EngineKind::cpu, "there is no graphics device"};
                     })
                     .get();
    }
    // The other engine goes first: the device has room for one hairstyle more.
    playing.engine.reset();
    if (choice.kind == EngineKind::gpu) {
        auto made = makeDeviceEngine(taken.live, start);
        if (made) playing.engine = std::move(*made);
        if (!made) choice = {EngineKind::cpu, made.error().message()};
    }
    if (!playing.engine) {
        auto made = makeCpuEngine(start, playing.time, taken.method);
        if (!made) {
            refuse(made.error());
            return false;
        }
        playing.engine = std::move(*made);
    }
    playing.choice = choice;
    setEngineShown(choice);
    return true;
}

void Player::advance(Playing& playing, WorkerRequests& taken) {
    const auto begin = std::chrono::steady_clock::now();
    LiveChanges changes;
    if (taken.settings) changes.settings = without(*taken.settings, taken.leftOut);
    if (taken.spheres) changes.spheres = without(std::move(*taken.spheres), taken.leftOut);
    playing.time += static_cast<double>(kFrameTime);
    auto pose = std::make_shared<HairPose>();
    pose->head = playing.motion->poseAt(static_cast<float>(playing.time));
    apply(taken.offset, pose->head);
    Status refused;
    auto stepped = playing.engine->step(kFrameTime, playing.time, std::move(changes), *pose, refused);
    if (!stepped && playing.choice.kind == EngineKind::gpu) {
        // A device that was lost takes the motion of the hair along, and nothing else.
        playing.deviceFailed = true;
        playing.choice = {EngineKind::cpu, "the device failed: " + stepped.error().message()};
        WorkerRequests again = taken;
        again.regroomed = true;
        Q_EMIT failed(
            tr("The GPU stopped simulating (%1). The CPU continues").arg(errorText(stepped.error())));
        if (!prepare(playing, again)) return;
        stepped = playing.engine->step(kFrameTime, playing.time, {}, *pose, refused);
    }
    if (!stepped) refused = stepped;
    if (!refused) refuse(refused.error());
    auto frame = std::make_shared<PlayedFrame>();
    // An engine that has just begun may have no positions yet, and the hair other points than before.
    if (const auto last = std::exchange(playing.before, pose);
        last && last->positions_ws.size() == pose->positions_ws.size()) {
        frame->before = last;
    }
    frame->pose = std::move(pose);
    frame->time = playing.time;
    const double clock =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    const double device = playing.engine->milliseconds();
    frame->milliseconds = device > 0 ? device : clock;
    frame->stats = playing.engine->stats();
    deliver(std::move(frame), taken.epoch);
}

void Player::run() {
    Playing playing;
    auto due = std::chrono::steady_clock::now();
    while (true) {
        WorkerRequests taken;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] {
                const bool letGo = requests_->restart && playing.engine;
                return requests_->stop || requests_->playing || requests_->steps > 0 || letGo ||
                       requests_->planPreview;
            });
            if (requests_->steps == 0 && requests_->playing) {
                wake_.wait_until(lock, due, [this] { return requests_->stop; });
            }
            if (requests_->stop) return;
            if (requests_->planPreview) {
                const auto planPreview = std::exchange(requests_->planPreview, nullptr);
                const QStringList leftOut = requests_->leftOut;
                lock.unlock();
                computePlanPreview(*planPreview, leftOut);
                continue;
            }
            if (!requests_->playing && requests_->steps == 0) {
                if (requests_->restart) playing = {};
                continue;
            }
            if (requests_->steps > 0) --requests_->steps;
            taken = *requests_;
            requests_->restart = requests_->regroomed = requests_->wishChanged = false;
            requests_->settings.reset();
            requests_->spheres.reset();
        }
        due = std::chrono::steady_clock::now() + std::chrono::microseconds(16'667);
        playing.groom = taken.groom;
        playing.motion = taken.motion;
        if (prepare(playing, taken)) {
            advance(playing, taken);
        } else if (playing.groom && playing.motion) {
            request([](WorkerRequests& requests) { requests.playing = false; });
        }
    }
}

void Player::deliver(std::shared_ptr<const PlayedFrame> frame, quint64 epoch) {
    bool isFirst = false;
    {
        const std::lock_guard lock(mutex_);
        if (epoch != requests_->epoch) return;
        isFirst = !requests_->delivered;
        requests_->delivered = std::move(frame);
    }
    // One message under way is enough: it takes the newest frame.
    if (!isFirst) return;
    QMetaObject::invokeMethod(this, [this] {
        std::shared_ptr<const PlayedFrame> newest;
        {
            const std::lock_guard lock(mutex_);
            newest = std::exchange(requests_->delivered, nullptr);
        }
        if (!newest) return;
        frame_ = std::move(newest);
        Q_EMIT frameReady();
    });
}

}  // namespace hairloom::editor
