// SPDX-License-Identifier: MIT
#pragma once
// One character's hair as an asset has it: what hl_instance is.

#include <array>
#include <charconv>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hairloom/asset.h"
#include "hairloom/engine.h"
#include "hairloom/hairloom.h"
#include "hairloom/memory.h"
#include "play/clip_player.h"
#include "play/gpu_guides.h"
#include "play/levels.h"
#include "play/root_poses.h"

namespace hairloom::runtime {

/// What a call of the C interface refuses.
struct Refusal {
    hl_code code;
    std::string words;
    std::uint64_t byte = HL_NO_PLACE;  ///< of the asset
};
using Outcome = std::optional<Refusal>;

/// Bytes that an instance holds at most, by the counts of a sound asset: with one thread, what follow hairs
/// add, and what each further thread adds.
struct InstanceMemory {
    std::size_t guides, hairs, levels, thread;
};
InstanceMemory instanceMemory(const Asset& asset);
/// Of an instance beside its engine and its FollowHairs.
std::size_t ownBytes(std::size_t strands, std::size_t points, std::size_t velocities);
/// Of poses that an engine may follow, while it follows none.
std::size_t bytesOfPoses(const Engine& engine);
/// How many strands have how many points.
Map<std::uint32_t, std::size_t> strandsByPoints(const Asset& asset);
/// Whether some layers have materials of their own.
bool hasMaterials(const Asset& asset);

/// Of hl_frame.spheres.
inline constexpr std::size_t kMaxGivenSpheres = 4096;

/// Of the settings that a layer's own material has.
inline String layerGroup(std::size_t layer) {
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.begin(), digits.end(), layer + 1).ptr;
    return String("layer").append(digits.begin(), end);
}

class Instance {
  public:
    struct Result;
    /// Of an asset whose content is sound.
    static Result make(const Asset& asset, bool wantsHairs, bool wantsLevels, Host host);

    Outcome reset(const hl_frame& frame);
    Outcome step(const hl_frame& frame);
    /// The asset's clip at a time, on the frame's roots (instance_play.cpp).
    Outcome play(const Asset& asset, const hl_frame& frame, const hl_play& how);
    static std::uint64_t numberOf(const Asset& asset);
    /// Bytes that play() adds.
    static std::size_t clipMemory(const Asset& asset);
    Outcome set(std::string_view name, std::span<const double> values);
    Outcome choose(std::string_view name, std::string_view choice);
    /// Poses of the asset (instance_poses.cpp).
    Outcome checkPose(std::uint32_t pose) const;
    Outcome setPose(std::uint32_t pose, float amount);
    float poseAmount(std::uint32_t pose) const { return hairPoses_.amounts[pose]; }
    Outcome read(hl_read& read, bool wantsBounds = true);
    /// What the kernels of hairs are given each frame (gpu.cpp): number HL_GPU_BUFFER_… into `bytes`.
    bool hasGpuHairs() const { return gpuHairs_ > 0; }
    /// Of the hairs in a GPU's order: all, unless a level leaves some out.
    std::uint32_t gpuHairsShown() const {
        return levels_ && !hairGroups_.empty() ? levels_->taken.back() : gpuHairs_;
    }
    std::uint32_t gpuHairs() const { return gpuHairs_; }
    std::uint32_t gpuPointsOfHair() const { return gpuPoints_; }
    std::size_t gpuBytes(std::uint32_t buffer) const;
    void fillGpu(std::uint32_t buffer, void* data);
    Outcome checkGpuGuides(std::uint32_t buffer) const;
    Outcome beginGpu();
    void leaveGpu() { gpuGuides_.reset(); }
    /// Of what was copied: what belongs to one instance alone.
    void beCopy() {
        leaveGpu();
        hairPoses_.isReserved = false;
    }
    Outcome stepGpu(const hl_frame& frame);
    Outcome readHairNumbers(std::span<std::uint32_t> numbers) const;
    Outcome readOffsets(std::span<std::uint32_t> offsets) const;
    hl_instance_info describe() const;
    std::uint64_t hash() const;
    /// What steps change, as bytes, and back (saved.cpp).
    Vector<std::byte> save() const;
    Outcome load(std::span<const std::byte> bytes);
    /// All memory that frames may come to ask for (reserve.cpp).
    Outcome reserve(const hl_reserve& wanted);
    void setClock(const std::function<std::uint64_t()>& nanoseconds);
    hl_effect describeEffect(std::uint32_t effect) const;

