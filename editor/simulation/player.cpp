// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/player.h"

#include <QElapsedTimer>
#include <chrono>
#include <optional>

#include "core/editing/document.h"
#include "core/simulation/clip_motion.h"
#include "core/simulation/effect_switch.h"
#include "core/simulation/engine_control.h"
#include "editor/simulation/live_method.h"

namespace hairloom::editor {
namespace {

constexpr float kFrameTime = 1.0f / 60.0f;
constexpr int kOutlookMs = 300;
constexpr QLatin1String kClip("clip:");

Result<std::unique_ptr<HeadMotion>> motionOf(const QString& name, const std::shared_ptr<const Actor>& actor,
                                             const Groom& groom) {
    if (!name.startsWith(kClip)) return makeRigidMotion(name.toStdString(), groom);
    if (!actor) return fail("this head came without clips");
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

void apply(const Eigen::Isometry3f& offset, HeadPose& pose) {
    pose.head_ws = offset * pose.head_ws;
    for (Vec3f& position : pose.scalpPositions_ws) position = offset * position;
    for (Vec3f& centre : pose.sphereCentres_ws) centre = offset * centre;
}

}  // namespace

/// What the interface has asked of the thread and it has not taken up yet.
struct Player::Orders {
    bool stop = false;
    bool playing = false;
    int steps = 0;
    bool restart = true;  ///< simulation and motion are made anew from `groom`
    std::shared_ptr<const Groom> groom;
    std::shared_ptr<HeadMotion> motion;
    Eigen::Isometry3f offset = Eigen::Isometry3f::Identity();
    std::optional<runtime::SimulationSettings> settings;
    std::optional<std::vector<CollisionSphere>> spheres;
    QStringList leftOut;
    std::shared_ptr<const Groom> outlook;  ///< whose plan is asked for
    quint64 epoch = 0;
    std::shared_ptr<const PlayedFrame> delivered;  ///< waits for the interface
};

Player::Player(Document& document, QObject* parent)
    : QObject(parent), document_(document), orders_(std::make_unique<Orders>()) {
    connect(&document_, &Document::changed, this, &Player::documentChanged);
    connect(&document_, &Document::replaced, this, [this] {
        actor_.reset();
        motion_ = "none";
        reset();
        Q_EMIT motionsChanged();
    });
    outlookSoon_.setSingleShot(true);
    outlookSoon_.setInterval(kOutlookMs);
    connect(&outlookSoon_, &QTimer::timeout, this, &Player::askForOutlook);
    thread_ = std::thread([this] { run(); });
}

Player::~Player() {
    order([](Orders& orders) { orders.stop = true; });
    thread_.join();
}

void Player::order(const std::function<void(Orders&)>& change) {
    {
        const std::lock_guard lock(mutex_);
        change(*orders_);
    }
    wake_.notify_all();
}

void Player::play() {
    if (document_.groom().strandCount() == 0) {
        Q_EMIT failed(tr("There are no strands to move yet"));
        return;
    }
    capture();
    playing_ = true;
    order([](Orders& orders) { orders.playing = true; });
    Q_EMIT stateChanged();
}

void Player::capture() {
    if (captured_) return;
    captured_ = true;
    auto groom = std::make_shared<const Groom>(document_.groom());
    auto made = motionOf(motion_, actor_, *groom);
    std::shared_ptr<HeadMotion> motion;
    if (made) motion = std::move(*made);
    order([&](Orders& orders) {
        orders.groom = std::move(groom);
        orders.motion = std::move(motion);
    });
}

void Player::pause() {
    playing_ = false;
    order([](Orders& orders) { orders.playing = false; });
    Q_EMIT stateChanged();
}

void Player::step() {
    if (playing_) pause();
    if (document_.groom().strandCount() == 0) return;
    capture();
    order([](Orders& orders) { ++orders.steps; });
}

void Player::reset() {
    playing_ = false;
    frame_.reset();
    ++epoch_;
    captured_ = false;
    order([&](Orders& orders) {
        orders.playing = false;
        orders.steps = 0;
        orders.restart = true;
        orders.groom.reset();
        orders.motion.reset();
        orders.offset.setIdentity();
        orders.settings.reset();
        orders.spheres.reset();
        orders.epoch = epoch_;
        orders.delivered.reset();
    });
    Q_EMIT frameReady();
    Q_EMIT stateChanged();
    if (outlookOutdated_) outdateOutlook();
}

Status Player::setMotion(const QString& name) {
    const auto made = motionOf(name, actor_, document_.groom());
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
    leftOut_ = effects;
    const Groom& groom = document_.groom();
    order([&](Orders& orders) {
        orders.leftOut = effects;
        orders.settings = groom.simulation;
        orders.spheres = groom.spheres;
    });
    outdateOutlook();
    Q_EMIT outlookChanged();
}

void Player::setOutlookWatched(bool watched) {
    outlookWatched_ = watched;
    if (watched && outlookOutdated_) outlookSoon_.start();
    if (!watched) outlookSoon_.stop();
}

void Player::outdateOutlook() {
    outlookOutdated_ = true;
    if (outlookWatched_) outlookSoon_.start();
}

std::vector<EffectReport> Player::effects() const {
    return frame_ ? frame_->stats.effects : outlook_;
}

void Player::askForOutlook() {
    // Not amid a stroke, which would pay for parting from the copy.
    if (document_.editing().stroke()) {
        outlookSoon_.start();
        return;
    }
    if (frame_) return;
    outlookOutdated_ = false;
    if (document_.groom().strandCount() == 0) {
        outlook_.clear();
        Q_EMIT outlookChanged();
        return;
    }
    order([this](Orders& orders) { orders.outlook = std::make_shared<const Groom>(document_.groom()); });
}

void Player::findOutlook(const Groom& groom, const QStringList& leftOut) {
    Groom tried = groom;
    tried.simulation = without(tried.simulation, leftOut);
    tried.spheres = without(std::move(tried.spheres), leftOut);
    const auto motion = makeRigidMotion("none", tried);
    if (!motion) return;
    const auto made = Simulation::make(tried, (*motion)->poseAt(0), {});
    if (!made) return;
    QMetaObject::invokeMethod(this, [this, effects = made->stats().effects] {
        outlook_ = effects;
        Q_EMIT outlookChanged();
    });
}

void Player::setHeadOffset(const Eigen::Isometry3f& offset) {
    order([&](Orders& orders) { orders.offset = offset; });
}

void Player::documentChanged(Changes changes) {
    const Groom& groom = document_.groom();
    if (changes & (Changes(Change::Simulation) | Change::Strands | Change::Spheres)) outdateOutlook();
    if (changes & (Changes(Change::Strands) | Change::Scalp)) {
        if (!captured_) return;
        const bool play = playing_ && groom.strandCount() > 0;
        reset();
        if (play) this->play();
        return;
    }
    if (!captured_) return;
    std::shared_ptr<HeadMotion> motion;
    if (changes & Change::Spheres) {
        // Clips carry spheres along by their bones.
        if (auto made = motionOf(motion_, actor_, groom)) motion = std::move(*made);
    }
    order([&](Orders& orders) {
        if (changes & Change::Simulation) orders.settings = groom.simulation;
        if (!(changes & Change::Spheres)) return;
        orders.spheres = groom.spheres;
        if (motion) orders.motion = motion;
    });
}

void Player::run() {
    const auto knobs = std::make_shared<LiveKnobs>();
    std::optional<Simulation> simulation;
    std::shared_ptr<const Groom> groom;
    std::shared_ptr<HeadMotion> motion;
    std::shared_ptr<const HairPose> before;
    double time = 0;
    quint64 epoch = 0;
    auto due = std::chrono::steady_clock::now();
    while (true) {
        Eigen::Isometry3f offset;
        std::optional<runtime::SimulationSettings> settings;
        std::optional<std::vector<CollisionSphere>> spheres;
        QStringList leftOut;
        bool restart = false;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] {
                const bool letGo = orders_->restart && simulation;
                return orders_->stop || orders_->playing || orders_->steps > 0 || letGo || orders_->outlook;
            });
            if (orders_->steps == 0 && orders_->playing) {
                wake_.wait_until(lock, due, [this] { return orders_->stop; });
            }
            if (orders_->stop) return;
            leftOut = orders_->leftOut;
            if (orders_->outlook) {
                const auto outlook = std::exchange(orders_->outlook, nullptr);
                lock.unlock();
                findOutlook(*outlook, leftOut);
                continue;
            }
            if (!orders_->playing && orders_->steps == 0) {
                if (orders_->restart) {
                    simulation.reset();
                    groom.reset();
                    motion.reset();
                }
                continue;
            }
            if (orders_->steps > 0) --orders_->steps;
            restart = std::exchange(orders_->restart, false);
            offset = orders_->offset;
            groom = orders_->groom;
            motion = orders_->motion;
            epoch = orders_->epoch;
            settings = std::exchange(orders_->settings, std::nullopt);
            spheres = std::exchange(orders_->spheres, std::nullopt);
        }
        const auto begin = std::chrono::steady_clock::now();
        due = begin + std::chrono::microseconds(16'667);
        const auto refuse = [this](const Error& error) {
            QMetaObject::invokeMethod(this, [this, words = QString::fromStdString(error.message())] {
                pause();
                Q_EMIT failed(words);
            });
        };
        if (restart || !simulation) {
            simulation.reset();
            time = 0;
            if (!groom || !motion) continue;
            SimulationOptions options;
            options.backend = liveMethod(knobs);
            Groom tried = *groom;
            tried.simulation = without(tried.simulation, leftOut);
            auto made = Simulation::make(tried, motion->poseAt(0), options);
            if (!made) {
                order([](Orders& orders) { orders.playing = false; });
                refuse(made.error());
                continue;
            }
            simulation.emplace(std::move(*made));
            knobs->spheres = without(groom->spheres, leftOut);
            before.reset();
        }
        if (settings) {
            if (auto taken = setEngineSettings(*knobs->engine, without(*settings, leftOut)); !taken) {
                refuse(taken.error());
            }
        }
        if (spheres) knobs->spheres = without(std::move(*spheres), leftOut);
        time += static_cast<double>(kFrameTime);
        auto pose = std::make_shared<HairPose>();
        pose->head = motion->poseAt(static_cast<float>(time));
        apply(offset, pose->head);
        simulation->step(kFrameTime, pose->head);
        const auto points = simulation->positions_ws();
        pose->positions_ws.assign(points.begin(), points.end());
        auto frame = std::make_shared<PlayedFrame>();
        frame->before = std::exchange(before, pose);
        frame->pose = std::move(pose);
        frame->time = time;
        frame->milliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        frame->stats = simulation->stats();
        deliver(std::move(frame), epoch);
    }
}

void Player::deliver(std::shared_ptr<const PlayedFrame> frame, quint64 epoch) {
    bool isFirst = false;
    {
        const std::lock_guard lock(mutex_);
        if (epoch != orders_->epoch) return;
        isFirst = !orders_->delivered;
        orders_->delivered = std::move(frame);
    }
    // One message under way is enough: it takes the newest frame.
    if (!isFirst) return;
    QMetaObject::invokeMethod(this, [this] {
        std::shared_ptr<const PlayedFrame> newest;
        {
            const std::lock_guard lock(mutex_);
            newest = std::exchange(orders_->delivered, nullptr);
        }
        if (!newest) return;
        frame_ = std::move(newest);
        Q_EMIT frameReady();
    });
}

}  // namespace hairloom::editor
