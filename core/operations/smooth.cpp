// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/smooth.h"

#include <algorithm>
#include <vector>

#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"

namespace hairloom {
namespace {

using S = SmoothSettings;

constexpr Field<S> kFields[] = {
    field<&S::amount>("amount", "", 0, 1,
                      "how far points move to the average of their neighbours in each pass"),
    field<&S::passes>("passes", "", 1, 100, "number of passes: more smooths over longer stretches"),
    clearanceField<&S::clearance>(),
};
constexpr const char* kFormulaFields[] = {"amount"};

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

namespace {

Result<std::size_t> smoothVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("smooth", varied.base()); !status) return tl::unexpected(status.error());
    return editStrands(groom, region, {varied.base().clearance}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        std::vector<Vec3f> before(strand.points.begin(), strand.points.end());
        for (std::uint32_t pass = 0; pass < settings.passes; ++pass) {
            for (std::size_t i = 1; i + 1 < before.size(); ++i) {
                const Vec3f middle = 0.5f * (before[i - 1] + before[i + 1]);
                strand.points[i] = before[i] + settings.amount * (middle - before[i]);
            }
            std::copy(strand.points.begin(), strand.points.end(), before.begin());
        }
        restoreLengthsByDirection(strand.points, strand.lengths);
    });
}

}  // namespace

Result<std::size_t> smooth(Groom& groom, const S& settings, const Region& region) {
    return smoothVaried(groom, settings, region);
}

Operation smoothOperation() {
    return variedOperation<S, smoothVaried, kFormulaFields>("smooth", 60, "smooths strands");
}

}  // namespace hairloom
