// SPDX-License-Identifier: MIT
#pragma once
// The seam between the engine and its models of strands. A model is a folder of models/ and a value of
// StrandModel: it gives its effects and the stages that follow, its arrays, its kernel of the CPU and the
// source of that of a GPU. What the engine has itself is alike for all: blocks, roots, spheres, wind, sleep,
// and State.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include "engine/kernels.h"
#include "engine/plan_builder.h"
#include "engine/poses.h"
#include "engine/state.h"
#include "hairloom/host.h"

namespace hairloom::runtime {

/// An effect of a model. While it is off nothing of it is left: no array (ModelStrands::effectBytes), no
/// stage, and in a kernel that has no stages no instruction that a block runs. The clock prices one that has
/// stages of its own, a run without it (core/cost/effect_cost.h) one that is part of a solve.
struct EffectRow {
    Effect effect;
    /// Whether it is on, and why. Rows before it are decided.
    Decision (*decide)(const PlanBuilder& plan);
};

/// Room for the BlockView of any model.
class BlockRoom {
  public:
    template <class Block>
    Block& make() {
        static_assert(sizeof(Block) <= sizeof(bytes_) && std::is_trivially_destructible_v<Block>);
        return *new (bytes_) Block();
    }

  private:
    alignas(64) std::byte bytes_[640];
};

/// What a model is told of a frame.
struct ModelFrame {
    SubstepContext context;  ///< of the first substep
    bool windy = false;
    std::array<float, kWindModes> windFrom{}, windTo{};  ///< phases at start and end of the frame
    float rescale = 1.0f;                                ///< new substep over old, 1 when equal
    bool starts = false;                                 ///< the first since the hair was put at rest
};

/// The strands of one engine as their model has them: what it derives from the rest shape, settings and plan.
/// What it remembers from step to step is in State::own.
class ModelStrands : public InMemory {
  public:
    virtual ~ModelStrands() = default;
    virtual std::unique_ptr<ModelStrands> copy() const = 0;

    /// Takes other settings, on the host's threads; `before` are those of the state, null where strands are
    /// new.
    virtual void takeSettings(const RestShape& shape, const SimulationSettings& settings,
                              const SimulationSettings* before, State& state, const Host& host) = 0;
    /// Makes any state one of this model and these settings: strands that were none of them go on from where
    /// their points are.
    virtual void takeState(const RestShape& shape, const SimulationSettings& settings, State& state) = 0;
    /// The same of a state in which nothing is placed yet.
    virtual void takeNewState(const RestShape& shape, const SimulationSettings& settings, State& state,
                              const Host&) {
        takeState(shape, settings, state);
    }
    /// Has memory for what the plan runs, and none for what it does not. `body`: there is one that the model
    /// meets.
    virtual void allocate(const RestShape& shape, const SimulationSettings& settings, const EffectPlan& plan,
                          bool body, State& state) = 0;
    /// Follows poses by their amounts, in place of those before; after takeSettings() and takeState(), on the
    /// host's threads. It has memory for them only while an amount is above 0, or where it is to be kept.
    virtual void takePoses(const RestShape&, const SimulationSettings&, const PoseChange&, State&,
                           const Host&) {}
    /// There is another body, or none: what the state knows of it is void.
    virtual void forgetBody(State&) const {}

    /// Puts lanes of block `index` at rest on their rows of state.roots, but for their points, which are
    /// there.
    virtual void placeAtRest(const RestShape& shape, State& state, std::size_t index,
                             LaneRange lanes) const = 0;
    /// Lets a lane go on from the state's points.
    virtual void placeOnPoints(const RestShape& shape, State& state, std::size_t index,
                               std::uint32_t lane) const = 0;

    /// The block with what is the model's.
    virtual BlockView& view(const RestShape& shape, State& state, std::size_t index,
                            std::uint32_t clampedPoints, BlockRoom& room) = 0;
    /// Of each block of a frame, asleep or not, on any thread.
    virtual void prepareBlock(const RestShape&, const SimulationSettings&, const ModelFrame&, std::size_t) {}
    /// Of each block that moves: before its first substep. LaneFrame has its roots.
    virtual void enterBlock(const RestShape&, const SimulationSettings&, const ModelFrame&, std::size_t,
                            BlockView&, LaneFrame&) const {}
    /// When all blocks are through.
    virtual void closeFrame(const ModelFrame&) {}

