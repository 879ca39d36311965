// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Classes of curl, from straight to woolly, as operators: Rünz 2012, Table 1, names them for groups of hair.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/groom/operator_stack.h"

namespace hairloom {

struct CurlClass {
    const char* name;         ///< "woolly"
    const char* description;  ///< of its strands
    const char* operators;    ///< as a file of operators has them
    float turnsPerMetre;      ///< of its finest waves or curls; 0: it has none
};
std::span<const CurlClass> curlClasses();
std::vector<std::string> curlNames();
/// The class of that name, or null.
const CurlClass* findCurlClass(std::string_view name);

/// What makes strands of that class, from the root on. None for straight hair that grows straight.
std::vector<Operator> operatorsOf(const CurlClass& curl);

/// The stack with the class in place of the class that it has, or after all others; with that of straight
/// hair without any.
std::vector<Operator> withCurl(std::vector<Operator> stack, const CurlClass& curl);

/// Points that a strand of that length (metres) needs, so that its curls are round.
std::uint32_t pointsForCurl(const CurlClass& curl, float length);

}  // namespace hairloom