    // Of an instance with levels of detail.
    bool hasLevels() const { return levels_.has_value(); }
    std::uint32_t level() const { return levels_ ? levels_->level : 0; }
    Outcome setLevel(std::uint32_t level, float hairShare);
    hl_level describeLevel(std::uint32_t level) const;
    /// Metres, of a frame as the last ones were: of the paths of points, or of what is seen far off.
    float predictedError(std::uint32_t level, bool ofPaths) const;
    /// Of the next step and read-out; 0 where it sleeps and stays at its level.
    float predictedMilliseconds(std::uint32_t level, float hairShare) const;
    float rootRadius() const { return radii_.root; }
    /// Of this machine, where 1 is that of predictions (measured.cpp).
    Outcome measureSpeed(const std::function<std::uint64_t()>& nanoseconds, float& speed) const;

  private:
    /// How thick a strand is: by its points, or from root to tip.
    struct Radii {
        float root, tip;
        Vector<float> own;                     // of each point, or none
        Vector<std::array<float, 2>> ofHairs;  // root and tip of each guide's, or none: as above
    };
    Instance(Engine engine, RootPoses poses, Host host)
        : engine_(std::move(engine)), poses_(std::move(poses)), host_(std::move(host)) {}

    /// Levels of detail (instance_levels.cpp).
    struct Levels {
        // Not in the class: clang does not find it there until the whole of Instance is read.
        Levels();
        std::shared_ptr<const LevelSet> set;
        Vector<Engine> engines;  ///< of levels 1 …, before the rigid one
        std::uint32_t level = 0;
        float share = 0;              ///< of the hairs that are read
        Vector<std::uint32_t> taken;  ///< of the hairs that are read, as FollowHairs::evaluateSome()
        /// Where roots were last, all finite, and what they were measured from; none before the first step.
        Vector<RootFrame> placed;
        std::optional<std::array<double, 3>> origin;
        Float3 velocity{};           ///< m/s, mean of the roots
        float motion = 0, wind = 0;  ///< m/s, greatest of the last frames; fades
        /// In the frames of the roots: from where guides are at this level to where the last one had them.
        Vector<Float3> fade;
        bool fading = false;
        Vector<RootFrame> simulatedRoots;  // of the level's guides
        Vector<Float3> simulated, moved;   // of their points
    };
    void makeLevels(const Asset& asset, const Asset::Strands& strands);
    void measureLevels(LevelSet& set);
    void resetLevel();
    void setSettingsOfLevels(const SimulationSettings& settings, std::span<Engine> engines) const;
    void stepLevel(FrameInput& input);
    void fadeLevel(float dt);
    void placeCoarser(Engine& engine, std::span<const Float3> positions_ws,
                      const std::optional<std::array<double, 3>>& origin_ws);
    void placeRootsOfLevels();
    void holdMotion(const FrameInput& input);
    void takeRootsOfLevel(const Engine& engine, FrameInput& input);
    Engine* engineOfLevel() { return engineAt(level()); }
    /// Null of the rigid level.
    Engine* engineAt(std::uint32_t level);
    const Engine* engineOfLevel() const { return const_cast<Instance*>(this)->engineOfLevel(); }
    std::size_t bytesOfLevels() const;
    std::uint32_t hairsRead() const;
    void takeHairs(float share);
    /// Fill positions_ and velocities_.
    void showPositions();
    void showVelocities();

    /// What all values of a read go through (read.cpp).
    struct Reading;
    Outcome checkRead(const hl_read& read, std::size_t points) const;
    std::uint64_t stateOf(bool hairs) const { return 2 * changes_ + (hairs ? 1 : 0); }
    void readGuidesInto(Reading& reading);
    void readHairsInto(Reading& reading);
    std::size_t hairPoints() const;

    /// What roots did since the last frame, for the speeds of points that are played.
    struct HeadBefore {
        Quat turn;
        bool known = false;
    };
    HeadBefore headBefore(const hl_frame& frame);
    void playOnto(const HeadBefore& before, const hl_frame& frame, float rate, float share,
                  std::span<const std::uint32_t> strands);
    void placePlayed();
    /// Puts the finest level's engine where a clip has the points, before anything else needs it.
    void settlePlayed();
    /// Positions may change in their last bits, which the engine keeps from roots.
    void settlePlayed() const { const_cast<Instance*>(this)->settlePlayed(); }
    void grow(const hl_reserve& wanted);
    std::string makePoses(const Asset& asset, const Asset::Strands& strands);
    static void giveAmounts(std::span<const float> amounts, Engine& finest, std::span<Engine> coarser);
    void takeAmounts(std::span<const float> amounts);
    bool isPosed() const;
    Standing standing();
    static Outcome checkStep(const hl_frame& frame);
    Outcome place(const hl_frame& frame, FrameInput& input);
    Outcome checkInner(const hl_frame& frame) const;
    Outcome placeInner(const hl_frame& frame, FrameInput& input);
    /// Of a frame that is asBefore().
    bool innerAsBefore(const hl_frame& frame) const;
    Outcome placeRoots(const hl_frame& frame);
    void placeBody(const hl_frame& frame, FrameInput& input);
    Outcome placeSpheres(const hl_frame& frame, FrameInput& input);
    Outcome placeCapsules(const hl_frame& frame, FrameInput& input);
    void takeTurns();
    void takeOrigin(const hl_frame& frame);
    bool asBefore(const hl_frame& frame) const;
    void remember(const hl_frame& frame);

