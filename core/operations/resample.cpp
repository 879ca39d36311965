// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/resample.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/geometry/curve.h"
#include "core/operations/operation.h"
#include "hairloom/strands.h"

namespace hairloom {
namespace {

using S = ResampleSettings;

constexpr Field<S> kFields[] = {
    field<&S::points>("points", "", 2, runtime::kMaxPoints, "points per strand, evenly spaced"),
};

template <class T>
T mixed(const T& a, const T& b, float t) {
    if (t <= 0) return a;
    if (t >= 1) return b;
    if constexpr (std::is_integral_v<T>) {
        return t < 0.5f ? a : b;
    } else {
        return a + t * (b - a);
    }
}

AttributeData taken(const AttributeData& data, const std::vector<PolylinePlace>& places) {
    return std::visit(
        [&](const auto& array) -> AttributeData {
            using Array = std::remove_cvref_t<decltype(array)>;
            std::vector<std::remove_cvref_t<decltype(array[0])>> values;
            values.reserve(places.size());
            for (const PolylinePlace& place : places)
                values.push_back(mixed(array[place.segment], array[place.segment + 1], place.t));
            return Array(std::move(values));
        },
        data);
}

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> resample(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("resample", settings); !status) return tl::unexpected(status.error());
    std::vector<std::uint32_t> counts(groom.strandCount());
    std::size_t changed = 0;
    for (std::size_t s = 0; s < counts.size(); ++s) counts[s] = groom.offsets[s + 1] - groom.offsets[s];
    for (const std::uint32_t s : strandsToEdit(groom, region)) {
        changed += counts[s] != settings.points ? 1 : 0;
        counts[s] = settings.points;
    }
    if (changed == 0) return 0;
    std::vector<std::uint32_t> offsets{0};
    std::vector<PolylinePlace> places;
    for (std::size_t s = 0; s < counts.size(); ++s) {
        const std::uint32_t first = groom.offsets[s], own = groom.offsets[s + 1] - first;
        if (counts[s] == own) {
            for (std::uint32_t i = 0; i + 1 < own; ++i) places.push_back({first + i, 0});
            places.push_back({first + own - 2, 1});
        } else {
            for (const auto& [segment, t] : evenPlaces(groom.strand(s), counts[s]))
                places.push_back({first + segment, t});
        }
        offsets.push_back(static_cast<std::uint32_t>(places.size()));
    }
    dropOperators(groom);  // their arrays have other points
    AttributeSet points;
    for (const auto& [name, data] : groom.pointAttributes.all()) points.set(name, taken(data, places));
    groom.pointAttributes = std::move(points);
    groom.offsets = CowArray<std::uint32_t>(std::move(offsets));
    return changed;
}

Operation resampleOperation() {
    return lastingOperation<S, resample>("resample", 110, "resamples strands to a number of points");
}

}  // namespace hairloom
