// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a measured grid offers to someone who chooses: where the hair is now, what the next step buys, the
// cheapest that is exact enough, the most exact that is fast enough. Runs are named by their index; those
// that diverge or tremble are never offered.

#include <optional>
#include <string>

#include "core/accuracy/work_precision.h"

namespace hairloom {

/// The run with the settings and the points (of its longest strand) that the groom has; nothing where the
/// grid lacks them.
std::optional<std::size_t> runOf(const WorkPrecision& measured, const Groom& groom);
/// The cheapest that is more exact than `from`, of those that are as exact as possible for their time.
std::optional<std::size_t> nextStep(const WorkPrecision& measured, std::size_t from);
/// The cheapest whose root mean square error is at most so many millimetres.
std::optional<std::size_t> cheapestWithinError(const WorkPrecision& measured, double rmsMm);
/// The most exact whose median time is at most so many milliseconds.
std::optional<std::size_t> mostExactWithinTime(const WorkPrecision& measured, double milliseconds);
/// Of those that take as long as that run, within a fifth, the one whose error differs most from its error.
std::optional<std::size_t> pairOfEqualTime(const WorkPrecision& measured, std::size_t run);
/// Of those that are as exact, within a fifth, the one whose time differs most from its time.
std::optional<std::size_t> pairOfEqualError(const WorkPrecision& measured, std::size_t run);
/// Runs that differ from that one in that axis alone, itself among them, in the order of the axis.
std::vector<std::size_t> runsAlong(const WorkPrecision& measured, std::size_t run, std::size_t axis);
/// "4 substeps, 24 points".
std::string describeRun(const WorkPrecision& measured, std::size_t run);

}  // namespace hairloom
