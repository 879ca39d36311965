// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/accuracy/ground_truth.h"
#include "core/base/parallel.h"
#include "core/groom/spheres.h"
#include "core/simulation/reference/converge.h"
#include "core/simulation/scene_input.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kStepsPerFrame = 4;
constexpr std::uint32_t kFirstSubsteps = 2;
constexpr std::uint32_t kEngineSubsteps = 16;  // of the converged engine that the notes compare with

/// The poses of a run as all strands see them.
struct SceneFrames {
    std::vector<std::vector<runtime::RootFrame>> roots;  // by pose
    std::vector<std::vector<runtime::Sphere>> spheres;   // by pose
    float dt;
};

SceneFrames framesOf(const SceneInput& scene, const HeadMotion& motion, const SceneTime& time) {
    SceneFrames frames;
    frames.dt = 1.0f / (time.framesPerSecond * static_cast<float>(time.stepsPerFrame));
    for (const HeadPose& pose : posesOf(motion, time)) {
        frames.roots.push_back(scene.rootsAt(pose));
        frames.spheres.push_back(scene.spheresAt(pose));
    }
    return frames;
}

/// A strand alone, with its frames.
struct StrandScene {
    reference::Strands strand;
    reference::Root start;
    std::vector<reference::Frame> frames;
    bool meetsSpheres = false;
};

Vec3d toDouble(runtime::Float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Whether a sphere comes within `reach` of the root between any two poses; both move evenly between them.
bool comesNear(const SceneFrames& frames, std::uint32_t strand, std::size_t sphere, double reach) {
    for (std::size_t f = 0; f + 1 < frames.roots.size(); ++f) {
        const auto apart = [&](std::size_t at) -> Vec3d {
            return toDouble(frames.spheres[at][sphere].center_ws) -
                   toDouble(frames.roots[at][strand].position);
        };
        const Vec3d from = apart(f), to = apart(f + 1);
        if (std::min(from.norm(), to.norm()) - 0.5 * (to - from).norm() <= reach) return true;
    }
    return false;
}

/// Spheres beyond the strand's reach are left out: without impulses steps are of a higher order.
StrandScene strandScene(const Groom& groom, const SceneFrames& frames, std::uint32_t strand) {
    StrandScene scene;
    double length = 0;
    for (std::uint32_t p = groom.offsets[strand]; p < groom.offsets[strand + 1]; ++p) {
        scene.strand.restPositions_ss.push_back(groom.positions()[p].cast<double>());
        const std::size_t count = scene.strand.restPositions_ss.size();
        if (count > 1) {
            length +=
                (scene.strand.restPositions_ss[count - 1] - scene.strand.restPositions_ss[count - 2]).norm();
        }
    }
    scene.strand.offsets = {0, static_cast<std::uint32_t>(scene.strand.restPositions_ss.size())};
    const runtime::SimulationSettings& settings = groom.simulation;
    const double collisionRadius =
        static_cast<double>(std::max(settings.collisionRadiusRoot, settings.collisionRadiusTip));
    // Both ends of a capsule are near where one is, or what lies between.
    const std::vector<runtime::Capsule> capsules = capsulesOf(groom.spheres);
    std::vector<double> between(groom.spheres.size(), 0);
    for (const auto& [first, second] : capsules) {
        for (const auto& at : frames.spheres) {
            const double apart = (toDouble(at[first].center_ws) - toDouble(at[second].center_ws)).norm() +
                                 static_cast<double>(std::max(at[first].radius, at[second].radius));
            between[first] = std::max(between[first], apart);
            between[second] = std::max(between[second], apart);
        }
    }
    std::vector<std::size_t> near;
    std::vector<std::size_t> numbers(groom.spheres.size(), groom.spheres.size());
    for (std::size_t i = 0; i < groom.spheres.size(); ++i) {
        const double reach =
            length + collisionRadius + static_cast<double>(groom.spheres[i].radius) + between[i];
        if (!comesNear(frames, strand, i, reach)) continue;
        numbers[i] = near.size();
        near.push_back(i);
    }
    std::vector<runtime::Capsule> nearCapsules;
    for (const auto& [first, second] : capsules) {
        if (std::max(numbers[first], numbers[second]) < near.size())
            nearCapsules.push_back(
                {static_cast<std::uint32_t>(numbers[first]), static_cast<std::uint32_t>(numbers[second])});
    }
    scene.meetsSpheres = !near.empty();
    double time = 0;
    for (std::size_t f = 0; f < frames.roots.size(); ++f) {
        runtime::FrameInput input;
        input.dt = frames.dt;
        input.time = time;
        input.roots_ws = {&frames.roots[f][strand], 1};
        std::vector<runtime::Sphere> spheres;
        for (const std::size_t i : near) spheres.push_back(frames.spheres[f][i]);
        input.spheres = spheres;
        input.capsules = nearCapsules;
        if (f == 0) {
            scene.start = reference::frameOf(input).roots_ws.front();
        } else {
            scene.frames.push_back(reference::frameOf(input));
        }
        time += static_cast<double>(frames.dt);
    }
    return scene;
}

/// One strand's outcome.
struct StrandGroundTruth {
    Result<reference::Convergence> motion = fail("not run");
};

StrandGroundTruth converge(const Groom& groom, const SceneFrames& frames, std::uint32_t strand,
                           const reference::Goal& goal) {
    const StrandScene scene = strandScene(groom, frames, strand);
    StrandGroundTruth groundTruth;
    groundTruth.motion =
        reference::converged(scene.strand, groom.simulation, {&scene.start, 1}, scene.frames, goal);
    return groundTruth;
}

/// The followed points at the ends of whole frames. `runs` are of the followed strands, in their order.
Trajectory trajectoryOf(const SceneHair& hair, const SceneTime& time, const Followed& followed,
                        const std::vector<const std::vector<std::vector<Vec3d>>*>& runs) {
    const MaterialPoints points(hair, followed);
    Trajectory result;
    result.frames = time.frames;
    result.pointsPerFrame = points.count();
    std::vector<Vec3f> positions(hair.groom.pointCount(), Vec3f::Zero());
    for (std::uint32_t frame = 1; frame <= time.frames; ++frame) {
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const std::vector<Vec3d>& strand = (*runs[i])[std::size_t{frame} * kStepsPerFrame - 1];
            for (std::size_t p = 0; p < strand.size(); ++p)
                positions[hair.groom.offsets[followed.strands[i]] + p] = strand[p].cast<float>();
        }
        result.finite = points.read(positions, result.points_ws) && result.finite;
    }
    return result;
}

