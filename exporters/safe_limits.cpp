// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/safe_limits.h"

namespace hairloom {
namespace {

using runtime::field;
using L = SafeLimits;

// clang-format off
constexpr runtime::Field<L> kFields[] = {
    field<&L::largestStep>("largestStep", "s", 0, 10, "longest frame"),
    field<&L::rootSpeed>("rootSpeed", "m/s", 0, 1e4, "fastest head"),
    field<&L::turn>("turn", "°", 0, 180, "largest turn of the head in a frame"),
    field<&L::wind>("wind", "m/s", 0, 1e4, "strongest wind"),
    field<&L::storms>("storms", "", 0, 1e6, "random storms tested"),
    field<&L::failed>("failed", "", 0, 1e6, "storms beyond the limits that broke it"),
};
// clang-format on

}  // namespace

std::span<const runtime::Field<SafeLimits>> fieldsOf(const SafeLimits&) {
    return kFields;
}

}  // namespace hairloom
