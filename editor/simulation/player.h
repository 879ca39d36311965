// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The simulation of the document, live, on a thread of its own: the engine that games run. Plays at most in
// real time; where a frame takes longer, the hair moves in slow motion and the frame time says so.

#include <QObject>
#include <QStringList>
#include <QTimer>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "core/animation/actor.h"
#include "core/live/engine_choice.h"
#include "core/simulation/simulation.h"
#include "core/simulation/time_line_motion.h"
#include "editor/document/qt_document.h"
#include "editor/simulation/frame_cache.h"
#include "editor/simulation/played_method.h"
#include "editor/simulation/take_recorder.h"
#include "editor/viewport/picture_request.h"
#include "editor/viewport/render_jobs.h"

namespace hairloom::editor {

/// A frame that was simulated.
struct PlayedFrame {
    std::shared_ptr<const HairPose> pose;
    std::shared_ptr<const HairPose> before;  ///< the frame before, with as many positions; or null
    double time = 0;                         ///< seconds since the start
    double milliseconds = 0;                 ///< of the step, where it runs
    SimulationStats stats;
};

class Player : public QObject {
    Q_OBJECT

  public:
    explicit Player(QtDocument& document, QObject* parent = nullptr);
    ~Player() override;

    void play();
    void pause();
    /// One frame: of 1/60 s, or of the time line.
    void step();
    /// Hair at rest, time zero, paused.
    void reset();
    bool isPlaying() const { return playing_; }
    /// Anything but at rest at time zero.
    bool hasFrame() const { return frame_ != nullptr; }
    /// The last frame; null at rest.
    const std::shared_ptr<const PlayedFrame>& frame() const { return frame_; }

    /// Hair at rest on the head as it is `seconds` behind the start of the motion, paused there.
    void seek(double seconds);
    /// Seconds behind the start of the motion.
    double time() const { return frame_ ? frame_->time : from_; }

    /// Frames of the motion.
    FramePace pace() const;

    // The play head: any time of the time line is shown at once. What was simulated stays, and play() goes on
    // from it.

    /// What the view shows.
    enum class Shown {
        rest,       ///< hair at rest on the head at rest
        simulated,  ///< the last frame
        played,     ///< one that has played before
        posed,      ///< hair at rest on the head of that time
    };
    /// Pauses. Shows the frame that was simulated or has played there, else hair at rest on the head of that
    /// time.
    void scrub(float lineTime);
    /// By frames of the time line, from where the play head is.
    void scrubFrames(std::int64_t frames);
    /// The play head by one frame where it is moved away from the last frame, else step().
    void stepForward();
    bool isScrubbed() const { return scrubbed_.has_value(); }
    /// Seconds on the time line of what is shown.
    float lineTime() const;
    std::int64_t lineFrame() const;
    Shown shown() const;
    /// For the view; null: at rest.
    const std::shared_ptr<const HairPose>& pose() const;
    /// Frames that scrub() shows as they played.
    const FrameCache& frameCache() const { return *cache_; }

    /// Of setMotion(): what the document's time line says.
    static constexpr QLatin1String kTimeLine{"timeline"};
    /// none, spin, nod, clip:NAME or kTimeLine. Starts anew. An error leaves the motion as it was.
    Status setMotion(const QString& name);
    const QString& motion() const { return motion_; }
    /// One that setMotion() takes, for this document. Errors: no such motion.
    Result<std::unique_ptr<HeadMotion>> makeMotion(const QString& name) const;
    /// For measuring and films: the motion that plays, or a nod where the head is at rest.
    QString measuredMotion() const { return motion_ == "none" ? QStringLiteral("nod") : motion_; }
    /// Errors: no such motion.
    Result<std::unique_ptr<HeadMotion>> makeMeasuredMotion() const;
    /// Names that setMotion() takes for this document.
    QStringList motions() const;
    /// The character with skeleton and clips; null where the head came without.
    void setActor(std::shared_ptr<const Actor> actor);
    const std::shared_ptr<const Actor>& actor() const { return actor_; }

    /// Effects by name that are left out for a try, from the next frame on; the document is not touched.
    /// Those that cannot be turned off are ignored.
    void setLeftOut(const QStringList& effects);
    const QStringList& leftOut() const { return leftOut_; }
    /// What runs and what it costs: of the last frame, else what would run, without times. Empty without
    /// hair.
    std::vector<EffectReport> effects() const;
    /// Where the hair is drawn, for simulating it there; null: the CPU simulates. Before anything plays.
    void setRenderJobs(std::shared_ptr<RenderJobs> jobs);
    /// What moves the hair: from the next frame on, which goes on from where hair is.
    void setEngine(EngineWish wish);
    /// How the hair moves, from the next frame on; a method that knows no state of another begins at rest.
    void setMethod(const PlayedMethod& method);
    const PlayedMethod& method() const { return method_; }
    /// What moves it now or did last, and why; nothing before anything has played.
    const std::optional<EngineChoice>& engine() const { return engine_; }

