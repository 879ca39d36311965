// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a picture's settings cost, as a table, a chart and a page.

#include <filesystem>
#include <string>
#include <vector>

#include "core/charts/plot.h"
#include "core/live/picture_cost.h"

namespace hairloom {

/// One line per run after a head line, RFC 4180: setting, value, now (0 or 1), ms_median, ms_q1, ms_q3, flip,
/// light.
std::string pictureCostCsv(const PictureCost& cost);

/// Difference against time, both logarithmic: a line for each setting through its values, which meet at the
/// picture as it is.
Plot pictureCostPlot(const PictureCost& cost, const std::string& groom);

/// Writes picture.csv, picture.svg and report.html into the folder, which is made where it is missing.
/// Returns the names of the files in it.
Result<std::vector<std::string>> writePictureCost(const PictureCost& cost, const std::string& groom,
                                                  const std::string& commandLine,
                                                  const std::filesystem::path& folder);

}  // namespace hairloom
