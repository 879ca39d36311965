// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/sim.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/sample_hair.h"
#include "core/base/parallel.h"
#include "core/cost/instruction_set_limit.h"

namespace hairloom::benchmarks {
namespace {

using scenes::ActiveForces;

constexpr std::uint32_t kPoints = 16;
constexpr std::uint32_t kMoreStrands = 10'000;
constexpr std::uint32_t kGuides = 300;
constexpr std::uint32_t kFollowNeighbours = 60;
constexpr const char* kPerParticle = "ns/particle/substep";

class Bench {
  public:
    explicit Bench(const Options& options) : options_(options) {
        bench_.strands = {300, 2'000, 10'000, 100'000};
        if (options.quick) {
            bench_.strands = {300, 2'000};
            seconds_ = 0.02;
        }
        if (!options.strands.empty()) bench_.strands = options.strands;
    }

    Result<SimulationBench> run() {
        bench_.machine = thisMachine();
        std::vector<std::size_t> threads{1};
        if (threadCount() > 1) threads.push_back(threadCount());
        total_ = 3 * bench_.strands.size() * threads.size() + threads.size() + 4;
        for (const std::size_t count : threads) {
            if (auto status = measureSamples(count); !status) return tl::unexpected(status.error());
            stepForward();
        }
        for (const std::uint32_t strands : bench_.strands) {
            for (const ActiveForces activeForces :
                 {ActiveForces::gravity, ActiveForces::noTorsion, ActiveForces::windAndSpheres}) {
                for (const std::size_t count : threads) {
                    bench_.steps.push_back(stepCosts({strands, kPoints, activeForces}, count));
                    stepForward();
                }
            }
        }
        bench_.thesis = measureThesisCosts(options_.repetitions.value_or(5), seconds_);
        stepForward();
        measureInstructionSets();
        stepForward();
        measureOverheads();
        stepForward();
        measureFrames();
        stepForward();
        return std::move(bench_);
    }

  private:
    void stepForward() {
        if (options_.progress) options_.progress("measuring", ++done_, total_);
    }

    /// As many values of measure() as there are repetitions.
    template <class Measure>
    Measurement repeated(std::string name, std::string unit, const Measure& measure) const {
        Measurement result{std::move(name), std::move(unit), {}};
        for (int r = 0; r < options_.repetitions.value_or(5); ++r) result.values.push_back(measure());
        return result;
    }

    static std::string describe(const StepScene& scene, std::size_t threads) {
        return fmt::format("{}x{}, {}, {}", scene.strands, scene.points, nameOf(scene.activeForces),
                           describe(threads));
    }

    static std::string describe(std::size_t threads) {
        return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
    }

    Status measureSamples(std::size_t threads) {
        const auto& hair = samples();
        if (!hair) return tl::unexpected(hair.error());
        for (const Sample& sample : *hair) {
            auto strands = nodding(sample.groom);
            if (!strands) return tl::unexpected(strands.error());
            StepRun run(std::move(*strands), sample.groom.simulation, threads > 1);
            bench_.samples.push_back(
                {stepOf(run, fmt::format("step, {}, {}", sample.name, describe(threads))), threads,
                 run.work()});
        }
        return {};
    }

    Measurement stepOf(StepRun& run, std::string name) const {
        const std::uint32_t frames = run.framesFor(seconds_);
        return repeated(std::move(name), kPerParticle,
                        [&] { return run.milliseconds(frames) * 1e6 / run.work(); });
    }

    Measurement wholeStep(const StepScene& scene, std::string name) const {
        StepRun run(scene);
        return stepOf(run, std::move(name));
    }

    StepCosts stepCosts(StepScene scene, std::size_t threads) const {
        StepCosts costs;
        scene.allThreads = threads > 1;
        costs.threads = threads;
        costs.step = wholeStep(scene, "step, " + describe(scene, threads));
        scene.byStage = true;
        costs.scene = scene;
        StepRun run(scene);
        const std::uint32_t frames = run.framesFor(seconds_);
        for (int r = 0; r < options_.repetitions.value_or(5); ++r) {
            run.milliseconds(frames);
            addStages(run, costs);
        }
        return costs;
    }

    /// A stage that joined in a later repetition, as a sweep may, has fewer values.
    static void addStages(const StepRun& run, StepCosts& costs) {
        for (std::size_t i = 0; i < runtime::kStageCount; ++i) {
            const auto id = static_cast<runtime::StageId>(i);
            const double milliseconds = run.stageMilliseconds()[i];
            if (!(milliseconds > 0.0)) continue;
            auto place = std::ranges::find(costs.stages, id, &StepCosts::Stage::id);
            if (place == costs.stages.end()) {
                const std::string name =
                    fmt::format("{}, {}, {}", runtime::stageFamily(id), runtime::stageName(id),
                                describe(costs.scene, costs.threads));
                place = costs.stages.insert(costs.stages.end(), {id, {name, kPerParticle, {}}});
            }
            place->cost.values.push_back(milliseconds * 1e6 / run.work());
        }
    }

    /// With the instruction set in use, of that name.
    InstructionSetCosts setCosts(const std::string& set, ActiveForces activeForces) const {
        InstructionSetCosts costs{set, activeForces, {}};
        for (const std::uint32_t strands : bench_.strands) {
            const StepScene scene{.strands = strands, .activeForces = activeForces};
            costs.steps.push_back(wholeStep(scene, fmt::format("step, {}, {}", describe(scene, 1), set)));
        }
        return costs;
    }

    void measureInstructionSets() {
        const std::vector<std::int64_t> targets = InstructionSetLimit::available();
        std::vector<std::string> seen;
        std::int64_t scalar = 0;
        for (const std::int64_t target : targets) {
            const InstructionSetLimit limit(target);
            const std::string name = runtime::Engine::instructionSet();
            // A set that this machine has and the engine was not built for runs as the next one.
            if (std::ranges::find(seen, name) != seen.end()) continue;
            seen.push_back(name);
            for (const ActiveForces activeForces : {ActiveForces::noTorsion, ActiveForces::windAndSpheres})
                bench_.instructionSets.push_back(setCosts(name, activeForces));
            if (name == "SCALAR" || name == "EMU128") scalar = target;
        }
        if (scalar != 0) {
            // Few strands: scalar frames that are longer than a time slice would measure other programs as
            // well.
            compareWithScalar({.strands = kGuides}, targets.front(), scalar);
        } else {
            bench_.notes.push_back("this build of the engine has no scalar code to compare with");
        }
    }

    /// In turns, so that what else the machine does falls on both.
    void compareWithScalar(const StepScene& scene, std::int64_t best, std::int64_t scalar) {
        StepRun run(scene);
        const std::uint32_t frames = run.framesFor(seconds_);
        const auto timeWith = [&](std::int64_t target) {
            const InstructionSetLimit limit(target);
            return run.milliseconds(frames);
        };
        const std::string name =
            fmt::format("scalar code against {}, {}", bench_.machine.instructionSet, describe(scene, 1));
        bench_.others.push_back({repeated(name, "times",
                                          [&] {
                                              const double slow = timeWith(scalar);
                                              return slow / timeWith(best);
                                          }),
                                 8.0, false});
    }

    void measureOverheads() {
        for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
            for (const std::uint32_t strands : {kGuides, kMoreStrands}) measureOverhead(strands, model);
        }
        bench_.others.push_back(
            {repeated("a profiler scope", "ns", [] { return profilerScopeNanoseconds(300); }), 100.0});
    }

    void measureOverhead(std::uint32_t strands, runtime::StrandModel model) {
        StepRun engine(
            {.strands = strands, .points = kPoints, .activeForces = ActiveForces::nothing, .model = model});
        BareSolve bare(strands, kPoints, model);
        const std::uint32_t frames = engine.framesFor(0.5 * seconds_);
        bare.milliseconds(frames);
        // In turns, so that what else the machine does falls on both.
        bench_.others.push_back(
            {repeated(fmt::format("{}, all effects off against the solve alone, {}x{}, 1 thread",
                                  runtime::modelOf(model).name, strands, kPoints),
                      "%",
                      [&] {
                          const double alone = bare.milliseconds(frames);
                          return 100.0 * (engine.milliseconds(frames) / alone - 1.0);
                      }),
             3.0});
    }

    void measureFrames() {
        const StepScene scene{.strands = kGuides};
        StepRun guides(scene);
        const std::uint32_t frames = guides.framesFor(seconds_);
        const std::string setup =
            fmt::format("{}x{} from {} guides", kGuides * (kFollowNeighbours + 1), kPoints, kGuides);
        const scenes::Lawn lawn(kGuides, kFollowNeighbours + 1, kPoints, 0.5f);
        auto made = runtime::FollowHairs::make(lawn.view());
        const auto follow = [&](bool all) { return followMilliseconds(*made.hairs, lawn, all, frames); };
        bench_.others.push_back({repeated(fmt::format("frame of 1/60 s, {}", describe(scene, 1)), "ms",
                                          [&] { return guides.milliseconds(frames); }),
                                 {}});
        bench_.others.push_back(
            {repeated(fmt::format("follow hairs, {}, 1 thread", setup), "ms", [&] { return follow(false); }),
             {}});
        if (threadCount() > 1) {
            bench_.others.push_back(
                {repeated(fmt::format("follow hairs, {}, {} threads", setup, threadCount()), "ms",
                          [&] { return follow(true); }),
                 {}});
        }
        bench_.others.push_back({repeated(fmt::format("both, {}, 1 thread", setup), "ms",
                                          [&] { return guides.milliseconds(frames) + follow(false); }),
                                 {}});
    }

    const Options& options_;
    double seconds_ = 0.1;  ///< of one repetition, about
    SimulationBench bench_;
    std::size_t done_ = 0, total_ = 0;
};

/// Straight hair in wind on one thread, the fewest strands: what runs are compared by after the samples.
bool isFirstToCompare(const SimulationBench& bench, const StepCosts& costs) {
    return costs.scene.strands == bench.strands.front() && costs.threads == 1 &&
           costs.scene.activeForces == ActiveForces::noTorsion;
}

Report reportOf(const SimulationBench& bench) {
    Report rows = Report::array();
    for (const SampleStep& sample : bench.samples) rows.push_back(rowOf(sample.step));
    for (const bool first : {true, false}) {
        for (const StepCosts& costs : bench.steps) {
            if (isFirstToCompare(bench, costs) != first) continue;
            rows.push_back(rowOf(costs.step));
            for (const StepCosts::Stage& stage : costs.stages) rows.push_back(rowOf(stage.cost));
        }
    }
    for (const ThesisCosts& column : bench.thesis) {
        for (std::size_t i = 0; i < kFamilies.size(); ++i) {
            if (column.measured[i].median() == 0) continue;  // rods solve all forces at once
            Report row = rowOf(column.measured[i]);
            if (column.model == runtime::StrandModel::springs) {
                row["thesis"] = column.printed[i];
                row["ratio"] = column.printed[i] / column.measured[i].median();
            }
            rows.push_back(std::move(row));
        }
        rows.push_back(rowOf(column.whole));
    }
    for (const InstructionSetCosts& set : bench.instructionSets) {
        for (const Measurement& step : set.steps) rows.push_back(rowOf(step));
    }
    for (const Wanted& other : bench.others) {
        Report row = rowOf(other.cost);
        if (other.limit) {
            row[other.atMost ? "at_most" : "at_least"] = *other.limit;
            row["met"] = other.met();
        }
        rows.push_back(std::move(row));
    }
    return Report{{"name", "sim"},
                  {"processor", bench.machine.processor},
                  {"instruction_set", bench.machine.instructionSet},
                  {"threads", bench.machine.threads},
                  {"notes", bench.notes},
                  {"rows", std::move(rows)}};
}

Result<Outcome> runSim(const Options& options) {
    const auto bench = Bench(options).run();
    if (!bench) return tl::unexpected(bench.error());
    return Outcome{reportOf(*bench), markdownOf(*bench, options.commandLine), {}};
}

}  // namespace

Benchmark simBenchmark() {
    return {"sim",
            "a step of the strand engine, compared with the thesis",
            {"--strands", "--quick", "--markdown"},
            runSim};
}

}  // namespace hairloom::benchmarks
