// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"
#include "core/gpu/vulkan/free_list.h"
#include "core/gpu/vulkan/reflection.h"

namespace hairloom::gpu::vulkan {
namespace {

TEST(FreeList, PartsNeverOverlapAndComeBackWhole) {
    constexpr std::uint64_t kSize = 1u << 16u;
    FreeList list(kSize);
    Random random(7);
    struct Part {
        std::uint64_t offset, size;
    };
    std::vector<Part> parts;
    std::vector<bool> used(kSize, false);
    for (int step = 0; step < 4000; ++step) {
        if (parts.empty() || random.uniform() < 0.55f) {
            const std::uint64_t size = 1 + random.below(2000);
            const std::uint64_t alignment = std::uint64_t{1} << random.below(9);
            const auto offset = list.allocate(size, alignment);
            if (!offset) continue;
            ASSERT_EQ(*offset % alignment, 0u);
            ASSERT_LE(*offset + size, kSize);
            for (std::uint64_t i = *offset; i < *offset + size; ++i) {
                ASSERT_FALSE(used[i]);
                used[i] = true;
            }
            parts.push_back({*offset, size});
        } else {
            const std::size_t k = random.below(static_cast<std::uint32_t>(parts.size()));
            for (std::uint64_t i = 0; i < parts[k].size; ++i) used[parts[k].offset + i] = false;
            list.release(parts[k].offset, parts[k].size);
            parts[k] = parts.back();
            parts.pop_back();
        }
    }
    for (const Part& part : parts) list.release(part.offset, part.size);
    EXPECT_TRUE(list.isEmpty());
    EXPECT_FALSE(list.allocate(kSize + 1, 1));
    EXPECT_EQ(list.allocate(kSize, 256), 0u);
    EXPECT_FALSE(list.allocate(1, 1));
}

TEST(Reflection, RefusesWhatIsNotSpirV) {
    EXPECT_FALSE(reflect({}, VK_SHADER_STAGE_VERTEX_BIT));
    const std::vector<std::uint32_t> wrongMagic(16, 1);
    EXPECT_FALSE(reflect(wrongMagic, VK_SHADER_STAGE_VERTEX_BIT));
    std::vector<std::uint32_t> truncated = {0x07230203, 0x10300, 0, 10, 0, (9u << 16u) | 71u, 1};
    EXPECT_FALSE(reflect(truncated, VK_SHADER_STAGE_VERTEX_BIT));
    truncated.resize(5);
    EXPECT_TRUE(reflect(truncated, VK_SHADER_STAGE_VERTEX_BIT));
}

TEST(Reflection, NamesRegisters) {
    EXPECT_EQ(toString(toRegister(3)), "b3");
    EXPECT_EQ(toString(toRegister(16)), "t0");
    EXPECT_EQ(toString(toRegister(49)), "s1");
    EXPECT_EQ(toString(toRegister(66)), "u2");
}

}  // namespace
}  // namespace hairloom::gpu::vulkan
