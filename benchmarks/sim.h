// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `bench sim`: what the engine costs on this machine, beside what it should and what the thesis measured.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/measurement.h"
#include "core/cost/machine.h"
#include "core/cost/step_cost.h"

namespace hairloom::benchmarks {

/// A step of a sample hairstyle with its own settings, on a nodding head.
struct SampleStep {
    Measurement step;  ///< nanoseconds per particle and substep
    std::size_t threads = 1;
    double work = 0;  ///< particles times substeps of a frame
};

/// One head of hair, in nanoseconds per particle and substep.
struct StepCosts {
    StepScene scene;
    std::size_t threads = 1;
    Measurement step;  ///< whole, without clocks inside
    struct Stage {
        runtime::StageId id;
        Measurement cost;  ///< summed over threads
    };
    std::vector<Stage> stages;  ///< in the plan's order, each once
};

/// A scene on one thread with one of this machine's instruction sets, in nanoseconds per particle and
/// substep.
struct InstructionSetCosts {
    std::string set;
    scenes::ActiveForces activeForces;
    std::vector<Measurement> steps;  ///< by SimulationBench::strands
};

/// The rows of the thesis' Table 3 (Rünz 2012, Section 7.2) but for the whole frame, in its order; the names
/// are those of runtime::stageFamily, and "interpolation" is runtime/follow.h.
inline constexpr std::array<std::string_view, 8> kFamilies{
    "linear forces",   "angular forces", "external forces", "integration",
    "post-processing", "collision",      "animation",       "interpolation"};

/// A column of Table 3, in milliseconds per frame on one thread.
struct ThesisCosts {
    runtime::StrandModel model = runtime::StrandModel::springs;  ///< the thesis has springs alone
    std::uint32_t guides = 0;
    std::uint32_t neighbours = 0;  ///< hairs that follow a guide, besides one in its own place
    std::array<double, kFamilies.size()> printed{};
    std::array<Measurement, kFamilies.size()> measured;
    Measurement whole;  ///< step and interpolation, bookkeeping between the stages included
};

/// A measurement with what it should be, where that is laid down.
struct Wanted {
    Measurement cost;
    std::optional<double> limit;
    bool atMost = true;  ///< the limit, else at least it

    bool met() const { return !limit || (atMost ? cost.median() <= *limit : cost.median() >= *limit); }
};

struct SimulationBench {
    Machine machine;
    std::vector<std::uint32_t> strands;  ///< as asked for
    std::vector<SampleStep> samples;
    std::vector<StepCosts> steps;
    std::vector<ThesisCosts> thesis;
    std::vector<InstructionSetCosts> instructionSets;  ///< the best first
    std::vector<Wanted> others;
    std::vector<std::string> notes;  ///< what could not be measured, and why
};

/// Of the guides of Table 3: the thesis does not say; its Figure 5 has 10 segments.
inline constexpr std::uint32_t kThesisSegments = 30;

/// All columns with springs, then all with rods; `seconds` of one repetition, about.
std::vector<ThesisCosts> measureThesisCosts(int repetitions, double seconds);
/// The table as Markdown, the thesis' own numbers first; "" without columns.
std::string thesisTable(const std::vector<ThesisCosts>& columns);

/// The tables as Markdown; `command` is how they were made.
std::string markdownOf(const SimulationBench& bench, const std::string& command);

}  // namespace hairloom::benchmarks
