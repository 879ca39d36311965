// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/models/bend_reduction.h"

#include <utility>

#include "core/base/parallel.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::kBlockLanes;

constexpr std::size_t kBlocksPerJob = 8;

/// a b; c d.
struct Block {
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
};
Block operator*(const Block& x, const Block& y) {
    return {x.a * y.a + x.b * y.c, x.a * y.b + x.b * y.d, x.c * y.a + x.d * y.c, x.c * y.b + x.d * y.d};
}
Block operator+(const Block& x, const Block& y) {
    return {x.a + y.a, x.b + y.b, x.c + y.c, x.d + y.d};
}
Block operator-(const Block& x) {
    return {-x.a, -x.b, -x.c, -x.d};
}
Block inverse(const Block& x) {
    const double determinant = 1.0 / (x.a * x.d - x.b * x.c);
    return {x.d * determinant, -x.b * determinant, -x.c * determinant, x.a * determinant};
}

/// A pair of rows: its own block, and those that couple it to the pair before and after.
struct Pair {
    Block before, own, after;
};

/// The matrix's rows p and p − 1, p − 2.
struct Row {
    double diagonal = 1.0, one = 0.0, two = 0.0;
};
Row rowOf(const BendFactors& f, std::uint32_t p) {
    Row row;
    if (p < f.first || p >= f.end) return row;
    row.diagonal = 1.0 / f.inverseDiagonal[p];
    if (p > f.first) {
        const double before = 1.0 / f.inverseDiagonal[p - 1];
        row.diagonal += f.lower1[p] * f.lower1[p] * before;
        row.one = f.lower1[p] * before;
    }
    if (p > f.first + 1) {
        const double before = 1.0 / f.inverseDiagonal[p - 2];
        row.diagonal += f.lower2[p] * f.lower2[p] * before;
        row.one += f.lower2[p] * before * f.lower1[p - 1];
        row.two = f.lower2[p] * before;
    }
    return row;
}

std::vector<Pair> pairsOf(const BendFactors& factors, std::uint32_t points) {
    std::vector<Pair> pairs((points + 1) / 2);
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        const Row first = rowOf(factors, 2 * i), second = rowOf(factors, 2 * i + 1);
        pairs[i].own = {first.diagonal, second.one, second.one, second.diagonal};
        pairs[i].before = {first.two, first.one, 0.0, second.two};
    }
    for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
        const Block& next = pairs[i + 1].before;
        pairs[i].after = {next.a, next.c, next.b, next.d};
    }
    return pairs;
}

shaders::float4 toFloat4(double x, double y, double z, double w) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
}

}  // namespace

std::uint32_t reductionSteps(std::uint32_t points) {
    std::uint32_t steps = 1;
    while ((2u << steps) < points) ++steps;
    return steps;
}

std::vector<shaders::float4> reduce(const BendFactors& factors, std::uint32_t points) {
    const std::uint32_t steps = reductionSteps(points);
    std::vector<Pair> pairs = pairsOf(factors, points);
    std::vector<shaders::float4> quads(std::size_t{points} * (steps + 1));
    const auto put = [&](std::size_t pair, std::uint32_t step, const Block& before, const Block& after) {
        quads[2 * pair * (steps + 1) + step] = toFloat4(before.a, before.b, after.a, after.b);
        if (2 * pair + 1 < points)
            quads[(2 * pair + 1) * (steps + 1) + step] = toFloat4(before.c, before.d, after.c, after.d);
    };
    std::vector<Pair> next(pairs.size());
    for (std::uint32_t step = 0; step < steps; ++step) {
        const std::size_t apart = std::size_t{1} << step;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            Block before, after;
            next[i] = {{}, pairs[i].own, {}};
            if (i >= apart) {
                const Pair& other = pairs[i - apart];
                before = -(pairs[i].before * inverse(other.own));
                next[i].own = next[i].own + before * other.after;
                next[i].before = before * other.before;
            }
            if (i + apart < pairs.size()) {
                const Pair& other = pairs[i + apart];
                after = -(pairs[i].after * inverse(other.own));
                next[i].own = next[i].own + after * other.before;
                next[i].after = after * other.after;
            }
            put(i, step, before, after);
        }
        std::swap(pairs, next);
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Block own = inverse(pairs[i].own);
        quads[2 * i * (steps + 1) + steps] = toFloat4(own.a, own.b, 0.0, 0.0);
        if (2 * i + 1 < points) quads[(2 * i + 1) * (steps + 1) + steps] = toFloat4(own.d, own.c, 0.0, 0.0);
    }
    return quads;
}

std::vector<shaders::float4> reducedBend(const runtime::RestShape& shape, const StrandBatch& batch,
                                         std::uint32_t clampedPoints, const runtime::Bend& bend) {
    const std::uint32_t points = batch.shape.points, steps = reductionSteps(points);
    const std::size_t plane = std::size_t{points} * batch.slots;
    std::vector<shaders::float4> values(plane * (steps + 1));
    const auto strand = [&](std::size_t n, std::size_t lane) {
        const runtime::Block& block = shape.blocks[batch.blocks[n]];
        const std::size_t size = planeSize(block);
        const float* const planes = bend.planes.data() + block.firstPlane * bend.planeCount() + lane;
        std::vector<double> factors;
        factors.reserve(std::size_t{3} * block.points);
        for (std::size_t k = 1; k <= 3; ++k) {
            for (std::uint32_t p = 0; p < block.points; ++p)
                factors.push_back(planes[k * size + std::size_t{p} * kBlockLanes]);
        }
        const std::span<const double> all = factors;
        const auto quads = reduce({clampedPoints, block.points, all.first(block.points),
                                   all.subspan(block.points, block.points), all.last(block.points)},
                                  points);
        const std::size_t slot = n * kBlockLanes + lane;
        for (std::uint32_t p = 0; p < points; ++p) {
            shaders::float4* const to = values.data() + slot * points + p;
            for (std::uint32_t step = 0; step <= steps; ++step)
                to[step * plane] = quads[p * (steps + 1) + step];
            if (p < block.points) to[steps * plane].z = planes[std::size_t{p} * kBlockLanes];
        }
    };
    parallelFor(batch.blocks.size(), kBlocksPerJob, [&](std::size_t first, std::size_t end) {
        for (std::size_t n = first; n < end; ++n) {
            for (std::size_t lane = 0; lane < kBlockLanes; ++lane) strand(n, lane);
        }
    });
    return values;
}

}  // namespace hairloom::gpu_simulation
