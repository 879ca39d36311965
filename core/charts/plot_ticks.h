// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where an axis has its marks, and what they say.

#include <vector>

#include "core/charts/plot.h"

namespace hairloom {

/// An axis with its range settled.
struct AxisLayout {
    Scale scale = Scale::Linear;
    double low = 0;
    double high = 1;
    std::vector<AxisTick> ticks;     ///< within the range, ascending. "10^-3" stands for a raised −3.
    std::vector<double> minorTicks;  ///< without labels

    bool drawable(double value) const;  ///< finite, and positive on a logarithmic axis
    bool within(double value) const;    ///< drawable, and in the range up to rounding
    /// Place in 0 … 1 along the axis; the value is drawable.
    double share(double value) const;
};

/// The range that covers the drawable ones of `values` (0 … 1, or 1 … 10, where there are none) and the
/// ticks, about one per `spacing` of `length` pixels. `padded` leaves a little room around the values.
AxisLayout layoutAxis(const Axis& axis, const std::vector<double>& values, double length, double spacing,
                      bool padded);

/// 1, 2 or 5 times a power of ten, the least that is not below `step` > 0.
double niceStep(double step);

/// The shortest decimal text of the value: "0.25", "16", "1e-07", with a real minus sign.
std::string numberText(double value);

}  // namespace hairloom
