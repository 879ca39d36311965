// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the settings of a picture cost, and how far each is from the best picture of the same hair, light and
// view.

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/cost/statistics.h"
#include "core/gpu/device.h"
#include "core/groom/groom.h"
#include "core/live/groom_scene.h"
#include "core/render/options.h"

namespace hairloom {

struct PictureCostOptions {
    /// Camera, lights, head, shading model and scattering; without a camera it is the three-quarter view,
    /// without lights those of the studio.
    ViewFile view;
    /// Size and the settings as they are. `samples` 0 is resolved by the device.
    render::RenderOptions picture;
    /// Hairs to draw at most, follow hairs counted, of strands drawn from the groom's; 0: all. Software
    /// devices take minutes for a whole head.
    std::size_t mostHairs = 0;
    std::uint32_t repeats = 3;       ///< timed frames of each setting, ≥ 1
    std::uint32_t exactFrames = 64;  ///< averaged in the picture that counts as right, 1…1024
    std::function<void(std::size_t done, std::size_t total)> progress;
    std::function<bool()> cancelled;  ///< asked between pictures; true ends them with an error
};

/// A picture with one setting changed.
struct PictureCostRun {
    std::string setting;     ///< by its name in the editor: "samples", "shadowResolution", …
    std::string value;       ///< "4", "deepOpacity"
    bool now = false;        ///< nothing is changed: the value that the picture has
    Quartiles milliseconds;  ///< device time of one frame in which hair moves, shadows included
    double flip = 0;         ///< mean difference from the right picture, 0…1
    double light = 1;        ///< of the pixels that show hair, times that of the right picture
};

struct PictureCost {
    std::string device;
    std::uint32_t width = 0, height = 0;
    std::uint32_t frames = 0;  ///< averaged in the pictures that are compared
    std::size_t hairs = 0;     ///< drawn
    std::size_t allHairs = 0;  ///< that the groom has; times grow about with them
    /// Setting by setting, values ascending in what they cost as a rule; each has one with `now`.
    std::vector<PictureCostRun> runs;
    std::vector<std::string> notes;  ///< whole sentences: what the device cannot
};

/// What `mostHairs` should be there, so that measuring takes a minute or two.
std::size_t mostHairsOn(const gpu::Device& device);

/// Samples, filter, how thin hair and curves are drawn, subdivisions, shadows and their resolution, scattered
/// light, follow hairs. The right picture has the most of each, and as many hairs as there are now. Errors:
/// no strands, being cancelled, what the device reports.
Result<PictureCost> measurePictureCost(gpu::Device& device, const Groom& groom,
                                       const PictureCostOptions& options);

}  // namespace hairloom
