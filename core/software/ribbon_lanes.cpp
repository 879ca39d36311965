// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/ribbon_lanes.h"

#include <algorithm>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/software/ribbon_lanes.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::software {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using Floats = hn::Vec<Lanes>;

void findHitsOf(const RibbonPiece& p, const PixelBox& box, float reach, RibbonHits& hits) {
    const Lanes d;
    const auto set = [&](float value) { return hn::Set(d, value); };
    const auto at = [](int pixel, int origin) { return static_cast<float>(pixel - origin); };
    const float fromX = at(box.left, p.originX);
    const float toX = at(box.right, p.originX);
    const float fromY = at(box.top, p.originY);
    const float toY = at(box.bottom, p.originY);
    const float fromU = p.steep ? fromY : fromX;
    const float toU = p.steep ? toY : toX;
    const Floats fromV = set(p.steep ? fromX : fromY);
    const Floats toV = set(p.steep ? toX : toY);
    const Floats half = set(0.5f);
    const Floats one = set(1.0f);
    const Floats outside = set(-reach);
    const float margin = p.across + 0.5f + reach;
    const auto line = [&](const std::array<float, 3>& l, Floats x, Floats y) {
        return hn::Add(hn::Add(hn::Mul(set(l[0]), x), hn::Mul(set(l[1]), y)), set(l[2]));
    };
    // The least whole number that is not below.
    const Floats low = hn::Ceil(set(p.lowU - 0.5f - reach));
    const Floats high = hn::Floor(set(p.highU - 0.5f + reach));
    const float first = std::max(hn::GetLane(low), fromU);
    const float last = std::min(hn::GetLane(high), toU);
    std::size_t count = 0;
    for (float begin = first; begin <= last; begin += static_cast<float>(hn::Lanes(d))) {
        const Floats u = hn::Add(set(begin), hn::ConvertTo(d, hn::Iota(hn::RebindToSigned<Lanes>(), 0)));
        const Floats atU = hn::Add(u, half);
        const Floats middle = hn::Add(set(p.startV), hn::Mul(set(p.slope), hn::Sub(atU, set(p.startU))));
        Floats v = hn::Max(hn::Ceil(hn::Sub(middle, set(margin))), fromV);
        const Floats end = hn::Min(hn::Floor(hn::Add(middle, set(p.across - 0.5f + reach))), toV);
        const auto valid = hn::Le(u, set(last));
        for (;; v = hn::Add(v, one)) {
            const auto runs = hn::And(valid, hn::Le(v, end));
            if (hn::AllFalse(d, runs)) break;
            const Floats atV = hn::Add(v, half);
            const Floats x = p.steep ? atV : atU;
            const Floats y = p.steep ? atU : atV;
            const Floats after = line(p.begins, x, y);
            const Floats before = line(p.ends, x, y);
            const Floats inside = hn::Min(line(p.left, x, y), line(p.right, x, y));
            const auto found = hn::And(hn::And(runs, hn::Ge(inside, outside)),
                                       hn::And(hn::Ge(after, hn::Zero(d)), hn::Gt(before, hn::Zero(d))));
            if (hn::AllFalse(d, found)) continue;
            const Floats along = hn::Div(after, hn::Max(hn::Add(after, before), set(1e-12f)));
            const Floats depth = hn::Add(set(p.depthBegin), hn::Mul(along, set(p.depthEnd - p.depthBegin)));
            hn::CompressStore(p.steep ? v : u, found, d, hits.x.data() + count);
            hn::CompressStore(p.steep ? u : v, found, d, hits.y.data() + count);
            hn::CompressStore(along, found, d, hits.along.data() + count);
            hn::CompressStore(depth, found, d, hits.depth.data() + count);
            count += hn::CompressStore(inside, found, d, hits.inside.data() + count);
        }
    }
    hits.count = count;
}

FindHits chosen() {
    return &findHitsOf;
}

}  // namespace HWY_NAMESPACE
}  // namespace hairloom::software
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::software {

HWY_EXPORT(chosen);

FindHits findHits() {
    return HWY_DYNAMIC_DISPATCH(chosen)();
}

}  // namespace hairloom::software
#endif
