// SPDX-License-Identifier: MIT
// What points of strands are shown as: directions, numbers of 16 bits, the box around them. Loops that the
// compiler turns into vectors. Included anew for each instruction set.
#if defined(HAIRLOOM_RUNTIME_FOLLOW_SHOWN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_FOLLOW_SHOWN_INL_H
#undef HAIRLOOM_RUNTIME_FOLLOW_SHOWN_INL_H
#else
#define HAIRLOOM_RUNTIME_FOLLOW_SHOWN_INL_H
#endif

#include <cmath>
#include <cstdint>

#include "engine/lanes-inl.h"
#include "follow/follow_kernels.h"
#include "follow/number_bits.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Of one component; without branches.
HWY_INLINE std::uint16_t halfOf(float value) {
    const auto bits = fromBitsOf<std::uint32_t>(value);
    const std::uint32_t sign = (bits >> 16u) & 0x8000u, size = bits & 0x7fffffffu;
    // Adding a half puts the last place of a half's subnormals at that of the sum, and rounds there.
    const std::uint32_t small = fromBitsOf<std::uint32_t>(fromBitsOf<float>(size) + 0.5f) - 0x3f000000u;
    const std::uint32_t usual = (size + 0xfffu + ((size >> 13u) & 1u) - 0x38000000u) >> 13u;
    std::uint32_t half = size < 0x38800000u ? small : usual;
    half = size >= 0x477ff000u ? 0x7c00u : half;
    half = size > 0x7f800000u ? 0x7e00u : half;
    return static_cast<std::uint16_t>(sign | half);
}

void toHalves(const float* positions, std::size_t points, Float3 from, std::uint16_t* halves) {
    const float less[3] = {from.x, from.y, from.z};
    for (std::size_t p = 0; p < points; ++p) {
        for (std::size_t c = 0; c < 3; ++c) halves[3 * p + c] = halfOf(positions[3 * p + c] - less[c]);
    }
}

std::uint32_t toNorms(const float* positions, std::size_t points, Float3 from, Float3 scale,
                      std::uint16_t* norms) {
    const float less[3] = {from.x, from.y, from.z}, steps[3] = {scale.x, scale.y, scale.z};
    std::uint32_t beyond = 0;
    for (std::size_t p = 0; p < points; ++p) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float at = (positions[3 * p + c] - less[c]) * steps[c] + 0.5f;
            // What is no number is neither, and lands at 0.
            const float above = at >= 0.0f ? at : 0.0f;
            const float within = above < 65536.0f ? above : 65535.0f;
            beyond += within == at ? 0u : 1u;
            norms[3 * p + c] = static_cast<std::uint16_t>(static_cast<std::int32_t>(within));
        }
    }
    return beyond;
}

void toSignedNorms(const float* values, std::size_t count, std::int16_t* norms) {
    for (std::size_t i = 0; i < count; ++i) {
        const float at = values[i] * 32767.0f;
        norms[i] = static_cast<std::int16_t>(static_cast<std::int32_t>(at + (at < 0.0f ? -0.5f : 0.5f)));
    }
}

void growBounds(const float* positions, std::size_t points, float* low, float* high) {
    const D d;
    const std::size_t floats = 3 * points;
    // Three registers hold whole points, x y z x y z …: lane i of all three has coordinate i modulo 3.
    V least[3], most[3];
    for (std::size_t k = 0; k < 3; ++k) {
        least[k] = all(1e30f);
        most[k] = all(-1e30f);
    }
    std::size_t i = 0;
    for (; i + 3 * kWidth <= floats; i += 3 * kWidth) {
        for (std::size_t k = 0; k < 3; ++k) {
            const V at = hn::LoadU(d, positions + i + k * kWidth);
            // Comparisons with what is no number are false.
            least[k] = hn::IfThenElse(at < least[k], at, least[k]);
            most[k] = hn::IfThenElse(at > most[k], at, most[k]);
        }
    }
    HWY_ALIGN float lows[3 * kWidth], highs[3 * kWidth];
    for (std::size_t k = 0; k < 3; ++k) {
        hn::Store(least[k], d, lows + k * kWidth);
        hn::Store(most[k], d, highs + k * kWidth);
    }
    const auto take = [&](std::size_t at, float lowest, float highest) {
        low[at % 3] = lowest < low[at % 3] ? lowest : low[at % 3];
        high[at % 3] = highest > high[at % 3] ? highest : high[at % 3];
    };
    for (std::size_t lane = 0; lane < 3 * kWidth; ++lane) take(lane, lows[lane], highs[lane]);
    for (; i < floats; ++i) take(i, positions[i], positions[i]);
}

/// Of a point between two others of its strand, which may be itself.
HWY_INLINE void tangentOf(const float* before, const float* after, float* direction) {
    const float x = after[0] - before[0], y = after[1] - before[1], z = after[2] - before[2];
    const float size = std::sqrt(x * x + y * y + z * z);
    const bool usable = size > 1e-12f && size < 1e30f;
    const float inverse = 1.0f / size;
    direction[0] = usable ? x * inverse : 0.0f;
    direction[1] = usable ? y * inverse : 1.0f;
    direction[2] = usable ? z * inverse : 0.0f;
}

void tangents(const float* positions, std::size_t points, std::size_t perStrand, float* directions) {
    const D d;
    if (points < 2) return;
    // All as if they were one strand, several at a time; then the ends of each.
    std::size_t p = 1;
    for (; p + kWidth < points; p += kWidth) {
        V3 before, after;
        hn::LoadInterleaved3(d, positions + 3 * (p - 1), before.x, before.y, before.z);
        hn::LoadInterleaved3(d, positions + 3 * (p + 1), after.x, after.y, after.z);
        const V3 along = after - before;
        const V size = hn::Sqrt(hn::Add(hn::Add(hn::Mul(along.x, along.x), hn::Mul(along.y, along.y)),
                                        hn::Mul(along.z, along.z)));
        const auto usable = hn::And(size > all(1e-12f), size < all(1e30f));
        const V inverse = hn::Div(all(1.0f), size);
        hn::StoreInterleaved3(hn::IfThenElseZero(usable, hn::Mul(along.x, inverse)),
                              hn::IfThenElse(usable, hn::Mul(along.y, inverse), all(1.0f)),
                              hn::IfThenElseZero(usable, hn::Mul(along.z, inverse)), d, directions + 3 * p);
    }
    for (; p + 1 < points; ++p)
        tangentOf(positions + 3 * (p - 1), positions + 3 * (p + 1), directions + 3 * p);
    for (std::size_t first = 0; first + perStrand <= points; first += perStrand) {
        const std::size_t last = first + perStrand - 1;
        tangentOf(positions + 3 * first, positions + 3 * (first + 1), directions + 3 * first);
        tangentOf(positions + 3 * (last - 1), positions + 3 * last, directions + 3 * last);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
