// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which strands of two versions of a groom are the same.

#include <cstdint>
#include <utility>
#include <vector>

#include "core/groom/groom_diff.h"

namespace hairloom {

struct StrandPairs {
    StrandMatch match = StrandMatch::ids;
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        pairs;  ///< strand before and after, in order of before
    std::size_t removed = 0, added = 0;

    bool inOrder() const;  ///< strands that both have follow each other alike
};

StrandPairs pairStrands(const Groom& before, const Groom& after);

}  // namespace hairloom
