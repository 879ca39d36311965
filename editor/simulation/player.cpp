// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/player.h"

#include <algorithm>
#include <utility>

#include "core/documents/motions.h"
#include "core/editing/document.h"
#include "core/gpu_simulation/kernel_key.h"
#include "core/simulation/clip_motion.h"
#include "core/simulation/time_line_motion.h"
#include "editor/document/words.h"
#include "editor/simulation/player_requests.h"

namespace hairloom::editor {
namespace {

constexpr int kPlanPreviewMs = 300;
constexpr QLatin1String kClip("clip:");

bool isMadeWithSettings(const PlayedMethod& method) {
    return method.method != SimulationMethod::strands;
}

Result<std::unique_ptr<HeadMotion>> motionOf(const QString& name, const std::shared_ptr<const Actor>& actor,
                                             const Groom& groom) {
    if (name == Player::kTimeLine) return makeTimeLineMotion(timeLineOf(groom), actor, groom);
    if (!name.startsWith(kClip)) return makeRigidMotion(name.toStdString(), groom);
    if (!actor) return fail("this head has no animation clips");
    return makeClipMotion(actor, name.mid(kClip.size()).toStdString(), groom);
}

}  // namespace

Player::Player(QtDocument& document, QObject* parent)
    : QObject(parent), document_(document), requests_(std::make_unique<WorkerRequests>()) {
    clearCache();
    connect(&document_, &QtDocument::changed, this, &Player::documentChanged);
    connect(&document_, &QtDocument::replaced, this, [this] {
        actor_.reset();
        chooseMotion();
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

void Player::chooseMotion() {
    hasTimeLine_ = !timeLineOf(document_.groom()).isEmpty();
    motion_ = hasTimeLine_ ? QString(kTimeLine) : QString("none");
    beforeLine_ = "none";
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
        Q_EMIT failed("There are no strands to simulate yet");
        return;
    }
    const TimeLine& line = timeLineOf(document_.groom());
    // From the end it plays again.
    if (motion_ == kTimeLine && !line.loop && frame_ && time() >= static_cast<double>(line.end - line.start))
        reset();
    if (!capture()) return;
    endScrub();
    playing_ = true;
    request([](WorkerRequests& requests) { requests.playing = true; });
    Q_EMIT stateChanged();
}

bool Player::capture() {
    if (captured_) return true;
    auto made = makeMotion(motion_);
    if (!made) {
        Q_EMIT failed(errorText(made.error()));
        return false;
    }
    captured_ = true;
    auto groom = std::make_shared<const Groom>(document_.groom());
    capturedOffsets_.assign(groom->offsets.view().begin(), groom->offsets.view().end());
    request([&, motion = std::shared_ptr<HeadMotion>(std::move(*made))](WorkerRequests& requests) {
        requests.groom = std::move(groom);
        requests.motion = motion;
        requests.from = from_;
        setPace(requests);
    });
    return true;
}

FramePace Player::pace() const {
    return motion_ == kTimeLine ? paceOf(timeLineOf(document_.groom())) : FramePace();
}

void Player::setPace(WorkerRequests& requests) const {
    requests.pace = pace();
    requests.stopAt = std::numeric_limits<double>::infinity();
    requests.line.reset();
    if (motion_ != kTimeLine) return;
    requests.line = document_.groom().timeLine;
    const TimeLine& line = timeLineOf(document_.groom());
    if (!line.loop) requests.stopAt = static_cast<double>(line.end - line.start);
}

void Player::takeTimeLine() {
    const bool had = std::exchange(hasTimeLine_, !timeLineOf(document_.groom()).isEmpty());
    // What is keyed first plays at once, or says why it cannot; another motion that somebody chose stays.
    if (!had && hasTimeLine_ && motion_ != kTimeLine) {
        if (auto made = makeMotion(kTimeLine); !made) Q_EMIT failed(errorText(made.error()));
        // Whoever keys the first of all is at the frame that it is for.
        const bool isShown = !playing_ && (frame_ || scrubbed_);
        return begin(kTimeLine, isShown ? std::optional(lineTime()) : std::nullopt);
    }
    if (had && !hasTimeLine_ && motion_ == kTimeLine)
        return begin(motions().contains(beforeLine_) ? beforeLine_ : QString("none"), playHead());
    if (motion_ != kTimeLine || !captured_) return;
    auto made = makeMotion(motion_);
    if (!made) {
        Q_EMIT failed(errorText(made.error()));
        return;
    }
    request([&](WorkerRequests& requests) {
        requests.motion = std::move(*made);
        setPace(requests);
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
    if (!capture()) return;
    endScrub();
    request([](WorkerRequests& requests) { ++requests.steps; });
}

void Player::reset() {
    playing_ = false;
    from_ = 0;
    frame_.reset();
    scrubbed_.reset();
    offset_.setIdentity();
    ++epoch_;
    captured_ = false;
    request([&](WorkerRequests& requests) {
        requests.playing = false;
        requests.steps = 0;
        requests.restart = true;
        requests.regroomed = requests.restyled = false;
        requests.groom.reset();
        requests.motion.reset();
        requests.offset.setIdentity();
        requests.changed = false;
        requests.epoch = epoch_;
        requests.delivered.reset();
    });
    clearCache();
    Q_EMIT frameReady();
    Q_EMIT playHeadMoved();
    Q_EMIT headOffsetChanged();
    Q_EMIT stateChanged();
    if (planPreviewOutdated_) outdatePlanPreview();
}

void Player::seek(double seconds) {
    reset();
    if (!(seconds > 0)) return;
    from_ = seconds;
    step();
}

Result<std::unique_ptr<HeadMotion>> Player::makeMotion(const QString& name) const {
    return motionOf(name, actor_, document_.groom());
}

Result<std::unique_ptr<HeadMotion>> Player::makeMeasuredMotion() const {
    return makeMotion(measuredMotion());
}

Status Player::setMotion(const QString& name) {
    const auto made = makeMotion(name);
    if (!made) return tl::unexpected(made.error());
    begin(name, playHead());
    return {};
}

void Player::begin(const QString& motion, std::optional<float> playHead) {
    const bool play = playing_;
    if (motion == kTimeLine && motion_ != kTimeLine) beforeLine_ = motion_;
    motion_ = motion;
    reset();
    if (play) this->play();
    if (playHead) scrub(*playHead);
    Q_EMIT motionsChanged();
}

QStringList Player::motions() const {
    QStringList names{"none", "nod", "spin"};
    if (actor_) {
        for (const Clip& clip : actor_->clips()) names.append(kClip + QString::fromStdString(clip.name));
    }
    if (hasTimeLine_) names.append(kTimeLine);
    return names;
}

void Player::setActor(std::shared_ptr<const Actor> actor) {
    actor_ = std::move(actor);
    Q_EMIT motionsChanged();
}

void Player::setLeftOut(const QStringList& effects) {
    const bool sameBody = leavesBodyOut(leftOut_) == leavesBodyOut(effects);
    leftOut_ = effects;
    request([&](WorkerRequests& requests) {
        requests.leftOut = effects;
        requests.regroomed = requests.regroomed || !sameBody || isMadeWithSettings(method_);
        requests.changed = true;
    });
    clearCache();
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

void Player::setRenderJobs(std::shared_ptr<RenderJobs> jobs) {
    request([&](WorkerRequests& requests) { requests.jobs = std::move(jobs); });
}

void Player::setEngine(EngineWish wish) {
    request([&](WorkerRequests& requests) {
        if (wish == requests.wish || !requests.jobs) return;
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
    clearCache();
    outdatePlanPreview();
    Q_EMIT planPreviewChanged();
}

std::shared_ptr<HeadMotion> Player::motionOfPoses() {
    if (motion_ != kTimeLine) return nullptr;
    auto made = makeMotion(motion_);
    return made ? std::shared_ptr<HeadMotion>(std::move(*made)) : nullptr;
}

void Player::setRecorder(std::shared_ptr<TakeRecorder> recorder) {
    request([&](WorkerRequests& requests) { requests.recorder = std::move(recorder); });
}

void Player::documentChanged(editing::Part parts) {
    const Groom& groom = document_.groom();
    if (contains(parts, editing::Part::Head)) {
        // Another head, or by undo the one before, has its own skeleton and clips.
        chooseMotion();
        std::shared_ptr<const Actor> actor;
        if (!groom.characterFile.empty()) {
            if (auto loaded = loadActor({}, groom)) actor = std::move(*loaded);
        }
        setActor(std::move(actor));
    }
    if (contains(parts, editing::Part::Physics | editing::kHairParts | editing::Part::Spheres))
        outdatePlanPreview();
    if (contains(parts, editing::kHairParts | editing::kScalpParts)) {
        if (!captured_) {
            clearCache();
            return endScrub();
        }
        endScrub();
        takenLine_.reset();
        const bool sameStrands = std::ranges::equal(groom.offsets.view(), capturedOffsets_);
        if (playing_ && sameStrands && !contains(parts, editing::kScalpParts)) {
            std::shared_ptr<HeadMotion> motion = motionOfPoses();
            request([&](WorkerRequests& requests) {
                requests.groom = std::make_shared<const Groom>(groom);
                if (motion) requests.motion = motion;
                // The method may turn where hair goes; any other change makes it anew.
                const bool pointsAlone =
                    !contains(editing::without(parts, editing::Part::Points), editing::kHairParts);
                (pointsAlone ? requests.restyled : requests.regroomed) = true;
            });
            clearCache();
            return;
        }
        const bool play = playing_ && groom.strandCount() > 0;
        reset();
        if (play) this->play();
        return;
    }
    if (contains(parts, editing::Part::TimeLine | editing::Part::Physics | editing::Part::Spheres)) {
        const bool moves = contains(parts, editing::Part::Physics | editing::Part::Spheres) ||
                           motion_ != kTimeLine || !takenLine_ || !groom.timeLine ||
                           !movesAlike(*takenLine_, *groom.timeLine);
        if (moves) {
            clearCache();
            if (contains(parts, editing::Part::TimeLine)) takeTimeLine();
        } else {
            request([&](WorkerRequests& requests) { setPace(requests); });
        }
        takenLine_ = groom.timeLine;
        if (scrubbed_) scrub(scrubbed_->time);
    }
    // Follow hairs matter where they move with the strands, which is on the device.
    const bool followsOther =
        contains(parts, editing::Part::Interpolation) && engine_ && engine_->kind == EngineKind::gpu;
    const bool isMasked =
        contains(parts, editing::Part::Masks) &&
        std::ranges::any_of(groom.poses, [](const GroomPose& pose) { return pose.mask > 0; });
    const bool changed = isMasked || contains(parts, editing::Part::Physics | editing::Part::Spheres);
    if (!captured_ || (!followsOther && !changed)) return;
    std::shared_ptr<HeadMotion> motion = motionOfPoses();
    if (contains(parts, editing::Part::Spheres)) {
        // Clips carry spheres along by their bones.
        if (auto made = makeMotion(motion_)) motion = std::move(*made);
    }
    request([&](WorkerRequests& requests) {
        // Engines are made with the body.
        const bool sameBody = !requests.groom || requests.groom->body == groom.body;
        // Some effects run on the CPU alone.
        const auto runsOnGpu = [](const Groom& which) {
            return gpu_simulation::kernelError(which.simulation).empty();
        };
        const bool sameEngines = !requests.groom || runsOnGpu(*requests.groom) == runsOnGpu(groom);
        // So are they with poses, whose amounts alone they take while they run.
        const bool samePoses = !requests.groom || std::ranges::equal(requests.groom->poses, groom.poses,
                                                                     [](GroomPose before, GroomPose now) {
                                                                         before.amount = now.amount;
                                                                         return before == now;
                                                                     });
        if (!sameBody || !sameEngines || !samePoses || followsOther || isMadeWithSettings(method_))
            requests.regroomed = true;
        requests.regroomed = requests.regroomed || isMasked;
        requests.changed = requests.changed || changed;
        requests.groom = std::make_shared<const Groom>(groom);
        if (motion) requests.motion = motion;
    });
}

}  // namespace hairloom::editor
