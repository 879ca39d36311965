// SPDX-License-Identifier: MIT
// Which stages go into one pass.
#include "models/springs/spring_kernels.h"

namespace hairloom::runtime {
namespace {

/// Reads stages in their order.
class StageReader {
  public:
    explicit StageReader(std::span<const StageId> stages) : stages_(stages) {}

    bool atEnd() const { return next_ == stages_.size(); }
    std::size_t next() const { return next_; }
    StageId take() { return stages_[next_++]; }
    /// Whether this stage comes next; then it is taken.
    bool takeIf(StageId stage) {
        if (atEnd() || stages_[next_] != stage) return false;
        ++next_;
        return true;
    }

    /// The pass of Kernels::moves that comes next, or null and nothing is taken.
    Stage takeMove(const SpringKernels& kernels) {
        const std::size_t begin = next_;
        const std::size_t damped = takeIf(StageId::damping) ? 1 : 0;
        const Air air = takeIf(StageId::drag) ? Air::still : takeIf(StageId::wind) ? Air::moving : Air::none;
        const std::size_t heavy = takeIf(StageId::gravity) ? 1 : 0;
        if (takeIf(StageId::verlet)) return kernels.moves[damped][static_cast<std::size_t>(air)][heavy];
        next_ = begin;
        return nullptr;
    }

    /// The pass of Kernels::bendAndProject that comes next, or null and nothing is taken.
    Stage takeBendAndProject(const SpringKernels& kernels) {
        const std::size_t begin = next_;
        const bool curved = takeIf(StageId::angular);
        if ((curved || takeIf(StageId::angularStraight)) && takeIf(StageId::length))
            return kernels.bendAndProject[curved ? 1 : 0];
        next_ = begin;
        return nullptr;
    }

    /// The pass of Kernels::bothCollisions that comes next, or null and nothing is taken.
    Stage takeBothCollisions(const SpringKernels& kernels) {
        const std::size_t begin = next_;
        if (takeIf(StageId::continuousCollision)) {
            if (takeIf(StageId::collision)) return kernels.bothCollisions[0];
            if (takeIf(StageId::collisionBack)) return kernels.bothCollisions[1];
        }
        next_ = begin;
        return nullptr;
    }

  private:
    std::span<const StageId> stages_;
    std::size_t next_ = 0;
};

}  // namespace

Passes passesOf(std::span<const StageId> stages, const SpringKernels& kernels) {
    Passes passes;
    passes.afterStart = kernels.startHalfway;
    for (StageReader reader(stages); !reader.atEnd();) {
        Stage pass = reader.takeMove(kernels);
        if (pass) passes.startCalls = passes.count + 1;
        if (!pass) pass = reader.takeBendAndProject(kernels);
        if (!pass) pass = reader.takeBothCollisions(kernels);
        if (!pass) pass = kernels.stages[static_cast<std::size_t>(reader.take())];
        passes.calls[passes.count++] = pass;
    }
    return passes;
}

Passes singlePassesOf(std::span<const StageId> stages, const SpringKernels& kernels) {
    Passes passes;
    passes.afterStart = kernels.startHalfway;
    for (StageReader reader(stages); !reader.atEnd();) {
        const std::size_t first = reader.next();
        const bool move = reader.takeMove(kernels) != nullptr;
        if (!move) reader.take();
        for (std::size_t i = first; i < reader.next(); ++i) {
            const auto id = static_cast<std::size_t>(stages[i]);
            passes.calls[passes.count++] =
                move ? kernels.partsOfMove[i > first ? 1 : 0][id] : kernels.stages[id];
        }
        if (move) passes.startCalls = passes.count;
    }
    return passes;
}

}  // namespace hairloom::runtime
