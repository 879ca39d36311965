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

Result<std::optional<Colours>> chooseColours(const ColourChoice& choice) {
    const std::filesystem::path file = configFile(choice);
    if (file.empty()) {
        if (choice.display.empty() && choice.view.empty()) return std::nullopt;
        return fail("a display or view without a config",
                    "expected a config (--color-config FILE) or $OCIO, which names one");
    }
    auto config = ColourConfig::read(file);
    if (!config) {
        Error error = config.error();
        if (choice.config.empty()) error.problem += " ($OCIO names this file)";
        return tl::unexpected(error);
    }
    const auto& displays = config->displays();
    Colours colours{
        *config, choice.display.empty() ? displays.front().name : choice.display, choice.view, {}};
    if (colours.view.empty()) {
        for (const Display& display : displays) {
            if (display.name == colours.display) colours.view = display.views.front();
        }
    }
    auto made = config->view(colours.display, colours.view);
    if (!made) return tl::unexpected(made.error());
    colours.toDisplay = std::move(*made);
    return colours;
}

}  // namespace hairloom::colour
