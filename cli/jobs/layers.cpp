// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/strand_subset.h"
#include "core/operations/stack.h"

namespace hairloom::cli {
namespace {

/// The operators that act on a layer, by their place in the stack.
Report operatorsOf(const Groom& groom, std::uint32_t number) {
    Report operators = Report::array();
    for (std::size_t i = 0; i < groom.operators.size(); ++i) {
        const std::uint32_t of = layerOf(groom.operators[i]);
        if (of == 0 || of == number) operators.push_back(i);
    }
    return operators;
}

Result<Report> layers(const std::string& input) {
    const auto groom = openGroom(input);
    if (!groom) return tl::unexpected(groom.error());
    Report report{{"layers", Report::array()}};
    for (std::uint32_t layer = 0; layer < groom->layers.size(); ++layer) {
        std::size_t points = 0;
        const std::vector<std::uint32_t> strands = strandsOfLayer(*groom, layer);
        for (const std::uint32_t s : strands) points += groom->offsets[s + 1] - groom->offsets[s];
        report["layers"].push_back(Report{{"number", layer + 1},
                                          {"name", groom->layers[layer].name},
                                          {"visible", groom->layers[layer].visible},
                                          {"locked", groom->layers[layer].locked},
                                          {"density", readableDecimal(groom->layers[layer].density)},
                                          {"own_material", groom->layers[layer].material.has_value()},
                                          {"strands", strands.size()},
                                          {"points", points},
                                          {"operators", operatorsOf(*groom, layer + 1)}});
    }
    return report;
}

JobRun declare(CLI::App& job) {
    const auto input = std::make_shared<std::string>();
    job.add_option("groom", *input, "Groom")->required();
    return [input](const std::string&) { return layers(*input); };
}

}  // namespace

Job layersJob() {
    return {"layers", "List the layers of a groom and their contents", "hair.hairloom --json", declare};
}

}  // namespace hairloom::cli
