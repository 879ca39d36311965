// SPDX-License-Identifier: GPL-3.0-or-later
// For programs that are built without OpenColorIO.
#include "core/colour/colour_config.h"

namespace hairloom::colour {

struct ColourConfig::Library {};

bool hasOpenColorIO() {
    return false;
}

Result<ColourConfig> ColourConfig::read(const std::filesystem::path& path) {
    return failIn(path.string(), {}, "this program was built without OpenColorIO and cannot read configs",
                  "expected no config");
}

Result<std::shared_ptr<const render::ColourTransform>> ColourConfig::view(const std::string&,
                                                                          const std::string&) const {
    return fail("this program was built without OpenColorIO",
                "expected one that was built with it, or no --color-config");
}

}  // namespace hairloom::colour
