// SPDX-License-Identifier: GPL-3.0-or-later
// A slider that is dragged: one change of the last and of the first of five operators, on the samples and on
// combedHair(). What people wait for besides is the picture (bench live).

#include "benchmarks/combed_hair.h"
#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"

namespace hairloom::benchmarks {
namespace {

using editing::Document;

Status build(Document& document) {
    std::vector<Operator> operators;
    for (const char* name : {"set_length", "flow", "clump", "curl", "noise"})
        operators.push_back(newOperator(name));
    auto command = editing::setOperators(document.model(), std::move(operators), "Operators");
    if (!command) return tl::unexpected(command.error());
    document.perform(std::move(*command));
    return {};
}

/// Seeds, since every value of theirs costs the same.
Status drag(Rounds& rounds, Document& document, std::size_t index) {
    constexpr std::uint64_t kKey = 1;
    Operator changed = document.groom().operators[index];
    nlohmann::json settings = nlohmann::json::parse(changed.settings);
    std::uint64_t seed = 1;
    Status status;
    while (rounds.next() && status) {
        settings["seed"] = ++seed;
        changed.settings = settings.dump();
        document.performMerged(kKey, [&](const editing::Model& model) {
            auto made = editing::setOperator(model, index, changed, "Seed");
            if (made) return std::move(*made);
            status = tl::unexpected(made.error());
            return std::unique_ptr<editing::Command>();
        });
    }
    return status;
}

void measureHair(Timings& timings, const std::string& name, const Groom& groom) {
    Document document(groom);
    const Status built = build(document);
    timings.measure("five operators again, " + name, [&](Rounds& rounds) -> Status {
        if (!built) return built;
        while (rounds.next()) {
            StackCache empty;
            if (const auto shape = evaluateStack(document.groom(), empty); !shape)
                return tl::unexpected(shape.error());
        }
        return {};
    });
    timings.measure("change of the last of five, " + name,
                    [&](Rounds& rounds) { return drag(rounds, document, 4); });
    timings.measure("change of the first of five, " + name,
                    [&](Rounds& rounds) { return drag(rounds, document, 0); });
}

Result<Outcome> runStack(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    Timings timings(options);
    for (const Sample& sample : *hairstyles) measureHair(timings, sample.name, sample.groom);
    measureHair(timings, "100,000 strands of 16 points", combedHair());
    return timings.outcome("stack");
}

}  // namespace

Benchmark stackBenchmark() {
    return {"stack", "sliders of operators that are dragged", {"--quick"}, runStack};
}

}  // namespace hairloom::benchmarks
