// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What other simulators cost and miss on one common scene, as `./dev peers` measured it: to stand beside
// settings of a groom, which are of another scene.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// A simulator with one setting. Errors are distances from its own converged run, not from another
/// simulator's.
struct PeerRun {
    std::string name, version;
    std::string setting;  ///< of a frame of 1/60 s
    std::uint32_t strands = 0;
    double milliseconds = 0;             ///< of all threads, a frame: median
    double lowestMs = 0, highestMs = 0;  ///< of the runs
    double errorMm = 0, errorMaxMm = 0;  ///< root mean square, largest
    double stretchPercent = 0;           ///< mean change of the strands' length
    double stretchMaxPercent = 0;
    double cantileverMm = 0;            ///< from the tip of the exact elastica, 0.1 m held level
    std::string reference;              ///< setting of its converged run
    double referenceUncertaintyMm = 0;  ///< of that run: errors as small say nothing
    std::string machine, date;          ///< date as YYYY-MM-DD
    double load = 0;                    ///< of the machine, processes that ran
};

/// What all of them ran, in a sentence.
std::string_view peerScene();

/// Of a CSV as benchmarks/peers writes it. Errors: another head line, a line with other cells or a number
/// that is none; `source` is named.
Result<std::vector<PeerRun>> parsePeers(std::string_view csv, const std::string& source);

/// The measurement that this program was built with: the newest benchmarks/results/peers-DATE.csv.
const std::vector<PeerRun>& recordedPeers();

}  // namespace hairloom
