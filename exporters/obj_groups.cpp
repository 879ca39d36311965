// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/obj_groups.h"

#include <fmt/format.h>

namespace hairloom {

bool isLegalInObj(char c, bool) {
    return static_cast<unsigned char>(c) > 0x20 && c != 0x7f && c != '#' && c != '\\';
}

std::string objGroup(const ExportedPart& part) {
    std::string title = part.displayName;
    for (char& c : title) {
        if (static_cast<unsigned char>(c) < 0x20 || c == '#') c = ' ';
    }
    // At the end of a line it would join the next.
    if (title.ends_with('\\')) title.back() = ' ';
    // A part alone is called "hair" whatever its layer is.
    const bool isAlone = !title.empty() && part.name == "hair";
    const std::string group = isAlone ? NameGiver(isLegalInObj).give(title) : part.name;
    return fmt::format("o {}\ng {}\n", title.empty() ? part.name : title, group);
}

}  // namespace hairloom
