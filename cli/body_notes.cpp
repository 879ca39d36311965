// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/body_notes.h"

#include "core/base/log.h"
#include "core/simulation/scene_input.h"

namespace hairloom::cli {

std::vector<std::string> bodyNotes(const Groom& groom, const HeadPose& start, bool strandEngine) {
    std::vector<std::string> notes;
    if (!groom.body) return notes;
    if (!strandEngine || groom.simulation.strandModel != runtime::StrandModel::rods)
        notes.emplace_back(
            "strands pass through the skin collider, which only rods of the strand engine meet. Use --model "
            "rods, "
            "or fit spheres (spheres --fit)");
    if (bodyAt(groom, start).empty())
        notes.emplace_back(
            "hair passes through the skin collider, because nothing says how this motion moves it. Fit it to "
            "the "
            "character that moves (colliders --fit field --character)");
    return notes;
}

std::vector<std::string> recordNotes(const Groom& groom, const HeadPose& pose) {
    if (!groom.body || !bodyAt(groom, pose).empty()) return {};
    return {
        "the record does not say where the skin collider is: hairs between guides are not led out of the "
        "skin. "
        "Record the groom again"};
}

void reportNotes(const std::vector<std::string>& notes, Report& report) {
    if (notes.empty()) return;
    for (const std::string& note : notes) log::warning("{}", note);
    report["notes"] = notes;
}

}  // namespace hairloom::cli
