// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/array_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace hairloom::editing {
namespace {

using Element = std::array<std::uint32_t, 3>;

/// `count` of `length` elements in gaps of up to `longest`, which do not touch.
std::vector<Range> randomGaps(Random& random, std::size_t length, std::size_t count, std::uint32_t longest) {
    std::vector<Range> gaps;
    std::size_t left = count;
    std::size_t begin = std::min<std::size_t>(random.below(3), length - left);
    while (left > 0) {
        const std::size_t size = std::min<std::size_t>(left, 1 + random.below(longest));
        gaps.push_back({begin, size});
        left -= size;
        begin += size;
        // What is not in gaps is spread over the rest.
        const std::size_t behind = length - begin - left;
        if (left > 0)
            begin += 1 + random.below(static_cast<std::uint32_t>(1 + behind * longest / (2 * left)));
        if (left > 0 && begin + left > length) begin = length - left;
    }
    return gaps;
}

std::vector<Element> numbered(std::size_t count) {
    std::vector<Element> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        values[i] = {n, ~n, n * 2654435761u};
    }
    return values;
}

std::vector<Element> withoutGaps(const std::vector<Element>& values, std::span<const Range> gaps) {
    std::vector<Element> kept;
    std::size_t at = 0;
    for (const Range& gap : gaps) {
        kept.insert(kept.end(), values.begin() + static_cast<std::ptrdiff_t>(at),
                    values.begin() + static_cast<std::ptrdiff_t>(gap.begin));
        at = gap.begin + gap.count;
    }
    kept.insert(kept.end(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return kept;
}

class ArrayGaps : public testing::TestWithParam<std::size_t> {
  protected:
    void SetUp() override { setThreadCount(GetParam()); }
    void TearDown() override { setThreadCount(0); }
};

struct Case {
    std::size_t length;
    std::size_t count;  ///< in gaps
    std::uint32_t longest;
};

/// Large arrays are moved in pieces, one for each thread.
TEST_P(ArrayGaps, CloseAndOpenAsIfOneElementWereMovedAfterTheOther) {
    Random random(11);
    constexpr std::size_t kLarge = 600'000;  // 7.2 MB
    for (const auto& [length, count, longest] :
         {Case{1, 1, 1}, Case{10, 4, 3}, Case{1000, 1, 1}, Case{1000, 999, 50}, Case{kLarge, 1, 1},
          Case{kLarge, 3000, 16}, Case{kLarge, 30'000, 40}, Case{kLarge, 300'000, 400},
          Case{kLarge, 590'000, 9000}}) {
        SCOPED_TRACE(std::to_string(count) + " of " + std::to_string(length));
        const auto gaps = randomGaps(random, length, count, longest);
        ASSERT_EQ(total(gaps), count);
        ASSERT_LE(gaps.back().begin + gaps.back().count, length);
        const auto values = numbered(length);
        auto moved = values;
        closeGaps(std::as_writable_bytes(std::span(moved)), sizeof(Element), gaps);
        moved.resize(length - count);
        ASSERT_TRUE(moved == withoutGaps(values, gaps));
        moved.resize(length);
        openGaps(std::as_writable_bytes(std::span(moved)), sizeof(Element), gaps);
        for (const Range& gap : gaps) {
            for (std::size_t i = gap.begin; i < gap.begin + gap.count; ++i) moved[i] = values[i];
        }
        ASSERT_TRUE(moved == values);
    }
}

INSTANTIATE_TEST_SUITE_P(Threads, ArrayGaps, testing::Values(1, 2, 3, 16));

}  // namespace
}  // namespace hairloom::editing
