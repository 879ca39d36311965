// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/colour/colour_choice.h"

#include <cstdlib>

namespace hairloom::colour {
namespace {

const char* fromEnvironment() {
    const char* const named = std::getenv("OCIO");  // NOLINT(concurrency-mt-unsafe)
    return named == nullptr ? "" : named;
}

}  // namespace

std::filesystem::path configFile(const ColourChoice& choice) {
    if (choice.config == kNoConfig) return {};
    if (!choice.config.empty()) return choice.config;
    // Without the library the variable asks for what this program never had.
    return hasOpenColorIO() ? fromEnvironment() : "";
}

Result<ColourConfig> readConfig(const ColourChoice& choice) {
    auto config = ColourConfig::read(configFile(choice));
    if (config || !choice.config.empty()) return config;
    Error error = config.error();
    error.problem += " ($OCIO names this file)";
    return tl::unexpected(error);
}

Result<Colours> chooseView(const ColourConfig& config, const std::string& display, const std::string& view) {
    const auto& displays = config.displays();
    Colours colours{config, display.empty() ? displays.front().name : display, view, {}};
    if (view.empty()) {
        for (const Display& known : displays) {
            if (known.name == colours.display) colours.view = known.views.front();
        }
    }
    auto made = config.view(colours.display, colours.view);
    if (!made) return tl::unexpected(made.error());
    colours.toDisplay = std::move(*made);
    return colours;
}

Result<std::optional<Colours>> chooseColours(const ColourChoice& choice) {
    const std::filesystem::path file = configFile(choice);
    if (file.empty()) {
        if (choice.display.empty() && choice.view.empty()) return std::nullopt;
        return fail("a display or view without a config",
                    "expected a config (--color-config FILE) or $OCIO, which names one");
    }
    const auto config = readConfig(choice);
    if (!config) return tl::unexpected(config.error());
    auto colours = chooseView(*config, choice.display, choice.view);
    if (!colours) return tl::unexpected(colours.error());
    return std::move(*colours);
}

}  // namespace hairloom::colour
