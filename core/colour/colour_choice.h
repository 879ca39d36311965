// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which colours an image is shown in, as the command line and the window ask for them.

#include <optional>
#include <string>

#include "core/colour/colour_config.h"

namespace hairloom::colour {

/// Says "no config", even where `$OCIO` names one.
inline constexpr const char* kNoConfig = "none";

struct ColourChoice {
    std::string config;   ///< file, kNoConfig, or empty for what `$OCIO` names
    std::string display;  ///< empty: the config's default
    std::string view;     ///< empty: the display's default

    bool operator==(const ColourChoice&) const = default;
};

/// A view of a config, ready for use.
struct Colours {
    ColourConfig config;
    std::string display, view;
    std::shared_ptr<const render::ColourTransform> toDisplay;
};

/// The file that a choice means; empty: the standard colours.
std::filesystem::path configFile(const ColourChoice& choice);

/// The config that a choice means, which must mean one. Errors: those of ColourConfig::read().
Result<ColourConfig> readConfig(const ColourChoice& choice);

/// `display` and `view` of it, empty for the defaults. Errors: those of ColourConfig::view().
Result<Colours> chooseView(const ColourConfig& config, const std::string& display, const std::string& view);

/// Nothing for the standard colours. Errors: those of ColourConfig, a display or view without a config.
Result<std::optional<Colours>> chooseColours(const ColourChoice& choice);

}  // namespace hairloom::colour