std::string detailOf(const std::vector<StrandGroundTruth>& strands, double toleranceMm) {
    std::size_t reached = 0;
    std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max(), maximum = 0;
    double worst = 0;
    for (const StrandGroundTruth& strand : strands) {
        const reference::Convergence& motion = *strand.motion;
        reached += motion.reached;
        fewest = std::min(fewest, motion.substeps);
        maximum = std::max(maximum, motion.substeps);
        worst = std::max(worst, motion.change);
    }
    std::string detail = fmt::format(
        "{} of {} strands converged to within {} mm, with {} to {} substeps in each quarter of a frame",
        reached, strands.size(), toleranceMm, fewest, maximum);
    if (reached < strands.size())
        detail +=
            fmt::format(". The last doubling moved a point of the others by up to {:.3g} mm", 1e3 * worst);
    return detail;
}

/// What the scene asks for and the reference leaves out.
std::vector<std::string> notesOf(const runtime::SimulationSettings& settings) {
    std::vector<std::string> notes;
    if (settings.sleepSpeed > 0) {
        notes.push_back(
            fmt::format("The reference does not sleep. Where the engine puts hair slower than {} m/s to "
                        "sleep, the remaining motion counts as error.",
                        settings.sleepSpeed));
    }
    const bool springs = settings.strandModel == runtime::StrandModel::springs;
    const bool coils = settings.lengthMethod != runtime::LengthMethod::constraint;
    if (springs && coils && settings.lengthIterations > 0) {
        notes.push_back(
            fmt::format("The reference does not limit the stretch of coil springs, while the engine limits "
                        "it to {} of their length. Errors include that difference.",
                        settings.maximalExtension));
    }
    const bool gusts = settings.windKind != runtime::WindKind::uniform && settings.windGustiness > 0;
    if (springs && gusts && settings.windSpeed > 0 && settings.airDrag > 0) {
        notes.push_back(
            fmt::format("The engine samples gusts at the root and the tip of a strand once per frame and "
                        "interpolates. The reference samples them at each point. Where strands are not much "
                        "shorter than gusts ({} m), errors include that difference.",
                        settings.windGustSize));
    }
    return notes;
}

}  // namespace

