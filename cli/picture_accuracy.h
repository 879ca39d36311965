// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `accuracy --picture`: what the settings of the picture cost, instead of those of the motion.

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "cli/job.h"

namespace hairloom::cli {

struct PictureAccuracyOptions {
    bool wanted = false;  ///< --picture
    std::string shading;  ///< empty: the project's
    std::string scatter;  ///< of other hairs' light; empty: the view's, else volume
    std::string size;     ///< WxH; empty: the view's, else 640x640
    std::uint32_t frames = 8;
    std::optional<std::size_t> hairs;     ///< 0: all; else as the device suits
    std::optional<std::uint32_t> device;  ///< by its index in `devices`; else the best
};
/// --picture, --shading, --scatter, --size, --passes, --hairs, --device.
void addPictureAccuracyOptions(CLI::App& job, PictureAccuracyOptions& options);

/// `view` is a view file or empty. Writes picture.csv, picture.svg and report.html into the folder.
Result<Report> pictureAccuracy(const PictureAccuracyOptions& options, const std::string& groomFile,
                               const std::string& view, std::uint32_t repeats, const std::string& folder,
                               const std::string& commandLine);

}  // namespace hairloom::cli
