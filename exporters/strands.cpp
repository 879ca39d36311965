// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/strands.h"

#include <algorithm>
#include <cassert>

namespace hairloom {

const StrandWriter& strandWriter(std::string_view name) {
    const auto found = std::ranges::find(strandWriters(), name, &StrandWriter::name);
    assert(found != strandWriters().end());
    return *found;
}

}  // namespace hairloom