    /// What would run is looked for, strand by strand, only while somebody watches.
    void setPlanPreviewActive(bool watched);

    /// Gets each frame that is played from now on, whose hair must be on the CPU (setEngine()); null: nobody.
    void setRecorder(std::shared_ptr<TakeRecorder> recorder);

    /// Moves the head on top of its motion: by the hand of a person.
    void setHeadOffset(const Eigen::Isometry3f& offset);
    const Eigen::Isometry3f& headOffset() const { return offset_; }

  Q_SIGNALS:
    void frameReady();
    /// Playing, paused or reset.
    void stateChanged();
    void motionsChanged();
    /// By scrub(), or because it is where the last frame is again.
    void playHeadMoved();
    void headOffsetChanged();
    /// effects() has changed while nothing played.
    void planPreviewChanged();
    void engineChanged();
    void failed(const QString& problem);

  private:
    /// That of the time line anew, with the groom's poses as they are now; null where another motion plays.
    std::shared_ptr<HeadMotion> motionOfPoses();
    struct WorkerRequests;
    struct Playing;
    void run();
    /// The engine goes on, or begins; false: nothing can.
    bool prepare(Playing& playing, WorkerRequests& taken);
    void advance(Playing& playing, WorkerRequests& taken);
    /// Lets hair that begins come to rest on the first pose, as long as the pre-roll says.
    void settle(Playing& playing, const HeadPose& first);
    /// All steps of the next frame. Errors: as Transport::step().
    Status stepFrame(Playing& playing, WorkerRequests& taken, HairPose& pose, Status& refused);
    void setEngineShown(const EngineChoice& choice);
    void refuse(const Error& error);
    /// Gives the thread the groom as it is now. Not before it is needed: strokes pay for copies that are
    /// held.
    /// Errors, which are told: its motion cannot play.
    bool capture();
    void deliver(std::shared_ptr<const PlayedFrame> frame, quint64 epoch);
    void documentChanged(editing::Part parts);
    /// That motion from its start, and goes on playing; the play head is at that time of the line, if any.
    void begin(const QString& motion, std::optional<float> playHead);
    /// Where somebody has moved it.
    std::optional<float> playHead() const {
        return scrubbed_ ? std::optional(scrubbed_->time) : std::nullopt;
    }
    /// The time line is another: its motion goes on from where it is.
    void takeTimeLine();
    void setPace(WorkerRequests& requests) const;
    /// That of a document which has just come: its time line's, else none.
    void chooseMotion();
    void requestPlanPreview();
    void outdatePlanPreview();
    /// Makes the simulation to see its plan; on the thread.
    void computePlanPreview(const Groom& groom, const QStringList& leftOut);
    void request(const std::function<void(WorkerRequests&)>& change);
    std::shared_ptr<const HairPose> posedAt(float lineTime);
    void endScrub();
    float lineTimeOf(double seconds) const;
    /// The last frame was simulated for that time.
    bool isAtLastFrame(float lineTime) const;
    /// What has played is of another groom or motion.
    void clearCache();

    QtDocument& document_;
    std::shared_ptr<const Actor> actor_;
    QString motion_ = "none";
    QString beforeLine_ = "none";  ///< what played before the time line, which may be undone
    bool playing_ = false;
    double from_ = 0;                            ///< seconds of the motion, where the next start begins
    bool hasTimeLine_ = false;                   ///< the document's is not empty
    std::shared_ptr<const TimeLine> takenLine_;  ///< that the last change of it has left
    bool captured_ = false;                      ///< the thread has the groom as it is now
    std::shared_ptr<const PlayedFrame> frame_;
    struct Scrubbed {
        float time;
        Shown shown;
        std::shared_ptr<const HairPose> pose;
    };
    std::optional<Scrubbed> scrubbed_;
    std::shared_ptr<FrameCache> cache_;
    Eigen::Isometry3f offset_ = Eigen::Isometry3f::Identity();  ///< by the hand of a person
    std::optional<EngineChoice> engine_;
    PlayedMethod method_;
    std::vector<std::uint32_t> capturedOffsets_;  ///< of the strands that the thread has
    quint64 epoch_ = 0;                           ///< frames of earlier ones are dropped

    QStringList leftOut_;
    std::vector<EffectReport> planPreview_;
    QTimer planPreviewTimer_;
    bool planPreviewActive_ = false;
    bool planPreviewOutdated_ = false;

    std::unique_ptr<WorkerRequests> requests_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::thread thread_;
};

}  // namespace hairloom::editor