    /// What view().position and previous do not hold of point `i` turns along with its root.
    virtual void turnAlong(const BlockView&, std::size_t, Quat) const {}
    /// The same for a change of velocity, in m/s; `previous` has it.
    virtual void addVelocity(const BlockView&, std::size_t, std::uint32_t, Float3) const {}

    /// Memory of this model that exists because of the effect; 0 while it is off.
    virtual std::size_t effectBytes(Effect effect, const State& state) const = 0;
    /// Its other memory.
    virtual std::size_t baseBytes(const State& state) const = 0;
    /// What of that is there because of a body.
    virtual std::size_t bodyBytes(const State&) const { return 0; }
};

/// What an array of State::own takes while something needs it.
struct OwnArray {
    std::size_t planes = 0;    ///< floats of each point and lane
    std::size_t laneRows = 0;  ///< floats of each lane of a block
    bool isOptional = false;   ///< may be empty: what it is for is off

    std::size_t floats(std::size_t planeFloats, std::size_t blocks) const {
        return planes * planeFloats + laneRows * blocks * kBlockLanes;
    }
};

struct Model {
    const char* name;  ///< as in StrandModel
    std::span<const EffectRow> effects;
    /// After all effects are decided; none while all strands sleep.
    void (*listStages)(PlanBuilder& plan);
    /// hairReach().
    float (*reach)(const SimulationSettings& settings, float strandLength);
    /// Fills what it reads of a substep; the rest is filled.
    void (*fillNumbers)(const SimulationSettings& settings, const EffectPlan& plan, SubstepContext& context);
    /// `timed`: a call for each stage.
    Passes (*passes)(std::span<const StageId> stages, bool timed);
    /// Floats of LaneFrame::solver that the stages need for a point.
    std::size_t (*solverFloats)(std::span<const StageId> stages);
    std::unique_ptr<ModelStrands> (*make)();
    std::array<OwnArray, kOwnArrays> own;
    std::size_t laneFloats;  ///< of LaneFrame::own
    bool listsSpheres;       ///< fills LaneFrame::touchable, and meets capsules as they are
    bool meetsBody;          ///< SubstepContext::body
    bool keepsVelocities;    ///< in State::own; else what a point went in the last substep is its velocity
    std::size_t mostPlanes;  ///< floats of each point and lane that it can take, with those of `own`
    std::size_t (*mostSolverFloats)();
    /// Likewise while strands follow so many poses; null where they follow none.
    std::size_t (*posePlanes)(std::size_t poses) = nullptr;
    const char* gpuSource;  ///< of runtime/shaders: what becomes its kernel of a GPU
};
const Model& modelOf(StrandModel model);
/// In the order of StrandModel.
std::span<const Model* const> allModels();

/// ModelStrands that are copied with who owns them.
class OwnedStrands {
  public:
    OwnedStrands() = default;
    explicit OwnedStrands(std::unique_ptr<ModelStrands> strands) : strands_(std::move(strands)) {}
    OwnedStrands(const OwnedStrands& other) : strands_(other.strands_ ? other.strands_->copy() : nullptr) {}
    OwnedStrands(OwnedStrands&&) noexcept = default;
    OwnedStrands& operator=(OwnedStrands other) noexcept {
        strands_ = std::move(other.strands_);
        return *this;
    }
    ~OwnedStrands() = default;
    ModelStrands* operator->() const { return strands_.get(); }

  private:
    std::unique_ptr<ModelStrands> strands_;
};

/// Sets LaneFrame::touchable and touchableCapsules to what of the frame can touch the block's strands in it.
void listTouchable(const RestShape& shape, const SimulationSettings& settings, const SubstepContext& context,
                   std::size_t block, LaneFrame& lanes);

/// `floats` of them, which are 0 where they are new; as they are where there are so many. What becomes empty
/// keeps its memory, which the engine gives back unless it was told to keep it.
inline void keepFloats(Floats& values, std::size_t floats, const Host& host = {}) {
    if (values.size() == floats) return;
    if (floats <= values.capacity())
        values.assign(floats, 0.0f);
    else
        values = zeroFloats(floats, host);
}

}  // namespace hairloom::runtime