    Engine engine_;
    std::optional<FollowHairs> hairs_;
    Vector<std::uint32_t> hairGroups_;  // hairs before each guide's, then all
    std::optional<Levels> levels_;
    RootPoses poses_;
    struct HairPoses {
        Vector<float> amounts;          // of each of the asset's poses
        Vector<Float3> all, simulated;  // of instances with levels: as standing() gives them
        bool isStanding = false;        // ... and it is that of the amounts
        bool isReserved = false;        // memory for them stays
    } hairPoses_;
    Host host_;
    Radii radii_{};
    Vector<std::uint32_t> offsets_;
    Vector<asset::Sphere> restSpheres_;
    Vector<Capsule> restCapsules_, capsules_;
    Vector<Sphere> spheres_;
    std::shared_ptr<const BodyField> body_;  ///< null: none
    Vector<std::uint8_t> skinSpheres_;       // which of restSpheres_ stand for it
    Vector<std::size_t> bodyBones_;          // of a frame's bones
    Vector<BonePose> bodyPose_;
    Vector<RootFrame> roots_;
    Vector<Quat> turns_;
    /// Of the frame under way, pose after pose.
    struct Inner {
        Vector<InnerPose> poses;
        Vector<RootFrame> roots, simulatedRoots;  // of all guides, of those of the level
        Vector<Sphere> spheres;
        Vector<BonePose> body;
        std::size_t bytes() const {
            return poses.capacity() * sizeof(InnerPose) +
                   (roots.capacity() + simulatedRoots.capacity()) * sizeof(RootFrame) +
                   spheres.capacity() * sizeof(Sphere) + body.capacity() * sizeof(BonePose);
        }
    } inner_;
    bool saidInnerOnGpu_ = false;
    /// What the last step was given, where all of it is a head or bones; hair that sleeps needs no other.
    struct LastFrame {
        bool known = false, hasWind = false;
        float dt = 0;
        std::array<double, 3> origin{};
        Matrix34 head{};
        std::array<float, 3> wind{};
        Vector<float> bones;
    } last_;
    bool asleep_ = false;
    Vector<Float3> positions_, velocities_;
    std::array<double, 3> origin_{};  // of the last frame
    // Of a clip, once one was played:
    std::optional<ClipPlayer> clip_;
    Vector<std::uint32_t> allStrands_;
    Vector<Float3> rootsBefore_;
    /// positions_ and velocities_ are a clip's, and engine_ is not there yet: what only plays never pays for
    /// a simulation that could follow.
    bool playedWaits_ = false;
    bool played_ = false;     // by a clip, and not stepped since
    bool rootsKnown_ = true;  // roots_ are those of the state
    Float3 pivot_{};          // that heads nod about where something is measured
    WispMotion gpuWisps_;
    std::uint32_t gpuHairs_ = 0, gpuPoints_ = 0;  // of the asset, read or not, and of each
    std::size_t gpuBlocks_ = 0, gpuLongest_ = 0;  // of guides in slots: blocks, and points of the longest
    std::optional<GpuGuides> gpuGuides_;          // from hl_gpu_begin() until the CPU moves the hair
    std::uint64_t asset_ = 0;                     // tells assets apart
    std::uint64_t changes_ = 1;                   // grows with all that changes what is read
    /// What the last reads have shown, of guides and of hairs.
    struct Shown {
        std::uint64_t boundsOf = 0;  // state that the bounds are of
        Float3 low{}, high{};
        // Of those that asked for where points were before:
        Vector<Float3> positions;
        std::array<double, 3> origin{};
        std::uint64_t state = 0;  // of `positions`; 0: they are of no use
        bool still = false;       // the last one found them where they were
    };
    std::array<Shown, 2> shown_;
};

struct Instance::Result {
    std::optional<Instance> instance;
    std::string error;
};

}  // namespace hairloom::runtime

struct hl_instance : hairloom::runtime::InMemory {
    explicit hl_instance(hairloom::runtime::Instance made) : instance(std::move(made)) {}
    hairloom::runtime::Instance instance;
};
