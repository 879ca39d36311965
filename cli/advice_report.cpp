// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/advice_report.h"

#include "cli/documents.h"
#include "core/base/log.h"
#include "core/simulation/scene_input.h"
#include "hairloom/stable.h"

namespace hairloom::cli {

Report adviceReport(const Groom& groom, float frameTime) {
    const runtime::StableAdvice advice =
        runtime::adviseStability(strandsAtRest(groom), groom.simulation, frameTime);
    if (advice.words.empty()) return {};
    Report offers = Report::array();
    std::string remedies;
    for (const runtime::StableOffer& offer : advice.offers) {
        offers.push_back(offer.words);
        remedies += (remedies.empty() ? ". To fix it: " : ", or ") + offer.words;
    }
    log::warning("{}{}", advice.words, remedies);
    Report report;
    report["words"] = advice.words;
    report["factor"] = finiteOrNull(advice.region.factor);
    report["trembling_strands"] = advice.rest.moving;
    report["tried_strands"] = advice.rest.strands;
    report["offers"] = std::move(offers);
    return report;
}

}  // namespace hairloom::cli
