// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What `render` is asked for: its options, and what they mean for images and their sequence.

#include <CLI/App.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/job.h"
#include "core/base/result.h"
#include "core/colour/colour_choice.h"
#include "core/groom/shadow_settings.h"
#include "core/live/view_file.h"
#include "core/render/options.h"

namespace hairloom::cli {

struct RenderJobOptions {
    std::string input;
    std::string size;
    std::string show;        ///< a chart in place of hair; empty: none
    double inclination = 0;  ///< degrees, of the chart's light
    std::string camera = "three-quarter";
    std::string view;
    std::string material;
    std::string look;  ///< empty: the view's, or the project's
    std::string shading;
    std::string scatter = "volume";
    // Empty: the view's, or the project's.
    std::string shadow;
    std::uint32_t shadowLights = render::RenderOptions().shadowLights;
    std::string antiAliasing = "auto";
    std::string ribbons = "auto";
    std::string transparency = "auto";
    float detail = 0;
    std::optional<std::uint32_t> shadowResolution;
    std::string shadowFilter;
    std::optional<std::uint32_t> shadowLayers, shadowSlices, shadowNodes;
    std::string layerEnds;
    std::optional<float> layerGrowth;
    std::optional<std::uint32_t> subdivisions;
    std::optional<float> headAbsorption;
    std::optional<float> shadowBlur;
    std::string record;
    std::string motion;
    std::string character;
    std::string wind;
    std::string engine;
    std::vector<std::string> hiddenGroups;
    std::uint64_t frame = 0;
    std::vector<std::uint64_t> frames;  ///< first, last, step
    std::uint64_t handles = 0;
    std::optional<std::uint64_t> start;  ///< number of the image of the first frame without handles
    std::uint32_t turntable = 0;
    float turn = 0;  ///< degrees, without a turntable
    std::uint32_t device = 0;
    bool chooseDevice = false;
    std::string backend = "any";
    float exposure = 1;
    colour::ColourChoice colours;
    std::uint32_t passes = 8;
    bool temporal = false;
    std::string exr;
    std::vector<std::string> aovs;
    std::vector<std::string> imageFolders;
    std::vector<std::string> burnIn;  ///< frame, take, settings, error or other text, a line each
    std::string against;              ///< record that errors are measured from
    std::string animation;
    std::string strip;
    std::uint32_t columns = 0;  ///< of the strip; 0: one row
    std::uint32_t milliseconds = 40;
    std::optional<double> framesPerSecond;  ///< of the animation; none: as `milliseconds` says
    std::string output;

    bool sequence() const { return !frames.empty() || turntable > 0; }
    /// Of the first image, which may be one of the handles.
    std::uint64_t firstNumber() const { return start ? *start - handles : 0; }
};

/// Adds the options of `render` to `job`. They live as long as what is returned.
std::shared_ptr<RenderJobOptions> addRenderOptions(CLI::App& job);

/// How each image is drawn, but for its shadows. Throws WrongUsage for a size that is none.
Result<render::RenderOptions> pictureOptions(const RenderJobOptions& options, const ViewFile& view);
/// As the project has them, but for what the view says, and what the options say.
void takeShadows(const RenderJobOptions& options, const ShadowSettings& project, const ViewFile& view,
                 render::RenderOptions& picture);

/// One picture of a sequence.
struct Shot {
    std::uint64_t frame = 0;
    float turn = 0;  ///< degrees around the upright axis through the camera's target
};

/// The images that are asked for, at most 10,000. Throws WrongUsage for frames that are no sequence.
Result<std::vector<Shot>> shotsOf(const RenderJobOptions& options);

/// What `render` does once its outputs are held; images go where the options name a file.
Result<Report> renderToFile(const RenderJobOptions& options);

}  // namespace hairloom::cli