std::string ReferenceConverged::description() const {
    return fmt::format(
        "the model in double precision (core/simulation/reference), with {} to {} substeps in each of {} "
        "parts "
        "of a frame, doubled until no point moves by more than {} mm",
        2 * kFirstSubsteps, options_.maxSubsteps, kStepsPerFrame, options_.toleranceMm);
}

Result<GroundTruth> ReferenceConverged::compute(const SceneHair& hair, const HeadMotion& motion,
                                                const SceneTime& time, const Followed& followed) const {
    assert(options_.maxSubsteps >= 2 * kFirstSubsteps);
    const auto scene = SceneInput::make(hair.groom);
    if (!scene) return tl::unexpected(scene.error());
    SceneTime fine = time;
    fine.stepsPerFrame = kStepsPerFrame;
    fine.posesWithin = 0;
    const SceneFrames frames = framesOf(*scene, motion, fine);
    const reference::Goal goal{1e-3 * options_.toleranceMm, kFirstSubsteps, options_.maxSubsteps, 4,
                               options_.cancelled};
    std::vector<StrandGroundTruth> strands(followed.strands.size());
    parallelFor(strands.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            strands[i] = converge(hair.groom, frames, followed.strands[i], goal);
    });

    std::vector<const std::vector<std::vector<Vec3d>>*> last, before;
    std::vector<StrandGroundTruth> solved;
    GroundTruth groundTruth;
    groundTruth.followed.shares = followed.shares;
    for (std::size_t i = 0; i < strands.size(); ++i) {
        if (!strands[i].motion) return tl::unexpected(strands[i].motion.error());
        if (!std::isfinite(strands[i].motion->change) || strands[i].motion->report.failed > 0) continue;
        groundTruth.followed.strands.push_back(followed.strands[i]);
        solved.push_back(std::move(strands[i]));
    }
    if (solved.empty())
        return fail("the reference could not solve any strand", "expected a motion and a groom without NaN");
    for (const StrandGroundTruth& strand : solved) {
        last.push_back(&strand.motion->positions_ws);
        before.push_back(&strand.motion->coarser_ws);
    }
    groundTruth.trajectory = trajectoryOf(hair, time, groundTruth.followed, last);
    groundTruth.uncertaintyMm =
        compare(trajectoryOf(hair, time, groundTruth.followed, before), groundTruth.trajectory).rmsMm;
    groundTruth.detail = detailOf(solved, options_.toleranceMm);
    groundTruth.notes = notesOf(hair.groom.simulation);
    if (solved.size() < strands.size()) {
        groundTruth.notes.push_back(fmt::format(
            "The reference could not solve every step of {} of {} strands, which are not part of the errors. "
            "Hair that is pressed end-on or between two spheres has no well-defined motion there.",
            strands.size() - solved.size(), strands.size()));
    }

    // The others would take most of the time, and strands know nothing of each other here.
    const SceneHair solvedHair = strandsOf(hair, groundTruth.followed.strands);
    Followed all{std::vector<std::uint32_t>(solved.size()), followed.shares};
    std::iota(all.strands.begin(), all.strands.end(), 0u);
    const auto engine = EngineConverged(kEngineSubsteps).compute(solvedHair, motion, time, all);
    if (!engine) return tl::unexpected(engine.error());
    groundTruth.notes.push_back(
        fmt::format("With its own steps refined until that changed {:.2g} mm, the engine is {:.3g} mm (root "
                    "mean square) from the reference. The rest is the difference in model and precision, and "
                    "more substeps do not reduce it.",
                    engine->uncertaintyMm, compare(engine->trajectory, groundTruth.trajectory).rmsMm));
    return groundTruth;
}

}  // namespace hairloom
