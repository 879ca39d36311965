// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/head_options.h"

#include <fmt/format.h>

#include "cli/documents.h"

namespace hairloom::cli {

void addHeadOptions(CLI::App& job, HeadOptions& options, const std::string& prefix) {
    const std::string dashes = "--" + prefix;
    addUnitOption(job, options.unit, dashes + "unit", "the head mesh");
    job.add_option(dashes + "up", options.up,
                   "Up axis of the mesh file. Detected from the shape if the file has none")
        ->check(CLI::IsMember({"y", "z"}));
    job.add_option_function<float>(
           "--turn",
           [&options](float degrees) {
               options.turn = degrees;
               options.saysTurn = true;
           },
           "Degrees to turn the head around the vertical, from +Z towards +X, so that it faces +Z")
        ->check(CLI::Range(-360.0, 360.0));
    job.add_option("--leave-out", options.leaveOut,
                   "Groups of the mesh to leave out, such as helpers and joints: NAME or PREFIX*, separated "
                   "by commas")
        ->delimiter(',');
}

HeadImportOptions headImportOptions(const HeadOptions& options) {
    HeadImportOptions wanted;
    if (!options.unit.empty()) wanted.metresPerUnit = metresPerUnit(options.unit);
    wanted.zUp = options.up == "z";
    wanted.turnDegrees = options.turn;
    wanted.leaveOut = options.leaveOut;
    wanted.guessUnit = options.unit.empty();
    wanted.guessUp = options.up.empty();
    wanted.guessTurn = !options.saysTurn;
    return wanted;
}

Report headReport(const HeadImportOptions& taken, const std::vector<std::string>& words) {
    return Report{
        {"up", taken.zUp ? "z" : "y"},
        {"turn", taken.turnDegrees},
        {"metres_per_unit", taken.metresPerUnit > 0 ? Report(taken.metresPerUnit) : Report(nullptr)},
        {"left_out", taken.leaveOut},
        {"warnings", words}};
}

}  // namespace hairloom::cli
